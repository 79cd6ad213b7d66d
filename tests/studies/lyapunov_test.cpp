#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/lyapunov.hpp>

namespace continuo::studies::lyapunov_test {
namespace {

TEST(Lyapunov, OfALinearSystemTheyAreTheRealParts) {  // eigenvalues -0.1 +- 2i and -3
  const auto f = [](double, Values x, Values, std::span<double> out) {
    out[0] = -0.1 * x[0] + 2 * x[1];
    out[1] = -2 * x[0] - 0.1 * x[1];
    out[2] = -3 * x[2] + x[0];
  };
  const auto found = lyapunov_exponents(parametric_system(3, f), {1, 0, 1}, {.duration = 200, .settle = 10});
  ASSERT_TRUE(found.outcome) << describe(found.outcome);
  // The initial direction has decayed to exp(-29) after the settling; averaged over the duration, its error is at most
  // 1/200 of that.
  EXPECT_NEAR(found.exponents[0], -0.1, 2e-2 / 20);
  EXPECT_NEAR(found.exponents[1], -0.1, 2e-2 / 20);
  EXPECT_NEAR(found.exponents[2], -3, 2e-2);
  EXPECT_NEAR(found.averaged, 200, 1e-9);
}

/// J. C. Sprott, "Chaos and Time-Series Analysis" (2003): 0.9056, 0, -14.5723; their sum is the trace, -41/3, at any
/// time.
TEST(Lyapunov, Lorenz) {
  const auto found = lyapunov_exponents(lorenz(28), {1, 1, 1}, {.duration = 10'000});
  ASSERT_TRUE(found.outcome) << describe(found.outcome);
  EXPECT_NEAR(found.exponents[0] + found.exponents[1] + found.exponents[2], -41.0 / 3, 1e-5);
  // One per cent; four standard errors are less, or it would be luck.
  for (const double spread : found.spread) EXPECT_LT(4 * spread, 0.01 * 0.9056);
  EXPECT_NEAR(found.exponents[0], 0.9056, 0.01 * 0.9056);
  EXPECT_NEAR(found.exponents[1], 0, 0.01 * 0.9056);
  EXPECT_NEAR(found.exponents[2], -14.5723, 0.01 * 14.5723);
}

}  // namespace
}  // namespace continuo::studies::lyapunov_test
