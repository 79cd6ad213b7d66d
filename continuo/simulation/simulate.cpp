// continuo/simulation/simulate.cpp
// Plans and integrates a model, evaluates its checks and estimates its error.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <continuo/simulation/drive/error_estimate.hpp>
#include <continuo/simulation/drive/integrate.hpp>
#include <continuo/simulation/drive/run_checks.hpp>
#include <continuo/simulation/drive/run_recorder.hpp>
#include <continuo/simulation/integration_recording.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model {

namespace {

Options<ModelSystem::X> options_of(const Plan& plan, const Experiment& experiment) {
  Options<ModelSystem::X> options{.rtol = plan.rtol, .atol = plan.atol.front()};
  const std::size_t n = std::max(plan.atol.size(), plan.rtol_each.size());
  if (n > 1) {
    for (std::size_t i = 0; i < n; ++i) {
      options.rtol_each.push_back(plan.rtol_of(i));
      options.atol_each.push_back(plan.atol_of(i));
    }
  }
  options.step = plan.step;
  options.max_step = std::min(plan.max_step, experiment.max_step.value_or(plan.max_step));
  options.max_steps = experiment.max_steps.value_or(plan.max_steps);
  options.interrupt = experiment.interrupt;
  options.progress = experiment.progress;
  return options;
}

void place_step_inputs(const ModelProgram& program, Plan& plan) {
  for (const TableInput& input : program.step_inputs) plan.variables[input.variable] = input.table.value(plan.from);
}

bool is_positive_period(const Model& model, const Plan& plan, std::vector<Diagnostic>& problems) {
  for (const Scheduled& scheduled : model.schedule) {
    if (scheduled.kind != Scheduled::Kind::every) continue;
    const double period = evaluate(model, scheduled.time->node, plan.variables);
    if (period > 0) continue;
    problems.push_back(error("E333", scheduled.span, fmt::format("`every` needs a positive interval, not {}", period)));
    return false;
  }
  return true;
}

}  // namespace

std::optional<Plan> plan_run(const ModelProgram& program, const Experiment& experiment,
                             std::vector<Diagnostic>& problems) {
  auto planned = plan(program.model, experiment, problems);
  if (!planned || !is_positive_period(program.model, *planned, problems)) return std::nullopt;
  place_step_inputs(program, *planned);
  return planned;
}

Integration integration_of(const std::shared_ptr<const ModelProgram>& program, const Plan& plan,
                           const Experiment& experiment) {
  const Model& model = program->model;
  const auto first = plan.variables.begin() + model.layout.states;
  ModelSystem system(program, plan.variables);
  ModelSystem::X x0(first, first + static_cast<std::ptrdiff_t>(model.states.size()));
  system.hold_switches(plan.from, x0);
  return {std::move(system), std::move(x0), options_of(plan, experiment),
          ModelEvents(*program, plan.variables, plan.from, true)};
}

namespace {

RunRecorder recorder_of(const ModelProgram& program, const Plan& plan, const Experiment& experiment,
                        const OnRow& on_row = {}) {
  return {program, plan, experiment.keep_rows, sample_times(program.model, plan), program.always, on_row};
}

/// The run that the recorder has watched, judged; its end goes into the log.
Simulated judged(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment, Run run,
                 RunRecorder& recorder, IntegrationLog* log = nullptr) {
  Simulated simulated;
  RecordedPart rest = log ? recorder.part() : RecordedPart{};
  recorder.give(run);
  run.checks = judge(program->model, run, recorder);
  if (!succeeded(run.outcome.ending)) simulated.diagnostics.push_back(failure(*program, run));
  const bool is_whole = succeeded(run.outcome.ending) && !recorder.is_refused();
  if (experiment.estimate_error && is_whole) run.error = estimate_error(program, experiment, run);
  if (experiment.doubts && !run.error && is_whole) {
    const std::string doubt = doubt_of(program, experiment, run);
    if (!doubt.empty()) run.outcome.hint += (run.outcome.hint.empty() ? "" : "; ") + doubt;
  }
  if (log) log->add({std::move(rest), {run.outcome, run.stop_text, {}, run.statistics}});
  simulated.run = std::move(run);
  return simulated;
}

Simulated does_not_fit(const Model& model, std::string why) {
  return {.run = {},
          .diagnostics = {error("E325", model.run.span, "the recording does not fit its model", std::move(why))}};
}

}  // namespace

