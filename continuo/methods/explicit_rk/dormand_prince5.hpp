// continuo/methods/explicit_rk/dormand_prince5.hpp
#pragma once
#include <string_view>

#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>

namespace continuo {

/// Dormand and Prince's 5(4) pair, seven stages, first same as last, with Shampine's interpolant of order 4.
/// J. R. Dormand, P. J. Prince, "A family of embedded Runge-Kutta formulae", J. Comp. Appl. Math. 6 (1980) 19-26;
/// L. F. Shampine, "Some practical Runge-Kutta formulas", Math. Comp. 46 (1986) 135-150.
struct DormandPrince5 : ExplicitRungeKutta<DormandPrince5> {
  static constexpr std::string_view name = "dormand_prince5";
  static constexpr int order = 5, error_order = 4, dense_degree = 4, dense_order = 4;
  static constexpr Tableau<7, 0, 4> tableau{
      .c = {0, 1_c / 5, 3_c / 10, 4_c / 5, 8_c / 9, 1, 1},
      .a = {{},
            {1_c / 5},
            {3_c / 40, 9_c / 40},
            {44_c / 45, -56_c / 15, 32_c / 9},
            {19372_c / 6561, -25360_c / 2187, 64448_c / 6561, -212_c / 729},
            {9017_c / 3168, -355_c / 33, 46732_c / 5247, 49_c / 176, -5103_c / 18656},
            {35_c / 384, 0, 500_c / 1113, 125_c / 192, -2187_c / 6784, 11_c / 84, 0}},
      .b = {35_c / 384, 0, 500_c / 1113, 125_c / 192, -2187_c / 6784, 11_c / 84, 0},
      .embedded = {5179_c / 57600, 0, 7571_c / 16695, 393_c / 640, -92097_c / 339200, 187_c / 2100, 1_c / 40},
      .dense = {{-12715105075_c / 11282082432},
                {},
                {87487479700_c / 32700410799},
                {-10690763975_c / 1880347072},
                {701980252875_c / 199316789632},
                {-1453857185_c / 822651844},
                {69997945_c / 29380423}}};
};

}  // namespace continuo
