// Problems of Cash and Mazzia's test set that Newton's iteration does not solve from a straight line, as models. All 35
// are run by bench/boundary/test_set.py.
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "two_ends.hpp"
#include <continuo/boundary/boundary_of_model.hpp>

namespace continuo::boundary::boundary_test_set_test {
namespace {

model::Simulated solved(const std::string& text, double tolerance, const BoundaryRequest& request = {}) {
  return simulate_boundary(program_of(text), {.rtol = tolerance}, request);
}
std::string said(const model::Simulated& simulated) {
  return simulated.diagnostics.empty() ? "" : simulated.diagnostics.front().message;
}

const std::string burgers = "y'' = (y - y*y')/eps\n";  // problems 25 to 30, by their values at the ends

/// Problem 30: y = t - 7/6 left of a shock and y = t + 1/2 right of it, both exact; the shock is where these are
/// opposite, at 1/3, and has a width of some eps.
TEST(BoundaryTestSet, AShockIsFoundByItself) {
  const auto run = solved("param eps = 1e-3\n" + burgers + "y(0) = -7/6; y(1) = 3/2\nrun 0..1\n", 1e-6);
  ASSERT_TRUE(run.run) << said(run);
  for (std::size_t row = 0; row < run.run->motion.rows(); ++row) {
    const double t = run.run->motion.time(row), y = run.run->motion.state(row)[0];
    if (t > 0.3 && t < 0.37) continue;
    EXPECT_NEAR(y, t < 0.3 ? t - 7.0 / 6 : t + 0.5, 1e-5) << t;
  }
}

/// Problem 20: 1 + eps log cosh((t - 0.745)/eps).
TEST(BoundaryTestSet, ACornerIsFoundAlongAParameter) {
  const auto run = solved(
      "param eps = 1e-4\ny'' = (1 - y'^2)/eps\ny(0) = 1.745 - eps*log(2); y(1) = 1.255 - eps*log(2)\nrun 0..1\n", 1e-6);
  ASSERT_TRUE(run.run) << said(run);
  const double epsilon = 1e-4;
  for (std::size_t row = 0; row < run.run->motion.rows(); ++row) {
    const double far = std::abs(run.run->motion.time(row) - 0.745);
    const double truth = 1 + far + epsilon * std::log((1 + std::exp(-2 * far / epsilon)) / 2);
    EXPECT_NEAR(run.run->motion.state(row)[0], truth, 2e-6);
  }
}

/// Three ways to one solution: continuation from an easy value of the parameter, the search itself, and the table of an
/// earlier run.
TEST(BoundaryTestSet, AlongAParameterAndFromATableItIsTheSame) {
  const std::string text =
      "param eps = 1e-3\nlet A = 1 + t^2, dA = 2*t\n"  // problem 24: a shock in a nozzle
      "y'' = ((1.2 - eps*dA)*y*y' - y'/y - dA/A*(1 - 0.2*y^2))/(eps*A*y)\n"
      "y(0) = 0.9129; y(1) = 0.375\nrun 0..1 output 0.05\n";
  const auto plain = solved(text, 1e-8);
  BoundaryRequest along;
  along.along = {"eps", 0.3, 1e-3};
  const auto followed = solved(text, 1e-8, along);
  ASSERT_TRUE(plain.run && followed.run) << said(plain) << said(followed);
  BoundaryRequest from_table;
  from_table.guess = GuessTable{.name = "t.csv", .columns = {"y", "y'"}, .times = {}, .values = {{}, {}}};
  for (std::size_t row = 0; row < plain.run->motion.rows(); ++row) {
    for (const std::size_t i : {0u, 1u}) {
      const double a = plain.run->motion.state(row)[i], b = followed.run->motion.state(row)[i];
      EXPECT_NEAR(a, b, 2e-8 * (i == 0 ? 1 : 1e3)) << row;  // y' is some hundreds in the shock
      from_table.guess->values[i].push_back(a);
    }
    from_table.guess->times.push_back(plain.run->motion.time(row));
  }
  const auto again = solved(text, 1e-8, from_table);
  ASSERT_TRUE(again.run) << said(again);
  EXPECT_NEAR(again.run->motion.state(10)[0], plain.run->motion.state(10)[0], 2e-8);
}

TEST(BoundaryTestSet, WhatDoesNotFitIsSaid) {
  const std::string text = "param eps = 1e-2\n" + burgers + "y(0) = 1; y(1) = -1/3\nrun 0..1\n";
  BoundaryRequest request;
  request.guess = GuessTable{.name = "t.csv", .columns = {"z"}, .times = {0, 1}, .values = {{0, 1}}};
  const auto no_column = solved(text, 1e-6, request);
  ASSERT_FALSE(no_column.run);
  EXPECT_EQ(no_column.diagnostics.front().code, "E349");
  request.guess->columns = {"y"};
  request.guess->times = {5, 6};
  EXPECT_NE(said(solved(text, 1e-6, request)).find("outside of the run"), std::string::npos);
}

}  // namespace
}  // namespace continuo::boundary::boundary_test_set_test
