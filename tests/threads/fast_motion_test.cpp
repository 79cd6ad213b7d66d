// The fast motion by more threads than there are processors: no two touch the same without waiting for each other, and
// the results are those of one.
#include <cstdint>
#include <random>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <continuo/bodies/fast_motion.hpp>

namespace continuo {
namespace {

World<float, 3> heap(int count, int side) {
  World<float, 3> world;
  world.gravity = {{0, 0, -9.81f}};
  const Material<float> material{.restitution = 0, .friction = 0.5f};
  const float edge = 1.1f * static_cast<float>(side) + 1;
  EXPECT_EQ(world.add_container({}, {{edge, edge, 1000}}, material), "");
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> jitter(-0.04f, 0.04f);
  for (int i = 0; i < count; ++i) {
    const auto at = [&](int k, float spacing) { return 1 + spacing * static_cast<float>(k); };
    EXPECT_TRUE(world.add({.position = {{at(i % side, 1.1f) + jitter(engine),
                                         at(i / side % side, 1.1f) + jitter(engine), at(i / side / side, 1.02f)}},
                           .material = material}));
  }
  return world;
}

void expect_the_same_for_any_number_of_threads(const World<float, 3>& start, FastOptions<float> options) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  std::uint64_t expected = 0;
  for (const int threads : {1, 2, 4, 7}) {
    World<float, 3> world = start;
    options.threads = threads;
    FastMotion<float, 3> motion(world, options);
    for (int step = 0; step < 45; ++step) ASSERT_EQ(motion.advance(), "");
    EXPECT_GT(motion.statistics().contacts, world.size());
    if (threads == 1) expected = state_hash(world);
    EXPECT_EQ(state_hash(world), expected) << threads;
  }
}

TEST(Threads, ShareAHeap) {
  expect_the_same_for_any_number_of_threads(heap(1000, 8), {});
}

// Bounces, rolling resistance, a fixed ball, a force, contacts that are told of, and bodies that sleep.
TEST(Threads, ShareAMixedHeap) {
  World<float, 3> world = heap(1000, 8);
  world.material[17] = {.restitution = 0.5f, .friction = 0.3f, .rolling_resistance = 0.1f};
  ASSERT_TRUE(world.add({.shape = Sphere<float>{2.0f}, .position = {{5, 5, -1}}, .fixed = true}));
  world.drag.linear = 0.01f;
  FastOptions<float> options;
  options.sleep_after = 0.3f;
  options.contact_events = 1000;
  expect_the_same_for_any_number_of_threads(world, options);
}

}  // namespace
}  // namespace continuo
