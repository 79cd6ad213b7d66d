// Systems of one type for all equations: each method is compiled once for a kind of state, and not once for each test.
#pragma once
#include <array>
#include <cstddef>
#include <functional>

#include <continuo/numerics/state.hpp>

namespace continuo::testing {

/// M x' = f(t, x) with a diagonal M; all derivatives are left to differences.
template <State X>
struct AnySystem {
  std::function<void(double, const X&, X&)> f;
  std::function<double(std::size_t)> masses{};  // none: all of them 1

  void operator()(double t, const X& x, X& dxdt) const { f(t, x, dxdt); }
  [[nodiscard]] bool has_mass() const { return static_cast<bool>(masses); }
  [[nodiscard]] double mass(std::size_t i) const { return masses ? masses(i) : 1; }
};

using Two = std::array<double, 2>;

/// Equations of their own type as a system of this one.
template <State X = Two>
AnySystem<X> any_system(auto equations) {
  return {.f = [equations](double t, const X& x, X& dxdt) { equations(t, x, dxdt); }};
}

}  // namespace continuo::testing
