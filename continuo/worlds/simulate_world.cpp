// continuo/worlds/simulate_world.cpp
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <continuo/model/error_estimate.hpp>
#include <continuo/model/run_checks.hpp>
#include <continuo/model/run_recorder.hpp>
#include <continuo/worlds/simulate_world.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

namespace {

using model::Diagnostic;
using X = std::vector<double>;

constexpr double looks = 1000;  // in a run, where events are watched
constexpr std::size_t contacts_of_one_look = 10'000, contacts_of_a_run = 100'000;
constexpr double never = std::numeric_limits<double>::infinity();

bool has_passed(Direction direction, double before, double now) {
  const bool fell = before > 0 && !(now > 0), rose = before < 0 && !(now < 0);
  return (direction != Direction::rises && fell) || (direction != Direction::falls && rose);
}

class Simulation {
 public:
  Simulation(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
             model::Plan plan, std::unique_ptr<WorldRun> world)
      : program_(program),
        experiment_(experiment),
        world_(std::move(world)),
        system_(program, plan.variables),
        events_(*program, plan.variables, plan.from),
        times_(plan),
        samples_(sample_times(program->model, plan)),
        recorder_(*program, as_the_recorder_sees(plan), experiment.keep_rows, samples_, program->always) {
    run_.plan = std::move(plan);
    values_.resize(events_.size());
    before_.resize(events_.size());
    for (std::size_t i = 0; i < events_.size(); ++i) any_guard_ = any_guard_ || events_.is_guard(i);
  }

  model::Simulated go() {
    const auto begin = std::chrono::steady_clock::now();
    const double from = run_.plan.from;
    end_time_ = run_.plan.to;
    recorder_.begin(from, world_->state());
    for (; next_row() <= from; ++next_output_) {
    }
    while (next_sample_ < samples_.size() && samples_[next_sample_] <= from) ++next_sample_;
    scheduled_after_ = from;
    happen_scheduled(from, true);
    read_guards(before_);
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
  double slack() const { return in_steps() ? 1e-9 * world_->step() : 0; }

  double next_row() const {
    if (run_.plan.output == model::OutputPlan::Kind::steps)
      return in_steps() ? world_->time() + world_->step()
                        : run_.plan.from + (run_.plan.to - run_.plan.from) / 200 * static_cast<double>(next_output_);
    return times_[next_output_];
  }
  double next_scheduled() const {
    double next = never;
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (!events_.is_guard(i)) next = std::min(next, events_.next_time(i, scheduled_after_, false));
    return next;
  }

  bool is_interrupted() const { return experiment_.interrupt != nullptr && experiment_.interrupt->load(); }

  /// To the next instant that somebody asks for.
  void advance() {
    if (is_interrupted()) return end(Ending::interrupted);
    double to = std::min({end_time_, next_row(), next_scheduled()});
    if (next_sample_ < samples_.size()) to = std::min(to, samples_[next_sample_]);
    if (any_guard_) {
      const double look = in_steps() ? world_->step() : (end_time_ - run_.plan.from) / looks;
      to = std::min(to, world_->time() + look);
    }
    if (!any_guard_ && !program_->always.empty() && in_steps()) to = std::min(to, world_->time() + world_->step());
    std::optional<Snapshot> saved;
    if (any_guard_ && !in_steps()) saved = world_->snapshot();
    std::string error = world_->advance_to(to);
    if (error.empty() && any_guard_) {
      read_guards(values_);
      if (any_passed() && saved) error = go_back_to_event(*saved);
    }
    note_contacts();
    arrive();
    if (!error.empty() && is_interrupted()) return end(Ending::interrupted);
    if (!error.empty()) {
      error_ = std::move(error);
      end(Ending::invalid_input);
      run_.outcome.hint = error_;
      return;
    }
    if (any_guard_) happen_guards();
    if (!ended_ && next_scheduled() <= world_->time() + slack()) happen_scheduled(world_->time(), false);
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

  // ---- events ----

  void read_guards(std::vector<double>& values) { events_.guards(system_, world_->time(), world_->state(), values); }
  bool passed(std::size_t i) const {
    return events_.is_guard(i) && events_.active(system_, i) &&
           has_passed(events_.direction(i), before_[i], values_[i]);
  }
  bool any_passed() const {
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (passed(i)) return true;
    return false;
  }

  /// The first instant at which a guard has passed, on its far side.
  std::string go_back_to_event(const Snapshot& saved) {
    double low = saved.time, high = world_->time();
    const auto move_to = [&](double t) {
      std::string error = world_->restore(saved);
      if (error.empty()) error = world_->advance_to(t);
      if (error.empty()) read_guards(values_);
      return error;
    };
    const double least = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
    while (high - low > least) {
      const double middle = low + (high - low) / 2;
      if (std::string error = move_to(middle); !error.empty()) return error;
      (any_passed() ? high : low) = middle;
    }
    return move_to(high);
  }

  void happen_guards() {
    std::vector<std::size_t> fired;
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (passed(i)) fired.push_back(i);
    if (!fired.empty()) happen(fired);
    read_guards(before_);
  }
  void happen_scheduled(double t, bool inclusive) {
    const double until = t + slack();
    while (!ended_) {
      double next = never;
      std::vector<std::size_t> due;
      for (std::size_t i = 0; i < events_.size(); ++i) {
        if (events_.is_guard(i)) continue;
        const double time = events_.next_time(i, scheduled_after_, inclusive);
        if (time > until || time > next) continue;
        if (time < next) due.clear();
        next = time;
        due.push_back(i);
      }
      if (due.empty()) break;
      scheduled_after_ = next;
      inclusive = false;
      happen(due);
    }
    if (any_guard_) read_guards(before_);
  }

  void happen(const std::vector<std::size_t>& fired) {
    const X before = world_->state();
    X after = before;
    const double t = world_->time();
    const auto response = events_.fire(system_, fired, t, before, after);
    for (const model::TableInput& input : program_->step_inputs) {
      const double value = input.table.value(t);
      if (world_->variables()[input.variable] != value) world_->set(input.variable, value);
    }
    if (system_.mode() != world_->mode()) world_->go(system_.mode());
    if (after != before) world_->set_state(after);
    names_.clear();
    const auto marks = events_.marks().subspan(marks_seen_);
    for (const std::size_t i : fired) {
      if (!events_.is_declared(i)) continue;
      const auto mark = std::ranges::find(marks, i, &model::Marked::event);
      names_.push_back({std::string(events_.name(i)), mark == marks.end() ? std::string() : mark->text});
    }
    marks_seen_ = events_.marks().size();
    if (!names_.empty() || after != before) recorder_.happening(t, names_, before, world_->state());
    if (!response.stop) return;
    run_.outcome.event = names_.empty() ? std::string() : names_.front().event;
    end(Ending::stopped_by_event);
  }

  void end(Ending ending) {
    ended_ = true;
    run_.outcome.ending = ending;
  }

  std::shared_ptr<const model::ModelProgram> program_;
  const model::Experiment& experiment_;
  std::unique_ptr<WorldRun> world_;
  model::ModelSystem system_;  // its guards, actions and modes
  model::ModelEvents events_;
  model::OutputTimes times_;
  std::vector<double> samples_;
  model::RunRecorder recorder_;
  model::Run run_{};
  std::vector<double> values_, before_;  // of guards: now, and at the last look
  std::vector<model::RunRecorder::Name> names_;
  std::size_t next_output_ = 0, next_sample_ = 0, marks_seen_ = 0, contacts_ = 0;
  double scheduled_after_ = 0, end_time_ = 0;
  bool any_guard_ = false, ended_ = false;
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
