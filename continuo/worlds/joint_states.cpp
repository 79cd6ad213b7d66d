// Reads joints from the poses of their bodies, and what they bore in the last step.
#include <algorithm>

#include <continuo/bodies/rigid_stepping/joint_rows.hpp>
#include <continuo/worlds/joint_states.hpp>

namespace continuo::worlds {

namespace {

/// Of a = {}, the world.
template <int Dim>
Pose<double, Dim> pose_of(const World<double, Dim>& world, BodyHandle body) {
  if (!world.contains(body)) return {};
  const std::size_t i = world.index(body);
  return {world.position[i], rotation(world.orientation[i])};
}

}  // namespace

template <int Dim>
double coordinate_of(const World<double, Dim>& world, const Joint<double, Dim>& joint) {
  const Pose<double, Dim> a = pose_of(world, joint.a), b = pose_of(world, joint.b);
  if (joint.kind == JointKind::hinge) {
    if constexpr (Dim == 2) {
      const Vector<double, 1> of_a =
          world.contains(joint.a) ? world.orientation[world.index(joint.a)] : Vector<double, 1>{};
      return angle_between(joint, of_a, world.orientation[world.index(joint.b)]);
    } else {
      JointFrame<double, 3> frame;
      frame.axes_a = a.axes * joint.axes_a, frame.axes_b = b.axes * joint.axes_b;
      return angle_about(frame, 0);
    }
  }
  const Vector<double, Dim> apart = b.place(joint.anchor_b) - a.place(joint.anchor_a);
  if (joint.kind == JointKind::distance) return length(apart);
  if (joint.kind == JointKind::slider || joint.kind == JointKind::wheel) return dot(a.axes * joint.axes_a[0], apart);
  return 0;
}

template <int Dim>
void write_joints(const World<double, Dim>& world, std::span<const JointHandle> joints,
                  const model::WorldDescription& text, std::span<double> state) {
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const model::JointDescription& of = text.joints[k];
    const Joint<double, Dim>* const joint = world.find(joints[k]);
    if (of.first_measure == model::no_body || !joint) continue;
    double* measure = state.data() + of.first_measure;
    const bool has_coordinate = joint->kind == JointKind::hinge || joint->kind == JointKind::slider ||
                                joint->kind == JointKind::distance || joint->kind == JointKind::wheel;
    if (of.is_named && has_coordinate) *measure++ = coordinate_of(world, *joint);
    for (const double component : joint->force.components) *measure++ = component;
    for (const double component : joint->torque.components) *measure++ = component;
    if (of.motor_speed.valid()) *measure = joint->motor_effort;
  }
}

JointDrives::JointDrives(const model::ModelProgram& program, std::span<const double> variables) {
  const model::Model& model = program.model;
  std::vector<model::NodeId> nodes;
  for (std::size_t k = 0; k < model.world->joints.size(); ++k) {
    const model::NodeId speed = model.world->joints[k].motor_speed;
    if (!speed.valid()) continue;
    const auto changes = [&](std::uint32_t variable) {
      return variable < model.layout.parameters || variable >= model.layout.inputs;
    };
    if (!std::ranges::any_of(variables_of(model.graph, speed), changes)) continue;
    motors_.push_back(k);
    nodes.push_back(speed);
  }
  for (std::size_t k = 0; k < model.world->joints.size(); ++k) {
    const model::JointDescription& joint = model.world->joints[k];
    if (joint.kind != "pull") continue;
    pulls_.push_back(k);
    nodes.insert(nodes.end(), joint.target.begin(), joint.target.begin() + model.world->dimension);
  }
  if (!nodes.empty()) evaluation_ = model::Evaluation(program.tape_of(nodes), variables);
  values_.resize(nodes.size());
}

template double coordinate_of(const World<double, 2>&, const Joint<double, 2>&);
template double coordinate_of(const World<double, 3>&, const Joint<double, 3>&);
template void write_joints(const World<double, 2>&, std::span<const JointHandle>, const model::WorldDescription&,
                           std::span<double>);
template void write_joints(const World<double, 3>&, std::span<const JointHandle>, const model::WorldDescription&,
                           std::span<double>);

}  // namespace continuo::worlds
