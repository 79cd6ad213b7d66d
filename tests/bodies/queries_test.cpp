// Queries of a world: the answers of the index against a search through all bodies.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/queries.hpp>

namespace continuo::queries_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

template <int Dim>
Vector<double, Dim> random_point(std::mt19937& engine, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  Vector<double, Dim> x;
  for (std::size_t axis = 0; axis < x.size(); ++axis) x[axis] = uniform(engine);
  return x;
}

/// Balls of all sizes, some far out, some at one place, in four groups; walls about half of them.
template <int Dim>
World<double, Dim> random_world(std::mt19937& engine, std::size_t count) {
  World<double, Dim> world;
  Vector<double, Dim> corner;
  for (std::size_t axis = 0; axis < corner.size(); ++axis) corner[axis] = 15;
  EXPECT_TRUE(world.add_container(-corner, corner));
  for (std::size_t i = 0; i < count; ++i) {
    const double size = i % 17 == 0 ? 1e4 : 10;
    BodyDefinition<double, Dim> ball{.shape = Sphere<double>{std::exp(0.3 * random_point<Dim>(engine, 10)[0] - 2)},
                                     .position = random_point<Dim>(engine, size)};
    if (i % 11 == 0) ball.position = {};
    ball.group = static_cast<std::uint32_t>(i % 4);
    EXPECT_TRUE(world.add(ball));
  }
  return world;
}

template <int Dim>
void rays_hit_what_they_should(unsigned seed) {
  std::mt19937 engine(seed);
  const World<double, Dim> world = random_world<Dim>(engine, 1 + engine() % 300);
  const Queries queries(world);
  for (int k = 0; k < 20; ++k) {
    Ray<double, Dim> ray{random_point<Dim>(engine, 12), random_point<Dim>(engine, 1)};
    if (k % 5 == 0) ray.direction[k % Dim == 0 ? 1 : 0] = 0;
    if (k % 3 == 0) ray.reach = 5;
    const QueryFilter filter{.groups = k % 2 == 0 ? ~0u : 0b0101u, .walls = k % 4 < 2};
    const auto unit = ray.direction * (1 / length(ray.direction));
    // Every body along the ray, by its nearest point to the line. Rays within rounding of a tangent are not counted.
    std::vector<double> expected;
    bool is_doubtful = false;
    for (std::size_t i = 0; i < world.size(); ++i) {
      if ((filter.groups >> world.group(i) & 1u) == 0) continue;
      const auto apart = world.position[i] - ray.origin;
      const double along = dot(apart, unit), r = world.radius[i], miss = length(apart - unit * along);
      is_doubtful = is_doubtful || std::abs(miss - r) < 1e-9;
      const double distance = length(apart) <= r ? 0 : along - std::sqrt(std::max(0.0, r * r - miss * miss));
      if ((length(apart) <= r || (miss <= r && along > 0)) && distance <= ray.reach) expected.push_back(distance);
    }
    for (std::size_t w = 0; filter.walls && w < world.walls().size(); ++w) {
      const double gap = dot(world.walls()[w].normal, ray.origin) - world.walls()[w].offset;
      const double approach = -dot(world.walls()[w].normal, unit);
      if (approach > 0 && gap / approach <= ray.reach) expected.push_back(gap / approach);
    }
    if (is_doubtful) continue;
    std::ranges::sort(expected);
    const auto all = queries.all_hits(ray, filter);
    const auto first = queries.first_hit(ray, filter);
    ASSERT_TRUE(all && first);
    ASSERT_EQ(all->size(), expected.size());
    ASSERT_EQ(first->empty(), expected.empty());
    for (std::size_t n = 0; n < expected.size(); ++n) {
      const RayHit<double, Dim>& hit = (*all)[n];
      EXPECT_NEAR(hit.distance, expected[n], 1e5 * epsilon * (1 + expected[n]));  // a root loses half the digits
      EXPECT_NEAR(length(hit.normal), 1, 4 * epsilon);
      EXPECT_LE(dot(hit.normal, unit), 1e-7);
      if (hit.is_wall() || hit.distance == 0) continue;
      EXPECT_NEAR(length(hit.point - world.position_of(hit.body)) / world.radius[world.index(hit.body)], 1, 1e-6);
    }
    if (!expected.empty()) {
      EXPECT_EQ((*first)[0].body, (*all)[0].body);
      EXPECT_EQ((*first)[0].wall, (*all)[0].wall);
      EXPECT_EQ((*first)[0].distance, (*all)[0].distance);
    }
  }
}
TEST(Queries, RaysHitWhatTheyShould) {
  for (unsigned seed = 0; seed < 30; ++seed) rays_hit_what_they_should<3>(seed);
}
TEST(Queries, RaysHitWhatTheyShouldInThePlane) {
  for (unsigned seed = 0; seed < 30; ++seed) rays_hit_what_they_should<2>(seed);
}

