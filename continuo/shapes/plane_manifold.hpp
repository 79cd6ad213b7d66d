// Where a convex body touches a plane: its lowest corners.
#pragma once
#include <continuo/shapes/convex.hpp>
#include <continuo/shapes/manifold.hpp>

namespace continuo {

/// The points x with normal . x >= offset are free.
template <class Real, int Dim>
struct Plane {
  Vector<Real, Dim> normal{};  // of length 1
  Real offset{};               // normal . x of its points
};

/// The manifold of a convex body and a plane in the frame of the body: empty where they are farther apart than
/// `margin`. The normal is that into the plane. O(corners).
template <class Real, int Dim>
[[nodiscard]] Manifold<Real, Dim> manifold(const Convex<Real, Dim>& body, const Plane<Real, Dim>& plane,
                                           const Real& margin) {
  CommonPoints<Real, Dim> common;
  Manifold<Real, Dim> result;
  for (std::size_t i = 0; i < body.core.corners.size(); ++i) {
    const Vector<Real, Dim>& corner = body.core.corners[i];
    const Real separation = dot(plane.normal, corner) - plane.offset - body.rounding;
    if (separation <= margin) common.add({corner, separation, static_cast<std::uint32_t>(i)});
  }
  result.normal = -plane.normal;
  common.reduce(result.normal, Manifold<Real, Dim>::most_points);
  for (const CommonPoint<Real, Dim>& point : common)
    result.points[result.size++] = {point.on_a + result.normal * (body.rounding + point.separation / 2),
                                    point.separation, point.feature};
  return result;
}

}  // namespace continuo
