// Random worlds of all shapes and joints that the exact motion knows: no overlap, by brute force in wider numbers, no
// energy from nowhere, and momentum where nothing is outside.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "exact_steps.hpp"
#include "exact_worlds.hpp"
#include <continuo/bodies/exact_motion.hpp>

namespace continuo::random_exact_motion_test {
namespace {

using namespace test;  // exact_worlds.hpp and exact_steps.hpp

struct Tally {
  std::size_t finished = 0, stopped = 0, touched = 0;
};

/// Each state after a call that succeeds is held against the laws. A millionth of a second first brings the velocities
/// of joined bodies together.
template <int Dim>
void try_one(unsigned seed, Tally& tally, bool may_rub = Dim == 2) {
  SCOPED_TRACE(std::to_string(Dim) + " dimensions, seed " + std::to_string(seed));
  ExactWorld<Dim> made(seed, seed % 2 == 0, may_rub);
  World<double, Dim>& world = made.world;
  const ExactWorldKind& kind = made.kind;
  ExactMotion<double, Dim> motion(world, {.most_events = 5000});  // some worlds have no end of bounces
  if (!motion.advance_to(1e-6)) {
    ++tally.stopped;
    return;
  }
  const double first = energy(world);
  const double scale = kinetic_energy(world) + kind.gravity * 5 * static_cast<double>(world.size());
  const auto momentum_before = momentum(world);
  double before = first;
  for (int k = 1; k <= 20; ++k) {
    const Status status = motion.advance_to(0.1003 * k);
    if (!status) {
      EXPECT_GT(status.message.size(), 10u);
      ++tally.stopped;
      return;
    }
    const double depth = made.depth(), now = energy(world);
    ASSERT_TRUE(std::isfinite(now));
    ASSERT_LT(depth, 1e-9) << "at " << world.time;
    ASSERT_LT(now - before, 1e-9 * scale) << "at " << world.time;
    if (kind.restitution == 1 && kind.friction == 0) {
      ASSERT_NEAR(now, first, 1e-9 * scale);
    }
    if (!kind.has_walls) {
      ASSERT_LT(length(momentum(world) - momentum_before), 1e-11 * (1 + length(momentum_before)));
    }
    before = now;
    tally.touched += depth > -1e-9 ? 1u : 0u;
  }
  ++tally.finished;
}
/// Nearly all go on to the end: what ends before says why.
void try_many(unsigned first, unsigned end) {
  Tally tally;
  for (unsigned seed = first; seed < end; ++seed) {
    try_one<2>(seed, tally);
    try_one<3>(seed, tally);
  }
  EXPECT_GT(tally.finished, 4 * tally.stopped);
  EXPECT_GT(tally.touched, tally.finished);
}
/// Worlds of space of which half have friction.
void try_many_that_rub(unsigned first, unsigned end) {
  Tally tally;
  for (unsigned seed = first; seed < end; ++seed) try_one<3>(seed, tally, true);
  EXPECT_GT(tally.finished, 4 * tally.stopped);
  EXPECT_GT(tally.touched, tally.finished);
}
TEST(RandomExactMotion, KeepsTheLawsWithFrictionInSpace) {
  try_many_that_rub(3000, 3004);
}
TEST(RandomExactMotion, KeepsTheLawsWithFrictionInMoreWorldsOfSpace) {
  try_many_that_rub(4000, 4024);
}
TEST(RandomExactMotion, KeepsTheLaws) {
  try_many(1000, 1012);
}
TEST(RandomExactMotion, KeepsTheLawsInMoreWorlds) {
  try_many(2000, 2040);
}

}  // namespace
}  // namespace continuo::random_exact_motion_test
