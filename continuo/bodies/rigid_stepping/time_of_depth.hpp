// When two moving bodies that touch become deep in each other.
#pragma once
#include <algorithm>

#include <continuo/shapes/cast.hpp>

namespace continuo {

/// The time within the step at which two parts that touch at its beginning are deeper in each other, along the normal
/// of their contact, than `depth`; the duration where they never are.
template <class Real, int Dim>
[[nodiscard]] Real time_of_depth(const MovingBody<Real, Dim>& a, const MovingBody<Real, Dim>& b,
                                 const Vector<Real, Dim>& normal, const Real& depth, const Real& duration) {
  constexpr int most_rounds = 100;
  const auto reach = [](const MovingBody<Real, Dim>& body) {
    return length(body.spin) * (body.shape->reach - body.shape->rounding);
  };
  const Real approach = dot(normal, a.velocity - b.velocity) + reach(a) + reach(b);
  if (!(approach > Real(0))) return duration;
  const auto highest = [](const MovingBody<Real, Dim>& body, const Vector<Real, Dim>& direction, const Real& time) {
    const Pose<Real, Dim> pose = body.at(time);
    const auto& core = body.shape->core;
    return dot(direction, pose.place(core.corners[support(core, pose.local_direction(direction))])) +
           body.shape->rounding;
  };
  Real time(0);
  for (int round = 0; round < most_rounds && time < duration; ++round) {
    const Real room = depth - highest(a, normal, time) - highest(b, -normal, time);
    if (room < depth / 100) return time;
    time += room / approach;
  }
  return std::min(time, duration);
}

}  // namespace continuo
