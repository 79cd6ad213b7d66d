// GMRES against known solutions, from which the right-hand sides are computed.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/gmres.hpp>

namespace continuo::gmres_test {
namespace {

/// Not symmetric, with a spread of eigenvalues from about 1 to n / 4.
void multiply(const std::vector<double>& v, std::vector<double>& product) {
  const std::size_t n = v.size();
  for (std::size_t i = 0; i < n; ++i) {
    product[i] = (1 + static_cast<double>(i) / 4) * v[i];
    if (i > 0) product[i] -= 0.5 * v[i - 1];
    if (i + 1 < n) product[i] += 0.25 * v[i + 1];
  }
}

std::vector<double> wanted(std::size_t n) {
  std::vector<double> y(n);
  for (std::size_t i = 0; i < n; ++i) y[i] = std::cos(static_cast<double>(i));
  return y;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

// The eigenvalues of the symmetric part are above 1 - 2/8 = 3/4 (Gershgorin): the error is below 4/3 of the residual.
TEST(Gmres, SolvesToTheTargetWithAndWithoutRestarts) {
  for (const std::size_t vectors : {5U, 20U, 100U}) {
    for (const double target : {1e-3, 1e-8}) {
      auto y = wanted(60), b = y;
      multiply(y, b);
      Gmres<std::vector<double>> gmres(b, vectors);
      const auto result = gmres.solve(multiply, b, target, 1000);
      EXPECT_TRUE(result.converged) << vectors;
      EXPECT_LT(distance(b, y), 4 * target / 3) << vectors;
    }
  }
}

// In exact arithmetic n products are enough; so many it takes where all n eigenvalues differ and none may be left out.
TEST(Gmres, EndsAfterAsManyProductsAsUnknowns) {
  auto y = wanted(12), b = y;
  multiply(y, b);
  Gmres<std::vector<double>> gmres(b, 50);
  const auto result = gmres.solve(multiply, b, 1e-12, 1000);
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.products, 13U);
  EXPECT_LT(distance(b, y), 1e-11);
}

TEST(Gmres, SaysWhenItDoesNotArrive) {
  auto y = wanted(200), b = y;
  multiply(y, b);
  const auto right = b;
  Gmres<std::vector<double>> gmres(b, 5);
  const auto result = gmres.solve(multiply, b, 1e-12, 7);
  EXPECT_FALSE(result.converged);
  auto product = b;
  multiply(b, product);
  EXPECT_LT(distance(product, right), distance(right, std::vector<double>(200, 0)));  // its best approximation

  // A singular matrix and a right-hand side outside of its range.
  std::array<double, 2> c{1, 1};
  Gmres<std::array<double, 2>> small(c, 5);
  const auto project = [](const auto& v, auto& image) { image = {v[0], 0}; };
  EXPECT_FALSE(small.solve(project, c, 1e-12, 50).converged);
  EXPECT_NEAR(c[0], 1, 1e-12);
}

TEST(Gmres, WhatIsNotFiniteIsNotHidden) {
  std::array<double, 2> b{1, 1};
  Gmres<std::array<double, 2>> gmres(b, 5);
  const auto broken = [](const auto& v, auto& image) { image = {v[0], std::numeric_limits<double>::quiet_NaN()}; };
  EXPECT_FALSE(gmres.solve(broken, b, 1e-12, 50).converged);
  EXPECT_TRUE(std::isnan(b[0]));
}

}  // namespace
}  // namespace continuo::gmres_test
