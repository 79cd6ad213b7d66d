// Taylor series: coefficients of random expressions against another implementation in long double, of solutions against
// closed forms; runs, orders, events and failures of the method.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <bench/problems/arenstorf.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/problems/lorenz.hpp>
#include <bench/solver.hpp>
#include <gtest/gtest.h>

#include "any_system.hpp"
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/taylor_series/taylor_series.hpp>
#include <continuo/numerics/taylor.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::taylor_series_test {
namespace {

using One = std::array<double, 1>;
using Two = std::array<double, 2>;
using Four = std::array<double, 4>;

constexpr std::size_t order = 12;
using Referee = Taylor<long double, order>;

/// A random expression of two series, evaluated with any number type. Arguments of roots, logarithms and inverse sines
/// stay in their domains.
class Expression {
 public:
  template <class Random>
  Expression(Random& random, int depth) {
    kind_ = depth == 0 ? std::uniform_int_distribution(0, 2)(random) : std::uniform_int_distribution(3, last_)(random);
    number_ = std::uniform_real_distribution(0.5, 2.5)(random);
    if (depth == 0) return;
    a_ = std::make_unique<Expression>(random, depth - 1);
    b_ = std::make_unique<Expression>(random, std::uniform_int_distribution(0, depth - 1)(random));
  }

  template <class T>
  T operator()(const T& x, const T& y) const {
    using std::sqrt, std::exp, std::log, std::sin, std::cos, std::tan, std::atan, std::asin, std::acos, std::sinh,
        std::cosh, std::tanh, std::pow, std::abs, std::hypot, std::atan2;
    if (kind_ == 0) return x;
    if (kind_ == 1) return y;
    if (kind_ == 2) return T(number_);
    const T a = (*a_)(x, y), b = (*b_)(x, y), small = a / (1.5 + a * a), positive = 0.5 + a * a;
    switch (kind_) {
      case 3:
        return a + b;
      case 4:
        return a - b;
      case 5:
        return a * b;
      case 6:
        return a / (1.0 + b * b);
      case 7:
        return sqrt(positive);
      case 8:
        return exp(small);
      case 9:
        return log(positive);
      case 10:
        return sin(a);
      case 11:
        return cos(a);
      case 12:
        return tan(small);
      case 13:
        return atan(a);
      case 14:
        return asin(small);
      case 15:
        return acos(small);
      case 16:
        return sinh(small);
      case 17:
        return cosh(small);
      case 18:
        return tanh(a);
      case 19:
        return pow(positive, T(number_));
      case 20:
        return pow(positive, small);
      case 21:
        return pow(a, T(3.0));
      case 22:
        return 1.0 / positive;
      case 23:
        return -a;
      case 24:
        return number_ * a - b / number_;
      case 25:
        return abs(a);
      case 26:
        return hypot(positive, b);
      case 27:
        return atan2(b, positive);
      case last_:
        return a * a;
    }
    return a;
  }

 private:
  static constexpr int last_ = 28;
  int kind_;
  double number_;
  std::unique_ptr<Expression> a_, b_;
};

// The error of rounding is that of the values times what the expression amplifies it by, for which the greatest
// coefficient stands: terms of that size cancel in the others.
TEST(SeriesProgram, ComputesRandomExpressionsAsAnotherImplementationDoes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int compared = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Expression expression(random, 1 + trial % 4);
    std::array<Referee, 2> exact;
    SeriesProgram<double> program;
    const auto x = program.add_variable(), y = program.add_variable();
    for (std::size_t k = 0; k <= order; ++k)
      for (Referee& each : exact) each.c[k] = uniform(random);
    const SeriesNumber<double> result =
        expression(SeriesNumber<double>(program, x, static_cast<double>(exact[0].c[0])),
                   SeriesNumber<double>(program, y, static_cast<double>(exact[1].c[0])));
    const auto place = result.place_in(program);
    program.begin(order);
    for (std::size_t k = 0; k <= order; ++k) {
      program.coefficient(k, x) = static_cast<double>(exact[0].c[k]);
      program.coefficient(k, y) = static_cast<double>(exact[1].c[k]);
      program.evaluate(k);
    }
    const Referee expected = expression(exact[0], exact[1]);
    long double greatest = 1;
    for (const long double c : expected.c) greatest = std::max(greatest, std::abs(c));
    if (!(greatest < 1e6L)) continue;  // rounding may have been amplified by as much
    ++compared;
    EXPECT_NEAR(result.value(), static_cast<double>(expected.c[0]), 1e-13 * static_cast<double>(greatest)) << trial;
    for (std::size_t k = 0; k <= order; ++k)
      EXPECT_NEAR(program.coefficient(k, place), static_cast<double>(expected.c[k]),
                  1e-10 * static_cast<double>(greatest))
          << trial << ", order " << k;
  }
  EXPECT_GT(compared, 1500);
}

