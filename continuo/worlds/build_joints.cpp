// Evaluates the numbers of all joints together, and makes the definition of each.
#include <array>
#include <cstddef>
#include <string_view>

#include <continuo/worlds/build_joints.hpp>

namespace continuo::worlds {

namespace {

using model::JointDescription;
using model::NodeId;

JointKind kind_of(std::string_view word) {
  if (word == "ball") return JointKind::ball;
  if (word == "slider") return JointKind::slider;
  if (word == "weld") return JointKind::weld;
  if (word == "distance" || word == "rope") return JointKind::distance;
  if (word == "wheel") return JointKind::wheel;
  if (word == "universal") return JointKind::universal;
  if (word == "gear") return JointKind::gear;
  if (word == "pull") return JointKind::pull;
  return JointKind::hinge;
}

/// In the order in which `definition_of` reads their values.
template <int Dim>
void append_nodes(const JointDescription& joint, std::vector<NodeId>& nodes) {
  const auto want = [&](NodeId node) { nodes.push_back(node.valid() ? node : NodeId{0}); };
  for (const model::NodePoint& point : {joint.anchor_first, joint.anchor_second, joint.axis, joint.axle})
    for (std::size_t k = 0; k < Dim; ++k) want(point[k]);
  for (const NodeId node : {joint.lower, joint.upper, joint.hertz, joint.damping, joint.rest, joint.motor_speed,
                            joint.motor_most, joint.ratio, joint.breaks_at, joint.breaks_at_torque})
    want(node);
}

/// The numbers of one joint after the other; those of its description that are not valid mean nothing.
class Numbers {
 public:
  explicit Numbers(std::span<const double> values) : values_(values) {}
  double next() {
    const double value = values_.front();
    values_ = values_.subspan(1);
    return value;
  }
  template <int Dim>
  Vector<double, Dim> next_point() {
    Vector<double, Dim> point;
    for (std::size_t k = 0; k < point.size(); ++k) point[k] = next();
    return point;
  }

 private:
  std::span<const double> values_;
};

/// The first body is b, whose coordinate it is, the second one a.
template <int Dim>
JointDefinition<double, Dim> definition_of(const JointDescription& joint, const World<double, Dim>& world,
                                           Numbers& numbers) {
  JointDefinition<double, Dim> made{.kind = kind_of(joint.kind)};
  made.b = world.handle(joint.first);
  if (joint.second != model::no_body) made.a = world.handle(joint.second);
  made.anchor_b = numbers.next_point<Dim>();
  made.anchor = numbers.next_point<Dim>();
  const Vector<double, Dim> axis = numbers.next_point<Dim>(), axle = numbers.next_point<Dim>();
  if (joint.axis[0].valid()) made.axis = axis;
  if (joint.axle[0].valid()) made.axle = axle;
  const double lower = numbers.next(), upper = numbers.next();
  if (joint.lower.valid()) made.limits = JointLimits<double>{.lower = lower, .upper = upper};
  const double hertz = numbers.next(), damping = numbers.next(), rest = numbers.next();
  if (joint.hertz.valid()) made.spring = JointSpring<double>{.hertz = hertz, .damping = damping, .rest = rest};
  const double speed = numbers.next(), most = numbers.next();
  if (joint.motor_speed.valid()) made.motor = JointMotor<double>{.speed = speed, .most = most};
  const double ratio = numbers.next(), force = numbers.next(), torque = numbers.next();
  if (joint.ratio.valid()) made.ratio = ratio;
  if (joint.breaks_at.valid()) made.breaks_at = force;
  if (joint.breaks_at_torque.valid()) made.breaks_at_torque = torque;
  made.collide = joint.collide;
  return made;
}

}  // namespace

template <int Dim>
Result<std::vector<JointHandle>> add_joints(const model::Model& model, std::span<const double> variables,
                                            World<double, Dim>& world) {
  std::vector<NodeId> nodes;
  for (const JointDescription& joint : model.world->joints) append_nodes<Dim>(joint, nodes);
  const std::vector<double> values = evaluate(model, nodes, variables);
  Numbers numbers(values);
  std::vector<JointHandle> handles;
  for (const JointDescription& joint : model.world->joints) {
    const auto added = world.add_joint(definition_of<Dim>(joint, world, numbers));
    if (!added) return invalid_input("the " + joint.kind + " `" + joint.name + "`: " + added.status().message);
    handles.push_back(*added);
  }
  return handles;
}

template Result<std::vector<JointHandle>> add_joints(const model::Model&, std::span<const double>, World<double, 2>&);
template Result<std::vector<JointHandle>> add_joints(const model::Model&, std::span<const double>, World<double, 3>&);

}  // namespace continuo::worlds
