// continuo/methods/explicit_rk/rk38.hpp
#pragma once
#include <string_view>

#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>

namespace continuo {

/// The 3/8 rule, order 4, with smaller error constants than the classical method.
/// W. Kutta, "Beitrag zur naeherungsweisen Integration totaler Differentialgleichungen", Z. Math. Phys. 46 (1901).
struct Rk38 : ExplicitRungeKutta<Rk38> {
  static constexpr std::string_view name = "rk38";
  static constexpr int order = 4, dense_order = 3;
  static constexpr Tableau<4> tableau{.c = {0, 1_c / 3, 2_c / 3, 1},
                                      .a = {{}, {1_c / 3}, {-1_c / 3, 1}, {1, -1, 1}},
                                      .b = {1_c / 8, 3_c / 8, 3_c / 8, 1_c / 8}};
};

}  // namespace continuo