Simulated simulate(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment) {
  return simulate(program, experiment, {});
}

Simulated simulate(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                   const Followers& followers) {
  Simulated simulated;
  auto planned = plan_run(*program, experiment, simulated.diagnostics);
  if (!planned) return simulated;
  Run run;
  run.plan = std::move(*planned);
  RunRecorder recorder = recorder_of(*program, run.plan, experiment, followers.on_row);
  integrate(run.plan.method, integration_of(program, run.plan, experiment), recorder, run, followers);
  return judged(program, experiment, std::move(run), recorder, followers.log);
}

Simulated replay_integration(const std::shared_ptr<const ModelProgram>& program, const IntegrationRecording& recording,
                             const RowsOfRecording& rows) {
  Simulated simulated;
  Experiment experiment = recording.head.experiment;
  experiment.keep_rows = rows.keep_rows;
  experiment.doubts = experiment.estimate_error = false;  // what was found then stands in the recording
  auto planned = plan_run(*program, experiment, simulated.diagnostics);
  if (!planned) return simulated;
  Run run;
  run.plan = std::move(*planned);
  RunRecorder recorder = recorder_of(*program, run.plan, experiment, rows.on_row);
  bool fits = true;
  for (const IntegrationCheckpoint& checkpoint : recording.checkpoints) fits = fits && recorder.add(checkpoint.part);
  if (recording.end) fits = fits && recorder.add(recording.end->part);
  if (!fits) return does_not_fit(program->model, "it has other states");
  if (recording.end) {
    run.outcome = recording.end->end.outcome;
    run.stop_text = recording.end->end.stop_text;
    run.statistics = recording.end->end.statistics;
  } else {
    run.outcome.ending = Ending::interrupted;
    run.outcome.t = recording.checkpoints.back().t;
  }
  return judged(program, experiment, std::move(run), recorder);
}

Simulated resume_integration(const std::shared_ptr<const ModelProgram>& program, const IntegrationRecording& recording,
                             std::size_t checkpoint, const ResumeOptions& how, IntegrationLog* log) {
  Simulated simulated;
  Experiment experiment = recording.head.experiment;
  experiment.keep_rows = how.rows.keep_rows;
  experiment.interrupt = how.interrupt;
  experiment.progress = how.progress;
  if (how.to) experiment.to = how.to;
  if (how.max_steps) experiment.max_steps = how.max_steps;
  auto planned = plan_run(*program, experiment, simulated.diagnostics);
  if (!planned) return simulated;
  Run run;
  run.plan = std::move(*planned);
  RunRecorder recorder = recorder_of(*program, run.plan, experiment, how.rows.on_row);
  for (std::size_t k = 0; k <= checkpoint; ++k) {
    if (!recorder.add(recording.checkpoints[k].part)) return does_not_fit(program->model, "it has other states");
    if (log) log->add(recording.checkpoints[k]);
  }
  if (!integrate_from(recording.checkpoints[checkpoint], integration_of(program, run.plan, experiment), recorder, run,
                      log))
    return does_not_fit(program->model, "its checkpoint is of another integration");
  return judged(program, experiment, std::move(run), recorder, log);
}

Simulated simulate(const Model& model, const Experiment& experiment) {
  return simulate(compile(model), experiment);
}

std::vector<std::vector<double>> values_along(const ModelProgram& program, const Run& run,
                                              std::span<const NodeId> nodes) {
  std::vector<std::vector<double>> columns(nodes.size());
  if (nodes.empty()) return columns;
  Evaluation evaluation(program.tape_of(nodes), run.plan.variables);
  for (std::size_t row = 0; row < run.motion.rows(); ++row) {
    const double t = run.motion.time(row);
    for (const TableInput& input : program.step_inputs) evaluation.set(input.variable, input.table.value(t));
    const std::vector<double> values = evaluation(t, run.motion.state(row));
    for (std::size_t k = 0; k < nodes.size(); ++k) columns[k].push_back(values[k]);
  }
  return columns;
}

}  // namespace continuo::model
