// continuo/symbolic/graph/derivative.cpp
// Forward mode over the graph: each node's gradient is a sparse list made from those of its arguments.
#include <algorithm>
#include <numbers>
#include <unordered_map>
#include <utility>

#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::model {

namespace {

/// d op / d argument `which`, for every operation with a slope.
class Partial {
 public:
  explicit Partial(Graph& graph) : g(graph) {}

  NodeId operator()(NodeId id, int which) {
    const Node n = g[id];
    return arity(n.op) == 1 ? unary(n, id) : binary(n, id, which);
  }

 private:
  Graph& g;

  NodeId one() { return g.constant(1); }
  NodeId zero() { return g.constant(0); }
  NodeId square(NodeId a) { return g.multiply(a, a); }
  NodeId reciprocal(NodeId a) { return g.divide(one(), a); }

  NodeId unary(const Node& n, NodeId id) {
    const NodeId x = n.a;
    switch (n.op) {
      case Op::negate:
        return g.constant(-1);
      case Op::sine:
        return g.apply(Op::cosine, x);
      case Op::cosine:
        return g.negate(g.apply(Op::sine, x));
      case Op::tangent:
        return g.add(one(), square(id));
      case Op::arc_sine:
        return reciprocal(g.apply(Op::square_root, g.subtract(one(), square(x))));
      case Op::arc_cosine:
        return g.negate(reciprocal(g.apply(Op::square_root, g.subtract(one(), square(x)))));
      case Op::arc_tangent:
        return reciprocal(g.add(one(), square(x)));
      case Op::hyperbolic_sine:
        return g.apply(Op::hyperbolic_cosine, x);
      case Op::hyperbolic_cosine:
        return g.apply(Op::hyperbolic_sine, x);
      case Op::hyperbolic_tangent:
        return g.subtract(one(), square(id));
      case Op::exponential:
        return id;
      case Op::logarithm:
        return reciprocal(x);
      case Op::logarithm10:
        return g.divide(g.constant(1 / std::numbers::ln10), x);
      case Op::square_root:
        return g.divide(g.constant(0.5), id);
      case Op::smooth:
        return one();
      case Op::absolute:
        return g.apply(Op::sign, x);
      case Op::interpolate:
        return g.interpolate_slope(n.number, x);
      default:
        return zero();
    }
  }

  NodeId binary(const Node& n, NodeId id, int which) {
    const NodeId a = n.a, b = n.b, mine = which == 0 ? a : b, other = which == 0 ? b : a;
    switch (n.op) {
      case Op::add:
        return one();
      case Op::subtract:
        return g.constant(which == 0 ? 1 : -1);
      case Op::multiply:
        return other;
      case Op::divide:
        return which == 0 ? reciprocal(b) : g.negate(g.divide(id, b));
      case Op::power:
        return which == 0 ? base_slope(a, b) : g.multiply(id, g.apply(Op::logarithm, a));
      // The branch that compute() takes: the first argument where both are equal.
      case Op::minimum:
        return which == 0 ? g.greater_equal(b, a) : g.less(b, a);
      case Op::maximum:
        return which == 0 ? g.less_equal(b, a) : g.less(a, b);
      case Op::hypotenuse:
        return g.divide(mine, id);
      case Op::arc_tangent2: {
        const NodeId part = g.divide(other, g.add(square(a), square(b)));  // atan2(y, x): x/r^2 and -y/r^2
        return which == 0 ? part : g.negate(part);
      }
      case Op::modulo:
        return which == 0 ? one() : g.negate(g.apply(Op::floor, g.divide(a, b)));
      default:
        return zero();
    }
  }

