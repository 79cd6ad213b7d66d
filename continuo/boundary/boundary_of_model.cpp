// All solutions that the guesses of a model lead to, as runs, and their errors.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <continuo/boundary/boundary_continuation.hpp>
#include <continuo/boundary/boundary_of_model.hpp>
#include <continuo/boundary/boundary_problem_of_model.hpp>
#include <continuo/boundary/boundary_value.hpp>
#include <continuo/boundary/watched_boundary.hpp>
#include <continuo/simulation/run_along.hpp>

namespace continuo::boundary {

namespace {

using model::Experiment;
using model::Model;
using model::ModelProgram;
using model::Plan;

constexpr double stricter = 100;    // of the run that estimates the error
constexpr double same_part = 1000;  // solutions closer than so many tolerances are one

model::Run run_of(const ModelProgram& program, const Plan& plan, const BoundaryValueSolution& solution) {
  const std::span steps(solution.mesh);
  model::Run run = model::run_along(program, plan, steps, [&](double t, std::vector<double>& x) { solution.at(t, x); });
  run.statistics.steps = solution.mesh.size() - 1;
  run.statistics.evaluations = solution.evaluations;
  run.statistics.factorizations = run.statistics.jacobians = solution.iterations;
  return run;
}

/// The solution between the points of its mesh, as a motion that somebody watches.
void show(const Plan& plan, const BoundaryValueSolution& solution, model::MotionWatcher& watcher) {
  watcher.begin(plan, solution(plan.from));
  for (const double to : solution.mesh) {
    if (to > plan.from)
      watcher.on_piece(std::min(to, plan.to), [&](double t, std::vector<double>& x) { solution.at(t, x); });
  }
}

/// Largest difference of two solutions relative to the size of each component.
double distance(const BoundaryValueSolution& a, const BoundaryValueSolution& b) {
  std::vector<double> difference(a.size), size(a.size, 1e-300), x(a.size), y(a.size);
  for (const double t : a.mesh) {
    a.at(t, x);
    b.at(t, y);
    for (std::size_t i = 0; i < a.size; ++i) {
      difference[i] = std::max(difference[i], std::abs(x[i] - y[i]));
      size[i] = std::max(size[i], std::abs(x[i]));
    }
  }
  double worst = 0;
  for (std::size_t i = 0; i < a.size; ++i) worst = std::max(worst, difference[i] / size[i]);
  return worst;
}

/// By a stricter run. Where rounding keeps it from its tolerance, or there is none, by what the solutions estimate of
/// themselves.
model::ErrorEstimate error_of(const BoundaryValueProblem& problem, const BoundaryValueSolution& solution,
                              const model::Run& run, BoundaryValueOptions options) {
  options.tolerance = std::max(options.tolerance / stricter, 1e-13);
  options.mesh = solution.mesh;
  const auto strict =
      solve_boundary_values(problem, [&](double t, std::span<double> x) { solution.at(t, x); }, options);
  model::ErrorEstimate estimate;
  if (strict.mesh.empty() || strict.outcome.ending == Ending::interrupted) {
    estimate.message = describe(strict.outcome);
    return estimate;
  }
  estimate.largest.assign(solution.size, 0);
  for (std::size_t row = 0; row < run.motion.rows(); ++row) {
    const auto x = strict(run.motion.time(row));
    estimate.at_end.assign(solution.size, 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      estimate.at_end[i] = std::abs(x[i] - run.motion.state(row)[i]);
      estimate.largest[i] = std::max(estimate.largest[i], estimate.at_end[i]);
    }
  }
  const std::vector<double>& own = strict.error.empty() ? solution.error : strict.error;
  for (std::size_t i = 0; i < own.size() && i < solution.size; ++i) estimate.largest[i] += own[i];
  return estimate;
}

/// The posed problem of each value of a parameter; the experiment of the last one is left in `experiment`.
class PosedAlong {
 public:
  PosedAlong(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment, std::string parameter)
      : program_(program), experiment_(experiment), parameter_(std::move(parameter)) {}

  std::optional<PosedBoundary> operator()(double value, std::vector<model::Diagnostic>& problems) {
    experiment_.parameters[parameter_] = value;
    return pose_boundary(program_, experiment_, problems);
  }

