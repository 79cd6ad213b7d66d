// continuo/symbolic/tape/tape_steady.hpp
// Before a tape is compiled: factors that depend on steady variables alone are gathered. Internal to the tape.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model::tape {

/// An own graph with just the nodes the outputs need.
struct Prepared {
  Graph graph;
  std::vector<NodeId> outputs;
  std::vector<bool> steady;  // by node: made of steady variables and constants alone
};

/// `-k/m*x` becomes `(-k/m)*x`, `x/m*y/l` becomes `(1/m/l)*(x*y)`: one multiplication where steady factors were
/// spread over the product. `x/r, y/r` becomes `x*(1/r), y*(1/r)`. Results may differ from those of the text in the
/// last digit.
[[nodiscard]] Prepared gather_steady_factors(const Graph& graph, std::span<const NodeId> outputs,
                                             const std::function<bool(std::uint32_t variable)>& is_steady);

}  // namespace continuo::model::tape
