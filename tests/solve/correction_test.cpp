// Projections onto invariants and corrections of the state: what they keep, what they cost, and what becomes of the
// history of a method. The references are closed forms.
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

namespace continuo::correction_test {
namespace {

using solve_test::V, solve_test::AnyDerivative;

constexpr AnyDerivative oscillator{[](double, const V& x, V& dxdt) {
  dxdt[0] = x[1];
  dxdt[1] = -x[0];
}};
void onto_circle(double, V& x) {
  const double r = std::hypot(x[0], x[1]);
  x[0] /= r;
  x[1] /= r;
}

template <class M>
class Projected : public testing::Test {};
using Methods = testing::Types<Adams, Bdf>;
TYPED_TEST_SUITE(Projected, Methods);

TYPED_TEST(Projected, AProjectionThatMovesNothingCostsNothingAndChangesNoBit) {
  const auto plain = solve(oscillator, V{1, 0}, {0, 20}, TypeParam{}, {.rtol = 1e-7});
  const auto same = solve(oscillator, V{1, 0}, {0, 20}, TypeParam{}, {.rtol = 1e-7, .projection = [](double, V&) {}});
  EXPECT_EQ(plain.statistics.evaluations, same.statistics.evaluations);
  EXPECT_EQ(plain.x, same.x);
}

// What is projected keeps its history: beginning anew at each step would take some six times the evaluations.
TYPED_TEST(Projected, StatesLieOnTheInvariantAndTheHistoryIsKept) {
  const Options<V> options{.rtol = 1e-7, .atol = 1e-9, .save = save_every(0.37)};
  Options<V> with = options;
  with.projection = onto_circle;
  const auto plain = solve(oscillator, V{1, 0}, {0, 100}, TypeParam{}, options);
  const auto projected = solve(oscillator, V{1, 0}, {0, 100}, TypeParam{}, with);
  ASSERT_TRUE(projected.outcome) << describe(projected.outcome);
  EXPECT_LT(static_cast<double>(projected.statistics.evaluations),
            1.25 * static_cast<double>(plain.statistics.evaluations));
  for (std::size_t i = 0; i < projected.t.size(); ++i) {
    EXPECT_NEAR(std::hypot(projected.x[i][0], projected.x[i][1]), 1, 4e-16);
    EXPECT_NEAR(projected.x[i][0], std::cos(projected.t[i]), 1e-4);
  }
}

// Every polynomial ends where the step was moved to, so that the next one begins there.
TYPED_TEST(Projected, DenseOutputIsContinuous) {
  const auto solution = solve(oscillator, V{1, 0}, {0, 20}, TypeParam{},
                              {.rtol = 1e-4, .atol = 1e-4, .save = save_dense(), .projection = onto_circle});
  ASSERT_TRUE(solution.outcome);
  V end{0, 0};
  double farthest = 0;
  for (std::size_t k = 0; k < solution.segments.size(); ++k) {
    solution.segments[k](solution.segments[k].end, end);
    EXPECT_NEAR(std::hypot(end[0], end[1]), 1, 1e-14);
    EXPECT_NEAR(end[0], solution.x[k + 1][0], 1e-14);
    EXPECT_EQ(solution.segments[k].coefficients[0], solution.x[k]);
    for (const double t : {0.25, 0.5, 0.75}) {
      const auto& segment = solution.segments[k];
      segment(segment.begin + t * (segment.end - segment.begin), end);
      farthest = std::max(farthest, std::abs(std::hypot(end[0], end[1]) - 1));
    }
  }
  EXPECT_LT(farthest, 1e-2);
  EXPECT_GT(farthest, 1e-12) << "within a step the polynomial is not projected";
}

// A state set to what it is costs nothing. Set to its projection, it is a correction, and the history stays.
TYPED_TEST(Projected, SettingTheSameOrNearlyTheSameStateKeepsTheHistory) {
  const Options<V> options{.rtol = 1e-7, .atol = 1e-9};
  const auto plain = solve(oscillator, V{1, 0}, {0, 20}, TypeParam{}, options);
  Integrator same(oscillator, V{1, 0}, {0, 20}, TypeParam{}, options);
  while (same.advance()) same.set_state(V(same.x()));
  EXPECT_EQ(same.x(), plain.final_state());
  EXPECT_EQ(same.statistics().evaluations, plain.statistics.evaluations);

  Integrator corrected(oscillator, V{1, 0}, {0, 20}, TypeParam{}, options);
  V before{0, 0}, after{0, 0};
  while (corrected.advance()) {
    V x = corrected.x();
    onto_circle(0, x);
    const double within = corrected.step_begin() + 0.5 * corrected.step_size();
    corrected.set_state(x);
    corrected.at(within, after);
    EXPECT_NEAR(after[0], std::cos(within), 1e-4);
  }
  EXPECT_LT(static_cast<double>(corrected.statistics().evaluations),
            1.3 * static_cast<double>(plain.statistics.evaluations));
  EXPECT_NEAR(corrected.x()[0], std::cos(20), 1e-4);
}

TYPED_TEST(Projected, AChangeThatIsNotSmallBeginsAnew) {
  Integrator integrator(oscillator, V{1, 0}, {0, 20}, TypeParam{}, {.rtol = 1e-8, .atol = 1e-8});
  while (integrator.t() < 5 && integrator.advance()) continue;
  const double t = integrator.t();
  integrator.set_state({2, 0});
  while (integrator.advance()) continue;
  EXPECT_NEAR(integrator.x()[0], 2 * std::cos(20 - t), 1e-4);
}

// An event between steps is found on the projected states.
TYPED_TEST(Projected, EventsAreExact) {
  const auto solution =
      solve(oscillator, V{1, 0}, {0, 30}, TypeParam{},
            {.rtol = 1e-9,
             .atol = 1e-10,
             .events = {falls("half", [](double, const V& x) { return x[0] - 0.5; }),
                        falls(
                            "turn", [](double, const V& x) { return x[0]; }, [](auto& now) { now.x[1] = 1; })},
             .projection = onto_circle});
  ASSERT_TRUE(solution.outcome);
  // Turned round at x = 0: from there it goes up, over a half turn to 0 again.
  ASSERT_EQ(solution.events.size(), 20U);
  const double pi = std::acos(-1.0);
  for (std::size_t k = 0; k < solution.events.size(); ++k) {
    const double turns = static_cast<double>(k / 2);
    const double t = k % 2 == 0 ? pi * turns + pi / 3 : pi * turns + pi / 2;
    EXPECT_NEAR(solution.events[k].t, t, 1e-6) << k;
    EXPECT_NEAR(std::hypot(solution.events[k].before[0], solution.events[k].before[1]), 1, 4e-16);
  }
}

// The action of a scheduled event that is a correction keeps the history, and only where it says so.
TYPED_TEST(Projected, TheCorrectionOfAnActionKeepsTheHistory) {
  const auto evaluations = [](bool moves, bool correction) {
    const auto action = [=](auto& now) {
      if (moves) now.x[0] *= 1 + 1e-10;
      now.correction = correction;
    };
    const auto solution =
        solve(oscillator, V{1, 0}, {0, 20}, TypeParam{}, {.rtol = 1e-7, .events = {every("tick", 1, 0, action)}});
    EXPECT_NEAR(solution.final_state()[0], std::cos(20), 1e-4);
    return static_cast<double>(solution.statistics.evaluations);
  };
  const double still = evaluations(false, false);
  EXPECT_GT(evaluations(true, false), 1.5 * still);
  EXPECT_LT(evaluations(true, true), 1.5 * still);
}

// Random quadratic invariants x^T S x of x' = A x with A = B S, B skew, S positive definite: d/dt (x^T S x) = 2 x^T S B
// S x = 0. The projection scales x. The reference is a run at a strict tolerance.
constexpr std::size_t size = 4;
std::array<double, size> weight;
std::array<double, size * size> skew;
constexpr AnyDerivative quadratic{[](double, const V& x, V& dxdt) {
  for (std::size_t i = 0; i < size; ++i) {
    dxdt[i] = 0;
    for (std::size_t j = 0; j < size; ++j) dxdt[i] += skew[i * size + j] * weight[j] * x[j];
  }
}};
double invariant(const V& x) {
  double sum = 0;
  for (std::size_t i = 0; i < size; ++i) sum += weight[i] * x[i] * x[i];
  return sum;
}

TYPED_TEST(Projected, RandomQuadraticInvariants) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int which = 0; which < 10; ++which) {
    for (double& w : weight) w = 1 + 0.9 * unit(random);
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = i; j < size; ++j) {
        skew[i * size + j] = i == j ? 0 : 2 * unit(random);
        skew[j * size + i] = -skew[i * size + j];
      }
    V start(size);
    for (double& each : start) each = unit(random);
    const double value = invariant(start);
    const auto scaled = [value](double, V& x) {
      const double factor = std::sqrt(value / invariant(x));
      for (double& each : x) each *= factor;
    };
    const auto exact = solve(quadratic, start, {0, 10}, Adams{}, {.rtol = 1e-12, .atol = 1e-13});
    const auto solution =
        solve(quadratic, start, {0, 10}, TypeParam{}, {.rtol = 1e-6, .atol = 1e-8, .projection = scaled});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    for (const V& x : solution.x) EXPECT_NEAR(invariant(x), value, 1e-14);
    for (std::size_t i = 0; i < size; ++i) EXPECT_NEAR(solution.final_state()[i], exact.final_state()[i], 2e-4);
  }
}

