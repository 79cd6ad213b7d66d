// For all numbers in the operands, the result contains the exact value: tested in long double, which has eleven bits
// more.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include <continuo/numerics/enclosure_with_slope.hpp>

namespace continuo::enclosure_test {
namespace {

using Values = Enclosure<double>;
using Curve = EnclosureWithSlope<double>;

/// Numbers of all sizes, some whole, some zero, and intervals of them, some of them points.
class RandomNumbers {
 public:
  explicit RandomNumbers(unsigned seed) : random_(seed) {}

  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  double number() {
    const double size = std::pow(10.0, 6 * unit() - 4), value = unit() < 0.5 ? size : -size, kind = unit();
    return kind < 0.1 ? 0 : kind < 0.3 ? std::round(value) : value;
  }
  Values interval() {
    const double a = number(), kind = unit();
    if (kind < 0.2) return Values(a);
    const double b = kind < 0.6 ? number() : a * (1 + unit() * std::pow(10.0, -12 * unit()));
    return {std::min(a, b), std::max(a, b)};
  }
  double point(const Values& a) {
    const double kind = unit();
    return kind < 0.1 ? a.lo : kind < 0.2 ? a.hi : std::clamp(a.lo + unit() * (a.hi - a.lo), a.lo, a.hi);
  }

