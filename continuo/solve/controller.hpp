// continuo/solve/controller.hpp
// The next step size from the errors so far: h_new = h * safety * err_n^-b1 * err_(n-1)^-b2 * err_(n-2)^-b3, each
// exponent divided by the order of the error estimate plus one. G. Soderlind, "Digital filters in adaptive
// time-stepping", ACM TOMS 29 (2003).
#pragma once
#include <algorithm>
#include <cmath>

namespace continuo {

/// A step controller is three exponents and the bounds of one change.
struct Controller {
  double beta1, beta2, beta3;
  double safety = 0.9;
  double least_factor = 0.2, greatest_factor = 10;
};

/// The elementary controller: each error alone.
inline constexpr Controller I{1, 0, 0};
/// PI.3.4 of K. Gustafsson (1991): smoother steps, fewer rejections.
inline constexpr Controller PI{0.7, -0.4, 0};
/// The PID controller of C. Kennedy, M. Carpenter, Appl. Numer. Math. 44 (2003), for noisy right-hand sides.
inline constexpr Controller PID{0.58, -0.21, 0.1};

/// The memory of a controller: the last two errors. A jump of the state clears it.
template <class Real>
struct ErrorHistory {
  Real last = 1, before_last = 1;

  /// The factor for the next step after an accepted one; the error is kept for the steps after.
  Real accept(const Controller& controller, int error_order, Real error) {
    using std::pow;
    const Real k = Real(error_order + 1);
    const Real bounded = std::max(error, Real(1e-10));
    Real factor = Real(controller.safety) * pow(bounded, Real(-controller.beta1) / k);
    if (controller.beta2 != 0) factor *= pow(last, Real(-controller.beta2) / k);
    if (controller.beta3 != 0) factor *= pow(before_last, Real(-controller.beta3) / k);
    before_last = last;
    last = bounded;
    return std::clamp(factor, Real(controller.least_factor), Real(controller.greatest_factor));
  }

  /// The factor for another try of a rejected step.
  static Real reject(const Controller& controller, int error_order, Real error) {
    using std::pow;
    const Real factor = Real(controller.safety) * pow(error, Real(-1) / Real(error_order + 1));
    return std::clamp(factor, Real(controller.least_factor) / 2, Real(0.9));
  }
};

}  // namespace continuo
