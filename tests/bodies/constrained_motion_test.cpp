// Exact collisions under forces whose paths are no parabolas, against closed forms and against the motion on parabolas.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/snapshot.hpp>

namespace continuo::constrained_motion_test {
namespace {

const Material<double> elastic{.restitution = 1, .friction = 0};

// The distance s of two balls of mass m on a spring: s'' = -2 k / m s, from 3 down to 1, where they touch. The path is
// followed to 1e-10 a step, some hundred steps; errors of a phase grow with time, by ten bounces here.
TEST(ConstrainedMotion, TwoBallsOnASpringBounce) {
  World<double, 3> world;
  const auto a = world.add({.position = {{-1.5, 2, 0}}, .mass = 2, .material = elastic});
  const auto b = world.add({.position = {{1.5, 2, 0}}, .mass = 2, .material = elastic});
  world.springs.push_back({.a = *a, .b = *b, .stiffness = 9});
  const double bounce = std::acos(1.0 / 3) / 3;  // omega = sqrt(2 * 9 / 2)
  ExactMotion motion(world, {.contact_events = 100});
  for (int k = 1; k <= 10; ++k) {
    ASSERT_TRUE(motion.advance_to(2 * k * bounce));
    ASSERT_EQ(motion.contact_events().size(), 1u);
    EXPECT_NEAR(motion.contact_events()[0].time, (2 * k - 1) * bounce, 1e-8);
    // Twice the reduced mass, 1, times the speed 3 sqrt(9 - 1).
    EXPECT_NEAR(motion.contact_events()[0].impulse, 2 * 3 * std::sqrt(8.0), 1e-7);
    EXPECT_NEAR(length(world.position[1] - world.position[0]), 3, 1e-7);
  }
}

// m y'' = -m g - c y' from rest at height h: y = h - g t / k + g (1 - exp(-k t)) / k^2 with k = c / m.
TEST(ConstrainedMotion, AFallWithDragHitsWhenItShould) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  world.drag.linear = 1;
  ASSERT_TRUE(world.add_wall({}));
  ASSERT_TRUE(world.add({.position = {{0, 20.5}}, .mass = 2, .material = {.restitution = 0.5, .friction = 0}}));
  ExactMotion motion(world, {.contact_events = 1});
  ASSERT_TRUE(motion.advance_to(3));
  ASSERT_EQ(motion.contact_events().size(), 1u);
  const double k = 0.5, t = motion.contact_events()[0].time;
  const double fallen = 10 * t / k - 10 * (1 - std::exp(-k * t)) / (k * k), speed = 10 * (1 - std::exp(-k * t)) / k;
  EXPECT_NEAR(fallen, 20, 1e-8);
  EXPECT_NEAR(motion.contact_events()[0].impulse, 1.5 * 2 * speed, 1e-8);
}

// With a force law that adds nothing the paths are parabolas: both motions must agree. Collisions of balls multiply an
// error by some ten each: six in a row make 1e-4 of 1e-10.
TEST(ConstrainedMotion, AgreesWithTheMotionOnParabolas) {
  World<double, 3> world;
  world.gravity = {{0, 0, -5}};
  ASSERT_TRUE(world.add_container({}, {{5, 5, 5}}, elastic));
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 27; ++i)
    ASSERT_TRUE(world.add({.shape = Sphere<double>{0.4},
                           .position = {{1 + 1.5 * (i % 3), 1 + 1.5 * (i / 3 % 3), 1 + 1.5 * (i / 9)}},
                           .velocity = {{2 * uniform(engine), 2 * uniform(engine), 2 * uniform(engine)}},
                           .spin = {{uniform(engine), 0, 1}},
                           .fixed = i == 13,
                           .material = {.restitution = 0.9, .friction = 0.2}}));
  World<double, 3> forced = world;
  forced.force_laws.emplace_back([](const auto&, double, auto, auto, auto) {});
  ExactMotion on_parabolas(world), by_steps(forced);
  ASSERT_TRUE(on_parabolas.advance_to(1));
  ASSERT_TRUE(by_steps.advance_to(1));
  EXPECT_GT(on_parabolas.statistics().collisions, 10u);
  EXPECT_EQ(on_parabolas.statistics().collisions, by_steps.statistics().collisions);
  EXPECT_EQ(on_parabolas.statistics().wall_collisions, by_steps.statistics().wall_collisions);
  for (std::size_t i = 0; i < world.size(); ++i) {
    EXPECT_LT(length(world.position[i] - forced.position[i]), 1e-4) << i;
    EXPECT_LT(length(world.spin[i] - forced.spin[i]), 1e-3) << i;
    EXPECT_LT(length(world.orientation[i] - forced.orientation[i]), 1e-3) << i;
  }
}

