// continuo/worlds/simulate_world.cpp
#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <continuo/model/error_estimate.hpp>
#include <continuo/model/run_checks.hpp>
#include <continuo/model/run_recorder.hpp>
#include <continuo/worlds/simulate_world.hpp>
#include <continuo/worlds/world_events.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

namespace {

using model::Diagnostic;
using X = std::vector<double>;

constexpr std::size_t contacts_of_one_look = 10'000, contacts_of_a_run = 100'000;

class Simulation {
 public:
  Simulation(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
             model::Plan plan, std::unique_ptr<WorldRun> world)
      : program_(program),
        experiment_(experiment),
        world_(std::move(world)),
        events_(program, plan.variables, plan.from, (plan.to - plan.from) / looks),
        times_(plan),
        samples_(sample_times(program->model, plan)),
        recorder_(*program, as_the_recorder_sees(plan), experiment.keep_rows, samples_, program->always) {
    run_.plan = std::move(plan);
  }

  model::Simulated go() {
    const auto begin = std::chrono::steady_clock::now();
    const double from = run_.plan.from;
    end_time_ = run_.plan.to;
    recorder_.begin(from, world_->state());
    for (; next_row() <= from; ++next_output_) {
    }
    while (next_sample_ < samples_.size() && samples_[next_sample_] <= from) ++next_sample_;
    events_.begin(*world_, sink());
    end_where_stopped();
    while (!ended_ && world_->time() < end_time_ - slack()) advance();
    recorder_.finish(world_->time(), world_->state());
    if (!ended_) run_.outcome.ending = Ending::reached_end;
    run_.outcome.t = world_->time();
    run_.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    run_.stop_text = events_.stop_text();
    recorder_.give(run_);
    run_.checks = judge(program_->model, run_, recorder_);
    model::Simulated simulated;
    if (!error_.empty()) {
      simulated.diagnostics.push_back(
          model::error("E324", program_->model.world->span,
                       fmt::format("the bodies cannot be moved beyond t = {:.6g}: {}", run_.outcome.t, error_)));
    } else if (!succeeded(run_.outcome.ending)) {
      simulated.diagnostics.push_back(failure(program_->model, run_.outcome));
    }
    simulated.run = std::move(run_);
    return simulated;
  }

 private:
  /// Steps do not end at round times: rows are written when the time has come, with the time that it is.
  static model::Plan as_the_recorder_sees(model::Plan plan) {
    plan.output = model::OutputPlan::Kind::steps;
    return plan;
  }
  bool in_steps() const { return world_->step() > 0; }
  double slack() const { return slack_of(*world_); }

  double next_row() const {
    if (run_.plan.output == model::OutputPlan::Kind::steps)
      return in_steps() ? world_->time() + world_->step()
                        : run_.plan.from + (run_.plan.to - run_.plan.from) / 200 * static_cast<double>(next_output_);
    return times_[next_output_];
  }

  bool is_interrupted() const { return experiment_.interrupt != nullptr && experiment_.interrupt->load(); }

  /// To the next instant that somebody asks for.
  void advance() {
    if (is_interrupted()) return end(Ending::interrupted);
    double to = std::min({end_time_, next_row(), events_.next(*world_)});
    if (next_sample_ < samples_.size()) to = std::min(to, samples_[next_sample_]);
    if (!program_->always.empty() && in_steps()) to = std::min(to, world_->time() + world_->step());
    std::string error = events_.advance(*world_, to);
    note_contacts();
    arrive();
    if (!error.empty() && is_interrupted()) return end(Ending::interrupted);
    if (!error.empty()) {
      error_ = std::move(error);
      end(Ending::invalid_input);
      run_.outcome.hint = error_;
      return;
    }
    events_.happen(*world_, sink());
    end_where_stopped();
    if (experiment_.progress) experiment_.progress(world_->time());
  }

