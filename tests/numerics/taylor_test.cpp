// Series against closed forms and against differences in long double; comparisons just after the instant; bounds of the
// rounding against the same series in long double.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/taylor.hpp>

namespace continuo::taylor_test {
namespace {

using Series = Taylor<double, 3>;
using Wide = Taylor<long double, 3>;
using Bounded = Taylor<Rounded<double>, 3>;

template <class T = Series>
T series(double a, double b, double c, double d) {
  T made;
  made.c = {typename T::Scalar(a), typename T::Scalar(b), typename T::Scalar(c), typename T::Scalar(d)};
  return made;
}

/// A function of two numbers of every kind, and where both arguments may lie.
struct Function {
  std::string name;
  double low, high;
  std::function<long double(long double, long double)> number;
  std::function<Wide(Wide, Wide)> wide;
  std::function<Bounded(Bounded, Bounded)> bounded;

  template <class F>
  Function(std::string name_, double low_, double high_, F f)
      : name(std::move(name_)), low(low_), high(high_), number(f), wide(f), bounded(f) {}
};

std::vector<Function> smooth_functions() {
  using std::sqrt, std::sin, std::cos, std::tan, std::asin, std::acos, std::atan, std::sinh, std::cosh, std::tanh,
      std::exp, std::log, std::log10, std::pow, std::hypot, std::atan2;
  return {
      {"+", -2, 2, [](auto a, auto b) { return a + b; }},
      {"-", -2, 2, [](auto a, auto b) { return a - b; }},
      {"negated", -2, 2, [](auto a, auto) { return -a; }},
      {"*", -2, 2, [](auto a, auto b) { return a * b; }},
      {"/", 0.6, 2, [](auto a, auto b) { return a / b; }},
      {"sqrt", 0.6, 2, [](auto a, auto) { return sqrt(a); }},
      {"sin", -2, 2, [](auto a, auto) { return sin(a); }},
      {"cos", -2, 2, [](auto a, auto) { return cos(a); }},
      {"tan", -0.5, 0.5, [](auto a, auto) { return tan(a); }},
      {"asin", -0.4, 0.4, [](auto a, auto) { return asin(a); }},
      {"acos", -0.4, 0.4, [](auto a, auto) { return acos(a); }},
      {"atan", -2, 2, [](auto a, auto) { return atan(a); }},
      {"sinh", -2, 2, [](auto a, auto) { return sinh(a); }},
      {"cosh", -2, 2, [](auto a, auto) { return cosh(a); }},
      {"tanh", -2, 2, [](auto a, auto) { return tanh(a); }},
      {"exp", -2, 2, [](auto a, auto) { return exp(a); }},
      {"log", 0.6, 2, [](auto a, auto) { return log(a); }},
      {"log10", 0.6, 2, [](auto a, auto) { return log10(a); }},
      {"pow", 0.6, 2, [](auto a, auto b) { return pow(a, b); }},
      {"cube", -2, 2, [](auto a, auto) { return pow(a, decltype(a)(3)); }},
      {"reciprocal square", 0.6, 2, [](auto a, auto) { return pow(a, decltype(a)(-2)); }},
      {"20th power", 0.6, 1.2, [](auto a, auto) { return pow(a, decltype(a)(20)); }},
      {"power 1.7", 0.6, 2, [](auto a, auto) { return pow(a, decltype(a)(1.7)); }},
      {"hypot", 0.6, 2, [](auto a, auto b) { return hypot(a, b); }},
      {"atan2", 0.6, 2, [](auto a, auto b) { return atan2(a, b); }},
      {"atan2 to the left", 0.6, 2, [](auto a, auto b) { return atan2(a, -b); }},
  };
}

/// Two arguments with random coefficients.
template <class T>
std::array<T, 2> arguments_of(const Function& function, std::mt19937& engine) {
  std::uniform_real_distribution<double> value(function.low, function.high), slope(-0.4, 0.4);
  std::array<T, 2> arguments;
  for (T& argument : arguments) {
    for (std::size_t k = 0; k < 4; ++k) argument.c[k] = typename T::Scalar(k == 0 ? value(engine) : slope(engine));
  }
  return arguments;
}

// Central differences over nine points; B. Fornberg, "Generation of finite difference formulas on arbitrarily spaced
// grids", Math. Comp. 51 (1988), table 1. With h = 0.003 what they leave out is at most 0.014 h^6 times the ninth
// derivative, 4e6 for a logarithm at 0.6: 4e-11; of the third derivative the rounding is 1e-19/h^3, of the same size.
// Powers and quotients of such arguments have ten times as much.
TEST(Taylor, HasTheDerivativesThatDifferencesShow) {
  constexpr long double h = 0.003L;
  constexpr std::array<std::array<long double, 5>, 3> weights{{
      {0, 4.0L / 5, -1.0L / 5, 4.0L / 105, -1.0L / 280},
      {-205.0L / 72, 8.0L / 5, -1.0L / 5, 8.0L / 315, -1.0L / 560},
      {0, -61.0L / 30, 169.0L / 120, -3.0L / 10, 7.0L / 240},
  }};
  std::mt19937 engine(1);
  for (const Function& function : smooth_functions()) {
    for (int trial = 0; trial < 20; ++trial) {
      const auto [a, b] = arguments_of<Wide>(function, engine);
      const auto at = [](const Wide& x, long double s) { return x.c[0] + s * (x.c[1] + s * (x.c[2] + s * x.c[3])); };
      const auto f = [&, x = a, y = b](long double s) { return function.number(at(x, s), at(y, s)); };
      const Wide found = function.wide(a, b);
      EXPECT_NEAR(static_cast<double>(found.c[0] - f(0)), 0, 1e-15) << function.name;
      long double scale = 1;
      for (std::size_t k = 1; k <= 3; ++k) {
        scale *= static_cast<long double>(k) * h;
        long double difference = weights[k - 1][0] * f(0);
        for (int j = 1; j <= 4; ++j) {
          const long double s = h * static_cast<long double>(j), sign = k % 2 == 0 ? 1 : -1;
          difference += weights[k - 1][static_cast<std::size_t>(j)] * (f(s) + sign * f(-s));
        }
        EXPECT_NEAR(static_cast<double>(found.c[k] - difference / scale), 0, 1e-9) << function.name << " " << k;
      }
    }
  }
}

// The same in long double is 2000 times as close to the truth: 1e-18.
TEST(Taylor, BoundsItsRounding) {
  std::mt19937 engine(2);
  for (const Function& function : smooth_functions()) {
    for (int trial = 0; trial < 200; ++trial) {
      const auto [a, b] = arguments_of<Bounded>(function, engine);
      Wide wide_a, wide_b;
      for (std::size_t k = 0; k < 4; ++k) wide_a.c[k] = a.c[k].value, wide_b.c[k] = b.c[k].value;
      const Bounded found = function.bounded(a, b);
      const Wide truth = function.wide(wide_a, wide_b);
      for (std::size_t k = 0; k < 4; ++k) {
        const long double error = std::abs(static_cast<long double>(found.c[k].value) - truth.c[k]);
        EXPECT_LE(error, found.c[k].rounding * 1.001 + 1e-18) << function.name << " " << k;
        EXPECT_LT(found.c[k].rounding, 1e-12 * std::max(1.0, std::abs(found.c[0].value))) << function.name << " " << k;
      }
    }
  }
}

// Arguments with a rounding error: the true ones may lie anywhere within it.
TEST(Taylor, BoundsWhatTheRoundingOfItsArgumentsDoes) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> within(-1e-10, 1e-10);
  for (const Function& function : smooth_functions()) {
    for (int trial = 0; trial < 100; ++trial) {
      auto arguments = arguments_of<Bounded>(function, engine);
      std::array<Wide, 2> moved;
      for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
          arguments[i].c[k].rounding = 1e-10;
          moved[i].c[k] = static_cast<long double>(arguments[i].c[k].value) + within(engine);
        }
      }
      const Bounded found = function.bounded(arguments[0], arguments[1]);
      const Wide truth = function.wide(moved[0], moved[1]);
      for (std::size_t k = 0; k < 4; ++k) {  // of first order: the second is 1e-10 of it
        const long double error = std::abs(static_cast<long double>(found.c[k].value) - truth.c[k]);
        EXPECT_LE(error, found.c[k].rounding * (1 + 1e-8L)) << function.name << " " << k;
      }
    }
  }
}

