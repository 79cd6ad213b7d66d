// Distances and manifolds of random pairs of bodies, against certificates that prove them: a direction along which the
// bodies are as far apart as the closest points, points of both that face each other, and no direction of less overlap.
#include <cmath>

#include "random_shapes.hpp"
#include <continuo/shapes/box_manifold.hpp>
#include <continuo/shapes/closest_points.hpp>
#include <continuo/shapes/manifold.hpp>

namespace continuo::shapes_test {
namespace {

template <int Dim>
struct Pair {
  const Convex<double, Dim>& a;
  const Convex<double, Dim>& b;
  Pose<double, Dim> b_in_a;
};
template <int Dim>
Convex<double, Dim> random_box(std::mt19937& engine) {
  Vector<double, Dim> size = random_point<Dim>(engine);
  for (double& side : size.components) side = 0.1 + std::abs(side);
  return *convex_body<double>(*box(size), 0);
}
template <int Dim, class Check>
void for_random_pairs(int count, Convex<double, Dim> (*make)(std::mt19937&), Check&& check) {
  std::mt19937 engine(6);
  std::vector<Convex<double, Dim>> bodies;
  while (bodies.size() < 60) bodies.push_back(make(engine));
  for (int k = 0; k < count; ++k) {
    SCOPED_TRACE(k);
    Pose<double, Dim> pose{random_direction<Dim>(engine) * (1.2 * (1 + random_point<1>(engine)[0])),
                           random_rotation<Dim>(engine)};
    if (k % 5 == 0) pose.axes = identity_matrix<double, Dim>();  // parallel faces
    check(Pair<Dim>{bodies[engine() % bodies.size()], bodies[engine() % bodies.size()], pose}, engine);
  }
}

// Points of both at the distance, and a direction along which the whole bodies are as far apart: no points are closer.
template <int Dim>
void closest_points_are_closest() {
  for_random_pairs<Dim>(1500, random_body<Dim>, [](const Pair<Dim>& pair, std::mt19937&) {
    const auto closest = closest_points(pair.a.core, pair.b.core, pair.b_in_a);
    if (closest.distance == 0) return;  // the manifold proves the overlap
    EXPECT_NEAR(length(closest.on_a - closest.on_b), closest.distance, 1e-12);
    EXPECT_LT(outside(pair.a.core, closest.on_a), 1e-12);
    EXPECT_LT(outside(pair.b.core, pair.b_in_a.local(closest.on_b)), 1e-12);
    EXPECT_NEAR(separation_along(pair.a.core, pair.b.core, pair.b_in_a, closest.normal), closest.distance, 1e-9);
  });
}
TEST(ClosestPoints, AreClosest) {
  closest_points_are_closest<2>(), closest_points_are_closest<3>();
}

// The margins within which manifold.hpp prefers faces, relative to sizes of at most 2.
constexpr double bias = 2.2e-3;

template <int Dim>
void check_points(const Pair<Dim>& pair, const Manifold<double, Dim>& contact) {
  const double a = pair.a.rounding, b = pair.b.rounding;
  for (const auto& point : contact.all()) {
    const double separation = point.separation + a + b;  // of the cores
    const auto on_a = point.position - contact.normal * ((a + separation - b) / 2);
    EXPECT_LT(outside(pair.a.core, on_a), 1e-6);
    EXPECT_LT(outside(pair.b.core, pair.b_in_a.local(on_a + contact.normal * separation)), 1e-6);
  }
}
template <int Dim, class Find>
void manifolds_are_contacts(Convex<double, Dim> (*make)(std::mt19937&), Find&& find) {
  int apart = 0, overlapping = 0;
  for_random_pairs<Dim>(2500, make, [&](const Pair<Dim>& pair, std::mt19937& engine) {
    const double margin = 0.1, roundings = pair.a.rounding + pair.b.rounding;
    const double distance = closest_points(pair.a.core, pair.b.core, pair.b_in_a).distance;
    const auto contact = find(pair, margin);
    EXPECT_EQ(contact.size > 0, distance <= roundings + margin);
    if (contact.size == 0) return;
    EXPECT_NEAR(length(contact.normal), 1, 1e-12);
    check_points(pair, contact);
    double least = 1e300;
    for (const auto& point : contact.all()) least = std::min(least, point.separation + roundings);
    const auto along = [&](const Vector<double, Dim>& n) {
      return separation_along(pair.a.core, pair.b.core, pair.b_in_a, n);
    };
    if (distance > 1e-4) {
      ++apart;
      EXPECT_GE(least, distance - 1e-6);
      EXPECT_LE(least, distance + 0.02);
    } else if (distance == 0) {
      ++overlapping;
      EXPECT_NEAR(least, along(contact.normal), 0.02);
      for (int k = 0; k < 40; ++k) {
        const auto nearby = contact.normal + random_direction<Dim>(engine) * (k % 2 ? 0.1 : 2.0);
        EXPECT_LE(along(nearby * (1 / length(nearby))), along(contact.normal) + bias);
      }
    }
  });
  EXPECT_GT(apart, 100);
  EXPECT_GT(overlapping, 100);
}
TEST(Manifold, IsAContactOfLeastOverlap) {
  const auto find = [](const auto& pair, double margin) { return manifold(pair.a, pair.b, pair.b_in_a, margin); };
  manifolds_are_contacts<2>(random_body<2>, find), manifolds_are_contacts<3>(random_body<3>, find);
}

template <int Dim>
void manifolds_of_boxes_are_contacts() {
  const auto find = [](const Pair<Dim>& pair, double margin) {
    const auto half_a = half_sides(pair.a), half_b = half_sides(pair.b);
    for (std::size_t i = 0; i < Dim; ++i) EXPECT_GE(std::min(half_a[i], half_b[i]), 0.05);
    return manifold_of_boxes(pair.a, pair.b, {half_a, half_b, pair.b_in_a, std::min(pair.a.reach, pair.b.reach)},
                             margin);
  };
  manifolds_are_contacts<Dim>(random_box<Dim>, find);
}
TEST(Manifold, OfBoxesIsAContactOfLeastOverlap) {
  manifolds_of_boxes_are_contacts<2>(), manifolds_of_boxes_are_contacts<3>();
}
// Where the closest points are on faces, the short way for boxes and the one for all polygons have the same points with
// the same features.
TEST(Manifold, OfBoxesOfThePlaneIsThatOfPolygons) {
  int compared = 0;
  for_random_pairs<2>(20000, random_box<2>, [&](const Pair<2>& pair, std::mt19937&) {
    const auto general = manifold(pair.a, pair.b, pair.b_in_a, 0.3);
    const auto of_boxes = manifold_of_boxes(
        pair.a, pair.b, {half_sides(pair.a), half_sides(pair.b), pair.b_in_a, std::min(pair.a.reach, pair.b.reach)},
        0.3);
    ASSERT_EQ(of_boxes.size > 0, general.size > 0);
    // Of axes that are as good the choice is free.
    if (general.size == 0 || squared(general.normal - of_boxes.normal) > 1e-20) return;
    ASSERT_EQ(of_boxes.size, general.size);
    ++compared;
    for (const auto& point : general.all()) {
      const auto same = std::ranges::find(of_boxes.all(), point.feature, &ManifoldPoint<double, 2>::feature);
      ASSERT_NE(same, of_boxes.all().end());
      EXPECT_NEAR(same->separation, point.separation, 1e-12);
      EXPECT_NEAR(length(same->position - point.position), 0, 1e-12);
    }
  });
  EXPECT_GT(compared, 5000);
}
TEST(Manifold, KnowsBoxes) {
  std::mt19937 engine(3);
  EXPECT_EQ(half_sides(*convex_body<double>(*box<3>({{1, 2, 3}}), 0)), (Vector<double, 3>{{0.5, 1, 1.5}}));
  EXPECT_EQ(half_sides(*convex_body<double>(*box<3>({{1, 2, 3}}), 0.1)), (Vector<double, 3>{}));
  EXPECT_EQ(half_sides(*convex_body<double>(random_hull<3>(engine, 8), 0)), (Vector<double, 3>{}));
  EXPECT_EQ(half_sides(*convex_body<double>(random_hull<2>(engine, 4), 0)), (Vector<double, 2>{}));
}

// A box that slides over another one keeps four points, each with the feature it had.
TEST(Manifold, KeepsItsFeaturesWhileABoxSlides) {
  const auto crate = *convex_body<double>(*box<3>({{1, 1, 1}}), 0);
  const auto contact_at = [&](double x) {
    return manifold(crate, crate, Pose<double, 3>{{{x, 0.2, 0.999}}, rotation(Vector<double, 4>{{1, 0, 0, 0}})}, 0.02);
  };
  const auto first = contact_at(0.1);
  ASSERT_EQ(first.size, 4u);
  EXPECT_NEAR(first.normal[2], 1, 1e-15);
  for (const double x : {0.11, 0.2, 0.45}) {
    const auto later = contact_at(x);
    ASSERT_EQ(later.size, 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(later.points[i].separation, -0.001, 1e-12);
      const auto has_feature = [&](const auto& point) { return point.feature == first.points[i].feature; };
      EXPECT_TRUE(std::ranges::any_of(later.all(), has_feature));
    }
  }
}

TEST(Manifold, OfParallelCapsulesHasTwoPoints) {
  const auto rod = *convex_body<double>(Polytope<double, 3>{.corners = {{{-1, 0, 0}}, {{1, 0, 0}}}}, 0.25);
  const auto contact = manifold(rod, rod, Pose<double, 3>{{{0.5, 0, 0.51}}}, 0.02);
  ASSERT_EQ(contact.size, 2u);
  for (const auto& point : contact.all()) {
    EXPECT_NEAR(point.separation, 0.01, 1e-14);
    EXPECT_NEAR(point.position[2], 0.255, 1e-14);
  }
  EXPECT_NEAR(std::abs(contact.points[0].position[0] - contact.points[1].position[0]), 1.5, 1e-14);
}

}  // namespace
}  // namespace continuo::shapes_test
