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
  Real size{};  // the reach of the smaller one
};

/// The axis of greatest distance, or of least overlap, among those of a kind.
/// @{
template <class Real, int Dim>
[[nodiscard, gnu::always_inline]] inline SeparatingAxis<Real, Dim> axis_of_faces_of_a(const BoxPair<Real, Dim>& boxes) {
  SeparatingAxis<Real, Dim> best;
  const auto& [half_a, half_b, pose, size] = boxes;
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
[[nodiscard, gnu::always_inline]] inline SeparatingAxis<Real, Dim> axis_of_faces_of_b(const BoxPair<Real, Dim>& boxes) {
  SeparatingAxis<Real, Dim> best;
  const auto& [half_a, half_b, pose, size] = boxes;
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
  const auto& [half_a, half_b, pose, size] = boxes;
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
  const auto& [half_a, half_b, pose, size] = boxes;
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

/// A side of a box of the plane in the frame of one of two boxes. Its tangent points from corner `number` to the next
/// one, counter-clockwise; corners have the numbers that `box` gives them.
template <class Real>
struct BoxSide {
  Vector<Real, 2> normal{}, middle{};
  Real half{};  // of its length
  std::uint32_t number = 0;

  /// From its first corner to the next one, of length 1.
  [[nodiscard]] Vector<Real, 2> tangent() const { return {{-normal[1], normal[0]}}; }
  /// The number of the corner where it ends.
  [[nodiscard]] std::uint32_t next() const { return (number + 1) % 4; }
};

/// The side whose normal is nearest to the direction, which is given in the frame of the box.
template <class Real>
[[nodiscard, gnu::always_inline]] inline BoxSide<Real> facing_side(const Vector<Real, 2>& half,
                                                                   const Vector<Real, 2>& direction,
                                                                   const Pose<Real, 2>& pose) {
  const std::size_t axis = std::abs(direction[0]) > std::abs(direction[1]) ? 0 : 1;
  const bool is_positive = direction[axis] > Real(0);
  const Vector<Real, 2> normal = pose.axes[axis] * (is_positive ? Real(1) : Real(-1));
  const std::uint32_t number = axis == 0 ? (is_positive ? 1u : 3u) : (is_positive ? 2u : 0u);
  return {normal, pose.centre + normal * half[axis], half[1 - axis], number};
}

/// The part of two sides that lies above each other, seen along the normal of the first: up to two points, each in the
/// middle between both. Numbers of the second side's corners have the bit `of_second`, those of the first `of_first`.
/// Empty where there is no such part, or where the second is seen from its end.
template <class Real>
[[nodiscard, gnu::always_inline]] inline Manifold<Real, 2> common_part(const BoxSide<Real>& first,
                                                                       const BoxSide<Real>& second,
                                                                       std::uint32_t of_first,
                                                                       std::uint32_t of_second) {
  Manifold<Real, 2> common;
  const Vector<Real, 2> along = first.tangent(), way = second.tangent() * second.half;
  const Vector<Real, 2> between = second.middle - first.middle;
  const Real place = dot(between, along), height = dot(between, first.normal);
  const Real half = dot(way, along), rise = dot(way, first.normal);
  if (!(half * half > Real(0.0025) * second.half * second.half)) return common;
  // From its middle the second side goes by half along the first one, and by rise away from it.
  const Real slope = rise / half, reach = std::abs(half);
  const auto add = [&](const Real& at, std::uint32_t feature) {
    const Real separation = height + (at - place) * slope;
    common.points[common.size++] = {first.middle + along * at + first.normal * (separation / 2), separation, feature};
  };
  const Real low = std::max(-first.half, place - reach), high = std::min(first.half, place + reach);
  if (!(low <= high)) return common;
  const std::uint32_t begins = of_second | (half < Real(0) ? second.next() : second.number);
  const std::uint32_t ends = of_second | (half < Real(0) ? second.number : second.next());
  add(low, -first.half > place - reach ? of_first | first.number : begins);
  if (low < high) add(high, first.half < place + reach ? of_first | first.next() : ends);
  common.normal = first.normal;
  return common;
}

/// The manifold of two boxes of the plane without rounding, as manifold.hpp has it for all shapes. O(1).
template <class Real>
[[nodiscard]] Manifold<Real, 2> manifold_of_boxes(const Convex<Real, 2>& a, const Convex<Real, 2>& b,
                                                  const BoxPair<Real, 2>& boxes, const Real& margin) {
  const Real size = boxes.size;
  const SeparatingAxis<Real, 2> of_a = axis_of_faces_of_a(boxes), of_b = axis_of_faces_of_b(boxes);
  if (of_a.separation > margin || of_b.separation > margin) return {};
  // A face of a is preferred where b's is better by no more than this, as in least_overlap.
  const bool is_of_b = of_b.separation > of_a.separation + Real(1e-3) * size;
  const SeparatingAxis<Real, 2>& axis = is_of_b ? of_b : of_a;
  const BoxSide<Real> side_of_a = facing_side(boxes.half_a, axis.normal, Pose<Real, 2>{});
  const BoxSide<Real> side_of_b = facing_side(boxes.half_b, boxes.b_in_a.local_direction(-axis.normal), boxes.b_in_a);
  constexpr std::uint32_t from_b = 0x100;
  Manifold<Real, 2> common =
      is_of_b ? common_part(side_of_b, side_of_a, from_b, 0) : common_part(side_of_a, side_of_b, 0, from_b);
  // A point of a face with a corner above it at the greatest distance along an axis: nothing is closer.
  const bool is_apart = axis.separation > Real(1e-5) * size;
  const Real nearest = axis.separation + (is_apart ? Real(1e-5) : Real(1e-2)) * size;
  std::size_t kept = 0;
  bool is_nearest = false;
  for (std::size_t i = 0; i < common.size; ++i) {
    is_nearest |= common.points[i].separation <= nearest;
    if (common.points[i].separation <= margin) common.points[kept++] = common.points[i];
  }
  if (!is_nearest) return manifold(a, b, boxes.b_in_a, margin);
  common.size = kept;
  common.normal = axis.normal;
  return common;
}

/// The same in space.
template <class Real>
[[nodiscard]] Manifold<Real, 3> manifold_of_boxes(const Convex<Real, 3>& a, const Convex<Real, 3>& b,
                                                  const BoxPair<Real, 3>& boxes, const Real& margin) {
  const Real size = boxes.size, bias = Real(1e-3) * size;
  SeparatingAxis<Real, 3> axis = axis_of_faces_of_a(boxes);
  if (axis.separation > margin) return {};
  const SeparatingAxis<Real, 3> of_b = axis_of_faces_of_b(boxes);
  if (of_b.separation > margin) return {};
  if (of_b.separation > axis.separation + bias) axis = of_b;
  const SeparatingAxis<Real, 3> of_edges = axis_of_edges(boxes);
  if (of_edges.separation > margin) return {};
  const bool is_of_edges = of_edges.separation > axis.separation + bias;
  if (is_of_edges) axis = of_edges;
  CommonPoints<Real, 3> common = common_points_along(a.core, b.core, boxes.b_in_a, axis.normal);
  const bool is_apart = axis.separation > Real(1e-5) * size;
  // A point of a face with a corner above it at the greatest distance along an axis: nothing is closer.
  if (has_point_within(common, axis.separation + (is_apart ? Real(1e-5) : Real(1e-2)) * size))
    return manifold_of(common, axis.normal, Real(0), Real(0), margin);
  if (is_of_edges && !is_apart) {
    common.add({axis.on_a, axis.separation, CommonPoint<Real, 3>::closest});
    return manifold_of(common, axis.normal, Real(0), Real(0), margin);
  }
  return manifold(a, b, boxes.b_in_a, margin);
}

}  // namespace continuo
