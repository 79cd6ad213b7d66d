// Joints between two bodies, or between a body and the world: what they leave free, limits, springs and motors.
//
//   world.add_joint(JointDefinition<double, 2>{.kind = JointKind::hinge, .b = door, .anchor = {{0, 1}}});  // to the
//   world
#pragma once
#include <cstdint>
#include <limits>
#include <optional>

#include <continuo/bodies/body.hpp>
#include <continuo/shapes/matrix.hpp>

namespace continuo {

/// What a joint leaves free, of the motion of b against a. Its coordinate, which limits, springs and motors act on, is
/// an angle in radians or a length.
enum class JointKind : std::uint8_t {
  hinge,      // a rotation about the axis, in the plane about the anchor: the angle
  ball,       // all rotations about the anchor; no coordinate
  slider,     // a translation along the axis: how far b's anchor is from a's
  weld,       // nothing; no coordinate
  distance,   // all but the distance of the two anchors: their distance, which is kept unless limits or a spring say
              // else
  wheel,      // b slides along the axis (a spring with its limits) and turns about the axle (the motor)
  universal,  // in space: rotations about the axis, which is fixed to a, and the axle, which is fixed to b; no
              // coordinate
  gear,       // all but the sum of the angle of b about the axle and ratio times that of a about the axis
  pull        // all; b's anchor is drawn to the target by a spring, with no more than the greatest force
};

/// The range of a joint's coordinate.
template <class Real>
struct JointLimits {
  Real lower = -std::numeric_limits<Real>::infinity();  // the least
  Real upper = std::numeric_limits<Real>::infinity();   // the greatest, not below
};
/// A spring towards a value of the coordinate.
template <class Real>
struct JointSpring {
  Real hertz = Real(0);    // undamped frequency, with the masses that the joint connects; greater is stiffer
  Real damping = Real(1);  // ratio: 1 is critical
  Real rest = Real(0);     // the value of the coordinate; of distances and wheels, beyond that of the beginning
};
/// A motor that drives the coordinate at a speed; a speed of 0 is a brake.
template <class Real>
struct JointMotor {
  Real speed = Real(0);  // of the coordinate, in radians or length per time
  Real most = Real(0);   // the greatest force or torque, 0 or more
};

/// A joint to be added to a world. Places and axes are those of the world at that time.
template <class Real, int Dim>
struct JointDefinition {
  JointKind kind = JointKind::hinge;            // what is free
  BodyHandle a{};                               // one body; {} is the world
  BodyHandle b{};                               // the other body
  Vector<Real, Dim> anchor{};                   // where they are joined; the end at a, where they differ
  std::optional<Vector<Real, Dim>> anchor_b{};  // the end at b; default: the same
  Vector<Real, Dim> axis = [] {
    Vector<Real, Dim> up;
    up[static_cast<std::size_t>(Dim - 1)] = Real(1);
    return up;
  }();  // of hinges in space, sliders, wheels: of any length but 0
  Vector<Real, Dim> axle{};                                // of wheels and universal joints in space, across the axis
  std::optional<JointLimits<Real>> limits{};               // of the coordinate
  std::optional<JointSpring<Real>> spring{};               // of the coordinate
  std::optional<JointMotor<Real>> motor{};                 // of the coordinate; of a wheel, about the axle
  Real ratio = Real(1);                                    // of gears
  Real breaks_at = std::numeric_limits<Real>::infinity();  // force; beyond it the joint is broken
  Real breaks_at_torque = std::numeric_limits<Real>::infinity();  // likewise
  bool collide = false;                                           // whether the two bodies collide with each other
};

/// Identifies a joint until it is removed.
struct JointHandle {
  std::uint32_t slot = 0;        // a place, used again after its joint is removed
  std::uint32_t generation = 0;  // counts the joints that were there, from 1
  /// Whether both are the same.
  friend bool operator==(const JointHandle&, const JointHandle&) = default;
};

/// A joint of a world. What may be changed at any time: limits, spring, motor, target, breaks_at.
template <class Real, int Dim>
struct Joint {
  JointKind kind = JointKind::hinge;                        // what is free
  BodyHandle a{}, b{};                                      // a = {} is the world
  Vector<Real, Dim> anchor_a{}, anchor_b{};                 // from the centres, in the frames of the bodies
  Matrix<Real, Dim> axes_a = identity_matrix<Real, Dim>();  // in the frame of a: the axis, the axle, what is across
  Matrix<Real, Dim> axes_b = identity_matrix<Real, Dim>();  // in the frame of b: the same at the beginning
  Spin<Real, Dim> start{};                                  // in the plane, the angle of b against a at the beginning
  Real length{};  // of distances: at the beginning; of gears in the plane, the sum of angles then
  std::optional<JointLimits<Real>> limits{};                      // of the coordinate
  std::optional<JointSpring<Real>> spring{};                      // of the coordinate
  std::optional<JointMotor<Real>> motor{};                        // of the coordinate
  Vector<Real, Dim> target{};                                     // of pulls: where b's anchor is drawn to
  Real ratio = Real(1);                                           // of gears
  Real breaks_at = std::numeric_limits<Real>::infinity();         // force
  Real breaks_at_torque = std::numeric_limits<Real>::infinity();  // torque
  bool collide = false;                                           // whether the two bodies collide
  bool is_broken = false;                                         // then it acts no more
  Vector<Real, Dim> force{};                                      // on b, in the last step
  Spin<Real, Dim> torque{};                                       // on b, about its anchor, in the last step
  Real motor_effort{};                                            // force or torque of the motor in the last step
};

}  // namespace continuo
