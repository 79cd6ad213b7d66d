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

/// The memory of a controller: the logarithms of the last two errors. A jump of the state clears it.
/// Single precision is enough for a step size and takes a third of the time.
struct ErrorHistory {
  float last = 0, before_last = 0;

  /// The factor for the next step after an accepted one; the error is kept for the steps after.
  float accept(const Controller& controller, int error_order, float error) {
    const float exponent = 1.0F / static_cast<float>(error_order + 1);
    const float here = std::log2(std::max(error, 1e-10F));
    const float filtered = static_cast<float>(controller.beta1) * here + static_cast<float>(controller.beta2) * last +
                           static_cast<float>(controller.beta3) * before_last;
    before_last = last;
    last = here;
    return std::clamp(static_cast<float>(controller.safety) * std::exp2(-exponent * filtered),
                      static_cast<float>(controller.least_factor), static_cast<float>(controller.greatest_factor));
  }

  /// The factor for another try of a rejected step.
  static float reject(const Controller& controller, int error_order, float error) {
    const float exponent = 1.0F / static_cast<float>(error_order + 1);
    return std::clamp(static_cast<float>(controller.safety) * std::exp2(-exponent * std::log2(error)),
                      static_cast<float>(controller.least_factor) / 2, 0.9F);
  }
};

}  // namespace continuo
