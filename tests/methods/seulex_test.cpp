// The extrapolated linearly implicit Euler method: accuracy on the stiff problems, algebraic equations, reuse of
// Jacobians, failures. Its table is tested in extrapolation_test.cpp.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <bench/problems/hires.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/pollution.hpp>
#include <bench/problems/prothero_robinson.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include "stiff_promises.hpp"
#include <continuo/methods/extrapolation/seulex.hpp>

namespace continuo::seulex_test {
namespace {

using testing::AnySystem, testing::Two;

// The bound of the suite: within a factor of 30 of the tolerance. Extrapolation multiplies rounding errors by up to a
// hundred, and thousands of steps add them up: below 1e-10 they count for components relative to their size.
TEST(Seulex, MeetsItsToleranceOnStiffProblems) {
  for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9, 1e-10}) {
    EXPECT_LT(promises::error_in_tolerances<Seulex>(bench::Robertson<>{}, rtol, rtol * 1e-8), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<Seulex, bench::Hires<>>(rtol, rtol * 1e-4)), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<Seulex, bench::Oregonator<>>(rtol, rtol * 1e-6)), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<Seulex, bench::Pollution<>>(rtol, rtol * 1e-6)), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<Seulex, bench::VanDerPolScaled<>>(rtol, rtol)), 30) << rtol;
  }
}

TEST(Seulex, KeepsTheSumOfRobertsonsAmounts) {
  // A linear invariant: each step keeps it to rounding, some thousand steps of 2e-16 each.
  const auto solution =
      solve(bench::Robertson<>{}, bench::Robertson<>::start(), {0.0, 1e11}, Seulex{}, {.rtol = 1e-6, .atol = 1e-12});
  const auto& x = solution.final_state();
  EXPECT_NEAR(x[0] + x[1] + x[2], 1, 1e-12);
}

TEST(Seulex, DenseOutputMeetsTheTolerance) {
  const auto exact = [](double t) { return bench::ProtheroRobinson<>::exact(t)[0]; };
  for (const double tolerance : {1e-4, 1e-7, 1e-9})
    EXPECT_LT(promises::dense_error_in_tolerances<Seulex>(promises::prothero_robinson(), 10, tolerance, exact), 30)
        << tolerance;
}

TEST(Seulex, SolvesAlgebraicEquations) {
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12})
    EXPECT_LT(promises::error_of_algebraic_decay<Seulex>(tolerance), 30) << tolerance;
}

// x' = z, 0 = x^2 + z^2 - 1: x = sin(t), z = cos(t), between the steps too.
TEST(Seulex, SolvesNonlinearAlgebraicEquationsBetweenTheStepsToo) {
  const AnySystem<Two> circle{.f = [](double, const Two& x, Two& out) { out = {x[1], x[0] * x[0] + x[1] * x[1] - 1}; },
                              .masses = [](std::size_t i) { return i == 0 ? 1 : 0; }};
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9}) {
    Integrator integrator(circle, Two{0, 1}, {0.0, 1.2}, Seulex{}, {.rtol = tolerance, .atol = tolerance});
    double worst = 0;
    Two x{};
    while (integrator.advance()) {
      for (const double theta : {0.1, 0.4, 0.7, 1.0}) {
        integrator.interpolant()(theta, x);
        const double t = integrator.step_begin() + theta * integrator.step_size();
        worst = std::max({worst, std::abs(x[0] - std::sin(t)), std::abs(x[1] - std::cos(t))});
      }
    }
    ASSERT_TRUE(integrator.outcome()) << describe(integrator.outcome());
    EXPECT_LT(worst / tolerance, 30) << tolerance;
  }
}

// Backwards, x' = 1000 (x - cos t) - sin t is stiff.
TEST(Seulex, GoesBackwards) {
  const AnySystem<Two> system{.f = [](double t, const Two& x, Two& dxdt) {
    for (std::size_t i = 0; i < 2; ++i) dxdt[i] = 1000 * (x[i] - std::cos(t)) - std::sin(t);
  }};
  const auto solution = solve(system, Two{1, 2}, {3.0, 0.0}, Seulex{}, {.rtol = 1e-8, .atol = 1e-8});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  for (const double x : solution.final_state()) EXPECT_NEAR(x, 1, 30e-8);
}

// Of a linear system one Jacobian is good for all steps, even of run-time size and sparse.
using promises::Heat;
TEST(Seulex, ALinearSystemNeedsOneJacobian) {
  std::vector<double> u(Heat::nodes);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::sin(M_PI * Heat::dx * static_cast<double>(i + 1));
  const auto solution = solve(Heat{}, u, {0.0, 0.2}, Seulex{}, {.rtol = 1e-9, .atol = 1e-9});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  const double rate = 4 / (Heat::dx * Heat::dx) * std::pow(std::sin(M_PI * Heat::dx / 2), 2);
  for (std::size_t i = 0; i < u.size(); ++i)
    EXPECT_NEAR(solution.final_state()[i], u[i] * std::exp(-0.2 * rate), 30 * (1e-9 + 1e-9 * u[i]));
  EXPECT_LT(solution.statistics.jacobians, 4U);
  EXPECT_GT(solution.statistics.steps, 4U);
}

TEST(Seulex, ACopyGoesOnToTheSameBits) {
  promises::expect_copy_goes_on_to_the_same_bits<Seulex>(testing::any_system(bench::VanDerPol<>{}),
                                                         bench::VanDerPol<>::start(), 2000);
}

TEST(Seulex, FailuresAreNamed) {
  promises::expect_not_finite_ends_by_name<Seulex>();
  promises::expect_singular_ends_by_name<Seulex>();
}

// The number of steps grows more slowly than with order 5.
TEST(Seulex, OrderFollowsTheTolerance) {
  const auto steps = [](double rtol) {
    return static_cast<double>(solve(bench::Robertson<>{}, bench::Robertson<>::start(), {0.0, 1e11}, Seulex{},
                                     {.rtol = rtol, .atol = 1e-8 * rtol})
                                   .statistics.steps);
  };
  EXPECT_LT(steps(1e-9) / steps(1e-5), std::pow(1e4, 1.0 / 5));
}

}  // namespace
}  // namespace continuo::seulex_test