/// Coefficients 0 to 8 of the solution of x' = f(t, x).
template <class F>
std::vector<double> solution_series(F f, double t, double x) {
  TaylorSeries::Workspace<One> work(One{x});
  One x_new{};
  work.tolerance = {1e-6, 0};
  TaylorSeries::step(f, t, One{x}, 1.0, true, work, x_new);
  std::vector<double> c;
  for (std::size_t k = 0; k <= work.order; ++k) c.push_back(work.now().c[k]);
  return c;
}
void expect_coefficients(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_GE(found.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-14) << k;
}

TEST(TaylorSeries, KnowsTheSeriesOfClosedForms) {
  expect_coefficients(solution_series([](auto, const auto& x, auto& f) { f[0] = x[0]; }, 0, 1),
                      {1, 1, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120});
  expect_coefficients(solution_series([](auto, const auto& x, auto& f) { f[0] = x[0] * x[0]; }, 0, 1),
                      {1, 1, 1, 1, 1, 1, 1});
  expect_coefficients(solution_series([](auto, const auto& x, auto& f) { f[0] = 1 + x[0] * x[0]; }, 0, 0),
                      {0, 1, 0, 1.0 / 3, 0, 2.0 / 15, 0, 17.0 / 315});
  expect_coefficients(solution_series(
                          [](auto t, const auto&, auto& f) {
                            using std::cos;
                            f[0] = cos(t);
                          },
                          0, 0),
                      {0, 1, 0, -1.0 / 6, 0, 1.0 / 120});
  // sqrt(1 + 2 t) by x x' = 1
  expect_coefficients(solution_series([](auto, const auto& x, auto& f) { f[0] = 1 / x[0]; }, 0, 1),
                      {1, 1, -0.5, 0.5, -0.625, 0.875});
  // t^t at 1, by x' = x (1 + log t): 1 + s + s^2 + s^3/2 + s^4/3 + ...
  expect_coefficients(solution_series(
                          [](auto t, const auto& x, auto& f) {
                            using std::log;
                            f[0] = x[0] * (1 + log(t));
                          },
                          1, 1),
                      {1, 1, 1, 0.5, 1.0 / 3});
}

// What begins with a power of s: a^n and a^p at zero, where the usual recurrence divides by a.
TEST(SeriesProgram, TakesPowersAtZero) {
  SeriesProgram<double> program;
  const auto x = program.add_variable();
  const auto p = program.add_number(20), half = program.add_number(1.5);
  const auto high = program.add(SeriesCode::power, x, p), fraction = program.add(SeriesCode::power, x, half);
  program.begin(24);
  for (std::size_t k = 0; k <= 24; ++k) {
    program.coefficient(k, x) = k == 1 ? 2 : k == 2 ? 4 : 0;  // 2 s (1 + 2 s)
    program.evaluate(k);
  }
  for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(program.coefficient(k, high), 0) << k;
  EXPECT_NEAR(program.coefficient(20, high), std::pow(2.0, 20), 1e-8);
  EXPECT_NEAR(program.coefficient(22, high), std::pow(2.0, 20) * 190 * 4, 1e-4);  // 20 over 2, times 2^2
  EXPECT_EQ(program.coefficient(1, fraction), 0);
  EXPECT_TRUE(std::isnan(program.coefficient(2, fraction)));  // s^1.5 has no second derivative there
}

