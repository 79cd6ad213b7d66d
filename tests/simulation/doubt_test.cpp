// The doubts that a run reports: that its motion amplifies errors, and that it is at a jump of its equations.
#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model {
namespace {

using testing::HasSubstr;

Simulated run(const std::string& text, const Experiment& experiment) {
  const Loaded loaded = load(Source("doubt.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return loaded ? simulate(*loaded.model, experiment) : Simulated{};
}

// x' = r (x - cos(w t)) - w sin(w t) has the solution cos(w t), and amplifies errors by exp(r t). The second run has
// less than half of the error of the first, so the reported error is right within a factor of two.
TEST(Doubt, IsSaidWhereErrorsHaveGrownBeyondThirtyTolerances) {
  std::mt19937 random(1);
  int silent = 0, said = 0;
  for (int k = 0; k < 300; ++k) {
    const double rate = std::uniform_real_distribution(-2.0, 10.0)(random);
    const double w = std::uniform_real_distribution(0.5, 5.0)(random);
    const double end = std::uniform_real_distribution(1.0, 4.0)(random);
    const double tolerance = std::pow(10.0, -std::uniform_real_distribution(3.0, 9.0)(random));
    const std::string text =
        fmt::format("x' = {0}*(x - cos({1}*t)) - {1}*sin({1}*t)\nx(0) = 1\nrun 0..{2}\n", rate, w, end);
    const Simulated simulated = run(text, {.rtol = tolerance, .atol = {tolerance}, .doubts = true});
    ASSERT_TRUE(simulated.run);
    ASSERT_EQ(simulated.run->outcome.ending, Ending::reached_end) << text;
    const double expected = std::cos(w * simulated.run->final_time());
    const double off = std::abs(simulated.run->final_state()[0] - expected) / (tolerance * (1 + std::abs(expected)));
    const bool doubted = simulated.run->outcome.hint.find("compared with a run") != std::string::npos;
    if (off > 60 || off < 15) {
      EXPECT_EQ(doubted, off > 60) << off << "\n" << text;
    }
    ++(doubted ? said : silent);
  }
  EXPECT_GT(silent, 30);
  EXPECT_GT(said, 30);
}

// Rounding of x shakes v by 1e8 times as much: part of the error is in every run, however strict.
TEST(Doubt, IsSaidWhereStricterRunsShareTheRoundingOfHugeNumbers) {
  const Simulated simulated = run("x' = v - 0.01*x\nv' = -1e8*(x - cos(t))\nx(0) = 1; v(0) = 0.01\nrun 0..10\n",
                                  {.rtol = 1e-10, .atol = {1e-10}, .doubts = true});
  ASSERT_TRUE(simulated.run);
  ASSERT_EQ(simulated.run->outcome.ending, Ending::reached_end);
  EXPECT_THAT(simulated.run->outcome.hint, HasSubstr("compared with a run"));
  // The closed form, by the matrix exponential in forty digits.
  EXPECT_GT(std::abs(simulated.run->final_state()[1] - 0.5356338015926568), 30 * 1.5e-10);
}

TEST(Doubt, IsNotAskedForUnlessWanted) {
  const Simulated simulated = run("x' = 5*(x - cos(t)) - sin(t)\nx(0) = 1\nrun 0..5 tol 1e-6\n", {});
  ASSERT_TRUE(simulated.run);
  EXPECT_EQ(simulated.run->outcome.hint, "");
}

std::string failure_of(const std::string& text, std::size_t most_steps) {
  const Simulated simulated = run(text, {.max_steps = most_steps});
  return render(simulated.diagnostics, Source("doubt.sim", text));
}

TEST(HeldAtAJump, NamesTheJumpAndTheEquation) {
  EXPECT_THAT(failure_of("x' = smooth(if x > 1 then -1 else 1)\nx(0) = 0\nrun 0..3 tol 1e-10\n", 20'000),
              HasSubstr("the equation of `x'` jumps with `1 < x`"));
  EXPECT_THAT(
      failure_of("unknown w = 0\nu' = 1\n0 = w^3 + w - (if w > 0.2 then -u else u)\nu(0) = 0\nrun 0..3\n", 20'000),
      HasSubstr("the equation of `w` jumps with `0.2 < w`"));
  EXPECT_THAT(failure_of("y' = 1\nx' = smooth(0.5 - mod(x - y, 1)) + smooth(sign(0.3 - x))\n"
                         "x(0) = 0;  y(0) = 0\nrun 0..30 tol 1e-10\n",
                         20'000),
              HasSubstr("slides along it"));
}

TEST(HeldAtAJump, IsNotSaidOfOthers) {
  const std::string said = failure_of("x' = (if x > -5 then 1 else 2)*x^2\nx(0) = 1\nrun 0..3 tol 1e-10\n", 20'000);
  EXPECT_THAT(said, HasSubstr("error"));
  EXPECT_THAT(said, testing::Not(HasSubstr("slides")));
}

}  // namespace
}  // namespace continuo::model
