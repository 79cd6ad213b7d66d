// The fast motion on static meshes: no kicks at seams, nothing passes through, and what meshes share with walls.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "meshes.hpp"
#include "rigid_worlds.hpp"
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo::mesh_motion_test {

using namespace test;  // meshes.hpp, rigid_worlds.hpp

namespace {

double flat(double, double) {
  return 0;
}
double hill(double x, double y) {
  return 0.4 * std::sin(1.1 * x) + 0.3 * std::cos(0.9 * y);
}

/// Slides over a mesh without friction: what the seams do to it is not along the way.
template <int Dim>
void expect_no_kicks(const MeshShape<double, Dim>& ground, const Shape<double, Dim>& shape,
                     const Orientation<double, Dim>& orientation = upright<double, Dim>()) {
  World<double, Dim> world;
  world.gravity = upright_vector<Dim>(0, -9.81);
  ASSERT_TRUE(world.add_mesh({.shape = ground, .material = {.friction = 0}}));
  ASSERT_TRUE(world.add({.shape = shape,
                         .position = upright_vector<Dim>(0.03, 0.5),
                         .velocity = upright_vector<Dim>(10, 0),
                         .orientation = orientation,
                         .material = {.friction = 0}}));
  const Vector<double, Dim> start = world.position[0];
  FastMotion<double, Dim> motion(world);
  for (int k = 0; k < 60; ++k) {
    advance(motion, 1);
    EXPECT_LT(std::abs(world.velocity[0][Dim - 1]), 1e-6) << k;
    EXPECT_LT(length(world.spin[0]), 1e-6) << k;
  }
  EXPECT_NEAR(world.position[0][0], start[0] + 10, 1e-6);
  EXPECT_NEAR(world.position[0][Dim - 1], start[Dim - 1], 1e-4);
}
TEST(MeshMotion, SeamsAreNotFelt) {
  const double half = std::sqrt(0.5);
  const auto mesh = irregular_mesh<double>(52, 10, 0.25, -1.5, -1.25, flat);
  expect_no_kicks<3>(mesh, Box<double, 3>{});
  expect_no_kicks<3>(mesh, Sphere<double>{0.5});
  expect_no_kicks<3>(mesh, Capsule<double>{1, 0.5}, {{half, half, 0, 0}});
  expect_no_kicks<3>(mesh,
                     Hull<double, 3>{{{{-0.5, -0.4, -0.5}}, {{0.5, -0.4, -0.5}}, {{0.1, 0.6, -0.5}}, {{0, 0, 1}}}});
  const auto chain = flat_chain(60, 0.25, -1.5);
  expect_no_kicks<2>(chain, Box<double, 2>{});
  expect_no_kicks<2>(chain, Sphere<double>{0.5});
  expect_no_kicks<2>(chain, Capsule<double>{1, 0.5}, {{std::acos(0.0)}});
  expect_no_kicks<2>(chain, Box<double, 2>{.rounding = 0.1});
  expect_no_kicks<3>(HeightField<double, 3>{.origin = {{-1.5, -2, 0}},
                                            .spacing = {0.25, 0.25},
                                            .counts = {55, 17},
                                            .heights = std::vector<double>(55 * 17)},
                     Box<double, 3>{});
}

/// The greatest speed across a slope of angle 0.7, whose corners may be rounded to single precision, of a ball that
/// slides over it with 10 m/s, 70 to 100 m from the origin.
template <class Real>
double kicks_on_a_slope(bool is_rounded) {
  constexpr double c = 0.7648421872844885, s = 0.644217687237691;  // of 0.7
  const auto flat_mesh = irregular_mesh<double>(136, 10, 0.25, 68, -1.25, flat);
  TriangleMesh<Real> mesh{.corners = {}, .triangles = flat_mesh.triangles};
  for (const auto& x : flat_mesh.corners) {
    Vector<double, 3> corner{{c * x[0], x[1], s * x[0]}};
    for (double& part : corner.components) part = is_rounded ? static_cast<double>(static_cast<float>(part)) : part;
    mesh.corners.push_back(
        {{static_cast<Real>(corner[0]), static_cast<Real>(corner[1]), static_cast<Real>(corner[2])}});
  }
  World<Real, 3> world;
  world.gravity = {{static_cast<Real>(9.81 * s), 0, static_cast<Real>(-9.81 * c)}};
  EXPECT_TRUE(world.add_mesh({.shape = mesh, .material = {.friction = 0}}));
  EXPECT_TRUE(world.add({.position = {{static_cast<Real>(70 * c - s / 2), 0, static_cast<Real>(70 * s + c / 2)}},
                         .velocity = {{static_cast<Real>(10 * c), 0, static_cast<Real>(10 * s)}},
                         .material = {.friction = 0}}));
  FastMotion<Real, 3> motion(world);
  double greatest = 0;
  for (int k = 0; k < 170; ++k) {
    EXPECT_TRUE(motion.advance());
    const auto& v = world.velocity[0];
    if (k > 20) greatest = std::max(greatest, std::abs(c * static_cast<double>(v[2]) - s * static_cast<double>(v[0])));
  }
  return greatest;
}
/// In single precision the corners themselves are off by up to d = 2^-18 m, half of the distance of numbers beyond 64.
/// So triangles of size a tilt by up to 2 d (sin + cos) / a, which kicks in double precision, too.
TEST(MeshMotion, InSinglePrecisionASlopeIsAsRoughAsItsCorners) {
  EXPECT_LT(kicks_on_a_slope<double>(false), 1e-8);
  const double bound = 2 * std::ldexp(1, -18) * (0.765 + 0.644) * 10 / (0.25 * 0.66);  // sides are shifted
  const double of_corners = kicks_on_a_slope<double>(true), in_float = kicks_on_a_slope<float>(false);
  EXPECT_GT(of_corners, 2e-5);
  EXPECT_LT(of_corners, bound);
  EXPECT_LT(in_float, bound);
  EXPECT_LT(in_float, 3 * of_corners);
}

template <int Dim>
MeshShape<double, Dim> sheet(bool is_two_sided);
template <>
MeshShape<double, 2> sheet<2>(bool is_two_sided) {  // what is free is where x < 0
  Chain<double> chain{.is_two_sided = is_two_sided};
  for (int i = 0; i <= 40; ++i) chain.points.push_back({{0, i - 20.0}});
  if (!is_two_sided) std::ranges::reverse(chain.points);
  return chain;
}
template <>
MeshShape<double, 3> sheet<3>(bool is_two_sided) {
  auto mesh = irregular_mesh<double>(20, 20, 2, -20, -20, flat);
  mesh.is_two_sided = is_two_sided;
  for (auto& x : mesh.corners) x = {{x[2], x[0], x[1]}};
  if (!is_two_sided)
    for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  return mesh;
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
    ASSERT_TRUE(world.add_mesh({.shape = sheet<Dim>(shot % 2 == 0)}));
    BodyDefinition<double, Dim> body{.shape = bullet<Dim>(shot % 3)};
    body.position[0] = -3 - number(engine);
    for (std::size_t i = 1; i < Dim; ++i) body.position[i] = number(engine), body.velocity[i] = 3 * number(engine);
    body.velocity[0] = std::pow(10, 2 + number(engine));
    for (double& part : body.spin.components) part = 100 * number(engine);
    ASSERT_TRUE(world.add(body));
    FastMotion<double, Dim> motion(world);
    for (int k = 0; k < 40; ++k) {
      advance(motion, 1);
      ASSERT_LT(world.position[0][0], 0) << "shot " << shot << ", step " << k;
    }
  }
}
TEST(MeshMotion, NoBulletPassesASheet) {
  expect_no_bullet_passes<2>(60);
  expect_no_bullet_passes<3>(30);
}
// Beside small bodies triangles of 400 m leave few digits of single precision.
TEST(MeshMotion, NoBoxPassesTrianglesOfHundredsOfMetres) {
  std::mt19937 engine(1);
  const auto number = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine); };
  for (int shot = 0; shot < 200; ++shot) {
    World<float, 3> world;
    world.gravity[2] = -9.81f;
    TriangleMesh<float> mesh{.corners = {{{-400, -400, 0}}, {{400, -390, 0}}, {{380, 400, 0}}, {{-400, 410, 0}}},
                             .triangles = {{0, 1, 2}, {0, 2, 3}}};
    ASSERT_TRUE(world.add_mesh({.shape = mesh}));
    const float size = std::pow(10.0f, number(-1.7f, 0)), speed = std::pow(10.0f, number(0, 1));
    const Box<float, 3> box{{{size, size * number(0.3f, 1), size * number(0.1f, 1)}}};
    ASSERT_TRUE(world.add({.shape = box,
                           .position = {{number(-300, 300), number(-300, 300), size + number(0, 2)}},
                           .velocity = {{number(-1, 1) * speed, number(-1, 1) * speed, -speed}},
                           .spin = {{number(-20, 20), number(-20, 20), number(-20, 20)}}}));
    FastMotion<float, 3> motion(world);
    for (int k = 0; k < 60; ++k) {
      ASSERT_TRUE(motion.advance());
      ASSERT_GT(world.position[0][2], 0) << "shot " << shot << ", step " << k;
    }
  }
}
TEST(MeshMotion, TheBackOfAOneSidedMeshIsOpen) {
  World<double, 3> world;
  ASSERT_TRUE(world.add_mesh({.shape = sheet<3>(false)}));
  ASSERT_TRUE(world.add({.position = {{2, 0, 0}}, .velocity = {{-10, 0, 0}}}));
  FastMotion<double, 3> motion(world);
  advance(motion, 30);
  EXPECT_NEAR(world.position[0][0], -3, 1e-9);
}

