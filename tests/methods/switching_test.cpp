// The pair of an explicit and a stiff method: it detects by itself which of the two the system needs, and when.
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <bench/problems/hires.hpp>
#include <bench/problems/lotka_volterra.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include "stiff_promises.hpp"
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/switching.hpp>
#include <continuo/solve/automatic.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo::switching_test {
namespace {

using testing::Two;
using Pair = Tsitouras5Bdf;

TEST(Switching, MeetsItsToleranceOnStiffProblems) {
  for (const double rtol : {1e-4, 1e-7, 1e-10}) {
    EXPECT_LT((promises::error_in_tolerances_by_name<Pair, bench::Hires<>>(rtol, rtol * 1e-4)), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<Pair, bench::Oregonator<>>(rtol, rtol * 1e-6)), 30) << rtol;
    EXPECT_LT((promises::error_in_tolerances_by_name<Pair, bench::VanDerPol<>>(rtol, rtol)), 30) << rtol;
  }
}

TEST(Switching, StaysWithTheExplicitMethodWhereNothingIsStiff) {
  const auto run = [](auto method, const Options<Two>& options = {}) {
    return solve(testing::any_system(bench::LotkaVolterra<>{}), bench::LotkaVolterra<>::start(), {0.0, 100.0}, method,
                 options);
  };
  const auto pair = run(Pair{}), alone = run(Tsitouras5{});
  EXPECT_EQ(pair.statistics.jacobians, 0U);
  // On an orbit errors add up, and the pair limits them: its errors at the end are the smaller ones.
  const auto exact = run(Dop853{}, {.rtol = 1e-13, .atol = 1e-13});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(std::abs(pair.final_state()[i] - exact.final_state()[i]),
              std::abs(alone.final_state()[i] - exact.final_state()[i]));
  }
}

// Van der Pol with mu = 1000 is stiff on its slow branches and not on the jumps between: there and back several times.
TEST(Switching, GoesThereAndBack) {
  Integrator integrator(testing::any_system(bench::VanDerPol<>{}), bench::VanDerPol<>::start(), {0.0, 4000.0}, Pair{},
                        {.rtol = 1e-6});
  std::size_t jacobians = 0, quiet = 0, stretches = 0;
  while (integrator.advance()) {
    const std::size_t now = integrator.statistics().jacobians;
    quiet = now == jacobians ? quiet + 1 : 0;
    if (quiet == 60) ++stretches;  // a stiff method renews its Jacobian at least every 50 steps
    jacobians = now;
  }
  ASSERT_TRUE(integrator.outcome());
  EXPECT_GT(jacobians, 5U);
  EXPECT_GE(stretches, 2U);
}

TEST(Switching, ACopyGoesOnToTheSameBits) {
  promises::expect_copy_goes_on_to_the_same_bits<Pair>(testing::any_system(bench::VanDerPol<>{}),
                                                       bench::VanDerPol<>::start(), 2000);
}

TEST(Switching, DenseOutputMeetsTheToleranceAcrossTheChange) {
  const testing::AnySystem<Two> f{.f = [](double t, const Two& x, Two& out) {
    for (std::size_t i = 0; i < 2; ++i) out[i] = -1000 * (x[i] - std::cos(t)) - std::sin(t);
  }};
  for (const double tolerance : {1e-4, 1e-7})
    EXPECT_LT(promises::dense_error_in_tolerances<Pair>(f, 3, tolerance, [](double t) { return std::cos(t); }), 30);
}

TEST(Switching, SolvesAlgebraicEquationsByTheStiffMethodAlone) {
  EXPECT_LT(promises::error_of_algebraic_decay<Pair>(1e-6), 30);
}

// With a strict tolerance an explicit method of high order takes steps well inside its region of stability, and is
// still limited by stiffness: dop853 alone takes more than 10,000 steps here.
TEST(Switching, HandsOverWhereAStrictToleranceKeepsStepsOffTheBoundary) {
  const auto pair = promises::solved_by_name<Dop853Radau, bench::Oregonator<>>(1e-11, 1e-17),
             stiff = promises::solved_by_name<Radau, bench::Oregonator<>>(1e-11, 1e-17);
  ASSERT_TRUE(pair.outcome);
  EXPECT_LT(pair.statistics.steps, 3 * stiff.statistics.steps);
}

// A spring of frequency 1e4 that follows cos t: three steps in its period of 2 pi / 1e4 are the fewest for a Nystrom
// method, which would make some 100,000 to t = 30.
TEST(Switching, ASpringThatCouldOscillateAndDoesNotIsStiff) {
  const auto spring =
      second_order([](double t, const std::array<double, 1>& q) { return std::array{-1e8 * (q[0] - std::cos(t))}; });
  const std::array start{1 / (1 - 1e-8), 0.0};
  for (const double tolerance : {1e-4, 1e-8}) {
    const auto solution = solve(spring, start, {0.0, 30.0}, {.rtol = tolerance, .atol = tolerance});
    ASSERT_TRUE(solution.outcome);
    // At the strict tolerance the first steps excite an oscillation above the tolerance, which is resolved until it has
    // decayed.
    EXPECT_LT(solution.statistics.steps, tolerance > 1e-6 ? 3'000U : 20'000U) << tolerance;
    EXPECT_GT(solution.statistics.factorizations, 0U);
    EXPECT_NEAR(solution.final_state()[0], std::cos(30.0) / (1 - 1e-8), 30 * tolerance);
  }
}

// A spring that oscillates is not stiff: the stiff half is never used, or a few times to find that it does not help.
TEST(Switching, AnOscillationStaysWithTheNystromMethod) {
  const auto spring = studies::named_motion<double>(
      2, [](double, std::span<const double> x, std::span<double> dxdt) { dxdt[0] = x[1], dxdt[1] = -1e8 * x[0]; });
  const auto run = [&](auto method) {
    return studies::named_solve<double>(method.name, spring, {1, 0}, {0.0, 1.0}, {.rtol = 1e-8, .atol = 1e-8});
  };
  const auto pair = run(DormandPrinceNystrom12Radau{}), alone = run(DormandPrinceNystrom12{});
  ASSERT_TRUE(pair.outcome);
  EXPECT_EQ(pair.statistics.factorizations, 0U);
  // Over 1592 periods errors add up: those of the pair are a hundredth, which a step of order 12 pays with a factor of
  // 100^(1/13) = 1.4.
  EXPECT_LT(pair.statistics.evaluations, 2 * alone.statistics.evaluations);
  EXPECT_LT(std::abs(pair.final_state()[0] - std::cos(1e4)), std::abs(alone.final_state()[0] - std::cos(1e4)) / 10);
}

}  // namespace
}  // namespace continuo::switching_test