  /// Rows and samples whose time has come.
  void arrive() {
    const double t = world_->time() + slack();
    bool row = false;
    if (run_.plan.output == model::OutputPlan::Kind::steps && in_steps()) {
      row = true;
    } else {
      for (; next_row() <= t; ++next_output_) row = true;
    }
    bool sampled = false;
    for (; next_sample_ < samples_.size() && samples_[next_sample_] <= t; ++next_sample_) sampled = true;
    const X& state = world_->state();
    if (sampled) recorder_.sample_until(t, state);
    if (row) {
      recorder_.stretch(world_->time(), model::At{const_cast<X*>(&state),
                                                  [](void* from, double, X& x) { x = *static_cast<X*>(from); }});
    } else {
      recorder_.look(world_->time(), state);
    }
  }

  void note_contacts() {
    for (const Contact& contact : world_->contacts()) {
      if (contacts_ == contacts_of_a_run) return;
      ++contacts_;
      recorder_.contact(contact.time, world_->name_of(contact), contact.impulse);
    }
  }

  WorldEvents::Sink sink() {
    return [this](const WorldHappening& now) { recorder_.happening(now.t, now.names, now.before, world_->state()); };
  }
  void end_where_stopped() {
    if (!events_.stopped()) return;
    run_.outcome.event = events_.stopped_by();
    end(Ending::stopped_by_event);
  }

  void end(Ending ending) {
    ended_ = true;
    run_.outcome.ending = ending;
  }

  std::shared_ptr<const model::ModelProgram> program_;
  const model::Experiment& experiment_;
  std::unique_ptr<WorldRun> world_;
  WorldEvents events_;
  model::OutputTimes times_;
  std::vector<double> samples_;
  model::RunRecorder recorder_;
  model::Run run_{};
  std::size_t next_output_ = 0, next_sample_ = 0, contacts_ = 0;
  double end_time_ = 0;
  bool ended_ = false;
  std::string error_;
};

std::optional<Diagnostic> refusal(const model::Model& model) {
  if (model.needs_dae_solver())
    return model::error("E323", model.algebraic.front().span, "equations `0 = ...` cannot stand beside a world", "",
                        "solve this one for its unknown and name it: let ... = ...");
  if (model.needs_boundary_solver())
    return model::error("E323", model.boundary.front().span, "a world begins at the start of its run",
                        "this condition stands at another time", "give all initial values at the start");
  return std::nullopt;
}

}  // namespace

model::Simulated simulate_world(const std::shared_ptr<const model::ModelProgram>& program,
                                const model::Experiment& experiment) {
  model::Simulated simulated;
  const model::Model& model = program->model;
  if (auto problem = refusal(model)) {
    simulated.diagnostics.push_back(std::move(*problem));
    return simulated;
  }
  auto planned = plan(model, experiment, simulated.diagnostics);
  if (!planned) return simulated;
  for (const model::TableInput& input : program->step_inputs)
    planned->variables[input.variable] = input.table.value(planned->from);
  WorldOptions options = options_of(*planned);
  options.most_contacts = contacts_of_one_look;
  options.interrupt = experiment.interrupt;
  StartedWorld started = start_world(program, options, planned->variables);
  if (!started.run) {
    simulated.diagnostics.push_back(model::error("E324", model.world->span, "the world cannot begin", started.error));
    return simulated;
  }
  simulated = Simulation(program, experiment, std::move(*planned), std::move(started.run)).go();
  if (experiment.estimate_error && succeeded(simulated.run->outcome.ending))
    simulated.run->error = estimate_error(program, experiment, *simulated.run, [&](model::Experiment strict) {
      strict.atol.clear();  // bodies have a relative one only
      return simulate_world(program, strict);
    });
  return simulated;
}

model::Simulated simulate_any(const std::shared_ptr<const model::ModelProgram>& program,
                              const model::Experiment& experiment) {
  return program->model.has_world() ? simulate_world(program, experiment) : model::simulate(program, experiment);
}

}  // namespace continuo::worlds
