// The rows of a joint of the exact motion: one for each direction in which it holds, one for a limit at which it is,
// and one for a motor that keeps its speed.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/exact_options.hpp>
#include <continuo/bodies/exact_rigid/motion_row.hpp>
#include <continuo/bodies/joint.hpp>
#include <continuo/bodies/rigid_stepping/joint_rows.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

/// What the motor of a joint does: it keeps its speed, or works with all its force towards it, or is none.
enum class MotorMode : std::uint8_t { none, keeps_speed, forwards, backwards };

/// The limit of a joint's coordinate by which it is held; both where they are the same.
enum class LimitSide : std::uint8_t { none, lower, upper, both };

/// A limit of joint j of a system.
struct JointLimit {
  std::uint32_t joint = 0;
  LimitSide side = LimitSide::none;
};

/// Whether a joint has a limit on this side, lower or upper. No distance is below 0, and no angle of a hinge in space
/// beyond half a turn.
template <class Real, int Dim>
[[nodiscard]] bool has_limit(const Joint<Real, Dim>& joint, LimitSide side) {
  if (!joint.limits) return false;
  const Real limit = side == LimitSide::lower ? joint.limits->lower : joint.limits->upper;
  if (!std::isfinite(limit)) return false;
  if (joint.kind == JointKind::distance) return limit > Real(0);
  return Dim == 2 || joint.kind != JointKind::hinge || std::abs(limit) < std::numbers::pi_v<Real>;
}
/// The limit that always holds: both, where they are the same, or none.
template <class Real, int Dim>
[[nodiscard]] LimitSide lasting_limit(const Joint<Real, Dim>& joint) {
  const bool are_one = has_limit(joint, LimitSide::lower) && has_limit(joint, LimitSide::upper) &&
                       joint.limits->lower == joint.limits->upper;
  return are_one ? LimitSide::both : LimitSide::none;
}
template <class Real, int Dim>
[[nodiscard]] bool has_spring(const Joint<Real, Dim>& joint) {
  return joint.spring && joint.spring->hertz > Real(0);
}
/// Whether a joint breaks where it bears too much. What bounds the force of a pull is no such strength.
template <class Real, int Dim>
[[nodiscard]] bool has_strength(const Joint<Real, Dim>& joint) {
  constexpr Real infinite = std::numeric_limits<Real>::infinity();
  return joint.kind != JointKind::pull && (joint.breaks_at < infinite || joint.breaks_at_torque < infinite);
}

/// A joint of two bodies, given by their numbers.
template <class Real, int Dim>
struct ActingJoint {
  JointHandle handle{};
  Joint<Real, Dim> joint{};  // as it was when the motion began, with the present speed of its motor
  std::uint32_t a = 0, b = 0;
  MotorMode motor = MotorMode::none;
  bool is_overloaded = false;  // at this instant the motor ceases to keep its speed
  LimitSide held = LimitSide::none;
  bool breaks = false;                  // at this instant
  const MotorLaw<Real>* law = nullptr;  // of its motor
  Real change{};                        // of the speed of its motor

  /// Gives the motor its speed at time t.
  void follow_law(const Real& t) {
    if (!law) return;
    const MotorSpeed<Real> now = law->speed(t);
    joint.motor->speed = now.speed, change = now.change;
  }
};

template <class Real, int Dim>
[[nodiscard]] bool is_held_on_one_side(const ActingJoint<Real, Dim>& joint) {
  return joint.held == LimitSide::lower || joint.held == LimitSide::upper;
}

/// Why the exact motion does not move a world with this joint; a success where it does.
template <class Real, int Dim>
[[nodiscard]] Status check_exactly_movable(const Joint<Real, Dim>& joint) {
  const auto refused = [](const char* what) {
    return invalid_input("the exact motion knows no " + std::string(what) + ": use FastMotion, or leave it out");
  };
  if (!joint.limits) return {};
  if (joint.kind == JointKind::distance && !(joint.limits->upper > Real(0)))
    return refused("distances with an upper limit of 0 (a ball joint keeps two points together)");
  if (has_limit(joint, LimitSide::lower) != has_limit(joint, LimitSide::upper) && Dim == 3 &&
      joint.kind == JointKind::hinge)
    return refused("hinges in space with one limit only, as their angle is one between -pi and pi (give both)");
  return {};
}

