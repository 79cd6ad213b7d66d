// continuo/studies/boundary_of_model.cpp
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <continuo/model/run_along.hpp>
#include <continuo/studies/boundary_of_model.hpp>
#include <continuo/studies/boundary_problem_of_model.hpp>
#include <continuo/studies/boundary_value.hpp>
#include <continuo/worlds/simulate_world.hpp>

namespace continuo::studies {

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
  run.statistics.decompositions = run.statistics.jacobians = solution.iterations;
  return run;
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

model::ErrorEstimate error_of(const BoundaryValueProblem& problem, const BoundaryValueSolution& solution,
                              const model::Run& run, BoundaryValueOptions options) {
  options.tolerance = std::max(options.tolerance / stricter, 1e-13);
  options.mesh = solution.mesh;
  const auto strict =
      solve_boundary_values(problem, [&](double t, std::span<double> x) { solution.at(t, x); }, options);
  model::ErrorEstimate estimate;
  if (!strict.outcome) {
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
  return estimate;
}

}  // namespace

BoundaryRuns solve_boundary(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment) {
  BoundaryRuns result;
  const Model& model = program->model;
  auto posed = detail::pose_boundary(program, experiment, result.diagnostics);
  if (!posed) return result;
  const Plan& plan = posed->plan;
  std::vector<BoundaryValueSolution> found;
  std::optional<Outcome<double>> failure;
  result.guesses = detail::guess_count(model);
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
    auto solution = detail::solve_from_guess(*posed, k);
    if (!solution.outcome) {
      if (!failure) failure = solution.outcome;
      if (solution.outcome.ending == Ending::interrupted) break;
      continue;
    }
    const auto is_same = [&](const auto& other) { return distance(other, solution) < same_part * plan.rtol; };
    if (std::ranges::any_of(found, is_same)) continue;
    model::Run run = run_of(*program, plan, solution);
    run.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (experiment.estimate_error) run.error = error_of(posed->problem, solution, run, posed->options);
    found.push_back(std::move(solution));
    result.runs.push_back(std::move(run));
  }
  if (result.runs.empty() && failure) result.diagnostics.push_back(detail::boundary_failure(model, *failure));
  if (result.guesses > 1) {
    for (model::Run& run : result.runs)
      run.outcome.hint = fmt::format("{} guesses led to {} different solution{}", result.guesses, result.runs.size(),
                                     result.runs.size() == 1 ? "" : "s (--solution N shows another)");
  }
  return result;
}

model::Simulated run_model(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                           std::size_t solution) {
  if (program->model.has_world()) return worlds::simulate_world(program, experiment);
  if (!program->model.needs_boundary_solver()) return model::simulate(program, experiment);
  BoundaryRuns solved = solve_boundary(program, experiment);
  model::Simulated simulated{std::nullopt, std::move(solved.diagnostics)};
  if (solution - 1 < solved.runs.size()) {
    simulated.run = std::move(solved.runs[solution - 1]);
  } else if (!solved.runs.empty()) {
    simulated.diagnostics.push_back(
        model::error("E322", program->model.boundary.front().span,
                     fmt::format("there is no solution {}; {} found", solution,
                                 solved.runs.size() == 1 ? "one was" : fmt::format("{} were", solved.runs.size())),
                     {}, "another `guess x = ...` may lead to another solution"));
  }
  return simulated;
}

}  // namespace continuo::studies
