// The order of a method, estimated from a list of errors:
//
//   const ErrorCurve curve = read_errors(steps, errors);
//   curve.order;       // the slope, error = constant * step^order, where it is one
//   curve.best_step;   // a smaller one is not worth it
//
// Of the largest steps the error follows no power yet; of the smallest, rounding covers it and grows again. Between the
// two the slope is fitted by least squares in log-log, over a run of at least `least_points` neighbours. Its standard
// error says whether they lie on a line: a longer run makes it smaller until it takes in points that do not. Of all
// runs whose standard error is `good_fit` or as small as any, the one with the smallest steps is taken, and of those
// that end there the best: an order is what holds as h goes to zero.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace continuo::studies {

struct ErrorCurve {
  bool found = false;  // a slope: else there are too few points between the largest steps and rounding
  double order = 0, constant = 0, standard_error = 0;
  std::size_t first = 0, last = 0;  // the points that were used
  bool floor_reached = false;       // rounding ends it
  double least_error = 0;
  double best_step = 0;  // the largest one with an error of no more than twice the least
};

/// Relative errors above this are no approximation, and no part of a slope.
inline constexpr double greatest_useful_error = 0.1;
inline constexpr std::size_t least_points = 4;
inline constexpr double good_fit = 0.03;

/// `steps` falling, `errors` of each; what is not a positive number is left out. Slopes are made of errors between
/// `least` (below it they are made of rounding) and `greatest`.
[[nodiscard]] ErrorCurve read_errors(std::span<const double> steps, std::span<const double> errors, double least = 0,
                                     double greatest = greatest_useful_error);

/// Where constant * h^order, which falls with h, and rounding * h^-power, which grows, have the smallest sum, and that
/// sum.
struct Balance {
  double step, error;
};
[[nodiscard]] Balance balance(double constant, double order, double rounding, double power);

}  // namespace continuo::studies
