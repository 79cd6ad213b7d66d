// Joints: added by the numbers of continuo/joints.py, read and changed one by one.
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include "bound_world.hpp"
#include <continuo/worlds/joint_states.hpp>

namespace py = pybind11;

namespace continuo::python {

namespace {

constexpr std::array<const char*, 9> kinds = {"hinge", "ball",      "slider", "weld", "distance",
                                              "wheel", "universal", "gear",   "pull"};

JointKind kind_named(const std::string& name) {
  for (std::size_t k = 0; k < kinds.size(); ++k)
    if (name == kinds[k]) return static_cast<JointKind>(k);
  throw py::value_error(fmt::format("kind is '{}'; it can be {}", name, fmt::join(kinds, ", ")));
}

using Pair = std::pair<double, double>;
using Triple = std::array<double, 3>;

std::optional<JointLimits<double>> limits_from(const std::optional<Pair>& limits) {
  if (!limits) return std::nullopt;
  if (!(limits->first <= limits->second)) throw py::value_error("limits are a lower one and an upper one");
  return JointLimits<double>{.lower = limits->first, .upper = limits->second};
}
std::optional<JointSpring<double>> spring_from(const std::optional<Triple>& spring) {
  if (!spring) return std::nullopt;
  const auto [hertz, damping, rest] = *spring;
  if (!(hertz >= 0) || !(damping >= 0) || !std::isfinite(hertz + damping + rest))
    throw py::value_error("the hertz and the damping of a spring are 0 or more, and finite");
  return JointSpring<double>{.hertz = hertz, .damping = damping, .rest = rest};
}
std::optional<JointMotor<double>> motor_from(const std::optional<Pair>& motor) {
  if (!motor) return std::nullopt;
  if (!std::isfinite(motor->first) || !(motor->second >= 0))
    throw py::value_error("a motor has a finite speed and a greatest force or torque of 0 or more");
  return JointMotor<double>{.speed = motor->first, .most = motor->second};
}

template <int Dim>
Joint<double, Dim>& known_joint(MovingWorld<Dim>& m, std::uint64_t number) {
  Joint<double, Dim>* const joint = m.joint(handle_of<JointHandle>(number));
  if (joint == nullptr) throw py::key_error("there is no such joint: it was removed, or is of another world");
  return *joint;
}
template <int Dim>
const Joint<double, Dim>& seen_joint(const MovingWorld<Dim>& m, std::uint64_t number) {
  const Joint<double, Dim>* const joint = m.world().find(handle_of<JointHandle>(number));
  if (joint == nullptr) throw py::key_error("there is no such joint: it was removed, or is of another world");
  return *joint;
}

/// The keywords of World.add_joint.
template <int Dim>
JointDefinition<double, Dim> definition_from(const MovingWorld<Dim>& m, const std::string& kind, std::uint64_t body,
                                             const py::dict& more) {
  using B = BoundWorld<Dim>;
  JointDefinition<double, Dim> made{.kind = kind_named(kind), .b = B::known(m, body)};
  const auto point = [&](const char* name, auto&& into) {
    if (more.contains(name)) into = B::vector(more[name].cast<Array>(), name);
  };
  if (more.contains("a")) made.a = B::known(m, more["a"].cast<std::uint64_t>());
  point("anchor", made.anchor), point("anchor_b", made.anchor_b);
  point("axis", made.axis), point("axle", made.axle);
  if (more.contains("limits")) made.limits = limits_from(more["limits"].cast<Pair>());
  if (more.contains("spring")) made.spring = spring_from(more["spring"].cast<Triple>());
  if (more.contains("motor")) made.motor = motor_from(more["motor"].cast<Pair>());
  made.ratio = more["ratio"].cast<double>();
  made.breaks_at = more["breaks_at"].cast<double>();
  made.breaks_at_torque = more["breaks_at_torque"].cast<double>();
  made.collide = more["collide"].cast<bool>();
  return made;
}

/// What can be read of a joint, by name.
template <int Dim>
py::dict joint_facts(const World<double, Dim>& world, const Joint<double, Dim>& joint) {
  py::dict facts;
  facts["kind"] = kinds[static_cast<std::size_t>(joint.kind)];
  facts["a"] = joint.a == BodyHandle{} ? py::object(py::none()) : py::object(py::int_(number_of(joint.a)));
  facts["b"] = number_of(joint.b);
  facts["coordinate"] = worlds::coordinate_of<Dim>(world, joint);
  facts["force"] = BoundWorld<Dim>::array(joint.force);
  facts["torque"] = BoundWorld<Dim>::array(joint.torque);
  facts["motor_effort"] = joint.motor_effort;
  facts["broken"] = joint.is_broken;
  const auto none = py::object(py::none());
  facts["limits"] = joint.limits ? py::object(py::make_tuple(joint.limits->lower, joint.limits->upper)) : none;
  facts["spring"] =
      joint.spring ? py::object(py::make_tuple(joint.spring->hertz, joint.spring->damping, joint.spring->rest)) : none;
  facts["motor"] = joint.motor ? py::object(py::make_tuple(joint.motor->speed, joint.motor->most)) : none;
  facts["breaks_at"] = joint.breaks_at;
  facts["target"] = BoundWorld<Dim>::array(joint.target);
  return facts;
}

}  // namespace

template <int Dim>
void bind_joints(WorldClass<Dim>& world) {
  using B = BoundWorld<Dim>;
  using P = typename B::Pointer;
  world
      .def("add_joint",
           [](const P& m, const std::string& kind, std::uint64_t body, const py::dict& more) {
             const auto definition = definition_from<Dim>(B::idle(m), kind, body, more);
             return number_of(answer(m->forces().add_joint(definition)));
           })
      .def("remove_joint",
           [](const P& m, std::uint64_t joint) {
             seen_joint<Dim>(B::idle(m), joint);
             m->forces().remove_joint(handle_of<JointHandle>(joint));
           })
      .def("joints",
           [](const P& m) {
             std::vector<std::uint64_t> joints;
             for (const JointHandle handle : B::idle(m).world().joints()) joints.push_back(number_of(handle));
             return joints;
           })
      .def("joint",
           [](const P& m, std::uint64_t joint) {
             return joint_facts<Dim>(B::idle(m).world(), seen_joint<Dim>(B::idle(m), joint));
           })
      .def("set_limits",
           [](const P& m, std::uint64_t joint, const std::optional<Pair>& limits) {
             known_joint(B::idle(m), joint).limits = limits_from(limits);
           })
      .def("set_spring",
           [](const P& m, std::uint64_t joint, const std::optional<Triple>& spring) {
             known_joint(B::idle(m), joint).spring = spring_from(spring);
           })
      .def("set_motor",
           [](const P& m, std::uint64_t joint, const std::optional<Pair>& motor) {
             known_joint(B::idle(m), joint).motor = motor_from(motor);
           })
      .def("set_breaks_at",
           [](const P& m, std::uint64_t joint, double force) {
             if (!(force >= 0)) throw py::value_error("breaks_at is 0 or more");
             known_joint(B::idle(m), joint).breaks_at = force;
           })
      .def("set_target", [](const P& m, std::uint64_t joint, const Array& target) {
        const auto place = B::vector(target, "target");
        if (!is_finite(place)) throw py::value_error("the target is not finite");
        known_joint(B::idle(m), joint).target = place;
      });
}

template void bind_joints(WorldClass<2>&);
template void bind_joints(WorldClass<3>&);

}  // namespace continuo::python
