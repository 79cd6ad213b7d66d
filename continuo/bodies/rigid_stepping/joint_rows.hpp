// The rows of a joint: one for each direction in which it holds, and for limits, springs and motors.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/joint.hpp>
#include <continuo/bodies/rigid_stepping/constraint_rows.hpp>

namespace continuo {

/// How the joints of a substep are held.
template <class Real>
struct JointHardness {
  Real h{};             // the substep
  Real rate{};          // of undoing errors, per time
  Real softness{};      // velocity per impulse, times the mass; 0 is rigid
  Real fastest_push{};  // of undoing errors of a joint at rest
};

/// What a row of a joint does, which tells the impulses of the last substep apart.
enum class JointRow : std::uint8_t {
  hold_0,
  hold_1,
  hold_2,
  turn_0,
  turn_1,
  turn_2,
  lower,
  upper,
  spring,
  motor,
  count
};

/// A joint's impulses of the last substep, by what they do.
template <class Real>
using JointImpulses = std::array<Real, static_cast<std::size_t>(JointRow::count)>;

/// Where the frames of a joint are in the world.
template <class Real, int Dim>
struct JointFrame {
  Matrix<Real, Dim> axes_a{}, axes_b{};
  Vector<Real, Dim> arm_a{}, arm_b{};  // from the centres to the anchors
  Vector<Real, Dim> apart{};           // from the anchor of a to that of b
};
template <class Real, int Dim>
[[nodiscard]] JointFrame<Real, Dim> frame_of(const Joint<Real, Dim>& joint, const RigidBody<Real, Dim>& a,
                                             const RigidBody<Real, Dim>& b) {
  JointFrame<Real, Dim> frame;
  frame.axes_a = a.axes * joint.axes_a, frame.axes_b = b.axes * joint.axes_b;
  frame.arm_a = a.axes * joint.anchor_a, frame.arm_b = b.axes * joint.anchor_b;
  frame.apart = (b.x + frame.arm_b) - (a.x + frame.arm_a);
  return frame;
}

/// The angle of b against a about the axis of a hinge, or about the axle of a wheel, from that of the beginning: in
/// space between -pi and pi.
template <class Real>
[[nodiscard]] Real angle_between(const Joint<Real, 2>& joint, const Vector<Real, 1>& a, const Vector<Real, 1>& b) {
  return (b - a - joint.start)[0];
}
template <class Real>
[[nodiscard]] Real angle_about(const JointFrame<Real, 3>& frame, std::size_t axis) {
  const Vector<Real, 3>&across = frame.axes_a[(axis + 1) % 3], &other = frame.axes_a[(axis + 2) % 3];
  const Vector<Real, 3>& turned_across = frame.axes_b[(axis + 1) % 3];
  return std::atan2(dot(turned_across, other), dot(turned_across, across));
}

/// Adds rows to a block.
template <class Real, int Dim>
class JointRows {
 public:
  JointRows(const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b, const JointHardness<Real>& hardness,
            const JointImpulses<Real>& impulses, Constraints<Real, Dim>& all, std::vector<JointRow>& kinds)
      : a_(a), b_(b), hardness_(hardness), impulses_(impulses), all_(all), kinds_(kinds) {}

  /// Keeps the anchors together along a direction that turns with a.
  void hold(JointRow kind, const Vector<Real, Dim>& direction, const JointFrame<Real, Dim>& frame) {
    correct(along(kind, direction, frame), dot(direction, frame.apart));
  }
  /// Keeps b from turning against a about an axis, where it is turned by `error`.
  void hold_turn(JointRow kind, const Spin<Real, Dim>& axis, const Real& error) { correct(about(kind, axis), error); }

  /// The row of a coordinate that is a length along a direction, and of one that is an angle.
  /// @{
  ConstraintRow<Real, Dim>& along(JointRow kind, const Vector<Real, Dim>& direction,
                                  const JointFrame<Real, Dim>& frame) {
    ConstraintRow<Real, Dim>& row = add(kind);
    row.direction = direction;
    row.lever_a = moment(Vector<Real, Dim>(frame.arm_a + frame.apart), direction);
    row.lever_b = moment(frame.arm_b, direction);
    set_mass(row, a_, b_);
    return row;
  }
  ConstraintRow<Real, Dim>& about(JointRow kind, const Spin<Real, Dim>& axis) {
    ConstraintRow<Real, Dim>& row = add(kind);
    row.lever_a = row.lever_b = axis;
    set_mass(row, a_, b_);
    return row;
  }
  /// @}

