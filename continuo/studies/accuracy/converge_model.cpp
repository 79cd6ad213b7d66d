// Poses the study of convergence for a model: its equations, or whole runs of it.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/world.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/methods.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/of_model.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/studies/compare.hpp>
#include <continuo/studies/converge.hpp>

namespace continuo::studies {

namespace {

/// The model's equations in numbers of any length; exact derivatives, rounded to double where those are longer.
template <class Real>
NamedSystem<Real> equations(const model::ModelProgram& program, const ParametricSystem& in_double,
                            const std::vector<double>& variables) {
  const auto tape = program.derivatives.front();
  std::vector<Real> registers(tape->register_count());
  std::ranges::transform(variables, registers.begin(), [](double value) { return static_cast<Real>(value); });
  tape->prepare<Real>(registers);
  NamedSystem<Real> system{.size = program.model.states.size()};
  system.derivative = [tape, registers, first = program.model.layout.states](Real t, std::span<const Real> x,
                                                                             std::span<Real> dxdt) mutable {
    registers[model::Layout::time] = t;
    std::ranges::copy(x, registers.begin() + first);
    tape->evaluate<Real>(registers, dxdt);
  };
  system.given_jacobian = [in_double](Real t, std::span<const Real> x, std::span<Real> rows) {
    const std::vector<double> state(x.begin(), x.end());
    const auto exact = jacobian_of(in_double, static_cast<double>(t), state, in_double.constants);
    std::ranges::transform(exact, rows.begin(), [](double value) { return static_cast<Real>(value); });
  };
  system.pairs = program.model.pairs;
  system.velocity_free = !program.model.accelerations_depend_on_velocities;
  system.name = [in_double](std::size_t i) { return in_double.name(i); };
  return system;
}

/// Points of a model that is more than equations: by the comparison of whole runs.
MethodConvergence by_comparison(const model::Model& model, const std::string& method,
                                std::span<const Contender> contenders, bool by_tolerance) {
  MethodConvergence result{.method = method};
  if (!by_tolerance) result.nominal = runs::order_of_fixed_steps(model, method);
  std::vector<double> steps, global, energy;
  for (const Contender& contender : contenders) {
    if (contender.method != method) continue;
    if (!contender.simulated.run) {
      result.status = invalid_input(
          contender.simulated.diagnostics.empty() ? "cannot run it" : contender.simulated.diagnostics.front().message);
      continue;
    }
    const model::Run& run = *contender.simulated.run;
    const bool ended = succeeded(run.outcome.ending);
    if (!contender.step && !contender.tolerance) {
      result.status = invalid_input("it has no step to make smaller");
      continue;
    }
    const double step = contender.step ? *contender.step : contender.tolerance.value_or(not_measured);
    result.points.push_back({.step = step,
                             .global = ended ? contender.largest_error : not_measured,
                             .local = not_measured,
                             .energy = ended && run.energy ? run.energy->drift : not_measured,
                             .in_float = not_measured,
                             .in_long_double = not_measured,
                             .evaluations = run.statistics.evaluations,
                             .seconds = run.statistics.seconds});
    steps.push_back(step);
    global.push_back(result.points.back().global);
    energy.push_back(result.points.back().energy);
  }
  result.global = read_errors(steps, global);
  result.energy = read_errors(steps, energy);
  return result;
}

std::string name_of_reference(const model::Model& model) {
  if (runs::kind_of(model).solver != runs::Solver::world) return "a strict run";
  return model.world->is_moved_fast() ? "the fast motion in steps of a sixteenth" : "the exact motion";
}

Result<Convergence> compare_runs(const std::shared_ptr<const model::ModelProgram>& program,
                                 model::Experiment experiment, Interval<double> interval,
                                 const ConvergeRequest& request) {
  Convergence result{.by_tolerance = !request.tolerances.empty(), .reference = name_of_reference(program->model)};
  experiment.interrupt = request.interrupt;
  CompareRequest compared{.methods = {}, .tolerances = request.tolerances, .experiment = std::move(experiment)};
  if (request.tolerances.empty())
    for (std::size_t steps = 16; steps <= request.most_steps; steps *= 2)
      compared.steps.push_back(std::abs(interval.to - interval.from) / static_cast<double>(steps));
  for (std::size_t i = 0; i < request.methods.size(); ++i) {
    compared.methods = {request.methods[i]};
    const Comparison comparison = compare(program, compared);
    if (!comparison.reference.run || !succeeded(comparison.reference.run->outcome.ending)) {
      const auto& problems = comparison.reference.diagnostics;
      return Status{
          .ending = comparison.reference.run ? comparison.reference.run->outcome.ending : Ending::invalid_input,
          .message = problems.empty() ? "there is no reference run" : problems.front().message};
    }
    result.methods.push_back(
        by_comparison(program->model, request.methods[i], comparison.contenders, result.by_tolerance));
    if (request.progress) request.progress(static_cast<double>(i + 1) / static_cast<double>(request.methods.size()));
    if (request.interrupt != nullptr && request.interrupt->load()) {
      result.interrupted = true;
      break;
    }
  }
  return result;
}

/// Orders are measured to a few hundredths; what is missing more is not there.
bool falls_short(const MethodConvergence& method) {
  constexpr double missing = 0.25;
  return method.nominal > 0 && method.status && method.global.found && method.global.order < method.nominal - missing;
}

/// Looks for it along a strict run, in rows two thousandths of it apart at most.
std::optional<SpoiledOrder> spoiled_order(const std::shared_ptr<const model::ModelProgram>& program,
                                          model::Experiment experiment, Interval<double> interval,
                                          const Convergence& study) {
  if (study.interrupted || std::ranges::none_of(study.methods, falls_short)) return std::nullopt;
  experiment.method.reset();
  experiment.step.reset();
  experiment.rtol = 1e-9;
  experiment.output = std::abs(interval.to - interval.from) / 2000;
  experiment.progress = {};
  const model::Simulated simulated = model::simulate(program, experiment);
  if (!simulated.run) return std::nullopt;
  SpoiledOrder spoiled{.kinks = kinks_along(*program, *simulated.run), .events = simulated.run->events.size()};
  if (spoiled.events > 0) spoiled.first_event = simulated.run->events.front().t;
  if (spoiled.kinks.empty() && spoiled.events == 0) return std::nullopt;
  return spoiled;
}

}  // namespace

std::optional<ConvergenceProblem> convergence_problem(const std::shared_ptr<const model::ModelProgram>& program,
                                                      const model::Overrides& parameters, Interval<double> interval) {
  const model::Model& model = program->model;
  if (runs::kind_of(model).solver != runs::Solver::integration || model.needs_dae_solver() || !model.events.empty() ||
      !model.schedule.empty() || !program->step_inputs.empty() || model.modes.size() > 1)
    return std::nullopt;
  const std::vector<double> variables = model::start_values(model, parameters, interval.from);
  const ParametricSystem exact = of_model(program, {.parameters = parameters});
  ConvergenceProblem problem{.system = equations<double>(*program, exact, variables),
                             .in_float = equations<float>(*program, exact, variables),
                             .in_long_double = equations<long double>(*program, exact, variables),
                             .x0 = start_of(model, parameters),
                             .interval = interval};
  if (model.total_energy.valid()) {
    const std::vector<model::NodeId> nodes{model.total_energy};
    problem.energy = [energy = model::Evaluation(program->tape_of(nodes), variables)](
                         double t, std::span<const double> x) mutable { return energy(t, x).front(); };
  }
  return problem;
}

Result<Convergence> converge(const std::shared_ptr<const model::ModelProgram>& program,
                             const model::Experiment& experiment, const ConvergeRequest& request) {
  const runs::Kind kind = runs::kind_of(program->model);
  std::vector<model::Diagnostic> problems;
  const auto plan = runs::plan(program->model, experiment, problems);
  if (!plan || !kind.has_start)
    return invalid_input(problems.empty()
                             ? "the model's conditions stand at several times: it has no run from the start"
                             : problems.front().message);
  const Interval<double> interval{plan->from, plan->to};
  const auto problem = interval.to > interval.from ? convergence_problem(program, experiment.parameters, interval)
                                                   : std::optional<ConvergenceProblem>();
  Result<Convergence> study =
      problem ? converge(*problem, request) : compare_runs(program, experiment, interval, request);
  if (kind.solver == runs::Solver::integration && study)
    study->spoiled = spoiled_order(program, experiment, interval, *study);
  return study;
}

}  // namespace continuo::studies
