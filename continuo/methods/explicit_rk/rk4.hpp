// continuo/methods/explicit_rk/rk4.hpp
#pragma once
#include <string_view>

#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>

namespace continuo {

/// The classical method of order 4.
/// W. Kutta, "Beitrag zur naeherungsweisen Integration totaler Differentialgleichungen", Z. Math. Phys. 46 (1901).
struct Rk4 : ExplicitRungeKutta<Rk4> {
  static constexpr std::string_view name = "rk4";
  static constexpr int order = 4, dense_order = 3;
  static constexpr Tableau<4> tableau{.c = {0, 1_c / 2, 1_c / 2, 1},
                                      .a = {{}, {1_c / 2}, {0, 1_c / 2}, {0, 0, 1}},
                                      .b = {1_c / 6, 1_c / 3, 1_c / 3, 1_c / 6}};
};

}  // namespace continuo
