// continuo/shapes/hull.hpp
// The convex hull of points: of the plane by the monotone chain (A. M. Andrew, Inf. Proc. Lett. 9, 1979, 216-219), of
// space by Qhull (C. B. Barber, D. P. Dobkin, H. Huhdanpaa, ACM Trans. Math. Softw. 22, 1996, 469-483).
#pragma once
#include <span>

#include <continuo/shapes/polytope.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// The polygon around the points. Corners that lie on the line between their neighbours, to 1e-9 of the extent, are
/// left out. Fails where the points are not finite, lie on one line, or have more than 64 corners. O(n log n).
[[nodiscard]] Result<Polytope<double, 2>> convex_hull(std::span<const Vector<double, 2>> points);
/// The polyhedron around the points; facets that are parallel to rounding are one face. Fails where the points are not
/// finite, lie in one plane, or have more than 64 corners. O(n log n).
[[nodiscard]] Result<Polytope<double, 3>> convex_hull(std::span<const Vector<double, 3>> points);

}  // namespace continuo
