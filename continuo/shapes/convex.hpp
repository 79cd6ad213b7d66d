// continuo/shapes/convex.hpp
// The geometry of a rigid body: all points within a distance of a convex polytope. A ball is a rounded point, a capsule
// a rounded segment.
#pragma once
#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/polytope.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// A moment of inertia: one number about the axis out of the plane, or a symmetric matrix in space.
template <class Real, int Dim>
using Inertia = Matrix<Real, Dim == 2 ? 1 : 3>;

/// A rounded convex polytope in a frame whose origin is its centre of mass.
template <class Real, int Dim>
struct Convex {
  Polytope<Real, Dim> core;      // what is rounded
  Real rounding{};               // all points within this distance of the core
  Real reach{};                  // the greatest distance of a point from the centre of mass
  Real volume{};                 // in the plane the area
  Inertia<Real, Dim> inertia{};  // about the centre of mass, of a mass of 1
  Vector<double, Dim> centre{};  // of mass, in the frame in which the corners were given
};

/// The convex body of all points within `rounding` of `core`. Fails for a rounding that is negative or not finite, and
/// for a body without volume.
template <class Real, int Dim>
[[nodiscard]] Result<Convex<Real, Dim>> convex_body(const Polytope<double, Dim>& core, double rounding);

/// The box with its centre at the origin and sides of these lengths along the axes. Fails where one is not above 0.
template <int Dim>
[[nodiscard]] Result<Polytope<double, Dim>> box(const Vector<double, Dim>& size);

extern template Result<Convex<float, 2>> convex_body(const Polytope<double, 2>&, double);
extern template Result<Convex<float, 3>> convex_body(const Polytope<double, 3>&, double);
extern template Result<Convex<double, 2>> convex_body(const Polytope<double, 2>&, double);
extern template Result<Convex<double, 3>> convex_body(const Polytope<double, 3>&, double);
extern template Result<Polytope<double, 2>> box(const Vector<double, 2>&);
extern template Result<Polytope<double, 3>> box(const Vector<double, 3>&);

}  // namespace continuo
