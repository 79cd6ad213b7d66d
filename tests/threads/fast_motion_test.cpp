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

}  // namespace
}  // namespace continuo
