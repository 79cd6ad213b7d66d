// continuo/methods/symplectic/symplectic_euler_position_first.hpp
#pragma once
#include <string_view>

#include <continuo/methods/symplectic/symplectic_composition.hpp>

namespace continuo {

/// Symplectic Euler with the position first, order 1: q_new = q + h v, v_new = v + h a(t + h, q_new, v). It is the loop
///
///   x += h * v;
///   v += h * a(x);
///
/// bit by bit, and so sums without compensation. `SemiImplicitEuler` moves the velocity first. Components in no pair
/// take an explicit Euler step with f at q_new. E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd
/// ed. (2006), VI.3, Theorem 3.3.
struct SymplecticEulerPositionFirst : SymplecticComposition<SymplecticEulerPositionFirst> {
  static constexpr std::string_view name = "symplectic_euler_position_first";
  static constexpr int order = 1;
  static constexpr int dense_degree = SecondOrderMethod::dense_degree, dense_order = 1;
  static constexpr bool compensated = false;
  static constexpr SymplecticTableau<2> tableau{.kick = {0, 1}, .drift = {1, 0}};

  using SecondOrderMethod::interpolate;

  /// It keeps its order where accelerations read velocities, and beside components in no pair.
  template <class System, State X>
  [[nodiscard]] static std::string_view unsupported_reason(const System&, const X&) {
    return {};
  }
};

}  // namespace continuo
