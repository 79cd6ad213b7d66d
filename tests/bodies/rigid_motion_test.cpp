// The fast motion of boxes, capsules, hulls and compounds: against closed forms, and what must not happen.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo::rigid_motion_test {

using namespace test;  // rigid_worlds.hpp

namespace {

template <int Dim>
void expect_stack_stands(int boxes, double top_mass) {
  auto world = world_on_slope<Dim>(0, 0.6);
  for (int i = 0; i < boxes; ++i)
    add_box<Dim>(world, upright_vector<Dim>(0.02 * (i % 3), i + 0.5), i + 1 == boxes ? top_mass : 1);
  FastMotion<double, Dim> motion(world);
  advance(motion, 60);
  for (int i = 0; i < boxes; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(world.position[k][Dim - 1], i + 0.5, 1e-4) << "box " << i;
    EXPECT_NEAR(world.position[k][0], 0.02 * (i % 3), 1e-4) << "box " << i;
    EXPECT_LT(length(world.velocity[k]), 1e-4) << "box " << i;
  }
}
TEST(RigidMotion, StacksStand) {
  expect_stack_stands<2>(20, 1);
  expect_stack_stands<3>(6, 1);
}
TEST(RigidMotion, StacksBearAThousandTimesTheirMass) {
  expect_stack_stands<2>(5, 1000);
  expect_stack_stands<3>(3, 1000);
}

template <int Dim>
void expect_friction_of(double excess) {
  const double friction = 0.5, angle = std::atan(friction * (1 + excess));
  auto world = world_on_slope<Dim>(angle, friction);
  const auto box = add_box<Dim>(world, upright_vector<Dim>(-std::sin(angle) / 2, std::cos(angle) / 2), 1, friction);
  world.orientation[world.index(box)] = tilted<Dim>(angle);
  const Vector<double, Dim> start = world.position_of(box);
  FastMotion<double, Dim> motion(world);
  advance(motion, 60);
  const double pull = 9.81 * (std::sin(angle) - friction * std::cos(angle));
  const double way = length(Vector<double, Dim>(world.position_of(box) - start));
  // Semi-implicit Euler is one half of a step of the substep ahead: a t (t + h) / 2.
  EXPECT_NEAR(way, pull > 0 ? pull * (1 + 1.0 / 240) / 2 : 0, pull > 0 ? 0.01 * pull : 1e-5);
}
TEST(RigidMotion, FrictionHoldsAndSlipsAtItsAngle) {
  for (const double excess : {-0.01, 0.01, 0.5}) expect_friction_of<2>(excess), expect_friction_of<3>(excess);
}

// What rolls on a floor stays at its height and keeps its speed: its contact neither turns with it nor drops behind.
template <int Dim>
void rolls_evenly(const Shape<double, Dim>& shape, const Orientation<double, Dim>& orientation) {
  for (const double speed : {0.0, 0.01, 1.0, 10.0}) {
    SCOPED_TRACE(speed);
    World<double, Dim> world;
    constexpr std::size_t up = Dim - 1;
    world.gravity[up] = -10;
    Vector<double, Dim> size, under;
    for (double& side : size.components) side = 400;
    size[up] = 2, under[up] = -1;
    const Material<double> rough{.friction = 0.8};
    ASSERT_TRUE(world.add({.shape = Box<double, Dim>{size}, .position = under, .fixed = true, .material = rough}));
    Vector<double, Dim> start, velocity;
    start[up] = 0.5, velocity[0] = speed;
    Spin<double, Dim> spin;
    spin[Dim == 2 ? 0 : 1] = (Dim == 2 ? -1 : 1) * speed / 0.5;
    const BodyHandle body = *world.add({.shape = shape,
                                        .position = start,
                                        .velocity = velocity,
                                        .orientation = orientation,
                                        .spin = spin,
                                        .mass = 1.0,
                                        .material = rough});
    FastMotion<double, Dim> motion(world, {.step = 1.0 / 60});
    const std::size_t i = world.index(body);
    // The search for closest points ends where it would gain 4 eps of the floor's reach of 283, so that at a distance
    // of 0.5 the normal is within sqrt(2 * 4 eps * 283 / 0.5) of its place.
    const double rounding = 1e-9 + 1e-6 * speed;
    for (int k = 0; k < 300; ++k) {
      ASSERT_TRUE(motion.advance());
      EXPECT_NEAR(world.position[i][up], 0.5, rounding);
      EXPECT_NEAR(world.velocity[i][up], 0, rounding);
    }
    EXPECT_NEAR(world.velocity[i][0], speed, rounding);
    EXPECT_NEAR(world.position[i][0], 5 * speed, 5 * rounding);
  }
}
TEST(RigidMotion, WhatRollsKeepsItsHeightAndItsSpeed) {
  rolls_evenly<2>(Sphere<double>{}, upright<double, 2>()), rolls_evenly<3>(Sphere<double>{}, upright<double, 3>());
  const double half = std::sqrt(0.5);
  rolls_evenly<3>(Capsule<double>{}, {{half, half, 0, 0}});
}
TEST(RigidMotion, FreeFlightIsAParabola) {
  World<double, 3> world;
  world.gravity = {{0, 0, -9.81}};
  const auto body = world.add({.shape = Capsule<double>{}, .velocity = {{1, 2, 3}}, .spin = {{1, 2, 3}}});
  ASSERT_TRUE(body);
  FastMotion<double, 3> motion(world);
  advance(motion, 120);
  EXPECT_LT(length(Vector<double, 3>(world.position_of(*body) - Vector<double, 3>{{2, 4, 6 - 9.81 * 2}})), 1e-12);
}

TEST(RigidMotion, ANutFlipsAndKeepsItsAngularMomentum) {
  World<double, 3> world;
  const auto nut =
      world.add({.shape = Compound<double, 3>{{{.shape = Box<double, 3>{{{2, 0.4, 0.4}}}},
                                               {.shape = Box<double, 3>{{{0.4, 1, 0.4}}}, .position = {{0, 0.5, 0}}}}},
                 .spin = {{0.01, 5, 0.01}}});
  ASSERT_TRUE(nut) << describe(nut.status());
  const Vector<double, 3> momentum = angular_momentum(world);
  const double energy = kinetic_energy(world);
  FastMotion<double, 3> motion(world);
  int flips = 0;
  double side = 1;
  for (int k = 0; k < 1200; ++k) {
    advance(motion, 1);
    const double along = dot(rotation(world.orientation[0])[1], momentum);
    if (along * side < 0) ++flips, side = -side;
  }
  EXPECT_GE(flips, 3);
  EXPECT_LT(length(Vector<double, 3>(angular_momentum(world) - momentum)), 1e-11 * length(momentum));
  EXPECT_NEAR(kinetic_energy(world), energy, 1e-4 * energy);
}

// Of one body: the momentum before is 2, each time shared by equal masses.
template <int Dim>
void expect_elastic_hit(double restitution) {
  World<double, Dim> world;
  for (const double x : {-2.0, 2.0}) {
    const auto box = world.add({.shape = Box<double, Dim>{},
                                .position = upright_vector<Dim>(x, 0),
                                .velocity = upright_vector<Dim>(-x, 0),
                                .material = {.restitution = restitution}});
    ASSERT_TRUE(box);
  }
  FastMotion<double, Dim> motion(world);
  advance(motion, 120);
  EXPECT_NEAR(world.velocity[0][0], -2 * restitution, 1e-5);
  EXPECT_NEAR(world.velocity[1][0], 2 * restitution, 1e-5);
  EXPECT_LT(length(world.spin[0]) + length(world.spin[1]), 1e-5);
}
TEST(RigidMotion, HitsLeaveWithTheirRestitution) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    expect_elastic_hit<2>(restitution);
    expect_elastic_hit<3>(restitution);
  }
}