TEST(MeshMotion, AStackStandsAsOnAWall) {
  const auto top = [](bool has_wall) {
    World<double, 3> world;
    world.gravity = {{0, 0, -9.81}};
    if (has_wall) {
      EXPECT_TRUE(world.add_wall({}));
    } else {
      EXPECT_TRUE(world.add_mesh({.shape = irregular_mesh<double>(12, 12, 0.3, -1.8, -1.8, flat)}));
    }
    for (int i = 0; i < 4; ++i) add_box<3>(world, {{0.02 * (i % 3), 0, i + 0.5}});
    FastMotion<double, 3> motion(world);
    advance(motion, 60);
    return world.position.back();
  };
  EXPECT_LT(length(Vector<double, 3>(top(true) - top(false))), 1e-6);
}
// Two sides of a right angle are sqrt(2) radii below the centre of a ball.
TEST(MeshMotion, ABallLiesInAGroove) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  ASSERT_TRUE(world.add_mesh({.shape = Chain<double>{{{{3, 3}}, {{1, 1}}, {{0, 0}}, {{-1, 1}}, {{-3, 3}}}}}));
  ASSERT_TRUE(world.add({.position = {{0.3, 1.2}}}));
  FastMotion<double, 2> motion(world);
  advance(motion, 240);
  EXPECT_NEAR(world.position[0][0], 0, 1e-4);
  EXPECT_NEAR(world.position[0][1], 0.5 * std::sqrt(2), 1e-4);
}
TEST(MeshMotion, ABoxLiesAtTheEdgeOfAStep) {
  World<double, 2> world;  // its centre is over the step, most of it over the edge or beside the next step
  world.gravity = {{0, -9.81}};
  ASSERT_TRUE(
      world.add_mesh({.shape = Chain<double>{{{{9, -5}}, {{0, -5}}, {{0, 0}}, {{-1, 0}}, {{-1, 2}}, {{-9, 2}}}}}));
  for (const double x : {-0.45, -0.5}) {
    ASSERT_TRUE(world.add({.shape = Box<double, 2>{{{0.98, 1}}}, .position = {{x, 0.5}}}));
    FastMotion<double, 2> motion(world);
    advance(motion, 60);
    EXPECT_NEAR(world.position[0][0], x, 1e-6);
    EXPECT_NEAR(world.position[0][1], 0.5, 1e-6);
    world.remove(world.handle(0));
  }
}

