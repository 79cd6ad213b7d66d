// A ball that falls from rest and bounces with the coefficient of restitution e, in closed form: with the first flight
// of t1 = sqrt(2 h / g), the second impact is at t2 = t1 (1 + 2 e), and after it
//   x = e^2 g t1 s - g s^2 / 2,   s = t - t2.
#pragma once
#include <array>
#include <cmath>

#include <continuo/solve/event.hpp>

namespace continuo::bouncing_ball {

/// x'' = -g with p = (g, e).
inline constexpr auto fall = [](auto, const auto& x, const auto& p, auto& dxdt) {
  dxdt[0] = x[1];
  dxdt[1] = -p[0];
};
inline auto floor() {
  return falls(
      "floor", [](const auto&, const auto& x) { return x[0]; },
      [](auto& now) {
        now.x[0] = 0;
        now.x[1] = -now.p[1] * now.before[1];
      });
}

/// The height at t after two impacts, and its derivatives by g, e and h.
struct Height {
  double x, by_g, by_e, by_h;
};
inline Height after_two_impacts(double g, double e, double h, double t) {
  const double t1 = std::sqrt(2 * h / g), t2 = t1 * (1 + 2 * e), s = t - t2;
  const double falling = e * e * g * t1 - g * s;  // x'
  const double t1_by_g = -t1 / (2 * g), t1_by_h = t1 / (2 * h);
  return {e * e * g * t1 * s - g * s * s / 2,
          e * e * (t1 + g * t1_by_g) * s - s * s / 2 - falling * t1_by_g * (1 + 2 * e),
          2 * e * g * t1 * s - falling * 2 * t1, e * e * g * t1_by_h * s - falling * t1_by_h * (1 + 2 * e)};
}

}  // namespace continuo::bouncing_ball