 private:
  std::mt19937 random_;
};

/// The same formula for enclosures and for numbers, found by the arguments' type.
// clang-format off
const auto of_one = std::tuple{
    [](const auto& x) { using std::sin; return sin(x); },     [](const auto& x) { using std::cos; return cos(x); },
    [](const auto& x) { using std::tan; return tan(x); },     [](const auto& x) { using std::asin; return asin(x); },
    [](const auto& x) { using std::acos; return acos(x); },   [](const auto& x) { using std::atan; return atan(x); },
    [](const auto& x) { using std::sinh; return sinh(x); },   [](const auto& x) { using std::cosh; return cosh(x); },
    [](const auto& x) { using std::tanh; return tanh(x); },   [](const auto& x) { using std::exp; return exp(x); },
    [](const auto& x) { using std::log; return log(x); },     [](const auto& x) { using std::log10; return log10(x); },
    [](const auto& x) { using std::sqrt; return sqrt(x); },   [](const auto& x) { using std::abs; return abs(x); },
    [](const auto& x) { using std::floor; return floor(x); }, [](const auto& x) { using std::ceil; return ceil(x); },
    [](const auto& x) { return x * x; },                      [](const auto& x) { return -x; }};
const auto of_two = std::tuple{
    [](const auto& x, const auto& y) { return x + y; },
    [](const auto& x, const auto& y) { return x - y; },
    [](const auto& x, const auto& y) { return x * y; },
    [](const auto& x, const auto& y) { return x / y; },
    [](const auto& x, const auto& y) { using std::pow; return pow(x, y); },
    [](const auto& x, const auto& y) { using std::hypot; return hypot(x, y); },
    [](const auto& x, const auto& y) { using std::atan2; return atan2(x, y); },
    [](const auto& x, const auto& y) { using std::min; return min(x, y); },
    [](const auto& x, const auto& y) { using std::max; return max(x, y); }};
// clang-format on

template <class Functions, class Visit>
void for_each(const Functions& functions, Visit&& visit) {
  std::apply([&](const auto&... f) { (visit(f), ...); }, functions);
}

void expect_held(const Values& range, long double value, const std::string& what) {
  if (std::isnan(value)) {
    EXPECT_FALSE(range.is_bounded()) << what;
  } else {
    EXPECT_TRUE(static_cast<long double>(range.lo) <= value && value <= static_cast<long double>(range.hi))
        << what << ": " << static_cast<double>(value) << " is not in [" << range.lo << ", " << range.hi << "]";
  }
}

std::string text(const Values& x) {
  return "[" + std::to_string(x.lo) + ", " + std::to_string(x.hi) + "]";
}

TEST(Enclosure, HoldsEveryValueOfAFunction) {
  RandomNumbers random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const Values x = random.interval();
    int number = 0;
    for_each(of_one, [&](const auto& f) {
      const Values range = f(x);
      for (int k = 0; k < 5; ++k) {
        const double point = random.point(x);
        expect_held(range, f(static_cast<long double>(point)), "function " + std::to_string(number) + " of " + text(x));
        expect_held(range, f(point), "rounded function " + std::to_string(number) + " of " + text(x));
      }
      ++number;
    });
  }
}

TEST(Enclosure, HoldsEveryValueOfAnOperationOnTwo) {
  RandomNumbers random(2);
  for (int trial = 0; trial < 2000; ++trial) {
    const Values x = random.interval(), y = random.interval();
    int number = 0;
    for_each(of_two, [&](const auto& f) {
      const Values range = f(x, y);
      for (int k = 0; k < 5; ++k) {
        const double a = random.point(x), b = random.point(y);
        const std::string what = "operation " + std::to_string(number) + " on " + text(x) + " and " + text(y);
        expect_held(range, f(static_cast<long double>(a), static_cast<long double>(b)), what);
        expect_held(range, f(a, b), "rounded " + what);
      }
      ++number;
    });
  }
}

TEST(Enclosure, HoldsRemaindersOfBothSigns) {
  RandomNumbers random(3);
  for (int trial = 0; trial < 20000; ++trial) {
    const Values x = random.interval(), y = random.interval(), range = mod(x, y);
    const double a = random.point(x), b = random.point(y);
    if (b != 0) expect_held(range, a - b * std::floor(a / b), "mod of " + text(x) + " and " + text(y));
  }
}

// The enclosure of a function at a single number is as wide as a few units in the last place: twice the error allowed
// for libm.
TEST(Enclosure, IsTightOnSingleNumbers) {
  constexpr double units = 10 * std::numeric_limits<double>::epsilon();
  RandomNumbers random(4);
  for (int trial = 0; trial < 1000; ++trial) {
    const double x = random.number();
    for_each(of_one, [&](const auto& f) {
      const double value = f(x);
      if (!std::isfinite(value)) return;
      const Values range = f(Values(x));
      EXPECT_LE(range.hi - range.lo, units * std::abs(value) + 3 * underflow<double>) << x;
    });
  }
}

// The computed extremes of sine and cosine exceed the sampled ones by no more than a thousand samples can miss.
TEST(Enclosure, WavesAreTightOnIntervals) {
  RandomNumbers random(5);
  for (int trial = 0; trial < 500; ++trial) {
    const double from = 100 * random.unit() - 50, width = 8 * random.unit();
    double least = 1, greatest = -1;
    for (int k = 0; k <= 1000; ++k) {
      const double value = std::sin(from + width * k / 1000);
      least = std::min(least, value), greatest = std::max(greatest, value);
    }
    const double left_out = width * width / 8e6 + 1e-14;
    const Values range = sin(Values(from, from + width));
    EXPECT_GE(range.lo, least - left_out);
    EXPECT_LE(range.hi, greatest + left_out);
  }
}

TEST(Enclosure, CountersStayWhole) {
  const Values n(7), two(2);
  for (const Values& result : {n + two, n - two, n * two, Values(6) / two, mod(n, two), sqrt(Values(9)), n * n})
    EXPECT_TRUE(result.is_point());
  EXPECT_FALSE((Values(0.1) + Values(0.2)).is_point());
  EXPECT_FALSE((Values(1) / Values(3)).is_point());
}

TEST(Enclosure, WhatIsUndefinedIsTheEntireLine) {
  const Values around(-1, 1), negative(-2, -1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Values& result :
       {around / around, log(around), sqrt(around), asin(Values(0, 2)), pow(around, Values(0.5)), tan(Values(1, 2)),
        Values(nan), Values(nan) * Values(0), pow(around, Values(-1)), log10(negative), acos(negative)}) {
    EXPECT_EQ(result.lo, -Values::infinity);
    EXPECT_EQ(result.hi, Values::infinity);
  }
}

// sin(log(-1)) is not a number, and no comparison with it holds: -1..1 would decide some.
TEST(Enclosure, WhatIsUndefinedStaysSoInBoundedFunctions) {
  const Values undefined = log(Values(-1, 1));
  const Values results[] = {sin(undefined),
                            cos(undefined),
                            atan(undefined),
                            tanh(undefined),
                            exp(undefined),
                            cosh(undefined),
                            abs(undefined),
                            sign(undefined),
                            square(undefined),
                            floor(undefined),
                            pow(undefined, Values(2)),
                            min(undefined, Values(1)),
                            max(Values(1), undefined),
                            atan2(undefined, Values(1)),
                            hypot(Values(1), undefined),
                            mod(undefined, Values(1)),
                            undefined * Values(0)};
  for (const Values& result : results) EXPECT_TRUE(result.is_entire());
}

TEST(Enclosure, OverflowIsUnboundedAndStaysOnItsSide) {
  const Values large(1e200, 1e300), product = large * large;
  EXPECT_EQ(product.hi, Values::infinity);
  EXPECT_TRUE((product - product).holds(0));
  EXPECT_GE(exp(large).lo, 0);
  EXPECT_EQ(exp(large).hi, Values::infinity);
}

TEST(Enclosure, ComparisonsSayWhatTheyKnow) {
  const Values low(0, 1), high(2, 3), middle(0.5, 2.5);
  EXPECT_FALSE((low < high).may_fail);
  EXPECT_FALSE((high < low).may_hold);
  EXPECT_TRUE((low < middle).may_hold && (low < middle).may_fail);
  EXPECT_FALSE((low <= Values(1)).may_fail);
  EXPECT_TRUE((low < Values(1)).may_fail);
  EXPECT_FALSE((Values(3) == Values(3)).may_fail);
  EXPECT_FALSE((low == high).may_hold);
  EXPECT_TRUE((low != middle).may_fail);
  const Values chosen = select(low < middle, Values(1), Values(5));
  EXPECT_EQ(chosen.lo, 1);
  EXPECT_EQ(chosen.hi, 5);
}

/// f(a), f(b) and (f(a) - f(b))/(a - b) against the enclosure over an interval that holds a and b.
template <class F>
void expect_slope_held(const F& f, const Values& x, double a, double b, const std::string& what) {
  const Curve range = f(Curve(x, Values(1)));
  const long double at_a = f(static_cast<long double>(a)), at_b = f(static_cast<long double>(b));
  expect_held(range.value, at_a, what);
  if (std::isnan(at_a) || std::isnan(at_b) || std::isinf(at_a) || std::isinf(at_b) || a == b) return;
  // The quotient of differences has a rounding of its own; powl multiplies, good to some hundred units.
  const long double distance = static_cast<long double>(a) - static_cast<long double>(b);
  const long double rounding =
      256 * std::numeric_limits<long double>::epsilon() * (std::abs(at_a) + std::abs(at_b)) / std::abs(distance);
  const long double slope = (at_a - at_b) / distance;
  EXPECT_GE(slope, static_cast<long double>(range.slope.lo) - rounding) << what << " over " << text(x);
  EXPECT_LE(slope, static_cast<long double>(range.slope.hi) + rounding) << what << " over " << text(x);
}

TEST(EnclosureWithSlope, HoldsQuotientsOfDifferences) {
  RandomNumbers random(6);
  for (int trial = 0; trial < 1000; ++trial) {
    const Values x = random.interval();
    const double a = random.point(x), b = random.point(x), c = random.number();
    int number = 0;
    for_each(of_one, [&](const auto& f) { expect_slope_held(f, x, a, b, "function " + std::to_string(number++)); });
    number = 0;
    for_each(of_two, [&](const auto& f) {
      const std::string what = "operation " + std::to_string(number++) + " with " + std::to_string(c);
      expect_slope_held([&]<class T>(const T& y) { return f(y, T(c)); }, x, a, b, what);
      expect_slope_held([&]<class T>(const T& y) { return f(T(c), y); }, x, a, b, what);
      expect_slope_held([&]<class T>(const T& y) { return f(y, T(0.5) * y + T(c)); }, x, a, b, what);
    });
  }
}

TEST(EnclosureWithSlope, IsTheDerivativeOnSingleNumbers) {
  const Curve x(Values(0.7), Values(1));
  const auto expect_slope = [](const Curve& f, double slope) {
    EXPECT_NEAR(f.slope.lo, slope, 1e-14);
    EXPECT_NEAR(f.slope.hi, slope, 1e-14);
  };
  expect_slope(sin(x), std::cos(0.7));
  expect_slope(tan(x), 1 / (std::cos(0.7) * std::cos(0.7)));
  expect_slope(asin(x), 1 / std::sqrt(1 - 0.49));
  expect_slope(log10(x), 1 / (0.7 * std::log(10.0)));
  expect_slope(tanh(x), 1 - std::tanh(0.7) * std::tanh(0.7));
  expect_slope(pow(x, Curve(2.5)), 2.5 * std::pow(0.7, 1.5));
  expect_slope(pow(Curve(2.0), x), std::pow(2, 0.7) * std::log(2.0));
  expect_slope(atan2(x, Curve(2.0)), 2 / (4 + 0.49));
  expect_slope(Curve(1.0) / x, -1 / 0.49);
}

TEST(EnclosureWithSlope, KinksHaveTheSlopesOfBothSidesAndJumpsAny) {
  const Curve x({-1, 2}, Values(1));
  const Values kink = abs(x).slope, lower = min(x, Curve(0.5)).slope;
  EXPECT_EQ(kink.lo, -1);
  EXPECT_EQ(kink.hi, 1);
  EXPECT_EQ(lower.lo, 0);
  EXPECT_EQ(lower.hi, 1);
  for (const Curve& jump : {sign(x), floor(x), ceil(x), mod(x, Curve(1.0)), select(x < Curve(0.0), x, Curve(5.0)),
                            select(x < Curve(0.0), Curve(0.0), Curve(1.0))})
    EXPECT_FALSE(jump.slope.is_bounded());
  EXPECT_TRUE(select(x < Curve(0.0), Curve(1.0), Curve(1.0)).is_steady());
  EXPECT_TRUE(floor(Curve({0.2, 0.8}, Values(1))).is_steady());
}

}  // namespace
}  // namespace continuo::enclosure_test
