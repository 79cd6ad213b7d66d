// Where a ray enters a convex body, and how far a point is from one.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

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

/// Of a polytope whose planes are moved outwards by a rounding: the last of the planes that the ray enters, if it does
/// so before it leaves one.
template <class Real, int Dim>
[[nodiscard]] std::optional<RayEntry<Real, Dim>> entry_of_planes(const Polytope<Real, Dim>& core, const Real& rounding,
                                                                 const Vector<Real, Dim>& origin,
                                                                 const Vector<Real, Dim>& direction,
                                                                 const Real& reach) {
  RayEntry<Real, Dim> entry;
  Real end = reach;
  for (const Face<Real, Dim>& face : core.faces) {
    const Real height = dot(face.normal, origin) - face.offset - rounding, rate = dot(face.normal, direction);
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

/// The entry at a root of the equation of ray and surface, where the ray begins outside, or on the surface but for
/// rounding.
template <class Real, class NormalAt>
[[nodiscard]] auto entry_from_outside(const Real& root, const Real& radius, const Real& reach, NormalAt&& normal_at)
    -> std::optional<RayEntry<Real, static_cast<int>(decltype(normal_at(root))::size())>> {
  constexpr Real rounding = std::is_same_v<Real, float> ? Real(1e-3) : Real(1e-7);  // a root loses half the digits
  if (!(root >= -rounding * radius) || root > reach) return std::nullopt;
  return {{std::max(root, Real(0)), normal_at(root)}};
}
/// Of a ball about a point.
template <class Real, int Dim>
[[nodiscard]] std::optional<RayEntry<Real, Dim>> entry_of_ball(const Vector<Real, Dim>& centre, const Real& radius,
                                                               const Vector<Real, Dim>& origin,
                                                               const Vector<Real, Dim>& direction, const Real& reach) {
  const Vector<Real, Dim> from = origin - centre;
  const Real along = -dot(from, direction);
  const Real room = radius * radius - squared(Vector<Real, Dim>(from + direction * along));
  if (!(room >= Real(0))) return std::nullopt;
  return entry_from_outside(along - std::sqrt(room), radius, reach, [&](const Real& distance) {
    return Vector<Real, Dim>((from + direction * distance) * (1 / radius));
  });
}

/// Of a capsule: of the infinite cylinder where the ray enters that between its ends, else of a ball at an end. Across
/// the axis u, ray and cylinder are |o + t d|^2 = r^2 for the parts o, d of the ray that are perpendicular to u.
template <class Real, int Dim>
[[nodiscard]] std::optional<RayEntry<Real, Dim>> entry_of_capsule(const Vector<Real, Dim>& from,
                                                                  const Vector<Real, Dim>& to, const Real& radius,
                                                                  const Vector<Real, Dim>& origin,
                                                                  const Vector<Real, Dim>& direction,
                                                                  const Real& reach) {
  using V = Vector<Real, Dim>;
  const Real span = length(V(to - from));
  const V axis = (to - from) * (1 / span), begin = origin - from;
  const Real rate = dot(direction, axis), start = dot(begin, axis);
  const V d = direction - axis * rate, o = begin - axis * start;
  const Real a = squared(d), half_b = dot(o, d), c = squared(o) - radius * radius;
  const Real discriminant = half_b * half_b - a * c;
  if (!(discriminant >= Real(0))) return std::nullopt;
  // Along the axis, the ray can enter an end only.
  const bool is_across = a > std::numeric_limits<Real>::epsilon();
  const Real distance = is_across ? (-half_b - std::sqrt(discriminant)) / a : Real(0);
  const Real place = is_across ? start + rate * distance : rate > Real(0) ? Real(-1) : span + 1;
  if (place <= Real(0)) return entry_of_ball(from, radius, origin, direction, reach);
  if (place >= span) return entry_of_ball(to, radius, origin, direction, reach);
  return entry_from_outside(distance, radius, reach, [&](const Real& at) { return V((o + d * at) * (1 / radius)); });
}

/// Whether a point on the moved plane of a face of a rounded polytope is above the face itself.
template <class Real, int Dim>
[[nodiscard]] bool is_above_face(const Convex<Real, Dim>& body, const Vector<Real, Dim>& normal,
                                 const Vector<Real, Dim>& x) {
  const Vector<Real, Dim> on_core = x - normal * body.rounding;
  const Real slack = 8 * std::numeric_limits<Real>::epsilon() * body.reach;
  return std::ranges::all_of(
      body.core.faces, [&](const Face<Real, Dim>& face) { return dot(face.normal, on_core) <= face.offset + slack; });
}

/// Where a ray from `origin` along `direction`, of length 1, enters a body within `reach`, all in the frame of the
/// body. Exact to rounding for polytopes, balls, capsules and the faces of other rounded bodies, to 1e-6 of the size
/// for their edges and corners. O(faces).
template <class Real, int Dim>
[[nodiscard]] std::optional<RayEntry<Real, Dim>> ray_entry(const Convex<Real, Dim>& body,
                                                           const Vector<Real, Dim>& origin,
                                                           const Vector<Real, Dim>& direction, const Real& reach) {
  using V = Vector<Real, Dim>;
  if (body.rounding == Real(0)) return entry_of_planes(body.core, Real(0), origin, direction, reach);
  const Real middle = -dot(direction, origin);  // where the ray is nearest to the centre
  const Real height2 = squared(V(origin + direction * middle));
  if (height2 > body.reach * body.reach) return std::nullopt;
  const Real half = std::sqrt(body.reach * body.reach - height2);
  if (middle + half < Real(0) || middle - half > reach) return std::nullopt;
  if (middle - half <= Real(0) && signed_distance(body, origin) <= Real(0)) return RayEntry<Real, Dim>{};
  // The way to the ball around the body is free.
  Real skipped = std::max(middle - half, Real(0));
  // The sum is compared with the reach: what is as far as it but for rounding is as far for each shape.
  constexpr Real endless = std::numeric_limits<Real>::infinity();
  const auto later = [&](std::optional<RayEntry<Real, Dim>> entry) {
    if (entry) entry->distance += skipped;
    return entry && entry->distance > reach ? std::nullopt : entry;
  };
  const auto& corners = body.core.corners;
  const V start = origin + direction * skipped;
  if (corners.size() == 1) return later(entry_of_ball(corners[0], body.rounding, start, direction, endless));
  if (corners.size() == 2)
    return later(entry_of_capsule(corners[0], corners[1], body.rounding, start, direction, endless));
  const auto planes = entry_of_planes(body.core, body.rounding, start, direction, Real(reach - skipped));
  if (!planes) return std::nullopt;
  if (planes->normal != V{} && is_above_face(body, planes->normal, V(start + direction * planes->distance)))
    return later(planes);
  skipped += planes->distance;
  const Convex<Real, Dim> point{.core = {.corners = {{}}}};
  const MovingBody<Real, Dim> still{.shape = &body};
  const MovingBody<Real, Dim> moving{.shape = &point, .position = origin + direction * skipped, .velocity = direction};
  const auto contact = first_contact(still, moving, Real(reach - skipped), Real(body.reach * Real(1e-6)));
  if (!contact) return std::nullopt;
  const V at = moving.position + direction * contact->time;
  const auto closest = closest_points(body.core, point.core, Pose<Real, Dim>{.centre = at});
  return RayEntry<Real, Dim>{skipped + contact->time, closest.normal};
}

}  // namespace continuo
