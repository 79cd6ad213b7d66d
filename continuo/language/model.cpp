// continuo/language/model.cpp
// Searches a checked model for its states, parameters and columns.
#include <algorithm>

#include <continuo/language/model.hpp>

namespace continuo::model {

namespace {

template <class List, class Name>
std::size_t find_by(const List& list, Name member, std::string_view wanted) {
  const auto found = std::ranges::find(list, wanted, member);
  return found == list.end() ? npos : static_cast<std::size_t>(found - list.begin());
}

/// Most settings are a number or a name: no list of what they are computed from is needed.
bool is_at_hand(const Model& model, NodeId node) {
  return node.valid() && (model.graph[node].op == Op::constant || model.graph[node].op == Op::variable);
}

/// In one pass: thousands of cells of a grid share most of what they start from.
template <class Item>
void set_all(const Model& model, const std::vector<Item>& items, NodeId Item::* expression,
             std::vector<double>& variables) {
  std::vector<NodeId> nodes;
  nodes.reserve(items.size());
  for (const Item& item : items) nodes.push_back(item.*expression);
  std::vector<double> values;
  if (std::ranges::all_of(nodes, [&](NodeId node) { return is_at_hand(model, node); })) {
    for (const NodeId node : nodes) values.push_back(evaluate(model, node, variables));
  } else {
    values = evaluate(model, nodes, variables);
  }
  for (std::size_t i = 0; i < items.size(); ++i) variables[items[i].variable] = values[i];
}

}  // namespace

bool is_dragged(const DrawItem& item) {
  return std::ranges::any_of(item.attributes, [](const DrawAttribute& attribute) { return attribute.name == "drag"; });
}

bool stands_still(const Model& model, std::size_t state) {
  const State& one = model.states[state];
  return !one.algebraic && !one.in_world &&
         std::ranges::all_of(model.modes, [&](const Mode& mode) { return model.graph.is(mode.derivatives[state], 0); });
}

std::size_t find_state(const Model& model, std::string_view column) {
  return find_by(model.states, &State::column, column);
}
std::vector<std::size_t> states_named(const Model& model, std::string_view name) {
  if (const std::size_t one = find_state(model, name); one != npos) return {one};
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < model.states.size(); ++i) {
    std::string family = model.states[i].column;
    const std::size_t begin = family.find('['), end = family.rfind(']');
    if (begin == std::string::npos || end == std::string::npos) continue;
    if (family.erase(begin, end + 1 - begin) == name) found.push_back(i);
  }
  return found;
}

std::size_t find_parameter(const Model& model, std::string_view name) {
  return find_by(model.parameters, &Parameter::name, name);
}
std::size_t find_input(const Model& model, std::string_view name) {
  return find_by(model.inputs, &Input::name, name);
}
std::size_t find_mode(const Model& model, std::string_view name) {
  return find_by(model.modes, &Mode::name, name);
}

double evaluate(const Model& model, NodeId node, std::span<const double> variables) {
  if (is_at_hand(model, node))
    return model.graph[node].op == Op::constant ? model.graph[node].value : variables[model.graph[node].number];
  return evaluate(model, {&node, 1}, variables).front();
}
std::vector<double> evaluate(const Model& model, std::span<const NodeId> nodes, std::span<const double> variables) {
  return evaluate(model.graph, nodes, variables, [&](std::uint32_t table, double x, bool slope) {
    const Table& points = *model.tables[table].points;
    return slope ? points.slope(x) : points.value(x);
  });
}

std::vector<double> start_values(const Model& model, const Overrides& overrides, std::optional<double> from) {
  std::vector<double> variables(model.layout.size, 0.0);
  for (const std::size_t i : model.parameter_order) {
    const Parameter& parameter = model.parameters[i];
    const auto set = overrides.find(parameter.name);
    variables[parameter.variable] =
        set != overrides.end() ? set->second : evaluate(model, parameter.expression, variables);
  }
  const double start = from ? *from : model.run.from ? evaluate(model, model.run.from->node, variables) : 0.0;
  variables[Layout::time] = start;
  for (const Input& input : model.inputs) {
    const auto set = input.points ? overrides.end() : overrides.find(input.name);
    variables[input.variable] = input.points             ? input.points->value(start)
                                : set != overrides.end() ? set->second
                                                         : input.value;
  }
  set_all(model, model.unknowns, &Unknown::guess, variables);
  set_all(model, model.states, &State::initial, variables);
  return variables;
}

std::string variable_name(const Model& model, std::uint32_t variable) {
  const Layout& layout = model.layout;
  if (variable == Layout::time) return "t";
  if (variable - layout.states < model.states.size()) return model.states[variable - layout.states].column;
  for (const Parameter& parameter : model.parameters) {
    if (parameter.variable == variable) return parameter.name;
  }
  for (const Input& input : model.inputs) {
    if (input.variable == variable) return input.name;
  }
  for (const Unknown& unknown : model.unknowns) {
    if (unknown.variable == variable) return unknown.name;
  }
  return "sample " + std::to_string(variable - layout.samples);
}

}  // namespace continuo::model
