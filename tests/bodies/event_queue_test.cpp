// The queue of events against a search through all of them.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/event_driven/event_queue.hpp>

namespace continuo::event_queue_test {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Repeatedly takes the first event and postpones it and some others by `wait`. Each must be the least of all by time,
/// then by number.
template <class Wait>
void gives_the_least(std::uint32_t count, int events, Wait&& wait) {
  std::mt19937 engine(3);
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0u);
  std::shuffle(numbers.begin(), numbers.end(), engine);
  EventQueue<double> queue(numbers);
  std::vector<double> times(count, never);
  for (std::uint32_t i = 0; i < count; ++i) queue.set(i, times[i] = wait(engine));
  for (int k = 0; k < events; ++k) {
    const auto least = [&] {
      std::uint32_t first = 0;
      for (std::uint32_t i = 1; i < count; ++i)
        if (times[i] < times[first] || (times[i] == times[first] && numbers[i] < numbers[first])) first = i;
      return first;
    }();
    ASSERT_EQ(queue.time(), times[least]) << k;
    if (times[least] == never) return;
    ASSERT_EQ(queue.first(), least) << k;
    const double now = times[least];
    queue.set(least, times[least] = now + wait(engine));
    for (int others = 0; others < 2; ++others) {
      const auto i = static_cast<std::uint32_t>(engine() % count);
      queue.set(i, times[i] = now + wait(engine));
    }
  }
}

TEST(EventQueue, GivesTheLeastOfExponentialTimes) {
  std::exponential_distribution<double> exponential;
  gives_the_least(200, 5000, [&](auto& engine) { return exponential(engine); });
}
TEST(EventQueue, GivesEqualTimesByNumber) {
  gives_the_least(50, 5000, [](auto& engine) { return static_cast<double>(engine() % 3); });
}
TEST(EventQueue, GivesTheLeastOfTimesOfAllSizes) {
  gives_the_least(50, 5000, [](auto& engine) {
    return engine() % 20 == 0 ? never : std::ldexp(1.0, static_cast<int>(engine() % 2000) - 1000);
  });
}
TEST(EventQueue, OfNobodyHasNoEvent) {
  EventQueue<double> queue;
  EXPECT_EQ(queue.time(), never);
}

}  // namespace
}  // namespace continuo::event_queue_test
