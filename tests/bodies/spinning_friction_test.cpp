// The torque that resists spinning about the normal of a contact in the fast motion, as of a contact patch.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>

namespace continuo::spinning_friction_test {
namespace {

constexpr double friction = 0.5, radius = 0.5, g = 9.81;
constexpr double arm = 3 * std::numbers::pi / 16 * 0.05 * radius;  // torque = arm * friction * force

void run(FastMotion<double, 3>& motion, double duration) {
  for (int i = 0; i < std::lround(60 * duration); ++i) ASSERT_TRUE(motion.advance());
}

// The torque friction m g arm slows a spin with the inertia 2/5 m r^2 by 0.7 a second each second, until it ends.
TEST(SpinningFriction, SlowsABallOnTheFloorAtAConstantRate) {
  World<double, 3> world;
  world.gravity = {{0, 0, -g}};
  ASSERT_TRUE(world.add_wall({.material = {.friction = friction}}));
  ASSERT_TRUE(world.add({.position = {{0, 0, radius}}, .spin = {{0, 0, 2}}, .material = {.friction = friction}}));
  const double rate = friction * g * arm / (0.4 * radius * radius);
  FastMotion motion(world);
  run(motion, 0.5);  // within which the contact yields until it carries the weight
  const double then = world.spin[0][2];
  run(motion, 1);
  EXPECT_NEAR(then - world.spin[0][2], rate, 1e-3 * rate);
  run(motion, 4);
  EXPECT_NEAR(world.spin[0][2], 0, 1e-12);
}

// A ball on two fixed ones can roll over them about the line through both contacts, on which friction has no arm. The
// torques about the two normals, at an angle to that line whose cosine is 0.6, hold it as long as its weight m g acts
// at less than 2 x 0.6 friction N arm beside the line: N = m g / 1.6, as the normals are 0.8 upright, and the arm of
// the weight is the sine of the tilt times 0.4. That is a tilt of 0.0138. It stays where it is held, and does not
// creep.
TEST(SpinningFriction, HoldsABallOnTwoOthersUpToATiltAndNotBeyond) {
  const double steepest = 2 * 0.6 * friction * arm / 1.6 / 0.4;
  for (const double part : {0.2, 0.6, 2.0}) {
    World<double, 3> world;
    world.gravity = {{0, 0, -g}};
    for (const double side : {-0.6, 0.6})
      ASSERT_TRUE(world.add({.position = {{side, 0, 0}}, .fixed = true, .material = {.friction = friction}}));
    const double tilt = part * steepest;
    ASSERT_TRUE(
        world.add({.position = {{0, 0.8 * std::sin(tilt), 0.8 * std::cos(tilt)}}, .material = {.friction = friction}}));
    FastMotion motion(world);
    run(motion, 1);
    const auto then = world.position[2];
    run(motion, 2);
    if (part < 1) {
      EXPECT_LT(length(world.position[2] - then), 1e-9) << part;
    } else {
      EXPECT_LT(world.position[2][2], 0) << part;
    }
  }
}

}  // namespace
}  // namespace continuo::spinning_friction_test
