// Collocation at Gauss points: on each interval a polynomial of degree m that meets the differential equation at the m
// Gauss points. It is held by its values at m + 1 nodes, both ends among them. Its error is of order m + 1 inside of an
// interval and of order 2 m at the ends.
// C. de Boor, B. Swartz, "Collocation at Gaussian points", SIAM J. Numer. Anal. 10 (1973) 582-606.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace continuo::studies {

template <std::size_t m>
struct GaussCollocation {
  std::array<double, m + 1> nodes{};    // in 0..1; Chebyshev's, between which interpolation is well conditioned
  std::array<double, m + 1> weights{};  // of the integral over 0..1 of the polynomial through the nodes, all positive
  std::array<double, m> points{}, point_weights{};            // Gauss
  std::array<std::array<double, m + 1>, m> value{}, slope{};  // of the polynomial at the points, by values at the nodes
  std::array<double, m + 1> highest{};                        // its m-th derivative
  /// The greatest of |int_0^theta prod (s - points_g) ds| / m!: the error inside is that times h^(m+1) x^(m+1).
  double error_constant = 0;

  /// The values at theta of the polynomials that are 1 at one node and 0 at the others.
  [[nodiscard]] std::array<double, m + 1> basis(double theta) const {
    std::array<double, m + 1> values{};
    for (std::size_t j = 0; j <= m; ++j) {
      values[j] = 1;
      for (std::size_t i = 0; i <= m; ++i)
        if (i != j) values[j] *= (theta - nodes[i]) / (nodes[j] - nodes[i]);
    }
    return values;
  }
  [[nodiscard]] std::array<double, m + 1> basis_slopes(double theta) const {
    std::array<double, m + 1> slopes{};
    for (std::size_t j = 0; j <= m; ++j) {
      for (std::size_t k = 0; k <= m; ++k) {
        if (k == j) continue;
        double product = 1 / (nodes[j] - nodes[k]);
        for (std::size_t i = 0; i <= m; ++i)
          if (i != j && i != k) product *= (theta - nodes[i]) / (nodes[j] - nodes[i]);
        slopes[j] += product;
      }
    }
    return slopes;
  }
};

template <std::size_t m>
[[nodiscard]] GaussCollocation<m> make_gauss_collocation() {
  GaussCollocation<m> table;
  for (std::size_t j = 0; j <= m; ++j)
    table.nodes[j] = (1 - std::cos(std::numbers::pi * static_cast<double>(j) / static_cast<double>(m))) / 2;
  for (std::size_t g = 0; g < m; ++g) {  // the zeros of Legendre's polynomial, by Newton from Tricomi's guess
    double x = -std::cos(std::numbers::pi * (static_cast<double>(g) + 0.75) / (static_cast<double>(m) + 0.5));
    double slope = 0;
    for (int k = 0; k < 8; ++k) {
      double before = 1, here = x;
      for (std::size_t d = 2; d <= m; ++d) {
        const auto degree = static_cast<double>(d);
        const double next = ((2 * degree - 1) * x * here - (degree - 1) * before) / degree;
        before = here;
        here = next;
      }
      slope = static_cast<double>(m) * (x * here - before) / (x * x - 1);
      x -= here / slope;
    }
    table.points[g] = (1 + x) / 2;
    table.point_weights[g] = 1 / ((1 - x * x) * slope * slope);
    table.value[g] = table.basis(table.points[g]);
    table.slope[g] = table.basis_slopes(table.points[g]);
    for (std::size_t j = 0; j <= m; ++j) table.weights[j] += table.point_weights[g] * table.value[g][j];
  }
  double factorial = 1;
  for (std::size_t d = 2; d <= m; ++d) factorial *= static_cast<double>(d);
  for (std::size_t j = 0; j <= m; ++j) {
    table.highest[j] = factorial;
    for (std::size_t i = 0; i <= m; ++i)
      if (i != j) table.highest[j] /= table.nodes[j] - table.nodes[i];
  }
  constexpr int samples = 64;
  for (int k = 1; k <= samples; ++k) {
    const double theta = static_cast<double>(k) / samples;
    double integral = 0;
    for (std::size_t g = 0; g < m; ++g) {
      double product = theta * table.point_weights[g];
      for (const double point : table.points) product *= theta * table.points[g] - point;
      integral += product;
    }
    table.error_constant = std::max(table.error_constant, std::abs(integral) / factorial);
  }
  return table;
}

}  // namespace continuo::studies
