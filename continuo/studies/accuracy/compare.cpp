// Runs the contenders and the reference, and compares their rows.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/world.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/methods.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/studies/compare.hpp>

namespace continuo::studies {
namespace {

constexpr double grid_intervals = 500;  // rows where the model asks for steps: the same times for all

/// Rows must stand at the same times for all. Bodies that are moved in steps have theirs at the ends of steps: at
/// multiples of the longest.
model::Experiment with_common_rows(const model::ModelProgram& program, const CompareRequest& request) {
  std::vector<model::Diagnostic> problems;
  model::Experiment experiment = request.experiment;
  if (!runs::kind_of(program.model).has_rows_at_any_time) {
    std::vector<double> steps = request.steps;
    if (steps.empty()) {
      experiment.method = "fast";
      const auto fast = runs::plan(program.model, experiment, problems);
      if (fast) steps.push_back(fast->step);
    }
    experiment.method = runs::reference_method(program.model, false);
    if (experiment.method == "fast" && !steps.empty()) experiment.step = steps.front();
    const auto plan = runs::plan(program.model, experiment, problems);
    if (!plan || steps.empty()) return experiment;
    const double longest = std::ranges::max(steps), wanted = (plan->to - plan->from) / grid_intervals;
    experiment.output = longest * std::max(1.0, std::round(wanted / longest));
    return experiment;
  }
  const auto plan = runs::plan(program.model, experiment, problems);
  if (plan && plan->output == model::OutputPlan::Kind::steps) {
    experiment.output = std::abs(plan->to - plan->from) / grid_intervals;
  }
  return experiment;
}

std::string_view reference_method(const model::ModelProgram& program, const CompareRequest& request) {
  const auto is_implicit = [](std::string_view name) {
    const MethodInfo* info = find_method(name);
    return info != nullptr && info->implicit;
  };
  return runs::reference_method(program.model, std::ranges::any_of(request.methods, is_implicit));
}

/// A sixteenth of the smallest step, for bodies that only a motion in steps moves; nothing where no step is known.
std::optional<double> step_of_reference(const model::ModelProgram& program, const CompareRequest& request,
                                        const model::Experiment& common) {
  if (!request.steps.empty()) return std::ranges::min(request.steps) / 16;
  std::vector<model::Diagnostic> problems;
  const auto plan = runs::plan(program.model, common, problems);
  return plan && plan->step > 0 ? std::optional(plan->step / 16) : std::nullopt;
}

/// Absolute tolerances as small against each state as the relative one; a model's own are kept where tighter.
model::Experiment for_reference(const runs::Kind& kind, model::Experiment experiment, std::string_view method) {
  experiment.method = method;
  experiment.rtol = reference_rtol;
  experiment.step.reset();
  experiment.atol.clear();
  if (kind.has_absolute_tolerances) experiment.atol = {reference_rtol};
  experiment.rtol_of.clear();
  experiment.atol_of.clear();
  return experiment;
}

/// Places are measured by the largest of all bodies, velocities too, ...; what the world tells of itself is no state.
void share_sizes(const model::Model& model, std::vector<double>& sizes) {
  std::map<std::pair<std::string_view, int>, double> largest;
  const auto kind_of = [](const model::State& state) {
    const std::string_view member = std::string_view(state.base).substr(state.base.rfind('.') + 1);
    return std::pair(member.size() == 1 ? std::string_view("place") : member.substr(0, 4), state.primes);
  };
  const std::size_t bodies = model.world->body_states();
  for (std::size_t i = 0; i < bodies; ++i) {
    double& size = largest[kind_of(model.states[i])];
    size = std::max(size, sizes[i]);
  }
  for (std::size_t i = 0; i < bodies; ++i) sizes[i] = largest[kind_of(model.states[i])];
  std::fill(sizes.begin() + static_cast<std::ptrdiff_t>(model.world->first_measure), sizes.end(),
            std::numeric_limits<double>::infinity());
}

/// The largest absolute value of each state.
std::vector<double> sizes_of(const model::Motion& motion) {
  std::vector<double> sizes(motion.states, 0.0);
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const auto state = motion.state(row);
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = std::max(sizes[i], std::abs(state[i]));
  }
  return sizes;
}

double error_between(std::span<const double> x, std::span<const double> exact, std::span<const double> sizes) {
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double size = sizes[i] > 0 ? sizes[i] : 1;
    const double error = std::abs(x[i] - exact[i]) / size;
    worst = error > worst || std::isnan(error) ? error : worst;
  }
  return worst;
}

