// continuo/language/check/equations/reduction.cpp
// Derivatives of states from highest derivatives; which states are pairs.
#include <algorithm>

#include <continuo/language/check/equations/reduction.hpp>

namespace continuo::model::detail {

/// The derivative of x is x' in the units of x, of x' it is x'', and so on up to what the equations say.
std::vector<NodeId> reduce(const std::vector<NodeId>& highest, Workspace& workspace) {
  std::vector<NodeId> derivatives;
  derivatives.reserve(workspace.layout.unknowns - workspace.layout.states);
  for (std::size_t b = 0; b < workspace.declared.bases.size(); ++b) {
    const Base& base = workspace.declared.bases[b];
    for (int k = 0; k + 1 < base.order; ++k) {
      const std::size_t state = base.first + static_cast<std::size_t>(k);
      const Measured rate = workspace.time.per_time(workspace.units.of_state(state));
      const auto factor = factor_between(workspace.units.of_state(state + 1), rate);  // they fit: name_states
      const NodeId next = workspace.graph.variable(workspace.layout.states + static_cast<std::uint32_t>(state + 1));
      derivatives.push_back(workspace.graph.multiply(next, workspace.graph.constant(factor.value_or(1))));
    }
    derivatives.push_back(highest[b]);
  }
  return derivatives;
}

PairedStates pair_up(const Model& model) {
  PairedStates made;
  const std::size_t count = model.states.size();
  std::vector<bool> taken(count, false);
  const auto velocity_of = [&](std::size_t state) -> std::size_t {
    const Node& node = model.graph[model.modes[0].derivatives[state]];
    if (node.op != Op::variable || node.number < model.layout.states) return npos;
    const std::size_t velocity = node.number - model.layout.states;
    const bool everywhere = std::ranges::all_of(
        model.modes, [&](const Mode& mode) { return mode.derivatives[state] == model.modes[0].derivatives[state]; });
    return velocity < count && velocity != state && everywhere ? velocity : npos;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t velocity = taken[i] ? npos : velocity_of(i);
    if (velocity == npos || taken[velocity]) continue;
    taken[i] = taken[velocity] = true;
    made.all.push_back({i, velocity});
  }
  made.is_everything = 2 * made.all.size() == count;
  std::vector<NodeId> accelerations;
  for (const Mode& mode : model.modes) {
    for (const PositionVelocity& pair : made.all) accelerations.push_back(mode.derivatives[pair.velocity]);
  }
  const auto used = variables_of(model.graph, accelerations);
  made.accelerations_depend_on_velocities = std::ranges::any_of(made.all, [&](const PositionVelocity& pair) {
    return std::ranges::binary_search(used, model.states[pair.velocity].variable);
  });
  return made;
}

}  // namespace continuo::model::detail
