// continuo/studies/boundary_of_model.cpp
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <continuo/model/evaluation.hpp>
#include <continuo/model/expression.hpp>
#include <continuo/model/run_along.hpp>
#include <continuo/studies/boundary_of_model.hpp>
#include <continuo/studies/boundary_value.hpp>
#include <continuo/studies/of_model.hpp>

namespace continuo::studies {

namespace {

using model::BoundaryCondition;
using model::Diagnostic;
using model::Experiment;
using model::Model;
using model::ModelProgram;
using model::NodeId;
using model::Plan;
using model::Sample;

constexpr double stricter = 100;    // of the run that estimates the error
constexpr double same_part = 1000;  // solutions closer than so many tolerances are one

/// The conditions as one function of x at the times that they name.
class Conditions {
 public:
  Conditions(const ModelProgram& program, const Plan& plan) : model_(program.model), n_(model_.states.size()) {
    const auto time_of = [&](const model::Setting& setting) {
      return std::clamp(evaluate(model_, setting.node, plan.variables), plan.from, plan.to);
    };
    times_ = {plan.from, plan.to};
    for (const BoundaryCondition& condition : model_.boundary) {
      times_.push_back(time_of(condition.time));
      for (const Sample& sample : condition.samples) times_.push_back(time_of(sample.when));
    }
    std::ranges::sort(times_);
    times_.erase(std::ranges::unique(times_).begin(), times_.end());
    const auto place_of = [&](double t) {
      return static_cast<std::size_t>(std::ranges::lower_bound(times_, t) - times_.begin());
    };
    const auto evaluation_of = [&](NodeId node) {
      return model::Evaluation(program.tape_of(std::span(&node, 1)), model_.layout, plan.variables);
    };
    for (const BoundaryCondition& condition : model_.boundary) {
      Condition& made = conditions_.emplace_back();
      made.column = place_of(time_of(condition.time)) * n_ + condition.state;
      made.value = evaluation_of(condition.value);
      for (const Sample& sample : condition.samples)
        made.samples.push_back({sample.variable, place_of(time_of(sample.when)), sample.of, evaluation_of(sample.of)});
    }
  }

  const std::vector<double>& times() const { return times_; }

  void operator()(Values x, std::span<double> residuals) {
    for (std::size_t i = 0; i < conditions_.size(); ++i) residuals[i] = x[conditions_[i].column] - value(i, x);
  }

  /// Which entries of the Jacobian may differ from zero.
  std::vector<MatrixPlace> places() const {
    std::vector<MatrixPlace> places;
    for (std::uint32_t i = 0; i < conditions_.size(); ++i) {
      places.push_back({i, static_cast<std::uint32_t>(conditions_[i].column)});
      for (const SampleAt& sample : conditions_[i].samples) {
        for (const std::uint32_t variable : variables_of(model_.graph, sample.of)) {
          if (variable < model_.layout.states || variable >= model_.layout.states + n_) continue;
          const std::size_t column = sample.time * n_ + variable - model_.layout.states;
          if (column != conditions_[i].column) places.push_back({i, static_cast<std::uint32_t>(column)});
        }
      }
    }
    return places;
  }

  /// The values that state `i` is given without reference to others: times and values.
  std::vector<std::pair<double, double>> known(std::size_t state) {
    std::vector<std::pair<double, double>> points;
    const std::vector<double> nothing(times_.size() * n_);
    for (std::size_t i = 0; i < conditions_.size(); ++i)
      if (conditions_[i].samples.empty() && conditions_[i].column % n_ == state)
        points.emplace_back(times_[conditions_[i].column / n_], value(i, nothing));
    std::ranges::sort(points);
    return points;
  }

 private:
  struct SampleAt {
    std::uint32_t variable;
    std::size_t time;  // which of times_
    NodeId of;
    model::Evaluation evaluation;
  };
  struct Condition {
    std::size_t column = 0;
    model::Evaluation value;
    std::vector<SampleAt> samples;
  };

  double value(std::size_t i, Values x) {
    Condition& condition = conditions_[i];
    for (SampleAt& sample : condition.samples) {
      double read = 0;
      sample.evaluation(times_[sample.time], x.subspan(sample.time * n_, n_), std::span(&read, 1));
      condition.value.set(sample.variable, read);
    }
    double result = 0;
    condition.value(0, x.first(n_), std::span(&result, 1));
    return result;
  }

  const Model& model_;
  std::size_t n_;
  std::vector<double> times_;
  std::vector<Condition> conditions_;
};

/// The k-th guess: what the model guesses, else straight lines between the values of the conditions; of derivatives of
/// guessed or known states the slopes.
class Guess {
 public:
  Guess(const ModelProgram& program, const Plan& plan, Conditions& conditions, std::size_t number)
      : states_(program.model.states), span_(plan.to - plan.from), sources_(states_.size()) {
    for (std::size_t i = 0; i < states_.size(); ++i) sources_[i].known = conditions.known(i);
    std::vector<std::size_t> seen(states_.size());
    for (const model::Guess& guess : program.model.guesses) {
      if (seen[guess.state]++ > number) continue;
      const NodeId node = guess.node;
      sources_[guess.state].text =
          model::Evaluation(program.tape_of(std::span(&node, 1)), program.model.layout, plan.variables);
    }
    for (std::size_t i = 0; i < states_.size(); ++i)
      if (states_[i].variable >= program.model.layout.unknowns)
        sources_[i].constant = plan.variables[states_[i].variable];
  }

  void operator()(double t, std::span<double> x) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = value(i, t);
  }

 private:
  struct Source {
    std::optional<model::Evaluation> text;
    std::vector<std::pair<double, double>> known;
    double constant = 0;
  };

