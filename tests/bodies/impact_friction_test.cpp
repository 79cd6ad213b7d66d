// Friction in impacts of the fast motion in space: it stops the slip, or is as large as Coulomb's law lets it be.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>

namespace continuo::impact_friction_test {
namespace {

using V = Vector<double, 3>;

// A capsule without weight hits a floor with its lower end. In steps of 1/960 it turns by some milliradians, so that
// the impulse, the change of velocity times the mass of 1, acts at a point that is known. The limit of friction follows
// the normal impulse in some iterations, which leave a few hundredths.
struct Found {
  int slips = 0, sticks = 0, weak = 0;  // weak: the friction is below its limit though the point slips
};
void expect_coulombs_law(unsigned seed, double friction, Found& found) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  World<double, 3> world;
  const Material<double> material{.restitution = 0, .friction = friction};
  ASSERT_TRUE(world.add_wall({.normal = {{0, 0, 1}}, .material = material}));
  Orientation<double, 3> orientation;
  double square = 0;
  for (std::size_t k = 0; k < 4; ++k) orientation[k] = part(engine), square += orientation[k] * orientation[k];
  for (std::size_t k = 0; k < 4; ++k) orientation[k] /= std::sqrt(square);
  const V v{{2 * part(engine), 2 * part(engine), -3}}, spin{{part(engine), part(engine), part(engine)}};
  ASSERT_TRUE(world.add({.shape = Capsule<double>{0.6, 0.15},
                         .position = {{0, 0, 1}},
                         .velocity = v,
                         .orientation = orientation,
                         .spin = {{3 * spin[0], 3 * spin[1], 3 * spin[2]}},
                         .mass = 1,
                         .material = material}));
  FastMotion<double, 3> motion(world, {.step = 1.0 / 960});
  while (world.time < 1 && std::abs(world.velocity[0][2] - v[2]) < 0.1) ASSERT_TRUE(motion.advance());
  for (int k = 0; k < 2; ++k) ASSERT_TRUE(motion.advance());
  const V axis = rotation(world.orientation[0])[2], impulse = world.velocity[0] - v;
  if (!(impulse[2] > 0.1) || std::abs(axis[2]) < 0.2) return;  // both ends may have hit
  const V arm = axis * (axis[2] > 0 ? -0.3 : 0.3) + V{{0, 0, -0.15}};
  const V slip = world.velocity[0] + turning(world.spin[0], arm);
  const double along = std::hypot(impulse[0], impulse[1]), speed = std::hypot(slip[0], slip[1]);
  EXPECT_LE(along, friction * impulse[2] * 1.02) << "seed " << seed;
  const bool slips = speed > 0.2;
  ++(slips ? found.slips : found.sticks);
  found.weak += slips && along < 0.8 * friction * impulse[2] ? 1 : 0;
}
// Where the direction of the slip turns during the few substeps of an impact, the sum of its frictions is shorter than
// their limits together: that of one in ten is.
TEST(ImpactFriction, InSpaceStopsTheSlipOrHasTheCoulombLimit) {
  Found found;
  for (unsigned seed = 1; seed <= 100; ++seed)
    for (const double friction : {0.1, 0.3, 0.5}) expect_coulombs_law(seed, friction, found);
  EXPECT_GT(found.slips, 50);
  EXPECT_GT(found.sticks, 30);
  EXPECT_LE(10 * found.weak, found.slips) << found.weak << " of " << found.slips;
}

}  // namespace
}  // namespace continuo::impact_friction_test
