// Heaps that are swept in lanes, of rods that turn far in a step, gain no energy.
#include <algorithm>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/shapes/turned_inertia.hpp>

namespace continuo::spinning_heaps_test {
namespace {

[[nodiscard]] double energy(const World<double, 3>& world) {
  double sum = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const Matrix<double, 3> inertia = turned_inertia(rotation(world.orientation[i]), world.inertia(i));
    sum += world.mass[i] * (squared(world.velocity[i]) / 2 - dot(world.gravity, world.position[i])) +
           dot(world.spin[i], inertia * world.spin[i]) / 2;
  }
  return sum;
}
/// Rods in a box, each as far from the next as it is long, that turn about random axes.
[[nodiscard]] World<double, 3> rods(int side, double rate) {
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  const Material<double> rough{.friction = 1};
  const double spacing = 1.16;
  World<double, 3> world;
  world.gravity = {{0, 0, -10}};
  EXPECT_TRUE(world.add_container({}, {{side * spacing, side * spacing, side * spacing}}, rough));
  for (int k = 0; k < side * side * side; ++k) {
    Orientation<double, 3> orientation;
    Vector<double, 3> spin, v;
    for (double& part : orientation.components) part = normal(engine);
    for (double& part : spin.components) part = normal(engine);
    for (double& part : v.components) part = normal(engine);
    EXPECT_TRUE(world.add({.shape = Box<double, 3>{{{1, 0.1, 0.1}}},
                           .position = {{(k % side + 0.5) * spacing, (k / side % side + 0.5) * spacing,
                                         (k / (side * side) + 0.5) * spacing}},
                           .velocity = v,
                           .orientation = orientation * (1 / length(orientation)),
                           .spin = spin * (rate / length(spin)),
                           .mass = 1,
                           .material = rough}));
  }
  return world;
}

/// Undoing an overlap lifts a body without taking anything of its motion: each by less than the fastest push, 4 m/s,
/// does in a step. Seen were up to 1.1 times the whole energy more, after a single step.
TEST(SpinningHeaps, GainNoEnergy) {
  for (const double rate : {50.0, 200.0}) {
    World<double, 3> world = rods(9, rate);
    FastMotion<double, 3> motion(world);
    const double at_first = energy(world), lifted = static_cast<double>(world.size()) * 10 * 4 / 60;
    double before = at_first;
    std::size_t most_contacts = 0;
    for (int step = 0; step < 50; ++step) {
      ASSERT_TRUE(motion.advance());
      const double now = energy(world);
      ASSERT_LT(now, before + lifted) << "in step " << step << " of rods at " << rate << " rad/s";
      before = now, most_contacts = std::max(most_contacts, motion.statistics().contacts);
    }
    EXPECT_LT(before, at_first);
    EXPECT_GT(most_contacts, 500u);  // or nothing would be in lanes
  }
}

}  // namespace
}  // namespace continuo::spinning_heaps_test
