// Rewrites the equations of a mode with a switch for each jump and corner.
#include <algorithm>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/program/switches.hpp>
#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::model {

bool is_jump(Op op) {
  return op == Op::less || op == Op::less_equal || op == Op::sign || op == Op::floor || op == Op::ceiling ||
         op == Op::modulo;
}

namespace {

bool is_corner(Op op) {
  return op == Op::absolute || op == Op::minimum || op == Op::maximum;
}

/// The nodes below the roots, arguments first; below `smooth` nothing is looked for.
std::vector<NodeId> in_sight(const Graph& graph, std::span<const NodeId> roots) {
  std::vector<NodeId> found, open(roots.begin(), roots.end());
  std::vector<char> seen(graph.size(), 0);
  while (!open.empty()) {
    const NodeId id = open.back();
    open.pop_back();
    if (std::exchange(seen[id.index], char{1}) != 0) continue;
    found.push_back(id);
    if (graph[id].op == Op::smooth) continue;
    for (const NodeId argument : arguments(graph[id])) open.push_back(argument);
  }
  std::ranges::sort(found);
  return found;
}

/// Rewrites the equations of a mode from the leaves on.
class Rewriting {
 public:
  Rewriting(ModelProgram& program, std::size_t mode)
      : model_(program.model), g_(program.model.graph), still_(model_.states.size()) {
    for (std::size_t i = 0; i < still_.size(); ++i) still_[i] = stands_still(model_, i) ? 1 : 0;
    for (const NodeId node : model_.modes[mode].derivatives) roots_.push_back(program.with_inputs(g_, node));
  }

  SwitchedEquations equations() {
    const std::vector<NodeId> nodes = in_sight(g_, roots_);
    const auto count = [&](auto&& is) {
      return static_cast<std::size_t>(std::ranges::count_if(nodes, [&](NodeId id) { return is(g_[id].op); }));
    };
    const std::size_t jumps = count(is_jump);
    if (jumps > most_switches) return {};
    with_corners_ = count(is_corner) <= most_corners;
    if (jumps == 0 && !(with_corners_ && count(is_corner) > 0)) return {};
    for (const NodeId id : nodes) image_[id.index] = rewritten(id);
    if (made_.switches.empty()) return {};
    for (const NodeId root : roots_) made_.derivatives.push_back(of(root));
    return std::move(made_);
  }

 private:
  NodeId of(NodeId id) const { return image_.at(id.index); }

  NodeId rewritten(NodeId id) {
    const Node n = g_[id];  // a copy: the graph grows below
    switch (n.op) {
      case Op::constant:
      case Op::variable:
      case Op::smooth:
        return id;
      case Op::less:
      case Op::less_equal:
        return relation(g_.subtract(of(n.b), of(n.a)), n.op == Op::less_equal, g_.apply(n.op, of(n.a), of(n.b)));
      case Op::sign:
        return held(Switch::Kind::sign, of(n.a), g_.apply(Op::sign, of(n.a)));
      case Op::floor:
        return held(Switch::Kind::floor, of(n.a), g_.apply(Op::floor, of(n.a)));
      case Op::ceiling:  // ceil(u) = -floor(-u)
        return g_.negate(held(Switch::Kind::floor, g_.negate(of(n.a)), g_.apply(Op::floor, g_.negate(of(n.a)))));
      case Op::modulo: {
        const NodeId part = g_.divide(of(n.a), of(n.b));
        const NodeId whole = held(Switch::Kind::floor, part, g_.apply(Op::floor, part));
        return g_.subtract(of(n.a), g_.multiply(of(n.b), whole));
      }
      case Op::absolute:
      case Op::minimum:
      case Op::maximum:
        return with_corners_ ? corner(n) : again(n);
      default:
        return again(n);
    }
  }

