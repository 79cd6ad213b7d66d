// Constraints of two bodies, row by row, of position, velocity and acceleration at once. With v(c) the velocity of the
// point of a body that is at c, the rate of a row is
//
//   J v = direction . (v_b(c) - v_a(c)) + turn . (spin_b - spin_a),
//
// and its drift is the derivative of that at constant velocities and spins, so that its acceleration is J a + drift.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <continuo/bodies/exact_rigid/exact_body.hpp>

namespace continuo {

template <class Real, int Dim>
struct MotionRow {
  std::uint32_t a = 0, b = 0;                    // bodies
  Vector<Real, Dim> direction{};                 // of the force on b; 0 for a torque
  Spin<Real, Dim> lever_a{}, lever_b{};          // arms x direction, or the axis of a torque
  Vector<Real, Dim> rub{};                       // of a contact that slips: its friction on b by a normal force of 1
  Spin<Real, Dim> rub_lever_a{}, rub_lever_b{};  // likewise
  Real drift{};                                  // of the rate
  Real error{};                                  // of the position, 0 where the row holds only a rate
  Real rate{};                                   // that is wanted

  [[nodiscard]] Real rate_of(const ExactBody<Real, Dim>& body_a, const ExactBody<Real, Dim>& body_b) const {
    return dot(direction, body_b.v - body_a.v) + dot(lever_b, body_b.spin) - dot(lever_a, body_a.spin);
  }
};

/// What moves with a and b: a direction or an axis, or a point, with its change in time.
template <class Real, int Size>
struct Moving {
  Vector<Real, Size> value{}, change{};
};
template <class Real, int Dim>
[[nodiscard]] Moving<Real, Dim> moving_direction(const ExactBody<Real, Dim>& body, const Vector<Real, Dim>& in_world) {
  return {in_world, turning(body.spin, in_world)};
}
template <class Real, int Dim>
[[nodiscard]] Moving<Real, Dim> moving_point(const ExactBody<Real, Dim>& body, const Vector<Real, Dim>& in_body) {
  const Vector<Real, Dim> arm = body.axes * in_body;
  return {body.x + arm, body.v + turning(body.spin, arm)};
}
/// A moving vector divided by its length.
template <class Real, int Size>
[[nodiscard]] Moving<Real, Size> unit(const Moving<Real, Size>& of) {
  const Real inverse = 1 / length(of.value);
  const Vector<Real, Size> direction = of.value * inverse;
  return {direction, (of.change - direction * dot(direction, of.change)) * inverse};
}

/// The row along a direction at a place.
template <class Real, int Dim>
[[nodiscard]] MotionRow<Real, Dim> row_along(const ExactBody<Real, Dim>& a, const ExactBody<Real, Dim>& b,
                                             const Moving<Real, Dim>& direction, const Moving<Real, Dim>& place) {
  using V = Vector<Real, Dim>;
  const V arm_a = place.value - a.x, arm_b = place.value - b.x;
  MotionRow<Real, Dim> row;
  row.direction = direction.value;
  row.lever_a = moment(arm_a, direction.value), row.lever_b = moment(arm_b, direction.value);
  const V between = b.v + turning(b.spin, arm_b) - a.v - turning(a.spin, arm_a);
  const V turning_on = turning(b.spin, V(place.change - b.v)) - turning(a.spin, V(place.change - a.v));
  row.drift = dot(direction.change, between) + dot(direction.value, turning_on);
  return row;
}
/// The row about an axis.
template <class Real, int Dim, int Size>
[[nodiscard]] MotionRow<Real, Dim> row_about(const ExactBody<Real, Dim>& a, const ExactBody<Real, Dim>& b,
                                             const Moving<Real, Size>& axis) {
  MotionRow<Real, Dim> row;
  row.lever_a = row.lever_b = axis.value;
  row.drift = dot(axis.change, b.spin - a.spin);
  return row;
}

/// The change of the rate of one row by a unit of the force of another.
template <class Real, int Dim>
[[nodiscard]] Real response(const MotionRow<Real, Dim>& of, const MotionRow<Real, Dim>& to,
                            const ExactBody<Real, Dim>* bodies) {
  Real sum(0);
  const auto add = [&](std::uint32_t body, const Real& sign, const Spin<Real, Dim>& lever) {
    const ExactBody<Real, Dim>& at = bodies[body];
    if (at.is_fixed()) return;
    const auto from = [&](const Real& other, const Spin<Real, Dim>& to_lever, const Spin<Real, Dim>& rub_lever) {
      sum += sign * other *
             (at.inverse_mass * dot(of.direction, to.direction + to.rub) +
              dot(lever, at.inverse_inertia_now * Spin<Real, Dim>(to_lever + rub_lever)));
    };
    if (to.a == body) from(Real(-1), to.lever_a, to.rub_lever_a);
    if (to.b == body) from(Real(1), to.lever_b, to.rub_lever_b);
  };
  add(of.a, Real(-1), of.lever_a), add(of.b, Real(1), of.lever_b);
  return sum;
}

}  // namespace continuo
