// Poses and solves the linear boundary-value problem of sensitivities.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <continuo/boundary/boundary_problem_of_model.hpp>
#include <continuo/simulation/run_along.hpp>
#include <continuo/studies/sensitivity/boundary_sensitivity.hpp>
#include <continuo/studies/sensitivity/sensitive_system.hpp>

namespace continuo::studies::detail {

using boundary::BoundaryValueOptions;
using boundary::BoundaryValueProblem;
using boundary::BoundaryValueSolution;
using boundary::PosedBoundary;

namespace {

/// The conditions of x, then those of each column of S. The state at each time is x, then the columns of S.
class VariedConditions {
 public:
  VariedConditions(const std::shared_ptr<const SensitiveProgram>& program, const PosedBoundary& posed)
      : program_(program),
        times_(posed.conditions->times()),
        n_(program->size()),
        wide_(n_ * (1 + program->count())),
        system_(program, posed.plan.variables),
        rates_(wide_) {
    const std::vector<double>& variables = posed.plan.variables;
    for (const model::BoundaryCondition& condition : program->program().model.boundary) {
      std::vector<std::uint32_t> read;
      for (const model::Sample& sample : condition.samples) read.push_back(sample.variable);
      Condition& made =
          conditions_.emplace_back(Condition{condition.state,
                                             posed.conditions->place_of(condition.time),
                                             program->moves_of(condition.time.node, variables),
                                             WideEvaluation(program->along(condition.value, read), *program, variables),
                                             {}});
      for (const model::Sample& sample : condition.samples)
        made.samples.push_back({sample.variable, posed.conditions->place_of(sample.when),
                                program->moves_of(sample.when.node, variables),
                                WideEvaluation(program->along(sample.of, {}), *program, variables)});
    }
  }

  void operator()(Values y, std::span<double> residuals) {
    for (std::size_t c = 0; c < conditions_.size(); ++c) residual(c, y, residuals);
  }

  /// Of the entries of dg/dx, and where the columns of S have them too.
  std::vector<MatrixPlace> places(const std::vector<MatrixPlace>& plain) const {
    std::vector<MatrixPlace> places;
    const auto add = [&](std::size_t row, std::size_t time, std::size_t component) {
      places.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(time * wide_ + component)});
    };
    for (const MatrixPlace& place : plain) {
      const std::size_t time = place.column / n_, state = place.column % n_;
      add(place.row, time, state);
      for (std::size_t k = 1; k <= program_->count(); ++k) {
        add(k * n_ + place.row, time, k * n_ + state);
        add(k * n_ + place.row, time, state);
        // Where a time moves, f is read: of any state.
        for (std::size_t i = 0; i < n_ && moves(place.row, k - 1); ++i)
          if (i != state) add(k * n_ + place.row, time, i);
      }
    }
    return places;
  }

 private:
  struct Sample {
    std::uint32_t variable;
    std::size_t time;
    std::vector<double> time_moves;
    WideEvaluation of;
  };
  struct Condition {
    std::size_t state, time;
    std::vector<double> time_moves;
    WideEvaluation value;
    std::vector<Sample> samples;
  };

  bool moves(std::size_t c, std::size_t k) const {
    const auto is_moved = [&](const auto& at) { return at.time_moves[k] != 0; };
    return is_moved(conditions_[c]) || std::ranges::any_of(conditions_[c].samples, is_moved);
  }

  /// The wide state at a time as seen by who moves with that time: S + f t'.
  std::vector<double> moving(Values y, std::size_t time, const std::vector<double>& time_moves) {
    std::vector<double> at(y.begin() + static_cast<std::ptrdiff_t>(time * wide_),
                           y.begin() + static_cast<std::ptrdiff_t>((time + 1) * wide_));
    if (std::ranges::all_of(time_moves, [](double move) { return move == 0; })) return at;
    system_.rates(times_[time], at, rates_);
    for (std::size_t k = 0; k < time_moves.size(); ++k)
      for (std::size_t i = 0; i < n_; ++i) at[(k + 1) * n_ + i] += rates_[i] * time_moves[k];
    return at;
  }

