// Inelastic collapse: without forces, dissipative collisions may accumulate without end. Each one counts, and an
// endless sequence is ended by simultaneous impulses at all touching contacts.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

#include <bench/bodies/overlap.hpp>
#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>

namespace continuo::inelastic_collapse_test {
namespace {

/// One ball approaches at speed 1 a row of `count` - 1 others with gaps of `gap`; the last one leaves.
template <int Dim>
World<double, Dim> cradle(std::size_t count, double restitution, double gap) {
  World<double, Dim> world;
  for (std::size_t i = 0; i < count; ++i) {
    BodyDefinition<double, Dim> ball{.material = {.restitution = restitution}};
    ball.position[0] = static_cast<double>(i) * (1 + gap) + (i == 0 ? 0 : 0.5);
    ball.velocity[0] = i == 0 ? 1 : 0;
    EXPECT_TRUE(world.add(ball));
  }
  return world;
}

// Each ball passes on (1 + e)/2 of the speed it receives, touching or not.
TEST(InelasticCollapse, ACradleThatLosesEnergySendsOutWhatOneAfterAnotherHandOn) {
  for (const double restitution : {0.9, 0.6})
    for (const double gap : {0.0, 1e-12, 1e-9, 1e-6, 1e-3}) {
      auto world = cradle<2>(5, restitution, gap);
      ExactMotion motion(world);
      ASSERT_TRUE(motion.advance_to(2.0));
      EXPECT_NEAR(world.velocity[4][0], std::pow((1 + restitution) / 2, 4), 1e-13) << restitution << " " << gap;
      EXPECT_NEAR(momentum(world)[0], momentum(cradle<2>(5, restitution, gap))[0], 1e-14);
    }
  auto world = cradle<3>(12, 0.9, 0);
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(2.0));
  EXPECT_NEAR(world.velocity[11][0], std::pow(0.95, 11), 1e-13);
}

// Without restitution all move on together, with the initial momentum.
TEST(InelasticCollapse, WhatDoesNotBounceGoesOnTogether) {
  for (const double gap : {0.0, 1e-9, 1e-3}) {
    auto world = cradle<2>(10, 0, gap);
    ExactMotion motion(world);
    ASSERT_TRUE(motion.advance_to(20.0));
    for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(world.velocity[i][0], 0.1, 1e-13) << gap << " " << i;
    EXPECT_LT(motion.statistics().collisions, 1000u);
  }
}

/// A row of balls that flies into a wall at speed 1.
World<double, 2> row(std::size_t count, double restitution, double gap) {
  World<double, 2> world;
  Wall<double, 2> wall{.material = {.restitution = restitution}};
  EXPECT_TRUE(world.add_wall(wall));
  for (std::size_t i = 0; i < count; ++i) {
    BodyDefinition<double, 2> ball{.material = wall.material};
    ball.position[1] = 1 + static_cast<double>(i) * (1 + gap);
    ball.velocity[1] = -1;
    EXPECT_TRUE(world.add(ball));
  }
  return world;
}

// Each ball stops the one behind it: none returns from the wall. In an earlier version the last one returned with its
// full speed.
TEST(InelasticCollapse, WhatFliesIntoAWallTogetherWithoutRestitutionStopsThere) {
  for (const std::size_t count : {2u, 3u, 20u})
    for (const double gap : {0.0, 1e-7}) {
      auto world = row(count, 0, gap);
      ExactMotion motion(world);
      ASSERT_TRUE(motion.advance_to(10.0));
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_NEAR(world.velocity[i][1], 0, 1e-13) << count << " " << gap << " " << i;
        EXPECT_NEAR(world.position[i][1], 0.5 + static_cast<double>(i), static_cast<double>(i) * gap + 1e-12);
      }
    }
}

