// continuo/language/check/equations/reduction.cpp
// From solved equations to the system of first order: h' = h', (h')' = ..., and the pairs of position and velocity.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/names/checker.hpp>
#include <continuo/language/check/names/equations_at_work.hpp>

namespace continuo::model::detail {

std::size_t Checker::base_of_state(std::size_t state) const {
  const auto after = std::ranges::upper_bound(bases_, state, {}, &Base::first);
  return static_cast<std::size_t>(after - bases_.begin()) - 1;
}

/// The derivative of x is x' in the units of x, of x' it is x'', and so on up to what the equations say.
void Checker::store_derivatives(const ModeAtWork& work) {
  std::vector<NodeId>& derivatives = model_.modes[work.mode].derivatives;
  for (std::size_t b = 0; b < bases_.size(); ++b) {
    const Base& base = bases_[b];
    for (int k = 0; k + 1 < base.order; ++k) {
      const std::size_t state = base.first + static_cast<std::size_t>(k);
      const Measured rate = per_time(measures_[state]);
      const auto factor = factor_between(measures_[state + 1], rate);  // they fit: hold_to_chain
      const NodeId next = model_.graph.variable(model_.states[state + 1].variable);
      derivatives.push_back(model_.graph.multiply(next, model_.graph.constant(factor.value_or(1))));
    }
    derivatives.push_back(work.solved[b]);
  }
  if (model_.modes.size() == 1) solved_ = work.solved;
}

/// x and v are a pair where x' is v in every mode, written as x'' = ... or as x' = v.
void Checker::pair_up() {
  const std::size_t count = model_.states.size();
  std::vector<bool> taken(count, false);
  const auto velocity_of = [&](std::size_t state) -> std::size_t {
    const Node& node = model_.graph[model_.modes[0].derivatives[state]];
    if (node.op != Op::variable || node.number < model_.layout.states) return npos;
    const std::size_t velocity = node.number - model_.layout.states;
    const bool everywhere = std::ranges::all_of(
        model_.modes, [&](const Mode& mode) { return mode.derivatives[state] == model_.modes[0].derivatives[state]; });
    return velocity < count && velocity != state && everywhere ? velocity : npos;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t velocity = taken[i] ? npos : velocity_of(i);
    if (velocity == npos || taken[velocity]) continue;
    taken[i] = taken[velocity] = true;
    model_.pairs.push_back({i, velocity});
  }
  model_.all_paired = 2 * model_.pairs.size() == count;
  std::vector<NodeId> accelerations;
  for (const Mode& mode : model_.modes) {
    for (const PositionVelocity& pair : model_.pairs) accelerations.push_back(mode.derivatives[pair.velocity]);
  }
  const auto used = variables_of(model_.graph, accelerations);
  model_.accelerations_depend_on_velocities = std::ranges::any_of(model_.pairs, [&](const PositionVelocity& pair) {
    return std::ranges::binary_search(used, model_.states[pair.velocity].variable);
  });
}

}  // namespace continuo::model::detail
