// Proved changes of sign, against known roots and against dense samples in long double.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/root_bracketing.hpp>
#include <continuo/numerics/root_isolation.hpp>

namespace continuo::root_isolation_test {
namespace {

using Values = Enclosure<double>;
using Curve = EnclosureWithSlope<double>;

struct Found {
  std::vector<std::pair<double, double>> crossings, undecided;
  Isolation<double> end{};
};

template <class F>
Found isolate(const F& f, double from, double to, int side, const IsolationLimits<double>& limits = {}) {
  Found found;
  found.end = isolate_crossings(
      from, to, side, [&](double a, double b) { return f(Curve({a, b}, Values(1))); },
      [&](double a) { return f(Curve(Values(a), Values(1))).value; },
      [&](double a, double b, int, bool) { return found.crossings.emplace_back(a, b), false; },
      [&](double a, double b) { return found.undecided.emplace_back(a, b), false; }, limits);
  EXPECT_EQ(found.end.proved, found.undecided.empty());
  return found;
}

/// Each root is in an interval of its own, and no interval is without a root.
void expect_roots(const Found& found, const std::vector<double>& roots, double rounding = 1e-14) {
  EXPECT_TRUE(found.end.proved);
  ASSERT_EQ(found.crossings.size(), roots.size());
  for (std::size_t i = 0; i < roots.size(); ++i) {
    EXPECT_LE(found.crossings[i].first, roots[i] + rounding);
    EXPECT_GE(found.crossings[i].second, roots[i] - rounding);
  }
}

TEST(RootIsolation, EveryRootOfRandomProductsIsFoundOnce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 10);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<double> roots(1 + random() % 7);
    for (double& root : roots) root = uniform(random);
    std::sort(roots.begin(), roots.end());
    bool apart = true;
    for (std::size_t i = 1; i < roots.size(); ++i) apart = apart && roots[i] - roots[i - 1] > 1e-6;
    if (!apart) continue;
    const auto product = [&](const Curve& t) {
      Curve value(trial % 2 ? 1.0 : -1.0);
      for (const double root : roots) value = value * (t - Curve(root));
      return value;
    };
    const int side = (roots.size() % 2 == 0) == (trial % 2 == 1) ? 1 : -1;
    expect_roots(isolate(product, 0, 10, side), roots);
  }
}

TEST(RootIsolation, RootsABillionthApartInAStepOfTenAreTwo) {
  for (const double at : {5.0, 3.3, 7.0 / 9}) {
    const double next = at + 1e-9;
    const Found found = isolate([&](const Curve& t) { return (t - Curve(at)) * (t - Curve(next)); }, 0, 10, 1);
    expect_roots(found, {at, next});
    EXPECT_LE(found.end.evaluations, 150u);
  }
}

TEST(RootIsolation, NarrowPulsesAreFound) {
  const double half = std::sqrt(std::numbers::ln2);  // where exp(-z^2) is a half
  for (const double width : {0.01, 1e-6}) {
    for (const double at : {5.0, 10 * std::numbers::inv_pi}) {
      const auto pulse = [&](const Curve& t) {
        const Curve z = (t - Curve(at)) / Curve(width);
        return exp(-(z * z)) - Curve(0.5);
      };
      expect_roots(isolate(pulse, 0, 10, -1), {at - half * width, at + half * width});
    }
  }
}

TEST(RootIsolation, EveryRootOfAFastWaveIsFound) {
  std::vector<double> roots;
  for (int k = 1; k * std::numbers::pi < 1000; ++k) roots.push_back(k * std::numbers::pi / 1000);
  expect_roots(isolate([](const Curve& t) { return sin(Curve(1000.0) * t); }, 0, 1, 1), roots);
}

TEST(RootIsolation, TouchesAreNoCrossingsAndEndWithinTwoHundredEvaluations) {
  for (const double at : {5.0, 3.3, 7.0 / 9}) {
    const auto expanded = [&](const Curve& t) { return t * t - Curve(2 * at) * t + Curve(at * at); };
    const auto raised = [&](const Curve& t) { return expanded(t) + Curve(1e-10); };
    const auto squared = [&](const Curve& t) { return (t - Curve(at)) * (t - Curve(at)); };
    const auto kink = [&](const Curve& t) { return abs(t - Curve(at)); };
    const auto wave = [&](const Curve& t) { return Curve(1.0) - cos(t - Curve(at)); };
    for (const Found& found : {isolate(expanded, 0, 10, 1), isolate(raised, 0, 10, 1), isolate(squared, 0, 10, 1),
                               isolate(kink, 0, 10, 1), isolate(wave, at - 3, at + 3, 1)}) {
      expect_roots(found, {});
      EXPECT_LE(found.end.evaluations, 200u);
    }
  }
}

