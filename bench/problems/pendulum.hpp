// bench/problems/pendulum.hpp
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <bench/problems/accelerations.hpp>
#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// The undamped pendulum let go near its highest point, angle'' = -sin angle: its period is the complete elliptic
/// integral 4 K(sin(angle0 / 2)). State (angle, angle').
template <class Real = double>
struct Pendulum : Accelerations {
  static constexpr std::string_view name = "pendulum", title = "Pendulum from 3 rad to t = 10";
  static constexpr std::size_t size = 2;
  static constexpr double duration = 10;
  using State = std::array<Real, size>;

  static State start() { return {Real(3), Real(0)}; }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    using std::sin;
    dxdt[0] = x[1];
    dxdt[1] = -sin(x[0]);
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    using std::cos;
    write<Scalar<X>>(rows, {Scalar<X>(0), Scalar<X>(1), -cos(x[0]), Scalar<X>(0)});
  }

  /// A quarter of the period (the angle falls through 0) and half of it (it comes to rest at -3).
  static constexpr double lowest = 4.0388848430983436909, turns = 8.0777696861966873819;

  /// From bench/reference/main.cpp; its two runs agree to 3e-25.
  static std::vector<Reference<State>> reference() {
    return {{10, in<Real>({-2.650674563598209613232602077_c, 0.4649560983614306252356470758_c})}};
  }
};

}  // namespace continuo::bench
