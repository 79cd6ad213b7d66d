// Keeps each expression once, and writes those that are read once and short into their readers.
#include <utility>

#include <continuo/symbolic/native/c_expressions.hpp>
#include <continuo/symbolic/native/c_operations.hpp>
#include <continuo/symbolic/native/tape_values.hpp>

namespace continuo::model {

namespace {

constexpr std::size_t longest_expression = 100;

std::size_t operands_of(tape::Code code) {
  return is_table(code) ? 1 : tape::operands(code);
}

}  // namespace

CExpressions::Id CExpressions::leaf(std::string text) {
  const auto [place, is_new] = leaves_.try_emplace(std::move(text), static_cast<Id>(nodes_.size()));
  if (is_new) nodes_.push_back({.text = place->first});
  return place->second;
}

CExpressions::Id CExpressions::operation(tape::Code code, std::uint32_t table, std::array<Id, 4> operands) {
  const auto [place, is_new] = operations_.try_emplace(Key{code, table, operands}, static_cast<Id>(nodes_.size()));
  if (!is_new) return place->second;
  for (std::size_t k = 0; k < operands_of(code); ++k) ++nodes_[operands[k]].readers;
  nodes_.push_back({.text = {}, .code = code, .table = table, .operands = operands});
  return place->second;
}

void CExpressions::name_parts(const std::function<std::string(const std::string&)>& name) {
  for (Node& node : nodes_) {
    if (node.code == tape::Code::stop) continue;
    node.text = text_of(node);
    const bool is_long = node.text.size() > longest_expression && !node.is_whole;
    if (node.readers > 1 || is_long) node.text = name(node.text);
  }
}

std::string CExpressions::text_of(const Node& node) const {
  std::array<std::string, 4> operand;
  for (std::size_t k = 0; k < operands_of(node.code); ++k) operand[k] = nodes_[node.operands[k]].text;
  if (is_table(node.code)) return table_text(node.code, node.table, operand[0], in_lanes_);
  std::string text = fused_ ? fused_operation_text(node.code, operand, in_lanes_) : std::string();
  return text.empty() ? operation_text(node.code, std::move(operand), in_lanes_) : text;
}

}  // namespace continuo::model