 private:
  std::shared_ptr<const ModelProgram> program_;
  Experiment experiment_;
  std::string parameter_;
};

/// All that is known of where the search begins.
struct Beginning {
  BoundaryValueGuess guess;
  std::vector<double> mesh;  // empty: none is better than another
};

constexpr std::size_t most_parameters = 6;      // that are tried to come to a solution along them
constexpr std::size_t most_steps_in_vain = 10;  // along one of them
constexpr std::size_t most_rows = 20'000;       // of a table of which the times make a mesh

std::optional<Beginning> beginning_of(const PosedBoundary& posed, const BoundaryRequest& request, std::size_t k,
                                      std::vector<model::Diagnostic>& problems) {
  if (!request.guess) return Beginning{guess_of(posed, k), {}};
  auto guess = guess_from(posed, *request.guess, problems);
  if (!guess) return std::nullopt;
  Beginning beginning{std::move(*guess), {}};
  if (request.guess->times.size() <= most_rows) beginning.mesh = request.guess->times;
  return beginning;
}

/// Where the search from a guess has failed, and slower motion has not led there: from other values of each parameter
/// that is a number of its own, by factors of ten, along to the one that is asked for. The first that gets there.
std::optional<BoundaryValueSolution> along_some_parameter(const std::shared_ptr<const ModelProgram>& program,
                                                          const Experiment& experiment, const PosedBoundary& posed,
                                                          const BoundaryRequest& request, std::size_t k) {
  const Model& model = program->model;
  std::vector<model::Diagnostic> ignored;
  std::size_t tried = 0;
  for (const model::Parameter& parameter : model.parameters) {
    const double value = posed.plan.variables[parameter.variable];
    if (!parameter.independent || parameter.structural || value == 0) continue;
    if (++tried > most_parameters) break;
    PosedAlong pose(program, experiment, parameter.name);
    std::size_t steps = 0;
    const auto problem = [&](double at) -> std::optional<BoundaryValueProblem> {
      const auto there = pose(at, ignored);
      return there ? std::optional(there->problem) : std::nullopt;
    };
    for (const double factor : {10.0, 0.1, 100.0, 0.01, 1e3, 1e-3, 1e4, 1e-4, 1e5, 1e-5, 1e6, 1e-6}) {
      if (experiment.interrupt && experiment.interrupt->load()) return std::nullopt;
      const auto first = pose(factor * value, ignored);
      if (!first) continue;
      const auto beginning = beginning_of(*first, request, k, ignored);
      if (!beginning) continue;
      FollowedSolution followed = follow_path({problem, factor * value, value}, beginning->guess, posed.options);
      // Where it is known there what holds it, other ways lead to the same place.
      if (followed.solution.outcome || followed.solution.failure == BoundaryValueFailure::rounding)
        return std::move(followed.solution);
      steps += followed.steps;
      if (steps > most_steps_in_vain) break;  // it is easy enough there, but the way does not go through
    }
  }
  return std::nullopt;
}

/// The solution that the k-th guess leads to; nothing where the request does not fit, for which `problems` has the
/// reason.
std::optional<BoundaryValueSolution> solution_of(const std::shared_ptr<const ModelProgram>& program,
                                                 const Experiment& experiment, const PosedBoundary& posed,
                                                 const BoundaryRequest& request, std::size_t k,
                                                 std::vector<model::Diagnostic>& problems) {
  BoundaryValueOptions options = posed.options;
  if (!request.along) {
    const auto beginning = beginning_of(posed, request, k, problems);
    if (!beginning) return std::nullopt;
    options.mesh = beginning->mesh;
    BoundaryValueSolution solution = solve_with_continuation(posed.problem, beginning->guess, options);
    if (!may_be_followed(posed.problem, solution)) return solution;
    auto followed = along_some_parameter(program, experiment, posed, request, k);
    return followed ? std::move(*followed) : std::move(solution);
  }
  const auto& [parameter, from, to] = *request.along;
  PosedAlong pose(program, experiment, parameter);
  const auto first = pose(from, problems);
  if (!first) return std::nullopt;
  const auto beginning = beginning_of(*first, request, k, problems);
  if (!beginning) return std::nullopt;
  options.mesh = beginning->mesh;
  const auto problem = [&](double value) -> std::optional<BoundaryValueProblem> {
    std::vector<model::Diagnostic> ignored;
    const auto there = pose(value, ignored);
    return there ? std::optional(there->problem) : std::nullopt;
  };
  FollowedSolution followed = follow_path({problem, from, to}, beginning->guess, options);
  if (!followed.solution.outcome && followed.solution.failure != BoundaryValueFailure::undetermined &&
      followed.reached != to) {
    std::string& hint = followed.solution.outcome.hint;
    hint = followed.steps == 0
               ? fmt::format("there is none for {} = {:g}, where the way begins; begin where it is easier", parameter,
                             from)
               : fmt::format(
                     "from {} = {:g} it could be followed to {:g}; --family {}=A..B shows whether it turns round there",
                     parameter, from, followed.reached, parameter);
  }
  return std::move(followed.solution);
}

}  // namespace

namespace {

/// `watcher`, who may be null, sees the solution that is asked for.
BoundaryRuns solve(const std::shared_ptr<const ModelProgram>& program, const Experiment& asked,
                   const BoundaryRequest& request, model::MotionWatcher* watcher) {
  BoundaryRuns result;
  const Model& model = program->model;
  Experiment experiment = asked;
  if (request.along) experiment.parameters[request.along->parameter] = request.along->to;
  auto posed = pose_boundary(program, experiment, result.diagnostics);
  if (!posed) return result;
  const Plan& plan = posed->plan;
  std::vector<BoundaryValueSolution> found;
  std::optional<BoundaryValueSolution> failure;
  result.guesses = request.guess ? 1 : guess_count(model);
  for (std::size_t k = 0; k < result.guesses; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    // A residual that falls as a power of the mesh goes its way in logarithms.
    if (experiment.progress)
      posed->options.progress = [&, first = 0.0](std::size_t, double residual) mutable {
        if (!(first > 0)) first = residual;
        const double way = std::log(first / plan.rtol), gone = std::log(first / residual);
        const double part = way > 0 && std::isfinite(gone) ? std::clamp(gone / way, 0.0, 1.0) : 0;
        experiment.progress((static_cast<double>(k) + part) / static_cast<double>(result.guesses));
      };
    auto solved = solution_of(program, experiment, *posed, request, k, result.diagnostics);
    if (!solved) return result;
    BoundaryValueSolution& solution = *solved;
    if (!solution.outcome) {
      const bool interrupted = solution.outcome.ending == Ending::interrupted;
      if (!failure) failure = std::move(solution);
      if (interrupted) break;
      continue;
    }
    const auto is_same = [&](const auto& other) { return distance(other, solution) < same_part * plan.rtol; };
    if (std::ranges::any_of(found, is_same)) continue;
    model::Run run = run_of(*program, plan, solution);
    run.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    run.outcome.hint = solution.outcome.hint;
    if (experiment.estimate_error) run.error = error_of(posed->problem, solution, run, posed->options);
    if (watcher && result.runs.size() + 1 == request.solution) show(run.plan, solution, *watcher);
    found.push_back(std::move(solution));
    result.runs.push_back(std::move(run));
  }
  if (result.runs.empty() && failure) result.diagnostics.push_back(boundary_failure(model, *failure));
  if (result.guesses > 1) {
    for (model::Run& run : result.runs)
      run.outcome.hint += fmt::format("{}{} guesses led to {} different solution{}",
                                      run.outcome.hint.empty() ? "" : "; ", result.guesses, result.runs.size(),
                                      result.runs.size() == 1 ? "" : "s (--solution N shows another)");
  }
  return result;
}

/// The one of them that is asked for, as a run.
model::Simulated asked_of(const ModelProgram& program, const BoundaryRequest& request, BoundaryRuns solved) {
  const std::size_t solution = request.solution;
  model::Simulated simulated{std::nullopt, std::move(solved.diagnostics)};
  if (solution - 1 < solved.runs.size()) {
    simulated.run = std::move(solved.runs[solution - 1]);
  } else if (!solved.runs.empty()) {
    simulated.diagnostics.push_back(
        model::error("E322", program.model.boundary.front().span,
                     fmt::format("there is no solution {}; {} found", solution,
                                 solved.runs.size() == 1 ? "one was" : fmt::format("{} were", solved.runs.size())),
                     {}, "another `guess x = ...` may lead to another solution"));
  }
  return simulated;
}

}  // namespace

BoundaryRuns solve_boundary(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                            const BoundaryRequest& request) {
  return solve(program, experiment, request, nullptr);
}

model::Simulated simulate_boundary(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                                   const BoundaryRequest& request) {
  return asked_of(*program, request, solve(program, experiment, request, nullptr));
}

model::Simulated simulate_boundary(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                                   const BoundaryRequest& request, model::MotionWatcher& watcher) {
  return asked_of(*program, request, solve(program, experiment, request, &watcher));
}

}  // namespace continuo::boundary
