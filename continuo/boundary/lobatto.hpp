// Collocation at Lobatto points: the polynomial of degree s that meets the differential equation at s points of an
// interval, both ends among them, so that neighbours join with their derivatives. With s = 4 the ends are of order 6,
// the polynomial of order 5, its derivative of order 4.
// E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", IV.5 (Lobatto IIIA); J. Kierzenka, L. F.
// Shampine, "A BVP solver that controls residual and error", JNAIAM 3 (2008) 27-41.
#pragma once
#include <array>
#include <cstddef>

namespace continuo::boundary {

/// The coefficients of collocation at s points of the unit interval.
template <std::size_t s>
struct LobattoTable {
  static constexpr std::size_t stages = s;
  std::array<double, s> c{};
  /// l_j(theta) = sum_k slope[j][k] theta^k; their integrals from 0: sum_k rise[j][k] theta^(k + 1).
  std::array<std::array<double, s>, s> slope{}, rise{};
  std::array<std::array<double, s>, s> a{};  // a_ij = integral of l_j from 0 to c_i

  /// The integrals at theta: x(t + theta h) = x + h sum_j weights[j] f_j.
  [[nodiscard]] constexpr std::array<double, s> rises(double theta) const {
    std::array<double, s> weights{};
    for (std::size_t j = 0; j < s; ++j) {
      double sum = 0;
      for (std::size_t k = s; k-- > 0;) sum = sum * theta + rise[j][k];
      weights[j] = sum * theta;
    }
    return weights;
  }
  /// The values at theta: x'(t + theta h) = sum_j weights[j] f_j.
  [[nodiscard]] constexpr std::array<double, s> slopes(double theta) const {
    std::array<double, s> weights{};
    for (std::size_t j = 0; j < s; ++j)
      for (std::size_t k = s; k-- > 0;) weights[j] = weights[j] * theta + slope[j][k];
    return weights;
  }
};

/// The table for these points, 0 and 1 among them, by expanding Lagrange's polynomials.
template <std::size_t s>
[[nodiscard]] constexpr LobattoTable<s> make_lobatto(const std::array<double, s>& nodes) {
  LobattoTable<s> table{.c = nodes};
  for (std::size_t j = 0; j < s; ++j) {
    std::array<double, s + 1> product{1};  // of (theta - c_i) / (c_j - c_i), i != j
    std::size_t degree = 0;
    for (std::size_t i = 0; i < s; ++i) {
      if (i == j) continue;
      ++degree;
      const double scale = 1 / (nodes[j] - nodes[i]);
      for (std::size_t k = degree + 1; k-- > 0;)
        product[k] = ((k > 0 ? product[k - 1] : 0) - nodes[i] * (k < degree ? product[k] : 0)) * scale;
    }
    for (std::size_t k = 0; k < s; ++k) {
      table.slope[j][k] = product[k];
      table.rise[j][k] = product[k] / static_cast<double>(k + 1);
    }
  }
  for (std::size_t i = 0; i < s; ++i) {
    const auto weights = table.rises(nodes[i]);
    for (std::size_t j = 0; j < s; ++j) table.a[i][j] = weights[j];
  }
  return table;
}

/// Four points: 0, (5 -+ sqrt 5) / 10, 1.
inline constexpr LobattoTable<4> lobatto4 =
    make_lobatto<4>({0, 0.27639320225002103035908263312687, 0.72360679774997896964091736687313, 1});

}  // namespace continuo::boundary
