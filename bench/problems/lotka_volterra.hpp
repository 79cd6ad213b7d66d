// bench/problems/lotka_volterra.hpp
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// Prey and predators: V. Volterra, "Fluctuations in the abundance of a species considered mathematically", Nature 118
/// (1926). x0 - 3 ln x0 + x1 - 1.5 ln x1 stays 2.
template <class Real = double>
struct LotkaVolterra {
  static constexpr std::string_view name = "lotka_volterra", title = "Lotka-Volterra to t = 10";
  static constexpr std::size_t size = 2;
  static constexpr double duration = 10;
  using State = std::array<Real, size>;

  static State start() { return {Real(1), Real(1)}; }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    dxdt[0] = Real(1.5) * x[0] - x[0] * x[1];
    dxdt[1] = x[0] * x[1] - Real(3) * x[1];
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    write<Scalar<X>>(rows, {Real(1.5) - x[1], -x[0], x[1], x[0] - Real(3)});
  }

  /// From bench/reference/main.cpp; its two runs agree to 2e-25.
  static std::vector<Reference<State>> reference() {
    return {{10, in<Real>({1.026344767575089319138686726_c, 0.9096910781360416175482458835_c})}};
  }
};

}  // namespace continuo::bench
