// bench/problems/brusselator.hpp
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// I. Prigogine and R. Lefever's oscillating reaction (1968): E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary
/// Differential Equations I", I.16 and II.4.
template <class Real = double>
struct Brusselator {
  static constexpr std::string_view name = "brusselator", title = "Brusselator to t = 20";
  static constexpr std::size_t size = 2;
  static constexpr double duration = 20;
  static constexpr bool autonomous = true;
  using State = std::array<Real, size>;

  static State start() { return {Real(1.5), Real(3)}; }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    const Scalar<X> meet = x[0] * x[0] * x[1];
    dxdt[0] = Real(1) + meet - Real(4) * x[0];
    dxdt[1] = Real(3) * x[0] - meet;
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    const Scalar<X> by0 = Real(2) * x[0] * x[1], by1 = x[0] * x[0];
    write<Scalar<X>>(rows, {by0 - Real(4), by1, Real(3) - by0, -by1});
  }

  /// From bench/reference/main.cpp; its two runs agree to 2e-26.
  static std::vector<Reference<State>> reference() {
    return {{20, in<Real>({0.4986370712683478486498554830_c, 4.596780349452011183201743953_c})}};
  }
};

}  // namespace continuo::bench
