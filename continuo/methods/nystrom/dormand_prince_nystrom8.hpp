// continuo/methods/nystrom/dormand_prince_nystrom8.hpp
#pragma once
#include <string_view>

#include <continuo/methods/nystrom/runge_kutta_nystrom.hpp>

namespace continuo {

/// The 8(6) pair of Dormand, El-Mikkawy and Prince for q'' = a(t, q), nine stages, first same as last.
/// J. R. Dormand, M. E. A. El-Mikkawy, P. J. Prince, "High-order embedded Runge-Kutta-Nystrom formulae", IMA J. Numer.
/// Anal. 7 (1987) 423-430.
struct DormandPrinceNystrom8 : RungeKuttaNystrom<DormandPrinceNystrom8> {
  static constexpr std::string_view name = "dprkn8";
  static constexpr int order = 8, error_order = 6;
  static constexpr int dense_degree = 7, dense_order = 6, dense_rounds = 1;
  static constexpr NystromTableau<9> tableau{
      .c = {0, 1_c / 20, 1_c / 10, 3_c / 10, 1_c / 2, 7_c / 10, 9_c / 10, 1, 1},
      .a = {{},
            {1_c / 800},
            {1_c / 600, 1_c / 300},
            {9_c / 200, -9_c / 100, 9_c / 100},
            {-66701_c / 197352, 28325_c / 32892, -2665_c / 5482, 2170_c / 24669},
            {227015747_c / 304251000, -54897451_c / 30425100, 12942349_c / 10141700, -9499_c / 304251, 539_c / 9250},
            {-1131891597_c / 901789000, 41964921_c / 12882700, -6663147_c / 3220675, 270954_c / 644135, -108_c / 5875,
             114_c / 1645},
            {13836959_c / 3667458, -17731450_c / 1833729, 1063919505_c / 156478208, -33213845_c / 39119552,
             13335_c / 28544, -705_c / 14272, 1645_c / 57088},
            {223_c / 7938, 0, 1175_c / 8064, 925_c / 6048, 41_c / 448, 925_c / 14112, 1175_c / 72576}},
      .b = {223_c / 7938, 0, 1175_c / 8064, 925_c / 6048, 41_c / 448, 925_c / 14112, 1175_c / 72576, 0, 0},
      .bv = {223_c / 7938, 0, 5875_c / 36288, 4625_c / 21168, 41_c / 224, 4625_c / 21168, 5875_c / 36288, 223_c / 7938,
             0},
      .embedded = {7987313_c / 109941300, 0, 1610737_c / 44674560, 10023263_c / 33505920, -497221_c / 12409600,
                   10023263_c / 78180480, 1610737_c / 402071040, 0, 0},
      .embedded_v = {7987313_c / 109941300, 0, 1610737_c / 40207104, 10023263_c / 23454144, -497221_c / 6204800,
                     10023263_c / 23454144, 1610737_c / 40207104, -4251941_c / 54970650, 3_c / 20}};
};

}  // namespace continuo
