// continuo/methods/rosenbrock/rosenbrock23.hpp
#pragma once
#include <string_view>

#include <continuo/methods/rosenbrock/rosenbrock_method.hpp>

namespace continuo {

/// The pair of orders 2 and 3 of ode23s: L-stable, three stages, the last of them f at the end of the step. For low
/// accuracy; it gets along with a Jacobian that is not exact.
/// L. F. Shampine, M. W. Reichelt, "The MATLAB ODE Suite", SIAM J. Sci. Comput. 18 (1997) 1-22. There, with
/// d = 1 / (2 + sqrt(2)) and e = 6 + sqrt(2), (M - h d J) k_1 = f_1 + h d f_t, (M - h d J) (k_2 - k_1) = f_2 - M k_1,
/// (M - h d J) k_3 = f_3 - e (M k_2 - f_2) - 2 (M k_1 - f_1) + h d f_t, error = -h (k_1 - 2 k_2 + k_3) / 6; the
/// coefficients below follow with u_1 = h d k_1, u_2 = h d (k_2 - k_1), u_3 = h d (k_3 - e k_2 + (e - 2) k_1).
struct Rosenbrock23 : RosenbrockMethod<Rosenbrock23> {
  static constexpr std::string_view name = "rosenbrock23";
  static constexpr int order = 2, error_order = 2, dense_degree = 2, dense_order = 2;

 private:
  static constexpr Coefficient root2 = 1.41421356237309504880168872420969807856967187537694807318_c;
  static constexpr Coefficient d = 1 / (2 + root2), over_d = 2 + root2, e = 6 + root2;

 public:
  static constexpr RosenbrockTableau<3, 2> tableau{.gamma = d,
                                                   .alpha = {0, 1_c / 2, 1},
                                                   .gamma_sum = {d, 0, -d},
                                                   .a = {{}, {over_d / 2}, {over_d, over_d}},
                                                   .c = {{}, {-over_d}, {-2 * over_d, -e* over_d}},
                                                   .m = {over_d, over_d, 0},
                                                   .error = {-over_d / 6, -(e - 2) * over_d / 6, -over_d / 6},
                                                   .dense = {{0, -(4 + 3 * root2), 0}}};
};

}  // namespace continuo
