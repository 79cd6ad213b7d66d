// continuo/methods/dirk/diagonal_tableau.hpp
// A diagonally implicit Runge-Kutta method as numbers (E. Hairer, G. Wanner, "Solving Ordinary Differential Equations
// II", IV.6; with an explicit first stage: C. A. Kennedy, M. H. Carpenter, "Diagonally implicit Runge-Kutta methods for
// ordinary differential equations. A review", NASA/TM-2016-219173):
//
//   M k_i = f(t + c_i h, x + h sum_j<=i a_ij k_j),   x_new = x + h sum_i b_i k_i,   error = h sum_i (b_i - embedded_i)
//   k_i
#pragma once
#include <cstddef>

#include <continuo/numerics/coefficient.hpp>

namespace continuo {

/// `Stages` stages and an interpolant of degree `Degree` in theta.
template <std::size_t Stages, std::size_t Degree>
struct DiagonalTableau {
  static constexpr std::size_t stages = Stages, degree = Degree, last = Stages - 1;

  Coefficient gamma;  // on the diagonal, but for a first stage that is explicit
  Coefficient c[Stages] = {};
  Coefficient a[Stages][Stages] = {};
  Coefficient b[Stages] = {};
  Coefficient embedded[Stages] = {};
  /// For the nonstiff part of a system that is split; its weights are b.
  Coefficient explicit_a[Stages][Stages] = {};
  /// x(t + theta h) = x + h sum_ni dense[n][i] theta^(n+1) k_i.
  Coefficient dense[Degree][Stages] = {};

  [[nodiscard]] constexpr bool starts_explicit() const { return a[0][0].is_zero(); }
  /// x_new is the argument of the last stage.
  [[nodiscard]] constexpr bool stiffly_accurate() const {
    for (std::size_t j = 0; j < Stages; ++j) {
      if (!(a[last][j] == b[j])) return false;
    }
    return true;
  }
  [[nodiscard]] constexpr bool is_additive() const { return Stages > 1 && !explicit_a[last][0].is_zero(); }

  /// A first guess of k_i from the stages before: sum_j weight k_j. The parabola through the last three that lie at
  /// different times, a line or a constant where there are less.
  [[nodiscard]] constexpr Coefficient predictor(std::size_t i, std::size_t j) const {
    std::size_t node[3] = {}, count = 0;
    for (std::size_t back = i; back-- > 0 && count < 3;) {
      bool is_new = true;
      for (std::size_t n = 0; n < count; ++n) is_new = is_new && !(c[node[n]] == c[back]);
      if (is_new) node[count++] = back;
    }
    Coefficient weight = 0;
    for (std::size_t n = 0; n < count; ++n) {
      if (node[n] != j) continue;
      weight = 1;
      for (std::size_t m = 0; m < count; ++m) {
        if (m != n) weight = weight * (c[i] - c[node[m]]) / (c[j] - c[node[m]]);
      }
    }
    return weight;
  }

  /// With the cubic Hermite interpolant of the values and slopes at both ends, where the first and the last stage are.
  [[nodiscard]] constexpr DiagonalTableau with_hermite() const {
    static_assert(Degree == 3);
    DiagonalTableau result = *this;
    for (std::size_t i = 0; i < Stages; ++i) {
      const int first = i == 0 ? 1 : 0, end = i == last ? 1 : 0;
      result.dense[0][i] = first;
      result.dense[1][i] = 3 * b[i] - (2 * first + end);
      result.dense[2][i] = first + end - 2 * b[i];
    }
    return result;
  }
};

}  // namespace continuo