template <int Dim>
void regions_hold_what_they_should(unsigned seed) {
  std::mt19937 engine(seed);
  const World<double, Dim> world = random_world<Dim>(engine, 1 + engine() % 300);
  const Queries queries(world);
  for (int k = 0; k < 20; ++k) {
    const auto centre = random_point<Dim>(engine, 12), half = random_point<Dim>(engine, 6);
    const double radius = std::abs(half[0]);
    auto lower = centre, upper = centre;
    for (std::size_t axis = 0; axis < centre.size(); ++axis)
      lower[axis] -= std::abs(half[axis]), upper[axis] += std::abs(half[axis]);
    Overlap ball, box;
    std::vector<std::pair<double, std::size_t>> by_distance;
    for (std::size_t i = 0; i < world.size(); ++i) {
      const double distance = length(world.position[i] - centre) - world.radius[i];
      by_distance.emplace_back(distance, i);
      if (distance <= radius) ball.bodies.push_back(world.handle(i));
      auto clamped = world.position[i];
      for (std::size_t axis = 0; axis < centre.size(); ++axis)
        clamped[axis] = std::clamp(clamped[axis], lower[axis], upper[axis]);
      if (length(clamped - world.position[i]) <= world.radius[i]) box.bodies.push_back(world.handle(i));
    }
    for (std::uint32_t w = 0; w < world.walls().size(); ++w) {
      const Wall<double, Dim>& wall = world.walls()[w];
      if (dot(wall.normal, centre) - radius <= wall.offset) ball.walls.push_back(w);
      if (dot(wall.normal, wall.normal[w / 2] > 0 ? lower : upper) <= wall.offset) box.walls.push_back(w);
    }
    EXPECT_EQ(queries.in_sphere(centre, radius)->bodies, ball.bodies);
    EXPECT_EQ(queries.in_sphere(centre, radius)->walls, ball.walls);
    EXPECT_EQ(queries.in_box(lower, upper)->bodies, box.bodies);
    EXPECT_EQ(queries.in_box(lower, upper)->walls, box.walls);
    std::ranges::sort(by_distance);
    const std::size_t count = engine() % 12;
    const auto nearest = queries.nearest(centre, count);
    ASSERT_TRUE(nearest);
    ASSERT_EQ(nearest->size(), std::min(count, world.size()));
    for (std::size_t n = 0; n < nearest->size(); ++n) {
      EXPECT_EQ((*nearest)[n].body, world.handle(by_distance[n].second));
      EXPECT_EQ((*nearest)[n].distance, by_distance[n].first);
    }
  }
}
TEST(Queries, RegionsHoldWhatTheyShould) {
  for (unsigned seed = 0; seed < 30; ++seed) regions_hold_what_they_should<3>(seed);
}
TEST(Queries, RegionsHoldWhatTheyShouldInThePlane) {
  for (unsigned seed = 0; seed < 30; ++seed) regions_hold_what_they_should<2>(seed);
}

TEST(Queries, FromInsideTheDistanceIsNothing) {
  World<double, 3> world;
  const auto ball = world.add({.shape = Sphere<double>{2}});
  const Queries queries(world);
  for (const double side : {1.0, -1.0}) {
    const auto hit = queries.first_hit({.origin = {{1, 0, 0}}, .direction = {{side * 3, 0, 0}}});
    ASSERT_EQ(hit->size(), 1u);
    EXPECT_EQ((*hit)[0].body, *ball);
    EXPECT_EQ((*hit)[0].distance, 0);
    EXPECT_EQ((*hit)[0].normal, (Vector<double, 3>{{-side, 0, 0}}));
  }
}

// A ball of a millimetre, a thousand kilometres away: hit in the middle, missed by two thirds of its size.
TEST(Queries, SeeFar) {
  World<double, 3> world;
  ASSERT_TRUE(world.add({.shape = Sphere<double>{0.001}, .position = {{1e6, 0, 0}}}));
  const Queries queries(world);
  EXPECT_EQ(queries.first_hit({.direction = {{1, 0, 0}}})->size(), 1u);
  EXPECT_EQ(queries.first_hit({.origin = {{0, 0.0009, 0}}, .direction = {{1, 0, 0}}})->size(), 1u);
  EXPECT_EQ(queries.first_hit({.origin = {{0, 0.0016, 0}}, .direction = {{1, 0, 0}}})->size(), 0u);
}

