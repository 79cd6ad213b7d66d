// continuo/language/world_methods.cpp
// Compares a world with what the exact motion of shapes and joints knows.
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include <continuo/language/world_methods.hpp>

namespace continuo::model {

namespace {

/// Whether a force reads how a body stands or spins: behind its places and velocities.
bool reads_turns(const WorldDescription& world, const Model& model, const ForceDescription& force) {
  const auto axes = static_cast<std::size_t>(world.dimension);
  const std::vector<NodeId> nodes(force.components.begin(),
                                  force.components.begin() + static_cast<std::ptrdiff_t>(axes));
  return std::ranges::any_of(variables_of(model.graph, nodes), [&](std::uint32_t variable) {
    if (variable < model.layout.states) return false;
    const std::size_t state = variable - model.layout.states;
    return state < world.body_states() && state % WorldDescription::states_of_body(world.dimension) >= 2 * axes;
  });
}

}  // namespace

bool changes(const Model& model, NodeId node) {
  return std::ranges::any_of(variables_of(model.graph, std::vector{node}), [&](std::uint32_t variable) {
    return variable < model.layout.parameters || variable >= model.layout.inputs;
  });
}
bool reads_states(const Model& model, NodeId node) {
  return std::ranges::any_of(variables_of(model.graph, std::vector{node}), [&](std::uint32_t variable) {
    return variable != Layout::time && variable < model.layout.parameters;
  });
}

std::vector<std::string> world_integrators() {
  return {"semi_implicit_euler", "symplectic_euler_position_first", "implicit_euler", "central_difference",
          "explicit_euler"};
}

std::vector<std::string> world_methods() {
  std::vector<std::string> names{"exact", "dop853", "rk4", "fast"};
  for (const std::string& integrator : world_integrators()) names.push_back(integrator);
  return names;
}

std::vector<std::string> world_methods(const WorldDescription& world, const Model& model) {
  if (!world.is_rigid()) return world_methods();
  if (!exact_refusals(world, model).empty()) return {"fast", "semi_implicit_euler"};
  return {"exact", "dop853", "fast", "semi_implicit_euler"};
}

std::vector<ExactRefusal> exact_refusals(const WorldDescription& world, const Model& model) {
  std::vector<ExactRefusal> refusals;
  if (!world.is_rigid()) return refusals;
  const auto refuse = [&](std::string_view what, Span span) {
    refusals.push_back({"the exact motion knows no " + std::string(what), span});
  };
  const auto rolls = [&](const MaterialDescription& material) {
    return model.graph.value(material.rolling).value_or(0) > 0;
  };
  for (const BodyDescription& body : world.bodies) {
    if (body.character) refuse("characters", body.span);
    if (body.character) continue;
    if (body.traits.sensor) refuse("sensors", body.span);
    if (rolls(body.material))
      refusals.push_back({"rolling resistance exists only in worlds of balls without joints", body.span});
  }
  for (const MeshDescription& mesh : world.meshes) refuse("meshes and no chains", mesh.span);
  for (const JointDescription& joint : world.joints) {
    if (joint.motor_speed.valid() && reads_states(model, joint.motor_speed))
      refuse("motors whose speed depends on states", joint.span);
    if (joint.kind == "pull" &&
        std::ranges::any_of(joint.target, [&](NodeId node) { return node.valid() && changes(model, node); }))
      refuse("pulls whose target changes", joint.span);
  }
  for (const ForceDescription& force : world.forces)
    if (reads_turns(world, model, force)) refuse("forces that depend on how bodies stand or spin", force.span);
  for (const State& state : model.states)
    if (!state.in_world) {
      refusals.push_back({"the exact motion integrates equations beside balls without joints only", state.span});
      break;
    }
  return refusals;
}

}  // namespace continuo::model
