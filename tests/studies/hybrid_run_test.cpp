// Exponents and sections of models with events, against closed forms, and features that other studies ignore.
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/studies/lyapunov.hpp>
#include <continuo/studies/periodic_orbit.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::studies {
namespace {

std::vector<double> exponents_of(const std::string& text, const LyapunovOptions& options) {
  const auto program = program_of(text);
  const LyapunovExponents found = lyapunov_exponents(program, {}, options);
  EXPECT_TRUE(found.outcome) << describe(found.outcome);
  return found.exponents;
}

// S. Ulam, J. von Neumann: of y -> 4 y (1 - y) the exponent is ln 2, with a deviation of 1.8/sqrt(n) of n iterations.
TEST(HybridExponents, OfTheLogisticMapIsLnTwo) {
  const auto found =
      exponents_of("y' = 0\ny(0) = 0.3\nevery 1 { y := 4*y*(1 - y) }\nrun 0..100\n", {.duration = 2000, .settle = 10});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0], std::numbers::ln2, 4 * 1.8 / std::sqrt(2000.0));
}

// x' = a x, with x multiplied by c every T: the exponent is a + ln|c| / T.
TEST(HybridExponents, OfLinearPiecesAndKicksAreThoseOfTheirLogarithms) {
  std::mt19937 random(7);
  for (int k = 0; k < 40; ++k) {
    const double a = std::uniform_real_distribution(-0.5, 0.5)(random);
    const double b = std::uniform_real_distribution(-0.5, 0.5)(random);
    const double c = std::uniform_real_distribution(0.3, 0.9)(random), period = 0.7;
    const std::string text =
        fmt::format("x' = {0}*x\ny' = {1}*y\nx(0) = 1\ny(0) = 1\nevery {3} {{ x := {2}*x; y := -{2}*y }}\nrun 0..10\n",
                    a, b, c, period);
    // 100 periods, of which the last kick may fall on either side of the end; the directions begin with parts of 0.6
    // and 0.8 along the axes, and turn towards them.
    const auto found = exponents_of(text, {.duration = 70, .settle = 5});
    ASSERT_EQ(found.size(), 2u);
    const double kick = std::log(c) / period, error = (-std::log(c) - std::log(0.6)) / 70;
    EXPECT_NEAR(found[0], std::max(a, b) + kick, error + 1e-4) << text;
    EXPECT_NEAR(found[1], std::min(a, b) + kick, error + 1e-4) << text;
  }
}

// At a fixed wall perturbations dx become dx v+/v- and dv become dv dv+/dv- = -e dv: a bounce multiplies areas of the
// plane by e |v+/v-|, and the mean of its logarithms is the sum of the exponents.
TEST(HybridExponents, OfABounceSumToWhatItMakesOfAreas) {
  const std::string text =
      "param e = 0.8\nx' = v\nv' = -0.5\nx(0) = 0.2\nv(0) = 1\n"
      "when x rises through 1 { v := -e*v }\nwhen x falls through 0 { v := -e*v + 0.5 }\nrun 0..20\n";
  const auto program = program_of(text);
  ASSERT_TRUE(program);
  const model::Simulated simulated = model::simulate(program, {.rtol = 1e-10, .atol = {1e-10}, .to = 250});
  ASSERT_TRUE(simulated.run);
  std::size_t bounces = 0;
  for (const model::RecordedEvent& event : simulated.run->events) bounces += event.t > 50 ? 1 : 0;
  const auto found = exponents_of(text, {.duration = 200, .settle = 50});
  ASSERT_EQ(found.size(), 2u);
  double sum = 0;
  for (const model::RecordedEvent& event : simulated.run->events)
    if (event.t > 50) sum += std::log(0.8 * std::abs(event.after[1] / event.before[1]));
  EXPECT_GT(bounces, 50u);
  EXPECT_NEAR(found[0] + found[1], sum / 200, 2 * std::log(2.0) / 200 + 1e-3);
}

// The relay reaches its surface and slides, so that neighbouring motions merge.
TEST(HybridExponents, OfNeighboursThatMergeAreFarBelowZero) {
  const auto found =
      exponents_of("x' = if x > 0 then -1 else 1\nx(0) = 0.5\nrun 0..5\n", {.duration = 20, .settle = 5});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT(found[0], -5);
}

// x'' = -g between bounces without loss: h = 0.1 is passed upwards once between two of them.
TEST(HybridSection, OfABallHasOnePassBetweenTwoBounces) {
  const auto program =
      program_of("h'' = -9.81\nh(0) = 1\nh'(0) = 0\nwhen h falls through 0 { h' := -h' }\nrun 0..10\n");
  ASSERT_TRUE(program);
  const Section found = poincare_section(program, {}, 0, {.level = 0.1, .duration = 10});
  const double fall = std::sqrt(2 / 9.81), to_level = (std::sqrt(2 * 9.81) - std::sqrt(2 * 9.81 * 0.9)) / 9.81;
  ASSERT_EQ(found.points.size(), static_cast<std::size_t>(std::floor((10 - fall - to_level) / (2 * fall))) + 1);
  for (std::size_t k = 0; k < found.points.size(); ++k) {
    EXPECT_NEAR(found.points[k].t, fall * (1 + 2 * static_cast<double>(k)) + to_level, 1e-8);
    EXPECT_NEAR(found.points[k].x[1], std::sqrt(2 * 9.81 * 0.9), 1e-8);
  }
}

TEST(HybridSection, CountsWhatAnEventCarriesOverThePlaneOnce) {
  const auto program = program_of("y' = 0\ny(0) = 0\nevery 1 { y := 1 - y }\nrun 0..10\n");
  ASSERT_TRUE(program);
  const Section found = poincare_section(program, {}, 0, {.level = 0.5, .settle = 1, .duration = 8});
  ASSERT_EQ(found.points.size(), 5u);  // at 1, 3, 5, 7, 9
  for (std::size_t k = 0; k < found.points.size(); ++k) EXPECT_EQ(found.points[k].t, 1 + 2 * static_cast<double>(k));
}

TEST(Unseen, IsWhatEquationsAloneDoNotSay) {
  EXPECT_FALSE(unseen_of(*program_of("x'' = -x - abs(x)\nx(0) = 1\nx'(0) = 0\nrun 0..1\n"), 0));
  EXPECT_TRUE(unseen_of(*program_of("x'' = -x - sign(x')\nx(0) = 1\nx'(0) = 0\nrun 0..1\n"), 0));
  EXPECT_TRUE(unseen_of(*program_of("x' = 1\nx(0) = 0\nwhen x > 1 { x := 0 }\nrun 0..9\n"), 0));
  EXPECT_FALSE(unseen_of(*program_of("x' = 1\nx(0) = 0\nwhen x > 1 { mark \"one\" }\nrun 0..9\n"), 0));
  EXPECT_TRUE(depends_on_time(*program_of("x' = cos(t) - x\nx(0) = 0\nrun 0..9\n"), 0));
  EXPECT_FALSE(depends_on_time(*program_of("x' = 1 - x\nx(0) = 0\nrun 0..9\n"), 0));
  EXPECT_TRUE(jump_at(*program_of("x' = -x - sign(x)\nx(0) = 1\nrun 0..1\n"), 0, std::vector<double>{0.0}));
  EXPECT_FALSE(jump_at(*program_of("x' = -x - sign(x)\nx(0) = 1\nrun 0..1\n"), 0, std::vector<double>{0.1}));
}

}  // namespace
}  // namespace continuo::studies
