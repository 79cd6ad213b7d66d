// bench/problems/arenstorf.hpp
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace continuo::bench {

/// The closed orbit of R. F. Arenstorf about earth and moon, in axes that turn with them: E. Hairer, S. P. Norsett,
/// G. Wanner, "Solving Ordinary Differential Equations I", II.0. Step sizes range over a factor of a thousand.
struct Arenstorf {
  static constexpr std::string_view name = "arenstorf", title = "Arenstorf orbit, one period";
  static constexpr std::size_t size = 4;
  static constexpr double duration = 17.0652165601579625588917206249;
  static constexpr std::array<double, size> start() { return {0.994, 0, 0, -2.00158510637908252240537862224}; }

  template <class Real>
  void operator()(const Real&, const std::array<Real, size>& x, std::array<Real, size>& dxdt) const {
    using std::sqrt;
    constexpr double moon = 0.012277471, earth = 1 - moon;
    const Real from_earth = x[0] + Real(moon), from_moon = x[0] - Real(earth), y2 = x[1] * x[1];
    const Real square1 = from_earth * from_earth + y2, square2 = from_moon * from_moon + y2;
    const Real pull1 = Real(earth) / (square1 * sqrt(square1)), pull2 = Real(moon) / (square2 * sqrt(square2));
    dxdt[0] = x[2];
    dxdt[1] = x[3];
    dxdt[2] = x[0] + Real(2) * x[3] - pull1 * from_earth - pull2 * from_moon;
    dxdt[3] = x[1] - Real(2) * x[2] - pull1 * x[1] - pull2 * x[1];
  }
};

}  // namespace continuo::bench
