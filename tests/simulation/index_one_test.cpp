// Unknowns of algebraic equations, by every method that claims them: at any tolerance, at any time, after jumps, and
// between the steps.
#include <cmath>
#include <limits>
#include <string>

#include <bench/choice/residual.hpp>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace continuo::model {
namespace {

Simulated run(const std::string& text, std::string_view method, double tolerance) {
  const Loaded loaded = load(Source("index_one.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return loaded ? simulate(*loaded.model, {.method = std::string(method),
                                           .rtol = tolerance,
                                           .atol = {tolerance},
                                           .max_steps = 300'000,
                                           .keep_rows = false})
                : Simulated{};
}

void expect_reached(const Simulated& simulated, const std::string& what) {
  ASSERT_TRUE(simulated.run) << what;
  ASSERT_EQ(simulated.run->outcome.ending, Ending::reached_end) << what << ": " << describe(simulated.run->outcome);
}

// z = sin(50 t), a solution of 0 = z + z^3 - s - s^3, is known no better than t: to 50 spacings of the numbers there.
TEST(IndexOne, AnUnknownFollowsTimeToTheLastDigits) {
  constexpr double rate = 50, length = 0.5;
  for (const auto& method : bench::algebraic_methods()) {
    for (const double from : {0.0, 1e3, 1e6}) {
      for (const double tolerance : {1e-6, 1e-10, 1e-12, 1e-13}) {
        if (method.order < 4 && tolerance < 1e-6) continue;  // of low order: millions of steps
        if (method.order == 1) continue;
        const std::string what = fmt::format("{} from {} at {}", method.name, from, tolerance);
        const Simulated simulated = run(fmt::format("unknown z = 0\nlet s = sin({}*t)\n0 = z + z^3 - s - s^3\n"
                                                    "x' = 5*(z - x)\nx({}) = 0\nrun {}..{} [s]\n",
                                                    rate, from, from, from + length),
                                        method.name, tolerance);
        expect_reached(simulated, what);
        const double expected = std::sin(rate * (from + length));
        const double spacing = std::numeric_limits<double>::epsilon() * (from + length);
        EXPECT_NEAR(simulated.run->final_state()[1], expected,
                    10 * tolerance * (1 + std::abs(expected)) + rate * spacing)
            << what;
      }
    }
  }
}

// Each jump of p starts a transient of 1e-4 s, on which two unknowns depend: x = p + (x0 - p) exp(-r t), with the
// unknowns y = (x + p)/2 and z = y - z^3.
TEST(IndexOne, UnknownsFollowATransientAfterEachJump) {
  const std::string text = R"(unknown y = 0
unknown z = 0
p' = 0
x' = 1e4*(2*p - 2*y)
0 = x + p - 2*y
0 = y - z - z^3
p(0) = 1; x(0) = 0
at 0.2 { p := -1 }
at 0.5 { x := 3 }
at 0.9996 { p := 2 }
run 0..1 [s]
)";
  const double at_end = 2 - 3 * std::exp(-4.0);  // 4e-4 s after the last jump
  for (const auto& method : bench::algebraic_methods()) {
    for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
      if (method.order < 4 && tolerance < 1e-8) continue;
      if (method.order == 1 && tolerance < 1e-4) continue;
      const std::string what = fmt::format("{} at {}", method.name, tolerance);
      const Simulated simulated = run(text, method.name, tolerance);
      expect_reached(simulated, what);
      const auto x = simulated.run->final_state();
      EXPECT_NEAR(x[1], at_end, 30 * tolerance * 3) << what;
      EXPECT_NEAR(x[2], (at_end + 2) / 2, 30 * tolerance * 3) << what;
      EXPECT_NEAR(x[3] + x[3] * x[3] * x[3], x[2], 10 * tolerance * (1 + 3 * x[3] * x[3])) << what;
    }
  }
}

// Among them is a diode whose unknown a step of backward differentiation once accepted 1.5 V beyond the voltage at
// which it conducts.
TEST(IndexOne, UnknownsAreSolvedForBetweenSteps) {
  for (const auto& problem : bench::choice_problems()) {
    if (problem.kind != "dae") continue;
    const Loaded loaded = bench::load_with_residuals(problem);
    ASSERT_TRUE(loaded) << loaded.text();
    for (const auto& method : bench::algebraic_methods()) {
      for (const double tolerance : {1e-3, 1e-5, 1e-10}) {
        if (tolerance < (method.order < 2 ? 1e-3 : method.order < 4 ? 1e-5 : 1e-10)) continue;
        // A tolerance above the second concentration lets it become negative, and Robertson's reaction explode.
        if (problem.name == "Robertson, mass conserved" && tolerance > 1e-5) continue;
        const auto largest = bench::largest_residual(*loaded.model, problem.duration, method.name, tolerance);
        ASSERT_TRUE(largest) << problem.name << ' ' << method.name << ' ' << tolerance;
        EXPECT_LT(*largest, 10) << problem.name << ' ' << method.name << ' ' << tolerance;
      }
    }
  }
}

TEST(IndexOne, UnknownsAreSolvedForAtTheEndsOfSteps) {
  for (const auto& problem : bench::choice_problems()) {
    if (problem.kind != "dae") continue;
    const Loaded loaded = bench::load_with_residuals(problem);
    ASSERT_TRUE(loaded) << loaded.text();
    for (const auto& method : bench::algebraic_methods()) {
      const double tolerance = method.order < 2 ? 1e-3 : 1e-5;
      if (problem.name == "Robertson, mass conserved" && tolerance > 1e-5) continue;
      const auto largest = bench::largest_residual(
          *loaded.model,
          {.method = std::string(method.name), .rtol = tolerance, .atol = {tolerance}, .output_steps = true});
      ASSERT_TRUE(largest) << problem.name << ' ' << method.name;
      EXPECT_LT(*largest, 10 * tolerance) << problem.name << ' ' << method.name;
    }
  }
}

// They have no estimate of their error, and steps of a size that is named.
TEST(IndexOne, UnknownsAreSolvedForByMethodsOfFixedStepsToo) {
  for (const auto& problem : bench::choice_problems()) {
    if (problem.kind != "dae") continue;
    const Loaded loaded = bench::load_with_residuals(problem);
    ASSERT_TRUE(loaded) << loaded.text();
    for (const MethodInfo& method : method_catalogue()) {
      if (!method.implicit || method.second_order || method.error_order > 0) continue;
      const auto largest = bench::largest_residual(
          *loaded.model, {.method = std::string(method.name), .step = problem.duration / 4000, .output_steps = true});
      if (!largest) continue;
      EXPECT_LT(*largest, 1e-5) << problem.name << ' ' << method.name;
    }
  }
}

}  // namespace
}  // namespace continuo::model