  void residual(std::size_t c, Values y, std::span<double> residuals) {
    Condition& condition = conditions_[c];
    const std::size_t count = program_->count();
    std::vector<std::vector<double>> read;
    for (Sample& sample : condition.samples) {
      read.push_back(sample.of(times_[sample.time], moving(y, sample.time, sample.time_moves)));
      condition.value.set(sample.variable, read.back().front());
    }
    const std::vector<double> here = moving(y, condition.time, condition.time_moves);
    const std::vector<double> value = condition.value(times_[condition.time], here);
    residuals[c] = here[condition.state] - value[0];
    for (std::size_t k = 1; k <= count; ++k) {
      double move = value[k];
      for (std::size_t s = 0; s < read.size(); ++s) move += value[1 + count + s] * read[s][k];
      residuals[k * n_ + c] = here[k * n_ + condition.state] - move;
    }
  }

  std::shared_ptr<const SensitiveProgram> program_;
  std::vector<double> times_;
  std::size_t n_, wide_;
  SensitiveSystem system_;
  std::vector<double> rates_;
  std::vector<Condition> conditions_;
};

BoundaryValueSolution first_solution(const PosedBoundary& posed) {
  BoundaryValueSolution solution;
  const std::size_t guesses = boundary::guess_count(posed.program->model);
  for (std::size_t k = 0; k < guesses; ++k) {
    solution = solve_from_guess(posed, k);
    if (solution.outcome || solution.outcome.ending == Ending::interrupted) break;
  }
  return solution;
}

BoundaryValueSolution solve_along(const std::shared_ptr<const SensitiveProgram>& program, const PosedBoundary& posed,
                                  const BoundaryValueSolution& plain) {
  const std::size_t wide = program->size() * (1 + program->count());
  const auto conditions = std::make_shared<VariedConditions>(program, posed);
  BoundaryValueProblem problem{
      parametric_system(wide, SensitiveSystem(program, posed.plan.variables)), posed.conditions->times(),
      [conditions](Values y, Values, std::span<double> residuals) { (*conditions)(y, residuals); },
      conditions->places(posed.conditions->places())};
  BoundaryValueOptions options = posed.options;
  options.mesh = plain.mesh;
  return solve_boundary_values(
      problem,
      [&](double t, std::span<double> y) {
        plain.at(t, y.first(plain.size));
        std::ranges::fill(y.subspan(plain.size), 0.0);
      },
      options);
}

}  // namespace

std::optional<model::Diagnostic> no_boundary_sensitivity(const model::Model& model,
                                                         std::span<const Influence> influences) {
  for (const Influence& influence : influences) {
    if (influence.kind != Influence::Kind::initial) continue;
    const model::State& state = model.states[influence.index];
    return model::error("E361", model.boundary.front().span,
                        fmt::format("`{}` has no initial value of its own", state.column),
                        "conditions at several times determine it", "name a parameter that the conditions read");
  }
  return std::nullopt;
}

SensitivityRun boundary_sensitivity(const std::shared_ptr<const SensitiveProgram>& program,
                                    const SensitivityRequest& request) {
  const auto begin = std::chrono::steady_clock::now();
  const model::Model& model = program->program().model;
  SensitivityRun run;
  run.states = program->size();
  run.influences = program->count();
  model::Experiment experiment = request.experiment;
  experiment.method.reset();  // there is one for conditions at several times
  experiment.step.reset();
  const auto posed = boundary::pose_boundary(program->shared_program(), experiment, run.diagnostics);
  if (!posed) return run;
  run.variables = posed->plan.variables;
  const BoundaryValueSolution plain = first_solution(*posed);
  const BoundaryValueSolution found = plain.outcome ? solve_along(program, *posed, plain) : plain;
  run.outcome = found.outcome;
  if (!found.outcome) {
    run.diagnostics.push_back(boundary_failure(model, found));
    return run;
  }
  run.times = request.times;
  if (run.times.empty()) {
    const model::Run along = model::run_along(program->program(), posed->plan, found.mesh,
                                              [&](double t, std::vector<double>& x) { plain.at(t, x); });
    for (std::size_t row = 0; row < along.motion.rows(); ++row) run.times.push_back(along.motion.time(row));
  }
  for (const double t : run.times) {
    const std::vector<double> row = found(t);
    run.values.insert(run.values.end(), row.begin(), row.end());
  }
  run.statistics.steps = found.mesh.size() - 1;
  run.statistics.evaluations = plain.evaluations + found.evaluations;
  run.statistics.jacobians = run.statistics.factorizations = plain.iterations + found.iterations;
  run.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

}  // namespace continuo::studies::detail
