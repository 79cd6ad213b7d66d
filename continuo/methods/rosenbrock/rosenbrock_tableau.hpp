// continuo/methods/rosenbrock/rosenbrock_tableau.hpp
// A Rosenbrock method as numbers, in the variables u_i = sum_j gamma_ij k_j that need no product with J (E. Hairer,
// G. Wanner, "Solving Ordinary Differential Equations II", IV.7, eq. 7.25; with a mass matrix VI.3, eq. 3.4):
//
//   (M / (gamma h) - J) u_i = f(t + alpha_i h, x + sum_j a_ij u_j) + M sum_j (c_ij / h) u_j + gamma_i h df/dt
//   x_new = x + sum_i m_i u_i,   embedded solution = x_new - sum_i error_i u_i
#pragma once
#include <cstddef>

#include <continuo/numerics/coefficient.hpp>

namespace continuo {

/// `Stages` stages and an interpolant of degree `Degree` in theta.
template <std::size_t Stages, std::size_t Degree>
struct RosenbrockTableau {
  static_assert(Degree >= 2);
  static constexpr std::size_t stages = Stages, degree = Degree;

  Coefficient gamma;
  Coefficient alpha[Stages] = {};
  Coefficient gamma_sum[Stages] = {};  // the gamma_i before df/dt
  Coefficient a[Stages][Stages] = {};
  Coefficient c[Stages][Stages] = {};
  Coefficient m[Stages] = {};
  Coefficient error[Stages] = {};
  /// x(t + theta h) = (1 - theta) x + theta (x_new + (1 - theta) (d_0 + theta (d_1 + ...))), d_n = sum_i dense[n][i]
  /// u_i.
  Coefficient dense[Degree - 1][Stages] = {};

  /// f of the last stage is f at the end of the step.
  [[nodiscard]] constexpr bool first_same_as_last() const {
    for (std::size_t j = 0; j < Stages; ++j) {
      if (!(a[Stages - 1][j] == m[j])) return false;
    }
    return alpha[Stages - 1] == Coefficient(1);
  }
};

}  // namespace continuo
