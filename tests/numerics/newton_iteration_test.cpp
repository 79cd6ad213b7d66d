// Newton's iteration ends where it has converged, and reports how it ended elsewhere.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/newton_iteration.hpp>

namespace continuo {
namespace {

TEST(NewtonIteration, EndsBehindTheCorrectionAfterWhichNoneIsNeeded) {
  double z = 1;
  const auto correct = [&]() -> NewtonCorrection {
    const double step = (z * z - 2) / (2 * z);
    z -= step;
    return std::abs(step);
  };
  const NewtonOutcome outcome = newton_iteration({.most_iterations = 20, .solved_to = 1e-9}, correct);
  EXPECT_TRUE(outcome);
  EXPECT_EQ(outcome.iterations, 5u);  // corrections of 0.5, 0.08, 2e-3, 2e-6, 2e-12
  EXPECT_NEAR(z, std::sqrt(2.0), 1e-15);
}

// Corrections that no longer decrease count as convergence below the level of rounding, and as failure above it.
TEST(NewtonIteration, TakesWhatRoundingLeavesAsConverged) {
  for (const double noise : {1e-7, 1e-5}) {
    double size = 1;
    const auto correct = [&]() -> NewtonCorrection { return size = std::max(size / 100, noise); };
    const auto outcome = newton_iteration({.solved_to = 1e-9, .rounding = 1e-6, .each_is_smaller = true}, correct);
    EXPECT_EQ(outcome.ending, noise < 1e-6 ? NewtonEnding::converged : NewtonEnding::too_many);
  }
}

TEST(NewtonIteration, SaysWhyItFails) {
  const auto ending_of = [](const NewtonLimits& limits, double factor, double first) {
    double size = first;
    const auto correct = [&]() -> NewtonCorrection { return size *= factor; };
    return newton_iteration(limits, correct).ending;
  };
  EXPECT_EQ(ending_of({.farthest = 10}, 1, 11), NewtonEnding::diverged);
  EXPECT_EQ(ending_of({.farthest = 10}, 1, std::nan("")), NewtonEnding::diverged);
  EXPECT_EQ(ending_of({.each_is_smaller = true}, 2, 1), NewtonEnding::diverged);
  EXPECT_EQ(ending_of({.most_iterations = 3}, 1, 1), NewtonEnding::too_many);
  const auto none = []() -> NewtonCorrection { return NewtonEnding::singular; };
  EXPECT_EQ(newton_iteration({}, none).ending, NewtonEnding::singular);
  const auto fine = []() -> NewtonCorrection { return 0.5; };
  EXPECT_EQ(newton_iteration({}, fine, [] { return false; }).ending, NewtonEnding::diverged);
}

// The arc tangent, from a start at which full Newton steps diverge.
TEST(DampedNewton, ComesFromWhereFullStepsDiverge) {
  double z = 3, step = 0;
  const auto correct = [&]() -> NewtonCorrection {
    step = -std::atan(z) * (1 + z * z);
    return std::abs(step);
  };
  const auto attempt = [&](double part, double size) {
    if (!(std::abs(std::atan(z + part * step)) < std::abs(std::atan(z)))) return NewtonAttempt::refused;
    z += part * step;
    return size < 1e-6 ? NewtonAttempt::solved : NewtonAttempt::taken;
  };
  EXPECT_TRUE(damped_newton({}, correct, attempt));
  EXPECT_NEAR(z, 0, 1e-15);
}

TEST(DampedNewton, HalvesItsStepsDownToTheLeastAndRecovers) {
  std::vector<double> parts;
  const auto correct = [&]() -> NewtonCorrection { return 1.0; };
  const auto refuse = [&](double part, double) {
    parts.push_back(part);
    return NewtonAttempt::refused;
  };
  EXPECT_EQ(damped_newton({.least_damping = 0.25}, correct, refuse).ending, NewtonEnding::no_descent);
  EXPECT_EQ(parts, (std::vector{1.0, 0.5, 0.25}));
  parts.clear();
  const auto take_eighths = [&](double part, double) {
    parts.push_back(part);
    return part > 0.125 ? NewtonAttempt::refused : NewtonAttempt::taken;
  };
  const auto outcome = damped_newton({.most_iterations = 2, .recovery = 4}, correct, take_eighths);
  EXPECT_EQ(outcome.ending, NewtonEnding::too_many);
  EXPECT_EQ(parts, (std::vector{1.0, 0.5, 0.25, 0.125, 0.5, 0.25, 0.125}));
}

}  // namespace
}  // namespace continuo
