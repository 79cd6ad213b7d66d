// When two moving bodies that touch become deep in each other, by conservative advancement as in cast.hpp.
#pragma once
#include <algorithm>

#include <continuo/shapes/cast.hpp>
#include <continuo/shapes/manifold.hpp>

namespace continuo {

/// Two moving parts, and how deep they are in each other.
template <class Real, int Dim>
struct MovingPair {
  using V = Vector<Real, Dim>;
  const MovingBody<Real, Dim>&a, &b;

  /// Along a direction from a to b.
  [[nodiscard]] Real overlap(const V& direction, const Real& time) const {
    return highest(a, direction, time) + highest(b, -direction, time);
  }
  /// The direction, from a to b, along which they overlap least, or are farthest apart, and how far apart they are.
  struct Least {
    V direction{};
    Real separation{};
  };
  [[nodiscard]] Least least_overlap_at(const Real& time) const {
    const Pose<Real, Dim> at_a = a.at(time), b_in_a = relative(at_a, b.at(time));
    const auto &core_a = a.shape->core, &core_b = b.shape->core;
    const Real roundings = a.shape->rounding + b.shape->rounding;
    const auto closest = closest_points(core_a, core_b, b_in_a);
    if (closest.distance > Real(1e-5) * std::min(a.shape->reach, b.shape->reach)) {
      // Between points that nearly touch the normal has few digits: along it, long shapes may overlap deeply.
      const V normal = at_a.axes * closest.normal;
      const Real separation = -overlap(normal, time);
      if (separation + roundings > closest.distance / 2) return {normal, separation};
    }
    const auto axis = least_overlap(core_a, core_b, b_in_a, Real(0));
    return {at_a.axes * axis.normal, axis.separation - roundings};
  }
  /// From `time` on, the first time at which they overlap along a direction by `most`; the duration where they never
  /// do. No point of a body moves against its centre faster than the spin times its reach.
  [[nodiscard]] Real time_of_overlap(const V& direction, const Real& most, const Real& within, Real time,
                                     const Real& duration) const {
    constexpr int most_rounds = 100;
    const Real approach = dot(direction, a.velocity - b.velocity) + turning_speed(a) + turning_speed(b);
    if (!(approach > Real(0))) return duration;
    for (int round = 0; round < most_rounds && time < duration; ++round) {
      const Real room = most - overlap(direction, time);
      if (room < within) return time;
      time += room / approach;
    }
    return std::min(time, duration);
  }

 private:
  [[nodiscard]] static Real highest(const MovingBody<Real, Dim>& body, const V& direction, const Real& time) {
    const Pose<Real, Dim> pose = body.at(time);
    const auto& core = body.shape->core;
    return dot(direction, pose.place(core.corners[support(core, pose.local_direction(direction))])) +
           body.shape->rounding;
  }
  [[nodiscard]] static Real turning_speed(const MovingBody<Real, Dim>& body) {
    return length(body.spin) * (body.shape->reach - body.shape->rounding);
  }
};

/// The time within the step at which a part that touches a plane, which `b` is a point of, at its beginning is deeper
/// behind it along the normal than `depth`; the duration where it never is. A part that begins deeper may move on until
/// it is deeper by a quarter of that: the solver pushes it out, for which it has to move.
template <class Real, int Dim>
[[nodiscard]] Real time_of_depth(const MovingBody<Real, Dim>& a, const MovingBody<Real, Dim>& b,
                                 const Vector<Real, Dim>& normal, const Real& depth, const Real& duration) {
  const MovingPair<Real, Dim> pair{a, b};
  const Real most = std::max(depth, pair.overlap(normal, Real(0)) + depth / 4);
  return pair.time_of_overlap(normal, most, depth / 100, Real(0), duration);
}
/// The same for two parts, of which one is no deeper in the other one, beside an edge of it, than the least way on
/// which it would leave. Along any direction the two overlap by no less than that: so the time goes to where they do
/// along the best one.
template <class Real, int Dim>
[[nodiscard]] Real time_of_depth(const MovingBody<Real, Dim>& a, const MovingBody<Real, Dim>& b, const Real& depth,
                                 const Real& duration) {
  constexpr int most_rounds = 100;
  const MovingPair<Real, Dim> pair{a, b};
  auto least = pair.least_overlap_at(Real(0));
  const Real most = std::max(depth, depth / 4 - least.separation);
  Real time(0);
  for (int round = 0; round < most_rounds && time < duration; ++round) {
    const Real next = pair.time_of_overlap(least.direction, most, depth / 100, time, duration);
    if (next == time) return time;
    time = next;
    if (time < duration) least = pair.least_overlap_at(time);
  }
  return time;
}

}  // namespace continuo
