// continuo/language/check/states/starts.cpp
// Starts by other starts: S(0) = 1 - I(0) - R(0), m(0) = am/(am + bm) with lets of states. Each state in an initial
// value is replaced by what it starts from, so that what remains are parameters, inputs and t.
#include <algorithm>
#include <functional>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/names/checker.hpp>

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
      if (image_.contains(visit.node)) {
        visits_.pop_back();
      } else if (visit.is_open) {
        close(visit);
      } else {
        open();
      }
    }
    return image_.at(root);
  }

 private:
  struct Visit {
    NodeId node;
    NodeId expression = {};  // of a variable
    bool is_open = false;
  };
  struct Hash {
    std::size_t operator()(NodeId id) const { return id.index; }
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
      image_.emplace(id, id);
      return;
    }
    way_.push_back(node.number);
    visit.expression = expression_of_(node.number);
    if (visit.expression.valid()) visits_.push_back({visit.expression});
  }

  void close(const Visit& visit) {
    visits_.pop_back();
    const Node node = graph_[visit.node];
    NodeId image = visit.node;
    if (node.op != Op::variable) {
      image = with_arguments(graph_, visit.node, [&](NodeId argument) { return image_.at(argument); });
    } else {
      way_.pop_back();
      if (visit.expression.valid()) image = image_.at(visit.expression);
    }
    image_.emplace(visit.node, image);
  }

  Graph& graph_;
  Expressions expression_of_;
  Circle circle_;
  std::vector<Visit> visits_;
  std::vector<std::uint32_t> way_;  // variables whose expressions are being walked
  std::unordered_map<NodeId, NodeId, Hash> image_;
};

}  // namespace

/// Of conditions that all stand at the start. Samples of them are no numbers of the run: they are released.
void Checker::solve_starts() {
  const Layout& layout = model_.layout;
  std::unordered_map<std::uint32_t, NodeId> samples;
  for (const ConditionText& condition : conditions_) {
    for (const Sample& sample : condition.samples) samples.emplace(sample.variable, sample.of);
  }
  Span span{};  // of the start at hand
  const auto expression_of = [&](std::uint32_t variable) -> NodeId {
    if (const auto sample = samples.find(variable); sample != samples.end()) return sample->second;
    if (variable < layout.states || variable >= layout.parameters) {
      if (variable >= highest_begin) refuse_in_start(variable, "it follows from its equation", span);
      return {};
    }
    if (variable >= layout.unknowns) {
      refuse_in_start(variable, "an equation `0 = ...` determines it, when the states are known", span);
      return {};
    }
    const State& state = model_.states[variable - layout.states];
    if (!state.in_world) return state.initial;
    refuse_in_start(variable, "it is of a body or of the world", span);
    return {};
  };
  const auto circle = [&](const std::vector<std::uint32_t>& variables) { report_circle(variables); };
  StartSolver solver(model_.graph, expression_of, circle);
  std::vector<std::pair<State*, NodeId>> solved;  // put in their places when nobody looks for what was written there
  for (State& state : model_.states) {
    if (state.in_world || !state.initial.valid()) continue;
    span = state.span;
    solved.emplace_back(&state, solver.solve(model_.graph.variable(state.variable)));
  }
  for (const auto& [state, start] : solved) state->initial = start;
  model_.layout.size = model_.layout.samples;
}

void Checker::refuse_in_start(std::uint32_t variable, std::string_view why, Span span) {
  fail("E222", span, fmt::format("this start cannot depend on `{}`", name_of(variable)), std::string(why),
       "starts are made of parameters, inputs, t and other starts");
}

/// Of the circle's variables samples have no name: they stand for the states they are of.
void Checker::report_circle(const std::vector<std::uint32_t>& variables) {
  std::vector<std::uint32_t> states;
  for (const std::uint32_t variable : variables) {
    if (variable < model_.layout.parameters) states.push_back(variable);
  }
  const auto start_of = [&](std::uint32_t variable) { return fmt::format("{}({:g})", name_of(variable), start_time_); };
  std::string circle;
  for (const std::uint32_t state : states) circle += start_of(state) + " -> ";
  fail("E246", model_.states[states.front() - model_.layout.states].span,
       fmt::format("`{}` is given by itself", start_of(states.front())), circle + start_of(states.front()),
       "give one of them a start of its own");
}

}  // namespace continuo::model::detail
