// continuo/shapes/manifold.hpp
// Where two convex bodies touch, or nearly do: a normal, and up to two points in the plane, four in space, that hold
// them apart as their whole contact does.
//
// The normal joins the closest points of the cores where these are apart, else it is that of least overlap. Of each
// body the feature that faces the other one is taken: a face, a segment or a corner. The points are the corners of the
// common part of both features, seen along the normal, each with the distance there. Points have the numbers of the
// corners and sides that made them, by which impulses find them again in the next step.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <continuo/shapes/closest_points.hpp>
#include <continuo/shapes/convex.hpp>
#include <continuo/shapes/support/clipped_features.hpp>
#include <continuo/shapes/support/separating_axis.hpp>

namespace continuo {

/// A point of a contact.
template <class Real, int Dim>
struct ManifoldPoint {
  Vector<Real, Dim> position{};  // in the middle between the surfaces, in the frame of the first body
  Real separation{};             // of the surfaces along the normal, below 0 where they overlap
  std::uint32_t feature = 0;     // the same for as long as the same corners and sides make the point
};

/// A contact of two bodies.
template <class Real, int Dim>
struct Manifold {
  static constexpr std::size_t most_points = Dim == 2 ? 2 : 4;  // that hold two faces apart
  Vector<Real, Dim> normal{};  // from the first body to the second, in the frame of the first, of length 1
  std::array<ManifoldPoint<Real, Dim>, most_points> points{};  // the first `size` of them
  std::size_t size = 0;  // of the points; 0: the bodies are farther apart than the margin

  /// The points.
  [[nodiscard]] std::span<const ManifoldPoint<Real, Dim>> all() const { return std::span(points).first(size); }
};

/// The axis of least overlap of the cores of two bodies. A face is preferred to an edge, and a to b, where its overlap
/// is greater by no more than the bias, so that the choice does not change between boxes that lie on each other.
template <class Real, int Dim>
[[nodiscard]] SeparatingAxis<Real, Dim> least_overlap(const Polytope<Real, Dim>& a, const Polytope<Real, Dim>& b,
                                                      const Pose<Real, Dim>& b_in_a, const Real& bias) {
  SeparatingAxis<Real, Dim> best = separation_of_faces(a, b, b_in_a);
  const SeparatingAxis<Real, Dim> of_b = separation_of_faces(b, a, relative(b_in_a, Pose<Real, Dim>{}));
  if (of_b.separation > best.separation + bias) {
    const Vector<Real, Dim> normal = -(b_in_a.axes * of_b.normal);
    best = {normal, of_b.separation, b_in_a.place(of_b.on_a) - normal * of_b.separation};
  }
  if constexpr (Dim == 3) {
    const SeparatingAxis<Real, 3> of_edges = separation_of_edges(a, b, b_in_a);
    if (of_edges.separation > best.separation + bias) best = of_edges;
  }
  if (best.separation > -std::numeric_limits<Real>::infinity()) return best;
  // Neither has faces: points or segments that meet, where every direction across both is as good.
  Vector<Real, Dim> along = a.corners.back() - a.corners.front();
  if (squared(along) == Real(0)) along = b_in_a.axes * (b.corners.back() - b.corners.front());
  return {perpendicular(along), Real(0), (a.corners.back() + a.corners.front()) * Real(0.5)};
}

/// The common points of the features of a and b that face each other along the normal.
template <class Real, int Dim>
[[nodiscard]] CommonPoints<Real, Dim> common_points_along(const Polytope<Real, Dim>& a, const Polytope<Real, Dim>& b,
                                                          const Pose<Real, Dim>& b_in_a,
                                                          const Vector<Real, Dim>& normal) {
  const Feature<Real, Dim> of_a = facing_feature(a, normal);
  Feature<Real, Dim> of_b = facing_feature(b, b_in_a.local_direction(-normal));
  place(of_b, b_in_a);
  return common_points(of_a, of_b, normal);
}

/// The manifold with these points of the cores, of which those within the margin and so many as are needed are kept.
template <class Real, int Dim>
[[nodiscard]] Manifold<Real, Dim> manifold_of(CommonPoints<Real, Dim>& common, const Vector<Real, Dim>& normal,
                                              const Real& rounding_a, const Real& rounding_b, const Real& margin) {
  Manifold<Real, Dim> result;
  const Real roundings = rounding_a + rounding_b;
  result.normal = normal;
  common.drop_beyond(margin + roundings);
  common.reduce(normal, Manifold<Real, Dim>::most_points);
  for (const CommonPoint<Real, Dim>& point : common) {
    // From the core of a, along the normal: the surface of a, then that of b; between them the middle.
    const Real to_middle = (rounding_a + point.separation - rounding_b) / 2;
    result.points[result.size++] = {point.on_a + normal * to_middle, point.separation - roundings, point.feature};
  }
  return result;
}

/// Whether a point is as near as the bodies are along an axis.
template <class Real, int Dim>
[[nodiscard]] bool has_point_within(const CommonPoints<Real, Dim>& common, const Real& separation) {
  return std::any_of(common.begin(), common.end(),
                     [&](const CommonPoint<Real, Dim>& point) { return point.separation <= separation; });
}

/// The manifold of bodies a and b, where `b_in_a` is the pose of b in the frame of a: empty where they are farther
/// apart than `margin`. O(corners) where the bodies are apart, O(edges^2) where hulls of space overlap.
template <class Real, int Dim>
[[nodiscard]] Manifold<Real, Dim> manifold(const Convex<Real, Dim>& a, const Convex<Real, Dim>& b,
                                           const Pose<Real, Dim>& b_in_a, const Real& margin) {
  const Real roundings = a.rounding + b.rounding, size = a.reach < b.reach ? a.reach : b.reach;
  const ClosestPoints<Real, Dim> closest = closest_points(a.core, b.core, b_in_a);
  if (closest.distance > roundings + margin) return {};
  const bool is_apart = closest.distance > Real(1e-5) * size;
  SeparatingAxis<Real, Dim> axis{closest.normal, closest.distance, closest.on_a};
  if (!is_apart) axis = least_overlap(a.core, b.core, b_in_a, Real(1e-3) * size);
  CommonPoints<Real, Dim> common = common_points_along(a.core, b.core, b_in_a, axis.normal);
  // Where a corner or crossing edges are closest, their features need not have points above each other.
  if (!is_apart && !has_point_within(common, axis.separation + Real(1e-2) * size)) {
    axis = least_overlap(a.core, b.core, b_in_a, Real(0));
    common = common_points_along(a.core, b.core, b_in_a, axis.normal);
  }
  if (!has_point_within(common, axis.separation + Real(1e-2) * size))
    common.add({axis.on_a, axis.separation, CommonPoint<Real, Dim>::closest});
  return manifold_of(common, axis.normal, a.rounding, b.rounding, margin);
}

}  // namespace continuo
