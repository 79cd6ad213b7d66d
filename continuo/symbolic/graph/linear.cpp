// continuo/symbolic/graph/linear.cpp
// Expressions that are linear in a variable, and small systems of them.
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <continuo/symbolic/graph/expression.hpp>
#include <continuo/symbolic/graph/node_values.hpp>

namespace continuo::model {

namespace {

/// coefficient*variable + remainder for one node, from the same of its arguments; empty where it is not linear.
/// An invalid coefficient means that the node does not contain the variable.
struct Split {
  bool linear = true;
  NodeId coefficient{}, remainder{};
};

NodeId zero_if_absent(Graph& g, NodeId coefficient) {
  return coefficient.valid() ? coefficient : g.constant(0);
}

/// A remainder that is not there stays away, whatever it is multiplied with.
NodeId scaled(Graph& g, Op op, NodeId remainder, NodeId by) {
  return g.is(remainder, 0) ? remainder : g.apply(op, remainder, by);
}

Split split_product(Graph& g, Split a, Split b) {
  if (b.coefficient.valid()) std::swap(a, b);
  return {.coefficient = g.multiply(a.coefficient, b.remainder),
          .remainder = scaled(g, Op::multiply, a.remainder, b.remainder)};
}

Split split(Graph& g, const Node& node, const Split& a, const Split& b, const Split& c) {
  const bool only_b_is_free = !b.coefficient.valid();
  switch (node.op) {
    case Op::add:
    case Op::subtract:
      return {.coefficient = g.apply(node.op, zero_if_absent(g, a.coefficient), zero_if_absent(g, b.coefficient)),
              .remainder = g.apply(node.op, a.remainder, b.remainder)};
    case Op::negate:
      return {.coefficient = g.negate(a.coefficient), .remainder = g.negate(a.remainder)};
    case Op::smooth:
      return {.coefficient = g.apply(Op::smooth, a.coefficient), .remainder = g.apply(Op::smooth, a.remainder)};
    case Op::multiply:
      if (a.coefficient.valid() && b.coefficient.valid()) return {.linear = false};
      return split_product(g, a, b);
    case Op::divide:
      if (!only_b_is_free) return {.linear = false};
      return {.coefficient = g.divide(a.coefficient, b.remainder),
              .remainder = scaled(g, Op::divide, a.remainder, b.remainder)};
    case Op::select:
      if (a.coefficient.valid()) return {.linear = false};
      return {.coefficient = g.select(a.remainder, zero_if_absent(g, b.coefficient), zero_if_absent(g, c.coefficient)),
              .remainder = g.select(a.remainder, b.remainder, c.remainder)};
    default:
      return {.linear = false};
  }
}

}  // namespace

std::optional<Linear> linear_in(Graph& graph, NodeId node, std::uint32_t variable) {
  const std::vector<NodeId> nodes = reachable(graph, {&node, 1});
  NodeValues<Split> splits(nodes);
  const Split none;
  for (const NodeId id : nodes) {
    const Node n = graph[id];
    Split& mine = splits[id];
    mine.remainder = id;
    if (n.op == Op::variable && n.number == variable) {
      mine = {.coefficient = graph.constant(1), .remainder = graph.constant(0)};
      continue;
    }
    bool contains = false;
    for (const NodeId argument : arguments(n)) {
      const Split& of = splits[argument];
      if (!of.linear) return std::nullopt;  // no operation makes a nonlinear argument linear again
      contains = contains || of.coefficient.valid();
    }
    const auto of = [&](NodeId a) -> const Split& { return a.valid() ? splits[a] : none; };
    if (contains) mine = split(graph, n, of(n.a), of(n.b), of(n.c));
    if (!mine.linear) return std::nullopt;
  }
  const Split& result = splits[node];
  return Linear{zero_if_absent(graph, result.coefficient), result.remainder};
}

std::optional<LinearRows> linear_rows(Graph& graph, std::span<const NodeId> residuals,
                                      std::span<const std::uint32_t> unknowns) {
  LinearRows rows;
  for (NodeId remainder : residuals) {
    std::vector<NodeId> row;
    for (const std::uint32_t unknown : unknowns) {
      const auto linear = linear_in(graph, remainder, unknown);
      if (!linear) return std::nullopt;
      row.push_back(linear->coefficient);
      remainder = linear->remainder;
    }
    for (const NodeId coefficient : row) {  // x*y is linear in each of x and y, but not in both
      for (const std::uint32_t unknown : unknowns) {
        if (depends_on(graph, coefficient, unknown)) return std::nullopt;
      }
    }
    row.push_back(remainder);
    rows.push_back(std::move(row));
  }
  return rows;
}

namespace {

/// Prefers a number as pivot, which stays what it is, and takes what vanishes only where there is nothing else.
bool bring_pivot(const Graph& graph, LinearRows& rows, std::size_t k, const Vanishes& vanishes) {
  std::size_t best = rows.size();
  for (std::size_t i = k; i < rows.size(); ++i) {
    if (graph.is(rows[i][k], 0)) continue;
    if (best == rows.size() || (graph.value(rows[i][k]) && !graph.value(rows[best][k]))) best = i;
  }
  if (best == rows.size()) return false;
  const auto is_zero = [&](std::size_t i) { return graph.is(rows[i][k], 0) || vanishes(rows[i][k]); };
  if (vanishes && k + 1 < rows.size() && is_zero(best)) {
    for (std::size_t i = k; i < rows.size(); ++i) {
      if (is_zero(i)) continue;
      best = i;
      break;
    }
  }
  std::swap(rows[k], rows[best]);
  return true;
}

/// Of numbers what is left of rounding is nothing, and no pivot: 0.9 - 0.3/0.1*0.3.
NodeId difference(Graph& graph, NodeId a, NodeId b) {
  const auto p = graph.value(a), q = graph.value(b);
  if (p && q && std::abs(*p - *q) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(*p))
    return graph.constant(0);
  return graph.subtract(a, b);
}

}  // namespace

std::optional<std::vector<NodeId>> solve_linear(Graph& graph, LinearRows rows, const Vanishes& vanishes) {
  const std::size_t n = rows.size();
  LinearRows& r = rows;
  for (std::size_t k = 0; k < n; ++k) {
    if (!bring_pivot(graph, r, k, vanishes)) return std::nullopt;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (graph.is(r[i][k], 0)) continue;
      const NodeId factor = graph.divide(r[i][k], r[k][k]);
      for (std::size_t j = k + 1; j < n; ++j) r[i][j] = difference(graph, r[i][j], graph.multiply(factor, r[k][j]));
      r[i][n] = graph.subtract(r[i][n], graph.multiply(factor, r[k][n]));
    }
  }
  std::vector<NodeId> solution(n);
  for (std::size_t k = n; k-- > 0;) {
    NodeId sum = r[k][n];
    for (std::size_t j = k + 1; j < n; ++j) sum = graph.add(sum, graph.multiply(r[k][j], solution[j]));
    solution[k] = graph.divide(graph.negate(sum), r[k][k]);
  }
  return solution;
}

std::optional<std::vector<NodeId>> solve_linear(Graph& graph, std::span<const NodeId> residuals,
                                                std::span<const std::uint32_t> unknowns) {
  if (residuals.size() != unknowns.size()) return std::nullopt;
  auto rows = linear_rows(graph, residuals, unknowns);
  return rows ? solve_linear(graph, std::move(*rows)) : std::nullopt;
}

}  // namespace continuo::model
