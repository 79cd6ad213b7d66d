// In which directions a static mesh may push at one of its facets.
//
// A body that slides over seams between facets must feel none of them. The closest point of a facet may lie on its side
// while the neighbour goes on beyond that in the same plane: the direction to it is no normal of the surface. The
// normals of a surface at a point are the directions in which the point is farther than all others near it: inside of a
// facet its own normal, at a convex edge the arc between the normals of both facets, at a convex corner a cone, and at
// flat or concave edges nothing more. (Known as ghost collisions, or collisions with internal edges: E. Catto, "Box2D:
// ghost collisions", 2020.)
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/shapes/support/separating_axis.hpp>

namespace continuo {

/// Sines of angles below this are rounding of the corners of meshes.
template <class Real>
inline constexpr Real least_angle = std::is_same_v<Real, float> ? Real(3.5e-4) : Real(1.5e-8);

/// Whether a direction of length 1 is a normal of the surface at a facet whose free side has the given normal.
template <class Real, int Dim>
[[nodiscard]] bool is_surface_normal(const StaticMesh<Real, Dim>& mesh, std::uint32_t facet,
                                     const Vector<Real, Dim>& of_facet, const Vector<Real, Dim>& direction) {
  using V = Vector<Real, Dim>;
  constexpr Real angle = least_angle<Real>;
  if (squared(V(direction - of_facet)) <= angle * angle) return true;
  if (dot(direction, of_facet) < -angle) return false;
  const auto is_below = [&](const V& x, const V& from) {
    const V way = x - from;
    return dot(direction, way) <= angle * length(way);
  };
  const auto numbers = mesh.numbers(facet);
  const auto corners = mesh.corners(facet);
  if constexpr (Dim == 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const V &from = corners[k], &to = corners[(k + 1) % 3];
      if (!is_below(to, from) || !is_below(from, to) || !is_below(corners[(k + 2) % 3], from)) continue;
      const std::uint32_t other = mesh.beyond(facet, k);
      return other == StaticMesh<Real, Dim>::none || is_below(mesh.corner(other), from);
    }
  }
  std::size_t top = 0;
  for (std::size_t k = 1; k < corners.size(); ++k)
    if (dot(direction, corners[k] - corners[top]) > Real(0)) top = k;
  bool is_highest = true;
  mesh.for_each_around(numbers[top], [&](const V& x) { is_highest = is_highest && is_below(x, corners[top]); });
  return is_highest;
}

/// Calls act(edge) for the convex sides of a triangle, with the normals on either side of each. At a border, the
/// direction outwards takes the place of the other normal. `is_turned` turns the mesh over.
template <class Real, class Act>
void for_each_convex_side(const StaticMesh<Real, 3>& mesh, std::uint32_t number, bool is_turned, Act&& act) {
  using V = Vector<Real, 3>;
  const Facet<Real, 3> facet = facet_of<Real, 3>(mesh.corners(number));
  const Real sign = is_turned ? Real(-1) : Real(1);
  for (std::size_t k = 0; k < 3; ++k) {
    const V &from = facet.corners[k], &to = facet.corners[(k + 1) % 3], along = to - from;
    V other = moment(along, V(facet.normal * sign));
    if (const std::uint32_t beyond = mesh.beyond(number, k); beyond != StaticMesh<Real, 3>::none) {
      const V x = mesh.corner(beyond), way = x - from;
      if (!(sign * dot(facet.normal, way) < -least_angle<Real> * length(way))) continue;
      other = across<Real>({to, from, x}) * sign;
    } else if (is_turned) {
      other = -other;
    }
    const Real size = length(other);
    if (size > Real(0)) act(EdgeNormals<Real>{from, along * sign, facet.normal * sign, other * (1 / size)});
  }
}

}  // namespace continuo
