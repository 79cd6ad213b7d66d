// Islands of bodies in contact under gravity: each moves as it would alone, whatever else moves.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <bench/bodies/overlap.hpp>
#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo {
namespace {

using Flat = World<double, 2>;
using Space = World<double, 3>;

const Material<double> smooth{.restitution = 0, .friction = 0}, rough{.restitution = 0, .friction = 0.5},
    elastic{.restitution = 1, .friction = 0};

using Group = std::vector<BodyDefinition<double, 2>>;
/// Groups that never meet: a pyramid that collapses, one that is stable, a falling column, a ball that rolls down
/// another one, a ball in a groove, and one that bounces for ever.
std::array<Group, 6> groups() {
  const double up = 0.5 + std::sqrt(0.75);
  const Material<double> slippery{.restitution = 0, .friction = 0.1};
  return {Group{{.position = {{-0.5, 0.5}}, .material = slippery},
                {.position = {{0.5, 0.5}}, .material = slippery},
                {.position = {{0, up}}, .material = slippery}},
          Group{{.position = {{-0.5, 0.5}}, .material = rough},
                {.position = {{0.5, 0.5}}, .material = rough},
                {.position = {{0, up}}, .material = rough}},
          Group{{.position = {{0, 0.6}}, .material = rough},
                {.position = {{0, 1.7}}, .material = rough},
                {.position = {{0, 2.9}}, .material = rough}},
          Group{{.position = {{0, 0.5}}, .fixed = true, .material = rough},
                {.position = {{std::sin(0.1), 0.5 + std::cos(0.1)}}, .material = rough}},
          Group{{.position = {{-0.6, 3}}, .fixed = true, .material = rough},
                {.position = {{0.6, 3}}, .fixed = true, .material = rough},
                {.position = {{0.01, 4}}, .material = {.restitution = 0.5, .friction = 0.2}}},
          Group{{.position = {{0, 3}}, .material = elastic}}};
}
Flat world_of(const Group& group) {
  Flat world;
  world.gravity = {{0, -10}};
  EXPECT_TRUE(world.add_wall({.material = rough}));
  for (const auto& body : group) EXPECT_TRUE(world.add(body));
  return world;
}

// The radii are the same, and so are contact times and strides. The remaining difference is the rounding of larger
// coordinates, which the motions here amplify by some hundreds.
TEST(Islands, MoveAsAlone) {
  Group all;
  const auto parts = groups();
  std::vector<Flat> alone;
  for (std::size_t g = 0; g < parts.size(); ++g) {
    Group here = parts[g];
    for (auto& body : here) body.position[0] += 20.0 * static_cast<double>(g);
    alone.push_back(world_of(here));
    all.insert(all.end(), here.begin(), here.end());
  }
  Flat together = world_of(all);
  ExactMotion motion(together);
  std::vector<ExactMotion<double, 2>> motions;
  for (Flat& world : alone) motions.emplace_back(world);
  for (int k = 1; k <= 20; ++k) {
    ASSERT_TRUE(motion.advance_to(0.1 * k));
    std::size_t i = 0;
    for (std::size_t g = 0; g < alone.size(); ++g) {
      ASSERT_TRUE(motions[g].advance_to(0.1 * k)) << g;
      for (std::size_t j = 0; j < alone[g].size(); ++j, ++i) {
        EXPECT_LT(length(together.position[i] - alone[g].position[j]), 1e-7) << g << ' ' << k;
        EXPECT_LT(length(together.velocity[i] - alone[g].velocity[j]), 1e-6) << g << ' ' << k;
      }
    }
  }
}

/// A ball on a smaller one, one of the same mass that comes to it at a time of 0.5, horizontally, and another column.
Flat shot(double speed) {
  Flat world;
  world.gravity = {{0, -10}};
  EXPECT_TRUE(world.add_wall({.material = smooth}));
  for (const double x : {0.0, 30.0}) {
    EXPECT_TRUE(world.add({.shape = Sphere<double>{0.4}, .position = {{x, 0.4}}, .material = smooth}));
    EXPECT_TRUE(world.add({.position = {{x, 1.3}}, .mass = 1, .material = smooth}));
  }
  EXPECT_TRUE(world.add(
      {.position = {{-1 - 0.5 * speed, 1.3 - 10 * 0.125}}, .velocity = {{speed, 5}}, .mass = 1, .material = elastic}));
  return world;
}
// The shot stops, and the ball that was at rest flies off: it does not touch the one below, as speed^2 > g (0.5 + 0.4).
TEST(Islands, AreWokenByWhatHitsThem) {
  Flat world = shot(10);
  ExactMotion motion(world, {.contact_events = 100});
  ASSERT_TRUE(motion.advance_to(0.4));
  const auto other = world.position[3];
  ASSERT_TRUE(motion.advance_to(0.8));
  EXPECT_NEAR(world.position[1][0], 10 * 0.3, 1e-6);
  EXPECT_NEAR(world.position[1][1], 1.3 - 5 * 0.09, 1e-6);
  EXPECT_NEAR(world.position[4][0], -1, 1e-6);
  EXPECT_NEAR(world.position[4][1], 1.3 - 5 * 0.09, 1e-6);
  EXPECT_NEAR(world.position[0][0], 0, 1e-6);
  EXPECT_EQ(world.position[3], other);  // nothing has touched it
  double last = 0;
  for (const auto& event : motion.contact_events()) {
    EXPECT_GE(event.time, last);
    last = event.time;
    if (event.change != ContactChange::impact || !(event.impulse > 5)) continue;
    EXPECT_NEAR(event.time, 0.5, 1e-7);
    EXPECT_NEAR(event.impulse, 10, 1e-6);
    EXPECT_EQ(world.index(event.a), 1u);
    EXPECT_EQ(world.index(event.b), 4u);
  }
}

// A ball slides down a fixed one and another one hits it on its way, early or late: as if both moved by general forces,
// with an error of 1e-10 in each step.
TEST(Islands, GoBackToWhenSomebodyComes) {
  for (int k = 0; k < 8; ++k) {
    Flat world;
    world.gravity = {{0, -10}};
    ASSERT_TRUE(world.add({.shape = Sphere<double>{1}, .fixed = true, .material = smooth}));
    ASSERT_TRUE(world.add({.position = {{1.5 * std::sin(0.1), 1.5 * std::cos(0.1)}}, .mass = 1, .material = smooth}));
    ASSERT_TRUE(world.add({.position = {{3 + 0.2 * k, 1}},
                           .velocity = {{-6, 3}},
                           .mass = 1,
                           .material = {.restitution = 0.8, .friction = 0}}));
    Flat other = world;
    other.force_laws.emplace_back([](const auto&, double, auto, auto, auto) {});
    ExactMotion motion(world), of_other(other);
    ASSERT_TRUE(motion.advance_to(1));
    ASSERT_TRUE(of_other.advance_to(1));
    for (std::size_t i = 1; i < 3; ++i) EXPECT_LT(length(world.position[i] - other.position[i]), 1e-6) << k;
    EXPECT_LT(kinetic_energy(world) + potential_energy(world), 10 * 1.5 + 10 + 22.5 - 1);  // the two have met
  }
}

// Elastic balls in a box with one that rests on two others: the gas conserves its energy to rounding, which steps of
// first order would not.
TEST(Islands, LeaveWhatFliesOnItsParabolas) {
  Space world;
  world.gravity = {{0, 0, -10}};
  ASSERT_TRUE(world.add_container({}, {{20, 20, 20}}, elastic));
  world.combine_rule.restitution = Combine::minimum;
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 60; ++i)
    ASSERT_TRUE(world.add({.position = {{6 + 3.0 * (i % 4), 2 + 4.0 * (i / 4 % 4), 4 + 3.0 * (i / 16)}},
                           .velocity = {{uniform(engine), uniform(engine), uniform(engine)}},
                           .material = elastic}));
  for (const double z : {0.5, 1.6, 2.7})
    ASSERT_TRUE(world.add({.position = {{0.5, 0.5, z}}, .material = smooth, .group = 1}));
  EXPECT_TRUE(world.ignore(0, 1));
  const auto energy_of_gas = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < 60; ++i)
      sum += world.mass[i] * (squared(world.velocity[i]) / 2 + 10 * world.position[i][2]);
    return sum;
  };
  const double before = energy_of_gas();
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(5));
  EXPECT_GT(motion.statistics().collisions, 50u);
  EXPECT_NEAR(energy_of_gas() / before, 1, 1e-12);
  EXPECT_NEAR(world.position[62][2], 2.5, 4e-6);
}

