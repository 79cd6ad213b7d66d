// Queries by shapes, and of worlds with static meshes, against brute force and closed forms.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "meshes.hpp"
#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/bodies/queries.hpp>
#include <continuo/shapes/closest_points.hpp>

namespace continuo::shape_queries_test {

using namespace test;  // meshes.hpp

namespace {

template <int Dim>
Vector<double, Dim> random_vector(std::mt19937& engine, double most) {
  std::uniform_real_distribution<double> number(-most, most);
  Vector<double, Dim> v;
  for (double& part : v.components) part = number(engine);
  return v;
}
template <int Dim>
Shape<double, Dim> random_shape(std::mt19937& engine, int kind) {
  Box<double, Dim> box;
  for (double& side : box.size.components) side = 0.3 + std::abs(random_vector<Dim>(engine, 1)[0]);
  if (kind == 0) return Sphere<double>{0.4};
  if (kind == 1) return Capsule<double>{0.8, 0.2};
  if (kind == 2) return box;
  if (kind == 3) {
    Compound<double, Dim> both;
    both.parts.resize(2);
    both.parts[0].shape = box;
    both.parts[1].shape = Sphere<double>{0.3}, both.parts[1].position = random_vector<Dim>(engine, 1);
    return both;
  }
  box.rounding = 0.1;
  return box;
}
template <int Dim>
Orientation<double, Dim> random_turn(std::mt19937& engine) {
  auto turn = upright<double, Dim>();
  for (double& part : turn.components) part += random_vector<Dim>(engine, 2)[0];
  return turn;
}
double hill(double x, double y) {
  return 0.4 * std::sin(1.1 * x) + 0.3 * std::cos(0.9 * y) - 1;
}
MeshShape<double, 2> ground(std::integral_constant<int, 2>) {
  Chain<double> chain{.is_two_sided = true};
  for (int i = 0; i <= 30; ++i) chain.points.push_back({{6 - 0.4 * i, hill(i, 0)}});
  return chain;
}
MeshShape<double, 3> ground(std::integral_constant<int, 3>) {
  auto mesh = irregular_mesh<double>(10, 10, 1.2, -6, -6, hill);
  mesh.is_two_sided = true;
  return mesh;
}
template <int Dim>
World<double, Dim> random_world(std::mt19937& engine) {
  World<double, Dim> world;
  for (int k = 0; k < 15; ++k) {
    BodyDefinition<double, Dim> body;
    body.shape = random_shape<Dim>(engine, k % 5);
    body.position = random_vector<Dim>(engine, 4), body.orientation = random_turn<Dim>(engine);
    body.traits.category = k % 2 == 0 ? 1 : 2;
    EXPECT_TRUE(world.add(body));
  }
  EXPECT_TRUE(world.add_wall({.offset = -3}));
  EXPECT_TRUE(world.add_mesh({.shape = ground(std::integral_constant<int, Dim>{}), .category = 2}));
  return world;
}

/// The least distance of a shape, moved by `shift`, to what the filter selects: all pairs of parts.
template <int Dim>
double distance(const World<double, Dim>& world, const PlacedShape<double, Dim>& placed,
                const Vector<double, Dim>& shift, const QueryFilter& filter) {
  using Part = std::pair<Convex<double, Dim>, Pose<double, Dim>>;
  const auto parts_of = [](const Shape<double, Dim>& shape, const Vector<double, Dim>& at,
                           Orientation<double, Dim> orientation) {
    if (Dim == 3) orientation *= 1 / length(orientation);
    const auto made = *solid(shape);
    std::vector<Part> parts;
    const Matrix<double, Dim> axes = rotation(orientation);
    for (const auto& part : made.parts)
      parts.push_back({part.convex, {at + axes * (made.centre + part.in_solid.centre), axes * part.in_solid.axes}});
    return parts;
  };
  std::vector<Part> others;
  for (std::size_t i = 0; i < world.size(); ++i) {
    if ((world.traits(i).category & filter.categories) == 0) continue;
    const auto* const of_body = world.solid(i);
    const auto parts = parts_of(of_body ? of_body->shape : Shape<double, Dim>(Sphere<double>{world.radius[i]}),
                                world.origin(i), world.orientation[i]);
    others.insert(others.end(), parts.begin(), parts.end());
  }
  const WorldMesh<double, Dim>& mesh = world.meshes()[0];
  for (std::uint32_t f = 0; (mesh.category & filter.categories) != 0 && f < mesh.geometry->size(); ++f) {
    const auto corners = mesh.geometry->corners(f);
    others.push_back({{.core = {.corners = {corners.begin(), corners.end()}}}, {}});
  }
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [part, pose] : parts_of(placed.shape, placed.position + shift, placed.orientation)) {
    for (const auto& [other, there] : others)
      least = std::min(least, closest_points(part.core, other.core, relative(pose, there)).distance - part.rounding -
                                  other.rounding);
    for (const auto& wall : world.walls())
      for (const auto& corner : part.core.corners)
        least = std::min(least, dot(wall.normal, pose.place(corner)) - wall.offset - part.rounding);
  }
  return least;
}

template <int Dim>
void expect_answers_of_brute_force(unsigned seed) {
  std::mt19937 engine(seed);
  const auto world = random_world<Dim>(engine);
  const Queries<double, Dim> queries(world);
  int hits = 0, overlaps = 0;
  for (int k = 0; k < 40; ++k) {
    PlacedShape<double, Dim> shape;
    shape.shape = random_shape<Dim>(engine, k % 5);
    shape.position = random_vector<Dim>(engine, 5), shape.orientation = random_turn<Dim>(engine);
    const QueryFilter filter{.categories = k % 3 == 0 ? 1u : 3u};
    const double now = distance<Dim>(world, shape, {}, filter);
    const auto touched = queries.in_shape(shape, filter);
    const auto near = queries.near_shape(shape, 0.5, filter);
    ASSERT_TRUE(touched && near);
    const bool is_free = touched->bodies.empty() && touched->walls.empty() && touched->meshes.empty();
    if (std::abs(now) > 1e-9) {
      EXPECT_EQ(is_free, now > 0) << seed << ", " << k;
    }
    overlaps += is_free ? 0 : 1;
    if (now > 1e-3) {
      EXPECT_EQ(near->empty(), now > 0.5) << seed << ", " << k;
      if (!near->empty()) {
        EXPECT_NEAR(near->front().distance, now, 0.01) << seed << ", " << k;
      }
    }
    if (now <= 1e-3) continue;
    const Vector<double, Dim> way = random_vector<Dim>(engine, 6);
    const auto contact = queries.first_contact(shape, way, filter);
    ASSERT_TRUE(contact);
    // The referee steps along the way, by no more than what is free.
    double expected = 0, room = now;
    while (expected < length(way) && room > 1e-6)
      room = distance<Dim>(world, shape, way * (std::min(1.0, (expected += room) / length(way))), filter);
    ASSERT_EQ(contact->empty(), expected >= length(way)) << seed << ", " << k;
    if (contact->empty()) continue;
    ++hits;
    // At the contact the surfaces touch, and before it they do not.
    const double at = distance<Dim>(world, shape, way * (contact->front().distance / length(way)), filter);
    EXPECT_NEAR(at, 0, 3e-5) << seed << ", " << k;
    EXPECT_NEAR(contact->front().distance, expected, 1e-2) << seed << ", " << k;
    EXPECT_LT(dot(contact->front().normal, way), 0) << seed << ", " << k;
  }
  EXPECT_GT(hits, 2);
  EXPECT_GT(overlaps, 2);
}
TEST(ShapeQueries, AnswersAreThoseOfBruteForce) {
  for (const unsigned seed : {1u, 2u}) expect_answers_of_brute_force<2>(seed), expect_answers_of_brute_force<3>(seed);
}

TEST(ShapeQueries, RaysHitMeshesFromTheirFreeSide) {
  World<double, 3> world;
  auto sheet = irregular_mesh<double>(12, 12, 0.5, -3, -3, [](double x, double) { return 0.5 * x; });
  const auto one = world.add_mesh({.shape = sheet});
  ASSERT_TRUE(one);
  const Queries<double, 3> queries(world);
  std::mt19937 engine(4);
  Vector<double, 3> normal{{-0.5, 0, 1}};
  normal *= 1 / length(normal);
  for (int k = 0; k < 500; ++k) {
    const auto through = random_vector<3>(engine, 2);
    // Every other ray goes through a corner of a triangle.
    const Vector<double, 3> target = k % 2 == 0 ? Vector<double, 3>{{through[0], through[1], 0.5 * through[0]}}
                                                : sheet.corners[static_cast<std::size_t>(40 + k % 90)];
    if (std::abs(target[0]) > 2.5 || std::abs(target[1]) > 2.5) continue;
    const Vector<double, 3> from = target + Vector<double, 3>{{through[2], through[0], 3}};
    const auto down = queries.first_hit({.origin = from, .direction = target - from});
    ASSERT_TRUE(down);
    ASSERT_EQ(down->size(), 1u) << k;
    EXPECT_EQ(down->front().mesh, one->slot);
    EXPECT_NEAR(down->front().distance, length(Vector<double, 3>(target - from)), 1e-12);
    EXPECT_LT(length(Vector<double, 3>(down->front().normal - normal)), 1e-12);
    EXPECT_TRUE(queries.first_hit({.origin = target * 2 - from, .direction = from - target})->empty());
  }
  EXPECT_TRUE(queries.first_hit({.origin = {{0, 0, 9}}, .direction = {{0, 0, -1}}}, {.meshes = false})->empty());
  EXPECT_EQ(queries.all_hits({.origin = {{0.1, 0.2, 9}}, .direction = {{0, 0, -1}}})->size(), 1u);
  EXPECT_EQ(queries.in_sphere({{0, 0, 1}}, 1)->meshes.size(), 1u);
  EXPECT_EQ(queries.in_sphere({{0, 0, 1}}, 0.89)->meshes.size(), 0u);  // 2 / sqrt(5) from the plane
  EXPECT_EQ(queries.in_box({{-1, -1, 0}}, {{1, 1, 1}})->meshes.size(), 1u);
  EXPECT_EQ(queries.in_box({{-1, -1, 0.6}}, {{1, 1, 1}})->meshes.size(), 0u);
}

TEST(ShapeQueries, BatchesAnswerAsSingleRays) {
  std::mt19937 engine(8);
  const auto world = random_world<3>(engine);
  const Queries<double, 3> queries(world);
  std::vector<Ray<double, 3>> rays;
  for (int k = 0; k < 600; ++k)
    rays.push_back({.origin = random_vector<3>(engine, 6), .direction = random_vector<3>(engine, 1), .reach = 5});
  const auto hits = queries.first_hits(rays, {}, 2);
  ASSERT_TRUE(hits);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const auto one = queries.first_hit(rays[k]);
    ASSERT_EQ(one->empty(), std::isinf((*hits)[k].distance));
    if (one->empty()) continue;
    EXPECT_EQ(one->front().distance, (*hits)[k].distance);
    EXPECT_EQ(one->front().body, (*hits)[k].body);
    EXPECT_EQ(one->front().facet, (*hits)[k].facet);
  }
  rays[7].direction = {};
  EXPECT_EQ(queries.first_hits(rays).status().message, "ray 7: the direction of a ray must not be 0");
  EXPECT_EQ(queries.first_contact({.shape = Sphere<double>{-1}}, {{1, 0, 0}}).status().message,
            "the radius must be greater than 0, and finite, not -1.000000");
}

}  // namespace
}  // namespace continuo::shape_queries_test
