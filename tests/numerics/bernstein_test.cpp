#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/bernstein.hpp>
#include <continuo/numerics/root_bracketing.hpp>

namespace continuo::bernstein_test {
namespace {

template <class F>
bernstein::Coefficients coefficients_of(F&& f) {
  std::array<double, bernstein::count> value{};
  for (std::size_t k = 0; k < bernstein::count; ++k) value[k] = f(bernstein::nodes[k]);
  return bernstein::from_values(value);
}

std::vector<std::pair<double, double>> pieces(const bernstein::Coefficients& b) {
  std::vector<std::pair<double, double>> found;
  bernstein::isolate_sign_changes(b, [&](double left, double right) {
    found.emplace_back(left, right);
    return false;
  });
  return found;
}

TEST(Bernstein, CoefficientsOfAPolynomialOfDegreeEightGiveItBack) {
  const auto b = coefficients_of([](double x) { return std::pow(x, 8); });
  for (std::size_t j = 0; j < bernstein::degree; ++j) EXPECT_NEAR(b[j], 0, 1e-13);  // condition number about 500
  EXPECT_EQ(b[8], 1);
}

TEST(Bernstein, EveryRootOfRandomPolynomialsHasAPieceOfItsOwn) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<double> roots(1 + static_cast<std::size_t>(trial % 6));
    for (double& root : roots) root = unit(random);
    std::sort(roots.begin(), roots.end());
    bool apart = true;
    for (std::size_t i = 1; i < roots.size(); ++i) apart = apart && roots[i] - roots[i - 1] > 1e-3;
    if (!apart) continue;
    const auto found = pieces(coefficients_of([&](double x) {
      double product = 1;
      for (const double root : roots) product *= x - root;
      return product;
    }));
    ASSERT_EQ(found.size(), roots.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
      EXPECT_LE(found[i].first, roots[i] + 1e-9);
      EXPECT_GE(found[i].second, roots[i] - 1e-9);
    }
  }
}

TEST(Bernstein, ATouchIsNoChangeOfSign) {
  EXPECT_TRUE(pieces(coefficients_of([](double x) { return (x - 0.4) * (x - 0.4) + 1e-13; })).empty());
}

TEST(Bernstein, TheInterpolationErrorSeesWhatNinePointsDoNotResolve) {
  std::array<double, bernstein::count> rough{}, smooth{};
  for (std::size_t k = 0; k < bernstein::count; ++k) {
    rough[k] = std::sin(40 * bernstein::nodes[k]);
    smooth[k] = std::pow(bernstein::nodes[k], 6);
  }
  EXPECT_GT(bernstein::interpolation_error(rough), 0.1);
  EXPECT_LT(bernstein::interpolation_error(smooth), 1e-15);
}

TEST(RootBracketing, EndsWithNeighbouringNumbersOnBothSidesOfTheRoot) {
  int evaluations = 0;
  const auto root = enclose_root(
      [&](double x) {
        ++evaluations;
        return x * x - 2;
      },
      1.0, 2.0, -1.0, 2.0);
  EXPECT_EQ(root.far, std::nextafter(root.near, 2.0));
  EXPECT_LE(root.near * root.near, 2);
  EXPECT_GT(root.far * root.far, 2);
  EXPECT_LT(evaluations, 20);
}

TEST(RootBracketing, AStepOfHeavisideTakesNoMoreThanThreeTimesTheBits) {
  int evaluations = 0;
  const auto root = enclose_root(
      [&](double x) {
        ++evaluations;
        return x > 0.7 ? 1.0 : -1.0;
      },
      0.0, 1.0, -1.0, 1.0);
  EXPECT_EQ(root.near, 0.7);
  EXPECT_LT(evaluations, 3 * std::numeric_limits<double>::digits);
}

TEST(RootBracketing, ZeroBelongsToTheNearSideAndTimeMayRunBackwards) {
  const auto root = enclose_root([](double x) { return 0.5 - x; }, 1.0, 0.0, -0.5, 0.5);
  EXPECT_EQ(root.near, 0.5);
  EXPECT_EQ(root.far, std::nextafter(0.5, 0.0));
}

// With the rounding of a large number, f is zero over a stretch of many small ones. The strides to its end double, and
// what lies between the last two is halved: twice the logarithm of the count of numbers, after a few secants.
TEST(RootBracketing, TheEndOfAStretchOfZerosTakesTwiceTheLogarithmOfItsNumbers) {
  for (const double large : {27.0, 1e3, 1e6, 1e9}) {
    for (const double place : {0.3, 0.012, 1e-4}) {
      int evaluations = 0;
      const auto f = [&](double s) {
        ++evaluations;
        return (large + (std::exp(s) - std::exp(place))) - large;
      };
      const auto root = enclose_root(f, 0.0, 1.0, f(0), f(1));
      EXPECT_EQ(root.far, std::nextafter(root.near, 1.0));
      EXPECT_LE(f(root.near), 0);
      EXPECT_GT(f(root.far), 0);
      EXPECT_NEAR(root.far, place, std::numeric_limits<double>::epsilon() * large);
      const double numbers = std::numeric_limits<double>::epsilon() * large / (std::nextafter(place, 1) - place);
      EXPECT_LT(evaluations, 2 * std::log2(numbers) + 20) << "to " << large << " at " << place;
    }
  }
}

TEST(RootBracketing, AStretchOfTrueZerosIsLeftAtItsEnd) {
  const auto root = enclose_root([](double x) { return std::max(0.0, x - 0.7); }, 0.0, 1.0, 0.0, 0.3);
  EXPECT_EQ(root.near, 0.7);
  EXPECT_EQ(root.far, std::nextafter(0.7, 1.0));
}

TEST(RootBracketing, AZeroAtTheBeginningIsLeft) {
  const auto root = enclose_root([](double x) { return x * (x - 0.7); }, 0.0, 1.0, 0.0, 0.3);
  EXPECT_EQ(root.far, std::nextafter(root.near, 1.0));
  EXPECT_NEAR(root.far, 0.7, std::numeric_limits<double>::epsilon());
}

}  // namespace
}  // namespace continuo::bernstein_test
