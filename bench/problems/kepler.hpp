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
};

}  // namespace continuo::bench
