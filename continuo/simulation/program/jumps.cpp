// Looks through the expression graph for operations that jump.
#include <cmath>
#include <span>

#include <continuo/simulation/program/jumps.hpp>
#include <continuo/simulation/program/switches.hpp>

namespace continuo::model {

std::vector<Jump> jumps_of(const Model& model, std::size_t mode) {
  std::vector<Jump> jumps;
  const std::vector<NodeId>& equations = model.modes[mode].derivatives;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    for (const NodeId id : reachable(model.graph, std::span(&equations[i], 1))) {
      const Node& n = model.graph[id];
      if (is_jump(n.op)) jumps.push_back({i, id, n.a, arity(n.op) == 2 ? n.b : n.a});
    }
  }
  return jumps;
}

double distance_to(Op op, double a, double b) {
  switch (op) {
    case Op::less:
    case Op::less_equal:
      return std::abs(a - b);
    case Op::sign:
      return std::abs(a);
    case Op::modulo:
      return std::abs(a / b - std::round(a / b));
    default:
      return std::abs(a - std::round(a));
  }
}

std::string text_of(const Model& model, const Jump& jump) {
  return to_text(model.graph, jump.node, [&](std::uint32_t v) { return variable_name(model, v); }, 80);
}

}  // namespace continuo::model
