// continuo/language/check/states/starts.cpp
// Follows starts that are made of other starts; E222 and E246 where they lead nowhere.
#include <algorithm>
#include <functional>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/states/starts.hpp>

namespace continuo::model::detail {

namespace {

/// Walks the expressions of all starts once, a variable's own expression before what it is in. Depth first with a stack
/// of its own: in a family u[i](0) = u[i-1](0)/2 each start is as deep as it is long.
class StartSolver {
 public:
  /// What a variable stands for; nothing for those that stay.
  using Expressions = std::function<NodeId(std::uint32_t variable)>;
  /// Told the variables of a circle, from the first that leads back to itself.
  using Circle = std::function<void(const std::vector<std::uint32_t>& variables)>;

  StartSolver(Graph& graph, Expressions expression_of, Circle circle)
      : graph_(graph), expression_of_(std::move(expression_of)), circle_(std::move(circle)) {}

  NodeId solve(NodeId root) {
    visits_.push_back({root});
    while (!visits_.empty()) {
      const Visit visit = visits_.back();
      if (image(visit.node).valid()) {
        visits_.pop_back();
      } else if (visit.is_open) {
        close(visit);
      } else {
        open();
      }
    }
    return image(root);
  }

 private:
  struct Visit {
    NodeId node;
    NodeId expression = {};  // of a variable
    bool is_open = false;
  };

  void open() {
    Visit& visit = visits_.back();
    visit.is_open = true;
    const NodeId id = visit.node;
    const Node node = graph_[id];
    if (node.op != Op::variable) {
      for (const NodeId argument : arguments(node)) visits_.push_back({argument});
      return;
    }
    const auto again = std::ranges::find(way_, node.number);
    if (again != way_.end()) {
      circle_({again, way_.end()});
      image(id) = id;
      return;
    }
    way_.push_back(node.number);
    visit.expression = expression_of_(node.number);
    if (visit.expression.valid()) visits_.push_back({visit.expression});
  }

  void close(const Visit& visit) {
    visits_.pop_back();
    const Node node = graph_[visit.node];
    NodeId made = visit.node;
    if (node.op != Op::variable) {
      made = with_arguments(graph_, visit.node, [&](NodeId argument) { return image(argument); });
    } else {
      way_.pop_back();
      if (visit.expression.valid()) made = image(visit.expression);
    }
    image(visit.node) = made;
  }

  /// What a node becomes; not valid before that is known.
  NodeId& image(NodeId id) {
    if (id.index >= images_.size()) images_.resize(std::max<std::size_t>(graph_.size(), id.index + 1));
    return images_[id.index];
  }

  Graph& graph_;
  Expressions expression_of_;
  Circle circle_;
  std::vector<Visit> visits_;
  std::vector<std::uint32_t> way_;  // variables whose expressions are being walked
  std::vector<NodeId> images_;      // of the nodes of the graph
};

/// Of each node of the graph, whether it has variables in it that `expression_of` may give something for.
template <class IsOpen>
std::vector<bool> open_nodes(const Graph& graph, const IsOpen& is_open) {
  std::vector<bool> open(graph.size());
  for (std::uint32_t i = 0; i < graph.size(); ++i) {
    const Node& node = graph[NodeId{i}];
    open[i] = node.op == Op::variable ? is_open(node.number)
                                      : std::ranges::any_of(arguments(node), [&](NodeId a) { return open[a.index]; });
  }
  return open;
}

void refuse_in_start(Expressions& expressions, std::uint32_t variable, std::string_view why, Span span) {
  expressions.report.fail(
      "E222", span, fmt::format("this start cannot depend on `{}`", name_of_variable(expressions.workspace, variable)),
      std::string(why), "starts are made of parameters, inputs, t and other starts");
}

/// Of the circle's variables samples have no name: they stand for the states they are of.
void report_circle(Expressions& expressions, const std::vector<State>& all, double start_time,
                   const std::vector<std::uint32_t>& variables) {
  std::vector<std::uint32_t> states;
  for (const std::uint32_t variable : variables) {
    if (variable < expressions.workspace.layout.parameters) states.push_back(variable);
  }
  const auto start_of = [&](std::uint32_t variable) {
    return fmt::format("{}({:g})", name_of_variable(expressions.workspace, variable), start_time);
  };
  std::string circle;
  for (const std::uint32_t state : states) circle += start_of(state) + " -> ";
  expressions.report.fail("E246", all[states.front() - expressions.workspace.layout.states].span,
                          fmt::format("`{}` is given by itself", start_of(states.front())),
                          circle + start_of(states.front()), "give one of them a start of its own");
}

}  // namespace

void solve_starts(Expressions& expressions, std::vector<State>& states, double start_time) {
  const Layout& layout = expressions.workspace.layout;
  std::unordered_map<std::uint32_t, NodeId> samples;
  for (const auto& [condition, of_condition] : expressions.workspace.conditions.samples()) {
    for (const Sample& sample : of_condition) samples.emplace(sample.variable, sample.of);
  }
  Span span{};  // of the start at hand
  const auto expression_of = [&](std::uint32_t variable) -> NodeId {
    if (const auto sample = samples.find(variable); sample != samples.end()) return sample->second;
    if (variable < layout.states || variable >= layout.parameters) {
      if (variable >= highest_begin) refuse_in_start(expressions, variable, "it follows from its equation", span);
      return {};
    }
    if (variable >= layout.unknowns) {
      refuse_in_start(expressions, variable, "an equation `0 = ...` determines it, when the states are known", span);
      return {};
    }
    const State& state = states[variable - layout.states];
    if (!state.in_world) return state.initial;
    refuse_in_start(expressions, variable, "it is of a body or of the world", span);
    return {};
  };
  const auto circle = [&](const std::vector<std::uint32_t>& variables) {
    report_circle(expressions, states, start_time, variables);
  };
  StartSolver solver(expressions.workspace.graph, expression_of, circle);
  const std::vector<bool> is_open = open_nodes(expressions.workspace.graph, [&](std::uint32_t variable) {
    return (variable >= layout.states && variable < layout.parameters) || variable >= layout.samples;
  });
  std::vector<std::pair<State*, NodeId>> solved;  // put in their places when nobody looks for what was written there
  for (State& state : states) {
    if (state.in_world || !state.initial.valid() || expressions.workspace.graph.value(state.initial)) continue;
    const NodeId variable = expressions.workspace.graph.variable(state.variable);
    if (!is_open[state.initial.index]) continue;
    span = state.span;
    solved.emplace_back(&state, solver.solve(variable));
  }
  for (const auto& [state, start] : solved) state->initial = start;
  expressions.workspace.layout.size = expressions.workspace.layout.samples;
}

}  // namespace continuo::model::detail