TEST(SeriesProgram, MembersSideBySideAreAsOneByOne) {
  constexpr std::uint32_t count = 13;
  SeriesProgram<double> together, alone;
  const auto a = together.add_variable(count), b = together.add_variable(count);
  const auto c = alone.add_variable(count), d = alone.add_variable(count);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> results;
  const auto compare = [&](SeriesCode code) {
    const auto first = together.add(code, a, b, 0, count);
    for (std::uint32_t i = 0; i < count; ++i) results.emplace_back(first + i, alone.add(code, c + i, d + i));
  };
  for (const SeriesCode code :
       {SeriesCode::add, SeriesCode::product, SeriesCode::square, SeriesCode::quotient, SeriesCode::square_root,
        SeriesCode::exponential, SeriesCode::logarithm, SeriesCode::sine_cosine, SeriesCode::tangent,
        SeriesCode::hyperbolic_tangent, SeriesCode::minimum, SeriesCode::absolute, SeriesCode::less})
    compare(code);
  together.begin(9);
  alone.begin(9);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.1, 1);
  for (std::size_t k = 0; k <= 9; ++k) {
    for (std::uint32_t i = 0; i < count; ++i) {
      together.coefficient(k, a + i) = alone.coefficient(k, c + i) = uniform(random);
      together.coefficient(k, b + i) = alone.coefficient(k, d + i) = uniform(random);
    }
    together.evaluate(k);
    alone.evaluate(k);
    for (const auto& [one, other] : results)
      EXPECT_EQ(together.coefficient(k, one), alone.coefficient(k, other)) << k << ' ' << one;
  }
}

// To what the polynomials are said to be off by, over all exponents and on both sides of every power of two.
TEST(CoarsePower, IsNearTheExactOne) {
  for (int exponent = -1000; exponent <= 1000; exponent += 8) {
    for (const double m : {1.0, 1.0 + 1e-15, 1.1, 1.26, 1.41, 1.5, 1.7, 1.9, 2 - 1e-15}) {
      const double x = std::ldexp(m, exponent);
      EXPECT_NEAR(detail::coarse_log2(x), std::log2(x), 1.2e-4) << x;
      const double y = exponent + (m - 1.5);
      EXPECT_NEAR(detail::coarse_exp2(y) / std::exp2(y), 1, 1e-4) << y;
    }
  }
  EXPECT_LT(detail::coarse_log2(0.0), -1021);
}

constexpr auto kepler = [](auto, const auto& x, auto& dxdt) {
  using std::sqrt;
  const auto r2 = x[0] * x[0] + x[1] * x[1], r3 = r2 * sqrt(r2);
  dxdt[0] = x[2], dxdt[1] = x[3], dxdt[2] = -x[0] / r3, dxdt[3] = -x[1] / r3;
};

// One orbit, at the ends of steps and between them.

/// A method's memory in the middle of a run, with random series at both ends of a step.
TaylorSeries::Workspace<std::vector<double>> random_workspace(std::mt19937& random, std::size_t n, std::size_t p) {
  std::uniform_real_distribution<double> part(-1, 1);
  auto work = TaylorSeries::workspace(std::vector<double>(n));
  work.order = p;
  work.now().scale = 0.3 + part(random) / 8;
  work.next().scale = 0.25;
  work.next().is_known = true;
  for (auto* const expansion : {&work.now(), &work.next()})
    for (std::size_t k = 0; k < (p + 1) * n; ++k)
      expansion->c[k] = part(random) * std::pow(0.2, static_cast<double>(k / n));
  for (double& defect : work.defect) defect = std::abs(part(random)) * 1e-9;
  return work;
}

