// continuo/methods/dirk/implicit_euler.hpp
#pragma once
#include <string_view>

#include <continuo/methods/dirk/diagonally_implicit_runge_kutta.hpp>

namespace continuo {

/// The implicit (backward) Euler method, L-stable, of order 1. Its error, -h^2 x'' / 2, is estimated by the slopes at
/// both ends, h (x'(t + h) - x'(t)) / 2: the difference to the trapezoidal rule. E. Hairer, G. Wanner, "Solving
/// Ordinary Differential Equations II", IV.3.
struct ImplicitEuler : DiagonallyImplicitRungeKutta<ImplicitEuler> {
  static constexpr std::string_view name = "implicit_euler";
  static constexpr int order = 1, error_order = 1, dense_degree = 3, dense_order = 1;
  static constexpr DiagonalTableau<2, 3> tableau =
      DiagonalTableau<2, 3>{.gamma = 1, .c = {0, 1}, .a = {{}, {0, 1}}, .b = {0, 1}, .embedded = {1_c / 2, 1_c / 2}}
          .with_hermite();
};

}  // namespace continuo
