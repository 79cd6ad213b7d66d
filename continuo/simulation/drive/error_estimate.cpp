// continuo/simulation/drive/error_estimate.cpp
// Estimates the error of a run from a second run with stricter tolerances.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <continuo/simulation/drive/error_estimate.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::model {

namespace {

constexpr double usually_stricter = 100;
constexpr double least_rtol = 1e-14;  // below, rounding is larger than what is asked

bool same_times(const Motion& a, const Motion& b) {
  if (a.rows() != b.rows()) return false;
  for (std::size_t row = 0; row < a.rows(); ++row) {
    // Events move by what is to be measured.
    if (std::abs(a.time(row) - b.time(row)) > 1e-6 * std::abs(a.time(row))) return false;
  }
  return true;
}

/// The experiment with the method of the run and its tolerances, `stricter` times as strict.
Experiment stricter_run(const Experiment& experiment, const Run& run, double stricter) {
  Experiment strict = experiment;
  strict.estimate_error = strict.doubts = false;
  strict.method = run.plan.method;
  if (run.plan.step > 0) return strict;
  strict.rtol = std::max(run.plan.rtol / stricter, least_rtol);
  strict.rtol_of.clear();
  for (std::size_t i = 0; i < run.plan.rtol_each.size(); ++i)
    strict.rtol_of[run.motion.columns[i + 1].name] = std::max(run.plan.rtol_each[i] / stricter, least_rtol);
  strict.atol.clear();
  for (const double atol : run.plan.atol) strict.atol.push_back(atol / stricter);
  strict.atol_of.clear();
  return strict;
}

/// A run of a model that depends on time steps no further than a fiftieth of its length, which may be all that held its
/// steps.
double half_of_longest(const Plan& plan) {
  return std::min(plan.max_step, std::abs(plan.to - plan.from) / 100);
}

std::vector<double> differences(std::span<const double> a, std::span<const double> b, double factor) {
  std::vector<double> result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = factor * std::abs(a[i] - b[i]);
  return result;
}

}  // namespace

ErrorEstimate estimate_error(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                             const Run& run, const RunAgain& again) {
  ErrorEstimate estimate;
  Experiment strict = stricter_run(experiment, run, usually_stricter);
  double factor = 1;
  if (run.plan.step > 0) {
    strict.step = run.plan.step / 2;
    if (!again) {
      const double power = std::exp2(find_method(run.plan.method)->order);
      factor = power / (power - 1);
    }
  }
  if (!again && !(run.plan.step > 0)) strict.max_step = half_of_longest(run.plan);
  if (!again)
    strict.max_steps = std::max(run.plan.max_steps, usual_max_steps);  // a limit of the run's is none of its estimate's
  const Simulated second = again ? again(strict) : simulate(program, strict);
  if (!second.run || second.run->outcome.ending != run.outcome.ending) {
    estimate.message = second.run ? describe(second.run->outcome) : "the second run could not begin";
    return estimate;
  }
  if (std::abs(second.run->final_time() - run.final_time()) > 1e-6 * std::abs(run.final_time())) {
    estimate.message = fmt::format("the second run ended at t = {}", second.run->final_time());
    return estimate;
  }
  estimate.at_end = differences(run.final_state(), second.run->final_state(), factor);
  if (!same_times(run.motion, second.run->motion)) return estimate;
  estimate.largest = estimate.at_end;
  for (std::size_t row = 0; row < run.motion.rows(); ++row) {
    const auto here = differences(run.motion.state(row), second.run->motion.state(row), factor);
    for (std::size_t i = 0; i < here.size(); ++i) estimate.largest[i] = std::max(estimate.largest[i], here[i]);
  }
  return estimate;
}

namespace {

/// The second run that shows errors of the first. None where it takes many times the steps that its order lets expect:
/// a method that damps what it does not resolve may need any number of steps to resolve it.
std::optional<Run> second_run(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                              const Run& run, double stricter) {
  Experiment strict = stricter_run(experiment, run, stricter);
  strict.max_step = half_of_longest(run.plan);
  strict.keep_rows = false;
  strict.progress = {};
  constexpr double most_times = 20;
  const double expected = std::pow(stricter, 1.0 / find_method(run.plan.method)->order);
  const auto steps = static_cast<double>(run.statistics.steps + run.statistics.rejected);
  strict.max_steps = 1000 + static_cast<std::size_t>(std::min(4 * expected, most_times) * steps);
  Simulated second = simulate(program, strict);
  if (!second.run || second.run->outcome.ending == Ending::too_many_steps) return std::nullopt;
  return std::move(*second.run);
}

}  // namespace

std::string doubt_of(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment, const Run& run) {
  // The second run may have a third of the error of the first one: beyond thirty tolerances they differ by twenty.
  constexpr double most_work = 1e7, most_tolerances = 20;
  const std::span<const double> end = run.final_state();
  const double work = static_cast<double>(run.statistics.evaluations) * static_cast<double>(end.size());
  if (run.plan.step > 0 || work > most_work || run.plan.rtol < 10 * least_rtol) return {};
  std::string_view how = "a hundred times as strict";
  std::optional<Run> second = second_run(program, experiment, run, usually_stricter);
  // Where rounding holds its steps, the run that is only ten times as strict still shows what adds up.
  if (!second) {
    second = second_run(program, experiment, run, 10);
    how = "ten times as strict";
  }
  if (!second || second->outcome.ending == Ending::interrupted) return {};
  if (second->outcome.ending != run.outcome.ending)
    return fmt::format("a second run, {}, ends otherwise: {}", how, describe(second->outcome));
  if (std::abs(second->final_time() - run.final_time()) > 1e-3 * std::abs(run.final_time()))
    return fmt::format("a second run, {}, ends at t = {:.6g}", how, second->final_time());
  std::size_t worst = 0;
  double most = 0, error = 0;
  for (std::size_t i = 0; i < end.size(); ++i) {
    const double here = std::abs(end[i] - second->final_state()[i]);
    const double tolerances = here / (run.plan.atol_of(i) + run.plan.rtol_of(i) * std::abs(end[i]));
    if (tolerances > most) most = tolerances, error = here, worst = i;
  }
  if (most <= most_tolerances) return {};
  return fmt::format(
      "the error of `{}` at the end is about {:.1g}, {:.1g} times its tolerance, compared with a run {}: errors of "
      "steps have accumulated, or the motion amplifies them; see --estimate-error",
      program->model.states[worst].column, error, most, how);
}

}  // namespace continuo::model
