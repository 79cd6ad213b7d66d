// Fast bodies at walls: the contact has those corners that touch, also where a step takes a body farther than it is
// thick, and no body gets into a wall or through a thin one.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/shapes/plane_manifold.hpp>

namespace continuo::fast_at_walls_test {
namespace {

using test::upright_vector;
constexpr double pi = 3.14159265358979323846;

template <int Dim>
[[nodiscard]] double lowest_point(const World<double, Dim>& world, std::size_t i) {
  const auto axes = rotation(world.orientation[i]);
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& part : world.solid(i)->parts)
    for (const auto& corner : part.convex.core.corners)
      lowest =
          std::min(lowest, (world.position[i] + axes * part.in_solid.place(corner))[Dim - 1] - part.convex.rounding);
  return lowest;
}
template <int Dim>
[[nodiscard]] Box<double, Dim> flat_box(double width, double thickness) {
  Box<double, Dim> box;
  for (std::size_t axis = 0; axis + 1 < Dim; ++axis) box.size[axis] = width;
  box.size[Dim - 1] = thickness;
  return box;
}
/// A prism over a polygon, in the plane a trapezium, that lies on its wider side.
template <int Dim>
[[nodiscard]] Hull<double, Dim> flat_hull(int corners) {
  Hull<double, Dim> hull;
  for (const double height : {0.0, 0.3})
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * pi * k / corners;
      auto point = upright_vector<Dim>((1 - height / 2) * std::cos(angle), height);
      if constexpr (Dim == 3) point[1] = (1 - height / 2) * std::sin(angle);
      hull.points.push_back(point);
    }
  return hull;
}

// Up to 45 degrees, no upper corner of a box of any shape is held: in the plane the two lower ones are those of the
// side that faces the wall, in space the four of the face.
template <int Dim>
void expect_lower_corners(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> part(0, 1);
  Box<double, Dim> box;
  for (std::size_t axis = 0; axis < Dim; ++axis) box.size[axis] = 0.02 + part(engine);
  const auto made = solid<double, Dim>(Shape<double, Dim>(box));
  ASSERT_TRUE(made);
  const auto& body = made->parts[0].convex;
  auto normal = upright_vector<Dim>(0, 1);
  for (std::size_t axis = 0; axis + 1 < Dim; ++axis) normal[axis] = (2 * part(engine) - 1) * std::sqrt(0.9 / (Dim - 1));
  normal *= 1 / length(normal);
  constexpr double margin = 100;
  const auto touching = manifold(body, Plane<double, Dim>{normal, -2}, margin);
  ASSERT_EQ(touching.size, (Manifold<double, Dim>::most_points));
  for (const auto& point : touching.all())
    EXPECT_LT(body.core.corners[point.feature][Dim - 1], 0) << Dim << " dimensions, seed " << seed;
}
TEST(FastAtWalls, ContactsHaveTheLowerCornersOfBoxes) {
  for (unsigned seed = 1; seed <= 200; ++seed) expect_lower_corners<2>(seed), expect_lower_corners<3>(seed);
}

// A body that slides is slowed by mu g until it stands, after v^2 / (2 mu g), to the part of a step by which its end is
// not known: v step / 2 of the whole. It stays on the floor.
template <int Dim>
void expect_slide(const Shape<double, Dim>& shape, double v) {
  constexpr double friction = 1, g = 9.81, step = 1.0 / 60;
  auto world = test::world_on_slope<Dim>(0, friction);
  ASSERT_TRUE(world.add(
      {.shape = shape, .velocity = upright_vector<Dim>(v, 0), .mass = 2, .material = {.friction = friction}}));
  world.position[0][Dim - 1] -= lowest_point(world, 0);
  const double from = world.position[0][0], expected = v * v / (2 * friction * g);
  FastMotion<double, Dim> motion(world, {.step = step});
  for (double t = 0; t < v / (friction * g) + 0.5; t += step) {
    ASSERT_TRUE(motion.advance());
    ASSERT_GE(lowest_point(world, 0), -1e-3) << Dim << " dimensions, " << v << " m/s, t = " << t;
  }
  EXPECT_NEAR(world.position[0][0] - from, expected, v * step / 2) << Dim << " dimensions, " << v << " m/s";
}
template <int Dim>
void expect_slides() {
  for (const double v : {1.0, 5.0, 20.0, 50.0}) {
    for (const double thickness : {0.02, 0.1, 0.4, 1.0}) expect_slide<Dim>(flat_box<Dim>(1.5, thickness), v);
    for (const int corners : {4, 7, 20}) expect_slide<Dim>(flat_hull<Dim>(Dim == 2 ? 2 : corners), v);
  }
}
TEST(FastAtWalls, FlatBodiesSlideAsFarAsFrictionLetsThem) {
  expect_slides<2>(), expect_slides<3>();
}

// In a fast fall a body is never deeper than a quarter of its inner radius, where a step in which it turns into the
// wall ends, and no body is on the other side of a thin wall.
template <int Dim>
void expect_no_passage(const Shape<double, Dim>& shape, double inner_radius, double v, bool is_thin) {
  for (int k = 0; k < 24; ++k) {
    World<double, Dim> world;
    ASSERT_TRUE(world.add_wall({.normal = upright_vector<Dim>(0, 1), .thin = is_thin}));
    ASSERT_TRUE(world.add({.shape = shape,
                           .position = upright_vector<Dim>(0, 2 + 0.06 * k),
                           .velocity = upright_vector<Dim>(3, -v),
                           .orientation = test::tilted<Dim>(0.3 * k),
                           .mass = 1,
                           .material = {.restitution = 0.3}}));
    FastMotion<double, Dim> motion(world);
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(motion.advance());
      ASSERT_GE(lowest_point(world, 0), -0.5 * inner_radius)
          << Dim << " dimensions, " << v << " m/s, number " << k << ", step " << i;
    }
  }
}
template <int Dim>
void expect_no_passages() {
  for (const bool is_thin : {false, true})
    for (const double v : {5.0, 20.0, 50.0, 200.0}) {
      expect_no_passage<Dim>(flat_box<Dim>(0.4, 0.4), 0.2, v, is_thin);
      expect_no_passage<Dim>(flat_box<Dim>(2, 0.1), 0.05, v, is_thin);
      expect_no_passage<Dim>(Capsule<double>{0.5, 0.1}, 0.1, v, is_thin);
    }
}
TEST(FastAtWalls, NoBodyGetsIntoAWallOrThroughAThinOne) {
  expect_no_passages<2>(), expect_no_passages<3>();
}

}  // namespace
}  // namespace continuo::fast_at_walls_test
