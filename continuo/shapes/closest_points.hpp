// continuo/shapes/closest_points.hpp
// The distance of two convex polytopes and where they are closest (E. G. Gilbert, D. W. Johnson, S. S. Keerthi, IEEE J.
// Robotics and Automation 4, 1988, 193-203).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/polytope.hpp>
#include <continuo/shapes/support/difference_simplex.hpp>

namespace continuo {

/// The closest points of two polytopes, in the frame of the first.
template <class Real, int Dim>
struct ClosestPoints {
  Real distance{};             // 0 where they overlap
  Vector<Real, Dim> normal{};  // from the first to the second, of length 1; 0 where they overlap
  Vector<Real, Dim> on_a{};    // of the first; of no meaning where they overlap
  Vector<Real, Dim> on_b{};    // of the second, likewise
};

/// The closest points of polytope a and polytope b, where `b_in_a` is the pose of b in the frame of a. To rounding of
/// the greater of the sizes. Some five rounds of O(corners) each.
template <class Real, int Dim>
[[nodiscard]] ClosestPoints<Real, Dim> closest_points(const Polytope<Real, Dim>& a, const Polytope<Real, Dim>& b,
                                                      const Pose<Real, Dim>& b_in_a) {
  using V = Vector<Real, Dim>;
  constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
  constexpr int most_rounds = 100;  // only rounding errors can need more than the number of corners
  DifferenceSimplex<Real, Dim> simplex;
  const auto corner_along = [&](const V& direction) {  // the difference that is farthest in the direction
    typename DifferenceSimplex<Real, Dim>::Corner corner;
    corner.number_a = support(a, direction);
    corner.number_b = support(b, b_in_a.local_direction(-direction));
    corner.a = a.corners[corner.number_a];
    corner.b = b_in_a.place(b.corners[corner.number_b]);
    corner.difference = corner.a - corner.b;
    return corner;
  };
  const auto first = corner_along(b_in_a.centre);
  simplex.add(first);
  V nearest = first.difference;
  Real scale = squared(nearest);
  const ClosestPoints<Real, Dim> overlapping;
  bool is_apart = false;
  for (int round = 0; round < most_rounds; ++round) {
    const Real distance2 = squared(nearest);
    if (distance2 <= epsilon * epsilon * scale) return overlapping;
    const auto next = corner_along(-nearest);
    scale = std::max({scale, squared(next.difference), squared(next.a)});
    const Real progress = distance2 - dot(nearest, next.difference);
    if (progress <= 4 * epsilon * std::sqrt(distance2 * scale) || simplex.contains(next.number_a, next.number_b)) break;
    // All differences are beyond the plane of `next`: if that is beyond the origin, the polytopes are apart.
    is_apart = is_apart || dot(nearest, next.difference) > 8 * epsilon * std::sqrt(distance2 * scale);
    const DifferenceSimplex<Real, Dim> before = simplex;
    simplex.add(next);
    if (!simplex.reduce(is_apart)) return overlapping;
    nearest = simplex.closest();
    if (!(squared(nearest) < distance2)) {  // rounding: no nearer point is to be found
      simplex = before;
      nearest = simplex.closest();
      break;
    }
  }
  const Real distance = length(nearest);
  return {distance, nearest * (-1 / distance), simplex.on_a(), simplex.on_b()};
}

}  // namespace continuo
