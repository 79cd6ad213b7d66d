// Boundary-value problems with known solutions, in closed form or to many digits from the literature.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "two_ends.hpp"
#include <continuo/boundary/boundary_value.hpp>

namespace continuo::boundary::boundary_value_test {
namespace {

using X = std::vector<double>;

/// The residual, measured at points other than those of the solver.
double residual_of(const BoundaryValueProblem& problem, const BoundaryValueSolution& solution) {
  double worst = 0;
  X x(problem.system.size), slope(problem.system.size), f(problem.system.size);
  for (std::size_t k = 0; k + 1 < solution.mesh.size(); ++k) {
    double mean = 0;
    constexpr int samples = 40;
    for (int i = 0; i < samples; ++i) {
      const double t = solution.mesh[k] + (i + 0.5) / samples * (solution.mesh[k + 1] - solution.mesh[k]);
      solution.at(t, x);
      solution.slope_at(t, slope);
      problem.system.derivative(t, x, solution.parameters, f);
      for (std::size_t c = 0; c < problem.system.size; ++c) {
        const double part = (slope[c] - f[c]) / (1 + std::abs(f[c]));
        mean += part * part / samples;
      }
    }
    worst = std::max(worst, std::sqrt(mean));
  }
  return worst;
}

TEST(BoundaryValue, ParabolaIsExact) {  // x = t^2 - 47/6 t + ...: x(4) = -5.5
  const auto f = [](double, const X& x, X& dxdt) { dxdt = {x[1], 2}; };
  const BoundaryValueProblem problem{parametric_system(2, f), {1, 7}, ends(3, 4)};
  const auto solution = solve_boundary_values(problem);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution(4)[0], -5.5, 1e-12);
  EXPECT_EQ(solution.meshes, 1u);
}

/// u'' = -lambda exp(u), u(0) = u(1) = 0: u(1/2) = 2 log cosh(theta / 4), theta = sqrt(2 lambda) cosh(theta / 4).
TEST(BoundaryValue, BratuHasTwoSolutions) {
  const auto f = [](double, const X& x, X& dxdt) { dxdt = {x[1], -std::exp(x[0])}; };
  const BoundaryValueProblem problem{parametric_system(2, f), {0, 1}, ends(0, 0)};
  for (const double peak : {0.1, 3.0}) {
    const auto guess = [peak](double t, std::span<double> x) {
      x[0] = 4 * peak * t * (1 - t);
      x[1] = 4 * peak * (1 - 2 * t);
    };
    const auto solution = solve_boundary_values(problem, guess, {.tolerance = 1e-9});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    double theta = peak < 1 ? 1.5 : 11;  // Newton on the equation of the closed form
    for (int i = 0; i < 50; ++i) {
      const double value = theta - std::sqrt(2.0) * std::cosh(theta / 4);
      theta -= value / (1 - std::sqrt(2.0) / 4 * std::sinh(theta / 4));
    }
    // |error| <= |inverse| times the residual; the inverse of u'' + exp(u) is below 10 for both.
    EXPECT_NEAR(solution(0.5)[0], 2 * std::log(std::cosh(theta / 4)), 1e-8);
    EXPECT_LE(residual_of(problem, solution), 1.2e-9);
  }
}

/// x'' = mu sinh(mu x), x(0) = 0, x(1) = 1: x'(0) = 3.5833778463e-4 for mu = 10 (M. R. Scott, W. H. Vandevender, 1975).
TEST(BoundaryValue, Troesch) {
  const double mu = 10;
  const auto f = [mu](double, const X& x, X& dxdt) { dxdt = {x[1], mu * std::sinh(mu * x[0])}; };
  const BoundaryValueProblem problem{parametric_system(2, f), {0, 1}, ends(0, 1)};
  const auto guess = [](double t, std::span<double> x) { x[0] = t, x[1] = 1; };
  const auto solution = solve_boundary_values(problem, guess, {.tolerance = 1e-10});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution(0)[1], 3.5833778463e-4, 1e-12);
  EXPECT_LE(residual_of(problem, solution), 1.2e-10);
}