TEST(TaylorSeries, MeasuresRegistersOfComponentsAsOneByOne) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.5, 1);
  for (std::size_t n = 1; n <= 9; ++n) {
    for (const bool has_own : {false, true}) {
      const std::size_t p = 14 + n % 4;
      const auto work = random_workspace(random, n, p);
      std::vector<double> x(n), x_new(n), rtol(n), atol(n);
      for (auto* const list : {&x, &x_new, &rtol, &atol})
        for (double& number : *list) number = part(random);
      const Tolerance<double> tolerance{1e-9, has_own ? 1 : 0.0, has_own ? rtol.data() : nullptr,
                                        has_own ? atol.data() : nullptr};
      const long double theta = 0.25L / static_cast<long double>(work.now().scale),
                        allowed[] = {std::exp(2.0L), std::exp(4.0L)};
      long double error = 0, next[2] = {};
      for (std::size_t i = 0; i < n; ++i) {
        const auto relative = static_cast<long double>(has_own ? rtol[i] : 1e-9);
        const auto absolute = static_cast<long double>(has_own ? atol[i] : 0.0);
        long double greatest = static_cast<long double>(work.defect[i]);
        for (std::size_t j = 0; j < 2; ++j) {
          const std::size_t k = p - 1 + j;
          const long double term = std::abs(static_cast<long double>(work.now().c[k * n + i]));
          greatest = std::max(greatest, term * std::pow(theta, static_cast<long double>(k)) * allowed[j]);
          const long double last = static_cast<long double>(work.next().c[k * n + i]) * allowed[j];
          next[j] += std::pow(last / (absolute + relative * static_cast<long double>(x_new[i])), 2.0L);
        }
        error += std::pow(greatest / (absolute + relative * static_cast<long double>(std::max(x[i], x_new[i]))), 2.0L);
      }
      const auto count = static_cast<long double>(n);
      // Some 2 (p + 8) roundings of a term.
      const long double found = TaylorSeries::error_square(work, 0.25, x, x_new, tolerance);
      EXPECT_NEAR(static_cast<double>(found / (error / count)), 1, 1e-14);
      long double step = 10;  // at most ten times the last one
      for (std::size_t j = 0; j < 2; ++j)
        step = std::min(step, std::pow(next[j] / count, -0.5L / static_cast<long double>(p - 1 + j)));
      step *= std::exp(-0.7L / static_cast<long double>(p - 1));
      auto mutable_work = work;
      const double factor = TaylorSeries::next_factor(mutable_work, 0.0, 0.25, x, x_new, tolerance);
      EXPECT_NEAR(static_cast<double>(factor / step), 1, 3e-4);  // see coarse_power.hpp
    }
  }
}

// What events are located on is as near to the dense output as their enclosures allow for.
TEST(TaylorSeries, IsAtAPartOfTheStepWhereItsDenseOutputIs) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> part(0, 1);
  const auto f = [](double, const std::vector<double>&, std::vector<double>&) {};
  for (std::size_t n = 1; n <= 9; ++n) {
    auto work = random_workspace(random, n, 11 + n);
    std::vector<double> x(n);
    Interpolant<std::vector<double>, TaylorSeries::dense_degree> output(x);
    TaylorSeries::interpolate(f, 0.0, x, 0.35, x, work, output);
    for (int tries = 0; tries < 50; ++tries) {
      const double theta = part(random);
      TaylorSeries::at_part(work, 0.35, theta, x);
      for (std::size_t i = 0; i < n; ++i) {
        long double value = 0, weight = 0;
        for (std::size_t k = output.c.size() - 1; k > 0; --k) {
          value = (value + static_cast<long double>(output.c[k][i])) * static_cast<long double>(theta);
          weight = (weight + std::abs(static_cast<long double>(output.c[k][i]))) * static_cast<long double>(theta);
        }
        value += static_cast<long double>(output.c[0][i]);
        // See polynomial_enclosure.hpp: 5.5 n + 5 roundings, and that of the sum with c_0.
        constexpr long double u = std::numeric_limits<double>::epsilon() / 2;
        EXPECT_LE(std::abs(static_cast<long double>(x[i]) - value), 115 * u * weight + u * std::abs(value));
      }
    }
  }
}

