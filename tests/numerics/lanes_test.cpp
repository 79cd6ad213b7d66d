// The lanes of continuo/numerics/lanes.hpp, by its documentation.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <continuo/numerics/lanes.hpp>
#include <continuo/numerics/state.hpp>

namespace continuo::lanes_test {
namespace {

template <class L>
class LanesOf : public testing::Test {};
/// One register, two registers, a register of floats, odd widths, and a type without registers.
using Widths = testing::Types<Lanes<double, 2>, Lanes<double, 4>, Lanes<double, 8>, Lanes<float, 4>, Lanes<double, 1>,
                              Lanes<double, 3>, Lanes<long double, 4>>;
TYPED_TEST_SUITE(LanesOf, Widths);

template <class L>
L random_lanes(std::mt19937_64& generator, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  L result;
  for (std::size_t i = 0; i < L::width; ++i) result.set(i, static_cast<typename L::Scalar>(uniform(generator)));
  return result;
}

TYPED_TEST(LanesOf, ArithmeticGivesTheBitsOfEachNumberAlone) {
  std::mt19937_64 generator(1);
  for (int round = 0; round < 1000; ++round) {
    const auto a = random_lanes<TypeParam>(generator, -100, 100), b = random_lanes<TypeParam>(generator, -1, 1);
    const TypeParam sum = a + b, difference = a - b, product = a * b, quotient = a / b, root = sqrt(abs(a));
    const TypeParam larger = max(a, b), smaller = min(a, b), down = floor(a), up = ceil(a);
    for (std::size_t i = 0; i < TypeParam::width; ++i) {
      EXPECT_EQ(sum[i], a[i] + b[i]);
      EXPECT_EQ(difference[i], a[i] - b[i]);
      EXPECT_EQ(product[i], a[i] * b[i]);
      EXPECT_EQ(quotient[i], a[i] / b[i]);
      EXPECT_EQ(root[i], std::sqrt(std::abs(a[i])));
      EXPECT_EQ(larger[i], std::max(a[i], b[i]));
      EXPECT_EQ(smaller[i], std::min(a[i], b[i]));
      EXPECT_EQ(down[i], std::floor(a[i]));
      EXPECT_EQ(up[i], std::ceil(a[i]));
    }
  }
}

TYPED_TEST(LanesOf, ComparisonsAndSelectGoLaneByLane) {
  std::mt19937_64 generator(2);
  const auto a = random_lanes<TypeParam>(generator, -1, 1);
  TypeParam b = -a;
  b.set(0, a[0]);
  const auto less = a < b, equal = a == b, at_least = a >= b;
  const TypeParam chosen = select(less, a, b);
  for (std::size_t i = 0; i < TypeParam::width; ++i) {
    EXPECT_EQ(less[i], a[i] < b[i]);
    EXPECT_EQ(equal[i], a[i] == b[i]);
    EXPECT_EQ(at_least[i], !(a[i] < b[i]));
    EXPECT_EQ(chosen[i], a[i] < b[i] ? a[i] : b[i]);
    EXPECT_EQ((less | equal)[i], a[i] <= b[i]);
    EXPECT_FALSE((less & equal)[i]);
  }
  EXPECT_TRUE(any(equal));
  EXPECT_TRUE(all(less | !less));
  EXPECT_TRUE(none(less & !less));
}

TYPED_TEST(LanesOf, NumbersThatAreNotFiniteAreSeen) {
  TypeParam a(1);
  EXPECT_TRUE(all(isfinite(a)));
  a.set(TypeParam::width - 1, std::numeric_limits<typename TypeParam::Scalar>::quiet_NaN());
  EXPECT_TRUE(isnan(a)[TypeParam::width - 1]);
  EXPECT_FALSE(all(isfinite(a)));
  a.set(TypeParam::width - 1, std::numeric_limits<typename TypeParam::Scalar>::infinity());
  EXPECT_FALSE(any(isnan(a)));
  EXPECT_FALSE(isfinite(a)[TypeParam::width - 1]);
}

/// The distance of two doubles in units in the last place of the second.
double ulps(double value, double exact) {
  if (value == exact || (std::isnan(value) && std::isnan(exact))) return 0;
  return std::abs(value - exact) / (std::nextafter(std::abs(exact), HUGE_VAL) - std::abs(exact));
}

template <class F>
void expect_close(const char* name, double low, double high, F f) {
  std::mt19937_64 generator(3);
  for (int round = 0; round < 20000; ++round) {
    const auto x = random_lanes<Lanes<double, 4>>(generator, low, high);
    const auto y = f(x);
    for (std::size_t i = 0; i < 4; ++i) {
      // The stated accuracy of libmvec, with a unit for the rounding of <cmath> itself.
      ASSERT_LE(ulps(y[i], f(x[i])), 5) << name << "(" << x[i] << ")";
    }
  }
}

TEST(Lanes, ElementaryFunctionsAgreeWithOneNumberAtATime) {
  // clang-format off
  expect_close("sin", -1e5, 1e5, [](auto x) { using std::sin; return sin(x); });
  expect_close("cos", -1e5, 1e5, [](auto x) { using std::cos; return cos(x); });
  expect_close("tan", -10, 10, [](auto x) { using std::tan; return tan(x); });
  expect_close("asin", -1, 1, [](auto x) { using std::asin; return asin(x); });
  expect_close("acos", -1, 1, [](auto x) { using std::acos; return acos(x); });
  expect_close("atan", -10, 10, [](auto x) { using std::atan; return atan(x); });
  expect_close("sinh", -5, 5, [](auto x) { using std::sinh; return sinh(x); });
  expect_close("cosh", -5, 5, [](auto x) { using std::cosh; return cosh(x); });
  expect_close("tanh", -5, 5, [](auto x) { using std::tanh; return tanh(x); });
  expect_close("exp", -740, 709, [](auto x) { using std::exp; return exp(x); });
  expect_close("log", 0, 10, [](auto x) { using std::log; return log(x); });
  expect_close("log10", 0, 1e6, [](auto x) { using std::log10; return log10(x); });
  expect_close("cbrt", -10, 10, [](auto x) { using std::cbrt; return cbrt(x); });
  expect_close("pow", 0, 1e10, [](auto x) { using std::pow; return pow(x, -7.3); });
  expect_close("square", -10, 10, [](auto x) { using std::pow; return pow(x, 2); });
  expect_close("atan2", -10, 10, [](auto x) { using std::atan2; return atan2(x, -0.7); });
  expect_close("hypot", -10, 10, [](auto x) { using std::hypot; return hypot(x, 0.7); });
  // clang-format on
}

// The bits of f(a, b) alone, in the last lane of W whose others hold neighbours of all kinds.
template <std::size_t W, class F>
void expect_independent(const char* name, F f) {
  std::mt19937_64 generator(11);
  constexpr double special[] = {0.0, -1.0, 1e300, 1e-320, -1e5, 0.5, HUGE_VAL, NAN};
  for (int round = 0; round < 2000; ++round) {
    auto x = random_lanes<Lanes<double, W>>(generator, -3, 3), y = random_lanes<Lanes<double, W>>(generator, -3, 3);
    const double alone = f(Lanes<double, 1>(x[W - 1]), Lanes<double, 1>(y[W - 1]))[0];
    for (std::size_t i = 0; i + 1 < W; ++i)
      if (generator() % 2 == 0) x.set(i, special[generator() % 8]), y.set(i, special[generator() % 8]);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(f(x, y)[W - 1]), std::bit_cast<std::uint64_t>(alone))
        << name << "(" << x[W - 1] << ", " << y[W - 1] << ")";
  }
}

TEST(Lanes, NoLaneDependsOnItsNeighboursOrOnTheWidth) {
  const auto for_each_width = [](const char* name, auto f) {
    expect_independent<2>(name, f);
    expect_independent<3>(name, f);
    expect_independent<8>(name, f);
  };
  // clang-format off
  for_each_width("sin", [](auto x, auto) { return sin(x); });
  for_each_width("cos", [](auto x, auto) { return cos(x); });
  for_each_width("tan", [](auto x, auto) { return tan(x); });
  for_each_width("asin", [](auto x, auto) { return asin(x); });
  for_each_width("acos", [](auto x, auto) { return acos(x); });
  for_each_width("atan", [](auto x, auto) { return atan(x); });
  for_each_width("sinh", [](auto x, auto) { return sinh(x); });
  for_each_width("cosh", [](auto x, auto) { return cosh(x); });
  for_each_width("tanh", [](auto x, auto) { return tanh(x); });
  for_each_width("exp", [](auto x, auto) { return exp(x); });
  for_each_width("log", [](auto x, auto) { return log(abs(x)); });
  for_each_width("log10", [](auto x, auto) { return log10(abs(x)); });
  for_each_width("cbrt", [](auto x, auto) { return cbrt(x); });
  for_each_width("pow", [](auto x, auto y) { return pow(abs(x), y); });
  for_each_width("atan2", [](auto x, auto y) { return atan2(x, y); });
  for_each_width("hypot", [](auto x, auto y) { return hypot(x, y); });
  // clang-format on
}

TEST(Lanes, SpecialCasesAreThoseOfTheStandard) {
  const Lanes<double, 4> x(std::array{0.0, -1.0, 1e300, -0.0});
  const auto zeroth = pow(x, 0), inverse = pow(x, -1), root = sqrt(x), angle = atan2(x, x), length = hypot(x, x);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(zeroth[i], 1);
    EXPECT_LE(ulps(inverse[i], std::pow(x[i], -1)), 4);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(angle[i]), std::bit_cast<std::uint64_t>(std::atan2(x[i], x[i])));
    EXPECT_LE(ulps(length[i], std::hypot(x[i], x[i])), 4);
    EXPECT_EQ(std::isnan(root[i]), x[i] < 0);
  }
}

TEST(Lanes, AFunctionOfItsScalarTakesThemUnchanged) {
  const auto f = [](auto x) {
    using std::max;
    using std::sin;
    return 2 * max(x, 0.5) + sin(x) / 3;
  };
  const Lanes<double, 4> x(std::array{0.1, 0.6, -2.0, 3.0});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(f(x)[i], f(x[i]), 1e-15);
  static_assert(State<std::array<Lanes<double, 4>, 3>>);
}

}  // namespace
}  // namespace continuo::lanes_test
