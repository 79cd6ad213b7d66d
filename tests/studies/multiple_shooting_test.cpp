// Two methods against each other: shooting and collocation find the same motions.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/multiple_shooting.hpp>

namespace continuo::studies::multiple_shooting_test {
namespace {

using X = std::vector<double>;

TEST(MultipleShooting, ParabolaIsExact) {
  const auto f = [](double, const X& x, X& dxdt) { dxdt = {x[1], 2}; };
  const auto found = solve_by_shooting({parametric_system(2, f), {1, 7}, ends(3, 4)}, {}, {.segments = 2});
  ASSERT_TRUE(found.outcome) << describe(found.outcome);
  EXPECT_EQ(found.times[1], 4);
  EXPECT_NEAR(found.states[1][0], -5.5, 1e-11);
}

TEST(MultipleShooting, BothSolutionsOfBratuAsCollocationHasThem) {
  const auto f = [](double, const X& x, X& dxdt) { dxdt = {x[1], -std::exp(x[0])}; };
  const BoundaryValueProblem problem{parametric_system(2, f), {0, 1}, ends(0, 0)};
  for (const double peak : {0.1, 3.0}) {
    const auto guess = [peak](double t, std::span<double> x) {
      x[0] = 4 * peak * t * (1 - t);
      x[1] = 4 * peak * (1 - 2 * t);
    };
    const auto shot = solve_by_shooting(problem, guess);
    const auto collocated = solve_boundary_values(problem, guess, {.tolerance = 1e-11});
    ASSERT_TRUE(shot.outcome) << describe(shot.outcome);
    ASSERT_TRUE(collocated.outcome);
    for (std::size_t k = 0; k < shot.times.size(); ++k)  // the sum of both tolerances, times a condition below 100
      EXPECT_NEAR(shot.states[k][0], collocated(shot.times[k])[0], 1e-8);
  }
}

TEST(MultipleShooting, UnknownConstant) {  // y'' + k^2 y = 0, y(0) = y(1) = 0, y'(0) = k: k = pi
  const auto f = [](double, Values x, Values p, std::span<double> d) { d[0] = x[1], d[1] = -p[0] * p[0] * x[0]; };
  const auto conditions = [](Values x, Values p, std::span<double> g) { g[0] = x[0], g[1] = x[2], g[2] = x[1] - p[0]; };
  const auto guess = [](double t, std::span<double> x) { x[0] = std::sin(3 * t), x[1] = 3 * std::cos(3 * t); };
  const auto found = solve_by_shooting({parametric_system(2, f, {3.0}), {0, 1}, conditions}, guess);
  ASSERT_TRUE(found.outcome) << describe(found.outcome);
  EXPECT_NEAR(found.parameters[0], M_PI, 1e-8);
}

TEST(MultipleShooting, WithoutASolutionItSaysSo) {
  const auto f = [](double, const X& x, X& dxdt) { dxdt = {x[1], -4 * std::exp(x[0])}; };  // Bratu beyond the fold
  const auto none = solve_by_shooting({parametric_system(2, f), {0, 1}, ends(0, 0)});
  EXPECT_FALSE(none.outcome);
  EXPECT_FALSE(describe(none.outcome).empty());
  EXPECT_EQ(solve_by_shooting({}).outcome.ending, Ending::invalid_input);
}

}  // namespace
}  // namespace continuo::studies::multiple_shooting_test