template <int Dim>
Shape<double, Dim> bullet(int kind) {
  if (kind == 0) return Sphere<double>{0.02};
  if (kind == 1) return Capsule<double>{1, 0.01};
  Box<double, Dim> box;
  for (std::size_t i = 0; i < Dim; ++i) box.size[i] = 0.1 / double(i + 1);
  return box;
}
template <int Dim>
void expect_no_bullet_passes(int shots) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int shot = 0; shot < shots; ++shot) {
    World<double, Dim> world;
    Box<double, Dim> plate;
    for (std::size_t i = 0; i < Dim; ++i) plate.size[i] = i == 0 ? 0.01 : 20;
    ASSERT_TRUE(world.add({.shape = plate, .fixed = true}));
    BodyDefinition<double, Dim> body{.shape = bullet<Dim>(shot % 3)};
    body.position[0] = -3 - number(engine);
    for (std::size_t i = 1; i < Dim; ++i) body.position[i] = number(engine), body.velocity[i] = 3 * number(engine);
    body.velocity[0] = std::pow(10, 2 + number(engine));
    for (double& part : body.spin.components) part = 100 * number(engine);
    ASSERT_TRUE(world.add(body));
    FastMotion<double, Dim> motion(world);
    for (int k = 0; k < 40; ++k) {
      advance(motion, 1);
      ASSERT_LT(world.position[1][0], 0) << "shot " << shot << ", step " << k;
    }
  }
}
TEST(RigidMotion, NoBulletPassesAPlate) {
  expect_no_bullet_passes<2>(60);
  expect_no_bullet_passes<3>(30);
}

