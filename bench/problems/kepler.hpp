// bench/problems/kepler.hpp
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string_view>

#include <bench/problems/accelerations.hpp>

namespace continuo::bench {

/// A planet on an ellipse of eccentricity 1/2 and half axis 1 about a fixed sun, from the nearest point: a long smooth
/// run in which errors of the period add up.
struct Kepler : Accelerations {
  static constexpr std::string_view name = "kepler", title = "Kepler, e = 0.5, 100 orbits";
  static constexpr std::size_t size = 4;
  static constexpr double duration = 200 * std::numbers::pi;
  static constexpr std::array<double, size> start() { return {0.5, 0, 0, std::numbers::sqrt3}; }

  template <class Real>
  void operator()(const Real&, const std::array<Real, size>& x, std::array<Real, size>& dxdt) const {
    using std::sqrt;
    const Real square = x[0] * x[0] + x[1] * x[1];
    const Real inverse_cube = Real(1) / (square * sqrt(square));
    dxdt[0] = x[2];
    dxdt[1] = x[3];
    dxdt[2] = -x[0] * inverse_cube;
    dxdt[3] = -x[1] * inverse_cube;
  }

  /// The state at any time, by Kepler's equation M = E - e sin E; half axis and eccentricity are those of `start()` as
  /// rounded. The nearest point is where the mean anomaly M begins.
  template <class Real>
  static std::array<Real, size> exact(const Real& t) {
    using std::cos, std::sin, std::sqrt;
    const Real r0(start()[0]), v0(start()[3]);
    const Real half_axis = Real(1) / (Real(2) / r0 - v0 * v0), e = Real(1) - r0 / half_axis;
    const Real per_time = Real(1) / (half_axis * sqrt(half_axis)), mean_anomaly = per_time * t;
    Real anomaly = mean_anomaly;
    for (int i = 0; i < 30; ++i) {  // Newton, from everywhere as e is small
      anomaly -= (anomaly - e * sin(anomaly) - mean_anomaly) / (Real(1) - e * cos(anomaly));
    }
    const Real c = cos(anomaly), s = sin(anomaly), oblate = sqrt(Real(1) - e * e);
    const Real speed = half_axis * per_time / (Real(1) - e * c);
    return {half_axis * (c - e), half_axis * oblate * s, -speed * s, speed * oblate * c};
  }
};

}  // namespace continuo::bench
