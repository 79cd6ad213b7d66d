// Signs that a run keeps: by shorter steps, and by setting to zero what is beyond it by less than the tolerance. The
// references are closed forms, or runs at strict tolerances.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "any_derivative.hpp"
#include <continuo/methods/multistep/adams.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::signs_test {
namespace {

using solve_test::V, solve_test::AnyDerivative;

double least_of(const Solution<V>& solution) {
  double least = 0;
  for (const V& x : solution.x) least = std::min(least, std::ranges::min(x));
  return std::min(least, std::ranges::min(solution.final_state()));
}
const std::vector<Sign> one{Sign::nonnegative};

// H. H. Robertson's reactions: once a concentration is below zero, they run away to infinity.
constexpr AnyDerivative robertson{[](double, const V& x, V& dxdt) {
  dxdt[0] = -0.04 * x[0] + 1e4 * x[1] * x[2];
  dxdt[2] = 3e7 * x[1] * x[1];
  dxdt[1] = -dxdt[0] - dxdt[2];
}};

TEST(Signs, RobertsonSurvivesALooseTolerance) {
  Options<V> options{.rtol = 1e-3, .atol = 1e-3};
  const auto free = solve(robertson, V{1, 0, 0}, {0, 1e11}, Bdf{}, options);
  EXPECT_LT(least_of(free), -1) << "without signs it runs away";
  options.signs = {3, Sign::nonnegative};
  const auto kept = solve(robertson, V{1, 0, 0}, {0, 1e11}, Bdf{}, options);
  ASSERT_TRUE(kept.outcome) << describe(kept.outcome);
  EXPECT_GE(least_of(kept), 0);
  // All has become the third substance. What is set to zero is not taken from another: a few tolerances.
  EXPECT_NEAR(kept.final_state()[2], 1, 20e-3);
}

// x' = -|x| from 1 is exp(-t); from any x < 0 it runs away.
constexpr AnyDerivative decay{[](double, const V& x, V& dxdt) { dxdt[0] = -std::abs(x[0]); }};

TEST(Signs, ADecayDoesNotRunAwayBelowZero) {
  for (const Sign sign : {Sign::nonnegative, Sign::positive}) {
    const auto solution = solve(decay, V{1}, {0, 40}, Bdf{}, {.rtol = 1e-3, .atol = 1e-6, .signs = {sign}});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    for (std::size_t i = 0; i < solution.t.size(); ++i) {
      EXPECT_GE(solution.x[i][0], 0);
      EXPECT_TRUE(sign == Sign::nonnegative || solution.x[i][0] > 0);
      EXPECT_NEAR(solution.x[i][0], std::exp(-solution.t[i]), 1e-2);
    }
  }
  EXPECT_LT(least_of(solve(decay, V{1}, {0, 40}, Bdf{}, {.rtol = 1e-3, .atol = 1e-6})), -1);
}
TEST(Signs, TheMirrorImageIsKeptBelowZero) {
  const AnyDerivative mirrored{[](double, const V& x, V& dxdt) { dxdt[0] = std::abs(x[0]); }};
  const auto above = solve(decay, V{1}, {0, 40}, Bdf{}, {.rtol = 1e-3, .atol = 1e-6, .signs = {Sign::positive}});
  const auto below = solve(mirrored, V{-1}, {0, 40}, Bdf{}, {.rtol = 1e-3, .atol = 1e-6, .signs = {Sign::negative}});
  ASSERT_EQ(above.x.size(), below.x.size());
  for (std::size_t i = 0; i < above.x.size(); ++i) EXPECT_EQ(above.x[i][0], -below.x[i][0]);
  const auto to_zero = solve(mirrored, V{-1}, {0, 40}, Bdf{}, {.rtol = 1e-3, .signs = {Sign::nonpositive}});
  EXPECT_LE(to_zero.final_state()[0], 0);
  EXPECT_NEAR(to_zero.final_state()[0], 0, 1e-5);
}

// G. Dahlquist's knee, e x' = (1 - t) x - x^2: the solution follows 1 - t and then 0. Methods without signs follow 1 -
// t on, where it repels.
TEST(Signs, TheKneeIsTurned) {
  const AnyDerivative knee{[](double t, const V& x, V& dxdt) { dxdt[0] = ((1 - t) * x[0] - x[0] * x[0]) / 1e-6; }};
  Options<V> options{.rtol = 1e-3, .atol = 1e-6};
  EXPECT_NEAR(solve(knee, V{1}, {0, 2}, Bdf{}, options).final_state()[0], -1, 1e-3);
  options.signs = one;
  options.save = save_every(0.01);
  const auto solution = solve(knee, V{1}, {0, 2}, Bdf{}, options);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_GE(least_of(solution), 0);
  for (std::size_t i = 0; i < solution.t.size(); ++i)
    EXPECT_NEAR(solution.x[i][0], std::max(1 - solution.t[i], 0.0), 3e-3) << solution.t[i];
}

// Rows between steps and states at events are kept too.
TEST(Signs, NoRowOfAnyKindIsBeyondItsSign) {
  for (const double spacing : {0.0, 0.05}) {
    Options<V> options{.rtol = 1e-2, .atol = 1e-2, .signs = one};
    options.save = spacing > 0 ? Save<V>::every(spacing) : Save<V>::every_step();
    options.events.push_back({.name = "look", .period = 0.3, .from = 0.1});
    const auto solution = solve(decay, V{1}, {0, 30}, Adams{}, options);
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    EXPECT_GE(least_of(solution), 0);
    for (const auto& event : solution.events) EXPECT_GE(event.before[0], 0);
  }
}

// Mass-action reactions A + B -> C + D with random rates keep every concentration at or above zero, and their sum.
constexpr std::size_t substances = 6, reactions = 10;
struct Reaction {
  std::array<std::size_t, 2> from, to;
  double rate;
};
std::array<Reaction, reactions> network;
constexpr AnyDerivative mass_action{[](double, const V& x, V& dxdt) {
  std::ranges::fill(dxdt, 0.0);
  for (const Reaction& reaction : network) {
    const double flow = reaction.rate * x[reaction.from[0]] * x[reaction.from[1]];
    for (const std::size_t i : reaction.from) dxdt[i] -= flow;
    for (const std::size_t i : reaction.to) dxdt[i] += flow;
  }
}};

TEST(Signs, RandomReactionNetworks) {
  std::mt19937 random(11);
  std::uniform_int_distribution<std::size_t> any(0, substances - 1);
  std::uniform_real_distribution<double> power(-2, 4);
  for (int which = 0; which < 20; ++which) {
    for (Reaction& reaction : network)
      reaction = {{any(random), any(random)}, {any(random), any(random)}, std::pow(10, power(random))};
    V start(substances, 0);
    start[any(random)] = start[any(random)] = 1;
    const auto total = static_cast<double>(std::ranges::count(start, 1.0));
    const auto exact = solve(mass_action, start, {0, 10}, Bdf{}, {.rtol = 1e-10, .atol = 1e-12});
    const auto solution = solve(mass_action, start, {0, 10}, Bdf{},
                                {.rtol = 1e-4, .atol = 1e-5, .signs = {substances, Sign::nonnegative}});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    EXPECT_GE(least_of(solution), 0);
    double sum = 0;
    for (std::size_t i = 0; i < substances; ++i) {
      sum += solution.final_state()[i];
      EXPECT_NEAR(solution.final_state()[i], exact.final_state()[i], 3e-3) << which;
    }
    EXPECT_NEAR(sum, total, 3e-3);
  }
}

// Heat in a square as a system with algebraic equations at its edges (IDA's heat2D): u' = laplace u inside, 0 = u at
// the edge, u = 16 x (1 - x) y (1 - y) at first. u is 16 a(t, x) a(t, y) with a' = a'' on a line, which is a sum of
// sines.
struct Heat {
  static constexpr std::size_t points = 8;
  static constexpr bool autonomous = true;
  [[nodiscard]] static bool at_edge(std::size_t k) {
    const std::size_t i = k / points, j = k % points;
    return i == 0 || j == 0 || i + 1 == points || j + 1 == points;
  }
  [[nodiscard]] static double mass(std::size_t k) { return at_edge(k) ? 0 : 1; }
  void operator()(double, const V& u, V& dudt) const {
    constexpr double per_area = (points - 1) * (points - 1);
    for (std::size_t k = 0; k < u.size(); ++k)
      dudt[k] = at_edge(k) ? u[k] : per_area * (u[k - 1] + u[k + 1] + u[k - points] + u[k + points] - 4 * u[k]);
  }
};

TEST(Signs, HeatInASquareWithAlgebraicEdges) {
  constexpr std::size_t n = Heat::points;
  const double pi = std::acos(-1.0), d = 1.0 / (n - 1);
  const auto along = [&](double t, std::size_t i) {
    double sum = 0;
    for (std::size_t m = 1; m + 1 < n; ++m) {
      const auto wave = [&](std::size_t j) { return std::sin(pi * static_cast<double>(m * j) * d); };
      double part = 0;
      for (std::size_t j = 0; j < n; ++j)
        part += 2 * d * wave(j) * static_cast<double>(j) * d * (1 - static_cast<double>(j) * d);
      const double rate = 2 / d * std::sin(pi * static_cast<double>(m) * d / 2);
      sum += part * std::exp(-rate * rate * t) * wave(i);
    }
    return sum;
  };
  V start(n * n);
  for (std::size_t k = 0; k < n * n; ++k) start[k] = std::max(16 * along(0, k / n) * along(0, k % n), 0.0);
  const auto solution = solve(Heat{}, start, {0, 10}, Bdf{},
                              {.rtol = 0, .atol = 1e-3, .save = save_every(0.01), .signs = {n * n, Sign::nonnegative}});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_GE(least_of(solution), 0);
  for (std::size_t row = 0; row < solution.t.size(); ++row)
    for (std::size_t k = 0; k < n * n; ++k)
      EXPECT_NEAR(solution.x[row][k], 16 * along(solution.t[row], k / n) * along(solution.t[row], k % n), 1e-2);
}

// The solution itself leaves the sign: at t = 1 by a constant rate, at t = pi with the slope of the sine.
TEST(Signs, ASolutionThatLeavesItsSignIsNotHeldAtZero) {
  const AnyDerivative falling{[](double, const V&, V& dxdt) { dxdt[0] = -1; }};
  const AnyDerivative wave{[](double t, const V&, V& dxdt) { dxdt[0] = std::cos(t); }};
  const auto leaves = [](const auto& solution, double t) {
    EXPECT_EQ(solution.outcome.ending, Ending::cannot_continue) << describe(solution.outcome);
    EXPECT_NEAR(solution.outcome.t, t, 1e-3);
    EXPECT_EQ(solution.outcome.component, "x[0]");
    EXPECT_NE(solution.outcome.hint.find("no solution keeps it"), std::string::npos) << solution.outcome.hint;
    EXPECT_GE(least_of(solution), 0);
  };
  for (const Sign sign : {Sign::nonnegative, Sign::positive}) {
    const Options<V> options{.rtol = 1e-3, .atol = 1e-6, .max_steps = 5000, .signs = {sign}};
    leaves(solve(falling, V{1}, {0, 2}, Bdf{}, options), 1);
    leaves(solve(falling, V{1}, {0, 2}, Adams{}, options), 1);
    leaves(solve(wave, V{1e-3}, {0, 20}, Bdf{}, options), std::acos(-1.0));
  }
  // Steps that another component keeps short, so that each leaves by far less than the tolerance.
  const AnyDerivative slowly{[](double t, const V&, V& dxdt) {
    dxdt[0] = -1e-4;
    dxdt[1] = std::cos(1000 * t);
  }};
  const auto solution =
      solve(slowly, V{0, 0}, {0, 10}, Adams{}, {.rtol = 1e-6, .atol = 1e-6, .signs = {Sign::nonnegative, Sign::any}});
  EXPECT_EQ(solution.outcome.ending, Ending::cannot_continue) << describe(solution.outcome);
  EXPECT_NEAR(solution.outcome.t, 0.1, 0.05);
}

TEST(Signs, WhatCannotBeKeptIsRefused) {
  const auto hint = [](const V& start, Options<V> options) {
    const auto solution = solve(decay, start, {0, 1}, Bdf{}, std::move(options));
    EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
    return solution.outcome.hint;
  };
  EXPECT_EQ(hint({-1}, {.signs = one}), "x[0] is to be nonnegative, and is not at the start");
  EXPECT_EQ(hint({0}, {.signs = {Sign::positive}}), "x[0] is to be positive, and is not at the start");
  EXPECT_NE(hint({1}, {.signs = {2, Sign::any}}).find("one for each component"), std::string::npos);
  EXPECT_NE(hint({1}, {.step = 0.1, .signs = one}).find("fixed size"), std::string::npos);
  const Event<V> push{.name = "push", .action = [](EventAction<V>& now) { now.x[0] = -1; }, .times = {0.5}};
  EXPECT_EQ(hint({1}, {.events = {push}, .signs = one}), "after its action x[0] is not nonnegative");
  Integrator integrator(decay, V{1}, {0, 1}, Bdf{}, {.signs = one});
  integrator.advance();
  integrator.set_state({-1});
  EXPECT_EQ(integrator.outcome().ending, Ending::invalid_input);
  EXPECT_GE(integrator.x()[0], 0);
}

}  // namespace
}  // namespace continuo::signs_test