  /// Undoes an error.
  void correct(ConstraintRow<Real, Dim>& row, const Real& error) const {
    // What a substep at these velocities gives is undone at once. Ends that are farther apart, since they never were
    // together or something heavy has torn at them, are drawn together slowly.
    const Real speed = row.direction == Vector<Real, Dim>{}
                           ? length(a_.spin) + length(b_.spin)
                           : length(a_.v) + length(b_.v) + length(row.lever_a) * length(a_.spin) +
                                 length(row.lever_b) * length(b_.spin);
    const bool is_of_substep = std::abs(error) <= speed * hardness_.h / 2;
    const Real fastest = is_of_substep ? speed : hardness_.fastest_push;
    row.bias = std::clamp(Real(hardness_.rate * error), -fastest, fastest);
    row.softness = row.mass > Real(0) ? hardness_.softness / row.mass : Real(0);
  }
  /// The coordinate, whose rows `make(kind)` adds, obeys the limits, the spring and the motor.
  template <class Make>
  void drive(const Joint<Real, Dim>& joint, const Real& coordinate, const Real& beginning, Make&& make) {
    if (joint.spring && joint.spring->hertz > Real(0)) {
      ConstraintRow<Real, Dim>& row = make(JointRow::spring);
      pull(row, *joint.spring, coordinate - beginning - joint.spring->rest);
    }
    if (joint.motor) drive_motor(*joint.motor, make(JointRow::motor));
    if (joint.limits) limit(*joint.limits, coordinate, make);
  }
  void drive_motor(const JointMotor<Real>& motor, ConstraintRow<Real, Dim>& row) const {
    row.bias = row.bias_at_end = -motor.speed;
    row.least = -motor.most * hardness_.h, row.most = motor.most * hardness_.h;
  }
  template <class Make>
  void limit(const JointLimits<Real>& limits, const Real& coordinate, Make&& make) {
    const auto one_sided = [&](ConstraintRow<Real, Dim>& row, const Real& room) {
      row.least = Real(0);
      row.bias = room > Real(0) ? room / hardness_.h : std::max(hardness_.rate * room, -hardness_.fastest_push);
      row.bias_at_end = room > Real(0) ? room / hardness_.h : Real(0);
    };
    if (limits.lower > -std::numeric_limits<Real>::infinity())
      one_sided(make(JointRow::lower), coordinate - limits.lower);
    if (limits.upper < std::numeric_limits<Real>::infinity()) {
      ConstraintRow<Real, Dim>& row = make(JointRow::upper);
      row.direction = -row.direction, row.lever_a = -row.lever_a, row.lever_b = -row.lever_b;
      one_sided(row, limits.upper - coordinate);
    }
  }
  /// A spring: an implicit Euler step of it (contact_step.hpp), in both passes.
  void pull(ConstraintRow<Real, Dim>& row, const JointSpring<Real>& spring, const Real& error) const {
    const Softness<Real> soft = softness(spring.hertz, spring.damping, hardness_.h);
    row.bias = row.bias_at_end = soft.rate * error;
    row.softness = row.mass > Real(0) ? soft.of_impulse / (soft.of_mass * row.mass) : Real(0);
  }