/// Random bodies of all shapes that fall into a container.
template <class Real, int Dim>
World<Real, Dim> falling(unsigned seed, int bodies) {
  std::mt19937 engine(seed);
  const auto number = [&](double low, double high) {
    return static_cast<Real>(low + (high - low) * (static_cast<double>(engine()) / 4294967296.0));
  };
  World<Real, Dim> world;
  world.gravity[Dim - 1] = Real(-9.81);
  Vector<Real, Dim> lower, upper;
  for (std::size_t i = 0; i < Dim; ++i) lower[i] = Real(i + 1 == Dim ? 0 : -3), upper[i] = Real(i + 1 == Dim ? 100 : 3);
  EXPECT_TRUE(world.add_container(lower, upper));
  for (int k = 0; k < bodies; ++k) {
    BodyDefinition<Real, Dim> body;
    for (std::size_t i = 0; i < Dim; ++i)
      body.position[i] = i + 1 == Dim ? Real(1.5) * Real(k + 1) : number(-1, 1), body.velocity[i] = number(-3, 3);
    for (Real& part : body.spin.components) part = number(-5, 5);
    for (Real& part : body.orientation.components) part = number(0.1, 1);
    if (k % 4 == 0) body.shape = Sphere<Real>{number(0.2, 0.6)};
    if (k % 4 == 1) body.shape = Capsule<Real>{number(0.3, 1), number(0.1, 0.3)};
    if (k % 4 == 2) {
      Box<Real, Dim> box;
      for (Real& side : box.size.components) side = number(0.3, 1);
      body.shape = box;
    }
    if (k % 4 == 3) {
      Hull<Real, Dim> hull;
      for (int point = 0; point < 10; ++point) {
        Vector<Real, Dim>& x = hull.points.emplace_back();
        for (Real& part : x.components) part = number(-0.5, 0.5);
      }
      body.shape = hull;
    }
    body.material = {.restitution = k % 3 == 0 ? Real(0.5) : Real(0), .friction = number(0, 1)};
    EXPECT_TRUE(world.add(body));
  }
  return world;
}

template <class Real, int Dim>
void expect_equal_for_any_number_of_threads() {
  std::set<std::uint64_t> hashes;
  for (const int threads : {1, 2, 4, 7}) {
    World<Real, Dim> world = falling<Real, Dim>(1, 12);
    FastMotion<Real, Dim> motion(world, {.threads = threads});
    for (int k = 0; k < 90; ++k) ASSERT_TRUE(motion.advance());
    hashes.insert(state_hash(world));
  }
  EXPECT_EQ(hashes.size(), 1u);
}
TEST(RigidMotion, IsTheSameForAnyNumberOfThreads) {
  expect_equal_for_any_number_of_threads<double, 2>();
  expect_equal_for_any_number_of_threads<float, 3>();
}

