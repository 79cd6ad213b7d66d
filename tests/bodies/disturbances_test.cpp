// The contacts that the fast motion solves again: the three balls of docs/contact_solver.md, and neighbouring blocks.
#include <cstdint>

#include <gtest/gtest.h>

#include <continuo/bodies/contact_solver/disturbances.hpp>

namespace continuo::disturbances_test {
namespace {

TEST(Disturbances, OfThreeBallsEachHasABit) {
  const ContactBlocks blocks = ContactBlocks::of(3, 1);
  ASSERT_EQ(blocks.count, 1u);
  ASSERT_EQ(blocks.half, 2u);
  EXPECT_EQ(blocks.bit_of(0, 0) | blocks.bit_of(0, 1), 0b11u);
  EXPECT_EQ(blocks.bit_of(0, 2), std::uint64_t{1} << 32);
}

// Sweeps 2 to 5 of the example: the contact of balls 1 and 2 stays disturbed to the end, that of balls 2 and 3 until
// sweep 3.
TEST(Disturbances, AreThoseOfTheLastSweepAndOfThisOne) {
  const ContactBlocks blocks = ContactBlocks::of(3, 1);
  Disturbances disturbances;
  disturbances.resize(3, blocks);
  const std::uint64_t of_ball_2 = blocks.bit_of(0, 2);
  for (const std::uint32_t ball : {0u, 1u, 2u}) disturbances.mark(ball, 2);
  EXPECT_TRUE(disturbances.any_now());
  for (const std::uint8_t sweep : {std::uint8_t{3}, std::uint8_t{4}}) {
    disturbances.begin_sweep(0);
    EXPECT_FALSE(disturbances.any_now());
    EXPECT_EQ((disturbances.bins(0) & of_ball_2) != 0, sweep == 3);
    for (const std::uint32_t ball : {0u, 1u}) disturbances.mark(ball, sweep);
  }
  disturbances.begin_sweep(0);
  EXPECT_EQ(disturbances.bins(0), 0b11u);
  EXPECT_EQ(disturbances.sweep_of(1), 4);
  EXPECT_EQ(disturbances.sweep_of(2), 2);
  EXPECT_FALSE(disturbances.any_now());
  disturbances.begin_sweep(0);
  EXPECT_EQ(disturbances.bins(0), 0u);
}

// A body in the second half of block 0 takes part in contacts within block 0 and across its end, and in no others.
TEST(Disturbances, ReachTheGroupsThatMeetTheirHalf) {
  const ContactBlocks blocks = ContactBlocks::of(1000, 10);
  ASSERT_GE(blocks.count, 3u);
  Disturbances disturbances;
  disturbances.resize(1000, blocks);
  const std::uint32_t body = blocks.half + 5;
  disturbances.mark(body, 1);
  EXPECT_EQ(disturbances.bins(0), blocks.bit_of(0, body));
  EXPECT_EQ(disturbances.bins(blocks.across(0)), blocks.bit_of(blocks.across(0), body));
  EXPECT_EQ(disturbances.bins(1), 0u);
  EXPECT_EQ(disturbances.bins(blocks.across(1)), 0u);
  EXPECT_EQ(disturbances.bins(blocks.rest()), ~std::uint64_t{0});  // few bins: each is tested by itself
  EXPECT_TRUE(disturbances.any_from(0));
  EXPECT_TRUE(disturbances.any_from(1));
  EXPECT_FALSE(disturbances.any_from(2));
  disturbances.forget(0, 1000);
  EXPECT_EQ(disturbances.bins(0), 0u);
  EXPECT_EQ(disturbances.sweep_of(body), 0);
}

}  // namespace
}  // namespace continuo::disturbances_test