TEST(TaylorSeries, MeetsItsTolerance) {
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13}) {
    const auto solution = solve(kepler, bench::Kepler::start(), {0.0, 6.0}, TaylorSeries{},
                                {.rtol = tolerance, .atol = tolerance, .save = Save<Four>::every(0.03)});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    double worst = 0;
    for (std::size_t n = 0; n < solution.t.size(); ++n) {
      const auto exact = bench::Kepler::exact(solution.t[n]);
      for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, std::abs(solution.x[n][i] - exact[i]) / tolerance);
    }
    EXPECT_LT(worst, 30) << tolerance;
  }
}

TEST(TaylorSeries, GoesBackwards) {
  const auto start = bench::Kepler::exact(6.0);
  const auto solution = solve(kepler, start, {6.0, 0.0}, TaylorSeries{}, {.rtol = 1e-12, .atol = 1e-12});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(solution.final_state()[i], bench::Kepler::start()[i], 30e-12) << i;
}

// The first steps may be of another order, before it is known that steps are fixed.
TEST(TaylorSeries, StepsOfAFixedSizeHaveOrderEight) {
  const auto error = [](double step) {
    const auto solution =
        solve([](auto, const auto& x, auto& f) { f[0] = x[0] * (1 - x[0]); }, std::array<long double, 1>{0.125L},
              {0.0L, 8.0L}, TaylorSeries{}, {.step = static_cast<long double>(step)});
    return std::abs(static_cast<double>(solution.final_state()[0] - 1 / (1 + 7 * std::exp(-8.0L))));
  };
  EXPECT_NEAR(std::log2(error(0.25) / error(0.125)), 8, 0.4);
  EXPECT_NEAR(std::log2(error(0.125) / error(0.0625)), 8, 0.3);
}

// A kink, and a jump of which no coefficient tells: the defect does.
TEST(TaylorSeries, FindsWhatNoCoefficientShows) {
  const Options<One> options{.rtol = 1e-10, .atol = 1e-10};
  const auto kink = solve(
      [](auto t, const auto& x, auto& f) {
        using std::abs;
        f[0] = abs(t - 0.3) + 0 * x[0];
      },
      One{0}, {0, 1}, TaylorSeries{}, options);
  ASSERT_TRUE(kink.outcome) << describe(kink.outcome);
  EXPECT_NEAR(kink.final_state()[0], (0.09 + 0.49) / 2, 3e-9);
  const auto jump = solve(
      [](auto t, const auto& x, auto& f) {
        f[0] = x[0];
        if (t > 0.3) f[0] = -x[0];
      },
      One{1}, {0, 1}, TaylorSeries{}, options);
  ASSERT_TRUE(jump.outcome) << describe(jump.outcome);
  EXPECT_NEAR(jump.final_state()[0], std::exp(-0.4), 3e-8);
}

// x = 1/(1 - t^3): two of three coefficients are 0, and the last two may be.
TEST(TaylorSeries, IsNotLedAstrayByCoefficientsThatVanish) {
  const auto solution = solve([](auto t, const auto& x, auto& f) { f[0] = 3 * t * t * x[0] * x[0]; }, One{1}, {0, 0.9},
                              TaylorSeries{}, {.rtol = 1e-12, .atol = 1e-12});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution.final_state()[0], 1 / (1 - 0.729), 1e-9);
}

TEST(TaylorSeries, StopsWhereTheSolutionEnds) {
  const auto solution = solve([](auto, const auto& x, auto& f) { f[0] = x[0] * x[0]; }, One{1}, {0, 2}, TaylorSeries{},
                              {.rtol = 1e-10, .atol = 1e-10});
  EXPECT_FALSE(solution.outcome);
  EXPECT_NEAR(solution.t.back(), 1, 1e-6);
}

