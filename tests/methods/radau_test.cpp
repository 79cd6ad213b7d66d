// Radau IIA of orders 5, 9, 13 and of variable order: accuracy on the stiff problems. The orders are measured in
// stiff_order_test.cpp, the uses of long double and 113 bits are tested in precision_test.cpp.
#include <array>
#include <cmath>
#include <vector>

#include <bench/problems/hires.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/pollution.hpp>
#include <bench/problems/prothero_robinson.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include "stiff_promises.hpp"
#include <continuo/methods/collocation/radau.hpp>

namespace continuo::radau_test {
namespace {

// The bound of the suite: within a factor of 30 of the tolerance, over the whole range of tolerances.
template <class M>
void expect_tolerance_is_met() {
  for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
    EXPECT_LT(promises::error_in_tolerances<M>(bench::Robertson<>{}, rtol, rtol * 1e-8), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<M, bench::Hires<>>(rtol, rtol * 1e-4)), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<M, bench::Oregonator<>>(rtol, rtol * 1e-6)), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<M, bench::Pollution<>>(rtol, rtol * 1e-6)), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<M, bench::VanDerPolScaled<>>(rtol, rtol)), 30) << rtol;
  }
}
TEST(Radau, Radau5MeetsItsToleranceOnStiffProblems) {
  expect_tolerance_is_met<Radau5>();
}
TEST(Radau, VariableOrderMeetsItsToleranceOnStiffProblems) {
  expect_tolerance_is_met<Radau>();
}

TEST(Radau, VariableOrderNeedsFarFewerStepsAtTightTolerances) {
  const auto steps = []<class M>(M method, double rtol) {
    return solve(bench::Robertson<>{}, bench::Robertson<>::start(), {0.0, 1e11}, method,
                 {.rtol = rtol, .atol = 1e-8 * rtol})
        .statistics.steps;
  };
  EXPECT_LT(8 * steps(Radau{}, 1e-11), steps(Radau5{}, 1e-11));
}

TEST(Radau, KeepsTheSumOfRobertsonsAmounts) {
  // A linear invariant: each step keeps it to rounding, some hundred steps of 2e-16 each.
  const auto solution =
      solve(bench::Robertson<>{}, bench::Robertson<>::start(), {0.0, 1e11}, Radau{}, {.rtol = 1e-6, .atol = 1e-12});
  const auto& x = solution.final_state();
  EXPECT_NEAR(x[0] + x[1] + x[2], 1, 1e-13);
}

TEST(Radau, DenseOutputMeetsTheTolerance) {
  const auto exact = [](double t) { return bench::ProtheroRobinson<>::exact(t)[0]; };
  for (const double tolerance : {1e-4, 1e-7, 1e-9}) {
    EXPECT_LT(promises::dense_error_in_tolerances<Radau5>(promises::prothero_robinson(), 10, tolerance, exact), 30)
        << tolerance;
    EXPECT_LT(promises::dense_error_in_tolerances<Radau>(promises::prothero_robinson(), 10, tolerance, exact), 30)
        << tolerance;
  }
}

TEST(Radau, SolvesAlgebraicEquations) {
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    EXPECT_LT(promises::error_of_algebraic_decay<Radau5>(tolerance), 30);
    EXPECT_LT(promises::error_of_algebraic_decay<Radau>(tolerance), 30);
  }
}

TEST(Radau, ACopyGoesOnToTheSameBits) {
  promises::expect_copy_goes_on_to_the_same_bits<Radau>(testing::any_system(bench::VanDerPol<>{}),
                                                        bench::VanDerPol<>::start(), 2000);
}

TEST(Radau, FailuresAreNamed) {
  promises::expect_not_finite_ends_by_name<Radau>();
  promises::expect_singular_ends_by_name<Radau>();
}

// x' = J x with run-time size, sparse by its pattern.
using promises::Heat;

TEST(Radau, SolvesSparseSystemsOfRunTimeSize) {
  std::vector<double> u(Heat::nodes);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::sin(M_PI * Heat::dx * static_cast<double>(i + 1));
  const auto solution = solve(Heat{}, u, {0.0, 0.2}, Radau{}, {.rtol = 1e-9, .atol = 1e-9});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  const double rate = 4 / (Heat::dx * Heat::dx) * std::pow(std::sin(M_PI * Heat::dx / 2), 2);
  for (std::size_t i = 0; i < u.size(); ++i)
    EXPECT_NEAR(solution.final_state()[i], u[i] * std::exp(-0.2 * rate), 30 * (1e-9 + 1e-9 * u[i]));
  EXPECT_LT(solution.statistics.jacobians, 6U) << "a linear system";
}

}  // namespace
}  // namespace continuo::radau_test
