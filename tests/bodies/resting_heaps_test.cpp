// Bodies that come to rest on each other under gravity alone, at the default settings, against closed forms.
// `most_events` bounds the flights and steps of a call, and so the cost of a heap at rest.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <random>
#include <tuple>

#include <bench/bodies/overlap.hpp>
#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo::resting_heaps_test {
namespace {

// A column of dropped balls comes to rest and remains standing: another 1000 s take hardly any events.
TEST(RestingHeaps, AColumnStands) {
  for (const double restitution : {0.0, 0.5})
    for (const double friction : {0.0, 0.5}) {
      const Material<double> material{.restitution = restitution, .friction = friction};
      World<double, 3> world;
      world.gravity = {{0, 0, -10}};
      ASSERT_TRUE(world.add_wall({.material = material}));
      for (int i = 0; i < 8; ++i) ASSERT_TRUE(world.add({.position = {{0, 0, 0.5 + 1.1 * i}}, .material = material}));
      ExactMotion motion(world);
      ASSERT_TRUE(motion.advance_to(10));
      // Each contact may overlap by the distance that a body falls in the contact time, 1e-10, or in a stride of
      // several steps, 1e-6.
      for (int i = 0; i < 8; ++i)
        EXPECT_NEAR(world.position[static_cast<std::size_t>(i)][2], 0.5 + i, 8e-6) << restitution << ' ' << friction;
      const std::size_t collisions = motion.statistics().collisions;
      ExactMotion on(world, {.most_events = 200});
      ASSERT_TRUE(on.advance_to(1000)) << restitution << ' ' << friction;
      EXPECT_EQ(motion.statistics().collisions, collisions);
      EXPECT_LT(std::abs(world.position[7][2] - 7.5), 8e-6);
    }
}

// Three equal discs, two on the floor side by side and one on both: by the balance of moments and forces, friction
// between discs must be at least tan 15 degrees of the normal force, and less at the floor. Above that the pyramid is
// stable, below it collapses.
TEST(RestingHeaps, APyramidStandsByFriction) {
  const double enough = std::tan(std::acos(-1.0) / 12);
  for (const double part : {0.9, 0.98, 1.02, 1.5}) {
    const Material<double> material{.restitution = 0, .friction = part * enough};
    World<double, 2> world;
    world.gravity = {{0, -10}};
    ASSERT_TRUE(world.add_wall({.material = material}));
    for (const auto& x : {Vector<double, 2>{{-0.5, 0.5}}, {{0.5, 0.5}}, {{0, 0.5 + std::sqrt(0.75)}}})
      ASSERT_TRUE(world.add({.position = x, .material = material}));
    ExactMotion motion(world);
    ASSERT_TRUE(motion.advance_to(5));
    if (part > 1) {
      EXPECT_NEAR(world.position[2][1], 0.5 + std::sqrt(0.75), 1e-6) << part;
    } else {
      EXPECT_LT(world.position[2][1], 1) << part;
    }
  }
}

// Smooth discs are supported by walls, and rest exactly as under general forces.
TEST(RestingHeaps, APyramidStandsBetweenWalls) {
  const Material<double> material{.restitution = 0.5, .friction = 0};
  World<double, 2> world;
  world.gravity = {{0, -10}};
  ASSERT_TRUE(world.add_container({}, {{2, 9}}, material));
  for (const auto& x : {Vector<double, 2>{{0.5, 0.6}}, {{1.5, 0.7}}, {{0.99, 2}}})
    ASSERT_TRUE(world.add({.position = x, .material = material}));
  World<double, 2> other = world;
  other.force_laws.emplace_back([](const auto&, double, auto, auto, auto) {});
  ExactMotion motion(world), of_other(other);
  ASSERT_TRUE(motion.advance_to(5));
  ASSERT_TRUE(of_other.advance_to(5));
  EXPECT_NEAR(world.position[2][1], 0.5 + std::sqrt(0.75), 1e-6);
  EXPECT_NEAR(world.position[2][0], 1, 1e-6);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(length(world.position[i] - other.position[i]), 1e-6);
  EXPECT_LT(kinetic_energy(world), 1e-12);
}

// A ball dropped between two that are fixed comes to lie in their groove.
TEST(RestingHeaps, ABallLiesInAGroove) {
  for (const double friction : {0.0, 0.5}) {
    const Material<double> material{.restitution = 0.5, .friction = friction};
    World<double, 2> world;
    world.gravity = {{0, -10}};
    for (const double x : {-0.6, 0.6})
      ASSERT_TRUE(world.add({.position = {{x, 0}}, .fixed = true, .material = material}));
    ASSERT_TRUE(world.add({.position = {{0.01, 0.9}}, .material = material}));
    ExactMotion motion(world);
    ASSERT_TRUE(motion.advance_to(10));
    EXPECT_NEAR(world.position[2][0], 0, 1e-6) << friction;
    EXPECT_NEAR(world.position[2][1], 0.8, 1e-6) << friction;
    ExactMotion on(world, {.most_events = 100});
    EXPECT_TRUE(on.advance_to(1000)) << friction;
  }
}

/// A ball released at an angle of 0.1 on a fixed ball: the cosine of the angle at which it leaves it.
double cosine_of_leaving(double friction) {
  const Material<double> material{.restitution = 0, .friction = friction};
  World<double, 3> world;
  world.gravity = {{0, 0, -10}};
  EXPECT_TRUE(world.add({.shape = Sphere<double>{1}, .fixed = true, .material = material}));
  EXPECT_TRUE(world.add({.position = {{1.5 * std::sin(0.1), 0, 1.5 * std::cos(0.1)}}, .material = material}));
  ExactMotion motion(world, {.contact_events = 10});
  for (double t = 0.01; t < 3; t += 0.01) {
    EXPECT_TRUE(motion.advance_to(t));
    for (const auto& event : motion.contact_events())
      if (event.change == ContactChange::end) return std::abs(event.normal[2]);
  }
  return 0;
}
// By energy and the centripetal force: 2/3 of the first cosine if it slides without friction, 10/17 if it rolls.
// Shortly before it leaves, the normal force is too small for friction f to supply (2/7) m g sin: it slips there,
// within 2 / (17 f) of the cosine.
TEST(RestingHeaps, ABallLeavesAnotherAtTheKnownAngle) {
  EXPECT_NEAR(cosine_of_leaving(0), std::cos(0.1) * 2 / 3, 1e-8);
  EXPECT_NEAR(cosine_of_leaving(1e4), std::cos(0.1) * 10 / 17, 2 * 2 / (17 * 1e4));
}

/// Balls of three sizes above each other in a narrow box.
template <int Dim>
World<double, Dim> random_heap(unsigned seed) {
  constexpr auto top = static_cast<std::size_t>(Dim - 1);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::array<double, 3> restitutions{0, 0.5, 0.8}, frictions{0, 0.3, 0.6};
  const Material<double> material{restitutions[seed % 3], frictions[seed / 3 % 3]};
  World<double, Dim> world;
  world.gravity[top] = -9.81;
  Vector<double, Dim> upper;
  for (std::size_t axis = 0; axis < upper.size(); ++axis) upper[axis] = axis == top ? 100 : 2.6;
  EXPECT_TRUE(world.add_container({}, upper, material));
  double height = 0;
  for (int i = 0; i < 8; ++i) {
    const double r = 0.3 + 0.1 * (i % 3);
    BodyDefinition<double, Dim> ball{.shape = Sphere<double>{r}, .material = material};
    for (std::size_t axis = 0; axis < top; ++axis) ball.position[axis] = r + (2.6 - 2 * r) * uniform(engine);
    ball.position[top] = height + r;
    height += 2 * r;
    EXPECT_TRUE(world.add(ball));
  }
  return world;
}

// Random falling heaps: overlaps stay below a millionth of the radius, a few falls of a stride (200 sweeps leave
// impulses as inexact as that); the energy never rises by more than the work of separating these overlaps; and the
// computation ends in time.
template <int Dim>
void falls_together(unsigned seed) {
  World<double, Dim> world = random_heap<Dim>(seed);
  const auto energy = [&] { return kinetic_energy(world) + potential_energy(world); };
  double weight = 0;
  for (const double mass : world.mass) weight += 9.81 * mass;
  ExactMotion motion(world, {.most_events = 100'000});
  double last = energy();
  for (int k = 1; k <= 20; ++k) {
    ASSERT_TRUE(motion.advance_to(0.2 * k)) << Dim << ' ' << seed;
    EXPECT_LT(deepest_overlap(world), 1e-5) << Dim << ' ' << seed;
    EXPECT_LT(energy() - last, 1e-5 * weight) << Dim << ' ' << seed;
    last = energy();
  }
}
TEST(RestingHeaps, FallTogetherWithoutOverlapOrEnergyFromNowhere) {
  for (unsigned seed = 0; seed < 9; ++seed) {
    falls_together<2>(seed);
    falls_together<3>(seed);
  }
}

// A snapshot taken on the way resumes to the same bits, and every contact that begins ends before it begins again, in
// every part of the motion.
TEST(RestingHeaps, GoOnFromASnapshotAndTellWhoTouches) {
  World<double, 3> world = random_heap<3>(13);
  ExactMotion motion(world, {.contact_events = 1'000'000});
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, bool> lasts;
  for (int k = 1; k <= 15; ++k) {
    const Bytes saved = snapshot(world, motion);
    World<double, 3> other;
    ExactMotion of_other(other);
    ASSERT_TRUE(restore(saved, other, of_other));
    ASSERT_TRUE(motion.advance_to(0.2 * k));
    ASSERT_TRUE(of_other.advance_to(0.2 * k));
    EXPECT_EQ(state_hash(world), state_hash(other)) << k;
    for (const auto& event : motion.contact_events()) {
      if (event.change == ContactChange::impact) continue;
      bool& is_there = lasts[{event.a.slot, event.with_wall() ? 0 : event.b.slot, event.wall}];
      EXPECT_NE(is_there, event.change == ContactChange::begin) << k;
      is_there = event.change == ContactChange::begin;
    }
  }
  EXPECT_GT(lasts.size(), 8u);
}

}  // namespace
}  // namespace continuo::resting_heaps_test
