// continuo/symbolic/tape/tape_steady.cpp
// Gathers factors of steady variables, to be computed once instead of at each evaluation.
#include <algorithm>

#include <continuo/symbolic/tape/tape_steady.hpp>

namespace continuo::model::tape {

namespace {

/// factor*rest; an invalid node stands for 1.
struct Split {
  NodeId factor{}, rest{};
};

class Gatherer {
 public:
  Gatherer(const Graph& graph, std::span<const NodeId> outputs, const std::function<bool(std::uint32_t)>& is_steady)
      : from_(graph), is_steady_(is_steady), nodes_(reachable(graph, outputs)) {
    const std::size_t top = nodes_.empty() ? 0 : nodes_.back().index + 1;
    uses_.resize(top);
    split_.resize(top);
    for (const NodeId output : outputs) ++uses_[output.index];
    for (const NodeId id : nodes_)
      for (const NodeId argument : arguments(from_[id])) ++uses_[argument.index];
  }

  Prepared gather(std::span<const NodeId> outputs) {
    for (const NodeId id : nodes_) split_[id.index] = split(from_[id]);
    Prepared prepared;
    for (const NodeId output : outputs) prepared.outputs.push_back(whole(split_[output.index]));
    prepared.steady = steadiness(to_);
    prepared.graph = std::move(to_);
    return prepared;
  }

 private:
  std::vector<bool> steadiness(const Graph& graph) const {
    std::vector<bool> steady(graph.size());
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
      const Node& node = graph[NodeId{i}];
      const auto all = arguments(node);
      steady[i] = node.op == Op::variable ? is_steady_(node.number)
                                          : std::ranges::all_of(all, [&](NodeId a) { return steady[a.index]; });
    }
    return steady;
  }

  NodeId times(NodeId a, NodeId b) { return !a.valid() ? b : !b.valid() ? a : to_.multiply(a, b); }
  NodeId over(NodeId a, NodeId b) { return !b.valid() ? a : to_.divide(a.valid() ? a : to_.constant(1), b); }
  NodeId whole(const Split& split) {
    const NodeId product = times(split.factor, split.rest);
    return product.valid() ? product : to_.constant(1);
  }
  NodeId whole(NodeId id) { return whole(split_[id.index]); }

  /// A product used in several places stays one, lest it be computed several times.
  Split part(NodeId id) {
    const Split& mine = split_[id.index];
    return !mine.rest.valid() || uses_[id.index] == 1 ? mine : Split{.rest = whole(mine)};
  }

  Split split(const Node& node) {
    switch (node.op) {
      case Op::constant:
        return {.factor = to_.constant(node.value)};
      case Op::variable: {
        const NodeId variable = to_.variable(node.number);
        return is_steady_(node.number) ? Split{.factor = variable} : Split{.rest = variable};
      }
      case Op::multiply: {
        const Split a = part(node.a), b = part(node.b);
        return {.factor = times(a.factor, b.factor), .rest = times(a.rest, b.rest)};
      }
      case Op::divide:
        return quotient(part(node.a), part(node.b));
      case Op::smooth:  // says nothing about its value
        return part(node.a);
      case Op::negate: {
        const Split a = part(node.a);
        return a.factor.valid() ? Split{.factor = to_.negate(a.factor), .rest = a.rest}
                                : Split{.rest = to_.negate(a.rest)};
      }
      default:
        return rebuilt(node);
    }
  }

  Split quotient(const Split& a, const Split& b) {
    if (!a.rest.valid() && b.rest.valid()) return {.rest = over(over(a.factor, b.factor), b.rest)};
    return {.factor = b.factor.valid() ? over(a.factor, b.factor) : a.factor, .rest = over(a.rest, b.rest)};
  }

  Split rebuilt(const Node& node) {
    NodeId made;
    const bool is_table = node.op == Op::interpolate || node.op == Op::interpolate_slope;
    bool steady = true;
    for (const NodeId argument : arguments(node)) steady = steady && !split_[argument.index].rest.valid();
    if (is_table) {
      made = node.op == Op::interpolate ? to_.interpolate(node.number, whole(node.a))
                                        : to_.interpolate_slope(node.number, whole(node.a));
    } else if (node.op == Op::hypotenuse) {  // its squares may be needed elsewhere, its own square is their sum
      const NodeId a = whole(node.a), b = whole(node.b);
      made = to_.apply(Op::square_root, to_.add(to_.multiply(a, a), to_.multiply(b, b)));
    } else if (arity(node.op) == 3) {
      made = to_.select(whole(node.a), whole(node.b), whole(node.c));
    } else if (arity(node.op) == 2) {
      made = to_.apply(node.op, whole(node.a), whole(node.b));
    } else {
      made = to_.apply(node.op, whole(node.a));
    }
    return steady ? Split{.factor = made} : Split{.rest = made};
  }

  const Graph& from_;
  const std::function<bool(std::uint32_t)>& is_steady_;
  Graph to_;
  std::vector<NodeId> nodes_;
  std::vector<std::uint32_t> uses_;
  std::vector<Split> split_;
};

}  // namespace

Prepared gather_steady_factors(const Graph& graph, std::span<const NodeId> outputs,
                               const std::function<bool(std::uint32_t variable)>& is_steady) {
  return Gatherer(graph, outputs, is_steady).gather(outputs);
}

}  // namespace continuo::model::tape
