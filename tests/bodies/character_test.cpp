// Characters that walk, against closed forms.
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/character.hpp>

namespace continuo::character_test {

using namespace test;  // rigid_worlds.hpp

namespace {

constexpr double h = 1.0 / 60, radius = 0.3, skin = 0.005;

/// After so many steps at a velocity, in a world that does not move.
template <int Dim>
Character<double, Dim> walked(const World<double, Dim>& world, Character<double, Dim> of,
                              const Vector<double, Dim>& velocity, int steps) {
  const Queries<double, Dim> queries(world);
  for (int k = 0; k < steps; ++k) {
    const auto after = walk(world, queries, of, velocity, h);
    EXPECT_TRUE(after) << describe(after.status());
    if (after) of = *after;
  }
  return of;
}
template <int Dim>
Character<double, Dim> at(double x, double height) {
  return {.position = upright_vector<Dim>(x, height)};
}
/// A box from one corner to the other one, of all widths in space.
template <int Dim>
void add_block(World<double, Dim>& world, double x0, double z0, double x1, double z1) {
  Box<double, Dim> box;
  for (double& side : box.size.components) side = 8;
  box.size[0] = x1 - x0, box.size[Dim - 1] = z1 - z0;
  ASSERT_TRUE(world.add({.shape = box, .position = upright_vector<Dim>((x0 + x1) / 2, (z0 + z1) / 2), .fixed = true}));
}

template <int Dim>
void expect_fall_and_rest() {
  auto world = world_on_slope<Dim>(0, 0.5);
  // Half a second of free fall, exactly.
  const auto falling = walked<Dim>(world, at<Dim>(0, 3), {}, 30);
  EXPECT_NEAR(falling.position[Dim - 1], 3 - 9.81 / 2 * 0.25, 1e-12);
  EXPECT_FALSE(falling.is_on_ground);
  const auto standing = walked<Dim>(world, falling, {}, 60);
  EXPECT_TRUE(standing.is_on_ground);
  EXPECT_NEAR(standing.position[Dim - 1], skin, skin / 2 + 1e-4);
  const auto later = walked<Dim>(world, standing, {}, 100);
  EXPECT_EQ(later.position, standing.position);  // to the bit
  auto jumping = standing;
  jumping.rise = 3;
  jumping = walked<Dim>(world, jumping, {}, 12);
  EXPECT_NEAR(jumping.position[Dim - 1] - standing.position[Dim - 1], 3 * 0.2 - 9.81 / 2 * 0.04, 1e-12);
}
TEST(Character, FallsRestsAndJumps) {
  expect_fall_and_rest<2>();
  expect_fall_and_rest<3>();
}

template <int Dim>
void expect_slopes() {
  for (const double degrees : {10.0, 30.0, 44.0}) {
    const double angle = degrees * std::acos(-1) / 180;
    const auto world = world_on_slope<Dim>(angle, 0.5);
    auto of = walked<Dim>(world, at<Dim>(0, 0.1), {}, 30);
    ASSERT_TRUE(of.is_on_ground) << degrees;
    for (const double speed : {1.0, -2.0}) {
      const auto from = of.position;
      of = walked<Dim>(world, of, upright_vector<Dim>(speed, 0), 60);
      EXPECT_TRUE(of.is_on_ground) << degrees;
      EXPECT_NEAR(of.position[0] - from[0], speed, 1e-9) << degrees;
      EXPECT_NEAR(of.position[Dim - 1] - from[Dim - 1], speed * std::tan(angle), 2 * skin) << degrees;
    }
  }
  // Flat ground, and from x = 1 on a slope that is too steep.
  auto world = world_on_slope<Dim>(0, 0.5);
  ASSERT_TRUE(world.add_wall({.normal = upright_vector<Dim>(-std::sin(1.0), std::cos(1.0)), .offset = -std::sin(1.0)}));
  const auto of = walked<Dim>(world, at<Dim>(0, skin), upright_vector<Dim>(1, 0), 120);
  // The ball at its foot, and the skin, touch the slope.
  const double expected = 1 - (radius + skin - radius * std::cos(1.0)) / std::sin(1.0) + skin / std::tan(1.0);
  EXPECT_NEAR(of.position[0], expected, 2 * skin);
  EXPECT_LT(of.position[Dim - 1], 2 * skin);
}
TEST(Character, GoesUpSlopesThatAreNotTooSteep) {
  expect_slopes<2>();
  expect_slopes<3>();
}

template <int Dim>
void expect_steps() {
  for (const double height : {0.1, 0.2, 0.28}) {
    auto world = world_on_slope<Dim>(0, 0.5);
    for (int k = 1; k <= 4; ++k) add_block<Dim>(world, k, -1, 20, height * k);
    auto of = walked<Dim>(world, at<Dim>(0, skin), {}, 5);
    of = walked<Dim>(world, of, upright_vector<Dim>(2, 0), 180);
    EXPECT_NEAR(of.position[0], 6, 0.1) << height;  // hardly slower than on flat ground
    EXPECT_NEAR(of.position[Dim - 1], 4 * height + skin, skin / 2 + 1e-4) << height;
    EXPECT_TRUE(of.is_on_ground);
    of = walked<Dim>(world, of, upright_vector<Dim>(-2, 0), 180);
    EXPECT_NEAR(of.position[Dim - 1], skin, skin / 2 + 1e-4) << height;  // and down again
    EXPECT_TRUE(of.is_on_ground);
  }
  auto world = world_on_slope<Dim>(0, 0.5);
  add_block<Dim>(world, 1, -1, 20, 0.4);  // too high
  const auto of = walked<Dim>(world, at<Dim>(0, skin), upright_vector<Dim>(2, 0), 120);
  EXPECT_NEAR(of.position[0], 1 - radius - skin, skin / 2 + 1e-3);
  EXPECT_NEAR(of.position[Dim - 1], skin, skin / 2 + 1e-4);
}
TEST(Character, GoesUpStepsThatAreNotTooHigh) {
  expect_steps<2>();
  expect_steps<3>();
}

TEST(Character, SlidesAlongWallsAndStopsInCorners) {
  auto world = world_on_slope<3>(0, 0.5);
  ASSERT_TRUE(world.add_wall({.normal = {{-1, 0, 0}}, .offset = -2}));
  auto of = walked<3>(world, {.position = {{0, 0, skin}}}, {{2, 1, 0}}, 120);
  EXPECT_NEAR(of.position[0], 2 - radius - skin, 1e-4);
  EXPECT_NEAR(of.position[1], 2, 1e-9);
  ASSERT_TRUE(world.add_wall({.normal = {{0.6, -0.8, 0}}, .offset = -3}));
  of = walked<3>(world, of, {{2, 1, 0}}, 300);
  // Where it is a radius and the skin from both.
  const double r = radius + skin, x = 2 - r, y = (3 + 0.6 * x - r) / 0.8;
  EXPECT_NEAR(of.position[0], x, 1e-3);
  EXPECT_NEAR(of.position[1], y, 1e-3);
  const auto later = walked<3>(world, of, {{2, 1, 0}}, 60);
  EXPECT_LT(length(Vector<double, 3>(later.position - of.position)), 1e-4);
}

TEST(Character, IsCarriedByPlatforms) {
  World<double, 3> world;
  world.gravity = {{0, 0, -9.81}};
  const auto platform = world.add({.shape = Box<double, 3>{{{6, 6, 1}}},
                                   .position = {{0, 0, -0.5}},
                                   .velocity = {{0.5, 0, 0.25}},
                                   .spin = {{0, 0, 0.5}},
                                   .fixed = true,
                                   .traits = {.is_driven = true}});
  ASSERT_TRUE(platform);
  FastMotion<double, 3> motion(world);
  Character<double, 3> of{.position = {{1, 0, skin}}};
  of = *walk(world, Queries(world), of, {}, h);
  ASSERT_EQ(of.ground, *platform);
  const auto place_on = [&] {
    return transposed_times(rotation(world.orientation[0]), Vector<double, 3>(of.position - world.position[0]));
  };
  const auto before = place_on();
  for (int k = 0; k < 120; ++k) {
    advance(motion, 1);
    const auto after = walk(world, Queries(world), of, {}, h);
    ASSERT_TRUE(after);
    of = *after;
  }
  EXPECT_LT(length(Vector<double, 3>(place_on() - before)), 1e-9);
  EXPECT_NEAR(of.position[2], 0.5 + skin, skin);
}

/// What only senses neither bears it nor stops it, wherever that is: the same walk to the bit as without.
template <int Dim>
void expect_walk_through_sensors() {
  const auto alone = world_on_slope<Dim>(0, 0.5);
  auto other = alone;
  for (const auto& [x, height] : {std::pair(0.0, 0.5), {1.0, 1.0}, {2.0, 0.1}, {2.5, 2.0}}) {
    Box<double, Dim> box;
    for (double& side : box.size.components) side = 0.6;
    ASSERT_TRUE(other.add(
        {.shape = box, .position = upright_vector<Dim>(x, height), .fixed = true, .traits = {.is_sensor = true}}));
  }
  auto of = at<Dim>(0, 3), with_sensors = of;
  for (const double speed : {0.0, 2.0, -1.0}) {
    of.rise = with_sensors.rise = speed;
    of = walked<Dim>(alone, of, upright_vector<Dim>(speed, 0), 90);
    with_sensors = walked<Dim>(other, with_sensors, upright_vector<Dim>(speed, 0), 90);
    EXPECT_EQ(with_sensors.position, of.position) << speed;
    EXPECT_TRUE(with_sensors.is_on_ground && with_sensors.ground == BodyHandle{}) << speed;
  }
}
TEST(Character, WalksThroughSensors) {
  expect_walk_through_sensors<2>();
  expect_walk_through_sensors<3>();
}

TEST(Character, ErrorsSayWhatIsWrong) {
  const World<double, 3> world;
  const Queries<double, 3> queries(world);
  const auto error = [&](const CharacterOptions<double>& options) {
    return std::string(walk<double, 3>(world, queries, {}, {}, h, options).status().message);
  };
  EXPECT_EQ(error({.height = 0.5}), "a character's radius must be greater than 0, and its height more than two radii");
  EXPECT_EQ(error({.steepest = 2}), "the steepest slope must be between 0 and a right angle");
  EXPECT_EQ(error({.skin = 1}), "the skin must be greater than 0, and at most a tenth of the radius");
}

}  // namespace
}  // namespace continuo::character_test
