// Classifies the states of a model as directions, counters or unread sums, from its text.
#include <algorithm>
#include <variant>

#include <continuo/studies/support/state_roles.hpp>

namespace continuo::studies {

namespace {

bool decides(const model::Model& model, const model::Block& block, std::uint32_t variable) {
  return std::ranges::any_of(block, [&](const model::Action& action) {
    const auto* branch = std::get_if<model::If>(&action.what);
    return branch && (model::depends_on(model.graph, branch->condition, variable) ||
                      decides(model, branch->then, variable) || decides(model, branch->otherwise, variable));
  });
}

/// x + something that does not contain x.
bool is_increment_of(const model::Model& model, model::NodeId value, std::uint32_t variable) {
  const model::Node& node = model.graph[value];
  const auto is_x = [&](model::NodeId id) {
    return model.graph[id].op == model::Op::variable && model.graph[id].number == variable;
  };
  if (is_x(value)) return true;
  if (node.op == model::Op::add)
    return (is_x(node.a) && !model::depends_on(model.graph, node.b, variable)) ||
           (is_x(node.b) && !model::depends_on(model.graph, node.a, variable));
  return node.op == model::Op::subtract && is_x(node.a) && !model::depends_on(model.graph, node.b, variable);
}

/// Whether an assignment to another state, or one of its own that is no increment, contains the state.
bool moves_by(const model::Model& model, const model::Block& block, std::size_t state) {
  const std::uint32_t variable = model.states[state].variable;
  return std::ranges::any_of(block, [&](const model::Action& action) {
    if (const auto* assign = std::get_if<model::Assign>(&action.what))
      return model::depends_on(model.graph, assign->value, variable) &&
             !(assign->state == state && is_increment_of(model, assign->value, variable));
    const auto* branch = std::get_if<model::If>(&action.what);
    return branch && (moves_by(model, branch->then, state) || moves_by(model, branch->otherwise, state));
  });
}

/// Whether a value is made of constants, of states that are counted on, and of decisions, so that what it is now has no
/// neighbours but other such values.
bool is_step(const model::Model& model, model::NodeId value, const std::vector<char>& counted) {
  const model::Node& node = model.graph[value];
  const auto parts_are = [&] {
    return std::ranges::all_of(model::arguments(node), [&](model::NodeId a) { return is_step(model, a, counted); });
  };
  switch (node.op) {
    case model::Op::variable:
      return node.number >= model.layout.parameters ||
             (node.number >= model.layout.states && node.number < model.layout.unknowns &&
              counted[node.number - model.layout.states] != 0);
    case model::Op::less:
    case model::Op::less_equal:
    case model::Op::equal:
    case model::Op::not_equal:
    case model::Op::logical_and:
    case model::Op::logical_or:
    case model::Op::logical_not:
    case model::Op::sign:
    case model::Op::floor:
    case model::Op::ceiling:
      return true;
    case model::Op::select:
      return is_step(model, node.b, counted) && is_step(model, node.c, counted);
    case model::Op::constant:
    case model::Op::add:
    case model::Op::subtract:
    case model::Op::negate:
    case model::Op::absolute:
    case model::Op::minimum:
    case model::Op::maximum:
    case model::Op::modulo:
      return parts_are();
    default:
      return std::ranges::none_of(model::variables_of(model.graph, value),
                                  [&](std::uint32_t v) { return v < model.layout.parameters; });
  }
}

void leave_out_what_flows(const model::Model& model, const model::Block& block, std::vector<char>& counted,
                          bool& changed) {
  for (const model::Action& action : block) {
    if (const auto* assign = std::get_if<model::Assign>(&action.what)) {
      if (counted[assign->state] == 0 || is_step(model, assign->value, counted)) continue;
      counted[assign->state] = 0;
      changed = true;
    } else if (const auto* branch = std::get_if<model::If>(&action.what)) {
      leave_out_what_flows(model, branch->then, counted, changed);
      leave_out_what_flows(model, branch->otherwise, counted, changed);
    }
  }
}

/// `y := 4*y*(1 - y)` has neighbours, `n := n + 1` has none.
bool steps_only(const model::ModelProgram& program, std::size_t state) {
  const model::Model& model = program.model;
  std::vector<char> counted = program.counters;
  for (bool changed = true; changed;) {
    changed = false;
    for (const model::When& when : model.events) {
      leave_out_what_flows(model, when.actions, counted, changed);
      leave_out_what_flows(model, when.limit_actions, counted, changed);
    }
    for (const model::Scheduled& event : model.schedule) leave_out_what_flows(model, event.actions, counted, changed);
  }
  return counted[state] != 0;
}

template <class Asks>
bool any_block(const model::Model& model, Asks&& asks) {
  return std::ranges::any_of(model.events,
                             [&](const model::When& when) { return asks(when.actions) || asks(when.limit_actions); }) ||
         std::ranges::any_of(model.schedule, [&](const model::Scheduled& event) { return asks(event.actions); });
}

bool any_guard_reads(const model::Model& model, std::uint32_t variable) {
  return std::ranges::any_of(
      model.events, [&](const model::When& when) { return model::depends_on(model.graph, when.guard, variable); });
}

}  // namespace

bool is_discrete(const model::ModelProgram& program, std::size_t state) {
  const model::Model& model = program.model;
  const std::uint32_t variable = model.states[state].variable;
  if (program.counters[state] == 0 || !steps_only(program, state)) return false;
  return any_guard_reads(model, variable) ||
         any_block(model, [&](const model::Block& block) { return decides(model, block, variable); });
}

std::vector<std::size_t> directions_of(const model::ModelProgram& program) {
  std::vector<std::size_t> directions;
  for (std::size_t i = 0; i < program.model.states.size(); ++i)
    if (!program.model.states[i].algebraic && !is_discrete(program, i)) directions.push_back(i);
  return directions;
}

bool is_unread(const model::ModelProgram& program, std::size_t state) {
  const model::Model& model = program.model;
  const std::uint32_t variable = model.states[state].variable;
  for (const model::Mode& mode : model.modes)
    for (const model::NodeId node : mode.derivatives)
      if (model::depends_on(model.graph, node, variable)) return false;
  return !any_guard_reads(model, variable) && !any_block(model, [&](const model::Block& block) {
    return decides(model, block, variable) || moves_by(model, block, state);
  });
}

}  // namespace continuo::studies
