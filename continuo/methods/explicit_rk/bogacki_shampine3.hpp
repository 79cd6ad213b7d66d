// continuo/methods/explicit_rk/bogacki_shampine3.hpp
#pragma once
#include <string_view>

#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>

namespace continuo {

/// Bogacki and Shampine's 3(2) pair, four stages, first same as last; cubic Hermite between. For loose tolerances.
/// P. Bogacki, L. F. Shampine, "A 3(2) pair of Runge-Kutta formulas", Appl. Math. Lett. 2 (1989) 321-325.
struct BogackiShampine3 : ExplicitRungeKutta<BogackiShampine3> {
  static constexpr std::string_view name = "bogacki_shampine3";
  static constexpr int order = 3, error_order = 2, dense_order = 3;
  static constexpr Tableau<4> tableau{.c = {0, 1_c / 2, 3_c / 4, 1},
                                      .a = {{}, {1_c / 2}, {0, 3_c / 4}, {2_c / 9, 1_c / 3, 4_c / 9, 0}},
                                      .b = {2_c / 9, 1_c / 3, 4_c / 9, 0},
                                      .embedded = {7_c / 24, 1_c / 4, 1_c / 3, 1_c / 8}};
};

}  // namespace continuo