template <class Real, int Dim>
class JointConstraints {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  using Row = MotionRow<Real, Dim>;
  using Body = ExactBody<Real, Dim>;

  JointConstraints(const ActingJoint<Real, Dim>& of, const Body& a, const Body& b, std::vector<Row>& rows)
      : of_(of), joint_(of.joint), a_(a), b_(b), rows_(rows) {
    axes_a_ = a.axes * joint_.axes_a, axes_b_ = b.axes * joint_.axes_b;
    end_a_ = moving_point(a, joint_.anchor_a), end_b_ = moving_point(b, joint_.anchor_b);
    apart_ = {end_b_.value - end_a_.value, end_b_.change - end_a_.change};
  }

  /// Adds all rows.
  void add() {
    switch (joint_.kind) {
      case JointKind::hinge:
        hold_point();
        hold_turns(0);
        break;
      case JointKind::ball:
        hold_point();
        break;
      case JointKind::slider:
        hold_line();
        hold_turns(no_axis);
        break;
      case JointKind::weld:
        hold_point();
        hold_turns(no_axis);
        break;
      case JointKind::distance:
        if (!joint_.limits && !joint_.spring)
          put(row_along(a_, b_, unit(apart_), end_b_), length(apart_.value) - joint_.length);
        break;
      case JointKind::wheel:
        hold_line();
        hold_turns(1);
        break;
      case JointKind::universal:
        hold_point();
        hold_across(0, 1);
        break;
      case JointKind::gear:
        hold_gear();
        break;
      case JointKind::pull:
        break;
    }
    if (of_.held != LimitSide::none) rows_.push_back(limit(of_.held == LimitSide::both ? LimitSide::lower : of_.held));
    if (of_.motor != MotorMode::keeps_speed) return;
    Row row = driven();
    row.rate = joint_.motor->speed, row.drift -= of_.change;
    put(row, Real(0));
  }
  /// The row of the coordinate that the motor drives.
  [[nodiscard]] Row driven() const { return joint_.kind == JointKind::wheel ? about(1, Real(0)) : coordinate(); }
  /// The row of the coordinate that limits and the spring act on; its error is the coordinate.
  [[nodiscard]] Row coordinate() const {
    switch (joint_.kind) {
      case JointKind::distance: {
        const Real distance = length(apart_.value);
        return along(distance > Real(0) ? unit(apart_) : axis_of_a(0), distance);
      }
      case JointKind::slider:
      case JointKind::wheel:
        return along(axis_of_a(0), dot(axes_a_[0], apart_.value));
      default:
        return about(0, angle());
    }
  }
  /// The row of a limit, lower or upper, along which the joint comes away from it; its error is how far it is away.
  /// That of distances d, as d^2 - limit^2 over twice the limit, is smooth where the ends meet, and the same at the
  /// limit.
  [[nodiscard]] Row limit(LimitSide side) const {
    const bool is_upper = side == LimitSide::upper;
    const Real limit = is_upper ? joint_.limits->upper : joint_.limits->lower, sign(is_upper ? -1 : 1);
    if (joint_.kind == JointKind::distance) {
      const Real scale = sign / limit;
      return along({apart_.value * scale, apart_.change * scale}, scale * (squared(apart_.value) - limit * limit) / 2);
    }
    Row row = coordinate();
    row.direction = row.direction * sign, row.lever_a = row.lever_a * sign, row.lever_b = row.lever_b * sign;
    row.drift *= sign, row.error = sign * (row.error - limit);
    return row;
  }

