// One step after the other along a curve of solutions: predicted along the tangent, corrected by equations of which one
// says that the solution lies upright on the tangent at the prediction (pseudo-arclength). H. B. Keller, "Numerical
// solution of bifurcation and nonlinear eigenvalue problems" (1977).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/status/status.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

/// The equations of a solution, or of the next one on a curve, could not be solved.
[[nodiscard]] inline Status not_found(std::string message) {
  return {.ending = Ending::nonlinear_solve_failed, .message = std::move(message)};
}

/// The least cosine between the tangents of neighbours, that of 25 degrees: a step that turns by more was too long to
/// be sure of the curve.
inline constexpr double least_cosine_of_neighbours = 0.906;

/// How long the next step is to be.
class StepLength {
 public:
  /// Options with `first_step`, `least_step` and `largest_step`.
  template <class Options>
  explicit StepLength(const Options& options)
      : value_(options.first_step), least_(options.least_step), largest_(options.largest_step) {}

  operator double() const { return value_; }
  /// After a step that failed, or turned by too much. False where there is no shorter one.
  [[nodiscard]] bool shorten() {
    value_ /= 2;
    return value_ > least_;
  }
  void lengthen() { value_ = std::min(1.3 * value_, largest_); }

 private:
  double value_, least_, largest_;
};

/// z + step tangent, with the tangent in units; without units all are 1.
[[nodiscard]] inline std::vector<double> predicted(std::vector<double> z, std::span<const double> tangent, double step,
                                                   std::span<const double> units = {}) {
  for (std::size_t j = 0; j < z.size(); ++j) z[j] += units.empty() ? step * tangent[j] : step * tangent[j] * units[j];
  return z;
}

/// `corrected(guess)`: the solution near there, optional; unknowns, or what has them as `z`. Nothing where none is
/// found, or only one that is farther from the prediction than the step is long: it leapt to elsewhere. The step may be
/// negative.
template <class Corrected>
[[nodiscard]] auto arclength_step(const std::vector<double>& z, std::span<const double> tangent, double step,
                                  std::span<const double> units, const Corrected& corrected) {
  const std::vector<double> guess = predicted(z, tangent, step, units);
  auto found = corrected(guess);
  const auto unknowns_of = [](const auto& place) -> const std::vector<double>& {
    if constexpr (requires { place.z; })
      return place.z;
    else
      return place;
  };
  if (found && distance(unknowns_of(*found), guess, units) > std::abs(step)) found.reset();
  return found;
}

}  // namespace continuo::studies::detail
