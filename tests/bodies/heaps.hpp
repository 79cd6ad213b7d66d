// Heaps for tests of the fast motion, and a test that any number of threads moves them identically.
#pragma once
#include <cstddef>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <continuo/bodies/fast_motion.hpp>

namespace continuo {

/// Layers of side x side balls above the floor of a container.
template <class Real>
World<Real, 3> heap(int count, int side, std::uint32_t seed) {
  World<Real, 3> world;
  world.reserve(static_cast<std::size_t>(count));
  world.gravity = {{0, 0, Real(-9.81)}};
  EXPECT_TRUE(
      world.add_container({}, {{static_cast<Real>(1.15 * side + 0.25), static_cast<Real>(1.15 * side + 0.25), 1000}}));
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  for (int i = 0; i < count; ++i) {
    const double x = 0.7 + 1.15 * (i % side) + uniform(engine), y = 0.7 + 1.15 * (i / side % side) + uniform(engine);
    const double z = 1.0 + 1.2 * (i / side / side);
    EXPECT_TRUE(world.add({.position = {{static_cast<Real>(x), static_cast<Real>(y), static_cast<Real>(z)}}}));
  }
  return world;
}

/// Restitution, rolling resistance, a fixed ball and a force, whose code a plain heap does not run.
inline World<float, 3> mixed(World<float, 3> world) {
  world.material[17] = {.restitution = 0.5f, .friction = 0.3f, .rolling_resistance = 0.1f};
  EXPECT_TRUE(world.add({.shape = Sphere<float>{2.0f}, .position = {{5, 5, 2}}, .fixed = true}));
  world.drag.linear = 0.01f;
  return world;
}

/// More threads than the machine may have, so that loops are really cut in so many parts.
inline void expect_the_same_for_any_number_of_threads(const World<float, 3>& start, FastOptions<float> options,
                                                      int steps) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  std::uint64_t expected = 0;
  for (const int threads : {1, 2, 4, 7}) {
    World<float, 3> world = start;
    options.threads = threads;
    FastMotion<float, 3> motion(world, options);
    for (int step = 0; step < steps; ++step) ASSERT_TRUE(motion.advance());
    EXPECT_GT(motion.statistics().contacts, world.size());
    if (threads == 1) expected = state_hash(world);
    EXPECT_EQ(state_hash(world), expected) << threads;
  }
}

}  // namespace continuo
