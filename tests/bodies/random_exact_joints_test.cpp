// Random worlds whose joints have limits and springs, in the exact motion: no limit is passed, no body lies in another,
// joints hold, and the energy with that of the springs does not grow.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "exact_joint_worlds.hpp"
#include <continuo/bodies/exact_motion.hpp>

namespace continuo::random_exact_joints_test {
namespace {

using namespace test;  // exact_joint_worlds.hpp

struct Tally {
  std::size_t finished = 0, stopped = 0, at_limits = 0;
};

template <int Dim>
void try_one(unsigned seed, Tally& tally) {
  SCOPED_TRACE(std::to_string(Dim) + " dimensions, seed " + std::to_string(seed));
  ExactJointWorld<Dim> made(seed, seed % 2 == 0);
  World<double, Dim>& world = made.world;
  ExactMotion<double, Dim> motion(world, {.most_events = 3000});  // some worlds have no end of bounces
  const auto energy = [&] { return kinetic_energy(world) + potential_energy(world) + made.energy_of_springs(); };
  // At first the velocities of joined bodies are brought together.
  Status status = motion.advance_to(1e-6);
  double before = energy();
  const double scale =
      kinetic_energy(world) + made.kind.gravity * 5 * static_cast<double>(world.size()) + made.energy_of_springs();
  for (int k = 1; k <= 20 && status; ++k) {
    status = motion.advance_to(0.1003 * k);
    // Also where the motion ends with an error, the world is as it was then.
    const double now = energy();
    ASSERT_TRUE(std::isfinite(now));
    ASSERT_LT(made.depth(), 1e-9) << "at " << world.time;
    ASSERT_LT(now - before, 1e-9 * scale) << "at " << world.time;
    before = now;
    for (const auto& one : made.driven) {
      ASSERT_LT(made.beyond(one), 1e-9) << "at " << world.time;
      ASSERT_LT(made.error(one), 1e-9) << "at " << world.time;
      if (made.beyond(one) > -1e-9) ++tally.at_limits;
    }
  }
  EXPECT_TRUE(status || status.message.size() > 10);
  ++(status ? tally.finished : tally.stopped);
}
/// Nearly all go on to the end, and many joints come to their limits.
void try_many(unsigned first, unsigned end) {
  Tally tally;
  for (unsigned seed = first; seed < end; ++seed) {
    try_one<2>(seed, tally);
    try_one<3>(seed, tally);
  }
  EXPECT_GT(tally.finished, 4 * tally.stopped);
  EXPECT_GT(tally.at_limits, tally.finished);
}
TEST(RandomExactJoints, KeepTheirLimits) {
  try_many(100, 114);
}

}  // namespace
}  // namespace continuo::random_exact_joints_test
