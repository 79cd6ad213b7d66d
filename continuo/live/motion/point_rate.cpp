// continuo/live/motion/point_rate.cpp
// The chain rule over the states, whose own rates are the right-hand sides.
#include <algorithm>

#include <continuo/live/motion/point_rate.hpp>
#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::live {

namespace {

/// What a state's derivative is. A body's position has its velocity, the state after it; its velocity has no equation.
std::optional<model::NodeId> rate_of_state(model::Model& model, std::size_t state, std::size_t mode) {
  const model::State& of = model.states[state];
  if (of.algebraic) return std::nullopt;
  if (!of.in_world) return model.modes[mode].derivatives[state];
  const auto next = std::ranges::find_if(model.states, [&](const model::State& other) {
    return other.in_world && other.base == of.base && other.primes == of.primes + 1;
  });
  if (next == model.states.end()) return std::nullopt;
  return model.graph.variable(next->variable);
}

}  // namespace

std::optional<model::NodeId> rate_along_motion(model::Model& model, model::NodeId node, std::size_t mode) {
  model::NodeId sum = model.graph.constant(0);
  for (const std::uint32_t variable : variables_of(model.graph, node)) {
    const bool input =
        std::ranges::any_of(model.inputs, [&](const model::Input& each) { return each.variable == variable; });
    if (input) return std::nullopt;
    const auto state = std::ranges::find(model.states, variable, &model::State::variable);
    if (state == model.states.end() && variable != model::Layout::time) continue;
    const model::NodeId slope = differentiate(model.graph, node, variable);
    if (variable == model::Layout::time) {
      sum = model.graph.add(sum, slope);
      continue;
    }
    const auto rate = rate_of_state(model, static_cast<std::size_t>(state - model.states.begin()), mode);
    if (!rate) return std::nullopt;
    sum = model.graph.add(sum, model.graph.multiply(slope, *rate));
  }
  return sum;
}

}  // namespace continuo::live
