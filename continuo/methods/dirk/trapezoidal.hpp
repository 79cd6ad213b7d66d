// continuo/methods/dirk/trapezoidal.hpp
#pragma once
#include <string_view>

#include <continuo/methods/dirk/diagonally_implicit_runge_kutta.hpp>

namespace continuo {

/// The trapezoidal rule, for partial differential equations known as the method of Crank and Nicolson: A-stable, of
/// order 2, with fixed steps. It keeps the oscillations that it does not resolve; TR-BDF2 damps them. J. Crank, P.
/// Nicolson, Proc. Cambridge Phil. Soc. 43 (1947) 50-67.
struct Trapezoidal : DiagonallyImplicitRungeKutta<Trapezoidal> {
  static constexpr std::string_view name = "trapezoidal";
  static constexpr int order = 2, dense_degree = 3, dense_order = 2;
  static constexpr DiagonalTableau<2, 3> tableau =
      DiagonalTableau<2, 3>{.gamma = 1_c / 2, .c = {0, 1}, .a = {{}, {1_c / 2, 1_c / 2}}, .b = {1_c / 2, 1_c / 2}}
          .with_hermite();
};

}  // namespace continuo