TEST(RootIsolation, FlatCrossingsAreOne) {
  for (const int power : {3, 5}) {
    const auto flat = [&](const Curve& t) {
      Curve value(1.0);
      for (int k = 0; k < power; ++k) value = value * (t - Curve(3.3));
      return value;
    };
    const Found found = isolate(flat, 0, 10, -1, {.band = 1e-13});
    expect_roots(found, {3.3}, 0.01);  // 1e-13 is reached 0.0025 from the root of the fifth power
  }
}

TEST(RootIsolation, KinksAndJumpsAreCrossed) {
  expect_roots(isolate([](const Curve& t) { return abs(t - Curve(3.3)) - Curve(1e-9); }, 0, 10, 1),
               {3.3 - 1e-9, 3.3 + 1e-9});
  expect_roots(isolate([](const Curve& t) { return max(t - Curve(4.0), Curve(1.0) - t); }, 0, 10, 1), {1, 4});
  expect_roots(isolate([](const Curve& t) { return floor(t) - Curve(3.5); }, 0, 10, -1), {4});
  expect_roots(isolate([](const Curve& t) { return sign(t - Curve(3.3)); }, 0, 10, -1), {3.3});
  expect_roots(isolate([](const Curve& t) { return mod(t, Curve(1.0)) - Curve(0.5); }, 0.25, 2.25, -1),
               {0.5, 1, 1.5, 2});
  expect_roots(isolate([](const Curve& t) { return select(t < Curve(2.0), Curve(-1.0), t * t); }, 0, 10, -1), {2});
  expect_roots(isolate([](const Curve& t) { return Curve(1.0) / (t - Curve(3.3)); }, 0, 10, -1), {3.3});
}

// After each jump down the function grows steadily through zero again: slopes and ends of pieces alone do not reveal
// the jumps.
TEST(RootIsolation, JumpsBackAreCrossingsOfTheirOwn) {
  for (const double height : {0.5, 1e-3, 1e-9}) {
    const auto teeth = [&](const Curve& t) { return mod(t, Curve(0.7)) - Curve(height); };
    std::vector<double> roots;
    for (int k = 1; k <= 4; ++k) roots.insert(roots.end(), {0.7 * k, 0.7 * k + height});
    expect_roots(isolate(teeth, 0.65, 3.4, 1, {.budget = 10000}), roots);
  }
}

TEST(RootIsolation, JumpsEndWithNeighbouringNumbersOrAFewRoundingsApart) {
  const Found found = isolate([](const Curve& t) { return sign(t - Curve(3.3)); }, 0, 10, -1);
  ASSERT_EQ(found.crossings.size(), 1u);
  EXPECT_LE(found.crossings[0].second - found.crossings[0].first, 1e-14);
}

TEST(RootIsolation, ZeroBelongsToTheSideItWasReachedFrom) {
  const auto line = [](const Curve& t) { return t - Curve(10.0); };
  expect_roots(isolate(line, 0, 10, -1), {});
  EXPECT_EQ(isolate(line, 0, 10, -1).end.side, -1);
  const auto from_zero = [](const Curve& t) { return t; };
  expect_roots(isolate(from_zero, 0, 10, 1), {});
  expect_roots(isolate(from_zero, 0, 10, -1), {0});
  EXPECT_EQ(isolate(from_zero, 0, 10, 0).end.side, 1);  // without a side before, so it is no crossing
  expect_roots(isolate(from_zero, 0, 10, 0), {});
}

TEST(RootIsolation, ASideThatIsNotThatOfTheStartIsLeftThere) {
  const Found found = isolate([](const Curve& t) { return t - Curve(5.0); }, 0, 10, 1);
  ASSERT_EQ(found.crossings.size(), 2u);
  EXPECT_EQ(found.crossings[0], std::pair(0.0, 0.0));
  EXPECT_LE(found.crossings[1].first, 5);
  EXPECT_GE(found.crossings[1].second, 5);
}

TEST(RootIsolation, WithinTheBandNothingIsCrossed) {
  const auto ripple = [](const Curve& t) { return Curve(1e-12) * sin(Curve(100.0) * t); };
  expect_roots(isolate(ripple, 0, 10, 1, {.band = 2e-12}), {});
  EXPECT_EQ(isolate(ripple, 0, 0.3, 1).crossings.size(), 9u);
}

