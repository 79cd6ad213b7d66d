// How often the fast motion rebuilds its lists of pairs.
#include <cstddef>

#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>

namespace continuo::broad_phase_test {
namespace {

// A single fast ball among many at rest searches for neighbours by itself. All pairs are not listed anew on its
// account, which at a speed of 6 and a skin of 0.11 would be every other step. Balls that it passes stay at rest; the
// ball that it hits does not.
TEST(FastMotion, ListsPairsAnewForFewThatAreFastNoOftenerThanTheyReach) {
  for (const bool is_last : {false, true}) {  // it finds the others on either side of its place
    World<double, 3> world;
    const auto add_fast = [&] { EXPECT_TRUE(world.add({.position = {{0, 0, 1.2}}, .velocity = {{6, 0, 0}}})); };
    if (!is_last) add_fast();
    for (int i = 0; i < 400; ++i) ASSERT_TRUE(world.add({.position = {{(i % 20) * 1.5, (i / 20) * 1.5, 0}}}));
    ASSERT_TRUE(world.add({.position = {{5.5, 0.3, 1.2}}}));
    if (is_last) add_fast();
    FastMotion<double, 3> motion(world);
    for (int step = 0; step < 60; ++step) ASSERT_TRUE(motion.advance());
    EXPECT_LE(motion.statistics().lists, 10u);
    const std::size_t met = is_last ? 400 : 401;
    EXPECT_GT(length(world.velocity[met]), 1);
    for (std::size_t i = 0; i < world.size(); ++i)
      if (i != met && i != (is_last ? 401 : 0)) {
        EXPECT_EQ(length(world.velocity[i]), 0) << i;
      }
  }
}

}  // namespace
}  // namespace continuo::broad_phase_test
