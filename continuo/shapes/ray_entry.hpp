// Where a ray enters a convex body, and how far a point is from one.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <continuo/shapes/cast.hpp>
#include <continuo/shapes/convex.hpp>

namespace continuo {

/// The distance of a point in the frame of the body to its surface, below 0 inside: there, to the plane of the nearest
/// face. O(corners + faces).
template <class Real, int Dim>
[[nodiscard]] Real signed_distance(const Convex<Real, Dim>& body, const Vector<Real, Dim>& point) {
  Real outside = body.core.faces.empty() ? Real(0) : -std::numeric_limits<Real>::infinity();
  for (const Face<Real, Dim>& face : body.core.faces)
    outside = std::max(outside, dot(face.normal, point) - face.offset);
  if (body.core.faces.empty() || outside > Real(0)) {
    const Polytope<Real, Dim> at{.corners = {{}}};
    outside = closest_points(body.core, at, Pose<Real, Dim>{.centre = point}).distance;
  }
  return outside - body.rounding;
}

/// The first point of a body on a ray.
template <class Real, int Dim>
struct RayEntry {
  Real distance{};             // along the ray; 0 where it begins inside
  Vector<Real, Dim> normal{};  // of the surface, of length 1; 0 where it begins inside
};

/// Of a polytope that is not rounded: the last of the planes that the ray enters, if it does so before it leaves one.
template <class Real, int Dim>
[[nodiscard]] std::optional<RayEntry<Real, Dim>> entry_of_planes(const Polytope<Real, Dim>& core,
                                                                 const Vector<Real, Dim>& origin,
                                                                 const Vector<Real, Dim>& direction,
                                                                 const Real& reach) {
  RayEntry<Real, Dim> entry;
  Real end = reach;
  for (const Face<Real, Dim>& face : core.faces) {
    const Real height = dot(face.normal, origin) - face.offset, rate = dot(face.normal, direction);
    if (height > Real(0) && !(rate < Real(0))) return std::nullopt;
    if (rate == Real(0)) continue;
    const Real distance = -height / rate;
    if (rate > Real(0)) {
      end = std::min(end, distance);
    } else if (distance > entry.distance) {
      entry = {distance, face.normal};
    }
  }
  if (entry.distance > end) return std::nullopt;
  return entry;
}

/// Where a ray from `origin` along `direction`, of length 1, enters a body within `reach`, all in the frame of the
/// body. Exact to rounding for polytopes and balls, to 1e-6 of the size of other rounded bodies. O(faces).
template <class Real, int Dim>
[[nodiscard]] std::optional<RayEntry<Real, Dim>> ray_entry(const Convex<Real, Dim>& body,
                                                           const Vector<Real, Dim>& origin,
                                                           const Vector<Real, Dim>& direction, const Real& reach) {
  if (body.rounding == Real(0)) return entry_of_planes(body.core, origin, direction, reach);
  const Real middle = -dot(direction, origin);  // where the ray is nearest to the centre
  const Real height2 = squared(Vector<Real, Dim>(origin + direction * middle));
  if (height2 > body.reach * body.reach) return std::nullopt;
  const Real half = std::sqrt(body.reach * body.reach - height2);
  if (middle + half < Real(0) || middle - half > reach) return std::nullopt;
  const bool is_inside = signed_distance(body, origin) <= Real(0);
  if (is_inside) return RayEntry<Real, Dim>{};
  if (body.core.corners.size() == 1) {
    const Vector<Real, Dim> normal = (origin + direction * (middle - half)) * (1 / body.rounding);
    return RayEntry<Real, Dim>{middle - half, normal};
  }
  // The way to the ball around the body is free.
  const Real skipped = std::max(middle - half, Real(0));
  const Convex<Real, Dim> point{.core = {.corners = {{}}}};
  const MovingBody<Real, Dim> still{.shape = &body};
  const MovingBody<Real, Dim> moving{.shape = &point, .position = origin + direction * skipped, .velocity = direction};
  const auto contact = first_contact(still, moving, Real(reach - skipped), Real(body.reach * Real(1e-6)));
  if (!contact) return std::nullopt;
  const Vector<Real, Dim> at = moving.position + direction * contact->time;
  const auto closest = closest_points(body.core, point.core, Pose<Real, Dim>{.centre = at});
  return RayEntry<Real, Dim>{skipped + contact->time, closest.normal};
}

}  // namespace continuo