// The pendulum of SUNDIALS' cvPendulum, in Cartesian coordinates with the force of the rod: with this g its period is
// 2, so that at t = 30 it is where it began. Positions go to the circle, velocities along it.
constexpr double g = 13.750371636040745654980191559621;
constexpr AnyDerivative pendulum{[](double, const V& x, V& dxdt) {
  const double force = x[2] * x[2] + x[3] * x[3] - g * x[1];
  dxdt[0] = x[2];
  dxdt[1] = x[3];
  dxdt[2] = -x[0] * force;
  dxdt[3] = -x[1] * force - g;
}};
void onto_rod(double, V& x) {
  onto_circle(0, x);
  const double along_rod = x[0] * x[2] + x[1] * x[3];
  for (std::size_t i = 0; i < 2; ++i) x[2 + i] -= along_rod * x[i];
}

TYPED_TEST(Projected, ThePendulumReturnsAfterFifteenPeriods) {
  const auto run = [](double rtol, bool projected) {
    Options<V> options{.rtol = rtol, .atol = rtol};
    if (projected) options.projection = onto_rod;
    const auto solution = solve(pendulum, V{1, 0, 0, 0}, {0, 30}, TypeParam{}, options);
    EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
    double beside = 0;
    for (const V& x : solution.x)
      beside = std::max({beside, std::abs(std::hypot(x[0], x[1]) - 1), std::abs(x[0] * x[2] + x[1] * x[3])});
    const V& x = solution.final_state();
    return std::pair(std::hypot(x[0] - 1, x[1], x[2]) + std::abs(x[3]), beside);
  };
  double last = 1;
  for (const double rtol : {1e-6, 1e-8, 1e-10}) {
    const auto [error, beside] = run(rtol, true);
    const auto [free_error, free_beside] = run(rtol, false);
    EXPECT_LT(beside, 2e-15);
    EXPECT_GT(free_beside, 1e-12);
    EXPECT_LT(error, 2e4 * rtol);
    EXPECT_LT(error, last);
    EXPECT_LT(error, free_error);
    last = error;
  }
}

