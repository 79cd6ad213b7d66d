// Rays by the tree with four children and by planes in registers, against the tests of all bodies one by one.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/bounds/way_tree.hpp>
#include <continuo/bodies/queries.hpp>
#include <continuo/shapes/direction_of.hpp>
#include <continuo/shapes/ray_entry.hpp>
#include <continuo/status/require.hpp>

namespace continuo::ray_search_test {
namespace {

/// Numbers of which many are the same: halves, quarters, 0.
template <class Real, int Size>
Vector<Real, Size> round_vector(std::mt19937& engine, int most) {
  std::uniform_int_distribution<int> number(-4 * most, 4 * most);
  Vector<Real, Size> v;
  for (Real& part : v.components) part = static_cast<Real>(number(engine)) / 4;
  return v;
}
template <class Real, int Size>
Vector<Real, Size> random_vector(std::mt19937& engine, Real most) {
  std::uniform_real_distribution<Real> number(-most, most);
  Vector<Real, Size> v;
  for (Real& part : v.components) part = number(engine);
  return v;
}

template <class Real, int Dim>
std::vector<Bounds<Real, Dim>> strange_bounds(std::mt19937& engine) {
  std::vector<Bounds<Real, Dim>> all;
  for (int k = 0; k < 200; ++k) {
    const Vector<Real, Dim> corner = round_vector<Real, Dim>(engine, 5);
    Vector<Real, Dim> size = round_vector<Real, Dim>(engine, 1);
    for (Real& edge : size.components) edge = std::abs(edge);  // 0 too
    all.push_back({corner, corner + size});
  }
  all.push_back({});
  all.push_back({round_vector<Real, Dim>(engine, 1), {}});
  all.back().upper[0] = std::numeric_limits<Real>::infinity();
  all.push_back(all[0]);
  all.back().lower[0] = std::numeric_limits<Real>::quiet_NaN();
  return all;
}
/// Boxes and points on ways along axes, along faces, through corners, and not at all.
template <class Real, int Dim>
Vector<Real, Dim> far_corner() {
  Vector<Real, Dim> corner;
  for (Real& part : corner.components) part = std::numeric_limits<Real>::infinity();
  return corner;
}
template <class Real, int Dim>
BoxSweep<Real, Dim> strange_sweep(std::mt19937& engine, int k) {
  BoxSweep<Real, Dim> sweep;
  sweep.begin.lower = sweep.begin.upper = round_vector<Real, Dim>(engine, 6);
  if (k % 3 == 0)
    for (Real& bound : sweep.begin.upper.components) bound += Real(0.5);
  sweep.way = k % 2 == 0 ? round_vector<Real, Dim>(engine, 1) : random_vector<Real, Dim>(engine, Real(3));
  if (k % 7 == 0) sweep.way[0] = std::numeric_limits<Real>::denorm_min();
  if (k % 11 == 0) sweep.way = {};
  if (k % 5 == 0) sweep.end = std::numeric_limits<Real>::infinity();
  // As that of a shape whose size is near the greatest number.
  if (k % 13 == 0) sweep.begin = {-far_corner<Real, Dim>(), far_corner<Real, Dim>()};
  return sweep;
}
template <class Tree, class Sweep>
std::set<std::uint32_t> leaves_on_way(const Tree& tree, const Sweep& sweep) {
  std::set<std::uint32_t> found;
  tree.for_each_on_way(sweep, [&](std::uint32_t leaf, const auto&) {
    EXPECT_TRUE(found.insert(leaf).second) << "a leaf is visited twice";
    return sweep.end;
  });
  return found;
}
template <class Real, int Dim>
void expect_same_leaves() {
  std::mt19937 engine(3);
  for (int round = 0; round < 4; ++round) {
    auto bounds = strange_bounds<Real, Dim>(engine);
    if (round == 3) bounds.resize(1);
    const BoundsTree<Real, Dim> tree(bounds);
    const WayTree<Real, Dim> wide(tree);
    for (int k = 0; k < 1000; ++k) {
      const auto sweep = strange_sweep<Real, Dim>(engine, k);
      const auto leaves = leaves_on_way(wide, sweep);
      // A sweep that is not finite meets whatever it may meet, once.
      if (k % 13 == 0) continue;
      ASSERT_EQ(leaves, leaves_on_way(tree, sweep)) << "round " << round << ", way " << k;
    }
  }
}
TEST(RaySearch, BothTreesVisitTheSameLeaves) {
  expect_same_leaves<float, 2>();
  expect_same_leaves<float, 3>();
  expect_same_leaves<double, 2>();
  expect_same_leaves<double, 3>();
}

/// Half the bodies lie on a grid and are not turned, so that rays of round numbers meet their edges exactly.
template <class Real, int Dim>
World<Real, Dim> crowd(std::mt19937& engine, const Vector<Real, Dim>& middle) {
  World<Real, Dim> world;
  for (int k = 0; k < 60; ++k) {
    const bool is_round = k % 2 == 0;
    BodyDefinition<Real, Dim> body{.position = is_round ? round_vector<Real, Dim>(engine, 4)
                                                        : random_vector<Real, Dim>(engine, Real(4))};
    body.position += middle;
    if (!is_round) body.orientation = random_vector < Real, Dim == 2 ? 1 : 4 > (engine, Real(3));
    if (k / 2 % 5 == 0) body.shape = Sphere<Real>{Real(0.5)};
    if (k / 2 % 5 == 1) body.shape = Capsule<Real>{Real(0.5), Real(0.25)};
    if (k / 2 % 5 == 2) body.shape = Box<Real, Dim>{};
    Hull<Real, Dim> hull;
    for (int point = 0; point < 14; ++point) hull.points.push_back(random_vector<Real, Dim>(engine, Real(0.6)));
    if (k / 2 % 5 == 3) body.shape = hull;
    if (k / 2 % 5 == 4)
      body.shape = Compound<Real, Dim>{{{.shape = Box<Real, Dim>{}}, {.shape = hull, .position = {{Real(0.5)}}}}};
    require(world.add(body).status());
  }
  return world;
}
template <class Real, int Dim>
Ray<Real, Dim> ray_for(const World<Real, Dim>& world, const Vector<Real, Dim>& middle, std::mt19937& engine, int k) {
  Ray<Real, Dim> ray{.origin =
                         k % 2 == 0 ? round_vector<Real, Dim>(engine, 6) : random_vector<Real, Dim>(engine, Real(6))};
  ray.origin += middle;
  ray.direction = k % 3 == 0 ? round_vector<Real, Dim>(engine, 1) : random_vector<Real, Dim>(engine, Real(1));
  if (k % 4 == 0) {  // at a corner of a body
    const std::size_t i = engine() % world.size();
    if (const auto* const solid = world.solid(i)) {
      const auto& part = solid->parts.front();
      const auto& corners = part.convex.core.corners;
      const Vector<Real, Dim> in_solid = part.in_solid.place(corners[engine() % corners.size()]);
      ray.direction = world.position[i] + rotation(world.orientation[i]) * in_solid - ray.origin;
    }
  }
  if (k % 5 == 0) ray.direction = {}, ray.direction[engine() % Dim] = engine() % 2 == 0 ? Real(1) : Real(-1);
  if (ray.direction == Vector<Real, Dim>{}) ray.direction[0] = Real(1);
  if (k % 6 == 0) ray.reach = Real(3);
  return ray;
}
/// The distance to body i; infinite where the ray misses it. Planes are asked one by one.
template <class Real, int Dim>
Real distance_to(const World<Real, Dim>& world, std::size_t i, const Ray<Real, Dim>& ray) {
  Real least = std::numeric_limits<Real>::infinity();
  const Pose<Real, Dim> pose{world.position[i], rotation(world.orientation[i])};
  for (const auto& part : world.solid(i)->parts) {
    const Pose<Real, Dim> at{pose.place(part.in_solid.centre), pose.axes * part.in_solid.axes};
    const auto entry = ray_entry(part.convex, at.local(ray.origin), at.local_direction(ray.direction), ray.reach);
    if (entry) least = std::min(least, entry->distance);
  }
  return least;
}
template <class Real, int Dim>
void expect_nearest_of_all() {
  std::mt19937 engine(5);
  int hits = 0;
  for (int round = 0; round < 4; ++round) {
    // Far from the origin, too, where places have fewer digits.
    const auto middle = round < 2 ? Vector<Real, Dim>{} : round_vector<Real, Dim>(engine, 1000);
    const World<Real, Dim> world = crowd<Real, Dim>(engine, middle);
    const Queries<Real, Dim> queries(world);
    std::vector<Ray<Real, Dim>> rays;
    for (int k = 0; k < 2000; ++k) rays.push_back(ray_for(world, middle, engine, k));
    const auto found = require(queries.first_hits(rays));
    for (std::size_t k = 0; k < rays.size(); ++k) {
      Ray<Real, Dim> ray = rays[k];
      ray.direction = direction_of(ray.direction);
      std::size_t nearest = 0;
      Real least = std::numeric_limits<Real>::infinity();
      for (std::size_t i = 0; i < world.size(); ++i) {
        const World<Real, Dim> alone =
            world.solid(i) ? World<Real, Dim>{} : world.part(std::array{static_cast<std::uint32_t>(i)});
        Real distance = std::numeric_limits<Real>::infinity();
        if (world.solid(i))
          distance = distance_to(world, i, ray);
        else
          for (const auto& hit : require(Queries<Real, Dim>(alone).first_hit(rays[k]))) distance = hit.distance;
        if (distance < least) least = distance, nearest = i;
      }
      ASSERT_EQ(found[k].distance, least) << "round " << round << ", ray " << k;
      const auto single = require(queries.first_hit(rays[k]));
      ASSERT_EQ(single.empty(), !std::isfinite(least));
      if (single.empty()) continue;
      ++hits;
      ASSERT_EQ(world.index(found[k].body), nearest) << "round " << round << ", ray " << k;
      ASSERT_TRUE(single[0].body == found[k].body && single[0].normal == found[k].normal);
    }
  }
  EXPECT_GT(hits, 1600);
}
TEST(RaySearch, FindsTheNearestOfAllBodies) {
  expect_nearest_of_all<float, 2>();
  expect_nearest_of_all<float, 3>();
  expect_nearest_of_all<double, 2>();
  expect_nearest_of_all<double, 3>();
}

}  // namespace
}  // namespace continuo::ray_search_test
