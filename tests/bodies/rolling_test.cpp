// A sphere on a floor or a slope: it slips until it rolls, and rolls until it stops. Closed forms of H. Moyse, G.-G.
// Coriolis (Theorie mathematique des effets du jeu de billard, 1835), of J / (m r^2) = c: 2/5 of a ball, 1/2 of a disc.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "round.hpp"
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/snapshot.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::rolling_test {
namespace {

constexpr double g = 10, mu = 0.2, r = 0.5;
const Material<double> cloth{.restitution = 0, .friction = mu};

template <int Dim>
World<double, Dim> table() {
  World<double, Dim> world;
  world.gravity[Dim - 1] = -g;
  EXPECT_TRUE(world.add_wall({.material = cloth}));
  return world;
}
template <int Dim>
Vector<double, Dim> at_height(double height) {
  Vector<double, Dim> x{};
  x[Dim - 1] = height;
  return x;
}

template <class T>
class Rolling : public testing::Test {};
TYPED_TEST_SUITE(Rolling, round::DiscAndBall);

// Rolling resistance beyond the limit of friction decelerates like that limit, by mu g.
TYPED_TEST(Rolling, ResistanceBeyondFrictionStopsLikeFriction) {
  constexpr int dim = TypeParam::dim;
  constexpr double v0 = 3, stops = v0 / (mu * g);
  auto world = table<dim>();
  Vector<double, dim> velocity{};
  velocity[0] = v0;
  Spin<double, dim> spin{};
  spin[dim == 2 ? 0 : 1] = dim == 2 ? -v0 / r : v0 / r;  // it rolls already
  ASSERT_TRUE(world.add({.position = at_height<dim>(r),
                         .velocity = velocity,
                         .spin = spin,
                         .material = {.restitution = 0, .friction = mu, .rolling_resistance = 1}}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(stops + 1));
  EXPECT_NEAR(world.position[0][0], v0 * stops / 2, 1e-9);
  EXPECT_EQ(world.velocity[0][0], 0);
}

// The slip is v0 at first and decreases at mu g (1 + 1/c); when it ends the speed is v0 / (1 + c).
TYPED_TEST(Rolling, FrictionTurnsSlidingIntoRolling) {
  constexpr int dim = TypeParam::dim;
  constexpr double c = TypeParam::inertia, v0 = 7, begins = v0 / (mu * g * (1 + 1 / c));
  auto world = table<dim>();
  Vector<double, dim> velocity{};
  velocity[0] = v0;
  ASSERT_TRUE(world.add({.position = at_height<dim>(r), .velocity = velocity, .material = cloth}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(begins / 2));
  EXPECT_NEAR(world.velocity[0][0], v0 - mu * g * begins / 2, 1e-12);
  EXPECT_NEAR(world.position[0][0], v0 * begins / 2 - mu * g * begins * begins / 8, 1e-12);
  ASSERT_TRUE(motion.advance_to(begins + 3));
  const double rolls = v0 / (1 + c);
  EXPECT_NEAR(world.velocity[0][0], rolls, 1e-12);
  EXPECT_NEAR(world.position[0][0], v0 * begins - mu * g * begins * begins / 2 + 3 * rolls, 1e-11);
  EXPECT_NEAR(length(world.spin[0]), rolls / r, 1e-11);
  EXPECT_NEAR(world.position[0][dim - 1], r, 1e-14);
  // Clockwise, about the axis to the right of the direction of motion.
  EXPECT_LT(dim == 2 ? world.spin[0][0] : -world.spin[0][1 % world.spin[0].size()], 0);
}

// Of rolling, v' = -rho g / (1 + c) until it stops; there it stays.
TYPED_TEST(Rolling, RollingResistanceStopsIt) {
  constexpr int dim = TypeParam::dim;
  constexpr double c = TypeParam::inertia, v0 = 2, rho = 0.05, slows = rho * g / (1 + c);
  auto world = table<dim>();
  Vector<double, dim> velocity{};
  velocity[0] = v0;
  Spin<double, dim> spin{};
  spin[dim == 2 ? 0 : 1] = dim == 2 ? -v0 / r : v0 / r;
  auto material = cloth;
  material.rolling_resistance = rho;
  ASSERT_TRUE(world.add({.position = at_height<dim>(r), .velocity = velocity, .spin = spin, .material = material}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(1));
  EXPECT_NEAR(world.velocity[0][0], v0 - slows, 1e-12);
  ASSERT_TRUE(motion.advance_to(100));
  EXPECT_EQ(length(world.velocity[0]), 0);
  EXPECT_EQ(length(world.spin[0]), 0);
  EXPECT_NEAR(world.position[0][0], v0 * v0 / (2 * slows), 1e-11);
  EXPECT_LT(motion.statistics().collisions + motion.statistics().outdated, 20u);
}

// Up a slope and down again: g sin / (1 + c) while friction is sufficient, tan <= mu (1 + 1/c); else it slips, at g
// (sin - mu cos).
TYPED_TEST(Rolling, OnASlopeItRollsOrSlips) {
  constexpr int dim = TypeParam::dim;
  constexpr double c = TypeParam::inertia;
  for (const bool is_steep : {false, true}) {
    const double slope = std::atan(mu * (1 + 1 / c) * (is_steep ? 1.25 : 0.8));
    World<double, dim> world;
    world.gravity[0] = g * std::sin(slope);
    world.gravity[dim - 1] = -g * std::cos(slope);
    ASSERT_TRUE(world.add_wall({.material = cloth}));
    ASSERT_TRUE(world.add({.position = at_height<dim>(r), .material = cloth}));
    ExactMotion motion(world);
    ASSERT_TRUE(motion.advance_to(2));
    const double a = is_steep ? g * (std::sin(slope) - mu * std::cos(slope)) : g * std::sin(slope) / (1 + c);
    EXPECT_NEAR(world.velocity[0][0], 2 * a, 1e-12 * a) << is_steep;
    EXPECT_NEAR(world.position[0][0], 2 * a, 1e-12 * a) << is_steep;
    const double spin = is_steep ? 2 * mu * g * std::cos(slope) / (c * r) : 2 * a / r;
    EXPECT_NEAR(length(world.spin[0]), spin, 1e-11 * spin) << is_steep;
  }
}

// A ball with any spin: the slip keeps its direction, so the path is a parabola, and 1 - 2/7 of the slip is left in v.
TEST(RollingInSpace, ABallWithSideSpinFollowsAParabola) {
  auto world = table<3>();
  const Vector<double, 3> v0{{3, 1, 0}}, spin{{-4, 20, 5}}, contact{{0, 0, -r}};
  const Vector<double, 3> slip = v0 + turning(spin, contact);
  ASSERT_TRUE(world.add({.position = {{0, 0, r}}, .velocity = v0, .spin = spin, .material = cloth}));
  ExactMotion motion(world);
  const double ends = length(slip) / (3.5 * mu * g);
  ASSERT_TRUE(motion.advance_to(ends / 2));
  const auto pull = slip * (-mu * g / length(slip));
  const auto there = v0 * (ends / 2) + pull * (ends * ends / 8);
  EXPECT_NEAR(world.position[0][0], there[0], 1e-12);
  EXPECT_NEAR(world.position[0][1], there[1], 1e-12);
  ASSERT_TRUE(motion.advance_to(ends + 1));
  const auto rolls = v0 - slip * (2.0 / 7);
  EXPECT_NEAR(world.velocity[0][0], rolls[0], 1e-12);
  EXPECT_NEAR(world.velocity[0][1], rolls[1], 1e-12);
  EXPECT_NEAR(world.spin[0][2], 5, 1e-12);  // about the normal nothing acts
}

// On a slope the slip turns. The equations themselves, by an error-controlled method: v' = pull - mu N slip / |slip|,
// slip' = pull - 7/2 mu N slip / |slip|. Directions are of second order in a thousandth of a radian: 1e-7 a radian,
// here a few metres and radians.
TEST(RollingInSpace, ASlipThatTurnsIsFollowed) {
  constexpr double slope = 0.3;
  World<double, 3> world;
  world.gravity = {{g * std::sin(slope), 0, -g * std::cos(slope)}};
  ASSERT_TRUE(world.add_wall({.material = cloth}));
  ASSERT_TRUE(world.add({.position = {{0, 0, r}}, .velocity = {{-1, 4, 0}}, .material = cloth}));
  const auto f = [](double, const std::array<double, 6>& x) {
    const double size = std::hypot(x[4], x[5]), n = g * std::cos(slope), pull = g * std::sin(slope);
    return std::array<double, 6>{x[2],
                                 x[3],
                                 pull - mu * n * x[4] / size,
                                 -mu * n * x[5] / size,
                                 pull - 3.5 * mu * n * x[4] / size,
                                 -3.5 * mu * n * x[5] / size};
  };
  const auto right =
      solve(f, std::array<double, 6>{0, 0, -1, 4, -1, 4}, {0.0, 0.6}, Dop853{}, {.rtol = 1e-12, .atol = 1e-12});
  ASSERT_TRUE(right.outcome);
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(0.6));
  EXPECT_NEAR(world.position[0][0], right.final_state()[0], 1e-6);
  EXPECT_NEAR(world.position[0][1], right.final_state()[1], 1e-6);
  EXPECT_NEAR(world.velocity[0][0], right.final_state()[2], 1e-6);
  EXPECT_NEAR(world.velocity[0][1], right.final_state()[3], 1e-6);
}

// Every player's follow shot, the balls polished: the cue ball, rolling at v, stops dead, and its spin drives it on to
// 2/7 v; the other slides off at v and comes to roll at 5/7 v. Friction belongs to pairs of surfaces, and two surfaces
// combine by the mean sqrt(a b): polished a million times, on a cloth rougher by as much.
TEST(RollingInSpace, TheFollowShotOfBilliards) {
  constexpr double polish = 1e-9;
  World<double, 3> world;
  world.gravity = {{0, 0, -g}};
  ASSERT_TRUE(world.add_wall({.material = {.restitution = 0, .friction = mu * mu / polish}}));
  const Material<double> ivory{.restitution = 1, .friction = polish};
  ASSERT_TRUE(world.add({.position = {{0, 0, r}}, .velocity = {{7, 0, 0}}, .spin = {{0, 14, 0}}, .material = ivory}));
  ASSERT_TRUE(world.add({.position = {{3, 0, r}}, .material = ivory}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(20));
  // A few times the effect of a friction of 1e-9 on a ball of 7 m/s.
  EXPECT_NEAR(world.velocity[0][0], 2, 1e-7);
  EXPECT_NEAR(world.velocity[1][0], 5, 1e-7);
}

TEST(RollingInSpace, ASnapshotInTheMiddleOfASlideGoesOnToTheSameBits) {
  World<double, 3> world = table<3>(), again;
  for (int i = 0; i < 5; ++i)
    ASSERT_TRUE(world.add({.position = {{1.5 * i, 0, r}},
                           .velocity = {{3.0 - i, 0.1 * i, 0}},
                           .spin = {{1, -3, 2}},
                           .material = {.restitution = 0.7, .friction = 0.1, .rolling_resistance = 0.01}}));
  ExactMotion motion(world), motion_again(again);
  ASSERT_TRUE(motion.advance_to(0.3));
  const Bytes bytes = snapshot(world, motion);
  ASSERT_TRUE(motion.advance_to(5));
  ASSERT_TRUE(restore(bytes, again, motion_again));
  ASSERT_TRUE(motion_again.advance_to(5));
  EXPECT_EQ(state_hash(world), state_hash(again));
}

// Output does not change the motion: any number of calls gives the same bits.
TEST(RollingInSpace, PlacesDoNotDependOnHowOftenOneLooks) {
  auto seldom = table<3>(), often = table<3>();
  for (auto* world : {&seldom, &often})
    ASSERT_TRUE(world->add({.position = {{0, 0, r}},
                            .velocity = {{3, 1, 0}},
                            .spin = {{0, 0, 1}},
                            .material = {.friction = 0.1, .rolling_resistance = 0.01}}));
  ExactMotion once(seldom), steps(often);
  ASSERT_TRUE(once.advance_to(6));
  for (int i = 1; i <= 60; ++i) ASSERT_TRUE(steps.advance_to(0.1 * i));
  EXPECT_EQ(seldom.position, often.position);
  EXPECT_EQ(seldom.velocity, often.velocity);
  EXPECT_EQ(seldom.spin, often.spin);
}

}  // namespace
}  // namespace continuo::rolling_test
