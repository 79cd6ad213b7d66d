// The fast motion by more threads than there are processors: no two access the same data without synchronization, and
// the results are those of one thread.
#include <gtest/gtest.h>
#include <tests/bodies/heaps.hpp>

namespace continuo {
namespace {

TEST(Threads, ShareAHeap) {
  expect_the_same_for_any_number_of_threads(heap<float>(1000, 8, 1), {}, 45);
}

// With contact events, and with bodies that fall asleep.
TEST(Threads, ShareAMixedHeap) {
  FastOptions<float> options;
  options.sleep_after = 0.3f;
  options.contact_events = 1000;
  expect_the_same_for_any_number_of_threads(mixed(heap<float>(1000, 8, 1)), options, 45);
}

// Boxes and balls in one heap, whose contacts are found and solved by other code.
TEST(Threads, ShareAHeapOfBoxes) {
  World<float, 3> world = heap<float>(100, 4, 1);
  for (int i = 0; i < 60; ++i) {
    const auto x = static_cast<float>(i % 4), y = static_cast<float>(i / 4 % 4), z = static_cast<float>(i / 16);
    ASSERT_TRUE(
        world.add({.shape = Box<float, 3>{{{0.8f, 0.8f, 0.8f}}}, .position = {{x + 0.8f, y + 0.8f, 10 + 1.2f * z}}}));
  }
  expect_the_same_for_any_number_of_threads(world, {}, 45);
}

}  // namespace
}  // namespace continuo
