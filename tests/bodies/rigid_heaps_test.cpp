// Islands of many bodies, whose contacts are swept in lanes: pyramids stand, joints between them hold, and the results
// do not depend on the number of threads, nor on a snapshot in between.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/snapshot.hpp>

namespace continuo::rigid_heaps_test {
namespace {

using test::add_box;
using test::advance;
using test::upright_vector;

/// Rows of base, base - 1, ... unit boxes on a floor.
template <int Dim>
World<double, Dim> pyramid(int base) {
  World<double, Dim> world = test::world_on_slope<Dim>(0, 0.6);
  for (int i = 0; i < base; ++i)
    for (int j = i; j < base; ++j) add_box<Dim>(world, upright_vector<Dim>(0.5 * i + (j - i), i + 0.5));
  return world;
}

// A contact at 30 Hz with damping 10 that carries m g overlaps by g / w^2 = 0.28 mm: a column of n boxes by that times
// n (n + 1) / 2, and a pyramid, in which each box carries half of two others, by less.
template <int Dim>
void expect_pyramid_stands(int base) {
  World<double, Dim> world = pyramid<Dim>(base);
  const World<double, Dim> start = world;
  FastMotion<double, Dim> motion(world);
  advance<Dim>(motion, 240);
  EXPECT_GT(motion.statistics().colours, 2u);  // it was swept
  const double sag = 9.81 / std::pow(2 * 3.14159 * 30, 2) * base * (base + 1) / 2;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const auto moved = world.position[i] - start.position[i];
    EXPECT_LT(std::abs(moved[0]), sag) << i;
    EXPECT_LT(std::abs(moved[Dim - 1]), sag) << i;
    EXPECT_LT(length(world.velocity[i]), 0.05) << i;
  }
}
TEST(RigidHeaps, PyramidsStand) {
  expect_pyramid_stands<2>(24);
  expect_pyramid_stands<3>(12);
}

/// Boxes of random sizes that fall into a container.
template <class Real, int Dim>
World<Real, Dim> heap(std::size_t count) {
  World<Real, Dim> world;
  world.gravity[Dim - 1] = Real(-9.81);
  Vector<Real, Dim> lower, upper;
  for (std::size_t i = 0; i < Dim; ++i) lower[i] = Real(i + 1 == Dim ? 0 : -2), upper[i] = Real(i + 1 == Dim ? 100 : 2);
  EXPECT_TRUE(world.add_container(lower, upper));
  std::uint32_t random = 1;
  const auto next = [&] { return static_cast<Real>((random = random * 1664525u + 1013904223u) >> 8) / Real(1 << 24); };
  for (std::size_t k = 0; k < count; ++k) {
    BodyDefinition<Real, Dim> body;
    Box<Real, Dim> box;
    for (Real& side : box.size.components) side = Real(0.3) + Real(0.3) * next();
    body.shape = box;
    for (std::size_t i = 0; i + 1 < Dim; ++i) body.position[i] = Real(-1.5) + next() * 3;
    body.position[Dim - 1] = Real(0.5) + Real(0.25) * static_cast<Real>(k);
    body.orientation.components.back() = next();
    if (k % 3 == 0) body.material.restitution = Real(0.5);
    EXPECT_TRUE(world.add(body));
  }
  return world;
}
template <class Real, int Dim>
void expect_the_same_for_any_number_of_threads() {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 4, 7}) {
    World<Real, Dim> world = heap<Real, Dim>(120);
    FastMotion<Real, Dim> motion(world, {.threads = threads});
    for (int k = 0; k < 150; ++k) ASSERT_TRUE(motion.advance());
    EXPECT_GT(motion.statistics().colours, 2u);
    hashes.push_back(state_hash(world));
    EXPECT_EQ(hashes.back(), hashes.front()) << threads;
  }
}
TEST(RigidHeaps, AreTheSameForAnyNumberOfThreads) {
  expect_the_same_for_any_number_of_threads<double, 2>();
  expect_the_same_for_any_number_of_threads<float, 3>();
}

// The bodies end within the container, slower than what they fall in a step.
template <int Dim>
void expect_heap_comes_to_rest() {
  World<double, Dim> world = heap<double, Dim>(120);
  FastMotion<double, Dim> motion(world);
  advance<Dim>(motion, 900);
  for (std::size_t i = 0; i < world.size(); ++i) {
    EXPECT_LT(length(world.velocity[i]), 9.81 / 60) << i;
    for (std::size_t axis = 0; axis + 1 < Dim; ++axis) EXPECT_LT(std::abs(world.position[i][axis]), 2) << i;
    EXPECT_GT(world.position[i][Dim - 1], 0) << i;
  }
}
TEST(RigidHeaps, ComeToRest) {
  expect_heap_comes_to_rest<2>();
  expect_heap_comes_to_rest<3>();
}

// The points of a contact are carried along only while both shapes are the same.
TEST(RigidHeaps, SeeAnExchangedShape) {
  World<double, 2> world;
  ASSERT_TRUE(world.add({.shape = Box<double, 2>{{{4, 1}}}, .fixed = true}));
  const BodyHandle small = add_box<2>(world, {{0, 1}});
  FastMotion<double, 2> motion(world);
  advance<2>(motion, 2);
  EXPECT_LT(motion.deepest_overlap(), 1e-3);
  ASSERT_TRUE(world.remove(small));
  ASSERT_TRUE(world.add({.shape = Box<double, 2>{{{2, 2}}}, .position = {{0, 1}}}));
  advance<2>(motion, 1);
  EXPECT_GT(motion.deepest_overlap(), 0.4);  // 0.5, and pushed by at most 4 / 60
}

// A tray that turns about a hinge with boxes in it: its joint is solved between the sweeps of contacts.
TEST(RigidHeaps, KeepTheJointsBetweenThem) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  const auto body = world.add({.shape = test::tray(), .mass = 50});
  ASSERT_TRUE(body);
  const auto hinge = world.add_joint(
      {.kind = JointKind::hinge, .b = *body, .anchor = {{0, 0}}, .motor = JointMotor<double>{0.2, 1e5}});
  ASSERT_TRUE(hinge);
  for (int k = 0; k < 72; ++k) add_box<2>(world, {{-3.0 + 1.05 * (k % 6), -1 + 1.05 * (k / 6)}}, 0.2);
  FastMotion<double, 2> motion(world);
  for (int k = 0; k < 120; ++k) {
    ASSERT_TRUE(motion.advance());
    const Joint<double, 2>& joint = *world.find(*hinge);
    const std::size_t i = world.index(*body);
    const auto at = world.position[i] + rotation(world.orientation[i]) * joint.anchor_b;
    EXPECT_LT(length(at), 0.02) << k;
    EXPECT_NEAR(world.spin[i][0], 0.2, 0.05) << k;
  }
  EXPECT_GT(motion.statistics().colours, 2u);
}

}  // namespace
}  // namespace continuo::rigid_heaps_test
