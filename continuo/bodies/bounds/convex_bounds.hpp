// The bounds of a convex body.
#pragma once
#include <continuo/bodies/bounds/bounds.hpp>
#include <continuo/shapes/convex.hpp>

namespace continuo {

/// The bounds of a convex body in a pose.
template <class Real, int Dim>
[[nodiscard]] Bounds<Real, Dim> bounds_of(const Convex<Real, Dim>& convex, const Pose<Real, Dim>& pose) {
  Bounds<Real, Dim> bounds;
  for (const Vector<Real, Dim>& corner : convex.core.corners) {
    const Vector<Real, Dim> x = pose.place(corner);
    bounds = united(bounds, Bounds<Real, Dim>{x, x});
  }
  return grown(bounds, convex.rounding);
}

}  // namespace continuo
