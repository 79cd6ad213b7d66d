// The direction in which two convex polytopes overlap least: a normal of a face of either, or a normal of an edge of
// each. Of the pairs of edges only those count whose arcs of normals cross on the unit sphere, since only they are
// faces of the difference of the polytopes (D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC
// 2013).
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/polytope.hpp>

namespace continuo {

/// A unit vector across `direction`; any one where that has no length.
template <class Real>
[[nodiscard]] Vector<Real, 2> perpendicular(const Vector<Real, 2>& direction) {
  const Real size = length(direction);
  return size > Real(0) ? Vector<Real, 2>{{-direction[1] / size, direction[0] / size}} : Vector<Real, 2>{{0, 1}};
}
template <class Real>
[[nodiscard]] Vector<Real, 3> perpendicular(const Vector<Real, 3>& direction) {
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::abs(direction[i]) < std::abs(direction[least])) least = i;
  Vector<Real, 3> axis{};
  axis[least] = Real(1);
  const Vector<Real, 3> across = moment(direction, axis);
  const Real size = length(across);
  return size > Real(0) ? across * (1 / size) : axis;
}

/// A direction, the distance of two polytopes along it, below 0 where they overlap, and a point of the first one that
/// has one of the second at this distance.
template <class Real, int Dim>
struct SeparatingAxis {
  Vector<Real, Dim> normal{};                                // from the first to the second, of length 1
  Real separation = -std::numeric_limits<Real>::infinity();  // along the normal
  Vector<Real, Dim> on_a{};                                  // on the surface of the first
};

/// The greatest separation along a normal of a face of `a`, in the frame of a. In the plane a segment has two faces.
template <class Real, int Dim>
[[nodiscard]] SeparatingAxis<Real, Dim> separation_of_faces(const Polytope<Real, Dim>& a, const Polytope<Real, Dim>& b,
                                                            const Pose<Real, Dim>& b_in_a) {
  SeparatingAxis<Real, Dim> best;
  const auto consider = [&](const Vector<Real, Dim>& normal, const Real& offset) {
    const Vector<Real, Dim> towards_a = b_in_a.local_direction(-normal);
    const Vector<Real, Dim>& corner = b.corners[support(b, towards_a)];
    const Real separation = dot(normal, b_in_a.centre) - dot(towards_a, corner) - offset;
    if (separation > best.separation) best = {normal, separation, b_in_a.place(corner) - normal * separation};
  };
  for (const Face<Real, Dim>& face : a.faces) consider(face.normal, face.offset);
  if constexpr (Dim == 2) {
    if (a.faces.empty() && a.corners.size() == 2) {
      const Vector<Real, 2> normal = perpendicular(a.corners[1] - a.corners[0]);
      consider(normal, dot(normal, a.corners[0]));
      consider(-normal, -dot(normal, a.corners[0]));
    }
  }
  return best;
}

/// The edges of a polytope with the normals beside them: a segment has one edge and normals all around it.
template <class Real>
struct EdgeNormals {
  Vector<Real, 3> from, along, left, right;
  bool is_segment = false;
};
template <class Real, class Act>
void for_each_edge(const Polytope<Real, 3>& polytope, Act&& act) {
  if (polytope.faces.empty() && polytope.corners.size() == 2)
    act(EdgeNormals<Real>{polytope.corners[0], polytope.corners[1] - polytope.corners[0], {}, {}, true});
  for (const Edge& edge : polytope.edges)
    act(EdgeNormals<Real>{polytope.corners[edge.from], polytope.corners[edge.to] - polytope.corners[edge.from],
                          polytope.faces[edge.left].normal, polytope.faces[edge.right].normal});
}

/// Whether the difference of the polytopes has a face of these two edges: the arc of the normals of a crosses that of
/// the negative normals of b.
template <class Real>
[[nodiscard]] bool is_face_of_difference(const EdgeNormals<Real>& a, const EdgeNormals<Real>& b) {
  const Real left_b = dot(b.left, a.along), right_b = dot(b.right, a.along);
  const Real left_a = dot(a.left, b.along), right_a = dot(a.right, b.along);
  if (!b.is_segment && left_b * right_b >= Real(0)) return false;
  if (!a.is_segment && left_a * right_a >= Real(0)) return false;
  // Both arcs cross the plane of the other one; they cross each other if they do so on the same half of the sphere.
  // The cross product of the normals right and left of an edge points against it, of a and of the negative b alike.
  return a.is_segment || b.is_segment || left_a * right_b < Real(0);
}

/// The common normal of an edge of a and one of b, where it is a face of the difference: none where it is not, or where
/// the edges are nearly parallel. `centre_b` is anywhere beyond a, for two segments.
template <class Real>
[[nodiscard]] std::optional<SeparatingAxis<Real, 3>> separation_of_edges(const EdgeNormals<Real>& of_a,
                                                                         const EdgeNormals<Real>& of_b,
                                                                         const Vector<Real, 3>& centre_b) {
  // At smaller angles the direction of the normal is rounding, and a normal of a face is as good.
  constexpr Real least_sine2 = Real(1e-6);
  if (!is_face_of_difference(of_a, of_b)) return std::nullopt;
  Vector<Real, 3> normal = moment(of_a.along, of_b.along);
  const Real squared_length = squared(normal);
  if (squared_length <= least_sine2 * squared(of_a.along) * squared(of_b.along)) return std::nullopt;
  normal *= 1 / std::sqrt(squared_length);
  // Outwards from a: as the normals beside its edge, or for a segment away from b's.
  const Real outwards = of_a.is_segment ? -dot(normal, of_b.left + of_b.right) : dot(normal, of_a.left + of_a.right);
  if (of_a.is_segment && of_b.is_segment ? dot(normal, centre_b) < Real(0) : outwards < Real(0)) normal = -normal;
  const Vector<Real, 3> between = of_b.from - of_a.from;
  // On the line of a, where the line of b is above it: between + t along_b - s along_a is parallel to the normal.
  const Real s = dot(moment(between, of_b.along), moment(of_a.along, of_b.along)) / squared_length;
  return SeparatingAxis<Real, 3>{normal, dot(normal, between), of_a.from + of_a.along * s};
}

/// The greatest separation along a common normal of an edge of each.
template <class Real>
[[nodiscard]] SeparatingAxis<Real, 3> separation_of_edges(const Polytope<Real, 3>& a, const Polytope<Real, 3>& b,
                                                          const Pose<Real, 3>& b_in_a) {
  SeparatingAxis<Real, 3> best;
  for_each_edge(b, [&](const EdgeNormals<Real>& in_b) {
    const EdgeNormals<Real> of_b{b_in_a.place(in_b.from), b_in_a.axes * in_b.along, b_in_a.axes * in_b.left,
                                 b_in_a.axes * in_b.right, in_b.is_segment};
    for_each_edge(a, [&](const EdgeNormals<Real>& of_a) {
      const auto axis = separation_of_edges(of_a, of_b, b_in_a.centre);
      if (axis && axis->separation > best.separation) best = *axis;
    });
  });
  return best;
}

}  // namespace continuo
