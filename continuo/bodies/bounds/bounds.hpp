// Boxes with their faces along the axes, which bound shapes.
//
//   Bounds<double, 2> crate{{{0, 0}}, {{1, 2}}}, ball{{{0.9, 1}}, {{3, 3}}};
//   if (overlap(crate, ball)) look_closer();
//
// What a NaN bounds is unknown, so that it counts as unbounded there: it overlaps all that is not empty, and what is
// united with it is unbounded too. So no pair is lost by a wrong number.
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>

#include <continuo/numerics/vector.hpp>

namespace continuo {

/// The points from `lower` to `upper`, both included. Empty where a lower bound exceeds its upper one, as at first.
template <class Real, int Dim>
struct Bounds {
  Vector<Real, Dim> lower = filled(std::numeric_limits<Real>::infinity());   // the least coordinates
  Vector<Real, Dim> upper = filled(-std::numeric_limits<Real>::infinity());  // the greatest ones

  /// Whether all bounds are equal.
  friend constexpr bool operator==(const Bounds&, const Bounds&) = default;

 private:
  [[nodiscard]] static constexpr Vector<Real, Dim> filled(Real value) {
    Vector<Real, Dim> v;
    for (std::size_t axis = 0; axis < v.size(); ++axis) v[axis] = value;
    return v;
  }
};

/// Whether they contain no point.
template <class Real, int Dim>
[[nodiscard]] constexpr bool is_empty(const Bounds<Real, Dim>& a) {
  for (std::size_t axis = 0; axis < a.lower.size(); ++axis)
    if (a.lower[axis] > a.upper[axis]) return true;
  return false;
}

/// Whether they have a point in common. Bounds that touch do.
template <class Real, int Dim>
[[nodiscard]] constexpr bool overlap(const Bounds<Real, Dim>& a, const Bounds<Real, Dim>& b) {
  for (std::size_t axis = 0; axis < a.lower.size(); ++axis)
    if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
  return !is_empty(a) && !is_empty(b);
}

/// Whether bounds that are not empty have no point in common, or overlap along an axis by less than `depth`. Without a
/// branch, which would be unpredictable for many.
template <class Real, int Dim>
[[nodiscard]] constexpr bool are_apart(const Bounds<Real, Dim>& a, const Bounds<Real, Dim>& b,
                                       const Real& depth = static_cast<Real>(0)) {
  bool is_so = false;
  for (std::size_t axis = 0; axis < a.lower.size(); ++axis) {
    const bool is_above = a.lower[axis] + depth > b.upper[axis], is_below = b.lower[axis] + depth > a.upper[axis];
    is_so |= is_above | is_below;
  }
  return is_so;
}

/// The least bounds that contain both.
template <class Real, int Dim>
[[nodiscard]] constexpr Bounds<Real, Dim> united(const Bounds<Real, Dim>& a, const Bounds<Real, Dim>& b) {
  if (is_empty(a)) return b;
  if (is_empty(b)) return a;
  Bounds<Real, Dim> both = a;
  for (std::size_t axis = 0; axis < a.lower.size(); ++axis) {
    // A NaN in b fails the comparison and replaces the bound; one in a stays by the second.
    if (!(b.lower[axis] >= a.lower[axis]) && a.lower[axis] == a.lower[axis]) both.lower[axis] = b.lower[axis];
    if (!(b.upper[axis] <= a.upper[axis]) && a.upper[axis] == a.upper[axis]) both.upper[axis] = b.upper[axis];
  }
  return both;
}

/// Enlarged by `margin` on every side. What is empty stays so.
template <class Real, int Dim>
[[nodiscard]] constexpr Bounds<Real, Dim> grown(Bounds<Real, Dim> a, const Real& margin) {
  if (is_empty(a)) return a;
  for (std::size_t axis = 0; axis < a.lower.size(); ++axis) {
    a.lower[axis] -= margin;
    a.upper[axis] += margin;
  }
  return a;
}

/// Half the surface in space, half the perimeter in the plane; 0 if empty.
template <class Real, int Dim>
[[nodiscard]] constexpr Real surface(const Bounds<Real, Dim>& a) {
  if (is_empty(a)) return Real(0);
  const Vector<Real, Dim> edge = a.upper - a.lower;
  if constexpr (Dim == 2) {
    return edge[0] + edge[1];
  } else {
    return edge[0] * edge[1] + edge[1] * edge[2] + edge[2] * edge[0];
  }
}

/// The distance of a point to the nearest point of bounds that are not empty; 0 inside.
template <class Real, int Dim>
[[nodiscard]] Real distance(const Vector<Real, Dim>& x, const Bounds<Real, Dim>& a) {
  Vector<Real, Dim> out;
  for (std::size_t axis = 0; axis < x.size(); ++axis)
    out[axis] = std::max({Real(a.lower[axis] - x[axis]), Real(x[axis] - a.upper[axis]), Real(0)});
  return length(out);
}

}  // namespace continuo
