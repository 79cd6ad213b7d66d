// Adds, checks and removes the joints of a world.
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <continuo/bodies/world.hpp>
#include <continuo/shapes/direction_of.hpp>

namespace continuo {
namespace {

template <class Real>
bool is_number(const Real& value) {
  return std::isfinite(value);
}

template <class Real, int Dim>
Status check_joint(const JointDefinition<Real, Dim>& of) {
  if (!is_finite(of.anchor) || (of.anchor_b && !is_finite(*of.anchor_b)))
    return invalid_input("the anchors of a joint must be finite");
  if (!is_finite(of.axis) || of.axis == Vector<Real, Dim>{})
    return invalid_input("the axis of a joint must be finite, and not 0");
  if (!is_finite(of.axle)) return invalid_input("the axle of a joint must be finite");
  if (of.limits && !(of.limits->lower <= of.limits->upper))
    return invalid_input("the lower limit of a joint must not be above the upper one");
  if (of.spring && (!(of.spring->hertz >= Real(0)) || !is_number(of.spring->hertz) ||
                    !(of.spring->damping >= Real(0)) || !is_number(of.spring->damping) || !is_number(of.spring->rest)))
    return invalid_input("hertz and damping of the spring of a joint must be 0 or more, and finite, as must its rest");
  if (of.motor && (!is_number(of.motor->speed) || !(of.motor->most >= Real(0))))
    return invalid_input("the speed of a motor must be finite, and its greatest force or torque 0 or more");
  if (!is_number(of.ratio)) return invalid_input("the ratio of gears must be finite");
  if (!(of.breaks_at >= Real(0)) || !(of.breaks_at_torque >= Real(0)))
    return invalid_input("the strength of a joint must be 0 or more");
  const bool has_coordinate = of.kind == JointKind::hinge || of.kind == JointKind::slider ||
                              of.kind == JointKind::distance || of.kind == JointKind::wheel;
  if (!has_coordinate && (of.limits || of.motor || (of.spring && of.kind != JointKind::pull)))
    return invalid_input(
        "limits, springs and motors need a joint with a coordinate: a hinge, slider, distance or wheel");
  if (of.kind == JointKind::distance && of.motor) return invalid_input("a distance has no motor; a slider has");
  if (of.kind == JointKind::pull && of.a != BodyHandle{})
    return invalid_input("a pull draws b to a place, and has no a: a spring of the world pulls two bodies together");
  if (of.kind == JointKind::universal && Dim == 2) return invalid_input("universal joints exist in space only");
  return {};
}

/// The axis, the axle made perpendicular to it, and what is across both.
template <class Real>
Matrix<Real, 2> axes_of(const JointDefinition<Real, 2>& of) {
  const Vector<Real, 2> axis = direction_of(of.axis);
  return {{{axis, {{-axis[1], axis[0]}}}}};
}
template <class Real>
Matrix<Real, 3> axes_of(const JointDefinition<Real, 3>& of) {
  const Vector<Real, 3> axis = direction_of(of.axis), wished = direction_of(of.axle);
  Vector<Real, 3> axle = wished - axis * dot(wished, axis);
  if (!(length(axle) > Real(1e-3))) {
    std::size_t least = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (std::abs(axis[i]) < std::abs(axis[least])) least = i;
    axle = {};
    axle[least] = Real(1);
    axle -= axis * dot(axle, axis);
  }
  axle *= 1 / length(axle);
  return {{{axis, axle, moment(axis, axle)}}};
}

}  // namespace

template <class Real, int Dim>
Result<JointHandle> World<Real, Dim>::add_joint(const JointDefinition<Real, Dim>& of) {
  if (Status fault = check_joint(of); !fault) return fault;
  const bool is_to_world = of.a == BodyHandle{};
  if (!contains(of.b) || (!is_to_world && !contains(of.a)))
    return invalid_input("a joint needs bodies that exist: b, and a unless it is the world");
  if (of.a == of.b) return invalid_input("a joint cannot connect a body with itself");
  if (is_fixed(index(of.b)) && (is_to_world || is_fixed(index(of.a))))
    return invalid_input("a joint needs at least one body that can move");
  if (Dim == 3 && (of.kind == JointKind::universal || of.kind == JointKind::wheel) && of.axle == V{})
    return invalid_input("this joint needs an axle, across the axis");
  const auto pose = [&](BodyHandle handle) {
    Pose<Real, Dim> at;
    if (contains(handle)) at = {position[index(handle)], rotation(orientation[index(handle)])};
    return at;
  };
  const Pose<Real, Dim> a = pose(of.a), b = pose(of.b);
  const V end_b = of.anchor_b.value_or(of.anchor);
  Joint<Real, Dim> joint{.kind = of.kind, .a = of.a, .b = of.b};
  joint.anchor_a = a.local(of.anchor), joint.anchor_b = b.local(end_b);
  const Matrix<Real, Dim> axes = axes_of(of);
  joint.axes_a = transposed(a.axes) * axes, joint.axes_b = transposed(b.axes) * axes;
  if constexpr (Dim == 2) joint.start = orientation[index(of.b)] - (is_to_world ? O{} : orientation[index(of.a)]);
  joint.length = continuo::length(V(end_b - of.anchor));
  if (Dim == 2 && of.kind == JointKind::gear)
    joint.length = orientation[index(of.b)][0] + (is_to_world ? Real(0) : of.ratio * orientation[index(of.a)][0]);
  if (!is_finite(joint.anchor_a) || !is_finite(joint.anchor_b) || !is_finite(joint.start) || !is_number(joint.length))
    return invalid_input("the anchors of a joint are too far from its bodies for the numbers");
  if (of.kind == JointKind::distance && !(joint.length > Real(0)))
    return invalid_input("a distance needs two different ends: give anchor_b");
  joint.limits = of.limits, joint.spring = of.spring, joint.motor = of.motor;
  joint.target = of.anchor;
  if (of.kind == JointKind::pull) joint.anchor_b = b.local(of.anchor);
  joint.ratio = of.ratio, joint.breaks_at = of.breaks_at, joint.breaks_at_torque = of.breaks_at_torque;
  joint.collide = of.collide;

  std::uint32_t slot = joint_count_ < joints_.size() ? 0 : static_cast<std::uint32_t>(joints_.size());
  while (slot < joints_.size() && joints_[slot].is_used) ++slot;
  if (slot == joints_.size()) joints_.emplace_back();
  joints_[slot].joint = joint;
  joints_[slot].is_used = true;
  ++joint_count_;
  return JointHandle{slot, joints_[slot].generation};
}

template <class Real, int Dim>
bool World<Real, Dim>::remove_joint(JointHandle handle) {
  if (!has_joint(handle)) return false;
  joints_[handle.slot].is_used = false;
  ++joints_[handle.slot].generation;
  --joint_count_;
  return true;
}

template <class Real, int Dim>
std::vector<JointHandle> World<Real, Dim>::joints() const {
  std::vector<JointHandle> all;
  all.reserve(joint_count_);
  for (std::uint32_t slot = 0; slot < joints_.size(); ++slot)
    if (joints_[slot].is_used) all.push_back({slot, joints_[slot].generation});
  return all;
}

template Result<JointHandle> World<float, 2>::add_joint(const JointDefinition<float, 2>&);
template Result<JointHandle> World<float, 3>::add_joint(const JointDefinition<float, 3>&);
template Result<JointHandle> World<double, 2>::add_joint(const JointDefinition<double, 2>&);
template Result<JointHandle> World<double, 3>::add_joint(const JointDefinition<double, 3>&);
template bool World<float, 2>::remove_joint(JointHandle);
template bool World<float, 3>::remove_joint(JointHandle);
template bool World<double, 2>::remove_joint(JointHandle);
template bool World<double, 3>::remove_joint(JointHandle);
template std::vector<JointHandle> World<float, 2>::joints() const;
template std::vector<JointHandle> World<float, 3>::joints() const;
template std::vector<JointHandle> World<double, 2>::joints() const;
template std::vector<JointHandle> World<double, 3>::joints() const;

}  // namespace continuo