TEST(Correction, WhatCannotBeProjectedIsRefused) {
  const auto ending = [](V start, Options<V> options) {
    return solve(oscillator, std::move(start), {0, 20}, Adams{}, std::move(options)).outcome;
  };
  const auto off = ending({1.1, 0}, {.projection = onto_circle});
  EXPECT_EQ(off.ending, Ending::invalid_input);
  EXPECT_NE(off.hint.find("not on the invariants"), std::string::npos) << off.hint;
  const auto both = ending({1, 0}, {.projection = onto_circle, .signs = {Sign::any, Sign::any}});
  EXPECT_EQ(both.ending, Ending::invalid_input);
  const auto resized = ending({1, 0}, {.projection = [](double, V& x) { x.push_back(0); }});
  EXPECT_NE(resized.hint.find("number of components"), std::string::npos) << resized.hint;
  const auto none = ending({1, 0}, {.projection = [](double t, V&) { return t < 5; }});
  EXPECT_EQ(none.ending, Ending::step_too_small) << describe(none);
  EXPECT_NEAR(none.t, 5, 1e-9);
  EXPECT_NE(none.hint.find("finds no state"), std::string::npos) << none.hint;
  // A circle that shrinks is no invariant.
  const auto far = ending({1, 0}, {.projection = [](double t, V& x) {
                            onto_circle(t, x);
                            if (t > 5) x[0] *= 0.9, x[1] *= 0.9;
                          }});
  EXPECT_FALSE(far);
  EXPECT_NEAR(far.t, 5, 1e-6);
  EXPECT_NE(far.hint.find("by more than the tolerance"), std::string::npos) << far.hint;
}

}  // namespace
}  // namespace continuo::correction_test