template <class Real, int Dim>
void expect_calm_heap(unsigned seed) {
  World<Real, Dim> world = falling<Real, Dim>(seed, 12);
  FastMotion<Real, Dim> motion(world);
  Real deepest(0);
  for (int k = 0; k < 600; ++k) {
    ASSERT_TRUE(motion.advance());
    deepest = std::max(deepest, motion.deepest_overlap());
  }
  for (std::size_t i = 0; i < world.size(); ++i) {
    EXPECT_GT(world.position[i][Dim - 1], Real(0)) << "seed " << seed << ", body " << i;
    EXPECT_LT(world.position[i][Dim - 1], Real(20)) << "seed " << seed << ", body " << i;
  }
  EXPECT_LT(deepest, Real(0.2)) << "seed " << seed;
}
TEST(RigidMotion, RandomHeapsStayInTheirContainer) {
  for (unsigned seed = 1; seed < 4; ++seed) {
    expect_calm_heap<double, 2>(seed);
    expect_calm_heap<float, 2>(seed);
    expect_calm_heap<double, 3>(seed);
  }
}

TEST(RigidMotion, SnapshotsContinueToTheBit) {
  World<double, 3> world = falling<double, 3>(5, 8);
  const auto joined = world.add_joint(JointDefinition<double, 3>{
      .kind = JointKind::ball, .a = world.handle(0), .b = world.handle(1), .anchor = {{0, 0, 2}}});
  ASSERT_TRUE(joined);
  BodyTraits<double> traits;
  traits.damping = 0.1, traits.user_data = 42;
  ASSERT_TRUE(world.set_traits(world.handle(2), traits));
  FastMotion<double, 3> motion(world, {.sleep_after = 0.5});
  advance(motion, 60);
  const Bytes bytes = snapshot(world, motion);
  World<double, 3> other;
  FastMotion<double, 3> of_other(other, {.sleep_after = 0.5});
  const Status restored = restore(bytes, other, of_other);
  ASSERT_TRUE(restored) << describe(restored);
  EXPECT_EQ(other.traits(2).user_data, 42u);
  advance(motion, 60), advance(of_other, 60);
  EXPECT_EQ(state_hash(world), state_hash(other));
}

TEST(RigidMotion, PilesFallAsleepAndWake) {
  auto world = world_on_slope<2>(0, 0.6);
  for (int i = 0; i < 5; ++i) add_box<2>(world, {{0, i + 0.5}});
  FastMotion<double, 2> motion(world, {.sleep_after = 0.5});
  advance(motion, 90);
  EXPECT_EQ(motion.statistics().asleep, 5u);
  world.velocity[2] = {{1, 0}};
  advance(motion, 1);
  EXPECT_EQ(motion.statistics().asleep, 0u);
  advance(motion, 240);
  EXPECT_EQ(motion.statistics().asleep, 5u);
  ASSERT_TRUE(world.add({.shape = Sphere<double>{0.3}, .position = {{0, 8}}, .mass = 5}));
  motion.refresh();
  advance(motion, 120);
  EXPECT_LT(world.position[5][1], 7);
}

TEST(RigidMotion, LocksDampingGravityAndDrivenBodies) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  const auto add = [&](double x, const BodyTraits<double>& traits, bool fixed = false) {
    const auto body = world.add({.shape = Box<double, 2>{},
                                 .position = {{x, 0}},
                                 .velocity = {{1, 0}},
                                 .spin = {{2}},
                                 .fixed = fixed,
                                 .traits = traits});
    EXPECT_TRUE(body) << describe(body.status());
    return *body;
  };
  const auto locked = add(0, {.locked = both(Locked::y, Locked::turn_z)});
  const auto floats = add(10, {.gravity_scale = 0});
  const auto damped = add(20, {.gravity_scale = 0, .damping = 1, .spin_damping = 2});
  const auto driven = add(30, {.is_driven = true}, true);
  FastMotion<double, 2> motion(world);
  advance(motion, 60);
  EXPECT_NEAR(world.position_of(locked)[0], 1, 1e-12);
  EXPECT_NEAR(world.position_of(locked)[1], 0, 1e-6);
  EXPECT_NEAR(world.orientation[world.index(locked)][0], 0, 1e-6);
  EXPECT_NEAR(world.position_of(floats)[1], 0, 1e-12);
  // Implicit Euler: (1 + h c)^-n for exp(-c t), to c^2 t h / 2.
  EXPECT_NEAR(world.velocity_of(damped)[0], std::exp(-1), 1.0 / 240);
  EXPECT_NEAR(world.spin[world.index(damped)][0], 2 * std::exp(-2), 2 * 4.0 / 480);
  EXPECT_NEAR(world.position_of(driven)[0], 31, 1e-12);
  EXPECT_NEAR(world.orientation[world.index(driven)][0], 2, 1e-12);
}

