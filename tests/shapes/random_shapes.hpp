// Random members of the class of convex bodies: points, segments, boxes and hulls, some of them rounded.
#pragma once
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/shapes/convex.hpp>
#include <continuo/shapes/hull.hpp>

namespace continuo::shapes_test {

template <int Dim>
Vector<double, Dim> random_point(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector<double, Dim> x;
  for (double& component : x.components) component = uniform(engine);
  return x;
}
template <int Dim>
Vector<double, Dim> random_direction(std::mt19937& engine) {
  for (;;) {
    const Vector<double, Dim> x = random_point<Dim>(engine);
    if (squared(x) < 1 && squared(x) > 0.01) return x * (1 / length(x));
  }
}
template <int Dim>
Matrix<double, Dim> random_rotation(std::mt19937& engine) {
  if constexpr (Dim == 2) {
    return rotation(random_point<1>(engine) * 4);
  } else {
    return rotation(random_direction<4>(engine));
  }
}
template <int Dim>
Polytope<double, Dim> random_hull(std::mt19937& engine, std::size_t points) {
  std::vector<Vector<double, Dim>> all;
  while (all.size() < points) all.push_back(random_point<Dim>(engine));
  auto hull = convex_hull(std::span<const Vector<double, Dim>>(all));
  EXPECT_TRUE(hull) << hull.status().message;
  return *hull;
}
template <int Dim>
Polytope<double, Dim> random_core(std::mt19937& engine) {
  switch (engine() % 6) {
    case 0:
      return {.corners = {random_point<Dim>(engine)}};
    case 1:
      return {.corners = {random_point<Dim>(engine), random_point<Dim>(engine)}};
    case 2: {
      Vector<double, Dim> size = random_point<Dim>(engine);
      for (double& side : size.components) side = 0.1 + std::abs(side);
      return *box(size);
    }
    default:
      return random_hull<Dim>(engine, Dim + 2 + engine() % 12);
  }
}
template <int Dim>
Convex<double, Dim> random_body(std::mt19937& engine) {
  const Polytope<double, Dim> core = random_core<Dim>(engine);
  const bool is_rounded = core.faces.empty() || engine() % 2 == 0;
  const auto body = convex_body<double>(core, is_rounded ? 0.05 + 0.2 * std::abs(random_point<1>(engine)[0]) : 0.0);
  EXPECT_TRUE(body) << body.status().message;
  return *body;
}

/// How far x is outside a polytope at most: 0 inside; of a point or a segment the distance.
template <int Dim>
double outside(const Polytope<double, Dim>& polytope, const Vector<double, Dim>& x) {
  if (polytope.faces.empty()) {
    const auto p = polytope.corners.front(), along = polytope.corners.back() - p;
    const double share = squared(along) > 0 ? std::clamp(dot(x - p, along) / squared(along), 0.0, 1.0) : 0;
    return length(x - p - along * share);
  }
  double most = 0;
  for (const auto& face : polytope.faces) most = std::max(most, dot(face.normal, x) - face.offset);
  return most;
}
/// The distance of two polytopes along a direction of length 1, below 0 where they overlap.
template <int Dim>
double separation_along(const Polytope<double, Dim>& a, const Polytope<double, Dim>& b, const Pose<double, Dim>& b_in_a,
                        const Vector<double, Dim>& n) {
  double least = 1e300, most = -1e300;
  for (const auto& corner : a.corners) most = std::max(most, dot(n, corner));
  for (const auto& corner : b.corners) least = std::min(least, dot(n, b_in_a.place(corner)));
  return least - most;
}

}  // namespace continuo::shapes_test
