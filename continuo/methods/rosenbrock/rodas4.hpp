// continuo/methods/rosenbrock/rodas4.hpp
#pragma once
#include <string_view>

#include <continuo/methods/rosenbrock/rosenbrock_method.hpp>

namespace continuo {

/// RODAS, the pair of orders 4 and 3 of six stages: L-stable, stiffly accurate, also for systems with algebraic
/// equations of index 1, with an interpolant of order 3. E. Hairer, G. Wanner, "Solving Ordinary Differential Equations
/// II", VI.4; coefficients to the 16 digits of their code.
struct Rodas4 : RosenbrockMethod<Rodas4> {
  static constexpr std::string_view name = "rodas4";
  static constexpr int order = 4, error_order = 3, dense_degree = 3, dense_order = 3;
  static constexpr RosenbrockTableau<6, 3> tableau{
      .gamma = 1_c / 4,
      .alpha = {0, 0.386_c, 0.21_c, 0.63_c, 1, 1},
      .gamma_sum = {1_c / 4, -0.1043_c, 0.1035_c, -0.0362_c, 0, 0},
      .a = {{},
            {1.544_c},
            {0.9466785280815826_c, 0.2557011698983284_c},
            {3.314825187068521_c, 2.896124015972201_c, 0.9986419139977817_c},
            {1.221224509226641_c, 6.019134481288629_c, 12.53708332932087_c, -0.6878860361058950_c},
            {1.221224509226641_c, 6.019134481288629_c, 12.53708332932087_c, -0.6878860361058950_c, 1}},
      .c = {{},
            {-5.6688_c},
            {-2.430093356833875_c, -0.2063599157091915_c},
            {-0.1073529058151375_c, -9.594562251023355_c, -20.47028614809616_c},
            {7.496443313967647_c, -10.24680431464352_c, -33.99990352819905_c, 11.70890893206160_c},
            {8.083246795921522_c, -7.981132988064893_c, -31.52159432874371_c, 16.31930543123136_c,
             -6.058818238834054_c}},
      .m = {1.221224509226641_c, 6.019134481288629_c, 12.53708332932087_c, -0.6878860361058950_c, 1, 1},
      .error = {0, 0, 0, 0, 0, 1},
      .dense = {{10.12623508344586_c, -7.487995877610167_c, -34.80091861555747_c, -7.992771707568823_c,
                 1.025137723295662_c, 0},
                {-0.6762803392801253_c, 6.087714651680015_c, 16.43084320892478_c, 24.76722511418386_c,
                 -6.594389125716872_c, 0}}};
};

}  // namespace continuo