 private:
  ConstraintRow<Real, Dim>& add(JointRow kind) {
    kinds_.push_back(kind);
    ConstraintRow<Real, Dim>& row = all_.rows.emplace_back();
    row.impulse = impulses_[static_cast<std::size_t>(kind)];
    return row;
  }
  const RigidBody<Real, Dim>&a_, &b_;
  const JointHardness<Real>& hardness_;
  const JointImpulses<Real>& impulses_;
  Constraints<Real, Dim>& all_;
  std::vector<JointRow>& kinds_;
};

/// Turns of b against a, whose axes were the same at the beginning, about the axes of a: small ones.
template <class Real>
[[nodiscard]] Vector<Real, 3> turn_error(const JointFrame<Real, 3>& frame) {
  Vector<Real, 3> sum;  // of axes_a x axes_b over 2
  for (std::size_t i = 0; i < 3; ++i) sum += moment(frame.axes_a[i], frame.axes_b[i]) * Real(0.5);
  return {{dot(sum, frame.axes_a[0]), dot(sum, frame.axes_a[1]), dot(sum, frame.axes_a[2])}};
}

/// Keeps b from turning against a: about all axes, or all but one.
template <class Real>
void hold_turns(JointRows<Real, 2>& rows, const Joint<Real, 2>& joint, const JointFrame<Real, 2>&,
                const RigidBody<Real, 2>& a, const RigidBody<Real, 2>& b, std::size_t) {
  rows.hold_turn(JointRow::turn_0, {{Real(1)}}, angle_between(joint, a.orientation, b.orientation));
}
template <class Real>
void hold_turns(JointRows<Real, 3>& rows, const Joint<Real, 3>&, const JointFrame<Real, 3>& frame,
                const RigidBody<Real, 3>&, const RigidBody<Real, 3>&, std::size_t free_axis) {
  constexpr std::array<JointRow, 3> kinds{JointRow::turn_0, JointRow::turn_1, JointRow::turn_2};
  const Vector<Real, 3> tilt =
      free_axis < 3 ? moment(frame.axes_a[free_axis], frame.axes_b[free_axis]) : Vector<Real, 3>{};
  const Vector<Real, 3> error = turn_error(frame);
  for (std::size_t i = 0; i < 3; ++i) {
    if (i == free_axis) continue;
    rows.hold_turn(kinds[i], frame.axes_a[i], free_axis < 3 ? dot(tilt, frame.axes_a[i]) : error[i]);
  }
}

template <class Real, int Dim>
void hold_point(JointRows<Real, Dim>& rows, const JointFrame<Real, Dim>& frame) {
  constexpr std::array<JointRow, 3> kinds{JointRow::hold_0, JointRow::hold_1, JointRow::hold_2};
  for (std::size_t i = 0; i < Dim; ++i) rows.hold(kinds[i], frame.axes_a[i], frame);
}
template <class Real, int Dim>
void hold_line(JointRows<Real, Dim>& rows, const JointFrame<Real, Dim>& frame) {
  constexpr std::array<JointRow, 3> kinds{JointRow::hold_0, JointRow::hold_1, JointRow::hold_2};
  for (std::size_t i = 1; i < Dim; ++i) rows.hold(kinds[i], frame.axes_a[i], frame);
}

/// The unit axis about which the coordinate of a hinge turns (axis 0), or of a wheel (axis 1).
template <class Real, int Dim>
[[nodiscard]] Spin<Real, Dim> turning_axis(const JointFrame<Real, Dim>& frame, std::size_t axis) {
  if constexpr (Dim == 2) {
    return {{Real(1)}};
  } else {
    return frame.axes_a[axis];
  }
}
template <class Real, int Dim>
[[nodiscard]] Real turning_angle(const Joint<Real, Dim>& joint, const JointFrame<Real, Dim>& frame,
                                 const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b, std::size_t axis) {
  if constexpr (Dim == 2) {
    return angle_between(joint, a.orientation, b.orientation);
  } else {
    return angle_about(frame, axis);
  }
}

/// A joint's axle is free to turn where the axle of b stays across both: only the rotation about it is free.
template <class Real, int Dim>
void add_wheel(JointRows<Real, Dim>& rows, const Joint<Real, Dim>& joint, const JointFrame<Real, Dim>& frame) {
  hold_line(rows, frame);
  const auto along = [&](JointRow kind) -> auto& { return rows.along(kind, frame.axes_a[0], frame); };
  const Real way = dot(frame.axes_a[0], frame.apart);
  if (joint.spring && joint.spring->hertz > Real(0))
    rows.pull(along(JointRow::spring), *joint.spring, way - joint.spring->rest);
  if (joint.limits) rows.limit(*joint.limits, way, along);
  if (joint.motor) rows.drive_motor(*joint.motor, rows.about(JointRow::motor, turning_axis(frame, 1)));
}

template <class Real, int Dim>
void add_distance(JointRows<Real, Dim>& rows, const Joint<Real, Dim>& joint, const JointFrame<Real, Dim>& frame) {
  const Real distance = length(frame.apart);
  const Vector<Real, Dim> direction = distance > Real(0) ? frame.apart * (1 / distance) : frame.axes_a[0];
  const auto along = [&](JointRow kind) -> auto& { return rows.along(kind, direction, frame); };
  if (!joint.limits && !joint.spring) return rows.correct(along(JointRow::hold_0), distance - joint.length);
  rows.drive(joint, distance, joint.length, along);
}

template <class Real, int Dim>
[[nodiscard]] JointSpring<Real> spring_of_pull(const Joint<Real, Dim>& joint) {
  return joint.spring.value_or(JointSpring<Real>{.hertz = Real(5), .damping = Real(0.7)});
}
/// Whether a pull is bounded.
template <class Real, int Dim>
[[nodiscard]] bool has_greatest_pull(const Joint<Real, Dim>& joint) {
  return joint.kind == JointKind::pull && joint.breaks_at < std::numeric_limits<Real>::infinity();
}
/// A pull has a row for each axis, and a greatest force, which bounds the length of all their impulses together.
template <class Real, int Dim>
void add_pull(JointRows<Real, Dim>& rows, const Joint<Real, Dim>& joint, const JointFrame<Real, Dim>& frame,
              const RigidBody<Real, Dim>& b, const Real& h) {
  constexpr std::array<JointRow, 3> kinds{JointRow::hold_0, JointRow::hold_1, JointRow::hold_2};
  const JointSpring<Real> spring = spring_of_pull(joint);
  const Vector<Real, Dim> error = b.x + frame.arm_b - joint.target;
  for (std::size_t i = 0; i < Dim; ++i) {
    Vector<Real, Dim> direction{};
    direction[i] = Real(1);
    auto& row = rows.along(kinds[i], direction, frame);
    row.lever_a = {};
    set_mass(row, RigidBody<Real, Dim>{}, b);
    rows.pull(row, spring, error[i]);
    if (!has_greatest_pull(joint)) continue;
    row.most = joint.breaks_at * h;
    row.least = -row.most;
  }
}

/// Gears with ratio r: the spin of b about its axle plus r times that of a about its axis is 0.
template <class Real, int Dim>
void add_gear(JointRows<Real, Dim>& rows, const Joint<Real, Dim>& joint, const JointFrame<Real, Dim>& frame,
              const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b) {
  Spin<Real, Dim> axis_a{}, axis_b{};
  Real error(0);
  if constexpr (Dim == 2) {
    axis_a = axis_b = {{Real(1)}};
    error = b.orientation[0] + joint.ratio * a.orientation[0] - joint.length;
  } else {
    axis_a = frame.axes_a[0], axis_b = frame.axes_b[1];
  }
  auto& row = rows.about(JointRow::hold_0, axis_b);
  row.lever_a = axis_a * -joint.ratio;
  set_mass(row, a, b);
  if (Dim == 2) rows.correct(row, error);
}

/// A force that pulls at an arm turns the arm into its direction, as a spring does. Where that is too fast for the
/// substep, it has to be implicit (M. Tournier, M. Nesme, B. Gilles, F. Faure, "Stable constrained dynamics", ACM
/// Trans. Graph. 34, 2015). Adds its stiffness, times the square of the substep: an inertia.
template <class Real>
void add_stiffening(const Vector<Real, 2>& arm, const Vector<Real, 2>& force, const Real& h2,
                    Matrix<Real, 1>& stiffening) {
  stiffening[0][0] += h2 * std::max(dot(arm, force), Real(0));
}
template <class Real>
void add_stiffening(const Vector<Real, 3>& arm, const Vector<Real, 3>& force, const Real& h2,
                    Matrix<Real, 3>& stiffening) {
  const Real pull = h2 * dot(arm, force), square = squared(arm);
  if (!(pull > Real(0))) return;
  stiffening += identity_matrix<Real, 3>() * pull + outer(arm, arm) * (-pull / square);
}

/// Adds the rows of a joint of bodies a and b in a block of their own.
template <class Real, int Dim>
void add_rows(const Joint<Real, Dim>& joint, const JointImpulses<Real>& impulses, std::uint32_t number_a,
              std::uint32_t number_b, const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b,
              const JointHardness<Real>& hardness, Constraints<Real, Dim>& all, std::vector<JointRow>& kinds) {
  RowBlock block{.a = number_a,
                 .b = number_b,
                 .first = static_cast<std::uint32_t>(all.rows.size()),
                 .is_bounded = has_greatest_pull(joint)};
  const JointFrame<Real, Dim> frame = frame_of(joint, a, b);
  JointRows<Real, Dim> rows(a, b, hardness, impulses, all, kinds);
  const auto about = [&](JointRow kind) -> auto& { return rows.about(kind, turning_axis(frame, 0)); };
  const auto along = [&](JointRow kind) -> auto& { return rows.along(kind, frame.axes_a[0], frame); };
  switch (joint.kind) {
    case JointKind::hinge:
      hold_point(rows, frame);
      if (Dim == 3) hold_turns(rows, joint, frame, a, b, 0);
      rows.drive(joint, turning_angle(joint, frame, a, b, 0), Real(0), about);
      break;
    case JointKind::ball:
      hold_point(rows, frame);
      break;
    case JointKind::slider:
      hold_line(rows, frame);
      hold_turns(rows, joint, frame, a, b, 3);
      rows.drive(joint, dot(frame.axes_a[0], frame.apart), Real(0), along);
      break;
    case JointKind::weld:
      hold_point(rows, frame);
      hold_turns(rows, joint, frame, a, b, 3);
      break;
    case JointKind::distance:
      add_distance(rows, joint, frame);
      break;
    case JointKind::wheel:
      add_wheel(rows, joint, frame);
      if (Dim == 3) hold_turns(rows, joint, frame, a, b, 1);
      break;
    case JointKind::universal:
      hold_point(rows, frame);
      if constexpr (Dim == 3) {
        // The axis of a and the axle of b stay perpendicular.
        rows.hold_turn(JointRow::turn_0, moment(frame.axes_b[1], frame.axes_a[0]),
                       dot(frame.axes_a[0], frame.axes_b[1]));
      }
      break;
    case JointKind::gear:
      add_gear(rows, joint, frame, a, b);
      break;
    case JointKind::pull:
      add_pull(rows, joint, frame, b, hardness.h);
      break;
  }
  block.rows = static_cast<std::uint16_t>(all.rows.size() - block.first);
  all.blocks.push_back(block);
}

}  // namespace continuo