template <class Real>
World<Real, 3> falling_on_hills() {
  std::mt19937 engine(3);
  const auto number = [&](double low, double high) {
    return static_cast<Real>(low + (high - low) * (static_cast<double>(engine()) / 4294967296.0));
  };
  World<Real, 3> world;
  world.gravity = {{0, 0, Real(-9.81)}};
  EXPECT_TRUE(world.add_mesh({.shape = irregular_mesh<Real>(10, 10, 0.8, -4, -4, hill)}));
  for (int k = 0; k < 12; ++k) {
    BodyDefinition<Real, 3> body{.position = {{number(-2, 2), number(-2, 2), 2 + number(0, 4)}}};
    for (Real& part : body.spin.components) part = number(-5, 5);
    if (k % 4 == 0) body.shape = Box<Real, 3>{{{number(0.3, 1), number(0.3, 1), number(0.3, 1)}}};
    if (k % 4 == 1) body.shape = Capsule<Real>{number(0.3, 1), number(0.1, 0.3)};
    if (k % 4 == 2) body.shape = Box<Real, 3>{{{Real(0.5), Real(0.4), Real(0.6)}}, Real(0.05)};
    if (k % 4 == 3)
      body.shape = Compound<Real, 3>{{{.shape = Sphere<Real>{Real(0.2)}},
                                      {.shape = Capsule<Real>{Real(0.5), Real(0.1)}, .position = {{Real(0.3), 0, 0}}}}};
    EXPECT_TRUE(world.add(body));
  }
  return world;
}
TEST(MeshMotion, BodiesOfAllShapesComeToRestOnHills) {
  auto world = falling_on_hills<double>();
  FastMotion<double, 3> motion(world);
  advance(motion, 150);
  for (std::size_t i = 0; i < world.size(); ++i) {
    const auto& x = world.position[i];
    if (std::abs(x[0]) > 3.5 || std::abs(x[1]) > 3.5) continue;  // over the border
    EXPECT_GT(x[2], hill(x[0], x[1]) + 0.05) << i;
  }
  EXPECT_LT(motion.deepest_overlap(), 0.01);
}
template <class Real>
void expect_equal_for_any_number_of_threads() {
  std::set<std::uint64_t> hashes;
  for (const int threads : {1, 3}) {
    World<Real, 3> world = falling_on_hills<Real>();
    FastMotion<Real, 3> motion(world, {.threads = threads});
    for (int k = 0; k < 60; ++k) ASSERT_TRUE(motion.advance());
    hashes.insert(state_hash(world));
  }
  EXPECT_EQ(hashes.size(), 1u);
}
TEST(MeshMotion, ResultsDoNotDependOnThreads) {
  expect_equal_for_any_number_of_threads<double>();
  expect_equal_for_any_number_of_threads<float>();
}
TEST(MeshMotion, ASnapshotContinuesToTheBit) {
  auto world = falling_on_hills<double>();
  ASSERT_TRUE(world.add_mesh({.shape = HeightField<double, 3>{.counts = {2, 2}, .heights = {0, 0, 0, 0}}}));
  FastMotion<double, 3> motion(world);
  advance(motion, 40);
  const Bytes bytes = snapshot(world, motion);
  World<double, 3> again;
  FastMotion<double, 3> motion_again(again);
  const Status status = restore(bytes, again, motion_again);
  ASSERT_TRUE(status) << describe(status);
  EXPECT_EQ(snapshot(again, motion_again), bytes);
  advance(motion, 20), advance(motion_again, 20);
  EXPECT_EQ(state_hash(again), state_hash(world));
}

