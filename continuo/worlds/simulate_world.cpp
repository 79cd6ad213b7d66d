// continuo/worlds/simulate_world.cpp
// Drives a world through a run, with rows, events, contacts, checks and notes for a recording.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <continuo/simulation/drive/error_estimate.hpp>
#include <continuo/simulation/drive/run_checks.hpp>
#include <continuo/simulation/drive/run_recorder.hpp>
#include <continuo/simulation/motion_watcher.hpp>
#include <continuo/worlds/flight.hpp>
#include <continuo/worlds/plan_world.hpp>
#include <continuo/worlds/prepared_world.hpp>
#include <continuo/worlds/simulate_world.hpp>
#include <continuo/worlds/world_events.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

namespace {

using model::Diagnostic;
using X = std::vector<double>;

constexpr std::chrono::seconds checkpoint_of_clock{10};  // a long run that is killed loses no more than this
constexpr std::size_t contacts_of_a_run = 100'000;

/// The plan of the recorder, which keeps every row that it gets. Steps do not end at round times, so that a row that is
/// due is written at the end of a step, with the time of that end.
model::Plan as_the_recorder_sees(model::Plan plan) {
  plan.output = model::OutputPlan::Kind::steps;
  return plan;
}

/// The diagnostic of a run that ended early.
Diagnostic ending_of(const model::Model& model, const Outcome<double>& outcome, const std::string& error) {
  if (error.empty()) return failure(model, outcome);
  return model::error("E324", model.world->span,
                      fmt::format("the bodies cannot be moved beyond t = {:.6g}: {}", outcome.t, error));
}

class Simulation {
 public:
  /// `look` is the time between two samples of the conditions of `when`.
  Simulation(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
             model::Plan plan, std::unique_ptr<WorldRun> world, double look, RunLog* log, model::OnRow on_row = {})
      : program_(program),
        experiment_(experiment),
        world_(std::move(world)),
        log_(log),
        events_(program, plan.variables, plan.from, look),
        times_(plan),
        recorder_(*program, as_the_recorder_sees(plan), experiment.keep_rows, sample_times(program->model, plan),
                  program->always, std::move(on_row)) {
    run_.plan = std::move(plan);
    end_time_ = run_.plan.to;
    if (log_ && log_->checkpoints() > 0)
      stand_every_ = (end_time_ - run_.plan.from) / static_cast<double>(log_->checkpoints());
    next_checkpoint_ = run_.plan.from;
  }

  /// Shows the motion to a watcher as it goes, who looks at these times, ascending, and at the end of every step.
  void show_to(model::MotionWatcher& watcher, std::vector<double> looks) {
    watcher_ = &watcher;
    looks_ = std::move(looks);
  }

  void begin() {
    const double from = run_.plan.from;
    if (watcher_) {
      watcher_->begin(run_.plan, world_->state());
      seen_ = {.from = from, .to = from, .start = world_->state(), .end = world_->state()};
    }
    note({.kind = Note::Kind::begin, .t = from, .x = world_->state()});
    for (; next_row() <= from; ++next_output_) {
    }
    if (Status status = events_.begin(*world_, sink()); !status) return fail(std::move(status));
    end_where_stopped();
    stand();
  }

  /// Fails where the checkpoint does not belong to this model.
  Status resume(const RunRecording& recording, std::size_t checkpoint) {
    const Checkpoint& at = recording.checkpoints[checkpoint];
    if (at.stops.size() != events_.stops().size() || at.next_sample > recorder_.samples().size() ||
        at.world.mode >= program_->model.modes.size())
      return invalid_input("it stands where this model cannot");
    if (Status fault = world_->check(at.world); !fault) return fault;
    for (std::size_t i = 0, k = 0; i < at.notes; ++i) {
      note(recording.notes[i]);
      for (; log_ && k <= checkpoint && recording.checkpoints[k].notes == i + 1; ++k)
        log_->add(recording.checkpoints[k]);
    }
    if (Status status = world_->restore(at.world); !status) return status;
    next_output_ = static_cast<std::size_t>(at.next_output);
    contacts_ = static_cast<std::size_t>(at.contacts);
    const std::vector<std::size_t> stops(at.stops.begin(), at.stops.end());
    events_.go_on(*world_, world_->variables(), stops);
    next_checkpoint_ = world_->time() + stand_every_;
    return {};
  }

  model::Simulated go() {
    const auto begin = std::chrono::steady_clock::now();
    while (!ended_ && world_->time() < end_time_ - slack()) {
      advance();
      if (!ended_) stand();
    }
    if (!ended_) run_.outcome.ending = Ending::reached_end;
    run_.outcome.t = world_->time();
    if (!ended_) stand(true);
    note({.kind = Note::Kind::finish, .t = world_->time(), .x = world_->state()});
    run_.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    run_.stop_text = events_.stop_text();
    if (log_) log_->add(RunEnd{run_.outcome, run_.stop_text, error_, run_.statistics});
    recorder_.give(run_);
    run_.checks = judge(program_->model, run_, recorder_);
    model::Simulated simulated;
    if (!succeeded(run_.outcome.ending))
      simulated.diagnostics.push_back(ending_of(program_->model, run_.outcome, error_));
    simulated.run = std::move(run_);
    return simulated;
  }

