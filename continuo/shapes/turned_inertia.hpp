// A moment of inertia in a frame that is turned against that in which it is known.
#pragma once
#include <continuo/shapes/matrix.hpp>

namespace continuo {

/// The inertia in the frame in which `axes` are the images of the axes of its own; in the plane the same. O(1).
/// @{
template <class Real>
[[nodiscard]] Matrix<Real, 1> turned_inertia(const Matrix<Real, 2>&, const Matrix<Real, 1>& inertia) {
  return inertia;
}
template <class Real>
[[nodiscard]] Matrix<Real, 3> turned_inertia(const Matrix<Real, 3>& axes, const Matrix<Real, 3>& inertia) {
  return axes * inertia * transposed(axes);
}
/// @}

}  // namespace continuo
