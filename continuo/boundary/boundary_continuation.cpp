// Solutions followed from an easier problem to the one that is asked for.
#include <algorithm>
#include <cmath>
#include <utility>

#include <continuo/boundary/boundary_continuation.hpp>
#include <continuo/boundary/boundary_nature.hpp>

namespace continuo::boundary {

namespace {

constexpr double rough_tolerance = 1e-3;  // of the solutions on the way
constexpr std::size_t rough_intervals = 3000;
constexpr double first_factor = 2, most_factor = 10;
constexpr double first_part = 0.1;  // of a way that is not by factors
constexpr double longer = 1.5, shorter = 3;
constexpr std::size_t most_attempts = 150;
constexpr double least_factor = 1.001;

/// The way from 0 to 1, by equal factors or by equal differences.
class Way {
 public:
  explicit Way(const BoundaryPath& path)
      : from_(path.from), to_(path.to), by_factors_(path.from * path.to > 0 && path.from != path.to) {}

  double value(double part) const {
    if (part >= 1) return to_;
    return by_factors_ ? from_ * std::pow(to_ / from_, part) : from_ + part * (to_ - from_);
  }
  double first() const { return by_factors_ ? part_of(first_factor) : first_part; }
  double longest() const { return by_factors_ ? part_of(most_factor) : 1; }
  double shortest() const { return by_factors_ ? part_of(least_factor) : 1e-4; }

 private:
  double part_of(double factor) const { return std::log(factor) / std::abs(std::log(to_ / from_)); }

  double from_, to_;
  bool by_factors_;
};

BoundaryValueOptions rough(const BoundaryValueOptions& options) {
  BoundaryValueOptions result = options;
  result.tolerance = std::max(options.tolerance, rough_tolerance);
  result.check_error = false;
  result.most_intervals = std::min(options.most_intervals, rough_intervals);
  result.most_refinements = 2;
  result.progress = {};
  return result;
}

BoundaryValueGuess guess_from(const BoundaryValueSolution& solution) {
  return [&solution](double t, std::span<double> x) { solution.at(t, x); };
}

}  // namespace

FollowedSolution follow_path(const BoundaryPath& path, const BoundaryValueGuess& guess,
                             const BoundaryValueOptions& options) {
  const Way way(path);
  BoundaryValueOptions on_the_way = rough(options);
  FollowedSolution followed{.solution = {}, .reached = path.from};
  const auto solve = [&](double value, const BoundaryValueGuess& from, const BoundaryValueSolution* before,
                         BoundaryValueOptions how) {
    auto problem = path.problem(value);
    BoundaryValueSolution none;
    none.outcome.ending = Ending::invalid_input;
    if (!problem) return none;
    if (before) {
      problem->system.constants = before->parameters;
      how.mesh = before->mesh;
    }
    return solve_boundary_values(*problem, from, how);
  };
  followed.solution = solve(path.from, guess, nullptr, on_the_way);
  if (!followed.solution.outcome || path.from == path.to) {
    if (followed.solution.outcome) followed.solution = solve(path.to, guess, nullptr, options);
    return followed;
  }
  double part = 0, step = way.first();
  for (std::size_t attempt = 0; attempt < most_attempts; ++attempt) {
    const double next = part + step > 0.999 ? 1 : part + step;
    BoundaryValueSolution& here = followed.solution;
    BoundaryValueSolution there = solve(way.value(next), guess_from(here), &here, on_the_way);
    if (there.outcome.ending == Ending::interrupted) return {std::move(there), followed.reached, followed.steps};
    if (!there.outcome) {
      step /= shorter;
      if (step < way.shortest()) return {std::move(there), followed.reached, followed.steps};
      continue;
    }
    there.evaluations += here.evaluations;
    there.iterations += here.iterations;
    here = std::move(there);
    part = next;
    followed.reached = way.value(part);
    ++followed.steps;
    if (part == 1) {
      const BoundaryValueSolution last = std::move(here);
      followed.solution = solve(path.to, guess_from(last), &last, options);
      followed.solution.evaluations += last.evaluations;
      followed.solution.iterations += last.iterations;
      return followed;
    }
    step = std::min(longer * step, way.longest());
  }
  followed.solution.outcome.ending = Ending::nonlinear_solve_failed;
  followed.solution.failure = BoundaryValueFailure::not_found;
  return followed;
}

bool may_be_followed(const BoundaryValueProblem& problem, const BoundaryValueSolution& solution) {
  using enum BoundaryValueFailure;
  const bool may_be_elsewhere = solution.failure == not_found || solution.failure == not_finite ||
                                solution.failure == too_fine || solution.failure == undetermined;
  return !solution.outcome && may_be_elsewhere && !is_linear(problem);
}

BoundaryValueSolution solve_with_continuation(const BoundaryValueProblem& problem, const BoundaryValueGuess& guess,
                                              const BoundaryValueOptions& options) {
  BoundaryValueSolution plain = solve_boundary_values(problem, guess, options);
  if (!may_be_followed(problem, plain)) return plain;
  const auto slowed = [&problem](double s) -> std::optional<BoundaryValueProblem> {
    BoundaryValueProblem slow = problem;
    slow.system.derivative = [&problem, s](double t, Values x, Values p, std::span<double> dxdt) {
      problem.system.derivative(t, x, p, dxdt);
      for (double& value : dxdt) value *= s;
    };
    if (problem.system.jacobian)
      slow.system.jacobian = [&problem, s](double t, Values x, Values p, std::span<double> entries) {
        problem.system.jacobian(t, x, p, entries);
        for (double& value : entries) value *= s;
      };
    return slow;
  };
  for (double s = 0.25; s > 1e-6; s /= 4) {
    if (options.interrupt && options.interrupt->load()) return plain;
    FollowedSolution followed = follow_path({slowed, s, 1}, guess, options);
    if (followed.solution.outcome || followed.solution.outcome.ending == Ending::interrupted ||
        followed.solution.failure == BoundaryValueFailure::undetermined ||
        followed.solution.failure == BoundaryValueFailure::rounding)
      return std::move(followed.solution);
    if (followed.steps > 0) break;
  }
  return plain;
}

}  // namespace continuo::boundary
