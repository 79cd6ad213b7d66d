// Forces that are complementary to the rates they cause, held against the conditions that define them, with more
// columns than equations that do not depend on each other.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/contacts/complementarity.hpp>

namespace continuo::complementarity_test {
namespace {

// A = E^T E of a matrix E with fewer rows than columns, whose first row is above 0: E y of no y >= 0 but 0 is 0. So
// forces exist for all rates: where none did, there would be (J. Farkas) a y >= 0 with A y <= 0, thus |E y|^2 <= 0, and
// q y < 0.
TEST(Complementarity, OfDependentColumnsWithAnyRates) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> part(-1, 1);
    const std::size_t rows = 1 + seed % 4, n = rows + seed % 7;
    std::vector<double> e(rows * n), a(n * n), q(n);
    for (double& value : e) value = part(engine);
    for (std::size_t column = 0; column < n; ++column) e[column * rows] = 1.5 + part(engine);
    for (double& value : q) value = part(engine);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t row = 0; row < rows; ++row) a[j * n + i] += e[i * rows + row] * e[j * rows + row];
    const auto f = complementary_forces<double>(a, q, 1e-14);
    ASSERT_EQ(f.size(), n) << "seed " << seed;
    for (std::size_t i = 0; i < n; ++i) {
      double rate = q[i];
      for (std::size_t j = 0; j < n; ++j) rate += a[j * n + i] * f[j];
      EXPECT_GE(f[i], 0);
      EXPECT_GE(rate, -1e-9) << "seed " << seed;
      EXPECT_LE(std::min(f[i], rate), 1e-9) << "seed " << seed;
    }
  }
}
TEST(Complementarity, OfRatesThatNoForcesRaise) {
  const std::vector<double> a{1, -1, -1, 1}, q{-1, 0.5};
  EXPECT_TRUE(complementary_forces<double>(a, q, 1e-14).empty());
}

}  // namespace
}  // namespace continuo::complementarity_test