// cos t, falling through 0: roots at pi/2 + 2 pi n.
TEST(TaylorSeries, FindsEvents) {
  Options<Two> options{.rtol = 1e-13, .atol = 1e-13};
  options.events.push_back(falls<Two>("zero", [](double, const Two& x) { return x[0]; }));
  const auto solution = solve([](auto, const auto& x, auto& f) { f[0] = x[1], f[1] = -x[0]; }, Two{1, 0}, {0, 30},
                              TaylorSeries{}, options);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  ASSERT_EQ(solution.events.size(), 5U);
  for (std::size_t n = 0; n < 5; ++n)
    EXPECT_NEAR(solution.events[n].t, std::numbers::pi * (0.5 + 2.0 * static_cast<double>(n)), 1e-11) << n;
}

TEST(TaylorSeries, RefusesASystemOfOneNumberType) {
  const auto solution =
      solve([](double, const One& x, One& f) { f[0] = x[0]; }, One{1}, {0, 1}, TaylorSeries{}, Options<One>{});
  EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
  EXPECT_NE(describe(solution.outcome).find("taylor needs a system that takes any number type"), std::string::npos)
      << describe(solution.outcome);
}

/// An equation that gives its coefficients itself, x' = x, and has none from t = 1 on.
struct Growth {
  void operator()(double, const One& x, One& f) const { f = x; }
  std::string_view taylor_coefficients(double t, double scale, std::span<double> c) const {
    if (t >= 1) return "the growth has no series from t = 1 on";
    for (std::size_t k = 1; k < c.size(); ++k) c[k] = c[k - 1] * scale / static_cast<double>(k);
    return {};
  }
};

TEST(TaylorSeries, TakesCoefficientsThatTheSystemGives) {
  const auto solution = solve(Growth{}, One{1}, {0, 0.9}, TaylorSeries{}, {.rtol = 1e-13, .atol = 1e-13});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution.final_state()[0], std::exp(0.9), 1e-12);
  for (const double step : {0.0, 0.125}) {
    const auto beyond = solve(Growth{}, One{1}, {0, 2}, TaylorSeries{}, {.rtol = 1e-10, .step = step});
    EXPECT_EQ(beyond.outcome.ending, Ending::nonlinear_solve_failed);
    EXPECT_NE(describe(beyond.outcome).find("has no series from t = 1 on"), std::string::npos);
  }
}

// 20,000 steps of circles. What rounds x_new, by u = 1.1e-16 or less, moves the radius by some u sqrt(N/12) = 4e-15 in
// N steps; where only the change is rounded, by the part h = pi/100 of that, for each of its operations.
TEST(TaylorSeries, RoundingIsNotAddedUp) {
  long double squares = 0;
  for (int n = 0; n < 8; ++n) {
    const Two start{std::cos(0.1 + 0.7 * n), std::sin(0.1 + 0.7 * n)};
    const auto solution =
        solve([](auto, const auto& x, auto& f) { f[0] = x[1], f[1] = -x[0]; }, start, {0, 200 * std::numbers::pi},
              TaylorSeries{}, {.step = std::numbers::pi / 100, .save = Save<Two>::only_end()});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    const auto radius = [](const Two& x) { return std::hypot(static_cast<long double>(x[0]), x[1]); };
    const long double error = radius(solution.final_state()) - radius(start);
    squares += error * error / 8;
  }
  EXPECT_LT(std::sqrt(squares), 1e-15L);
}

// In other numbers than double.
TEST(TaylorSeries, WorksInFloatAndLongDouble) {
  const auto growth = [](auto, const auto& x, auto& f) { f[0] = x[0]; };
  const auto single = solve(growth, std::array{1.0F}, {0.0F, 1.0F}, TaylorSeries{}, {.rtol = 1e-6F, .atol = 1e-6F});
  EXPECT_NEAR(single.final_state()[0], std::numbers::e_v<float>, 3e-6F);
  const auto extended = solve(growth, std::array{1.0L}, {0.0L, 1.0L}, TaylorSeries{}, {.rtol = 1e-17L, .atol = 1e-17L});
  EXPECT_NEAR(static_cast<double>(extended.final_state()[0] - std::numbers::e_v<long double>), 0, 1e-16);
}

}  // namespace
}  // namespace continuo::taylor_series_test