TEST(RootIsolation, WhatCannotBeDecidedIsSaidWithinTheBudget) {
  const auto nothing = [](const Curve& t) { return t * t - t * t; };
  const auto nowhere = [](const Curve& t) { return sqrt(-(t * t) - Curve(1.0)); };
  for (const Found& found : {isolate(nothing, 0, 10, 1), isolate(nowhere, 0, 10, 1)}) {
    EXPECT_TRUE(found.crossings.empty());
    ASSERT_FALSE(found.undecided.empty());
    EXPECT_LE(found.end.evaluations, 2020u);
  }
  EXPECT_LE(isolate(nowhere, 0, 10, 1).end.evaluations, 100u);
}

// The logarithm has no value up to 3.3; the root after that is still found.
TEST(RootIsolation, WhatIsUndefinedSomewhereIsDecidedElsewhere) {
  const Found found = isolate([](const Curve& t) { return log(t - Curve(3.3)); }, 0, 10, -1);
  EXPECT_FALSE(found.end.proved);
  EXPECT_LE(found.undecided.back().second, 4);
  ASSERT_EQ(found.crossings.size(), 1u);
  EXPECT_LE(found.crossings[0].first, 4.3);
  EXPECT_GE(found.crossings[0].second, 4.3);
}

TEST(RootIsolation, StopsWhenTold) {
  int visits = 0;
  const auto wave = [](const Curve& t) { return sin(t); };
  const auto end = isolate_crossings(
      1.0, 100.0, 1, [&](double a, double b) { return wave(Curve({a, b}, Values(1))); },
      [&](double a) { return sin(Values(a)); }, [&](double, double, int, bool) { return ++visits == 2; },
      [](double, double) { return false; });
  EXPECT_TRUE(end.stopped);
  EXPECT_EQ(visits, 2);
  EXPECT_EQ(end.side, 1);
}

/// Sums of waves, pulses and kinks of random size.
struct RandomFunction {
  struct Term {
    int kind;
    double size, speed, place;
  };
  std::vector<Term> terms;

  explicit RandomFunction(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    terms.resize(2 + random() % 3);
    for (Term& term : terms)
      term = {static_cast<int>(random() % 4), 2 * uniform(random) - 1, std::pow(10.0, 2 * uniform(random) - 1),
              10 * uniform(random)};
  }

  template <class Number>
  Number operator()(const Number& t) const {
    using std::abs, std::exp, std::sin, std::atan;
    Number sum(0.1);
    for (const Term& term : terms) {
      const Number z = Number(term.speed) * (t - Number(term.place));
      const Number value = term.kind == 0   ? sin(z)
                           : term.kind == 1 ? exp(-(z * z))
                           : term.kind == 2 ? abs(z) / (Number(1.0) + z * z)
                                            : atan(z);
      sum = sum + Number(term.size) * value;
    }
    return sum;
  }
};

// Samples 1e-4 apart see every change of side but pairs of roots closer than that. Where more are found, the function
// is on the other side between the two.
TEST(RootIsolation, AgreesWithDenseSamplesOnRandomFunctions) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 12; ++trial) {
    const RandomFunction f(random);
    const int side = f(0.0L) > 0 ? 1 : -1;
    const Found found = isolate(f, 0, 10, side);
    EXPECT_TRUE(found.end.proved);
    std::vector<double> roots;
    int at = side;
    for (const auto& [from, to] : found.crossings) {
      const auto beyond = [&](double t) { return -at * f(t); };
      roots.push_back(enclose_root(beyond, from, to, std::min(0.0, beyond(from)), beyond(to)).far);
      at = -at;
    }
    std::size_t next = 0;
    long double before = f(0.0L);
    for (int k = 1; k <= 100000; ++k) {
      const long double t = 1e-4L * k, value = f(t);
      std::size_t here = 0;
      while (next < roots.size() && static_cast<long double>(roots[next]) <= t) ++next, ++here;
      EXPECT_EQ(here % 2 == 1, (value > 0) != (before > 0))
          << "trial " << trial << " before " << static_cast<double>(t);
      before = value;
    }
    EXPECT_EQ(found.end.side, f(10.0L) > 0 ? 1 : -1);
  }
}

}  // namespace
}  // namespace continuo::root_isolation_test
