// Queries of worlds with boxes, capsules, hulls and compounds, against points that are tried one by one.
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include <continuo/bodies/queries.hpp>
#include <continuo/shapes/ray_entry.hpp>

namespace continuo::solid_queries_test {
namespace {

template <int Dim>
Vector<double, Dim> random_vector(std::mt19937& engine, double most) {
  std::uniform_real_distribution<double> number(-most, most);
  Vector<double, Dim> v;
  for (double& part : v.components) part = number(engine);
  return v;
}
template <int Dim>
World<double, Dim> random_world(std::mt19937& engine) {
  World<double, Dim> world;
  for (int k = 0; k < 12; ++k) {
    BodyDefinition<double, Dim> body{.position = random_vector<Dim>(engine, 4)};
    for (double& part : body.orientation.components) part += random_vector<Dim>(engine, 2)[0];
    Box<double, Dim> box;
    for (double& side : box.size.components) side = 0.3 + std::abs(random_vector<Dim>(engine, 1)[0]);
    if (k % 4 == 0) body.shape = box;
    if (k % 4 == 1) body.shape = Capsule<double>{1.2, 0.3};
    if (k % 4 == 2)
      body.shape = Compound<double, Dim>{
          {{.shape = box}, {.shape = Sphere<double>{0.4}, .position = random_vector<Dim>(engine, 1)}}};
    if (k % 4 == 3) {
      Hull<double, Dim> hull{.rounding = 0.1};
      for (int point = 0; point < 9; ++point) hull.points.push_back(random_vector<Dim>(engine, 0.7));
      body.shape = hull;
    }
    EXPECT_TRUE(world.add(body));
  }
  return world;
}
/// Whether a body contains a point: by the planes of its parts, or the distance to their cores.
template <int Dim>
double distance(const World<double, Dim>& world, std::size_t i, const Vector<double, Dim>& x) {
  double least = 1e300;
  const Vector<double, Dim> local =
      transposed_times(rotation(world.orientation[i]), Vector<double, Dim>(x - world.position[i]));
  for (const auto& part : world.solid(i)->parts) {
    const Polytope<double, Dim> point{.corners = {part.in_solid.local(local)}};
    least = std::min(least, closest_points(part.convex.core, point, {}).distance - part.convex.rounding);
  }
  return least;
}

template <int Dim>
void expect_rays_stop_at_surfaces() {
  std::mt19937 engine(11);
  for (int round = 0; round < 4; ++round) {
    const World<double, Dim> world = random_world<Dim>(engine);
    const Queries<double, Dim> queries(world);
    for (int k = 0; k < 60; ++k) {
      Ray<double, Dim> ray{
          .origin = random_vector<Dim>(engine, 8), .direction = random_vector<Dim>(engine, 1), .reach = 12};
      ray.direction *= 1 / length(ray.direction);
      const auto hits = queries.first_hit(ray);
      ASSERT_TRUE(hits);
      // The referee steps along the ray, by no more than what is free.
      std::optional<double> expected;
      for (double at = 0; at <= ray.reach && !expected;) {
        double room = 1e300;
        for (std::size_t i = 0; i < world.size(); ++i)
          room = std::min(room, distance<Dim>(world, i, ray.origin + ray.direction * at));
        if (room <= 2e-6) expected = at;
        at += std::max(room, 1e-6);
      }
      ASSERT_EQ(hits->empty(), !expected.has_value()) << "round " << round << ", ray " << k;
      if (expected) {
        EXPECT_NEAR(hits->front().distance, *expected, 1e-3) << "round " << round << ", ray " << k;
      }
      if (expected && *expected > 0) {
        EXPECT_LT(dot(hits->front().normal, ray.direction), 1e-6);
      }
    }
  }
}
TEST(SolidQueries, RaysStopAtSurfaces) {
  expect_rays_stop_at_surfaces<2>();
  expect_rays_stop_at_surfaces<3>();
}

template <int Dim>
void expect_regions_find_what_they_touch() {
  std::mt19937 engine(12);
  for (int round = 0; round < 10; ++round) {
    const World<double, Dim> world = random_world<Dim>(engine);
    const Queries<double, Dim> queries(world);
    for (int k = 0; k < 20; ++k) {
      const Vector<double, Dim> centre = random_vector<Dim>(engine, 5);
      const auto in_sphere = queries.in_sphere(centre, 1);
      const auto nearest = queries.nearest(centre, 1);
      ASSERT_TRUE(in_sphere && nearest);
      double least = 1e300;
      for (std::size_t i = 0; i < world.size(); ++i) {
        const double here = distance<Dim>(world, i, centre);
        least = std::min(least, here);
        const bool is_found = std::ranges::find(in_sphere->bodies, world.handle(i)) != in_sphere->bodies.end();
        EXPECT_EQ(is_found, here <= 1);
      }
      if (least > 0) {
        EXPECT_NEAR(nearest->front().distance, least, 1e-9);
      }
      if (least < 0) {
        EXPECT_LT(nearest->front().distance, 0);
      }
      Vector<double, Dim> half;
      for (double& part : half.components) part = 0.5;
      const auto in_box = queries.in_box(centre - half, centre + half);
      ASSERT_TRUE(in_box);
      for (std::size_t i = 0; i < world.size(); ++i) {
        const bool is_found = std::ranges::find(in_box->bodies, world.handle(i)) != in_box->bodies.end();
        const double here = distance<Dim>(world, i, centre);
        if (here < 0.5) {
          EXPECT_TRUE(is_found);
        }
        if (here > 0.5 * std::sqrt(Dim)) {
          EXPECT_FALSE(is_found);
        }
      }
    }
  }
}
TEST(SolidQueries, RegionsFindWhatTheyTouch) {
  expect_regions_find_what_they_touch<2>();
  expect_regions_find_what_they_touch<3>();
}

}  // namespace
}  // namespace continuo::solid_queries_test
