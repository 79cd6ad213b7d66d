#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/compare.hpp>

namespace continuo::studies::compare_test {
namespace {

constexpr const char* decay = "x' = -x\nx(0) = 1\nrun 0..1 output 0.1\n";

TEST(Compare, ErrorsAreThoseOfTheClosedForm) {  // Euler: x_n = (1 - h)^n; exact: exp(-1); the largest x is 1
  const Comparison comparison = compare(program_of(decay), {.methods = {"euler"}, .steps = {0.1, 0.05}});
  ASSERT_EQ(comparison.contenders.size(), 2u);
  EXPECT_NEAR(comparison.contenders[0].final_error, std::exp(-1) - std::pow(0.9, 10), 1e-11);
  EXPECT_NEAR(comparison.contenders[1].final_error, std::exp(-1) - std::pow(0.95, 20), 1e-11);
  EXPECT_GE(comparison.contenders[0].largest_error, comparison.contenders[0].final_error);
  EXPECT_EQ(comparison.contenders[0].errors.size(), 11u);
}

TEST(Compare, HalfTheStepShowsTheOrder) {  // global error C h^4: a ratio of 16, less terms of the next order
  const Comparison comparison = compare(program_of(decay), {.methods = {"rk4"}, .steps = {0.1, 0.05}});
  EXPECT_NEAR(comparison.contenders[0].final_error / comparison.contenders[1].final_error, 16, 1.5);
}

TEST(Compare, TolerancesAndTheModelsOwnSettingsCompareToo) {
  const auto program = program_of(decay);
  const Comparison loose = compare(program, {.methods = {"dop853", "tsitouras5"}, .tolerances = {1e-4, 1e-8}});
  ASSERT_EQ(loose.contenders.size(), 4u);
  EXPECT_EQ(loose.contenders[1].label(), "dop853, tol = 1e-08");
  EXPECT_EQ(compare(program, {.methods = {"dop853"}}).contenders.size(), 1u);
}

TEST(Compare, RowsWithoutAnOutputStandAtTheSameTimesForAll) {
  const Comparison comparison =
      compare(program_of("x' = -x\nx(0) = 1\nrun 0..1\n"), {.methods = {"rk4"}, .steps = {0.03}});
  EXPECT_GT(comparison.contenders[0].errors.size(), 400u);
}

TEST(Compare, AMethodThatIsNoneIsToldAndTheOthersStand) {
  const Comparison comparison = compare(program_of(decay), {.methods = {"rk5", "rk4"}, .steps = {0.1}});
  ASSERT_EQ(comparison.contenders.size(), 2u);
  EXPECT_FALSE(comparison.contenders[0].simulated.run);
  EXPECT_TRUE(std::isnan(comparison.contenders[0].final_error));
  EXPECT_TRUE(comparison.contenders[1].simulated.run);
}

// A box on a slack rope is damped by v' = -v, of which each substep h, a fourth of the step, leaves 1 / (1 + h): it
// comes to 1 - (1 + h)^(-t / h). The reference has steps of a sixteenth; the largest place is its own.
TEST(Compare, WhatOnlyTheFastMotionMovesIsComparedWithSmallerSteps) {
  const Comparison comparison = compare(program_of("world { gravity (0, 0)\n mode fast step 1/60\n"
                                                   " body crate at (0, 0) velocity (1, 0) box (1, 1) damping 1\n"
                                                   " rope crate to (0, 20) length 100 }\nrun 0..1\n"),
                                        {.methods = {"fast"}, .steps = {0.04}});
  ASSERT_EQ(comparison.contenders.size(), 1U);
  const auto place = [](double h) { return 1 - std::pow(1 + h, -1 / h); };
  EXPECT_NEAR(comparison.contenders[0].final_error, (place(0.01 / 16) - place(0.01)) / place(0.01 / 16), 1e-4);
}

// Stiff: -1e6 lets a pair take 300,000 steps and more, and a pair cannot solve `0 = ...` at all. x = cos t solves both.
TEST(Compare, StiffMethodsAndAlgebraicEquationsAreComparedWithAStiffReference) {
  const auto stiff = program_of("x' = -1e6*(x - cos(t)) - sin(t)\nx(0) = 1\nrun 0..1 output 0.1\n");
  const Comparison comparison = compare(stiff, {.methods = {"dop853", "bdf"}, .tolerances = {1e-6}});
  ASSERT_EQ(comparison.contenders.size(), 2u);
  EXPECT_LT(comparison.reference.run->statistics.steps, 3000u);
  EXPECT_LT(comparison.contenders[1].largest_error, 30e-6);

  const auto algebraic = program_of("unknown s = 0\nx' = s\n0 = s + sin(t)\nx(0) = 1\nrun 0..1 output 0.1\n");
  EXPECT_LT(compare(algebraic, {.methods = {"bdf"}, .tolerances = {1e-6}}).contenders.at(0).largest_error, 30e-6);
}

TEST(Compare, WithoutAReferenceThereAreNoContenders) {  // x = 1/(1 - t) does not reach t = 2
  const Comparison comparison =
      compare(program_of("x' = x^2\nx(0) = 1\nrun 0..2\n"), {.methods = {"rk4"}, .steps = {0.1}});
  EXPECT_TRUE(comparison.contenders.empty());
  EXPECT_FALSE(comparison.reference.diagnostics.empty());
}

}  // namespace
}  // namespace continuo::studies::compare_test
