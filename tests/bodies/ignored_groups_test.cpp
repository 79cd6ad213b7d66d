// Groups that are told to ignore each other while their bodies lie on each other.
#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::ignored_groups_test {
namespace {

constexpr double step = 1.0 / 60, gravity = 10;

/// Lets the last body come to rest on the others, of group 1, and tells it to ignore them: it falls freely in the very
/// next step.
template <int Dim>
void expect_fall(World<double, Dim> world, double sleep_after) {
  world.gravity[Dim - 1] = -gravity;
  FastMotion<double, Dim> motion(world, {.step = step, .sleep_after = sleep_after});
  for (int k = 0; k < 300; ++k) require(motion.advance());
  const std::size_t last = world.size() - 1;
  EXPECT_NEAR(world.velocity[last][Dim - 1], 0, 1e-3);
  EXPECT_EQ(motion.statistics().asleep, sleep_after > 0 ? 1u : 0u);
  world.velocity[last] = {};
  require(world.ignore(0, 1));
  require(motion.advance());
  EXPECT_NEAR(world.velocity[last][Dim - 1], -gravity * step, 1e-12);
  require(motion.advance());
  EXPECT_NEAR(world.velocity[last][Dim - 1], -2 * gravity * step, 1e-12);
}
template <int Dim>
void expect_asleep_and_awake(const World<double, Dim>& world) {
  expect_fall(world, 0);
  expect_fall(world, 0.5);
}

/// A ball in the hollow between others.
template <int Dim>
World<double, Dim> hollow() {
  World<double, Dim> world;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      Vector<double, Dim> at;
      at[0] = x, at[1] = Dim == 3 ? y : 0;
      if (Dim == 3 || y > 0) require(world.add({.position = at, .fixed = true, .group = 1}).status());
    }
  Vector<double, Dim> above;
  above[Dim - 1] = 1.4;
  require(world.add({.shape = Sphere<double>{1}, .position = above}).status());
  return world;
}
template <int Dim>
World<double, Dim> box_on_box() {
  World<double, Dim> world;
  Vector<double, Dim> above;
  above[Dim - 1] = 1;
  require(world.add({.shape = Box<double, Dim>{}, .fixed = true, .group = 1}).status());
  require(world.add({.shape = Box<double, Dim>{}, .position = above}).status());
  return world;
}

TEST(IgnoredGroups, ActAtTheNextStepForBalls) {
  expect_asleep_and_awake(hollow<2>());
  expect_asleep_and_awake(hollow<3>());
}
TEST(IgnoredGroups, ActAtTheNextStepForBoxes) {
  expect_asleep_and_awake(box_on_box<2>());
  expect_asleep_and_awake(box_on_box<3>());
}

}  // namespace
}  // namespace continuo::ignored_groups_test