 private:
  void note(const Note& note) {
    if (log_) log_->add(note);
    tell(recorder_, note);
  }
  /// Writes a checkpoint, where one is due by the time of the run or by the clock.
  void stand(bool is_end = false) {
    const double t = world_->time();
    const auto now = std::chrono::steady_clock::now();
    if (!log_ || !(stand_every_ > 0) || (!is_end && t < next_checkpoint_ && now - stood_ < checkpoint_of_clock)) return;
    stood_ = now;
    log_->add({.world = world_->snapshot(),
               .next_output = next_output_,
               .next_sample = recorder_.samples_taken(),
               .contacts = contacts_,
               .stops = {events_.stops().begin(), events_.stops().end()}});
    next_checkpoint_ = t + stand_every_;
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

  void fail(Status status) {
    error_ = std::move(status.message);
    end(status.ending);
    run_.outcome.hint = error_;
  }

  /// Advances to the next instant with a row, a sample or an event.
  void advance() {
    if (recorder_.is_refused()) return end(Ending::stopped_by_callback);
    if (is_interrupted()) {
      stand(true);
      return end(Ending::interrupted);
    }
    double to = std::min({end_time_, next_row(), events_.next(*world_), recorder_.next_sample()});
    if ((watcher_ || !program_->always.empty()) && in_steps()) to = std::min(to, world_->time() + world_->step());
    if (watcher_) to = std::min(to, next_look());
    Status status = events_.advance(*world_, to);
    const bool has_hit = !world_->contacts().empty();
    note_contacts();
    if (watcher_) show_piece(has_hit);
    arrive();
    if (!status && is_interrupted()) return end(Ending::interrupted);
    if (status) status = events_.fire_due(*world_, sink());
    if (!status) return fail(std::move(status));
    end_where_stopped();
    if (experiment_.progress) experiment_.progress(world_->time());
  }

  double next_look() {
    for (; next_look_ < looks_.size() && looks_[next_look_] <= world_->time() + slack(); ++next_look_) {
    }
    return next_look_ < looks_.size() ? looks_[next_look_] : end_time_;
  }
  void show_piece(bool has_hit) {
    seen_.from = seen_.to;
    seen_.to = world_->time();
    seen_.start = std::move(seen_.end);
    seen_.end = world_->state();
    seen_.is_straight = has_hit || in_steps();
    watcher_->on_piece(seen_.to, [this](double t, X& x) {
      x.resize(seen_.end.size());
      seen_.at(program_->model, t, x);
    });
  }

  /// Notes the rows and samples that are due.
  void arrive() {
    const double t = world_->time() + slack();
    bool row = false;
    if (run_.plan.output == model::OutputPlan::Kind::steps && in_steps()) {
      row = true;
    } else {
      for (; next_row() <= t; ++next_output_) row = true;
    }
    note({.kind = Note::Kind::arrival,
          .t = world_->time(),
          .x = world_->state(),
          .is_row = row,
          .is_sampled = recorder_.next_sample() <= t,
          .until = t});
  }

  void note_contacts() {
    for (const Contact& contact : world_->contacts()) {
      if (contacts_ == contacts_of_a_run) return;
      ++contacts_;
      note({.kind = Note::Kind::contact,
            .t = contact.time,
            .name = world_->name_of(contact),
            .impulse = contact.impulse});
    }
  }

  WorldEvents::Sink sink() {
    return [this](const WorldEventOccurrence& now) {
      if (watcher_) {
        seen_.end = world_->state();
        watcher_->on_jump(now.t, now.before, seen_.end);
      }
      note({.kind = Note::Kind::event, .t = now.t, .x = world_->state(), .before = now.before, .names = now.names});
    };
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
  RunLog* log_;
  WorldEvents events_;
  model::OutputTimes times_;
  model::RunRecorder recorder_;
  model::Run run_{};
  std::size_t next_output_ = 0, contacts_ = 0;
  double end_time_ = 0, stand_every_ = 0, next_checkpoint_ = 0;
  std::chrono::steady_clock::time_point stood_ = std::chrono::steady_clock::now();
  bool ended_ = false;
  std::string error_;
  model::MotionWatcher* watcher_ = nullptr;
  std::vector<double> looks_;
  std::size_t next_look_ = 0;
  Flight seen_;  // the last piece
};

double look_of(const model::Plan& plan) {
  return (plan.to - plan.from) / looks;
}

/// Whether a note can belong to this model: it has as many states.
bool fits(const model::Model& model, const Note& note) {
  if (note.kind == Note::Kind::contact) return true;
  return note.x.size() == model.states.size() &&
         (note.kind != Note::Kind::event || note.before.size() == model.states.size());
}
Diagnostic does_not_fit(const model::Model& model, std::string_view why) {
  return model::error("E325", model.world->span, "the recording does not fit its model", std::string(why));
}

}  // namespace

model::Simulated simulate_world(const std::shared_ptr<const model::ModelProgram>& program,
                                const model::Experiment& experiment, RunLog* log) {
  return simulate_world(program, experiment, log, {});
}

model::Simulated simulate_world(const std::shared_ptr<const model::ModelProgram>& program,
                                const model::Experiment& experiment, RunLog* log, const model::OnRow& on_row) {
  model::Simulated simulated;
  PreparedWorld prepared = prepare_world(program, experiment, simulated.diagnostics);
  if (!prepared.world) return simulated;
  const double look = look_of(*prepared.plan);
  Simulation simulation(program, experiment, std::move(*prepared.plan), std::move(prepared.world), look, log, on_row);
  simulation.begin();
  simulated = simulation.go();
  const Ending ending = simulated.run->outcome.ending;
  if (experiment.estimate_error && succeeded(ending) && ending != Ending::stopped_by_callback)
    simulated.run->error = estimate_error(program, experiment, *simulated.run, [&](model::Experiment strict) {
      strict.atol.clear();  // bodies have a relative one only
      return simulate_world(program, strict);
    });
  return simulated;
}

bool show_world(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
                const model::Run& run, model::MotionWatcher& watcher) {
  constexpr double longest = 20;  // seconds
  constexpr double same = 1e-6;   // of the size of a state
  if (run.statistics.seconds > longest || run.motion.rows() == 0) return false;
  model::Experiment again = experiment;
  again.estimate_error = again.doubts = again.keep_rows = false;
  again.progress = {};
  std::vector<Diagnostic> problems;
  PreparedWorld prepared = prepare_world(program, again, problems);
  if (!prepared.world) return false;
  std::vector<double> contacts;
  for (const model::RecordedEvent& event : run.events)
    if (event.is_contact()) contacts.push_back(event.t);
  prepared.plan->to = std::min(prepared.plan->to, run.outcome.t);
  const double look = look_of(run.plan);
  auto times = looks_at(prepared.plan->from, prepared.plan->to, contacts);
  Simulation simulation(program, again, std::move(*prepared.plan), std::move(prepared.world), look, nullptr);
  simulation.show_to(watcher, std::move(times));
  simulation.begin();
  const model::Simulated simulated = simulation.go();
  const auto last = run.final_state(), seen = simulated.run->final_state();
  for (std::size_t i = 0; i < last.size(); ++i)
    if (!(std::abs(seen[i] - last[i]) <= same * (1 + std::abs(last[i])))) return false;
  return true;
}

model::Simulated resume_world(const std::shared_ptr<const model::ModelProgram>& program, const RunRecording& recording,
                              std::size_t checkpoint, const GoOn& how, RunLog* log) {
  model::Simulated simulated;
  model::Experiment experiment = recording.head.experiment;
  const auto as_recorded = plan_world(program->model, experiment, simulated.diagnostics);
  if (!as_recorded) return simulated;
  experiment.keep_rows = how.rows.keep_rows;
  experiment.interrupt = how.interrupt;
  experiment.progress = how.progress;
  if (how.to) experiment.to = how.to;
  PreparedWorld prepared = prepare_world(program, experiment, simulated.diagnostics);
  if (!prepared.world) return simulated;
  if (!std::ranges::all_of(recording.notes, [&](const Note& note) { return fits(program->model, note); })) {
    simulated.diagnostics.push_back(does_not_fit(program->model, "it has other states"));
    return simulated;
  }
  Simulation simulation(program, experiment, std::move(*prepared.plan), std::move(prepared.world),
                        look_of(*as_recorded), log, how.rows.on_row);
  if (const Status status = simulation.resume(recording, checkpoint); !status) {
    simulated.diagnostics.push_back(does_not_fit(program->model, status.message));
    return simulated;
  }
  return simulation.go();
}

model::Simulated replay_world(const std::shared_ptr<const model::ModelProgram>& program, const RunRecording& recording,
                              const model::RowsOfRecording& rows) {
  model::Simulated simulated;
  const model::Model& model = program->model;
  auto planned = plan_world(model, recording.head.experiment, simulated.diagnostics);
  if (!planned) return simulated;
  model::RunRecorder recorder(*program, as_the_recorder_sees(*planned), rows.keep_rows, sample_times(model, *planned),
                              program->always, rows.on_row);
  for (const Note& note : recording.notes) {
    if (!fits(model, note)) {
      simulated.diagnostics.push_back(does_not_fit(model, "it has other states"));
      return simulated;
    }
    tell(recorder, note);
  }
  model::Run run{};
  run.plan = std::move(*planned);
  if (recording.end) {
    run.outcome = recording.end->outcome;
    run.stop_text = recording.end->stop_text;
    run.statistics = recording.end->statistics;
  } else {
    run.outcome.ending = Ending::interrupted;
    run.outcome.t = recording.notes.back().t;
  }
  recorder.give(run);
  run.checks = judge(model, run, recorder);
  if (!succeeded(run.outcome.ending))
    simulated.diagnostics.push_back(
        ending_of(model, run.outcome, recording.end ? recording.end->error : std::string()));
  simulated.run = std::move(run);
  return simulated;
}

}  // namespace continuo::worlds