// More than two hundred collisions of a ball at one instant are computed like any others: the same velocities result
// from rounds until no pair approaches, each with all pairs that do, whose impulses are found by plain sweeps.
TEST(InelasticCollapse, ManyCollisionsAtOneInstantAreEachAsAnyOther) {
  constexpr std::size_t count = 20;
  constexpr double restitution = 0.9;
  std::vector<double> v(count, -1);
  const auto parting = [&](std::size_t i) { return i == 0 ? v[0] : v[i] - v[i - 1]; };  // of ball i and what is below
  std::size_t collisions = 0;
  while (true) {
    std::vector<double> asked(count, -1), impulse(count, 0);
    bool acts = false;
    for (std::size_t i = 0; i < count; ++i)
      if (parting(i) < -3e-15) asked[i] = -restitution * parting(i), acts = true, ++collisions;
    if (!acts) break;
    for (int sweep = 0; sweep < 2000; ++sweep)
      for (std::size_t i = 0; i < count; ++i) {
        if (asked[i] < 0) continue;
        const double more = std::max((asked[i] - parting(i)) / (i == 0 ? 1 : 2), -impulse[i]);
        impulse[i] += more, v[i] += more;
        if (i > 0) v[i - 1] -= more;
      }
  }
  ASSERT_GT(collisions, 200u);
  auto world = row(count, restitution, 0);
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(1.0));
  for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(world.velocity[i][1], v[i], 1e-12) << i;
}

/// Balls that fly towards one place.
template <int Dim>
World<double, Dim> implosion(std::size_t count, Material<double> material) {
  World<double, Dim> world;
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto side = static_cast<std::size_t>(std::ceil(std::pow(static_cast<double>(count), 1.0 / Dim)));
  for (std::size_t i = 0; i < count; ++i) {
    BodyDefinition<double, Dim> ball{.material = material};
    std::size_t rest = i;
    for (std::size_t axis = 0; axis < Dim; ++axis, rest /= side) {
      ball.position[axis] =
          (static_cast<double>(rest % side) - static_cast<double>(side) / 2) * 1.5 + 0.2 * uniform(engine);
      ball.velocity[axis] = -0.3 * ball.position[axis] + 0.05 * uniform(engine);
    }
    EXPECT_TRUE(world.add(ball));
  }
  return world;
}

// The balls collapse into a cluster. Momentum and angular momentum are conserved, nothing overlaps, and the energy only
// falls. Friction acts on each ball at its own surface although the two are a gap apart: up to the distance of flight
// in the contact time, 1e-5 of the radius at the greatest speed of all. That gap is the lever in the bound on the
// angular momentum.
template <int Dim>
void collapses(std::size_t count, Material<double> material) {
  auto world = implosion<Dim>(count, material);
  ExactMotion motion(world, {.most_events = 2'000'000, .contact_events = 2'000'000});
  const auto before = momentum(world);
  const auto turning_before = angular_momentum(world);
  double energy = kinetic_energy(world);
  const double mass = std::accumulate(world.mass.begin(), world.mass.end(), 0.0), scale = std::sqrt(2 * energy * mass);
  double struck = 0;
  for (int k = 1; k <= 8; ++k) {
    ASSERT_TRUE(motion.advance_to(0.75 * k)) << material.restitution;
    EXPECT_LE(kinetic_energy(world), energy * (1 + 1e-12));
    energy = kinetic_energy(world);
    for (const auto& event : motion.contact_events()) struck += event.impulse;
    EXPECT_LT(deepest_overlap_of_bodies(world), 1e-12) << material.restitution << " " << k;
  }
  constexpr double lever = 2 * 1e-5 * 0.5;
  EXPECT_EQ(motion.lost_contact_events(), 0u);
  EXPECT_LT(length(momentum(world) - before), 1e-12 * scale);
  EXPECT_LT(length(angular_momentum(world) - turning_before), 1e-11 * scale + lever * material.friction * struck);
}
TEST(InelasticCollapse, AClumpThatCollapsesKeepsItsMomenta) {
  for (const double restitution : {0.0, 0.3, 0.7})
    for (const double friction : {0.0, 0.5}) collapses<2>(64, {.restitution = restitution, .friction = friction});
  collapses<3>(125, {.restitution = 0, .friction = 0.3});
  collapses<3>(125, {.restitution = 0.5});
}

}  // namespace
}  // namespace continuo::inelastic_collapse_test
