// continuo/methods/dirk/implicit_midpoint.hpp
#pragma once
#include <string_view>

#include <continuo/methods/dirk/diagonally_implicit_runge_kutta.hpp>

namespace continuo {

/// The implicit midpoint rule, Gauss's method of one stage: A-stable, symplectic, of order 2, with fixed steps. Its
/// interpolant is its collocation polynomial, a line.
/// E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", II.1.3 and VI.4.
struct ImplicitMidpoint : DiagonallyImplicitRungeKutta<ImplicitMidpoint> {
  static constexpr std::string_view name = "implicit_midpoint";
  static constexpr int order = 2, dense_degree = 1, dense_order = 1;
  static constexpr DiagonalTableau<1, 1> tableau{
      .gamma = 1_c / 2, .c = {1_c / 2}, .a = {{1_c / 2}}, .b = {1}, .dense = {{1}}};
};

}  // namespace continuo
