// continuo/methods/dirk/kvaerno5.hpp
#pragma once
#include <string_view>

#include <continuo/methods/dirk/diagonally_implicit_runge_kutta.hpp>

namespace continuo {

/// Kvaerno's pair of orders 5 and 4, seven stages, the first explicit: both solutions stiffly accurate, the method
/// L-stable, the embedded one A-stable.
/// A. Kvaerno, "Singly diagonally implicit Runge-Kutta methods with an explicit first stage", BIT 44 (2004) 489-502;
/// coefficients to 16 digits.
struct Kvaerno5 : DiagonallyImplicitRungeKutta<Kvaerno5> {
  static constexpr std::string_view name = "kvaerno5";
  static constexpr int order = 5, error_order = 4, dense_degree = 3, dense_order = 3;

 private:
  static constexpr Coefficient g = 0.26_c;

 public:
  static constexpr DiagonalTableau<7, 3> tableau =
      DiagonalTableau<7, 3>{
          .gamma = g,
          .c = {0, 0.52_c, 1.230333209967908_c, 0.8957659843500759_c, 0.43639360985864756_c, 1, 1},
          .a = {{},
                {g, g},
                {0.13_c, 0.84033320996790809_c, g},
                {0.22371961478320505_c, 0.47675532319799699_c, -0.06470895363112615_c, g},
                {0.16648564323248321_c, 0.10450018841591720_c, 0.03631482272098715_c, -0.13090704451073998_c, g},
                {0.13855640231268224_c, 0, -0.04245337201752043_c, 0.02446657898003141_c, 0.61943039072480676_c, g},
                {0.13659751177640291_c, 0, -0.05496908796538376_c, -0.04118626728321046_c, 0.62993304899016403_c,
                 0.06962479448202728_c, g}},
          .b = {0.13659751177640291_c, 0, -0.05496908796538376_c, -0.04118626728321046_c, 0.62993304899016403_c,
                0.06962479448202728_c, g},
          .embedded = {0.13855640231268224_c, 0, -0.04245337201752043_c, 0.02446657898003141_c, 0.61943039072480676_c,
                       g, 0}}
          .with_hermite();
};

}  // namespace continuo