/// Errors at the times that stand in both runs. Output times are the same numbers in both (of bodies to rounding: ends
/// of steps); those of events differ by their error and are passed over. Of equal times, the last row: the state after
/// an event.
void judge(const model::Model& model, const model::Motion& reference, Contender& contender) {
  auto sizes = sizes_of(reference);
  const runs::Kind kind = runs::kind_of(model);
  if (kind.solver == runs::Solver::world) share_sizes(model, sizes);
  const double last = reference.time(reference.rows() - 1);
  const double slack = kind.has_rows_at_any_time ? 0 : 1e-12 * std::max(std::abs(last), std::abs(reference.time(0)));
  const model::Motion& motion = contender.simulated.run->motion;
  for (std::size_t i = 0, j = 0; i < motion.rows(); ++i) {
    const double t = motion.time(i);
    if (i + 1 < motion.rows() && motion.time(i + 1) == t) continue;
    while (j < reference.rows() && reference.time(j) < t - slack) ++j;
    while (j + 1 < reference.rows() && reference.time(j + 1) <= t + slack) ++j;
    if (j == reference.rows() || std::abs(reference.time(j) - t) > slack) continue;
    contender.times.push_back(t);
    contender.errors.push_back(error_between(motion.state(i), reference.state(j), sizes));
  }
  contender.final_error = contender.errors.empty() ? std::nan("") : contender.errors.back();
  contender.largest_error = contender.errors.empty() ? std::nan("") : std::ranges::max(contender.errors);
}

Contender contend(const std::shared_ptr<const model::ModelProgram>& program, const model::Motion& reference,
                  model::Experiment experiment) {
  Contender contender{.method = *experiment.method,
                      .step = experiment.step,
                      .tolerance = experiment.rtol,
                      .simulated = runs::run(program, experiment, {.from_start = true}),
                      .final_error = std::nan(""),
                      .largest_error = std::nan(""),
                      .times = {},
                      .errors = {}};
  if (contender.simulated.run) judge(program->model, reference, contender);
  return contender;
}

}  // namespace

std::string Contender::label() const {
  if (step) return fmt::format("{}, h = {}", method, *step);
  return tolerance ? fmt::format("{}, tol = {}", method, *tolerance) : method;
}

Comparison compare(const std::shared_ptr<const model::ModelProgram>& program, const CompareRequest& request) {
  const model::Experiment common = with_common_rows(*program, request);
  const runs::Kind kind = runs::kind_of(program->model);
  const std::string_view method = reference_method(*program, request);
  model::Experiment strict = for_reference(kind, common, method);
  if (method == "fast") strict.step = step_of_reference(*program, request, common);
  Comparison comparison{.reference = runs::run(program, strict, {.from_start = true}), .contenders = {}};
  if (!comparison.reference.run || !succeeded(comparison.reference.run->outcome.ending)) return comparison;

  const model::Motion& motion = comparison.reference.run->motion;
  for (const std::string& name : request.methods) {
    model::Experiment experiment = common;
    experiment.method = name;
    const bool stepless = runs::has_no_step(kind, name);
    if (stepless || (request.steps.empty() && request.tolerances.empty())) {
      comparison.contenders.push_back(contend(program, motion, experiment));
    }
    if (stepless) continue;
    for (const double step : request.steps) {
      experiment.step = step;
      experiment.rtol.reset();
      comparison.contenders.push_back(contend(program, motion, experiment));
    }
    for (const double tolerance : request.tolerances) {
      experiment.rtol = tolerance;
      experiment.step.reset();
      comparison.contenders.push_back(contend(program, motion, experiment));
    }
    if (common.interrupt != nullptr && common.interrupt->load()) break;
  }
  return comparison;
}

}  // namespace continuo::studies
