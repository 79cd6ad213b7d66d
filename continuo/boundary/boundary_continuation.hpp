// Boundary values that Newton's iteration does not find from a guess: solved for a problem that is easier, from which
// the solution is followed to the one that is asked for, in steps as long as the iteration goes along with.
//
//   const BoundaryPath path{[&](double eps) { return layer(eps); }, 1, 1e-5};
//   const auto solution = follow_path(path, guess, {.tolerance = 1e-8});
#pragma once
#include <functional>
#include <optional>

#include <continuo/boundary/boundary_value.hpp>

namespace continuo::boundary {

/// A problem for each value of a parameter, the easy one at `from`. Steps are factors where both have one sign.
struct BoundaryPath {
  std::function<std::optional<BoundaryValueProblem>(double value)> problem{};
  double from = 0, to = 1;
};

/// Where it ends on the way, the hint says how far it came: `reached` is the last value that has a solution.
struct FollowedSolution {
  BoundaryValueSolution solution;
  double reached = 0;
  std::size_t steps = 0;  // to values between
};
/// Solves the problem at `from`, then at values on the way to `to`, each from the solution before.
[[nodiscard]] FollowedSolution follow_path(const BoundaryPath& path, const BoundaryValueGuess& guess = {},
                                           const BoundaryValueOptions& options = {});

/// Whether another way may lead to a solution where the search has ended without one, or at one that is not determined.
[[nodiscard]] bool may_be_followed(const BoundaryValueProblem& problem, const BoundaryValueSolution& solution);

/// From x' = s f(t, x, p) with a small s, by which layers are wide and motions slow, to s = 1. Tried where a problem
/// that is not linear has no solution near the guess.
[[nodiscard]] BoundaryValueSolution solve_with_continuation(const BoundaryValueProblem& problem,
                                                            const BoundaryValueGuess& guess = {},
                                                            const BoundaryValueOptions& options = {});

}  // namespace continuo::boundary