TEST(MeshMotion, ContactsWithMeshesHaveEvents) {
  World<double, 3> world;
  world.gravity = {{0, 0, -9.81}};
  ASSERT_TRUE(world.add_wall({.offset = -10}));
  const auto other = world.add_mesh({.shape = irregular_mesh<double>(2, 2, 1, 50, 50, flat)});
  const auto mesh = world.add_mesh({.shape = irregular_mesh<double>(8, 8, 0.5, -2, -2, flat)});
  ASSERT_TRUE(other && mesh);
  ASSERT_TRUE(world.add({.shape = Box<double, 3>{}, .position = {{0, 0, 0.6}}}));
  FastMotion<double, 3> motion(world, {.contact_events = 100});
  std::vector<ContactEvent<double, 3>> events;
  for (int k = 0; k < 60; ++k) {
    advance(motion, 1);
    events.insert(events.end(), motion.contact_events().begin(), motion.contact_events().end());
  }
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.front().change, ContactChange::begin);
  EXPECT_TRUE(events.front().with_mesh() && !events.front().with_wall());
  EXPECT_EQ(events.front().mesh, mesh->slot);
  EXPECT_LT(length(Vector<double, 3>(events.front().normal - Vector<double, 3>{{0, 0, -1}})), 1e-9);
  world.position[0][2] += 1;
  advance(motion, 1);
  ASSERT_EQ(motion.contact_events().size(), 1u);
  EXPECT_EQ(motion.contact_events()[0].change, ContactChange::end);
  EXPECT_GT(motion.contact_events()[0].impulse, 9.81 * 0.5);  // half a second of its weight, and the impact
}
TEST(MeshMotion, WhatRestsOnAMeshFallsWithoutIt) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  const auto mesh = world.add_mesh({.shape = flat_chain(10, 1, -5)});
  ASSERT_TRUE(mesh);
  const auto box = add_box<2>(world, {{0, 0.5}});
  FastMotion<double, 2> motion(world, {.sleep_after = 0.5});
  advance(motion, 120);
  EXPECT_EQ(motion.statistics().asleep, 1u);
  EXPECT_TRUE(world.remove_mesh(*mesh));
  EXPECT_FALSE(world.has_mesh(*mesh) || world.has_meshes() || world.remove_mesh(*mesh));
  advance(motion, 60);
  EXPECT_LT(world.position_of(box)[1], -3);
  const auto later = world.add_mesh({.shape = flat_chain(10, 1, -5)});
  EXPECT_EQ(later->slot, mesh->slot);
  EXPECT_NE(*later, *mesh);
}
TEST(MeshMotion, CategoriesChooseMeshes) {
  World<double, 3> world;  // of balls only
  world.gravity = {{0, 0, -9.81}};
  ASSERT_TRUE(world.add_mesh({.shape = irregular_mesh<double>(8, 8, 1, -4, -4, flat), .mask = 2}));
  for (const std::uint64_t category : {std::uint64_t{1}, std::uint64_t{2}})
    ASSERT_TRUE(world.add({.position = {{1.2 * double(category), 0, 0.5}}, .traits = {.category = category}}));
  FastMotion<double, 3> motion(world);
  advance(motion, 60);
  EXPECT_LT(world.position[0][2], -3);
  EXPECT_NEAR(world.position[1][2], 0.5, 1e-3);
}
TEST(MeshMotion, TheExactMotionRefusesMeshes) {
  World<double, 2> world;
  ASSERT_TRUE(world.add_mesh({.shape = flat_chain(10, 1, -5)}));
  ASSERT_TRUE(world.add({}));
  ExactMotion<double, 2> motion(world);
  EXPECT_EQ(motion.advance_to(1).message, "the exact motion knows no static meshes: use FastMotion for them");
}

}  // namespace
}  // namespace continuo::mesh_motion_test
