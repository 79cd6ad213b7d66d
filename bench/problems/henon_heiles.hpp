// bench/problems/henon_heiles.hpp
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

/// A star in a galaxy with an axis: M. Henon, C. Heiles, "The applicability of the third integral of motion", Astron.
/// J. 69 (1964). State (x, y, x', y'); (x'^2 + y'^2 + x^2 + y^2) / 2 + x^2 y - y^3 / 3 stays what it is.
template <class Real = double>
struct HenonHeiles : Accelerations {
  static constexpr std::string_view name = "henon_heiles", title = "Henon-Heiles to t = 100";
  static constexpr std::size_t size = 4;
  static constexpr double duration = 100;
  using State = std::array<Real, size>;

  static State start() { return in<Real>({0.1_c, 0.1_c, 0.1_c, 0.1_c}); }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    dxdt[0] = x[2];
    dxdt[1] = x[3];
    dxdt[2] = -x[0] - Real(2) * x[0] * x[1];
    dxdt[3] = -x[1] - x[0] * x[0] + x[1] * x[1];
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    using S = Scalar<X>;
    write<S>(rows, {S(0), S(0), S(1), S(0),                                  //
                    S(0), S(0), S(0), S(1),                                  //
                    Real(-2) * x[1] - Real(1), Real(-2) * x[0], S(0), S(0),  //
                    Real(-2) * x[0], Real(2) * x[1] - Real(1), S(0), S(0)});
  }

  /// From bench/reference/main.cpp; its two runs agree to 8e-29.
  static std::vector<Reference<State>> reference() {
    return {{100, in<Real>({-0.1100974472227054862555293192_c, -0.1696026843927303311034467149_c,
                            0.02189125719006017029771625659_c, 0.02875457932418600633159352978_c})}};
  }
};

}  // namespace continuo::bench
