// The derivative of a function by differences: what becomes of f'(x) where h is as small as one likes, but the numbers
// have so many digits only.
//
//   const auto study = converge_differences([](auto x) { return std::sin(x); }, 1, std::cos(1.0L), -std::sin(1.0L));
//   study[0].in_double.order;      // 1, of the forward difference
//   study[0].in_double.best_step;  // about 1e-8: half the digits of double
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include <continuo/studies/accuracy/observed_order.hpp>

namespace continuo::studies {

/// sum weights[k] f(x + (k - 1) h) / h^derivative
struct DifferenceScheme {
  std::string_view name;
  int derivative, order;
  std::array<double, 3> weights;
};
/// Forward, backward and central for f', central for f''.
inline constexpr std::array<DifferenceScheme, 4> difference_schemes{{{"forward", 1, 1, {0, -1, 1}},
                                                                     {"backward", 1, 1, {-1, 1, 0}},
                                                                     {"central", 1, 2, {-0.5, 0, 0.5}},
                                                                     {"central, f''", 2, 2, {1, -2, 1}}}};

/// The errors of one scheme over the step.
struct DifferenceErrors {
  DifferenceScheme scheme;
  std::vector<double> steps, in_double, in_float;  // relative errors at each step
  ErrorCurve of_double, of_float;
  /// Where C h^p and the rounding of f, epsilon/2 |f| for each weight, over h or h^2, balance.
  Balance predicted, predicted_in_float;
};

/// Steps are the powers of 1/2 from `from` down, of which x + h is exact as long as it has the digits; f is called with
/// float and double. The exact derivatives are those that errors are measured against (relative; absolute where 0).
[[nodiscard]] std::vector<DifferenceErrors> converge_differences(const std::function<double(double)>& f,
                                                                 const std::function<float(float)>& in_float, double x,
                                                                 double first_derivative, double second_derivative);
template <class F>
[[nodiscard]] std::vector<DifferenceErrors> converge_differences(const F& f, double x, double first_derivative,
                                                                 double second_derivative) {
  return converge_differences(std::function<double(double)>(f), std::function<float(float)>(f), x, first_derivative,
                              second_derivative);
}

}  // namespace continuo::studies