// Bounces that pile up end on the floor, by flights of the contact time.
TEST(ConstrainedMotion, ABallComesToLieUnderDrag) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  world.drag.quadratic = 0.1;
  ASSERT_TRUE(world.add_wall({}));
  ASSERT_TRUE(world.add({.position = {{0, 2}}, .material = {.restitution = 0.5, .friction = 0}}));
  ExactMotion motion(world, {.contact_time = 1e-2});
  ASSERT_TRUE(motion.advance_to(4));
  EXPECT_GT(world.position[0][1], 0.5 - 1e-12);
  EXPECT_LT(world.position[0][1], 0.5 + 10 * 1e-4 / 2);  // the last bounce that was its own rises by g tc^2 / 2 at most
  EXPECT_LT(motion.statistics().wall_collisions, 500u);
}

TEST(ConstrainedMotion, GoesOnFromASnapshotToTheSameBits) {
  World<double, 2> world, again;
  world.gravity = {{0, -10}};
  world.attraction = {.constant = 5, .softening = 0.1};
  ASSERT_TRUE(world.add_wall({}));
  for (int i = 0; i < 6; ++i)
    ASSERT_TRUE(world.add({.position = {{1.2 * i, 1 + 0.3 * i}}, .material = {.restitution = 0.9, .friction = 0.1}}));
  ExactMotion motion(world), motion_again(again);
  ASSERT_TRUE(motion.advance_to(0.5));
  ASSERT_TRUE(restore(snapshot(world, motion), again, motion_again));
  ASSERT_TRUE(motion.advance_to(1));
  ASSERT_TRUE(motion_again.advance_to(1));
  EXPECT_EQ(snapshot(world, motion), snapshot(again, motion_again));
  EXPECT_GT(motion.statistics().collisions, 2u);
}

// A heavy disc on a row of light ones: it lies on them, or the run says that it cannot go on. A disc of 10,000 times
// their mass sank by 0.2 in a minute before.
TEST(ConstrainedMotion, AHeavyDiscDoesNotSinkInSilence) {
  for (const double mass : {1e3, 1e4, 1e7}) {
    World<double, 2> world;
    world.gravity = {{0, -9.81}};
    const Material<double> rough{.friction = 0.3};
    ASSERT_TRUE(world.add_container({{-3.2, 0}}, {{3.2, 40}}, rough));
    for (int i = 0; i < 6; ++i)
      ASSERT_TRUE(world.add({.position = {{-2.6 + 1.04 * i, 0.5}}, .mass = 1, .material = rough}));
    ASSERT_TRUE(world.add({.shape = Sphere<double>{1}, .position = {{0.1, 2.3}}, .mass = mass, .material = rough}));
    ExactMotion motion(world);
    Status status;
    for (int k = 1; k <= 8 && status; ++k) {
      status = motion.advance_to(0.25 * k);
      double deepest = 0;
      for (std::size_t i = 0; i < world.size(); ++i)
        for (std::size_t j = i + 1; j < world.size(); ++j)
          deepest =
              std::max(deepest, world.radius[i] + world.radius[j] - length(world.position[i] - world.position[j]));
      EXPECT_LT(deepest, status ? 1e-4 : 1e-2) << mass;
    }
    if (mass < 1e5) {
      EXPECT_TRUE(status) << status.message;
    }
    if (!status) {
      EXPECT_TRUE(status.message.find("sink into each other") != std::string::npos ||
                  status.message.find("were not found") != std::string::npos)
          << status.message;
    }
  }
}

// A light ball between a wall and a heavy one that is 10^2n times as heavy: they strike each other as often as the
// first digits of pi say, all at one instant (G. Galperin, Regul. Chaotic Dyn. 8, 2003). The heavy one leaves as fast
// as it came, or the run says that it cannot go on: after 256 rounds it went on in silence, with a fifth of the energy.
void expect_digits_of_pi(double mass, std::size_t collisions) {
  World<double, 2> world;
  world.drag.linear = 1e-12;
  const Material<double> lossless{.restitution = 1, .friction = 0};
  ASSERT_TRUE(world.add_wall({.normal = {{1, 0}}, .material = lossless}));
  ASSERT_TRUE(world.add({.position = {{0.5, 0}}, .mass = 1, .material = lossless}));
  ASSERT_TRUE(world.add({.position = {{1.5, 0}}, .velocity = {{-1, 0}}, .mass = mass, .material = lossless}));
  ExactMotion motion(world);
  const Status status = motion.advance_to(1);
  const auto& statistics = motion.statistics();
  if (collisions == 0) {
    EXPECT_EQ(status.ending, Ending::cannot_continue);
    EXPECT_NE(status.message.find("the impulses of the collision at t = 0.000000 of bodies 0, 1 were not found"),
              std::string::npos)
        << status.message;
    return;
  }
  ASSERT_TRUE(status) << status.message;
  EXPECT_EQ(statistics.collisions + statistics.wall_collisions, collisions);
  const double energy = mass * squared(world.velocity[1]) + squared(world.velocity[0]);
  EXPECT_NEAR(energy, mass, 1e-10 * mass);  // rounding, thousands of times
}
TEST(ConstrainedMotion, ManyCollisionsOfOneInstantEndAsTheyShouldOrWithAMessage) {
  expect_digits_of_pi(1e4, 314), expect_digits_of_pi(1e6, 3141);
  expect_digits_of_pi(1e10, 0);
}

}  // namespace
}  // namespace continuo::constrained_motion_test
