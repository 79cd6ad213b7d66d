// A body in a groove or a corner, in contact with several rough walls, against closed forms.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo::groove_test {
namespace {

constexpr double g = 9.81;

/// A disc of mass 2 and radius 0.5 that touches both walls of a corner, each at 45 degrees, and spins.
World<double, 2> spinning_in_a_corner(double friction, double spin) {
  World<double, 2> world;
  world.gravity = {{0, -g}};
  const Material<double> material{.restitution = 0, .friction = friction};
  for (const double side : {1.0, -1.0}) EXPECT_TRUE(world.add_wall({.normal = {{side, 1}}, .material = material}));
  EXPECT_TRUE(world.add({.shape = Sphere<double>{0.5},
                         .position = {{0, 0.5 * std::numbers::sqrt2}},
                         .spin = {{spin}},
                         .mass = 2,
                         .material = material}));
  return world;
}

// Both walls exert their full friction while the disc stays in place: N_1 + N_2 = sqrt(2) m g / (1 + mu^2), as mu N
// acts along each wall, against the spin. That begins within the contact time, 3e-6 s, in which the spin falls by 7e-5
// at most.
TEST(Groove, RubsADiscUntilItStands) {
  for (const double friction : {0.1, 0.5}) {
    World<double, 2> world = spinning_in_a_corner(friction, 30);
    const double inertia = 0.5 * 2 * 0.25;
    const double slowing = friction * 0.5 * std::numbers::sqrt2 * 2 * g / (1 + friction * friction) / inertia;
    const double stop = 30 / slowing;
    ExactMotion motion(world);
    ASSERT_TRUE(motion.advance_to(stop / 3));
    EXPECT_NEAR(world.spin[0][0], 20, 1e-4) << friction;
    ASSERT_TRUE(motion.advance_to(0.99 * stop));
    EXPECT_NEAR(world.spin[0][0], 0.3, 1e-4) << friction;
    ASSERT_TRUE(motion.advance_to(1.01 * stop));
    EXPECT_NEAR(world.spin[0][0], 0, 1e-9) << friction;
    EXPECT_NEAR(world.position[0][1], 0.5 * std::numbers::sqrt2, 1e-9) << friction;
    EXPECT_NEAR(length(world.velocity[0]), 0, 1e-9) << friction;
    ExactMotion on(world, {.most_events = 100});  // at rest there are no events
    EXPECT_TRUE(on.advance_to(1e6)) << friction;
  }
}
TEST(Groove, WithoutFrictionSpinGoesOn) {
  World<double, 2> world = spinning_in_a_corner(0, 30);
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(10));
  EXPECT_EQ(world.spin[0][0], 30);
}

// Down a groove of two walls, each at an angle beta from its middle, a ball rolls about the line through its contacts,
// which is r cos(beta) below its centre: a = g sin(slope) / (1 + J / (m r^2 cos(beta)^2)). What slips by less than
// forces change in the contact time, 3e-5 here, rolls.
TEST(Groove, LetsABallRollDown) {
  const double slope = 0.2;
  for (const double beta : {0.3, 0.8}) {
    for (const double height : {0.0, 0.3}) {
      World<double, 3> world;
      world.gravity = {{g * std::sin(slope), 0, -g * std::cos(slope)}};
      const Material<double> material{.restitution = 0.3, .friction = 0.9};
      for (const double side : {1.0, -1.0})
        ASSERT_TRUE(world.add_wall({.normal = {{0, side * std::sin(beta), std::cos(beta)}}, .material = material}));
      ASSERT_TRUE(world.add({.position = {{0, 0, 0.5 / std::cos(beta) + height}}, .material = material}));
      ExactMotion motion(world);
      const double settled = height > 0 ? 20 : 2;  // it rolls from side to side first
      ASSERT_TRUE(motion.advance_to(settled));
      const double v = world.velocity[0][0], spin = world.spin[0][1];
      EXPECT_NEAR(spin * 0.5 * std::cos(beta), v, 1e-4) << beta << ' ' << height;  // it rolls
      ASSERT_TRUE(motion.advance_to(settled + 2));
      const double wanted = g * std::sin(slope) / (1 + 0.4 / (std::cos(beta) * std::cos(beta)));
      EXPECT_NEAR((world.velocity[0][0] - v) / 2, wanted, 1e-5) << beta << ' ' << height;
      EXPECT_NEAR(world.velocity[0][1], 0, 1e-6);
      EXPECT_NEAR(world.position[0][2], 0.5 / std::cos(beta), 1e-6);
    }
  }
}

TEST(Groove, GoesOnFromASnapshotAndIsToldOfOnce) {
  World<double, 2> world = spinning_in_a_corner(0.3, 30), again;
  ExactMotion motion(world, {.contact_events = 100}), motion_again(again, {.contact_events = 100});
  ASSERT_TRUE(motion.advance_to(0.2));
  ASSERT_EQ(motion.contact_events().size(), 2u);  // a contact with each wall begins
  for (const auto& event : motion.contact_events()) EXPECT_EQ(event.change, ContactChange::begin);
  ASSERT_TRUE(restore(snapshot(world, motion), again, motion_again));
  ASSERT_TRUE(motion.advance_to(5));
  ASSERT_TRUE(motion_again.advance_to(5));
  EXPECT_EQ(state_hash(world), state_hash(again));
}

}  // namespace
}  // namespace continuo::groove_test
