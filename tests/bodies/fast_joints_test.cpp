// Bodies that are joined and fast: the stop of what would pass through another body in a step does not know them.
#include <cmath>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::fast_joints_test {
namespace {

// Two bodies without other forces, joined at a point between them: their centre of mass goes straight on at its speed.
// Were one stopped at the other one within a step, it would stay behind.
template <int Dim>
void expect_straight_way(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  World<double, Dim> world;
  for (const double x : {0.0, 0.5}) {
    Box<double, Dim> box;
    for (std::size_t axis = 0; axis < Dim; ++axis) box.size[axis] = 0.3 + 0.2 * part(engine);
    Vector<double, Dim> v;
    Spin<double, Dim> spin;
    for (std::size_t axis = 0; axis < Dim; ++axis) v[axis] = 40 * part(engine);
    for (std::size_t axis = 0; axis < spin.size(); ++axis) spin[axis] = 5 * part(engine);
    ASSERT_TRUE(world.add({.shape = box,
                           .position = test::upright_vector<Dim>(x, 0),
                           .velocity = v,
                           .spin = spin,
                           .mass = std::exp(part(engine))}));
  }
  ASSERT_TRUE(world.add_joint({.kind = Dim == 2 ? JointKind::hinge : JointKind::ball,
                               .a = world.handle(0),
                               .b = world.handle(1),
                               .anchor = test::upright_vector<Dim>(0.25, 0)}));
  const double whole = world.mass[0] + world.mass[1];
  const auto mean = [&](const auto& of) {
    return Vector<double, Dim>((of[0] * world.mass[0] + of[1] * world.mass[1]) * (1 / whole));
  };
  const Vector<double, Dim> from = mean(world.position), v = mean(world.velocity);
  FastMotion<double, Dim> motion(world);
  test::advance(motion, 120);
  EXPECT_LT(length(Vector<double, Dim>(mean(world.position) - from - v * world.time)), 1e-9)
      << Dim << ", seed " << seed;
}
TEST(FastJoints, JoinedBodiesDoNotStopEachOther) {
  for (unsigned seed = 1; seed <= 100; ++seed) expect_straight_way<2>(seed), expect_straight_way<3>(seed);
}

}  // namespace
}  // namespace continuo::fast_joints_test
