// How far two convex parts of bodies are apart, and until when they surely stay apart.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

#include <continuo/bodies/exact_rigid/exact_body.hpp>
#include <continuo/shapes/manifold.hpp>

namespace continuo {

/// A part of a body, or the half space behind a wall.
template <class Real, int Dim>
struct ExactPart {
  const Convex<Real, Dim>* convex = nullptr;  // null of a wall
  Pose<Real, Dim> in_body{};
  Vector<Real, Dim> wall_normal{};  // out of the wall
  Real wall_offset{};
  std::uint32_t body = 0;

  [[nodiscard]] bool is_wall() const { return convex == nullptr; }
  [[nodiscard]] Real rounding() const { return convex ? convex->rounding : Real(0); }
  [[nodiscard]] Pose<Real, Dim> pose(const ExactBody<Real, Dim>& of) const {
    return {of.x + of.axes * in_body.centre, of.axes * in_body.axes};
  }
};

/// The distance of the surfaces along the normal from a to b; below 0 where they overlap.
template <class Real, int Dim>
struct Separation {
  Real gap{};
  Vector<Real, Dim> normal{};  // in the world
};

/// The separation of the cores of two parts, in the frame of the first. Cores that nearly touch have no closest points
/// that are exact enough for a normal: there it is the direction in which they overlap least.
template <class Real, int Dim>
[[nodiscard]] SeparatingAxis<Real, Dim> separation_of_cores(const Convex<Real, Dim>& a, const Convex<Real, Dim>& b,
                                                            const Pose<Real, Dim>& b_in_a) {
  const ClosestPoints<Real, Dim> closest = closest_points(a.core, b.core, b_in_a);
  constexpr Real least = std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-7);
  if (closest.distance > least * std::min(a.reach, b.reach)) return {closest.normal, closest.distance, closest.on_a};
  return least_overlap(a.core, b.core, b_in_a, Real(0));
}
/// The separation of part a and part b, of which only a may be a wall.
template <class Real, int Dim>
[[nodiscard]] Separation<Real, Dim> separation_of(const ExactPart<Real, Dim>& part_a, const ExactBody<Real, Dim>& a,
                                                  const ExactPart<Real, Dim>& part_b, const ExactBody<Real, Dim>& b) {
  using V = Vector<Real, Dim>;
  const Pose<Real, Dim> pose_b = part_b.pose(b);
  if (part_a.is_wall()) {
    const V& n = part_a.wall_normal;
    const V& corner = part_b.convex->core.corners[support(part_b.convex->core, pose_b.local_direction(-n))];
    return {dot(n, pose_b.place(corner)) - part_a.wall_offset - part_b.rounding(), n};
  }
  const Pose<Real, Dim> pose_a = part_a.pose(a);
  const auto axis = separation_of_cores(*part_a.convex, *part_b.convex, relative(pose_a, pose_b));
  return {axis.separation - part_a.rounding() - part_b.rounding(), pose_a.axes * axis.normal};
}

/// The points at which two parts touch, up to a gap: the normal and the places, in the world.
template <class Real, int Dim>
struct TouchingPlaces {
  Vector<Real, Dim> normal{};  // from a to b
  std::vector<Vector<Real, Dim>> places{};
};
template <class Real, int Dim>
[[nodiscard]] TouchingPlaces<Real, Dim> touching_places(const ExactPart<Real, Dim>& part_a,
                                                        const ExactBody<Real, Dim>& a,
                                                        const ExactPart<Real, Dim>& part_b,
                                                        const ExactBody<Real, Dim>& b, const Real& gap) {
  const Convex<Real, Dim>&convex_a = *part_a.convex, &convex_b = *part_b.convex;
  const Pose<Real, Dim> pose_a = part_a.pose(a), b_in_a = relative(pose_a, part_b.pose(b));
  const Real most = gap + convex_a.rounding + convex_b.rounding;
  const SeparatingAxis<Real, Dim> axis = separation_of_cores(convex_a, convex_b, b_in_a);
  TouchingPlaces<Real, Dim> found;
  if (axis.separation > most) return found;
  CommonPoints<Real, Dim> common = common_points_along(convex_a.core, convex_b.core, b_in_a, axis.normal);
  common.drop_beyond(most);
  if (common.empty()) common.add({axis.on_a, axis.separation, CommonPoint<Real, Dim>::closest});
  found.normal = pose_a.axes * axis.normal;
  for (const CommonPoint<Real, Dim>& point : common)
    found.places.push_back(pose_a.place(point.on_a + axis.normal * convex_a.rounding));
  return found;
}

