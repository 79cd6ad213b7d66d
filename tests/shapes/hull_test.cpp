// Hulls of points: their faces hold all points, their edges join two faces, and bad points are refused.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "random_shapes.hpp"

namespace continuo::shapes_test {
namespace {

template <int Dim>
void holds_all_points(unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<Vector<double, Dim>> points;
  const double thickness = seed % 5 == 0 ? 1e-4 : 1;
  for (std::size_t i = 0, n = Dim + 1 + engine() % 40; i < n; ++i) {
    points.push_back(random_point<Dim>(engine));
    points.back()[0] *= thickness;
    if (i % 4 == 3) points.push_back((points[i] + points[i - 1]) * 0.5);  // not a corner
  }
  const auto hull = convex_hull(std::span<const Vector<double, Dim>>(points));
  ASSERT_TRUE(hull) << hull.status().message;
  for (const auto& point : points) EXPECT_LT(outside(*hull, point), 1e-9);
  for (std::size_t i = 0; i < hull->faces.size(); ++i) {
    EXPECT_NEAR(length(hull->faces[i].normal), 1, 1e-14);
    if constexpr (Dim == 2) {
      const auto& next = hull->corners[(i + 1) % hull->corners.size()];
      EXPECT_NEAR(dot(hull->faces[i].normal, next), hull->faces[i].offset, 1e-14);
    }
  }
}

// Counter-clockwise loops about their normals, every side of a loop an edge with its two faces, and Euler's formula.
void has_a_closed_surface(const Polytope<double, 3>& hull) {
  std::size_t sides = 0;
  for (std::size_t face = 0; face < hull.faces.size(); ++face) {
    const auto loop = hull.loop(face);
    sides += loop.size();
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const std::uint8_t from = loop[k], to = loop[(k + 1) % loop.size()];
      EXPECT_NEAR(dot(hull.faces[face].normal, hull.corners[from]), hull.faces[face].offset, 1e-9);
      const bool is_edge = std::ranges::any_of(hull.edges, [&](const Edge& edge) {
        return (edge.from == from && edge.to == to && edge.left == face) ||
               (edge.from == to && edge.to == from && edge.right == face);
      });
      EXPECT_TRUE(is_edge) << int(from) << " to " << int(to);
    }
  }
  EXPECT_EQ(sides, 2 * hull.edges.size());
  EXPECT_EQ(hull.corners.size() + hull.faces.size(), hull.edges.size() + 2);
}

TEST(Hull, HoldsAllPointsOfRandomSets) {
  for (unsigned seed = 0; seed < 100; ++seed) holds_all_points<2>(seed), holds_all_points<3>(seed);
}

TEST(Hull, HasAClosedSurface) {
  std::mt19937 engine(1);
  for (int k = 0; k < 50; ++k) has_a_closed_surface(random_hull<3>(engine, 4 + engine() % 30));
  has_a_closed_surface(*box<3>({{1, 2, 3}}));
}

TEST(Hull, OfTheCornersOfABoxHasSixFaces) {
  const auto corners = box<3>({{1, 2, 3}})->corners;
  const auto hull = convex_hull(std::span<const Vector<double, 3>>(corners));
  ASSERT_TRUE(hull);
  EXPECT_EQ(hull->faces.size(), 6u);
  EXPECT_EQ(hull->edges.size(), 12u);
}

TEST(Hull, RefusesPointsWithoutAHull) {
  using Space = std::vector<Vector<double, 3>>;
  const auto refusal = [](const Space& points) {
    const auto hull = convex_hull(std::span<const Vector<double, 3>>(points));
    return hull ? std::string("none") : hull.status().message;
  };
  EXPECT_THAT(refusal({{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}), testing::HasSubstr("at least 4 points, not 3"));
  const Space flat{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 1, 0}}, {{0.2, 0.7, 0}}};
  EXPECT_THAT(refusal(flat), testing::HasSubstr("lie in one plane"));
  EXPECT_THAT(refusal(Space(9, {{1, 2, 3}})), testing::HasSubstr("lie in one plane"));
  Space not_finite = flat;
  not_finite[2][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(not_finite), testing::HasSubstr("point 2 of the hull is not finite"));
  std::mt19937 engine(2);
  Space ball;
  while (ball.size() < 100) ball.push_back(random_direction<3>(engine));
  EXPECT_THAT(refusal(ball), testing::HasSubstr("the hull has 100 corners, and at most 64"));

  const std::vector<Vector<double, 2>> line{{{0, 0}}, {{1, 1}}, {{2, 2}}, {{0.5, 0.5}}};
  EXPECT_THAT(convex_hull(std::span<const Vector<double, 2>>(line)).status().message,
              testing::HasSubstr("lie on one line"));
  EXPECT_FALSE((box<3>({{1, 0, 1}})));
  EXPECT_FALSE((box<2>({{1, std::numeric_limits<double>::infinity()}})));
}

}  // namespace
}  // namespace continuo::shapes_test