/// 2 f''' + f f'' = 0, f(0) = f'(0) = 0, f'(oo) = 1: f''(0) = 0.332057336215196; at 12 f' is 1 to 1e-16.
TEST(BoundaryValue, Blasius) {
  const auto f = [](double, const X& x, X& dxdt) { dxdt = {x[1], x[2], -x[0] * x[2] / 2}; };
  const auto conditions = [](Values x, Values, std::span<double> g) { g[0] = x[0], g[1] = x[1], g[2] = x[4] - 1; };
  const BoundaryValueProblem problem{parametric_system(3, f), {0, 12}, conditions};
  const auto guess = [](double t, std::span<double> x) {
    x[0] = t * t / (t + 2), x[1] = t / (t + 1), x[2] = std::exp(-t);
  };
  const auto solution = solve_boundary_values(problem, guess, {.tolerance = 1e-12});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution(0)[2], 0.332057336215196, 1e-12);
}

/// eps x'' + x' = -1 ... a layer at 0 of width eps: x = (1 - exp(-t/eps)) / (1 - exp(-1/eps)) for eps x'' + x' = 0.
TEST(BoundaryValue, Layer) {
  const double epsilon = 1e-4;
  const auto f = [epsilon](double, const X& x, X& dxdt) { dxdt = {x[1], -x[1] / epsilon}; };
  const BoundaryValueProblem problem{parametric_system(2, f), {0, 1}, ends(0, 1)};
  const auto solution = solve_boundary_values(problem, {}, {.tolerance = 1e-6});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  for (const double t : {1e-5, 1e-4, 3e-4, 1e-3, 0.5}) EXPECT_NEAR(solution(t)[0], 1 - std::exp(-t / epsilon), 1e-6);
  EXPECT_LE(residual_of(problem, solution), 1.2e-6);
  EXPECT_LT(solution.mesh.size(), 300u);
}

/// The fourth derivative of w is q / EI, clamped at 0, free at L: the tip is at q L^4 / (8 EI). A polynomial, hence
/// exact.
TEST(BoundaryValue, Cantilever) {
  const double load = 3, stiffness = 7, length = 2;
  const auto f = [=](double, const X& x, X& dxdt) { dxdt = {x[1], x[2], x[3], load / stiffness}; };
  const auto conditions = [](Values x, Values, std::span<double> g) {
    g[0] = x[0], g[1] = x[1], g[2] = x[6], g[3] = x[7];
  };
  const auto solution = solve_boundary_values({parametric_system(4, f), {0, length}, conditions});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution(length)[0], load * std::pow(length, 4) / (8 * stiffness), 1e-13);
}

/// y'' + k^2 y = 0, y(0) = y(1) = 0, y'(0) = k: k = pi, 2 pi, ...
TEST(BoundaryValue, UnknownConstantIsFound) {
  const auto f = [](double, Values x, Values p, std::span<double> dxdt) {
    dxdt[0] = x[1], dxdt[1] = -p[0] * p[0] * x[0];
  };
  const auto conditions = [](Values x, Values p, std::span<double> g) { g[0] = x[0], g[1] = x[2], g[2] = x[1] - p[0]; };
  for (const int n : {1, 2}) {
    const auto guess = [n](double t, std::span<double> x) {
      x[0] = std::sin(3 * n * t);
      x[1] = 3 * n * std::cos(3 * n * t);
    };
    const BoundaryValueProblem problem{parametric_system(2, f, {3.0 * n}), {0, 1}, conditions};
    const auto solution = solve_boundary_values(problem, guess, {.tolerance = 1e-9});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    EXPECT_NEAR(solution.parameters[0], n * std::numbers::pi, 1e-8);
  }
}

