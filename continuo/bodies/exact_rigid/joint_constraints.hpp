// The rows of a joint of the exact motion: one for each direction in which it holds, and one for a motor that keeps its
// speed.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/exact_rigid/motion_row.hpp>
#include <continuo/bodies/joint.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

/// What the motor of a joint does: it keeps its speed, or works with all its force towards it, or is none.
enum class MotorMode : std::uint8_t { none, keeps_speed, forwards, backwards };

/// A joint of two bodies, given by their numbers.
template <class Real, int Dim>
struct ActingJoint {
  JointHandle handle{};
  Joint<Real, Dim> joint{};  // as it was when the motion began
  std::uint32_t a = 0, b = 0;
  MotorMode motor = MotorMode::none;
  bool is_overloaded = false;  // at this instant the motor ceases to keep its speed
};

/// Why the exact motion does not move a world with this joint; a success where it does.
template <class Real, int Dim>
[[nodiscard]] Status check_exactly_movable(const Joint<Real, Dim>& joint) {
  const auto refused = [](const char* what) {
    return invalid_input("the exact motion knows no " + std::string(what) + ": use FastMotion, or leave it out");
  };
  if (joint.kind == JointKind::pull) return refused("joints that pull");
  if (joint.kind == JointKind::gear && Dim == 3) return refused("gears in space");
  if (joint.limits) return refused("limits of joints");
  if (joint.spring && joint.spring->hertz > Real(0)) return refused("springs of joints");
  if (joint.breaks_at < std::numeric_limits<Real>::infinity() ||
      joint.breaks_at_torque < std::numeric_limits<Real>::infinity())
    return refused("joints that break");
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
    if (of_.motor != MotorMode::keeps_speed) return;
    Row row = coordinate();
    row.rate = joint_.motor->speed;
    put(row, Real(0));
  }
  /// The row of the coordinate that the motor drives, without its bodies.
  [[nodiscard]] Row coordinate() const {
    if (joint_.kind == JointKind::slider) return row_along(a_, b_, axis_of_a(0), end_b_);
    if constexpr (Dim == 2) {
      return row_about(a_, b_, Moving<Real, 1>{S{{Real(1)}}, S{}});
    } else {
      return row_about(a_, b_, axis_of_a(joint_.kind == JointKind::wheel ? 1 : 0));
    }
  }

 private:
  static constexpr std::size_t no_axis = 3;

  [[nodiscard]] Moving<Real, Dim> axis_of_a(std::size_t i) const { return moving_direction(a_, axes_a_[i]); }
  void put(Row row, const Real& error) {
    row.a = of_.a, row.b = of_.b;
    row.error = error;
    rows_.push_back(row);
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
  /// ratio times the angle of a, plus that of b, stays.
  void hold_gear() {
    if constexpr (Dim == 2) {
      Row row = row_about(a_, b_, Moving<Real, 1>{S{{Real(1)}}, S{}});
      row.lever_a = S{{-joint_.ratio}};
      put(row, b_.orientation[0] + joint_.ratio * a_.orientation[0] - joint_.length);
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
