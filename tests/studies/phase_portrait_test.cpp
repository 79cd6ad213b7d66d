#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <continuo/studies/phase_portrait.hpp>

namespace continuo::studies::phase_portrait_test {
namespace {

ParametricSystem pendulum() {
  return parametric_system(2,
                           [](double, Values x, Values, std::span<double> f) { f[0] = x[1], f[1] = -std::sin(x[0]); });
}

TEST(PhasePortrait, SeparatricesOfThePendulumHaveItsEnergy) {  // v^2 / 2 - cos x = 1, that of the upright pendulum
  const auto portrait = phase_portrait(pendulum(), {.low = {-4, -3}, .high = {4, 3}, .duration = 20});
  EXPECT_TRUE(portrait.complete);
  ASSERT_EQ(portrait.equilibria.size(), 3u);
  EXPECT_EQ(portrait.equilibria[1].stability, Stability::undecided);
  ASSERT_EQ(portrait.separatrices.size(), 8u);
  for (const PlaneCurve& curve : portrait.separatrices) {
    EXPECT_GT(curve.size(), 10u);
    // The separatrix begins 1e-4 of the plane from the saddle, where the energy is off by the square of that; rtol adds
    // the rest.
    for (const auto& [x, v] : curve) EXPECT_NEAR(v * v / 2 - std::cos(x), 1, 1e-5);
  }
}

TEST(PhasePortrait, NullclinesLieWhereTheyMust) {  // v = 0, and x = -pi, 0, pi
  const auto portrait = phase_portrait(pendulum(), {.low = {-4.1, -3}, .high = {4, 3.1}, .duration = 1});
  ASSERT_FALSE(portrait.nullclines[0].empty());
  ASSERT_FALSE(portrait.nullclines[1].empty());
  const double cell = 8.1 / 160;  // linear inside a cell: off by sin'' cell^2 / 8 at most
  for (const PlaneCurve& piece : portrait.nullclines[0])
    for (const auto& point : piece) EXPECT_NEAR(point[1], 0, 1e-12);
  for (const PlaneCurve& piece : portrait.nullclines[1])
    for (const auto& point : piece) EXPECT_NEAR(std::sin(point[0]), 0, cell * cell / 8);
}

TEST(PhasePortrait, TheFieldPointsWhereTheMotionGoes) {
  const auto portrait = phase_portrait(pendulum(), {.low = {-2, -2}, .high = {2, 2}, .spread = 1, .arrows = 5});
  ASSERT_EQ(portrait.field.size(), 24u);  // at the origin there is none
  for (const FieldArrow& arrow : portrait.field) {
    EXPECT_NEAR(std::hypot(arrow.direction[0], arrow.direction[1]), 1, 1e-12);
    EXPECT_GE(arrow.direction[0] * arrow.at[1], 0);
  }
  EXPECT_EQ(portrait.motions.size(), 1u);
}

TEST(PhasePortrait, MotionsEndWhereTheyLeave) {  // x' = x, y' = 0
  const auto f = [](double, Values x, Values, std::span<double> out) { out[0] = x[0], out[1] = 0 * x[1]; };
  const auto portrait = phase_portrait(parametric_system(2, f),
                                       {.low = {-1, -1}, .high = {1, 1}, .starts = {{0.5, 0.5}}, .duration = 100});
  ASSERT_EQ(portrait.motions.size(), 1u);
  for (const auto& point : portrait.motions[0]) EXPECT_LE(std::abs(point[0]), 1.03);
}

// Two hundred turns within the time of the picture: at equidistant times there would be four points to a turn.
TEST(PhasePortrait, FastMotionsAreRound) {
  const double w = 400 * std::numbers::pi;
  const auto turning =
      parametric_system(2, [w](double, Values x, Values, std::span<double> f) { f[0] = w * x[1], f[1] = -w * x[0]; });
  const auto portrait =
      phase_portrait(turning, {.low = {-2, -2}, .high = {2, 2}, .starts = {{1, 0}}, .duration = 1, .rtol = 1e-9});
  ASSERT_EQ(portrait.motions.size(), 1u);
  const PlaneCurve& circle = portrait.motions[0];
  for (std::size_t k = 1; k < circle.size(); ++k)  // the middle of a chord, as far inside as 1/2000 of the plane
    EXPECT_NEAR(std::hypot(circle[k][0] + circle[k - 1][0], circle[k][1] + circle[k - 1][1]) / 2, 1, 4.0 / 2000 + 1e-4);
}

}  // namespace
}  // namespace continuo::studies::phase_portrait_test
