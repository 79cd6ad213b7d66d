// continuo/symbolic/graph/derivative.hpp
// Exact derivatives of expressions. Where a function has a kink (abs, min, if) the derivative is that of the
// branch taken; floor, sign and comparisons have derivative 0.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model {

/// d node / d variable.
[[nodiscard]] NodeId differentiate(Graph& graph, NodeId node, std::uint32_t variable);

/// One entry that is not zero everywhere: d outputs[row] / d variables[column].
struct JacobianEntry {
  std::uint32_t row, column;
  NodeId value;
};

/// Every such entry, row by row, columns ascending: values and sparsity in one.
[[nodiscard]] std::vector<JacobianEntry> jacobian(Graph& graph, std::span<const NodeId> outputs,
                                                  std::span<const std::uint32_t> variables);

}  // namespace continuo::model
