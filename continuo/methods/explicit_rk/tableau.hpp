// continuo/methods/explicit_rk/tableau.hpp
// An explicit Runge-Kutta method as numbers (Hairer, Norsett, Wanner, "Solving Ordinary Differential Equations I",
// II.1, eq. 1.8; the embedded weights II.4; continuous extensions II.6):
//
//   k_i = f(t + c_i h, x + h sum_j a_ij k_j),   x_new = x + h sum_i b_i k_i,   error = h sum_i (b_i - embedded_i) k_i
#pragma once
#include <algorithm>
#include <cstddef>

#include <continuo/numerics/coefficient.hpp>

namespace continuo {

/// `Stages` stages; `Extra` more that only the interpolant needs; the interpolant's degree in theta (3: cubic Hermite).
template <std::size_t Stages, std::size_t Extra = 0, std::size_t Degree = 3>
struct Tableau {
  static_assert(Degree >= 3, "an interpolant joins values and slopes at both ends: degree 3 at least");
  static constexpr std::size_t stages = Stages, extra = Extra, degree = Degree;
  /// Columns of what the interpolant knows: the stages, f at the end of the step, the extra stages.
  static constexpr std::size_t end = Stages, known = Stages + 1 + Extra;
  static constexpr std::size_t dense_terms = Degree - 3;

  Coefficient c[Stages] = {};
  Coefficient a[Stages][Stages] = {};
  Coefficient b[Stages] = {};
  Coefficient embedded[Stages] = {};
  Coefficient extra_c[std::max<std::size_t>(Extra, 1)] = {};
  Coefficient extra_a[std::max<std::size_t>(Extra, 1)][known] = {};
  /// x(t + theta h) = cubic Hermite + theta^2 (1 - theta)^2 h sum_ij dense[i][j] theta^j k_i: every interpolant that
  /// meets values and slopes at both ends has this form, and in it round-off in the sums vanishes at the ends.
  Coefficient dense[known][std::max<std::size_t>(dense_terms, 1)] = {};

  /// The last stage is f at the end of the step.
  [[nodiscard]] constexpr bool first_same_as_last() const {
    for (std::size_t j = 0; j < Stages; ++j) {
      if (!(a[Stages - 1][j] == b[j])) return false;
    }
    return Stages > 1 && c[Stages - 1] == Coefficient(1);
  }

  /// Takes the interpolant as it is usually published, x + h sum_ij weights[i][j] theta^(j+1) k_i.
  [[nodiscard]] constexpr Tableau with_dense(const Coefficient (&weights)[known][Degree]) const {
    Tableau result = *this;
    for (std::size_t i = 0; i < known; ++i) {
      // The cubic Hermite part of this weight is (3 theta^2 - 2 theta^3) b_i, and the slopes' parts where k_i is f at
      // an end; only its theta^2 and theta^3 matter below. Then divide by theta^2 (1 - theta)^2, lowest power first.
      const Coefficient weight = i < Stages ? b[i] : Coefficient(0);
      const int at_start = i == 0 ? 1 : 0, at_end = i == (first_same_as_last() ? Stages - 1 : end) ? 1 : 0;
      Coefficient rest[Degree - 1];
      for (std::size_t j = 0; j + 1 < Degree; ++j) rest[j] = weights[i][j + 1];
      rest[0] = rest[0] - 3 * weight + (2 * at_start + at_end);
      rest[1] = rest[1] + 2 * weight - (at_start + at_end);
      for (std::size_t j = 0; j < dense_terms; ++j) {
        result.dense[i][j] = rest[j];
        rest[j + 1] = rest[j + 1] + 2 * rest[j];
        if (j + 2 < Degree - 1) rest[j + 2] = rest[j + 2] - rest[j];
      }
    }
    return result;
  }
};

}  // namespace continuo
