// continuo/symbolic/graph/expression.hpp
// Expressions as a graph in which equal expressions are one node:
//
//   Graph g;
//   const NodeId x = g.variable(1), k = g.variable(3);
//   const NodeId force = g.negate(g.multiply(k, x));                  // -k*x
//   const NodeId stiffness = differentiate(g, force, 1);             // -k    (derivative.hpp)
//   to_text(g, stiffness, [](auto i) { return i == 3 ? "k" : "x"; });  // "-k"
//
// A node's arguments always have smaller indices than the node: a walk in the order of the indices meets every
// argument before its use, and nothing here recurses.
#pragma once
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/symbolic/graph/operation.hpp>

namespace continuo::model {

/// An expression of a Graph: cheap to copy, equal where the expressions are equal.
struct NodeId {
  std::uint32_t index = std::numeric_limits<std::uint32_t>::max();
  [[nodiscard]] bool valid() const { return index != std::numeric_limits<std::uint32_t>::max(); }
  friend auto operator<=>(NodeId, NodeId) = default;
};

struct Node {
  /// Of an operation: the uses of its arguments before it. See Graph.
  struct Before {
    NodeId of_a{}, of_b{};
  };

  Op op = Op::constant;
  bool finite : 1 = false;   // it cannot be infinite or NaN where the variables are not
  bool corners : 1 = false;  // it, or what it is made of, has jumps or kinks that no `smooth` stands around
  // The operations that it is an argument of: how many, up to a limit; their kinds, a bit for each kind and side; and
  // the latest. See Graph.
  std::uint8_t use_count : 5 = 0;
  std::uint16_t uses = 0;
  std::uint32_t number = 0;  // of a variable, or of a table
  NodeId a{}, b{}, c{};      // as many as arity(op)
  NodeId latest_use{};
  union {              // a grid has millions of nodes: half a line of the cache each
    double value = 0;  // of a constant
    Before before;     // of an operation
  };
};

/// Owns the nodes. An operation is looked for among the uses of an argument that has few, else in an index of those
/// whose arguments all have many; and nowhere where one of its arguments has no use of its kind and side. So the nodes
/// of a large family, which are made one after the other and are new, cost neither a search nor a place in the index.
/// The makers simplify as they build: constants are folded, `x + 0`, `1*x`, `--x` and their like
/// vanish, `x^2` becomes `x*x`. Only what holds for every number is used: `0*x` is 0 where x cannot be infinite.
class Graph {
 public:
  Graph();

  [[nodiscard]] NodeId constant(double value);
  [[nodiscard]] NodeId truth(bool value) { return constant(value ? 1 : 0); }
  [[nodiscard]] NodeId variable(std::uint32_t number);
  [[nodiscard]] NodeId apply(Op op, NodeId a);
  [[nodiscard]] NodeId apply(Op op, NodeId a, NodeId b);
  [[nodiscard]] NodeId select(NodeId condition, NodeId if_true, NodeId if_false);
  [[nodiscard]] NodeId interpolate(std::uint32_t table, NodeId x) { return read_table(Op::interpolate, table, x); }
  [[nodiscard]] NodeId interpolate_slope(std::uint32_t table, NodeId x) {
    return read_table(Op::interpolate_slope, table, x);
  }

  [[nodiscard]] NodeId add(NodeId a, NodeId b) { return apply(Op::add, a, b); }
  [[nodiscard]] NodeId subtract(NodeId a, NodeId b) { return apply(Op::subtract, a, b); }
  [[nodiscard]] NodeId multiply(NodeId a, NodeId b) { return apply(Op::multiply, a, b); }
  [[nodiscard]] NodeId divide(NodeId a, NodeId b) { return apply(Op::divide, a, b); }
  [[nodiscard]] NodeId power(NodeId a, NodeId b) { return apply(Op::power, a, b); }
  [[nodiscard]] NodeId negate(NodeId a) { return apply(Op::negate, a); }
  [[nodiscard]] NodeId less(NodeId a, NodeId b) { return apply(Op::less, a, b); }
  [[nodiscard]] NodeId less_equal(NodeId a, NodeId b) { return apply(Op::less_equal, a, b); }
  [[nodiscard]] NodeId greater(NodeId a, NodeId b) { return apply(Op::less, b, a); }
  [[nodiscard]] NodeId greater_equal(NodeId a, NodeId b) { return apply(Op::less_equal, b, a); }

  /// So many nodes are to be expected.
  void reserve(std::size_t nodes);
  const Node& operator[](NodeId id) const { return nodes_[id.index]; }
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

  /// The number this node is, if it is one.
  [[nodiscard]] std::optional<double> value(NodeId id) const {
    const Node& node = (*this)[id];
    return node.op == Op::constant ? std::optional(node.value) : std::nullopt;
  }
  [[nodiscard]] bool is(NodeId id, double value) const {
    const Node& node = (*this)[id];
    return node.op == Op::constant && node.value == value;
  }