/// Heaps in three places, and balls thrown at them.
template <int Dim>
World<double, Dim> battle(unsigned seed) {
  constexpr auto top = static_cast<std::size_t>(Dim - 1);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::array<double, 3> restitutions{0, 0.4, 0.8};
  World<double, Dim> world;
  world.gravity[top] = -9.81;
  Vector<double, Dim> upper;
  for (std::size_t axis = 0; axis < upper.size(); ++axis) upper[axis] = axis == 0 ? 14 : axis == top ? 100 : 3;
  EXPECT_TRUE(world.add_container({}, upper, rough));
  const auto add = [&](double x, double height, double speed) {
    const double r = 0.3 + 0.2 * uniform(engine);
    BodyDefinition<double, Dim> ball{.shape = Sphere<double>{r}, .material = {restitutions[seed % 3], 0.4}};
    for (std::size_t axis = 0; axis < top; ++axis) ball.position[axis] = r + (3 - 2 * r) * uniform(engine);
    ball.position[0] = x + 0.1 * uniform(engine);
    ball.position[top] = height;
    ball.velocity[0] = speed;
    EXPECT_TRUE(world.add(ball));
  };
  for (const double x : {2, 7, 12})
    for (int i = 0; i < 4; ++i) add(x, 0.6 + 1.05 * i, 0);
  for (int i = 0; i < 6; ++i) add(4.5 + 5 * (i % 2), 1 + 1.2 * i, 16 * uniform(engine) - 8);
  return world;
}
// No ball passes through another, no energy is created, and a snapshot taken on the way resumes to the same bits. The
// bounds are those of one heap, see resting_heaps_test.cpp.
template <int Dim>
void fights(unsigned seed) {
  World<double, Dim> world = battle<Dim>(seed), other;
  const auto energy = [&] { return kinetic_energy(world) + potential_energy(world); };
  double weight = 0;
  for (const double mass : world.mass) weight += 9.81 * mass;
  ExactMotion motion(world), of_other(other);
  double last = energy();
  for (int k = 1; k <= 12; ++k) {
    ASSERT_TRUE(restore(snapshot(world, motion), other, of_other));
    ASSERT_TRUE(motion.advance_to(0.1 * k)) << Dim << ' ' << seed;
    ASSERT_TRUE(of_other.advance_to(0.1 * k));
    ASSERT_EQ(state_hash(world), state_hash(other)) << Dim << ' ' << seed << ' ' << k;
    EXPECT_LT(deepest_overlap(world), 1e-5) << Dim << ' ' << seed << ' ' << k;
    EXPECT_LT(energy() - last, 1e-5 * weight) << Dim << ' ' << seed << ' ' << k;
    last = energy();
  }
}
TEST(Islands, MeetWithoutOverlapOrEnergyFromNowhere) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    fights<2>(seed);
    fights<3>(seed);
  }
}

}  // namespace
}  // namespace continuo
