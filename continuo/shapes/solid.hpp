// The geometry of a rigid body of any shape: convex parts in the frame of its centre of mass, with volume and inertia.
#pragma once
#include <vector>

#include <continuo/shapes/convex.hpp>
#include <continuo/shapes/shape.hpp>

namespace continuo {

/// A convex part of a solid.
template <class Real, int Dim>
struct SolidPart {
  Convex<Real, Dim> convex;    // in the frame of its own centre of mass
  Pose<Real, Dim> in_solid{};  // of that frame, in the frame of the solid
};

/// A rigid body's geometry. The axes of its frame are those of its shape, the origin is its centre of mass.
template <class Real, int Dim>
struct Solid {
  Shape<Real, Dim> shape{};                   // what it was made of
  std::vector<SolidPart<Real, Dim>> parts{};  // at least one
  Vector<Real, Dim> centre{};                 // of mass, in the frame of the shape
  Inertia<Real, Dim> inertia{};               // about the centre of mass, of a mass of 1
  Real volume{};                              // in the plane the area
  Real reach{};                               // the greatest distance of a point from the centre of mass
};

/// The solid of a shape. Fails for sizes that are not above 0 or not finite, and for points without a hull that has
/// volume; the message says which. O(points log(points)).
template <class Real, int Dim>
[[nodiscard]] Result<Solid<Real, Dim>> solid(const Shape<Real, Dim>& shape);

extern template Result<Solid<float, 2>> solid(const Shape<float, 2>&);
extern template Result<Solid<float, 3>> solid(const Shape<float, 3>&);
extern template Result<Solid<double, 2>> solid(const Shape<double, 2>&);
extern template Result<Solid<double, 3>> solid(const Shape<double, 3>&);

}  // namespace continuo
