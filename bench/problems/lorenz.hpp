// bench/problems/lorenz.hpp
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace continuo::bench {

/// E. N. Lorenz, "Deterministic nonperiodic flow", J. Atmos. Sci. 20 (1963): the cheapest right-hand side of all, so
/// the cost of the stepper itself shows.
struct Lorenz {
  static constexpr std::string_view name = "lorenz", title = "Lorenz to t = 10";
  static constexpr std::size_t size = 3;
  static constexpr double duration = 10;
  static constexpr std::array<double, size> start() { return {1, 0, 0}; }

  template <class Real>
  void operator()(const Real&, const std::array<Real, size>& x, std::array<Real, size>& dxdt) const {
    dxdt[0] = Real(10.0) * (x[1] - x[0]);
    dxdt[1] = x[0] * (Real(28.0) - x[2]) - x[1];
    dxdt[2] = x[0] * x[1] - Real(8.0 / 3.0) * x[2];
  }
};

}  // namespace continuo::bench