 private:
  friend struct Simplifier;
  /// Nodes by what they are: open addressing over nodes_, a power of two in size.
  struct Index {
    std::vector<std::uint32_t> slots;
    std::size_t count = 0;  // of the nodes in it
  };

  [[nodiscard]] NodeId intern_leaf(const Node& node);
  [[nodiscard]] NodeId intern_operation(const Node& node);
  [[nodiscard]] NodeId read_table(Op op, std::uint32_t table, NodeId x);
  [[nodiscard]] NodeId new_variable(std::uint32_t number);
  [[nodiscard]] NodeId find_operation(const Node& node) const;
  [[nodiscard]] NodeId find_among_uses(NodeId argument, const Node& node) const;
  [[nodiscard]] NodeId use_before(NodeId argument, NodeId use) const;
  [[nodiscard]] bool has_many_uses(NodeId id) const;
  void count_use(NodeId argument);
  [[nodiscard]] NodeId append(const Node& node);
  void make_room(Index& index);
  void enter(Index& index, std::uint32_t node);

  std::vector<Node> nodes_;
  std::vector<NodeId> variables_;  // by their numbers, as far as these are not many more than the nodes
  Index leaves_, operations_;      // constants and other variables; operations whose arguments all have many uses
};

/// The arguments of a node, arity(op) of them: `for (const NodeId a : arguments(node))`.
struct Arguments {
  std::array<NodeId, 3> ids;
  std::size_t count;
  [[nodiscard]] const NodeId* begin() const { return ids.data(); }
  [[nodiscard]] const NodeId* end() const { return ids.data() + count; }
};
[[nodiscard]] inline Arguments arguments(const Node& node) {
  return {{node.a, node.b, node.c}, arity(node.op)};
}

/// The nodes the roots are made of, each once, arguments before their use.
[[nodiscard]] std::vector<NodeId> reachable(const Graph& graph, std::span<const NodeId> roots);

/// Whether the expression contains the variable.
[[nodiscard]] bool depends_on(const Graph& graph, NodeId node, std::uint32_t variable);

/// The variables it contains, ascending.
[[nodiscard]] std::vector<std::uint32_t> variables_of(const Graph& graph, NodeId node);
[[nodiscard]] std::vector<std::uint32_t> variables_of(const Graph& graph, std::span<const NodeId> nodes);

/// The expression with every variable replaced that `replacement` gives a node for.
using Replacement = std::function<std::optional<NodeId>(std::uint32_t variable)>;
[[nodiscard]] NodeId substitute(Graph& graph, NodeId node, const Replacement& replacement);
[[nodiscard]] NodeId substitute(Graph& graph, NodeId node, std::uint32_t variable, NodeId replacement);

/// The same operation on the images of its arguments.
[[nodiscard]] NodeId with_arguments(Graph& graph, NodeId node, const std::function<NodeId(NodeId)>& image);

/// node = coefficient*variable + remainder, neither of which contains the variable.
struct Linear {
  NodeId coefficient, remainder;
};
[[nodiscard]] std::optional<Linear> linear_in(Graph& graph, NodeId node, std::uint32_t variable);

/// One row for each of `residuals`: what stands before each of `unknowns`, and last what is left without them; if all
/// are linear in all of them together.
using LinearRows = std::vector<std::vector<NodeId>>;
[[nodiscard]] std::optional<LinearRows> linear_rows(Graph& graph, std::span<const NodeId> residuals,
                                                    std::span<const std::uint32_t> unknowns);

/// The values of the unknowns at which every one of the residuals is zero (accelerations coupled through a mass
/// matrix); nothing where the matrix is singular. Elimination without exchange for size: meant for a handful. What
/// `vanishes` says of is divided by only where nothing else is left.
using Vanishes = std::function<bool(NodeId)>;
[[nodiscard]] std::optional<std::vector<NodeId>> solve_linear(Graph& graph, LinearRows rows,
                                                              const Vanishes& vanishes = {});
[[nodiscard]] std::optional<std::vector<NodeId>> solve_linear(Graph& graph, std::span<const NodeId> residuals,
                                                              std::span<const std::uint32_t> unknowns);

/// The number the expression has at these values of the variables. For single numbers; a Tape is for many.
/// `table` computes interp and its slope; without it they are NaN.
using TableLookup = std::function<double(std::uint32_t table, double x, bool slope)>;
[[nodiscard]] double evaluate(const Graph& graph, NodeId node, std::span<const double> variables,
                              const TableLookup& table = {});
/// Of many at once: what they share is computed once.
[[nodiscard]] std::vector<double> evaluate(const Graph& graph, std::span<const NodeId> nodes,
                                           std::span<const double> variables, const TableLookup& table = {});

/// The expression as a model would write it, cut off after about `longest` characters.
using VariableName = std::function<std::string(std::uint32_t variable)>;
[[nodiscard]] std::string to_text(const Graph& graph, NodeId node, const VariableName& name,
                                  std::size_t longest = 2000);

}  // namespace continuo::model
