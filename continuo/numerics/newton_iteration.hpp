// Newton's iteration, whatever the corrections come from and whatever they are measured in: when it has converged, when
// it leads nowhere, how a step is shortened. Who calls evaluates and solves:
//
//   double z = 1;
//   const auto to_root_of_two = [&]() -> NewtonCorrection {
//     const double step = (z * z - 2) / (2 * z);
//     z -= step;
//     return std::abs(step);
//   };
//   if (newton_iteration({.most_iterations = 20, .solved_to = 1e-9, .rounding = 1e-6}, to_root_of_two)) ...
//
// P. Deuflhard, "Newton Methods for Nonlinear Problems" (2004).
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <variant>

namespace continuo {

/// How an iteration ended. `no_descent`: no part of a correction was better. `diverged`: a correction was too large.
/// `too_many`: the limit of iterations was reached.
enum class NewtonEnding { converged, no_descent, diverged, singular, not_finite, too_many, interrupted };

/// How an iteration ended, and after how many corrections.
struct [[nodiscard]] NewtonOutcome {
  NewtonEnding ending = NewtonEnding::too_many;
  std::size_t iterations = 0;  // with that in which it ended
  /// Whether it converged.
  explicit operator bool() const { return ending == NewtonEnding::converged; }
};

/// How large a correction is, or why there is none.
using NewtonCorrection = std::variant<double, NewtonEnding>;

/// When an iteration in full steps ends. Corrections are measured as the caller measures them.
struct NewtonLimits {
  std::size_t most_iterations = 20;
  double solved_to = 0;  // a correction behind which none is needed: the next one would be of the size of its square
  /// A correction below this that is not four times as small as the one before is what rounding leaves: it has
  /// converged.
  double rounding = 0;
  double farthest = std::numeric_limits<double>::infinity();  // a correction that is not below leads nowhere
  bool each_is_smaller = false;  // than the one before, from the third on; else it leads nowhere
};

/// In full steps. `correct()` evaluates, solves and goes by the correction. `is_near()`: whether the place that this
/// has led to may still lead to the solution that is meant.
template <class Correct, class IsNear>
[[nodiscard]] NewtonOutcome newton_iteration(const NewtonLimits& limits, const Correct& correct,
                                             const IsNear& is_near) {
  double before = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k <= limits.most_iterations; ++k) {
    const NewtonCorrection correction = correct();
    if (const auto* failure = std::get_if<NewtonEnding>(&correction)) return {*failure, k};
    const double size = std::get<double>(correction);
    if (size <= limits.solved_to || (size > before / 4 && size < limits.rounding)) return {NewtonEnding::converged, k};
    const bool grows = limits.each_is_smaller && k > 2 && size > before;
    if (!(size < limits.farthest) || grows || !is_near()) return {NewtonEnding::diverged, k};
    before = size;
  }
  return {NewtonEnding::too_many, limits.most_iterations};
}
template <class Correct>
[[nodiscard]] NewtonOutcome newton_iteration(const NewtonLimits& limits, const Correct& correct) {
  return newton_iteration(limits, correct, [] { return true; });
}

/// When an iteration in shortened steps ends.
struct DampedNewtonLimits {
  std::size_t most_iterations = 40;
  double least_damping = 1e-4;
  double recovery = std::numeric_limits<double>::infinity();  // by how much the next step may be less damped, up to 1
};

/// What came of a part of a correction: `refused` is a place that is no better, where it does not stay.
enum class NewtonAttempt { refused, taken, solved };

/// In steps that are halved until one is taken. `correct()` evaluates and solves. `attempt(part, size)` goes by so much
/// of the correction, of that size, and judges what that leads to: by the residual, or by the next correction.
template <class Correct, class Attempt>
[[nodiscard]] NewtonOutcome damped_newton(const DampedNewtonLimits& limits, const Correct& correct,
                                          const Attempt& attempt) {
  double damping = 1;
  for (std::size_t k = 1; k <= limits.most_iterations; ++k) {
    const NewtonCorrection correction = correct();
    if (const auto* failure = std::get_if<NewtonEnding>(&correction)) return {*failure, k};
    for (;;) {
      const NewtonAttempt made = attempt(damping, std::get<double>(correction));
      if (made == NewtonAttempt::solved) return {NewtonEnding::converged, k};
      if (made == NewtonAttempt::taken) break;
      damping /= 2;
      if (damping < limits.least_damping) return {NewtonEnding::no_descent, k};
    }
    damping = std::min(1.0, limits.recovery * damping);
  }
  return {NewtonEnding::too_many, limits.most_iterations};
}

}  // namespace continuo