  double value(std::size_t i, double t) {
    Source& source = sources_[i];
    if (source.text) {
      double result = 0;
      const std::vector<double> no_state(states_.size());
      (*source.text)(t, no_state, std::span(&result, 1));
      return result;
    }
    const bool follows = states_[i].primes > 0 && (sources_[i - 1].text || sources_[i - 1].known.size() > 1);
    if (follows) return (value(i - 1, t + 1e-5 * span_) - value(i - 1, t - 1e-5 * span_)) / (2e-5 * span_);
    if (source.known.empty()) return source.constant;
    return interpolated(source.known, t);
  }

  static double interpolated(const std::vector<std::pair<double, double>>& points, double t) {
    if (points.size() == 1) return points.front().second;
    std::size_t k = 1;
    while (k + 1 < points.size() && points[k].first < t) ++k;
    const auto& [from, first] = points[k - 1];
    const auto& [to, last] = points[k];
    return first + (last - first) * (t - from) / (to - from);
  }

  const std::vector<model::State>& states_;
  double span_;
  std::vector<Source> sources_;
};

/// What does not go together with conditions at several times.
std::optional<Diagnostic> what_does_not_fit(const Model& model, const Experiment& experiment) {
  const model::Span here = model.boundary.front().span;
  const auto wrong = [&](std::string what, std::string help) {
    return model::error("E321", here, "conditions at different times do not go together with " + what,
                        "this makes it a boundary-value problem", std::move(help));
  };
  if (!model.algebraic.empty()) return wrong("algebraic equations", "solve them for their unknowns with `let`");
  if (model.modes.size() > 1) return wrong("modes", "drop them, or give all conditions at the start");
  if (!model.events.empty() || !model.schedule.empty())
    return wrong("events", "drop them, or give all conditions at the start");
  if (experiment.method || experiment.step)
    return wrong("a method that integrates from the start", "leave out --method and --step");
  return std::nullopt;
}

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

Diagnostic failure_of(const Model& model, const Outcome<double>& outcome) {
  if (outcome.ending == Ending::interrupted)
    return model::error("E307", model.run.span, "interrupted before there was a solution");
  std::string message = "no motion meets these conditions near the guess";
  if (outcome.ending == Ending::too_many_steps) message = "the motion could not be resolved to this tolerance";
  if (outcome.ending == Ending::not_finite) message = "the equations give no finite number on the way";
  if (!outcome.component.empty() && outcome.ending == Ending::nonlinear_solve_failed)
    message += fmt::format("; `{}` moves most", outcome.component);
  return model::error("E322", model.boundary.front().span, std::move(message), {}, outcome.hint);
}

std::size_t guess_count(const Model& model) {
  std::vector<std::size_t> seen(model.states.size());
  std::size_t count = 1;
  for (const model::Guess& guess : model.guesses) count = std::max(count, ++seen[guess.state]);
  return count;
}

}  // namespace

BoundaryRuns solve_boundary(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment) {
  BoundaryRuns result;
  const Model& model = program->model;
  if (auto problem = what_does_not_fit(model, experiment)) {
    result.diagnostics.push_back(std::move(*problem));
    return result;
  }
  auto planned = model::plan(model, experiment, result.diagnostics);
  if (!planned) return result;
  planned->method = "collocation";
  planned->step = 0;
  const auto conditions = std::make_shared<Conditions>(*program, *planned);
  const BoundaryValueProblem problem{
      of_model(program, {.parameters = experiment.parameters}), conditions->times(),
      [conditions](Values x, Values, std::span<double> residuals) { (*conditions)(x, residuals); },
      conditions->places()};
  BoundaryValueOptions options{.tolerance = planned->rtol, .interrupt = experiment.interrupt};
  std::vector<BoundaryValueSolution> found;
  std::optional<Outcome<double>> failure;
  result.guesses = guess_count(model);
  for (std::size_t k = 0; k < result.guesses; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    // A residual that falls as a power of the mesh goes its way in logarithms.
    if (experiment.progress)
      options.progress = [&, first = 0.0](std::size_t, double residual) mutable {
        if (!(first > 0)) first = residual;
        const double way = std::log(first / planned->rtol), gone = std::log(first / residual);
        const double part = way > 0 && std::isfinite(gone) ? std::clamp(gone / way, 0.0, 1.0) : 0;
        experiment.progress((static_cast<double>(k) + part) / static_cast<double>(result.guesses));
      };
    Guess guess(*program, *planned, *conditions, k);
    auto solution = solve_boundary_values(problem, [&](double t, std::span<double> x) { guess(t, x); }, options);
    if (!solution.outcome) {
      if (!failure) failure = solution.outcome;
      if (solution.outcome.ending == Ending::interrupted) break;
      continue;
    }
    const auto is_same = [&](const auto& other) { return distance(other, solution) < same_part * planned->rtol; };
    if (std::ranges::any_of(found, is_same)) continue;
    model::Run run = run_of(*program, *planned, solution);
    run.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (experiment.estimate_error) run.error = error_of(problem, solution, run, options);
    found.push_back(std::move(solution));
    result.runs.push_back(std::move(run));
  }
  if (result.runs.empty() && failure) result.diagnostics.push_back(failure_of(model, *failure));
  if (result.guesses > 1) {
    for (model::Run& run : result.runs)
      run.outcome.hint = fmt::format("{} guesses led to {} different solution{}", result.guesses, result.runs.size(),
                                     result.runs.size() == 1 ? "" : "s (--solution N shows another)");
  }
  return result;
}

model::Simulated run_model(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                           std::size_t solution) {
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