TEST(Queries, AnEmptyWorldAnswersWithNothing) {
  const Queries queries((World<float, 2>()));
  EXPECT_TRUE(queries.first_hit({.direction = {{1, 0}}})->empty());
  EXPECT_TRUE(queries.all_hits({.direction = {{1, 0}}})->empty());
  EXPECT_TRUE(queries.nearest({}, 3)->empty());
  EXPECT_TRUE(queries.in_sphere({}, 3)->bodies.empty());
}

TEST(Queries, RefuseWhatMakesNoSense) {
  World<double, 2> world;
  ASSERT_TRUE(world.add({}));
  const Queries queries(world);
  EXPECT_FALSE(queries.first_hit({}));
  EXPECT_FALSE(queries.all_hits({}));
  EXPECT_FALSE(queries.first_hit({.direction = {{nan, 1}}}));
  EXPECT_FALSE(queries.first_hit({.origin = {{inf, 1}}, .direction = {{1, 0}}}));
  EXPECT_FALSE(queries.first_hit({.direction = {{1, 0}}, .reach = nan}));
  EXPECT_FALSE(queries.in_sphere({{nan, 0}}, 1));
  EXPECT_FALSE(queries.in_sphere({}, -1));
  EXPECT_FALSE(queries.in_box({{1, 0}}, {{0, 1}}));
  EXPECT_FALSE(queries.in_box({{0, 0}}, {{0, inf}}));
  EXPECT_FALSE(queries.nearest({{nan, 0}}, 1));
  // The smallest and the largest directions are as good as any.
  EXPECT_EQ(queries.first_hit({.origin = {{-5, 0}}, .direction = {{5e-324, 0}}})->size(), 1u);
  EXPECT_EQ(queries.first_hit({.origin = {{-5, 0}}, .direction = {{1e308, 0}}})->size(), 1u);
}

// A thin wall is hit from either side, and touched only where it is.
TEST(Queries, AThinWallHasTwoSides) {
  World<double, 2> world;
  ASSERT_TRUE(world.add_wall({.normal = {{1, 0}}, .offset = 2, .thin = true}));
  const Queries queries(world);
  for (const double from : {0.0, 5.0}) {
    const double towards = from < 2 ? 1 : -1;
    const auto hit = queries.first_hit({.origin = {{from, 1}}, .direction = {{towards, 0}}});
    ASSERT_EQ(hit->size(), 1u);
    EXPECT_DOUBLE_EQ((*hit)[0].distance, std::abs(from - 2));
    EXPECT_EQ((*hit)[0].normal[0], -towards);
    EXPECT_TRUE(queries.first_hit({.origin = {{from, 1}}, .direction = {{-towards, 0}}})->empty());
    EXPECT_TRUE(queries.in_sphere({{from, 0}}, 1.5)->walls.empty());
    EXPECT_EQ(queries.in_sphere({{from, 0}}, 3.5)->walls.size(), 1u);
    EXPECT_TRUE(queries.in_box({{from, 0}}, {{from + 1, 1}})->walls.empty());
  }
  EXPECT_EQ(queries.in_box({{1, 0}}, {{3, 1}})->walls.size(), 1u);
}

// Each query as if a body were not there.
TEST(Queries, LeaveOutABody) {
  World<double, 3> world;
  const auto near = world.add({.shape = Box<double, 3>{}, .position = {{2, 0, 0}}});
  const auto far = world.add({.position = {{5, 0, 0}}});
  ASSERT_TRUE(near && far);
  const Queries queries(world);
  const Ray<double, 3> ray{.direction = {{1, 0, 0}}};
  const PlacedShape<double, 3> ball{.shape = Sphere<double>{0.1}}, large{.shape = Sphere<double>{6}};
  for (const bool is_left_out : {false, true}) {
    const QueryFilter filter{.without = is_left_out ? *near : BodyHandle{}};
    const BodyHandle first = is_left_out ? *far : *near;
    const std::size_t count = is_left_out ? 1 : 2;
    EXPECT_EQ(queries.first_hit(ray, filter)->front().body, first);
    EXPECT_EQ(queries.first_hits({&ray, 1}, filter)->front().body, first);
    EXPECT_EQ(queries.all_hits(ray, filter)->size(), count);
    EXPECT_EQ(queries.first_contact(ball, {{9, 0, 0}}, filter)->front().body, first);
    EXPECT_EQ(queries.in_sphere({}, 6, filter)->bodies.size(), count);
    EXPECT_EQ(queries.in_box({{-9, -9, -9}}, {{9, 9, 9}}, filter)->bodies.size(), count);
    EXPECT_EQ(queries.in_shape(large, filter)->bodies.size(), count);
    EXPECT_EQ(queries.near_shape(ball, 9, filter)->front().body, first);
    EXPECT_EQ(queries.nearest({}, 2, filter)->size(), count);
  }
}

}  // namespace
}  // namespace continuo::queries_test
