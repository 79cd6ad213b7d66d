#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/studies/sweep/distribution.hpp>

namespace continuo::studies::distribution_test {
namespace {

using testing::HasSubstr;

constexpr double half_ulp = 0x1p-53;

/// The integral of g(quantile(u)) over u, by u = Phi(z) and the trapezoidal rule, which is exact to round-off there.
template <class G>
double expectation(const Distribution& d, G g) {
  double sum = 0;
  for (int i = -128; i <= 128; ++i) {
    const double z = i / 16.0;
    sum +=
        g(quantile(d, std::erfc(-z / std::sqrt(2.0)) / 2)) * std::exp(-z * z / 2) / std::sqrt(2 * std::acos(-1.0)) / 16;
  }
  return sum;
}

TEST(Distribution, NormalQuantilesAreThosePublished) {  // OEIS A002115 and others, to 20 digits
  EXPECT_DOUBLE_EQ(quantile(Normal{0, 1}, 0.975), 1.9599639845400542355);
  EXPECT_DOUBLE_EQ(quantile(Normal{0, 1}, 0.75), 0.67448975019608174320);
  EXPECT_DOUBLE_EQ(quantile(Lognormal{2, 1}, 0.75), 2 * std::exp(0.67448975019608174320));
  EXPECT_EQ(quantile(Lognormal{2, 1}, 0.5), 2);
  EXPECT_EQ(quantile(Normal{0, 1}, 0.5), 0);
  EXPECT_EQ(quantile(Normal{0, 1}, 0), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(quantile(Normal{0, 1}, 1), std::numeric_limits<double>::infinity());
}

TEST(Distribution, NormalQuantilesLeadBackToTheirProbabilities) {  // by the error function of the C library
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    double u = std::ldexp(static_cast<double>(random() >> 12) + 0.5, -52);
    if (i % 4 == 0) u = std::pow(u, 40);  // far down the tail
    const double z = quantile(Normal{0, 1}, u);
    const long double back = std::erfc(-static_cast<long double>(z) / std::sqrt(2.0L)) / 2;
    // Half a unit in the last place of z moves u by the density times that.
    const long double density = std::exp(-static_cast<long double>(z) * z / 2) / std::sqrt(2 * std::acos(-1.0L));
    EXPECT_LE(std::abs(back - u), 1.01L * density * std::abs(z) * 2 * half_ulp + 4 * 0x1p-63L * u) << u;
  }
}

TEST(Distribution, MeanAndDeviationAreThoseOfTheQuantity) {
  for (const Distribution& d : {Distribution(Normal{-3, 0.5}), Distribution(Lognormal{0.5, 0.1}),
                                Distribution(Lognormal{2, 0.5}), Distribution(Lognormal{1e-9, 0.01})}) {
    const double m = expectation(d, [](double x) { return x; });
    const double s = std::sqrt(expectation(d, [&](double x) { return (x - m) * (x - m); }));
    EXPECT_NEAR(m / mean(d), 1, 1e-12);
    EXPECT_NEAR(s / deviation(d), 1, 1e-9);
  }
}

TEST(Distribution, UniformAndTriangularLeadBackToTheirProbabilities) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> number(-5, 5), unit(0, 1);
  for (int i = 0; i < 5000; ++i) {
    std::array<double, 3> p{number(random), number(random), number(random)};
    std::ranges::sort(p);
    const double u = unit(random), width = p[2] - p[0];
    EXPECT_NEAR((quantile(Uniform{p[0], p[2]}, u) - p[0]) / width, u, 20 * half_ulp * 5 / width);
    const double x = quantile(Triangular{p[0], p[1], p[2]}, u);
    const double below = x <= p[1] ? (x - p[0]) * (x - p[0]) / width / (p[1] - p[0])
                                   : 1 - (p[2] - x) * (p[2] - x) / width / (p[2] - p[1]);
    EXPECT_NEAR(below, u, 20 * half_ulp * 5 / std::min(p[1] - p[0], p[2] - p[1])) << p[0] << ' ' << p[1] << ' ' << p[2];
  }
}

TEST(Distribution, EndsAreExact) {
  EXPECT_EQ(quantile(Uniform{0.1, 0.7}, 0), 0.1);
  EXPECT_EQ(quantile(Uniform{0.1, 0.7}, 1), 0.7);
  EXPECT_EQ(quantile(Triangular{0.1, 0.2, 0.7}, 0), 0.1);
  EXPECT_EQ(quantile(Triangular{0.1, 0.2, 0.7}, 1), 0.7);
  EXPECT_EQ(quantile(Triangular{0.1, 0.1, 0.7}, 0), 0.1);
  EXPECT_EQ(quantile(Triangular{0.1, 0.7, 0.7}, 1), 0.7);
  EXPECT_EQ(quantile(Uniform{-1e308, 1e308}, 0.5), 0);  // the width is beyond the largest number
}

TEST(Distribution, WithoutSpreadIsAConstant) {
  for (const double u : {0.0, 0.3, 1.0}) {
    EXPECT_EQ(quantile(Normal{2, 0}, u), 2);
    EXPECT_EQ(quantile(Lognormal{2, 0}, u), 2);
    EXPECT_EQ(quantile(Uniform{2, 2}, u), 2);
    EXPECT_EQ(quantile(Triangular{2, 2, 2}, u), 2);
  }
}

TEST(Distribution, HasNoValueOutsideOfZeroToOne) {
  for (const double u : {-0.1, 1.1, std::nan("")}) EXPECT_TRUE(std::isnan(quantile(Normal{}, u))) << u;
}

TEST(Distribution, FaultsSayHowToMendThem) {
  const auto message = [](std::string_view name, std::vector<double> numbers) {
    return distribution_named(name, numbers).status().message;
  };
  EXPECT_THAT(message("normal", {0.5, -0.1}), HasSubstr("normal(0.5, -0.1): the deviation is below 0"));
  EXPECT_THAT(message("uniform", {2, 1}), HasSubstr("write uniform(1, 2)"));
  EXPECT_THAT(message("triangular", {0, 3, 2}), HasSubstr("the mode is not between the ends"));
  EXPECT_THAT(message("lognormal", {-1, 0.1}), HasSubstr("the median is not above 0"));
  EXPECT_THAT(message("lognormal", {1, -0.1}), HasSubstr("the deviation is below 0"));
  EXPECT_THAT(message("normal", {1}), HasSubstr("write normal(mean, deviation)"));
  EXPECT_THAT(message("normal", {1, std::nan("")}), HasSubstr("not finite"));
  EXPECT_THAT(message("gauss", {0, 1}), HasSubstr("there are uniform, normal, lognormal, triangular"));
  EXPECT_TRUE(distribution_named("triangular", std::array{1.0, 1.0, 2.0}).has_value());
}

}  // namespace
}  // namespace continuo::studies::distribution_test
