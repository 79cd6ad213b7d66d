// Contacts of bodies that turn far in a step: nothing but motors and springs gives energy, and nobody gets stuck.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::turning_contacts_test {
namespace {

constexpr double g = 9.81;

template <int Dim>
[[nodiscard]] double energy(const World<double, Dim>& world) {
  double sum = kinetic_energy(world);
  for (std::size_t i = 0; i < world.size(); ++i)
    if (!world.is_fixed(i)) sum += world.mass[i] * g * world.position[i][Dim - 1];
  return sum;
}

/// By how much the energy of a body that falls on a floor, spinning about the vertical, rises at most after it was
/// less, relative to that of the beginning.
[[nodiscard]] double rise_of_energy(const Shape<double, 3>& shape, double spin, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> part(0, 1);
  auto world = test::world_on_slope<3>(0, part(engine));
  Orientation<double, 3> orientation;
  double square = 0;
  for (std::size_t k = 0; k < 4; ++k) orientation[k] = 2 * part(engine) - 1, square += orientation[k] * orientation[k];
  for (std::size_t k = 0; k < 4; ++k) orientation[k] /= std::sqrt(square);
  EXPECT_TRUE(world.add({.shape = shape,
                         .position = {{0, 0, 1}},
                         .orientation = orientation,
                         .spin = {{0.2 * spin, 0.1 * spin, spin}},
                         .mass = 1,
                         .material = world.walls()[0].material}));
  FastMotion<double, 3> motion(world);
  const double at_first = energy(world);
  double least = at_first, rise = 0;
  for (int step = 0; step < 300; ++step) {
    EXPECT_TRUE(motion.advance());
    least = std::min(least, energy(world)), rise = std::max(rise, energy(world) - least);
  }
  return rise / at_first;
}
// What is pushed out of a floor is lifted, which takes nothing of its motion: some thousandths of the energy. With the
// levers that contacts had when a step began, a capsule sank in and was pushed out all the time it spun, and its energy
// rose by up to four fifths.
TEST(TurningContacts, WhatSpinsOnAFloorGainsNoEnergy) {
  for (const double spin : {3.0, 10.0, 30.0})
    for (unsigned seed = 1; seed <= 8; ++seed) {
      for (const double radius : {0.05, 0.1, 0.3})
        EXPECT_LT(rise_of_energy(Capsule<double>{0.7, radius}, spin, seed), 0.01)
            << "radius " << radius << ", spin " << spin << ", seed " << seed;
      EXPECT_LT(rise_of_energy(Box<double, 3>{{{0.3, 0.5, 0.9}}}, spin, seed), 0.01) << spin << ", seed " << seed;
      EXPECT_LT(rise_of_energy(Box<double, 3>{{{0.3, 0.5, 0.9}}, 0.1}, spin, seed), 0.01) << spin << ", seed " << seed;
    }
}

/// A chain with humps of 0.3, from the right to the left.
[[nodiscard]] Chain<double> humps() {
  Chain<double> chain;
  for (int i = 300; i >= -300; --i) {
    const double x = 1.1 * i;
    chain.points.push_back({{x, 0.3 * std::sin(0.6 * x) * std::cos(0.2 * x)}});
  }
  return chain;
}
// A body that is deep in a mesh beside the direction of the facet that it turns into moves on: it was stopped at the
// beginning of each step, and hung in the air with a velocity that grew.
TEST(TurningContacts, NobodyHangsInAMesh) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> part(-1, 1);
    World<double, 2> world;
    world.gravity = {{0, -g}};
    ASSERT_TRUE(
        world.add_mesh({.shape = humps(), .material = {.restitution = 0, .friction = 0.4 + 0.4 * part(engine)}}));
    Hull<double, 2> hull;
    for (int k = 0; k < 8; ++k) hull.points.push_back({{0.5 * part(engine), 0.5 * part(engine)}});
    ASSERT_TRUE(
        world.add({.shape = seed % 2 == 0 ? Shape<double, 2>(hull) : Shape<double, 2>(Box<double, 2>{{{0.3, 0.9}}}),
                   .position = {{5 * part(engine), 1.2}},
                   .velocity = {{50 * part(engine), -25 + 25 * part(engine)}},
                   .orientation = {{3 * part(engine)}},
                   .spin = {{10 * part(engine)}},
                   .mass = 1}));
    FastMotion<double, 2> motion(world);
    int held = 0;
    for (int step = 0; step < 200; ++step) {
      const auto before = world.position[0];
      ASSERT_TRUE(motion.advance());
      const double way = length(Vector<double, 2>(world.position[0] - before)), speed = length(world.velocity[0]);
      held = speed > 0.5 && way < 0.01 * speed * motion.options().step ? held + 1 : 0;
      ASSERT_LT(held, 5) << "seed " << seed << ", step " << step;
    }
  }
}

}  // namespace
}  // namespace continuo::turning_contacts_test
