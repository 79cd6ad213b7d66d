#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <tests/numerics/random_number.hpp>

#include <continuo/numerics/polynomial_enclosure.hpp>

namespace continuo::polynomial_enclosure_test {
namespace {

struct Sample {
  long double value, slope;
};

Sample exact(const std::vector<double>& c, double theta) {
  long double value = 0, slope = 0;
  for (std::size_t j = c.size(); j-- > 0;) {
    slope = slope * static_cast<long double>(theta) + value;
    value = value * static_cast<long double>(theta) + static_cast<long double>(c[j]);
  }
  return {value, slope};
}

double by_horner(const std::vector<double>& c, double theta) {
  double value = 0;
  for (std::size_t j = c.size(); j-- > 0;) value = value * theta + c[j];
  return value;
}

Enclosure<double> whole(const std::vector<double>& c) {
  return enclose_whole_polynomial<double>(c.size(), [&](std::size_t j) { return c[j]; });
}

/// Coefficients of a step of a smooth motion: each smaller than the one before, besides a possibly large constant.
std::vector<double> random_polynomial(std::mt19937& random, std::size_t degree) {
  std::vector<double> c(degree + 1);
  double size = 1;
  for (double& coefficient : c) coefficient = size * random_number<double>(random), size *= 0.7;
  if (random() % 4 == 0) c[0] += 1e6;
  return c;
}

TEST(PolynomialEnclosure, HoldsValuesAndSlopesOfEveryDegreeOnEveryPart) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 8000; ++trial) {
    const auto c = random_polynomial(random, static_cast<std::size_t>(1 + trial % 15));
    double from = std::abs(random_number<double>(random));
    double to = std::min(1.0, from + std::pow(10.0, -static_cast<double>(random() % 17)));
    if (trial % 5 == 0) from = 0, to = 1;
    const auto range = enclose_polynomial<double>(c, from, to);
    for (int k = 0; k <= 10; ++k) {
      const double theta = std::clamp(from + (to - from) * k / 10, from, to);
      const Sample sample = exact(c, theta);
      ASSERT_GE(sample.value, static_cast<long double>(range.value.lo));
      ASSERT_LE(sample.value, static_cast<long double>(range.value.hi));
      ASSERT_GE(sample.slope, static_cast<long double>(range.slope.lo));
      ASSERT_LE(sample.slope, static_cast<long double>(range.slope.hi));
      ASSERT_TRUE(range.value.holds(by_horner(c, theta)));
      if (from == 0 && to == 1) {
        const auto all = whole(c);
        ASSERT_TRUE(static_cast<long double>(all.lo) <= sample.value &&
                    sample.value <= static_cast<long double>(all.hi) && all.holds(by_horner(c, theta)));
        const auto quick = enclose_whole_polynomial_with_slope<double>(c);
        ASSERT_EQ(quick.value.lo, all.lo);
        ASSERT_EQ(quick.value.hi, all.hi);
        ASSERT_TRUE(static_cast<long double>(quick.slope.lo) <= sample.slope &&
                    sample.slope <= static_cast<long double>(quick.slope.hi));
      }
      const auto point = polynomial_at<double>(c, theta);
      ASSERT_TRUE(static_cast<long double>(point.lo) <= sample.value &&
                  sample.value <= static_cast<long double>(point.hi) && point.holds(by_horner(c, theta)));
    }
  }
}

// The excess is of second order in the width: a tenth of the width leaves a hundredth.
TEST(PolynomialEnclosure, IsTightOnSmallParts) {
  const std::vector<double> c = {1, -3, 2, 0.5, -0.25, 0.1};
  for (const double width : {1e-1, 1e-2, 1e-3, 1e-4}) {
    const double from = 0.3, to = from + width;
    const auto range = enclose_polynomial<double>(c, from, to);
    const auto first = static_cast<double>(exact(c, from).value), last = static_cast<double>(exact(c, to).value);
    const double excess = range.value.hi - range.value.lo - std::abs(last - first);
    EXPECT_LE(excess, 5 * width * width);  // the second derivative is below 10
  }
}

TEST(PolynomialEnclosure, WhatStandsStillIsASingleNumber) {
  const std::vector<double> c = {3, 0, 0, 0};
  const auto range = enclose_polynomial<double>(c, 0, 1);
  EXPECT_TRUE(range.value.is_point() && range.is_steady());
  EXPECT_TRUE(polynomial_at<double>(c, 0.3).is_point());
  EXPECT_TRUE(whole(c).is_point());
  const auto quick = enclose_whole_polynomial_with_slope<double>(c);
  EXPECT_TRUE(quick.value.is_point() && quick.is_steady());
}

// With coefficients that fall to a tenth, slopes that the terms may turn are those that the polynomial may turn.
TEST(PolynomialEnclosure, TermsShowTheSlopeOfWhatHardlyBends) {
  const std::vector<double> c = {5, 1, 0.1, -0.01, 0.001};
  const auto slope = enclose_whole_polynomial_with_slope<double>(c).slope;
  EXPECT_NEAR(slope.lo, 1 - 0.03, 1e-12);
  EXPECT_NEAR(slope.hi, 1 + 0.2 + 0.004, 1e-12);
}

}  // namespace
}  // namespace continuo::polynomial_enclosure_test
