// Bodies at rest fall asleep, and wake when another body comes near.
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>
#include <tests/bodies/heaps.hpp>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo::sleep_test {
namespace {

const FastOptions<double> with_sleep{.sleep_after = 0.5};

World<double, 3> stack_of(int count) {
  World<double, 3> world;
  world.gravity = {{0, 0, -9.81}};
  EXPECT_TRUE(world.add_wall({}));
  for (int i = 0; i < count; ++i) EXPECT_TRUE(world.add({.position = {{0, 0, 0.5 + i}}}));
  return world;
}
void run(FastMotion<double, 3>& motion, double duration) {
  for (int i = 0; i < std::lround(duration * 60); ++i) ASSERT_TRUE(motion.advance());
}

TEST(Sleep, AStackFallsAsleepAndStaysAsleep) {
  World<double, 3> world = stack_of(5);
  FastMotion<double, 3> motion(world, with_sleep);
  run(motion, 2);
  EXPECT_EQ(motion.statistics().asleep, 5u);
  EXPECT_EQ(kinetic_energy(world), 0);
  const auto hash = world.position;
  run(motion, 10);
  EXPECT_EQ(motion.statistics().asleep, 5u);
  EXPECT_EQ(world.position, hash);
  EXPECT_EQ(motion.statistics().contacts, 0u);
}

TEST(Sleep, NothingSleepsUnlessAsked) {
  World<double, 3> world = stack_of(2);
  FastMotion<double, 3> motion(world);
  run(motion, 5);
  EXPECT_EQ(motion.statistics().asleep, 0u);
}

// An oscillating body does not fall asleep either: a pendulum is slow at its turning points, but not for long.
TEST(Sleep, WhatSwingsStaysAwake) {
  World<double, 3> world;
  const auto ball = world.add({.position = {{2, 0, 0}}, .mass = 1});
  world.springs.push_back({.a = *ball, .b = Vector<double, 3>{}, .rest_length = 1, .stiffness = 1});
  FastMotion<double, 3> motion(world, with_sleep);
  run(motion, 20);
  EXPECT_EQ(motion.statistics().asleep, 0u);
  EXPECT_NEAR(kinetic_energy(world) + potential_energy(world), 0.5, 0.01);
}

// A ball that hits a sleeping one transfers its momentum as to an awake one: with equal masses, all of it.
TEST(Sleep, AHitWakes) {
  World<double, 3> world;
  const Material<double> elastic{.restitution = 1, .friction = 0};
  ASSERT_TRUE(world.add({.material = elastic}));
  FastMotion<double, 3> motion(world, with_sleep);
  run(motion, 1);
  ASSERT_EQ(motion.statistics().asleep, 1u);
  ASSERT_TRUE(world.add({.position = {{-10, 0, 0}}, .velocity = {{5, 0, 0}}, .material = elastic}));
  run(motion, 1);  // the new body wakes all; it falls asleep again before it is hit
  EXPECT_EQ(motion.statistics().asleep, 1u);
  run(motion, 2);
  EXPECT_EQ(motion.statistics().asleep, 1u);  // now it is the other
  EXPECT_EQ(world.velocity[1], (Vector<double, 3>{}));
  EXPECT_NEAR(world.velocity[0][0], 5, 1e-9);
}

/// Which it will hit after 2.3 s.
World<double, 3> ball_above_a_stack() {
  World<double, 3> world = stack_of(3);
  EXPECT_TRUE(world.add({.position = {{0, 0, 30}}, .mass = 5}));
  return world;
}

TEST(Sleep, ABallOnAStackWakesAllOfIt) {
  World<double, 3> world = ball_above_a_stack();
  FastMotion<double, 3> motion(world, with_sleep);
  run(motion, 1.5);
  EXPECT_EQ(motion.statistics().asleep, 3u);
  run(motion, 1.0);  // it falls for 2.3 s
  EXPECT_EQ(motion.statistics().asleep, 0u);
  run(motion, 8);
  EXPECT_EQ(kinetic_energy(world), 0);
}

TEST(Sleep, WhatIsChangedWakes) {
  const auto height_after = [](auto&& change) {
    World<double, 3> world = stack_of(1);
    FastMotion<double, 3> motion(world, with_sleep);
    run(motion, 1);
    EXPECT_EQ(motion.statistics().asleep, 1u);
    change(world);
    run(motion, 0.25);
    EXPECT_EQ(motion.statistics().asleep, 0u);
    return world.position[0][2];
  };
  EXPECT_GT(height_after([](auto& world) { world.velocity[0][2] = 3; }), 0.6);
  EXPECT_GT(height_after([](auto& world) { world.position[0][2] = 3; }), 2);
  EXPECT_GT(height_after([](auto& world) { world.constant_force[0] = {{0, 0, 12}}; }), 0.6);
  EXPECT_GT(height_after([](auto& world) { world.gravity = {{0, 0, 9.81}}; }), 0.6);
}

// A restored world sleeps on, and wakes to the same bits.
TEST(Sleep, IsPartOfASnapshot) {
  World<double, 3> world = ball_above_a_stack();
  FastMotion<double, 3> motion(world, with_sleep);
  run(motion, 1.5);
  ASSERT_EQ(motion.statistics().asleep, 3u);
  World<double, 3> other = world;
  FastMotion<double, 3> again(other, with_sleep);
  const auto bytes = snapshot(world, motion);
  ASSERT_TRUE(restore(bytes, other, again));
  ASSERT_TRUE(again.advance());
  ASSERT_TRUE(motion.advance());
  EXPECT_EQ(again.statistics().asleep, 3u);
  run(motion, 3), run(again, 3);
  EXPECT_EQ(state_hash(other), state_hash(world));
}

// In a pile some bodies always come to rest later than their neighbours. These must not wake the others for ever. When
// the pile is woken again, it has the impulses with which it fell asleep: without them its balls would jump by tenths
// of a length per time. In gravity that is 9.81 per time^2, an awake ball at rest without any impulse would have 0.16
// after a step.
TEST(Sleep, APileFallsAsleepAndWakesAtRest) {
  World<double, 3> world = heap<double>(100, 4, 1);
  for (auto& material : world.material) material.rolling_resistance = 0.05;
  FastMotion<double, 3> motion(world, with_sleep);
  for (int i = 0; i < 900 && motion.statistics().asleep < world.size(); ++i) ASSERT_TRUE(motion.advance());
  ASSERT_EQ(motion.statistics().asleep, world.size());
  const std::size_t lists = motion.statistics().lists;
  const auto position = world.position;
  run(motion, 1);
  EXPECT_EQ(world.position, position);
  EXPECT_LE(motion.statistics().lists, lists + 1);
  world.gravity[0] = 1e-4;  // a changed force wakes all
  run(motion, 0.1);
  EXPECT_EQ(motion.statistics().asleep, 0u);
  for (const auto& v : world.velocity) EXPECT_LT(length(v), 0.05);
}

// What arrives slower than the speed of sleep wakes nothing, but becomes part of the island that it touches: what wakes
// the one wakes the other.
TEST(Sleep, ASlowTouchWakesNothing) {
  World<double, 3> world = stack_of(1);
  const auto roll = [&](double speed) {
    world.velocity[1] = {{-speed, 0, 0}};
    world.spin[1] = {{0, -2 * speed, 0}};
  };
  ASSERT_TRUE(world.add({.position = {{1.046, 0, 0.5}}}));
  ASSERT_TRUE(world.add({.position = {{9, 0, 30}}}));  // is awake all the time
  roll(0.06);
  FastMotion<double, 3> motion(world, with_sleep);
  run(motion, 0.6);
  ASSERT_EQ(motion.statistics().asleep, 1u);
  roll(0.03);  // slow, and it will touch in a third of a second
  run(motion, 1);
  EXPECT_EQ(motion.statistics().asleep, 2u);
  EXPECT_NEAR(world.position[0][0], 0, 1e-12);
  EXPECT_LT(world.position[1][0], 1.001);
  world.velocity[0] = {{0, 0, 1}};
  ASSERT_TRUE(motion.advance());
  EXPECT_EQ(motion.statistics().asleep, 0u);
}

// A ball that a force presses slowly against a sleeping one moves it: the two together are accelerated by the force.
TEST(Sleep, WhatIsPressedByAForceWakes) {
  World<double, 3> world;
  ASSERT_TRUE(world.add({.mass = 1}));
  FastMotion<double, 3> motion(world, with_sleep);
  run(motion, 1);
  ASSERT_EQ(motion.statistics().asleep, 1u);
  World<double, 3> pushed = world;
  ASSERT_TRUE(pushed.add({.position = {{-1.0001, 0, 0}}, .mass = 1}));
  pushed.constant_force[1] = {{1, 0, 0}};
  FastMotion<double, 3> together(pushed, with_sleep);
  run(together, 2);
  EXPECT_NEAR(pushed.velocity[0][0], 1, 0.02);  // force 1, mass 2, 2 s
}

// Taking out the lowest of a stack lets the others fall.
TEST(Sleep, RemovalWakes) {
  World<double, 3> world = stack_of(3);
  FastMotion<double, 3> motion(world, with_sleep);
  run(motion, 1);
  ASSERT_EQ(motion.statistics().asleep, 3u);
  ASSERT_TRUE(world.remove(world.handle(0)));
  run(motion, 3);
  EXPECT_EQ(motion.statistics().asleep, 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(world.position[i][2], 1.6);
}

}  // namespace
}  // namespace continuo::sleep_test