/// x'' + x' + x = cos t has the periodic solution sin t.
TEST(BoundaryValue, PeriodicConditions) {
  const auto f = [](double t, const X& x, X& dxdt) { dxdt = {x[1], std::cos(t) - x[1] - x[0]}; };
  const auto conditions = [](Values x, Values, std::span<double> g) { g[0] = x[0] - x[2], g[1] = x[1] - x[3]; };
  const auto solution =
      solve_boundary_values({parametric_system(2, f), {0, 2 * std::numbers::pi}, conditions}, {}, {.tolerance = 1e-10});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  for (const double t : {0.0, 1.0, 4.0}) EXPECT_NEAR(solution(t)[0], std::sin(t), 1e-9);
}

/// x''' = 0 through three points: x = 2 - 3 t + t^2.
TEST(BoundaryValue, ConditionsInTheMiddle) {
  const auto f = [](double, const X& x, X& dxdt) { dxdt = {x[1], x[2], 0}; };
  const auto conditions = [](Values x, Values, std::span<double> g) {
    g[0] = x[0] - 2, g[1] = x[3], g[2] = x[6] - 0.75;
  };
  const auto solution = solve_boundary_values({parametric_system(3, f), {0, 1, 2.5}, conditions});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution(1.5)[0], -0.25, 1e-13);
  EXPECT_NEAR(solution(2.5)[2], 2, 1e-12);
}

TEST(BoundaryValue, NoSolutionEndsByName) {
  const auto oscillator = [](double, const X& x, X& dxdt) { dxdt = {x[1], -x[0]}; };
  // x = c sin t for x(0) = 0, and x(pi) = 0 for each c.
  const auto none = solve_boundary_values({parametric_system(2, oscillator), {0, std::numbers::pi}, ends(0, 1)});
  EXPECT_FALSE(none.outcome);
  const auto bratu = [](double, const X& x, X& dxdt) { dxdt = {x[1], -4 * std::exp(x[0])}; };  // beyond 3.5138
  const auto fold = solve_boundary_values({parametric_system(2, bratu), {0, 1}, ends(0, 0)});
  EXPECT_EQ(fold.outcome.ending, Ending::nonlinear_solve_failed) << describe(fold.outcome);
  EXPECT_FALSE(fold.outcome.hint.empty());
}

TEST(BoundaryValue, WhatCannotBeAsked) {
  const auto f = [](double, const X& x, X& dxdt) { dxdt = {x[1], 2}; };
  const auto ending = [&](std::vector<double> times, BoundaryValueOptions options) {
    return solve_boundary_values({parametric_system(2, f), std::move(times), ends(0, 1)}, {}, options).outcome.ending;
  };
  EXPECT_EQ(ending({0}, {}), Ending::invalid_input);
  EXPECT_EQ(ending({1, 0}, {}), Ending::invalid_input);
  EXPECT_EQ(ending({0, 1}, {.tolerance = 0}), Ending::invalid_input);
  EXPECT_EQ(solve_boundary_values({}).outcome.ending, Ending::invalid_input);
  const auto broken = [](double, const X& x, X& dxdt) { dxdt = {x[1], std::log(-1 - x[0] * x[0])}; };
  EXPECT_EQ(solve_boundary_values({parametric_system(2, broken), {0, 1}, ends(0, 1)}).outcome.ending,
            Ending::not_finite);
  const std::atomic<bool> now = true;
  EXPECT_EQ(ending({0, 1}, {.interrupt = &now}), Ending::interrupted);
}

TEST(BoundaryValue, TooFineAMeshKeepsTheLastSolution) {
  const auto f = [](double, const X& x, X& dxdt) { dxdt = {x[1], -x[1] / 1e-4}; };
  const auto solution = solve_boundary_values({parametric_system(2, f), {0, 1}, ends(0, 1)}, {},
                                              {.tolerance = 1e-9, .most_intervals = 100});
  EXPECT_EQ(solution.outcome.ending, Ending::too_many_steps);
  EXPECT_FALSE(solution.mesh.empty());
  EXPECT_GT(solution.residual, 1e-9);
}

}  // namespace
}  // namespace continuo::boundary::boundary_value_test
