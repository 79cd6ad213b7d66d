// The shapes that bodies can have, as their users describe them: numbers and points, not yet checked.
#pragma once
#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include <continuo/numerics/vector.hpp>

namespace continuo {

/// A ball in space, a disc in the plane. You choose the units; all lengths must be in the same one.
template <class Real>
struct Sphere {
  Real radius = Real(0.5);  // in the unit of length of the world
  /// Whether all numbers are equal.
  friend bool operator==(const Sphere&, const Sphere&) = default;
};

/// All points within a radius of a segment along the last axis, upwards by default.
template <class Real>
struct Capsule {
  Real length = Real(1);    // of the segment, between the centres of the round ends
  Real radius = Real(0.5);  // of the ends
  /// Whether all numbers are equal.
  friend bool operator==(const Capsule&, const Capsule&) = default;
};

/// A box with sides along the axes, in the plane a rectangle.
template <class Real, int Dim>
struct Box {
  Vector<Real, Dim> size = [] {
    Vector<Real, Dim> ones;
    for (std::size_t i = 0; i < ones.size(); ++i) ones[i] = Real(1);
    return ones;
  }();  // from side to opposite side, what is rounded included
  Real rounding = Real(0);  // radius of its edges and corners
  /// Whether all numbers are equal.
  friend bool operator==(const Box&, const Box&) = default;
};

/// The convex hull of points, in the plane a convex polygon: at most 64 corners.
template <class Real, int Dim>
struct Hull {
  std::vector<Vector<Real, Dim>> points{};  // in any order; those within the hull of the others do not matter
  Real rounding = Real(0);                  // all points within this distance of the hull belong to the body
  /// Whether all numbers are equal.
  friend bool operator==(const Hull&, const Hull&) = default;
};

/// A convex part of a compound.
template <class Real, int Dim>
struct ShapePart {
  std::variant<Sphere<Real>, Capsule<Real>, Box<Real, Dim>, Hull<Real, Dim>> shape{};  // of the part
  Vector<Real, Dim> position{};                               // of its origin in the frame of the compound
  Orientation<Real, Dim> orientation = upright<Real, Dim>();  // in that frame
  /// Whether all numbers are equal.
  friend bool operator==(const ShapePart&, const ShapePart&) = default;
};
/// Convex parts that are rigidly joined. Where parts overlap, the mass there counts as often.
template <class Real, int Dim>
struct Compound {
  std::vector<ShapePart<Real, Dim>> parts{};  // at least one
  /// Whether all parts are equal.
  friend bool operator==(const Compound&, const Compound&) = default;
};

/// The shape of a body, in a frame of its own.
template <class Real, int Dim>
using Shape = std::variant<Sphere<Real>, Capsule<Real>, Box<Real, Dim>, Hull<Real, Dim>, Compound<Real, Dim>>;

}  // namespace continuo
