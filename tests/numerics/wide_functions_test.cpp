// Powers, sines and cosines of registers beside those of long doubles, which have eleven more bits.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <tests/numerics/wide_functions.hpp>

namespace continuo::wide_functions {
namespace {

using Four = std::array<double, width>;

/// The distance from the exact number, in units of the last place of its double; 0 where both are the same, whatever it
/// is.
double units(double number, long double exact) {
  const auto nearest = static_cast<double>(exact);
  if (number == nearest || (std::isnan(number) && std::isnan(nearest))) return 0;
  if (!std::isfinite(number) || !std::isfinite(nearest)) return HUGE_VAL;
  const double unit = std::nextafter(std::abs(nearest), HUGE_VAL) - std::abs(nearest);
  return static_cast<double>(std::abs(static_cast<long double>(number) - exact) / static_cast<long double>(unit));
}

class WideFunctions : public testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "this processor has no AVX2";
  }
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(generator_); }
  void expect_power(double x, double y, double most) {
    const Four xs{x, 2, x, 0.5}, ys{y, y, 3, y};
    Four result{};
    powers(xs.data(), ys.data(), result.data());
    for (std::size_t i = 0; i < result.size(); ++i)
      ASSERT_LE(units(result[i], std::pow(static_cast<long double>(xs[i]), static_cast<long double>(ys[i]))), most)
          << xs[i] << "^" << ys[i];
  }
  void expect_sine_and_cosine(double x, double most) {
    const Four xs{x, -x, x / 3, 0.1};
    Four sine{}, cosine{};
    sines(xs.data(), sine.data());
    cosines(xs.data(), cosine.data());
    for (std::size_t i = 0; i < sine.size(); ++i) {
      ASSERT_LE(units(sine[i], std::sin(static_cast<long double>(xs[i]))), most) << xs[i];
      ASSERT_LE(units(cosine[i], std::cos(static_cast<long double>(xs[i]))), most) << xs[i];
    }
  }

 private:
  std::mt19937_64 generator_{3};
};

TEST_F(WideFunctions, PowersAreWithinTwoUnitsAlsoOfBasesNearOne) {
  for (int round = 0; round < 20'000; ++round) {
    expect_power(between(0, 10), between(-5, 5), 2);
    expect_power(std::exp(between(-300, 300)), between(-2.3, 2.3), 2);
    expect_power(1 + between(-1e-3, 1e-3), between(-6e5, 6e5), 2);
    expect_power(1 + std::ldexp(between(-1, 1), static_cast<int>(between(-50, -5))), between(-1e12, 1e12), 2);
  }
}

TEST_F(WideFunctions, PowersOutOfTheCommonRangeAreThoseOfTheLibrary) {
  constexpr double infinity = std::numeric_limits<double>::infinity(),
                   nothing = std::numeric_limits<double>::quiet_NaN(), least = 5e-324;
  // libmvec's are within four units, and long doubles below the least normal double have more digits than it.
  for (const double x : {0.0, -0.0, 1.0, -1.0, 2.0, -3.0, 1e300, -1e300, 1e-310, least, infinity, -infinity, nothing})
    for (const double y : {0.0, 1.0, -1.0, 2.0, 3.0, -3.0, 0.5, 1e-300, infinity, -infinity, nothing})
      expect_power(x, y, 4.5);
}

TEST_F(WideFunctions, SinesAndCosinesAreWithinTwoUnitsAlsoNearTheirZeros) {
  for (int round = 0; round < 20'000; ++round) {
    expect_sine_and_cosine(between(-10, 10), 2);
    expect_sine_and_cosine(between(-1e6, 1e6), 2);
    expect_sine_and_cosine(std::floor(between(-6e5, 6e5)) * (std::acos(-1.0) / 2), 2);
    expect_sine_and_cosine(std::ldexp(between(1, 2), static_cast<int>(between(-1000, -1))), 2);
  }
}

TEST_F(WideFunctions, SinesAndCosinesOfLargeNumbersAreThoseOfTheLibrary) {
  for (const double x : {1.1e6, 1e15, 1e300, HUGE_VAL, std::nan(""), 0.0}) expect_sine_and_cosine(x, 4.5);
}

}  // namespace
}  // namespace continuo::wide_functions
