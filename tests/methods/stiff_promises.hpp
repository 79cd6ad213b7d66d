// Properties of every adaptive stiff method, tested by the same code for all of them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <bench/problems/problem.hpp>
#include <bench/problems/prothero_robinson.hpp>
#include <gtest/gtest.h>

#include "any_system.hpp"
#include "solved_by_name.hpp"
#include <continuo/solve/solve.hpp>

namespace continuo::promises {

using testing::any_system, testing::AnySystem, testing::Two;

/// The greatest error of a component at the end of the problem, relative to the component, in units of rtol.
template <class Problem, class X>
double error_in_tolerances(const Solution<X>& solution, double rtol, double atol) {
  EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  const auto expected = bench::end_of<Problem>();
  double worst = 0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    worst = std::max(worst, std::abs(solution.final_state()[i] - expected[i]) / (atol + rtol * std::abs(expected[i])));
  return worst;
}
template <class M, class Problem>
double error_in_tolerances(const Problem& problem, double rtol, double atol) {
  return error_in_tolerances<Problem>(
      solve(problem, Problem::start(), {0.0, Problem::duration}, M{}, {.rtol = rtol, .atol = atol}), rtol, atol);
}
/// The same of the method as the studies have it.
template <class M, class Problem>
double error_in_tolerances_by_name(double rtol, double atol) {
  return error_in_tolerances<Problem>(solved_by_name<M, Problem>(rtol, atol), rtol, atol);
}

/// x' = -y, 0 = x - y: x = y = exp(-t).
inline AnySystem<Two> algebraic_decay() {
  return {.f = [](double, const Two& x, Two& out) { out = {-x[1], x[0] - x[1]}; },
          .masses = [](std::size_t i) { return i == 0 ? 1 : 0; }};
}

/// The greatest error of either component at t = 1 in units of the tolerance.
template <class M>
double error_of_algebraic_decay(double tolerance) {
  const auto solution = solve(algebraic_decay(), Two{1, 1}, {0.0, 1.0}, M{}, {.rtol = tolerance, .atol = tolerance});
  EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  const double exact = std::exp(-1.0);
  return std::max(std::abs(solution.final_state()[0] - exact), std::abs(solution.final_state()[1] - exact)) / tolerance;
}

/// A copy of the integrator in the middle of the run goes on to the same bits as the original.
template <class M, class System, class X>
void expect_copy_goes_on_to_the_same_bits(const System& system, const X& start, double end) {
  Integrator original(system, start, {0.0, end}, M{}, {.rtol = 1e-6, .atol = 1e-10});
  for (int i = 0; i < 25 && original.advance(); ++i) {
  }
  Integrator copy = original;
  while (original.advance()) {
  }
  while (copy.advance()) {
  }
  ASSERT_TRUE(original.outcome()) << describe(original.outcome());
  EXPECT_EQ(original.statistics().steps, copy.statistics().steps);
  EXPECT_GT(original.statistics().steps, 30U);
  for (std::size_t i = 0; i < dimension(start); ++i) EXPECT_EQ(original.x()[i], copy.x()[i]);
}

/// The equation of A. Prothero and A. Robinson, twice.
inline AnySystem<Two> prothero_robinson() {
  return {.f = [](double t, const Two& x, Two& out) {
    const bench::ProtheroRobinson<> one;
    std::array<double, 1> slope{};
    for (std::size_t i = 0; i < 2; ++i) one(t, std::array{x[i]}, slope), out[i] = slope[0];
  }};
}

/// The greatest distance of the dense output from `exact`, that of both components, within the steps, in units of the
/// tolerance.
template <class M>
double dense_error_in_tolerances(const AnySystem<Two>& system, double end, double tolerance, const auto& exact) {
  Integrator integrator(system, Two{exact(0), exact(0)}, {0.0, end}, M{}, {.rtol = tolerance, .atol = tolerance});
  double worst = 0;
  Two x{};
  while (integrator.advance()) {
    for (const double theta : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      integrator.interpolant()(theta, x);
      for (const double value : x)
        worst = std::max(worst, std::abs(value - exact(integrator.step_begin() + theta * integrator.step_size())));
    }
  }
  EXPECT_TRUE(integrator.outcome()) << describe(integrator.outcome());
  return worst / tolerance;
}

/// f is NaN beyond t = 1: the run ends there with the ending of that name, and keeps its results.
template <class M>
void expect_not_finite_ends_by_name() {
  const AnySystem<Two> broken{.f = [](double t, const Two& x, Two& out) {
    out = {-x[0], t < 1 ? -1000 * x[1] : std::numeric_limits<double>::quiet_NaN()};
  }};
  const auto solution = solve(broken, Two{1, 1}, {0.0, 2.0}, M{}, {.rtol = 1e-6, .atol = 1e-9});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite) << describe(solution.outcome);
  EXPECT_NEAR(solution.outcome.t, 1, 1e-9);
  // The errors of the steps add up; this suite allows 30 tolerances everywhere.
  EXPECT_NEAR(solution.final_state()[0], std::exp(-solution.outcome.t), 30e-6);
}

/// An algebraic equation that does not contain its unknown: index 2, the matrix of the step is singular.
template <class M>
void expect_singular_ends_by_name() {
  const AnySystem<Two> higher_index{.f = [](double t, const Two& x, Two& out) { out = {x[1] * 0 - x[0], t - x[0]}; },
                                    .masses = [](std::size_t i) { return i == 0 ? 1 : 0; }};
  const auto solution = solve(higher_index, Two{0, 1}, {0.0, 1.0}, M{}, {.rtol = 1e-6, .atol = 1e-6});
  EXPECT_EQ(solution.outcome.ending, Ending::nonlinear_solve_failed) << describe(solution.outcome);
}

/// The heat equation on thirty-three nodes, given as a pattern without values: differences by three groups of columns.
/// The mode sin(pi x) of the discrete equation decays with 4/dx^2 sin^2(pi dx / 2).
struct Heat {
  static constexpr std::size_t nodes = 33;
  static constexpr double dx = 1.0 / (nodes + 1);
  SparsePattern pattern = [] {
    std::vector<MatrixPlace> places;
    for (std::uint32_t i = 1; i < nodes; ++i) places.insert(places.end(), {{i, i - 1}, {i - 1, i}});
    return SparsePattern(nodes, places);
  }();

  void operator()(double, const std::vector<double>& u, std::vector<double>& dudt) const {
    for (std::size_t i = 0; i < nodes; ++i) {
      const double left = i > 0 ? u[i - 1] : 0, right = i + 1 < nodes ? u[i + 1] : 0;
      dudt[i] = (left - 2 * u[i] + right) / (dx * dx);
    }
  }
  const SparsePattern& jacobian_pattern() const { return pattern; }
};

}  // namespace continuo::promises
