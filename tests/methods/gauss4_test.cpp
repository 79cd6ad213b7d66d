// Gauss of order 4: order, invariants, and its step control.
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "stiff_promises.hpp"
#include <continuo/methods/collocation/gauss4.hpp>

namespace continuo::gauss4_test {
namespace {

using testing::AnySystem, testing::Two;

/// The pendulum q'' = -sin q, and its energy.
const AnySystem<Two> pendulum{.f = [](double, const Two& x, Two& out) { out = {x[1], -std::sin(x[0])}; }};
double energy(const Two& x) {
  return x[1] * x[1] / 2 - std::cos(x[0]);
}

/// x' = x (1 - x), x(0) = 1/2: x = 1 / (1 + exp(-t)).
struct Logistic {
  template <class X>
  void operator()(const auto&, const X& x, X& out) const {
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = x[i] * (1 - x[i]);
  }
};
template <class Real>
Real logistic(Real t) {
  return 1 / (1 + std::exp(-t));
}

long double error_of_fixed_steps(int n) {
  const long double h = 4.0L / n;
  const auto solution = solve(Logistic{}, std::array{0.5L}, Interval<long double>{0, 4}, Gauss4{},
                              {.rtol = 1e-17L, .atol = 1e-17L, .step = h});
  EXPECT_TRUE(solution.outcome);
  return std::abs(solution.final_state()[0] - logistic(4.0L));
}

TEST(Gauss4, OrderIsFour) {
  EXPECT_NEAR(static_cast<double>(std::log2(error_of_fixed_steps(32) / error_of_fixed_steps(64))), 4, 0.1);
}

TEST(Gauss4, DenseOutputIsOfOrderThree) {
  const auto error = [](long double h) {
    Integrator integrator(Logistic{}, std::array{0.5L}, Interval<long double>{0, 2 * h}, Gauss4{},
                          {.rtol = 1e-17L, .atol = 1e-17L, .step = h});
    integrator.advance();
    integrator.advance();  // the first step is odd about its start, and a polynomial of degree 3 too good
    long double worst = 0;
    std::array<long double, 1> x{};
    for (int i = 0; i <= 20; ++i) {
      const long double theta = static_cast<long double>(i) / 20;
      integrator.interpolant()(theta, x);
      worst = std::max(worst, std::abs(x[0] - logistic(integrator.step_begin() + theta * h)));
    }
    return worst;
  };
  EXPECT_GT(std::log2(error(0.25L) / error(0.125L)), 3.9);
}

// Gauss keeps every quadratic invariant (Hairer, Lubich, Wanner, "Geometric Numerical Integration", theorem IV.2.1): to
// rounding, 2e-16 a step at random, where the equations are solved to it.
TEST(Gauss4, KeepsQuadraticInvariants) {
  const AnySystem<Two> oscillator{.f = [](double, const Two& x, Two& out) { out = {x[1], -x[0]}; }};
  const auto solution =
      solve(oscillator, std::array{1.0, 0.0}, {0.0, 1000.0}, Gauss4{}, {.rtol = 1e-14, .atol = 1e-14, .step = 0.25});
  const auto& x = solution.final_state();
  EXPECT_NEAR(x[0] * x[0] + x[1] * x[1], 1, 4000 * 2e-16);
}

// A symplectic method's energy oscillates and does not drift: its greatest error over the first ten turns bounds that
// over the last ten of a thousand.
TEST(Gauss4, EnergyDoesNotDrift) {
  Integrator integrator(pendulum, Two{2, 0}, {0.0, 8000.0}, Gauss4{}, {.rtol = 1e-13, .atol = 1e-13, .step = 0.2});
  const double start = energy(Two{2, 0});
  double early = 0, late = 0;
  while (integrator.advance()) {
    const double error = std::abs(energy(integrator.x()) - start);
    if (integrator.t() < 80) early = std::max(early, error);
    if (integrator.t() > 7920) late = std::max(late, error);
  }
  ASSERT_TRUE(integrator.outcome());
  EXPECT_LT(late, 1.01 * early);
  EXPECT_LT(early, 1e-4);
}

// A tolerance at which steps are rejected: half a unit of energy, a closed orbit, the tolerance of the suite.
TEST(Gauss4, MeetsItsToleranceWithStepControl) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const auto solution = solve(testing::any_system(Logistic{}), Two{0.5, 0.5}, {0.0, 4.0}, Gauss4{},
                                {.rtol = tolerance, .atol = tolerance});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    EXPECT_LT(std::abs(solution.final_state()[0] - logistic(4.0)), 30 * tolerance);
  }
}

TEST(Gauss4, SolvesAlgebraicEquations) {
  for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
    EXPECT_LT(promises::error_of_algebraic_decay<Gauss4>(tolerance), 30) << tolerance;
  }
}

TEST(Gauss4, ACopyGoesOnToTheSameBits) {
  promises::expect_copy_goes_on_to_the_same_bits<Gauss4>(pendulum, Two{2, 0}, 20.0);
}

}  // namespace
}  // namespace continuo::gauss4_test
