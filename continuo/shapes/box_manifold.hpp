// Where two boxes touch. All directions in which they may be apart are known: the normals of three faces each, in space
// also the products of an axis of each (S. Gottschalk, M. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996). Where one of them
// proves how far apart the boxes are, the search for closest points is not needed.
#pragma once
#include <cmath>
#include <cstddef>

#include <continuo/shapes/manifold.hpp>

namespace continuo {

/// Half the sides of a box whose axes are those of its frame, with its centre at the origin; zeros of other bodies.
template <class Real, int Dim>
[[nodiscard]] Vector<Real, Dim> half_sides(const Convex<Real, Dim>& convex) {
  Vector<Real, Dim> half;
  const auto& core = convex.core;
  if (convex.rounding != Real(0) || core.corners.size() != (Dim == 2 ? 4 : 8) || core.faces.size() != 2 * Dim)
    return {};
  for (const Face<Real, Dim>& face : core.faces) {
    std::size_t axis = 0;
    for (std::size_t i = 1; i < Dim; ++i)
      if (std::abs(face.normal[i]) > std::abs(face.normal[axis])) axis = i;
    if (std::abs(face.normal[axis]) != Real(1) || (half[axis] != Real(0) && half[axis] != face.offset)) return {};
    half[axis] = face.offset;
  }
  return half;
}

/// Two boxes with these halves of sides.
template <class Real, int Dim>
struct BoxPair {
  Vector<Real, Dim> half_a{}, half_b{};
  Pose<Real, Dim> b_in_a{};
};

/// The axis of greatest distance, or of least overlap, among those of a kind.
/// @{
template <class Real, int Dim>
[[nodiscard]] SeparatingAxis<Real, Dim> axis_of_faces_of_a(const BoxPair<Real, Dim>& boxes) {
  SeparatingAxis<Real, Dim> best;
  const auto& [half_a, half_b, pose] = boxes;
  for (std::size_t i = 0; i < Dim; ++i) {
    Real reach = half_a[i];
    for (std::size_t j = 0; j < Dim; ++j) reach += std::abs(pose.axes[j][i]) * half_b[j];
    const Real separation = std::abs(pose.centre[i]) - reach;
    if (!(separation > best.separation)) continue;
    best.separation = separation;
    best.normal = {};
    best.normal[i] = pose.centre[i] < Real(0) ? Real(-1) : Real(1);
  }
  return best;
}
template <class Real, int Dim>
[[nodiscard]] SeparatingAxis<Real, Dim> axis_of_faces_of_b(const BoxPair<Real, Dim>& boxes) {
  SeparatingAxis<Real, Dim> best;
  const auto& [half_a, half_b, pose] = boxes;
  for (std::size_t j = 0; j < Dim; ++j) {
    const Vector<Real, Dim>& axis = pose.axes[j];
    Real reach = half_b[j];
    for (std::size_t i = 0; i < Dim; ++i) reach += std::abs(axis[i]) * half_a[i];
    const Real along = dot(pose.centre, axis), separation = std::abs(along) - reach;
    if (separation > best.separation)
      best.separation = separation, best.normal = along < Real(0) ? Vector<Real, Dim>(-axis) : axis;
  }
  return best;
}
/// Where the edges along axis i of a and axis j of b that face each other along the normal are closest, on that of a.
template <class Real>
[[nodiscard]] Vector<Real, 3> closest_on_edge(const BoxPair<Real, 3>& boxes, std::size_t i, std::size_t j,
                                              const Vector<Real, 3>& normal) {
  const auto& [half_a, half_b, pose] = boxes;
  Vector<Real, 3> on_a, on_b = pose.centre;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k != i) on_a[k] = normal[k] < Real(0) ? -half_a[k] : half_a[k];
    if (k != j) on_b += pose.axes[k] * (dot(pose.axes[k], normal) < Real(0) ? half_b[k] : -half_b[k]);
  }
  const Vector<Real, 3> between = on_b - on_a;
  const Vector<Real, 3>& along_b = pose.axes[j];
  const Real cosine = along_b[i];
  on_a[i] += (between[i] - cosine * dot(between, along_b)) / (1 - cosine * cosine);
  return on_a;
}
template <class Real>
[[nodiscard]] SeparatingAxis<Real, 3> axis_of_edges(const BoxPair<Real, 3>& boxes) {
  SeparatingAxis<Real, 3> best;
  std::size_t best_i = 0, best_j = 0;
  const auto& [half_a, half_b, pose] = boxes;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      Vector<Real, 3> unit;
      unit[i] = Real(1);
      Vector<Real, 3> normal = moment(unit, pose.axes[j]);
      const Real square = squared(normal);
      if (square <= Real(1e-6)) continue;  // the direction would be rounding, and a face's is as good
      normal *= 1 / std::sqrt(square);
      Real reach(0);
      for (std::size_t k = 0; k < 3; ++k)
        reach += std::abs(normal[k]) * half_a[k] + std::abs(dot(pose.axes[k], normal)) * half_b[k];
      const Real along = dot(pose.centre, normal), separation = std::abs(along) - reach;
      if (!(separation > best.separation)) continue;
      best.separation = separation, best.normal = along < Real(0) ? Vector<Real, 3>(-normal) : normal;
      best_i = i, best_j = j;
    }
  if (best.separation > -std::numeric_limits<Real>::infinity())
    best.on_a = closest_on_edge(boxes, best_i, best_j, best.normal);
  return best;
}

/// @}

/// The manifold of two boxes without rounding, as manifold.hpp has it for all shapes. O(1).
template <class Real, int Dim>
[[nodiscard]] Manifold<Real, Dim> manifold_of_boxes(const Convex<Real, Dim>& a, const Convex<Real, Dim>& b,
                                                    const BoxPair<Real, Dim>& boxes, const Real& margin) {
  const Real size = a.reach < b.reach ? a.reach : b.reach, bias = Real(1e-3) * size;
  SeparatingAxis<Real, Dim> axis = axis_of_faces_of_a(boxes);
  if (axis.separation > margin) return {};
  const SeparatingAxis<Real, Dim> of_b = axis_of_faces_of_b(boxes);
  if (of_b.separation > margin) return {};
  if (of_b.separation > axis.separation + bias) axis = of_b;
  bool is_of_edges = false;
  if constexpr (Dim == 3) {
    const SeparatingAxis<Real, 3> of_edges = axis_of_edges(boxes);
    if (of_edges.separation > margin) return {};
    if (of_edges.separation > axis.separation + bias) axis = of_edges, is_of_edges = true;
  }
  CommonPoints<Real, Dim> common = common_points_along(a.core, b.core, boxes.b_in_a, axis.normal);
  const bool is_apart = axis.separation > Real(1e-5) * size;
  // A point of a face with a corner above it at the greatest distance along an axis: nothing is closer.
  if (has_point_within(common, axis.separation + (is_apart ? Real(1e-5) : Real(1e-2)) * size))
    return manifold_of(common, axis.normal, Real(0), Real(0), margin);
  if (is_of_edges && !is_apart) {
    common.add({axis.on_a, axis.separation, CommonPoint<Real, Dim>::closest});
    return manifold_of(common, axis.normal, Real(0), Real(0), margin);
  }
  return manifold(a, b, boxes.b_in_a, margin);
}

}  // namespace continuo
