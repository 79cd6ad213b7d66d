// Backward differentiation: its formulas on powers of time, its accuracy on the stiff problems.
#include <array>
#include <cmath>
#include <vector>

#include <bench/problems/hires.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/prothero_robinson.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include "stiff_promises.hpp"
#include <continuo/methods/multistep/bdf.hpp>

namespace continuo::bdf_test {
namespace {

using testing::Two;

double binomial(std::size_t n, std::size_t k) {
  double result = 1;
  for (std::size_t i = 1; i <= k; ++i) result = result * static_cast<double>(n - k + i) / static_cast<double>(i);
  return result;
}

/// The backward difference of order j at s of the power m, at spacing 1.
double difference(std::size_t j, double s, int m) {
  double sum = 0;
  for (std::size_t i = 0; i <= j; ++i)
    sum += (i % 2 ? -1 : 1) * binomial(j, i) * std::pow(s - static_cast<double>(i), m);
  return sum;
}

// With y = s^m, h = 1 and the step from 0 to 1: d is the difference of order k + 1 at 1, so for m <= k the formula is
// exact, and for m = k + 1 it is wrong by the error constant times d = (k + 1)!. All numbers are whole or small.
TEST(Bdf, FormulasAreExactUpToTheirOrderAndWrongByTheirErrorConstantBeyond) {
  for (std::size_t k = 1; k <= Bdf::greatest_order; ++k) {
    for (int m = 1; m <= static_cast<int>(k) + 1; ++m) {
      const double d = difference(k + 1, 1, m);
      double sum = ndf::alpha<double>(k) * d;
      for (std::size_t j = 1; j <= k; ++j) sum += ndf::gamma<double>(j) * difference(j, 0, m);
      const double defect = sum - m;
      EXPECT_NEAR(defect, -ndf::error_constant<double>(k) * d, 1e-10) << "order " << k << ", power " << m;
      if (m <= static_cast<int>(k)) {
        EXPECT_NEAR(d, 0, 1e-10);
      }
    }
  }
}

// The bound of the issue: within a factor of 30 of the tolerance, over the whole range of tolerances.
TEST(Bdf, MeetsItsToleranceOnStiffProblems) {
  for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
    EXPECT_LT(promises::error_in_tolerances<Bdf>(bench::Robertson<>{}, rtol, rtol * 1e-8), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<Bdf, bench::Hires<>>(rtol, rtol * 1e-4)), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<Bdf, bench::Oregonator<>>(rtol, rtol * 1e-6)), 30) << rtol;
  }
}

TEST(Bdf, KeepsTheSumOfRobertsonsAmounts) {
  // A linear invariant: each step keeps it to rounding, some thousand steps of 2e-16 each.
  const auto solution =
      solve(bench::Robertson<>{}, bench::Robertson<>::start(), {0.0, 1e11}, Bdf{}, {.rtol = 1e-6, .atol = 1e-12});
  const auto& x = solution.final_state();
  EXPECT_NEAR(x[0] + x[1] + x[2], 1, 1e-12);
}

TEST(Bdf, DenseOutputMeetsTheTolerance) {
  const auto exact = [](double t) { return bench::ProtheroRobinson<>::exact(t)[0]; };
  for (const double tolerance : {1e-4, 1e-7, 1e-9})
    EXPECT_LT(promises::dense_error_in_tolerances<Bdf>(promises::prothero_robinson(), 10, tolerance, exact), 30)
        << tolerance;
}

// Order 2 from the second step on; the error of the first step, of order 1, is of the size of h^2 too.
TEST(Bdf, FixedStepsHaveOrderTwo) {
  const testing::AnySystem<Two> logistic{
      .f = [](double, const Two& x, Two& out) { out = {x[0] * (1 - x[0]), x[1] * (1 - x[1])}; }};
  const auto error = [&](double h) {
    const auto solution =
        solve(logistic, Two{0.125, 0.125}, {0.0, 4.0}, Bdf{}, {.rtol = 1e-12, .atol = 1e-12, .step = h});
    EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
    return std::abs(solution.final_state()[0] - 1 / (1 + 7 * std::exp(-4.0)));
  };
  // The next term of the error is some h smaller.
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), 2, 0.1);
}

TEST(Bdf, SolvesAlgebraicEquations) {
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) EXPECT_LT(promises::error_of_algebraic_decay<Bdf>(tolerance), 30);
}

TEST(Bdf, ACopyGoesOnToTheSameBits) {
  promises::expect_copy_goes_on_to_the_same_bits<Bdf>(testing::any_system(bench::VanDerPol<>{}),
                                                      bench::VanDerPol<>::start(), 2000);
}

TEST(Bdf, FailuresAreNamed) {
  promises::expect_not_finite_ends_by_name<Bdf>();
  promises::expect_singular_ends_by_name<Bdf>();
}

using promises::Heat;

TEST(Bdf, SolvesSparseSystemsOfRunTimeSize) {
  std::vector<double> u(Heat::nodes);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::sin(M_PI * Heat::dx * static_cast<double>(i + 1));
  const auto solution = solve(Heat{}, u, {0.0, 0.2}, Bdf{}, {.rtol = 1e-7, .atol = 1e-9});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  const double rate = 4 / (Heat::dx * Heat::dx) * std::pow(std::sin(M_PI * Heat::dx / 2), 2);
  for (std::size_t i = 0; i < u.size(); ++i)
    EXPECT_NEAR(solution.final_state()[i], u[i] * std::exp(-0.2 * rate), 30 * (1e-9 + 1e-7 * u[i]));
  // Three groups and a base, not 33: the evaluations of all Jacobians stay few.
  EXPECT_LT(solution.statistics.jacobians * 4, solution.statistics.evaluations);
  promises::expect_copy_goes_on_to_the_same_bits<Bdf>(Heat{}, u, 0.2);
}

}  // namespace
}  // namespace continuo::bdf_test
