// Central differences: ten digits of a smooth function's derivatives, whatever the size of its variables.
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/central_difference.hpp>

namespace continuo {
namespace {

TEST(CentralDifference, KnowsTenDigits) {
  for (const double size : {1e-6, 1.0, 1e6}) {
    const std::vector<double> x{0.5 * size, 2 * size};
    std::vector<double> rows(6);
    difference_jacobian(
        x, [&](std::size_t j) { return central_increment(x[j], size); },
        [&](std::span<const double> at, std::span<double> f) {
          f[0] = std::sin(at[0] / size), f[1] = std::exp(at[1] / size), f[2] = at[0] * at[1];
        },
        std::span(rows));
    const std::vector<double> exact{std::cos(0.5) / size, 0, 0, std::exp(2.0) / size, x[1], x[0]};
    for (std::size_t e = 0; e < rows.size(); ++e) EXPECT_NEAR(rows[e], exact[e], 2e-10 * std::abs(exact[e])) << size;
  }
}

TEST(CentralDifference, IncrementsAreWhatIsReallyAdded) {
  for (const double x : {0.0, 0.1, -1.0 / 3, 1e10})
    EXPECT_EQ((x + central_increment(x, 1.0)) - x, central_increment(x, 1.0));
}

TEST(CentralDifference, LeavesTheVariableAsItWas) {
  double x = 0.1;
  const auto [above, below] = on_both_sides(x, 0.3, [&] { return x; });
  EXPECT_EQ(above, 0.1 + 0.3);
  EXPECT_EQ(below, 0.1 - 0.3);
  EXPECT_EQ(x, 0.1);
}

}  // namespace
}  // namespace continuo
