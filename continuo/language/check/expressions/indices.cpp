// continuo/language/check/expressions/indices.cpp
// Nearly every index is `3`, `i` or `i-1` and found without a detour through the graph.
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

namespace {

/// `3`, `i`, `i+1`, `i-1` without a detour through the graph: nearly every index looks like one of these.
std::optional<long> quick_index(const ast::Expression& expression, const Scope& scope) {
  if (const auto* number = std::get_if<ast::Number>(&expression.node)) {
    if (std::abs(number->value) > 1e9 || number->value != std::floor(number->value)) return std::nullopt;
    return static_cast<long>(number->value);
  }
  if (const auto* name = std::get_if<ast::Name>(&expression.node)) {
    const Index* index = name->primes == 0 && name->indices.empty() ? scope.find_index(name->text) : nullptr;
    return index ? std::optional(index->value) : std::nullopt;
  }
  const auto* binary = std::get_if<ast::Binary>(&expression.node);
  if (!binary || (binary->op != ast::BinaryOperator::add && binary->op != ast::BinaryOperator::subtract)) return {};
  const auto left = quick_index(*binary->left, scope), right = quick_index(*binary->right, scope);
  if (!left || !right) return std::nullopt;
  return binary->op == ast::BinaryOperator::add ? *left + *right : *left - *right;
}

}  // namespace

Indices::Indices(Expressions& expressions)
    : expressions_(expressions), workspace_(expressions.workspace), report_(expressions.report) {}

std::optional<long> Indices::whole_number(const ast::Expression& expression, Scope& scope,
                                          std::string_view what) const {
  if (const auto quick = quick_index(expression, scope)) return quick;
  const auto value = expressions_.values.constant(expression, scope, Measured::unknown(), what);
  if (!value) return std::nullopt;
  const double rounded = std::round(*value);
  if (!(std::abs(*value - rounded) < 1e-9) || std::abs(rounded) > 1e9) {
    report_.fail("E219", expression.span, fmt::format("{} is a whole number", what),
                 fmt::format("this is {:g}", *value));
    return std::nullopt;
  }
  return static_cast<long>(rounded);
}

std::optional<std::pair<long, long>> Indices::bounds(const ast::Range& range, Scope& scope) const {
  constexpr std::string_view what = "the end of a range";
  const auto first = whole_number(*range.first, scope, what), last = whole_number(*range.last, scope, what);
  if (!first || !last) return std::nullopt;
  return std::pair{*first, *last};
}

std::optional<IndexValues> Indices::indices_of(const ast::Name& name, Scope& scope) const {
  IndexValues indices;
  if (name.indices.size() > IndexValues::most) {
    report_.fail("E219", name.span, fmt::format("a name has at most {} indices", IndexValues::most),
                 fmt::format("here are {}", name.indices.size()));
    return std::nullopt;
  }
  for (const ast::Expression& index : name.indices) {
    const auto value = whole_number(index, scope, "an index");
    if (!value) return std::nullopt;
    indices.push_back(*value);
  }
  return indices;
}

std::optional<IndexedName> Indices::name_of(const ast::Name& name, Scope& scope) const {
  const auto indices = indices_of(name, scope);
  if (!indices) return std::nullopt;
  return IndexedName{name.text, *indices, name.member};
}

const Index* Indices::keep(const Index& index) const {
  return &workspace_.kept_indices.emplace_back(index);
}

bool Indices::is_wanted(const ast::Sum& sum, Scope& scope) const {
  if (!sum.condition) return true;
  const auto holds =
      expressions_.values.constant(**sum.condition, scope, Measured::unknown(), "the condition of a sum");
  return holds && *holds != 0;
}

bool Indices::count_written_out(Span span) const {
  std::size_t& count = workspace_.written_out;
  if (++count <= most_written_out) return true;
  if (count == most_written_out + 1) refuse_size(span);
  return false;
}

/// A range that is too long is refused before its members are written out.
bool Indices::has_room(long first, long last, Span span) const {
  std::size_t& count = workspace_.written_out;
  if (count > most_written_out) return false;  // said already
  if (last < first || static_cast<std::size_t>(last - first) < most_written_out - count) return true;
  count = most_written_out + 1;
  refuse_size(span);
  return false;
}

void Indices::refuse_size(Span span) const {
  report_.fail("E221", span, "the model is too large",
               fmt::format("more than {} members of families and terms of sums", most_written_out),
               "each takes about 1 kB of memory: take fewer points, or write this system in C++");
}

}  // namespace continuo::model::detail
