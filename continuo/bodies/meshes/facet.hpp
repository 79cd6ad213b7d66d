// A facet of a static mesh: a segment in the plane, a triangle in space.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <continuo/bodies/bounds/bounds.hpp>
#include <continuo/shapes/matrix.hpp>

namespace continuo {

/// Perpendicular to a facet, towards its free side, of any length: of a segment to the right of its way, of a triangle
/// to where its corners go counter-clockwise.
/// @{
template <class Real>
[[nodiscard]] constexpr Vector<Real, 2> across(const std::array<Vector<Real, 2>, 2>& corners) {
  const Vector<Real, 2> along = corners[1] - corners[0];
  return {{along[1], -along[0]}};
}
template <class Real>
[[nodiscard]] constexpr Vector<Real, 3> across(const std::array<Vector<Real, 3>, 3>& corners) {
  return moment(corners[1] - corners[0], corners[2] - corners[0]);
}
/// @}

/// A facet with its corners in some frame.
template <class Real, int Dim>
struct Facet {
  std::array<Vector<Real, Dim>, static_cast<std::size_t>(Dim)> corners{};
  Vector<Real, Dim> normal{};  // of length 1, towards the free side

  /// How far a point is in front of its plane.
  [[nodiscard]] Real height(const Vector<Real, Dim>& x) const { return dot(normal, x - corners[0]); }
};

/// The facet with these corners.
template <class Real, int Dim>
[[nodiscard]] Facet<Real, Dim> facet_of(const std::array<Vector<Real, Dim>, static_cast<std::size_t>(Dim)>& corners) {
  const Vector<Real, Dim> normal = across(corners);
  return {corners, normal * (1 / length(normal))};
}
/// The facet seen from a pose.
template <class Real, int Dim>
[[nodiscard]] Facet<Real, Dim> local(const Pose<Real, Dim>& pose, Facet<Real, Dim> facet) {
  for (auto& corner : facet.corners) corner = pose.local(corner);
  facet.normal = pose.local_direction(facet.normal);
  return facet;
}
/// The facet with its other side as the free one.
template <class Real, int Dim>
[[nodiscard]] Facet<Real, Dim> turned_over(Facet<Real, Dim> facet) {
  std::swap(facet.corners[0], facet.corners[1]);
  facet.normal = -facet.normal;
  return facet;
}
template <class Real, int Dim>
[[nodiscard]] Bounds<Real, Dim> bounds_of(const std::array<Vector<Real, Dim>, static_cast<std::size_t>(Dim)>& corners) {
  Bounds<Real, Dim> bounds{corners[0], corners[0]};
  for (const Vector<Real, Dim>& corner : corners)
    for (std::size_t axis = 0; axis < corner.size(); ++axis) {
      bounds.lower[axis] = std::min(bounds.lower[axis], corner[axis]);
      bounds.upper[axis] = std::max(bounds.upper[axis], corner[axis]);
    }
  return bounds;
}

}  // namespace continuo