TEST(Taylor, HasTheClosedFormsOfKnownFunctions) {
  const Series s(0, 1);
  EXPECT_EQ(exp(s).c, (std::array<double, 4>{1, 1, 0.5, 1.0 / 6}));
  EXPECT_EQ(sin(s).c, (std::array<double, 4>{0, 1, 0, -1.0 / 6}));
  EXPECT_EQ(cos(s).c, (std::array<double, 4>{1, 0, -0.5, 0}));
  EXPECT_EQ((1.0 / (1.0 - s)).c, (std::array<double, 4>{1, 1, 1, 1}));
  EXPECT_EQ(sqrt(1.0 + 2.0 * s).c, (std::array<double, 4>{1, 1, -0.5, 0.5}));
  EXPECT_EQ(pow(s, Series(3)).c, (std::array<double, 4>{0, 0, 0, 1}));
  EXPECT_EQ(pow(s - 2.0, Series(2)).c, (std::array<double, 4>{4, -4, 1, 0}));
}

TEST(Taylor, ComparesByTheFirstCoefficientThatDiffers) {
  const Series zero(0), rises = series(0, 1e-300, -9, -9), falls_late = series(0, 0, 0, -1);
  EXPECT_TRUE(zero < rises);
  EXPECT_TRUE(falls_late < zero);
  EXPECT_FALSE(zero < falls_late);
  EXPECT_TRUE(falls_late <= zero);
  EXPECT_TRUE(rises > zero);
  EXPECT_TRUE(rises >= zero);
  EXPECT_TRUE(zero <= zero);
  EXPECT_TRUE(zero >= zero);
  EXPECT_FALSE(zero < zero);
  EXPECT_TRUE(series(1, -100, 0, 0) > series(0, 100, 0, 0));  // the value comes first
  EXPECT_TRUE(zero == Series(0));
  EXPECT_FALSE(zero == falls_late);
  EXPECT_TRUE(zero != falls_late);
}

