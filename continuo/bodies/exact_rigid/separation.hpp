// How far two convex parts of bodies are apart, and where they touch.
#pragma once
#include <algorithm>
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

/// How far two polytopes are apart along a direction of length 1, from a to b.
template <class Real, int Dim>
[[nodiscard]] Real separation_along(const Polytope<Real, Dim>& a, const Polytope<Real, Dim>& b,
                                    const Pose<Real, Dim>& b_in_a, const Vector<Real, Dim>& normal) {
  const Vector<Real, Dim>& of_a = a.corners[support(a, normal)];
  const Vector<Real, Dim>& of_b = b.corners[support(b, b_in_a.local_direction(-normal))];
  return dot(normal, b_in_a.place(of_b) - of_a);
}
/// The separation of the cores of two parts, in the frame of the first: what surely lies between them along the normal.
/// Cores that nearly touch have no closest points that are exact enough for a normal: there it is the direction in
/// which they overlap least. Where rounding has turned the line of the closest points, the better of both is taken:
/// steps towards a meeting need a normal that separates.
template <class Real, int Dim>
[[nodiscard]] SeparatingAxis<Real, Dim> separation_of_cores(const Convex<Real, Dim>& a, const Convex<Real, Dim>& b,
                                                            const Pose<Real, Dim>& b_in_a) {
  const ClosestPoints<Real, Dim> closest = closest_points(a.core, b.core, b_in_a);
  constexpr Real least = std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-7);
  const Real size = std::min(a.reach, b.reach);
  if (!(closest.distance > least * size)) return least_overlap(a.core, b.core, b_in_a, Real(0));
  const Real surely = separation_along(a.core, b.core, b_in_a, closest.normal);
  const SeparatingAxis<Real, Dim> of_points{closest.normal, std::min(surely, closest.distance), closest.on_a};
  if (closest.distance - surely <= 64 * std::numeric_limits<Real>::epsilon() * size) return of_points;
  const SeparatingAxis<Real, Dim> least_one = least_overlap(a.core, b.core, b_in_a, Real(0));
  return least_one.separation > of_points.separation ? least_one : of_points;
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
  std::vector<Real> gaps{};  // there
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
  for (const CommonPoint<Real, Dim>& point : common) {
    found.places.push_back(pose_a.place(point.on_a + axis.normal * convex_a.rounding));
    found.gaps.push_back(point.separation - convex_a.rounding - convex_b.rounding);
  }
  return found;
}

}  // namespace continuo
