// The conditions and guesses of a model as functions, and what does not go together with them.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <continuo/boundary/boundary_continuation.hpp>
#include <continuo/boundary/boundary_problem_of_model.hpp>
#include <continuo/simulation/drive/planner.hpp>
#include <continuo/simulation/of_model.hpp>
#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::boundary {

using model::BoundaryCondition;
using model::Diagnostic;
using model::Experiment;
using model::Model;
using model::ModelProgram;
using model::NodeId;
using model::Plan;
using model::Sample;

BoundaryConditions::BoundaryConditions(const ModelProgram& program, const Plan& plan)
    : model_(program.model),
      n_(model_.states.size()),
      from_(plan.from),
      to_(plan.to),
      variables_(plan.variables),
      times_{plan.from, plan.to} {
  for (const BoundaryCondition& condition : model_.boundary) {
    times_.push_back(time_of(condition.time));
    for (const Sample& sample : condition.samples) times_.push_back(time_of(sample.when));
  }
  std::ranges::sort(times_);
  times_.erase(std::ranges::unique(times_).begin(), times_.end());
  const auto evaluation_of = [&](NodeId node) {
    return model::Evaluation(program.tape_of(std::span(&node, 1)), plan.variables);
  };
  for (const BoundaryCondition& condition : model_.boundary) {
    Condition& made = conditions_.emplace_back();
    made.column = place_of(condition.time) * n_ + condition.state;
    made.value = evaluation_of(condition.value);
    for (const Sample& sample : condition.samples)
      made.samples.push_back({sample.variable, place_of(sample.when), sample.of, evaluation_of(sample.of)});
  }
}

double BoundaryConditions::time_of(const model::Setting& setting) const {
  return std::clamp(evaluate(model_, setting.node, variables_), from_, to_);
}

std::size_t BoundaryConditions::place_of(const model::Setting& setting) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(times_, time_of(setting)) - times_.begin());
}

void BoundaryConditions::operator()(Values x, std::span<double> residuals) {
  for (std::size_t i = 0; i < conditions_.size(); ++i) residuals[i] = x[conditions_[i].column] - value(i, x);
}

