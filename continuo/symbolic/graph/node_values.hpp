// continuo/symbolic/graph/node_values.hpp
// One value for each node of an expression. The nodes of a small expression may lie anywhere in a graph of millions, so
// the size is that of the expression, not of the graph.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model {

template <class T>
class NodeValues {
 public:
  /// `nodes`: ascending, as `reachable` returns them; they must outlive this.
  explicit NodeValues(std::span<const NodeId> nodes)
      : nodes_(nodes), is_dense_(!nodes.empty() && range(nodes) <= 8 * nodes.size()) {
    values_.resize(is_dense_ ? range(nodes) : nodes.size());
  }

  [[nodiscard]] T& operator[](NodeId id) { return values_[place(id)]; }
  [[nodiscard]] const T& operator[](NodeId id) const { return values_[place(id)]; }

 private:
  static std::size_t range(std::span<const NodeId> nodes) { return nodes.back().index - nodes.front().index + 1; }
  [[nodiscard]] std::size_t place(NodeId id) const {
    if (is_dense_) return id.index - nodes_.front().index;
    return static_cast<std::size_t>(std::ranges::lower_bound(nodes_, id) - nodes_.begin());
  }

  std::span<const NodeId> nodes_;
  bool is_dense_;
  std::vector<T> values_;
};

}  // namespace continuo::model
