// continuo/methods/nystrom/dormand_prince_nystrom6.hpp
#pragma once
#include <string_view>

#include <continuo/methods/nystrom/runge_kutta_nystrom.hpp>

namespace continuo {

/// The 6(4) pair of Dormand and Prince for q'' = a(t, q) with dense output (RKN6(4)6FD), six stages, first same as
/// last. Between the ends positions are of order 6 and velocities of order 5, without a further evaluation. J. R.
/// Dormand, P. J. Prince, "Runge-Kutta-Nystrom triples", Comput. Math. Appl. 13 (1987) 937-949.
struct DormandPrinceNystrom6 : RungeKuttaNystrom<DormandPrinceNystrom6> {
  static constexpr std::string_view name = "dprkn6";
  static constexpr int order = 6, error_order = 4, dense_degree = 6, dense_order = 5;

  static constexpr Coefficient root = 92.633687176966026239908952111858919252149241729_c;  // of 8581
  static constexpr NystromTableau<6> tableau{
      .c = {0, (209 - root) / 900, (209 - root) / 450, (209 + root) / 450, 9_c / 10, 1},
      .a = {{},
            {(26131 - 209 * root) / 810000},
            {(26131 - 209 * root) / 607500, (26131 - 209 * root) / 303750},
            {(980403512254 + 7781688431 * root) / 11694469921875,
             -(1262884486208 + 15385481287 * root) / 11694469921875,
             (7166233891441 + 78694563299 * root) / 46777879687500},
            {-9 * (329260 + 3181 * root) / 27040000, 27 * (35129 + 3331 * root) / 13520000,
             -27 * (554358343 + 31040327 * root) / 464060480000, 153 * (8555257 - 67973 * root) / 2745920000},
            {329_c / 4212, 0, (84119543 + 366727 * root) / 409622616, (84119543 - 366727 * root) / 409622616,
             200_c / 17901}},
      .b = {329_c / 4212, 0, (84119543 + 366727 * root) / 409622616, (84119543 - 366727 * root) / 409622616,
            200_c / 17901, 0},
      .bv = {329_c / 4212, 0, (389225579 + 96856 * root) / 1024056540, (389225579 - 96856 * root) / 1024056540,
             2000_c / 17901, 1_c / 20},
      .embedded = {(2701 + 23 * root) / 4563, -(9829 + 131 * root) / 9126, 5 * (1798 + 17 * root) / 9126, 0, 0, 0},
      .embedded_v = {115_c / 2106, 0, (84119543 + 366727 * root) / 256014135, (84119543 - 366727 * root) / 256014135,
                     6950_c / 17901, -1_c / 10}};
  static constexpr NystromDense<6, 5> dense{
      {{1_c / 2, -5244_c / 4212, 6386_c / 4212, -3819_c / 4212, 900_c / 4212},
       {},
       {0, 18 * (81356461 + 25954829 * root) / 22529243880, (22190560391 - 1109665151 * root) / 22529243880,
        -6 * (4929647204 - 156109769 * root) / 22529243880, 1800 * (5860823 - 152228 * root) / 22529243880},
       {0, 18 * (81356461 - 25954829 * root) / 22529243880, (22190560391 + 1109665151 * root) / 22529243880,
        -6 * (4929647204 + 156109769 * root) / 22529243880, 1800 * (5860823 + 152228 * root) / 22529243880},
       {0, 39000_c / 17901, -124000_c / 17901, 130200_c / 17901, -45000_c / 17901},
       {0, -117_c / 110, 757_c / 220, -823_c / 220, 15_c / 11}}};
};

}  // namespace continuo