  NodeId again(const Node& n) {
    switch (n.op) {
      case Op::interpolate:
        return g_.interpolate(n.number, of(n.a));
      case Op::interpolate_slope:
        return g_.interpolate_slope(n.number, of(n.a));
      case Op::select:
        return g_.select(of(n.a), of(n.b), of(n.c));
      default:
        return arity(n.op) == 1 ? g_.apply(n.op, of(n.a)) : g_.apply(n.op, of(n.a), of(n.b));
    }
  }

  NodeId corner(const Node& n) {
    const NodeId a = of(n.a);
    if (n.op == Op::absolute) return g_.select(relation(a, true, g_.less_equal(g_.constant(0), a)), a, g_.negate(a));
    const NodeId b = of(n.b), a_first = relation(g_.subtract(b, a), true, g_.less_equal(a, b));
    return n.op == Op::minimum ? g_.select(a_first, a, b) : g_.select(a_first, b, a);
  }

  NodeId relation(NodeId surface, bool closed, NodeId live) {
    return held(Switch::Kind::relation, surface, live, closed);
  }

  /// The variable of the switch, or `live` where there is nothing to hold: the surface does not move, or follows
  /// unknowns.
  NodeId held(Switch::Kind kind, NodeId surface, NodeId live, bool closed = false) {
    if (g_.value(live) || !moves(surface)) return live;
    for (const Switch& known : made_.switches)
      if (known.kind == kind && known.surface == surface && known.closed == closed) return g_.variable(known.variable);
    const auto variable = static_cast<std::uint32_t>(model_.layout.size + made_.switches.size());
    made_.switches.push_back({kind, closed, surface, variable});
    return g_.variable(variable);
  }

  bool moves(NodeId node) {
    bool any = false;
    for (const std::uint32_t v : variables_of(g_, node)) {
      if (v >= model_.layout.unknowns && v < model_.layout.parameters) return false;
      const bool state = v >= model_.layout.states && v < model_.layout.unknowns;
      if (state) made_.slides = true;
      any = any || v == Layout::time || (state && !still_[v - model_.layout.states]) || v >= model_.layout.size;
    }
    return any;
  }

  const Model& model_;
  Graph& g_;
  std::vector<char> still_;
  std::vector<NodeId> roots_;
  std::unordered_map<std::uint32_t, NodeId> image_;
  bool with_corners_ = false;
  SwitchedEquations made_;
};

/// dz/dt + sum of dz/dx f.
NodeId approach_of(ModelProgram& program, const SwitchedEquations& equations, NodeId surface) {
  Graph& g = program.model.graph;
  const Layout& layout = program.model.layout;
  NodeId rate = differentiate(g, surface, Layout::time);
  for (const std::uint32_t v : variables_of(g, surface)) {
    if (v < layout.states || v >= layout.unknowns) continue;
    const NodeId slope = differentiate(g, surface, v);
    rate = g.add(rate, g.multiply(slope, equations.derivatives[v - layout.states]));
  }
  return rate;
}

}  // namespace

SwitchedEquations switched_equations(ModelProgram& program, std::size_t mode) {
  SwitchedEquations equations = Rewriting(program, mode).equations();
  if (equations.empty()) return equations;
  std::vector<NodeId> surfaces, approach;
  for (const Switch& one : equations.switches) surfaces.push_back(one.surface);
  approach.reserve(surfaces.size());
  for (const NodeId surface : surfaces) approach.push_back(approach_of(program, equations, surface));
  program.switch_variables = std::max(program.switch_variables, static_cast<std::uint32_t>(surfaces.size()));
  Graph& g = program.model.graph;
  for (const Switch& one : equations.switches) {
    const NodeId half = g.constant(0.5), part = g.subtract(one.surface, g.variable(one.variable));
    equations.guards.push_back(one.kind == Switch::Kind::floor
                                   ? g.subtract(half, g.apply(Op::absolute, g.subtract(part, half)))
                                   : one.surface);
  }
  equations.rates = program.busy_tape_of(equations.derivatives);
  equations.surfaces = program.busy_tape_of(surfaces);
  equations.approach = program.busy_tape_of(approach);
  return equations;
}

}  // namespace continuo::model