/// The corners of a part along a direction that is at rest in the world, each with its rate.
template <class Real, int Dim>
struct MovingCorners {
  std::array<Real, Polytope<Real, Dim>::most_corners> value{}, rate{};
  std::size_t size = 0;

  MovingCorners(const ExactPart<Real, Dim>& part, const ExactBody<Real, Dim>& body, const Vector<Real, Dim>& normal,
                const Real& sign) {
    if (part.is_wall()) {
      value[0] = sign * part.wall_offset, size = 1;
      return;
    }
    const Pose<Real, Dim> pose = part.pose(body);
    for (const Vector<Real, Dim>& corner : part.convex->core.corners) {
      const Vector<Real, Dim> x = pose.place(corner);
      value[size] = sign * dot(normal, x), rate[size++] = sign * dot(normal, body.velocity_at(x));
    }
  }
  /// The least of them after a time, with its rate then.
  [[nodiscard]] std::array<Real, 2> least(const Real& duration) const {
    std::array<Real, 2> best{std::numeric_limits<Real>::infinity(), Real(0)};
    for (std::size_t i = 0; i < size; ++i)
      if (const Real here = value[i] + rate[i] * duration; here < best[0]) best = {here, rate[i]};
    return best;
  }
};

/// A time, at most `longest`, for which the gap surely stays above `level`, above which it is now. No point of the
/// bodies may accelerate by more than `most`, the sum of both: along the present normal, which separates the bodies as
/// long as the least corner of b is beyond the greatest of a, every corner stays above a parabola. The least of these
/// is concave in time: chords approach its zero from the left, tangents from the right.
template <class Real, int Dim>
[[nodiscard]] Real safe_time(const ExactPart<Real, Dim>& part_a, const ExactBody<Real, Dim>& a,
                             const ExactPart<Real, Dim>& part_b, const ExactBody<Real, Dim>& b,
                             const Vector<Real, Dim>& normal, const Real& level, const Real& most,
                             const Real& longest) {
  const MovingCorners<Real, Dim> of_a(part_a, a, normal, Real(-1)), of_b(part_b, b, normal, Real(1));
  const Real beyond = part_a.rounding() + part_b.rounding() + level;
  const auto room = [&](const Real& duration) {
    const auto at_a = of_a.least(duration), at_b = of_b.least(duration);
    return std::array<Real, 2>{at_a[0] + at_b[0] - beyond - most * duration * duration / 2,
                               at_a[1] + at_b[1] - most * duration};
  };
  Real low(0), high = longest, at_low = room(low)[0];
  auto at_high = room(high);
  if (at_high[0] >= Real(0)) return longest;
  if (!(at_low > Real(0))) return Real(0);
  for (int round = 0; round < 40; ++round) {
    const Real chord = low + (high - low) * (at_low / (at_low - at_high[0]));
    if (chord > low) low = chord, at_low = room(low)[0];
    if (!(at_low > Real(0))) break;
    const Real tangent = at_high[1] < Real(0) ? high - at_high[0] / at_high[1] : high;
    if (tangent < high && tangent > low) high = tangent, at_high = room(high);
    if (at_high[0] >= Real(0) || high - low <= Real(0.05) * low) break;
  }
  return low;
}

}  // namespace continuo