TEST(RigidMotion, CategoriesSensorsAndRulesDecideWhoCollides) {
  auto world = world_on_slope<2>(0, 0.6);
  const auto floor_of_some =
      world.add({.shape = Box<double, 2>{{{10, 1}}}, .position = {{0, 5}}, .fixed = true, .traits = {.category = 2}});
  const auto sensor = world.add(
      {.shape = Box<double, 2>{{{10, 1}}}, .position = {{0, 3}}, .fixed = true, .traits = {.is_sensor = true}});
  ASSERT_TRUE(floor_of_some && sensor);
  const auto stays = world.add({.shape = Box<double, 2>{}, .position = {{-2, 6.1}}});
  const auto falls =
      world.add({.shape = Box<double, 2>{}, .position = {{2, 6.1}}, .traits = {.mask = ~std::uint64_t{2}}});
  ASSERT_TRUE(stays && falls);
  FastMotion<double, 2> motion(world, {.contact_events = 100});
  int sensed = 0;
  for (int k = 0; k < 120; ++k) {
    advance(motion, 1);
    for (const auto& event : motion.contact_events())
      sensed += event.change == ContactChange::begin && (event.a == *sensor || event.b == *sensor) ? 1 : 0;
  }
  EXPECT_NEAR(world.position_of(*stays)[1], 6, 1e-3);
  EXPECT_NEAR(world.position_of(*falls)[1], 0.5, 1e-3);
  EXPECT_EQ(sensed, 1);
  world.may_push = [](const auto&, std::size_t, std::size_t, const auto&) { return false; };
  advance(motion, 120);
  EXPECT_NEAR(world.position_of(*stays)[1], 0.5, 1e-3);  // walls always push
}

TEST(RigidMotion, RefusesWhatMakesNoSense) {
  World<double, 3> world;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(world.add({.shape = Box<double, 3>{{{1, 0, 1}}}}));
  EXPECT_FALSE(world.add({.shape = Box<double, 3>{{{1, 1, 1}}, 0.5}}));
  EXPECT_FALSE(world.add({.shape = Box<double, 3>{{{1, nan, 1}}}}));
  EXPECT_FALSE(world.add({.shape = Capsule<double>{-1, 0.5}}));
  EXPECT_FALSE(world.add({.shape = Capsule<double>{1, 0}}));
  EXPECT_FALSE(world.add({.shape = Hull<double, 3>{}}));
  EXPECT_FALSE(world.add({.shape = Hull<double, 3>{{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 1, 0}}}}}));
  EXPECT_FALSE(world.add({.shape = Compound<double, 3>{}}));
  EXPECT_FALSE(world.add({.traits = {.damping = -1}}));
  EXPECT_FALSE(world.add({.traits = {.gravity_scale = nan}}));
  EXPECT_EQ(world.size(), 0u);
  ASSERT_TRUE(world.add({.shape = Box<double, 3>{}}));
  world.material[0].rolling_resistance = 0.1;
  FastMotion<double, 3> motion(world);
  EXPECT_EQ(motion.advance().ending, Ending::invalid_input);
  FastMotion<double, 3> without_substeps(world, {.substeps = 0});
  EXPECT_EQ(without_substeps.advance().ending, Ending::invalid_input);
}

}  // namespace
}  // namespace continuo::rigid_motion_test
