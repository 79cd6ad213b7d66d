// Runs by the default method are accurate: equations with unknowns, fast oscillations, pulses of an input (bench/choice
// has the whole table). Also index-1 systems by every method that claims to solve them.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <bench/choice/problems.hpp>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::model {
namespace {

constexpr double most_tolerances = 30;  // allowed everywhere in this suite

/// The greatest error of a state at the end, in units of the tolerance.
void expect_right(const bench::ChoiceProblem& problem, double tolerance, const std::string& method) {
  const std::string what = fmt::format("{} by '{}' at {}", problem.name, method, tolerance);
  const Loaded loaded = load(Source("problem.sim", fmt::format("{}\nrun 0..{} [s]\n", problem.text, problem.duration)));
  ASSERT_TRUE(loaded) << what << loaded.text();
  Experiment experiment{.rtol = tolerance, .atol = {tolerance}, .keep_rows = false};
  if (!method.empty()) experiment.method = method;
  const Simulated simulated = simulate(*loaded.model, experiment);
  ASSERT_TRUE(simulated.run) << what;
  ASSERT_EQ(simulated.run->outcome.ending, Ending::reached_end) << what << ": " << simulated.run->outcome.hint;
  for (const auto& [name, expected] : problem.end) {
    const auto state = std::ranges::find(loaded.model->states, name, &State::column);
    ASSERT_NE(state, loaded.model->states.end()) << what << ": " << name;
    const double value = simulated.run->final_state()[static_cast<std::size_t>(state - loaded.model->states.begin())];
    EXPECT_LT(std::abs(value - expected) / (tolerance * (1 + std::abs(expected))), most_tolerances)
        << what << ' ' << name;
  }
}

void expect_right_of_kind(std::string_view kind) {
  std::size_t tried = 0;
  for (const auto& problem : bench::choice_problems()) {
    if (problem.kind != kind) continue;
    ++tried;
    for (const double tolerance : {1e-3, 1e-5}) expect_right(problem, tolerance, "");
    if (kind != "oscillator") expect_right(problem, 1e-8, "");  // which takes some seconds
  }
  EXPECT_GT(tried, 2U);
}

// Even if all states are at rest, an unknown may change: the step size must follow it.
TEST(DefaultChoice, KeepsItsToleranceWithUnknowns) {
  expect_right_of_kind("dae");
}

// Errors in an oscillation add up, and a fast oscillation must not be excited where the solution has none.
TEST(DefaultChoice, KeepsItsToleranceOnFastOscillations) {
  expect_right_of_kind("oscillator");
}

// The probe for oscillations perturbs x by more than a strict tolerance, or it would measure only rounding: all
// components by the same number of tolerances, at every phase, or the oscillation is not recognized.
TEST(DefaultChoice, KeepsAStrictToleranceOverAHundredThousand) {
  const bench::ChoiceProblem problem{"harmonic oscillator",
                                     "oscillator",
                                     1e5,
                                     "x' = v\nv' = -x\nx(0) = 1; v(0) = 0",
                                     {{"x", std::cos(1e5)}, {"v", -std::sin(1e5)}}};
  for (const double tolerance : {1e-8, 1e-10}) expect_right(problem, tolerance, "dop853_radau");
}

TEST(DefaultChoice, JumpsOverNoPulseOfTheInput) {
  expect_right_of_kind("pulse");
}

// No later step reduces the residual of an algebraic equation: it must be solved accurately enough, with a matrix
// evaluated nearby.
TEST(IndexOne, IsSolvedByEveryMethodThatClaimsIt) {
  std::size_t methods = 0;
  for (const MethodInfo& method : method_catalogue()) {
    if (!method.implicit || method.automatic || method.second_order || method.error_order < 2)
      continue;  // of order 1: a million steps
    ++methods;
    for (const auto& problem : bench::choice_problems()) {
      // With some methods the solution drifts off the constraints from which the pendulum's equations were
      // differentiated.
      if (problem.kind != "dae" || problem.name == "pendulum, index 1") continue;
      // A tolerance above the second concentration lets it become negative, and Robertson's reaction explode.
      const bool explosive = problem.name == "Robertson, mass conserved";
      for (const double tolerance : {explosive ? 1e-5 : 1e-3, 1e-6})
        if (method.order > 2 || tolerance > 1e-6) expect_right(problem, tolerance, std::string(method.name));
    }
  }
  EXPECT_GE(methods, 10U);
}

}  // namespace
}  // namespace continuo::model