TEST(Taylor, TakesTheBranchThatComes) {
  const Series rises(0, 2), falls(0, -2), turns = series(0, 0, -3, 1);
  EXPECT_EQ(abs(rises).c, rises.c);
  EXPECT_EQ(abs(falls).c, rises.c);
  EXPECT_EQ(abs(turns).c, (std::array<double, 4>{0, 0, 3, -1}));
  EXPECT_EQ(floor(series(3, 1, 0, 0)).c[0], 3);
  EXPECT_EQ(floor(series(3, -1, 0, 0)).c, Series(2).c);
  EXPECT_EQ(floor(series(3, 0, 0, -1)).c[0], 2);
  EXPECT_EQ(floor(series(3, 0, 0, 0)).c[0], 3);
  EXPECT_EQ(floor(series(2.7, -1, 0, 0)).c[0], 2);
  EXPECT_EQ(floor(series(-2.3, 1, 0, 0)).c[0], -3);
  EXPECT_EQ(ceil(series(3, 1, 0, 0)).c[0], 4);
  EXPECT_EQ(ceil(series(3, -1, 0, 0)).c[0], 3);
  EXPECT_EQ(ceil(series(2.2, -1, 0, 0)).c[0], 3);
}

TEST(Taylor, LeavesZeroAsItsLeadingTermDoes) {
  // sqrt(4 s^2 + 4 s^3) = 2 s sqrt(1 + s) = 2 s + s^2 + ...; the fourth coefficient decides the third of the root.
  const Series root = sqrt(series(0, 0, 4, 4));
  EXPECT_EQ(root.c[0], 0);
  EXPECT_EQ(root.c[1], 2);
  EXPECT_EQ(root.c[2], 1);
  EXPECT_TRUE(std::isnan(root.c[3]));
  // At the corner (0, 0), along (3, 4) s: |s| times 5.
  EXPECT_EQ(hypot(Series(0, 3), Series(0, -4)).c[1], 5);
  EXPECT_EQ(hypot(Series(0, 3), Series(0, -4)).c[2], 0);
  EXPECT_EQ(atan2(Series(0, -1), Series(0, -1)).c[0], -3 * std::numbers::pi / 4);
  EXPECT_EQ(atan2(Series(0, -1), Series(-1)).c[0], -std::numbers::pi);
  EXPECT_EQ(atan2(Series(0, 1), Series(-1)).c[0], std::numbers::pi);
  // The slope is infinite there, and no later coefficient exists.
  EXPECT_EQ(sqrt(Series(0, 1)).c[1], std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(sqrt(Series(0, 1)).c[2]));
  EXPECT_EQ(pow(Series(0, 4), Series(1.5)).c[1], 0);
  EXPECT_EQ(pow(Series(0, 4), Series(1.5)).c[2], std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(sqrt(Series(0, -1)).c[1]));
  EXPECT_TRUE(std::isnan(pow(Series(0, -1), Series(4.5)).c[1]));
  EXPECT_EQ(pow(Series(0, 1), Series(4.5)).c, Series(0).c);
}