 private:
  static constexpr std::size_t no_axis = 3;

  [[nodiscard]] Moving<Real, Dim> axis_of_a(std::size_t i) const { return moving_direction(a_, axes_a_[i]); }
  [[nodiscard]] Row between_bodies(Row row, const Real& error) const {
    row.a = of_.a, row.b = of_.b;
    row.error = error;
    return row;
  }
  void put(const Row& row, const Real& error) { rows_.push_back(between_bodies(row, error)); }
  [[nodiscard]] Row along(const Moving<Real, Dim>& direction, const Real& error) const {
    return between_bodies(row_along(a_, b_, direction, end_b_), error);
  }
  /// About an axis of a.
  [[nodiscard]] Row about(std::size_t axis, const Real& error) const {
    if constexpr (Dim == 2) {
      return between_bodies(row_about(a_, b_, Moving<Real, 1>{S{{Real(1)}}, S{}}), error);
    } else {
      return between_bodies(row_about(a_, b_, axis_of_a(axis)), error);
    }
  }
  /// Of b against a, about the axis.
  [[nodiscard]] Real angle() const {
    if constexpr (Dim == 2) {
      return angle_between(joint_, a_.orientation, b_.orientation);
    } else {
      return angle_about(JointFrame<Real, 3>{.axes_a = axes_a_, .axes_b = axes_b_}, 0);
    }
  }
  /// The ends stay together along an axis of a.
  void hold(std::size_t i) { put(row_along(a_, b_, axis_of_a(i), end_b_), dot(axes_a_[i], apart_.value)); }
  void hold_point() {
    for (std::size_t i = 0; i < Dim; ++i) hold(i);
  }
  void hold_line() {
    for (std::size_t i = 1; i < Dim; ++i) hold(i);
  }
  /// Axis i of a stays perpendicular to axis j of b: u . w = 0 changes by (w x u) . (spin_b - spin_a).
  void hold_across(std::size_t i, std::size_t j) {
    if constexpr (Dim == 3) {
      const V u = axes_a_[i], w = axes_b_[j];
      const V change = moment(turning(b_.spin, w), u) + moment(w, turning(a_.spin, u));
      put(row_about(a_, b_, Moving<Real, 3>{moment(w, u), change}), dot(u, w));
    }
  }
  /// b does not turn against a, but for one axis.
  void hold_turns(std::size_t free_axis) {
    if constexpr (Dim == 2) {
      if (free_axis == no_axis)
        put(row_about(a_, b_, Moving<Real, 1>{S{{Real(1)}}, S{}}), (b_.orientation - a_.orientation - joint_.start)[0]);
    } else if (free_axis == no_axis) {
      hold_across(1, 0), hold_across(2, 0), hold_across(2, 1);
    } else {
      hold_across((free_axis + 1) % 3, free_axis), hold_across((free_axis + 2) % 3, free_axis);
    }
  }
  /// ratio times the angle of a, plus that of b, stays. In space that of their spins about the axis and the axle, each
  /// fixed to its body, stays 0: there is no drift, as u' . w = (w x u) . w = 0.
  void hold_gear() {
    if constexpr (Dim == 2) {
      Row row = row_about(a_, b_, Moving<Real, 1>{S{{Real(1)}}, S{}});
      row.lever_a = S{{-joint_.ratio}};
      put(row, b_.orientation[0] + joint_.ratio * a_.orientation[0] - joint_.length);
    } else {
      Row row;
      row.lever_a = axes_a_[0] * -joint_.ratio, row.lever_b = axes_b_[1];
      put(row, Real(0));
    }
  }

  const ActingJoint<Real, Dim>& of_;
  const Joint<Real, Dim>& joint_;
  const Body &a_, &b_;
  std::vector<Row>& rows_;
  Matrix<Real, Dim> axes_a_, axes_b_;
  Moving<Real, Dim> end_a_, end_b_, apart_;
};

}  // namespace continuo