std::vector<MatrixPlace> BoundaryConditions::places() const {
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

std::vector<std::pair<double, double>> BoundaryConditions::known(std::size_t state) {
  std::vector<std::pair<double, double>> points;
  const std::vector<double> nothing(times_.size() * n_);
  for (std::size_t i = 0; i < conditions_.size(); ++i)
    if (conditions_[i].samples.empty() && conditions_[i].column % n_ == state)
      points.emplace_back(times_[conditions_[i].column / n_], value(i, nothing));
  std::ranges::sort(points);
  return points;
}

double BoundaryConditions::value(std::size_t i, Values x) {
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

namespace {

/// The k-th guess: what the model guesses, else straight lines between the values of the conditions; of derivatives of
/// guessed or known states the slopes.
class Guess {
 public:
  Guess(const ModelProgram& program, const Plan& plan, BoundaryConditions& conditions, std::size_t number)
      : states_(program.model.states), span_(plan.to - plan.from), sources_(states_.size()) {
    for (std::size_t i = 0; i < states_.size(); ++i) sources_[i].known = conditions.known(i);
    std::vector<std::size_t> seen(states_.size());
    for (const model::Guess& guess : program.model.guesses) {
      if (seen[guess.state]++ > number) continue;
      const NodeId node = guess.node;
      sources_[guess.state].text = model::Evaluation(program.tape_of(std::span(&node, 1)), plan.variables);
    }
    for (std::size_t i = 0; i < states_.size(); ++i)
      if (states_[i].variable >= program.model.layout.unknowns)
        sources_[i].constant = plan.variables[states_[i].variable];
  }

  /// Takes the place of what is guessed of a state.
  void set(std::size_t state, std::vector<std::pair<double, double>> points) {
    sources_[state] = {.text = {}, .known = std::move(points), .given = true};
  }

  void operator()(double t, std::span<double> x) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = value(i, t);
  }

 private:
  struct Source {
    std::optional<model::Evaluation> text;
    std::vector<std::pair<double, double>> known;
    double constant = 0;
    bool given = false;  // by a table
  };

  double value(std::size_t i, double t) {
    Source& source = sources_[i];
    if (source.text) {
      double result = 0;
      const std::vector<double> no_state(states_.size());
      (*source.text)(t, no_state, std::span(&result, 1));
      return result;
    }
    const bool follows =
        !source.given && states_[i].primes > 0 && (sources_[i - 1].text || sources_[i - 1].known.size() > 1);
    if (follows) return (value(i - 1, t + 1e-5 * span_) - value(i - 1, t - 1e-5 * span_)) / (2e-5 * span_);
    if (source.known.empty()) return source.constant;
    return interpolated(source.known, t);
  }

  static double interpolated(const std::vector<std::pair<double, double>>& points, double t) {
    if (points.size() == 1) return points.front().second;
    const auto above = std::upper_bound(points.begin() + 1, points.end() - 1, t,
                                        [](double time, const auto& point) { return time < point.first; });
    const auto k = static_cast<std::size_t>(above - points.begin());
    const auto& [from, first] = points[k - 1];
    const auto& [to, last] = points[k];
    return first + (last - first) * (t - from) / (to - from);
  }

  const std::vector<model::State>& states_;
  double span_;
  std::vector<Source> sources_;
};

/// A condition that an interval other than the model's leaves out, but for rounding.
std::optional<Diagnostic> what_stands_outside(const Model& model, const Plan& plan) {
  const double slack = 1e-12 * (plan.to - plan.from);
  const auto is_outside = [&](const model::Setting& setting) {
    const double t = evaluate(model, setting.node, plan.variables);
    return t < plan.from - slack || t > plan.to + slack;
  };
  for (const BoundaryCondition& condition : model.boundary) {
    if (!is_outside(condition.time) &&
        std::ranges::none_of(condition.samples, [&](const Sample& sample) { return is_outside(sample.when); }))
      continue;
    return model::error("E245", condition.span, "this condition stands outside of the run",
                        fmt::format("the run goes from {:g} to {:g}", plan.from, plan.to),
                        "let the run reach it, or move it");
  }
  return std::nullopt;
}

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

}  // namespace

std::optional<model::Plan> plan_boundary(const Model& model, const Experiment& experiment,
                                         std::vector<Diagnostic>& problems) {
  model::Planner planner(model, experiment, problems);
  planner.begin();
  if (experiment.max_step || experiment.max_steps)
    planner.fail("E333", "conditions at several times are met without steps in time",
                 "leave out --max-step and --max-steps", true);
  planner.set_integration();  // for its tolerances; pose_boundary replaces the method and the step
  return planner.finish();
}

std::optional<PosedBoundary> pose_boundary(const std::shared_ptr<const ModelProgram>& program,
                                           const Experiment& experiment, std::vector<Diagnostic>& problems) {
  if (auto problem = what_does_not_fit(program->model, experiment)) {
    problems.push_back(std::move(*problem));
    return std::nullopt;
  }
  auto planned = plan_boundary(program->model, experiment, problems);
  if (!planned) return std::nullopt;
  if (auto problem = what_stands_outside(program->model, *planned)) {
    problems.push_back(std::move(*problem));
    return std::nullopt;
  }
  planned->method = "collocation";
  planned->step = 0;
  const auto conditions = std::make_shared<BoundaryConditions>(*program, *planned);
  BoundaryValueProblem problem{
      of_model(program, {.parameters = experiment.parameters}), conditions->times(),
      [conditions](Values x, Values, std::span<double> residuals) { (*conditions)(x, residuals); },
      conditions->places()};
  const double tolerance = planned->rtol;
  return PosedBoundary{program,
                       std::move(*planned),
                       conditions,
                       std::move(problem),
                       {.tolerance = tolerance, .interrupt = experiment.interrupt}};
}

BoundaryValueGuess guess_of(const PosedBoundary& posed, std::size_t k) {
  const auto guess = std::make_shared<Guess>(*posed.program, posed.plan, *posed.conditions, k);
  return [guess](double t, std::span<double> x) { (*guess)(t, x); };
}

std::optional<BoundaryValueGuess> guess_from(const PosedBoundary& posed, const GuessTable& table,
                                             std::vector<Diagnostic>& problems) {
  const Model& model = posed.program->model;
  const auto guess = std::make_shared<Guess>(*posed.program, posed.plan, *posed.conditions, 0);
  std::string names;
  bool any = false;
  for (std::size_t i = 0; i < model.states.size(); ++i) {
    names += fmt::format("{}`{}`", names.empty() ? "" : ", ", model.states[i].column);
    const auto column = std::ranges::find(table.columns, model.states[i].column);
    if (column == table.columns.end()) continue;
    const auto& values = table.values[static_cast<std::size_t>(column - table.columns.begin())];
    std::vector<std::pair<double, double>> points;
    for (std::size_t row = 0; row < values.size(); ++row)
      if (std::isfinite(values[row]) && (points.empty() || table.times[row] > points.back().first))
        points.emplace_back(table.times[row], values[row]);
    if (points.empty()) continue;
    guess->set(i, std::move(points));
    any = true;
  }
  const bool overlaps =
      !table.times.empty() && table.times.front() < posed.plan.to && table.times.back() > posed.plan.from;
  if (!any) {
    problems.push_back(model::error("E349", model.boundary.front().span,
                                    fmt::format("{} has no column of a state to begin from", table.name), {},
                                    fmt::format("columns are read by name: {}", names)));
    return std::nullopt;
  }
  if (!overlaps) {
    problems.push_back(model::error("E349", model.boundary.front().span,
                                    fmt::format("the times of {} are outside of the run", table.name),
                                    fmt::format("the run goes from {:g} to {:g}", posed.plan.from, posed.plan.to)));
    return std::nullopt;
  }
  return [guess](double t, std::span<double> x) { (*guess)(t, x); };
}

BoundaryValueSolution solve_from_guess(const PosedBoundary& posed, std::size_t k) {
  return solve_with_continuation(posed.problem, guess_of(posed, k), posed.options);
}

std::size_t guess_count(const Model& model) {
  std::vector<std::size_t> seen(model.states.size());
  std::size_t count = 1;
  for (const model::Guess& guess : model.guesses) count = std::max(count, ++seen[guess.state]);
  return count;
}

Diagnostic boundary_failure(const Model& model, const BoundaryValueSolution& solution) {
  const Outcome<double>& outcome = solution.outcome;
  if (outcome.ending == Ending::interrupted)
    return model::error("E307", model.run.span, "interrupted before there was a solution");
  std::string message = "no motion meets these conditions near the guess";
  if (solution.failure == BoundaryValueFailure::undetermined)
    message = "these conditions do not determine the motion";
  else if (outcome.ending == Ending::too_many_steps)
    message = "the motion could not be resolved to this tolerance";
  else if (outcome.ending == Ending::not_finite)
    message = "the equations give no finite number on the way";
  else if (!outcome.component.empty() && outcome.ending == Ending::nonlinear_solve_failed)
    message += fmt::format("; `{}` moves most", outcome.component);
  return model::error("E322", model.boundary.front().span, std::move(message), {}, outcome.hint);
}

}  // namespace continuo::boundary