TEST(Rounded, IsExactWhereTheArithmeticIs) {
  const Rounded<double> x(1.5), y(-0.75);
  for (const auto& z : {x + y, x - y, x * y, (x * y) / y, sqrt(Rounded<double>(2.25))}) EXPECT_EQ(z.rounding, 0);
  EXPECT_GT((Rounded<double>(1) / Rounded<double>(3)).rounding, 0);
  EXPECT_GT((Rounded<double>(0.1) + Rounded<double>(0.2)).rounding, 0);
  // As in the header: 0.1 and 0.3 are doubles beside the decimals.
  const Rounded<double> z = Rounded<double>(0.1, 1e-17) * 3.0 - 0.3;
  EXPECT_NEAR(z.value, 5.55e-17, 1e-19);
  EXPECT_NEAR(z.rounding, 5.78e-17, 1e-19);
}

TEST(Rounded, SaysWhereItCannotDecide) {
  const Rounded<double> zero(0), nearly(1e-16, 1e-15), more(1e-14, 1e-15);
  EXPECT_EQ(zero < nearly, Truth::undecided);
  EXPECT_EQ(zero == nearly, Truth::undecided);
  EXPECT_EQ(zero < more, Truth::yes);
  EXPECT_EQ(zero == more, Truth::no);
  EXPECT_EQ(zero < zero, Truth::no);
  EXPECT_EQ(nearly == nearly, Truth::yes);  // a tie is a tie
  EXPECT_EQ(zero < Rounded<double>::anything(), Truth::undecided);
}

TEST(Rounded, HoldsBothBranchesWhereItCannotDecide) {
  const Bounded nearly(Rounded<double>(1e-16, 1e-15), Rounded<double>(1));
  EXPECT_FALSE(abs(nearly).c[1].is_known());  // 1 or -1
  const Bounded one(1), three(3);
  const Bounded either = select(nearly < Bounded(0), one, three);
  EXPECT_EQ(either.c[0].value, 2);
  EXPECT_EQ(either.c[0].rounding, 1);
  EXPECT_TRUE((Bounded(0) * abs(nearly)).c[1].is_exactly_zero());
}

}  // namespace
}  // namespace continuo::taylor_test