  NodeId base_slope(NodeId a, NodeId b) { return g.multiply(b, g.power(a, g.subtract(b, one()))); }
};

using Gradient = std::vector<std::pair<std::uint32_t, NodeId>>;  // column and derivative, columns ascending

/// scale_p*p + scale_q*q with the zeros dropped.
Gradient combine(Graph& g, NodeId scale_p, const Gradient& p, NodeId scale_q, const Gradient& q) {
  Gradient sum;
  sum.reserve(p.size() + q.size());
  auto i = p.begin();
  auto j = q.begin();
  const auto push = [&](std::uint32_t column, NodeId value) {
    if (!g.is(value, 0)) sum.emplace_back(column, value);
  };
  // A slope that is 0 everywhere (floor, sign) ends the chain, whatever stands behind it.
  const auto scaled = [&](NodeId scale, NodeId value) { return g.is(scale, 0) ? scale : g.multiply(scale, value); };
  while (i != p.end() || j != q.end()) {
    if (j == q.end() || (i != p.end() && i->first < j->first)) {
      push(i->first, scaled(scale_p, i->second));
      ++i;
    } else if (i == p.end() || j->first < i->first) {
      push(j->first, scaled(scale_q, j->second));
      ++j;
    } else {
      push(i->first, g.add(scaled(scale_p, i->second), scaled(scale_q, j->second)));
      ++i, ++j;
    }
  }
  return sum;
}

Gradient choose(Graph& g, NodeId condition, const Gradient& p, const Gradient& q) {
  Gradient chosen;
  for (auto i = p.begin(), j = q.begin(); i != p.end() || j != q.end();) {
    const bool from_p = j == q.end() || (i != p.end() && i->first <= j->first);
    const bool from_q = i == p.end() || (j != q.end() && j->first <= i->first);
    const std::uint32_t column = from_p ? i->first : j->first;
    const NodeId value = g.select(condition, from_p ? i->second : g.constant(0), from_q ? j->second : g.constant(0));
    if (!g.is(value, 0)) chosen.emplace_back(column, value);
    if (from_p) ++i;
    if (from_q) ++j;
  }
  return chosen;
}

class Differentiation {
 public:
  Differentiation(Graph& graph, std::span<const NodeId> outputs, std::span<const std::uint32_t> variables)
      : graph_(graph), partial_(graph) {
    for (std::uint32_t k = 0; k < variables.size(); ++k) column_.emplace(variables[k], k);
    std::uint32_t top = 0;
    for (const NodeId output : outputs) top = std::max(top, output.index + 1);
    gradient_.resize(top);
    for (const NodeId id : reachable(graph, outputs)) gradient_[id.index] = of(id);
  }

  const Gradient& operator[](NodeId id) const { return gradient_[id.index]; }

 private:
  Gradient of(NodeId id) {
    const Node n = graph_[id];
    if (n.op == Op::variable) {
      const auto found = column_.find(n.number);
      return found == column_.end() ? Gradient{} : Gradient{{found->second, graph_.constant(1)}};
    }
    if (arity(n.op) == 0) return {};
    static const Gradient nothing;
    const Gradient& of_a = gradient_[n.a.index];
    const Gradient& of_b = n.b.valid() ? gradient_[n.b.index] : nothing;
    if (n.op == Op::select) return choose(graph_, n.a, of_b, gradient_[n.c.index]);
    if (of_a.empty() && of_b.empty()) return {};
    const NodeId slope_a = of_a.empty() ? NodeId{} : partial_(id, 0);
    const NodeId slope_b = of_b.empty() ? NodeId{} : partial_(id, 1);
    return combine(graph_, slope_a, of_a, slope_b, of_b);
  }

  Graph& graph_;
  Partial partial_;
  std::unordered_map<std::uint32_t, std::uint32_t> column_;
  std::vector<Gradient> gradient_;
};

}  // namespace

NodeId differentiate(Graph& graph, NodeId node, std::uint32_t variable) {
  const Differentiation d(graph, {&node, 1}, {&variable, 1});
  return d[node].empty() ? graph.constant(0) : d[node].front().second;
}

std::vector<JacobianEntry> jacobian(Graph& graph, std::span<const NodeId> outputs,
                                    std::span<const std::uint32_t> variables) {
  const Differentiation d(graph, outputs, variables);
  std::vector<JacobianEntry> entries;
  for (std::uint32_t row = 0; row < outputs.size(); ++row) {
    for (const auto& [column, value] : d[outputs[row]]) entries.push_back({row, column, value});
  }
  return entries;
}

}  // namespace continuo::model
