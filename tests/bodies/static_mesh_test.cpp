// Static meshes: which facets are near, what is beside them, and where bodies touch them, against brute force.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "meshes.hpp"
#include <continuo/bodies/meshes/mesh_manifolds.hpp>
#include <continuo/shapes/solid.hpp>

namespace continuo::static_mesh_test {

using namespace test;  // meshes.hpp

namespace {

double hill(double x, double y) {
  return 0.3 * std::sin(1.7 * x) + 0.2 * std::cos(2.3 * y + x);
}
HeightField<double, 3> random_field(std::uint32_t columns, std::uint32_t rows) {
  HeightField<double, 3> field{.origin = {{-1, 2, 0.5}}, .spacing = {0.4, 0.7}, .counts = {columns, rows}};
  for (std::uint32_t i = 0; i < columns * rows; ++i)
    field.heights.push_back(hill(0.4 * (i % columns), 0.7 * (i / columns)));
  return field;
}
/// The triangles of a height field, as the documentation of the field has them.
TriangleMesh<double> triangles_of(const HeightField<double, 3>& field) {
  TriangleMesh<double> mesh;
  const std::uint32_t n = field.counts[0];
  for (std::uint32_t i = 0; i < field.heights.size(); ++i)
    mesh.corners.push_back({{field.origin[0] + field.spacing[0] * (i % n), field.origin[1] + field.spacing[1] * (i / n),
                             field.origin[2] + field.heights[i]}});
  for (std::uint32_t j = 0; j + 1 < field.counts[1]; ++j)
    for (std::uint32_t i = j * n; i + 1 < (j + 1) * n; ++i)
      mesh.triangles.push_back({i, i + 1, i + n + 1}), mesh.triangles.push_back({i, i + n + 1, i + n});
  return mesh;
}
template <int Dim>
StaticMesh<double, Dim> made(const MeshShape<double, Dim>& shape) {
  auto mesh = StaticMesh<double, Dim>::of(shape);
  EXPECT_TRUE(mesh) << describe(mesh.status());
  return *std::move(mesh);
}

TEST(StaticMesh, AHeightFieldHasTheNeighboursOfItsTriangles) {
  const auto field = random_field(5, 4);
  const auto grid = made<3>(field), mesh = made<3>(triangles_of(field));
  ASSERT_EQ(grid.size(), mesh.size());
  for (std::uint32_t i = 0; i < mesh.size(); ++i) {
    ASSERT_EQ(grid.numbers(i), mesh.numbers(i));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(grid.beyond(i, k), mesh.beyond(i, k)) << i << ", side " << k;
  }
  const auto around = [](const StaticMesh<double, 3>& of, std::uint32_t corner) {
    std::set<std::array<double, 3>> places;
    of.for_each_around(corner, [&](const Vector<double, 3>& x) { places.insert(x.components); });
    return places;
  };
  for (std::uint32_t i = 0; i < field.heights.size(); ++i) EXPECT_EQ(around(grid, i), around(mesh, i)) << i;
}

TEST(StaticMesh, CornersAtTheSamePlaceAreOne) {
  const TriangleMesh<double> joined = irregular_mesh<double>(3, 3, 1, 0, 0, hill);
  TriangleMesh<double> apart;
  for (const auto& triangle : joined.triangles) {
    const auto first = static_cast<std::uint32_t>(apart.corners.size());
    for (const std::uint32_t corner : triangle) apart.corners.push_back(joined.corners[corner]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  const auto mesh = made<3>(joined), soup = made<3>(apart);
  for (std::uint32_t i = 0; i < mesh.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.beyond(i, k), b = soup.beyond(i, k);
      ASSERT_EQ(a == mesh.none, b == soup.none);
      if (a != mesh.none) {
        EXPECT_EQ(mesh.corner(a), soup.corner(b));
      }
    }
}

template <int Dim>
void expect_all_facets_found(const MeshShape<double, Dim>& shape, unsigned seed) {
  const auto mesh = made<Dim>(shape);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int round = 0; round < 40; ++round) {
    Bounds<double, Dim> box;
    Vector<double, Dim> way;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      const double size = mesh.bounds().upper[axis] - mesh.bounds().lower[axis];
      box.lower[axis] = mesh.bounds().lower[axis] + size * (0.5 + number(engine));
      box.upper[axis] = box.lower[axis] + size * 0.2 * (1 + number(engine));
      way[axis] = round % 4 == 0 && axis == 0 ? 0 : size * number(engine);
    }
    const BoxSweep<double, Dim> sweep{.begin = box, .way = way};
    const SweepSlabs<double, Dim> slabs(sweep);
    std::set<std::uint32_t> near, on_way, expected_near, expected_on_way;
    mesh.for_each_overlap(box, [&](std::uint32_t facet) { EXPECT_TRUE(near.insert(facet).second); });
    mesh.for_each_on_way(sweep, [&](std::uint32_t facet) { return on_way.insert(facet), 1.0; });
    for (std::uint32_t facet = 0; facet < mesh.size(); ++facet) {
      const auto bounds = bounds_of<double, Dim>(mesh.corners(facet));
      if (overlap(box, bounds)) expected_near.insert(facet);
      if (slabs.entry(bounds, 1) <= 1) expected_on_way.insert(facet);
    }
    EXPECT_EQ(near, expected_near);
    EXPECT_EQ(on_way, expected_on_way);
  }
}
TEST(StaticMesh, AllFacetsThatAreNearOrOnAWayAreFound) {
  expect_all_facets_found<3>(random_field(21, 18), 1);
  expect_all_facets_found<3>(irregular_mesh<double>(9, 11, 0.5, -2, 1, hill), 2);
  HeightField<double, 2> line{.counts = {37}};
  for (int i = 0; i < 37; ++i) line.heights.push_back(hill(i, 0));
  expect_all_facets_found<2>(line, 3);
  Chain<double> loop{.is_loop = true};
  for (int i = 0; i < 30; ++i) loop.points.push_back({{3 * std::cos(0.2 * i), 2 * std::sin(0.2 * i)}});
  expect_all_facets_found<2>(loop, 4);
}

/// The distance of a body to the nearest facet: brute force.
template <int Dim>
double distance(const Convex<double, Dim>& body, const Pose<double, Dim>& pose, const StaticMesh<double, Dim>& mesh) {
  double least = std::numeric_limits<double>::infinity();
  Polytope<double, Dim> facet;
  for (std::uint32_t i = 0; i < mesh.size(); ++i) {
    const auto corners = mesh.corners(i);
    facet.corners.assign(corners.begin(), corners.end());
    least = std::min(least, closest_points(body.core, facet, relative(pose, {})).distance);
  }
  return least - body.rounding;
}
// Above a mesh of hills, one of the contacts is the nearest one, whether it is at a face, a side or a corner.
template <int Dim>
void expect_nearest_is_a_contact(const MeshShape<double, Dim>& hills, const std::vector<Shape<double, Dim>>& shapes) {
  const auto mesh = made<Dim>(hills);
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(-1, 1);
  int touching = 0;
  for (int round = 0; round < 300; ++round) {
    const auto body = solid(shapes[static_cast<std::size_t>(round) % shapes.size()]);
    ASSERT_TRUE(body);
    const Convex<double, Dim>& convex = body->parts[0].convex;
    Pose<double, Dim> pose;
    for (std::size_t axis = 0; axis < Dim; ++axis) pose.centre[axis] = (axis + 1 == Dim ? 0.3 : 1.5) * number(engine);
    pose.centre[Dim - 1] += Dim == 2 ? 0.5 : 0.8;  // above the hills
    Orientation<double, Dim> turn = upright<double, Dim>();
    for (double& part : turn.components) part += number(engine);
    pose.axes = rotation(Orientation<double, Dim>(turn * (Dim == 2 ? 1 : 1 / length(turn))));
    const double margin = 0.3, expected = distance(convex, pose, mesh);
    if (expected + convex.rounding < 1e-6) continue;  // the cores overlap
    double least = margin;
    for_each_manifold(convex, pose, mesh, margin, [&](const Manifold<double, Dim>& manifold) {
      for (const auto& point : manifold.all()) least = std::min(least, point.separation);
    });
    touching += expected < margin ? 1 : 0;
    const bool is_ball = convex.core.corners.size() == 1;
    EXPECT_GE(least, std::min(expected, margin) - 1e-9) << round;
    EXPECT_LE(least, std::min(expected, margin) + (is_ball ? 1e-9 : convex.reach / 100)) << round;
  }
  EXPECT_GT(touching, 50);
}
TEST(StaticMesh, TheNearestPointIsAmongTheContacts) {
  expect_nearest_is_a_contact<3>(irregular_mesh<double>(16, 16, 0.5, -4, -4, hill),
                                 {Sphere<double>{0.3}, Capsule<double>{0.6, 0.2}, Box<double, 3>{{{0.5, 0.3, 0.4}}},
                                  Box<double, 3>{{{0.4, 0.6, 0.5}}, 0.1}});
  HeightField<double, 2> line{.origin = {{-4, 0}}, .spacing = {0.25}, .counts = {33}};
  for (int i = 0; i < 33; ++i) line.heights.push_back(0.4 * hill(i, 0));
  expect_nearest_is_a_contact<2>(line, {Sphere<double>{0.3}, Capsule<double>{0.6, 0.2}, Box<double, 2>{{{0.5, 0.3}}},
                                        Box<double, 2>{{{0.4, 0.6}}, 0.1}});
}

// Along a direction that is no normal of the surface, a body would be pushed by a seam.
TEST(StaticMesh, AllNormalsOfAFlatMeshAreItsOwn) {
  const auto mesh = made<3>(irregular_mesh<double>(16, 16, 0.3, -2.4, -2.4, [](double x, double) { return 0.2 * x; }));
  Vector<double, 3> up{{-0.2, 0, 1}};
  up *= 1 / length(up);
  std::mt19937 engine(9);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int round = 0; round < 200; ++round) {
    const auto box = solid(Shape<double, 3>(Box<double, 3>{{{0.8, 0.6, 0.4}}, round % 2 == 0 ? 0 : 0.05}));
    Vector<double, 4> turn{{1, number(engine), number(engine), number(engine)}};
    Pose<double, 3> pose{.axes = rotation(turn * (1 / length(turn)))};
    const Convex<double, 3>& convex = box->parts[0].convex;
    const double lowest = dot(up, pose.axes * convex.core.corners[support(convex.core, pose.local_direction(-up))]);
    const double height = convex.rounding - lowest + (round % 3 - 1) * 0.01;  // deeper, touching, above
    pose.centre = Vector<double, 3>{{number(engine), number(engine), 0}};
    pose.centre += up * (height - dot(up, pose.centre));
    int manifolds = 0;
    for_each_manifold(convex, pose, mesh, 0.1, [&](const Manifold<double, 3>& manifold) {
      ++manifolds;
      EXPECT_LT(length(Vector<double, 3>(pose.axes * manifold.normal + up)), 1e-9) << round;
      double least = 1;
      for (const auto& point : manifold.all()) least = std::min(least, point.separation);
      EXPECT_NEAR(least, (round % 3 - 1) * 0.01, 0.01 * convex.reach) << round;
    });
    EXPECT_EQ(manifolds, 1) << round;
  }
}

// A ball whose centre is above a seam but for rounding is beside both facets, as each of them sees it. It falls through
// none: all seams of a tilted mesh carry it at any place, 100 m from the origin, where rounding is largest.
template <class Real>
void expect_no_gaps_at_seams() {
  const double c = std::cos(0.7), s = std::sin(0.7);
  auto corners = irregular_mesh<double>(30, 30, 0.25, 90, -3.75, [](double, double) { return 0; });
  TriangleMesh<Real> triangles{.corners = {}, .triangles = corners.triangles};
  for (const auto& x : corners.corners)
    triangles.corners.push_back({{static_cast<Real>(c * x[0]), static_cast<Real>(x[1]), static_cast<Real>(s * x[0])}});
  const auto mesh = StaticMesh<Real, 3>::of(MeshShape<Real, 3>(triangles));
  ASSERT_TRUE(mesh);
  const auto ball = solid(Shape<Real, 3>(Sphere<Real>{Real(0.5)}));
  ASSERT_TRUE(ball);
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(0, 1);
  for (int round = 0; round < 30'000; ++round) {
    const auto& triangle = triangles.triangles[engine() % triangles.triangles.size()];
    const std::size_t side = engine() % 3;
    const Vector<Real, 3>&from = triangles.corners[triangle[side]], &to = triangles.corners[triangle[(side + 1) % 3]];
    if (std::abs(from[1]) > 3 || from[0] < 91 * c || from[0] > 96 * c) continue;  // near the border
    Pose<Real, 3> pose{.centre = from + (to - from) * static_cast<Real>(number(engine))};
    pose.centre += Vector<Real, 3>{{static_cast<Real>(-s * 0.499), 0, static_cast<Real>(c * 0.499)}};
    int manifolds = 0;
    for_each_manifold(ball->parts[0].convex, pose, *mesh, Real(0.01), [&](const Manifold<Real, 3>& manifold) {
      ++manifolds;
      EXPECT_EQ(manifold.size, 1u);
      EXPECT_NEAR(manifold.points[0].separation, -0.001, 1e-4);
    });
    ASSERT_EQ(manifolds, 1) << round;
  }
}
TEST(StaticMesh, SeamsHaveNoGapsForBalls) {
  expect_no_gaps_at_seams<double>();
  expect_no_gaps_at_seams<float>();
}

TEST(StaticMesh, ErrorsNameTheFacet) {
  const auto error = [](const MeshShape<double, 3>& shape) {
    const auto mesh = StaticMesh<double, 3>::of(shape);
    return mesh ? std::string() : mesh.status().message;
  };
  TriangleMesh<double> mesh = irregular_mesh<double>(2, 2, 1, 0, 0, hill);
  mesh.triangles[5] = {0, 1, 1};
  EXPECT_EQ(error(mesh), "triangle 5 of the mesh has no area: leave it out");
  mesh.triangles[5] = {0, 1, 100};
  EXPECT_EQ(error(mesh), "triangle 5 has a corner that the mesh does not have");
  mesh.corners[3][0] = std::nan("");
  EXPECT_EQ(error(mesh), "corner 3 of the mesh is not finite");
  EXPECT_EQ(error(TriangleMesh<double>{}), "a mesh needs at least one triangle");
  auto field = random_field(3, 3);
  field.heights.pop_back();
  EXPECT_EQ(error(field), "a height field needs 9 heights, one for each point, not 8");
  field.counts = {3, 1};
  EXPECT_EQ(error(field), "a height field needs two points or more along each axis");
  const auto chain = StaticMesh<double, 2>::of(Chain<double>{.points = {{{0, 0}}, {{1, 0}}, {{1, 0}}}});
  EXPECT_EQ(chain.status().message, "the chain has no way from point 1 to the next: leave one of them out");
}

}  // namespace
}  // namespace continuo::static_mesh_test
