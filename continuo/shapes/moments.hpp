// continuo/shapes/moments.hpp
// Volume and moments of a convex polytope and of all points within a distance of it, in closed form.
#pragma once
#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/polytope.hpp>

namespace continuo {

/// Integrals over a region: of 1, x and x x^T.
template <int Dim>
struct Moments {
  double volume = 0;             // in the plane an area
  Vector<double, Dim> first{};   // volume times the centre
  Matrix<double, Dim> second{};  // symmetric
};

/// The moments about the origin of the points within `rounding` of the polytope: a point or a segment needs a rounding
/// above 0. Exact but for rounding errors of the size of those of a cube as far from the origin: O(corners).
/// @{
[[nodiscard]] Moments<2> moments_of(const Polytope<double, 2>& polytope, double rounding);
[[nodiscard]] Moments<3> moments_of(const Polytope<double, 3>& polytope, double rounding);
/// @}

}  // namespace continuo
