// continuo/language/check/expressions/indices.cpp
// Indices: `for i in 1..N` written out, and the numbers in `u[i-1]`.
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>

namespace continuo::model::detail {

namespace {

const Index* find_index(const Scope& scope, std::string_view name) {
  for (std::size_t i = scope.indices.size(); i-- > 0;) {
    if (scope.indices[i].name == name) return &scope.indices[i];
  }
  return nullptr;
}

/// `3`, `i`, `i+1`, `i-1` without a detour through the graph: nearly every index looks like one of these.
std::optional<long> quick_index(const ast::Expression& expression, const Scope& scope) {
  if (const auto* number = std::get_if<ast::Number>(&expression.node)) {
    if (std::abs(number->value) > 1e9 || number->value != std::floor(number->value)) return std::nullopt;
    return static_cast<long>(number->value);
  }
  if (const auto* name = std::get_if<ast::Name>(&expression.node)) {
    const Index* index = name->primes == 0 && name->indices.empty() ? find_index(scope, name->text) : nullptr;
    return index ? std::optional(index->value) : std::nullopt;
  }
  const auto* binary = std::get_if<ast::Binary>(&expression.node);
  if (!binary || (binary->op != ast::BinaryOperator::add && binary->op != ast::BinaryOperator::subtract)) return {};
  const auto left = quick_index(*binary->left, scope), right = quick_index(*binary->right, scope);
  if (!left || !right) return std::nullopt;
  return binary->op == ast::BinaryOperator::add ? *left + *right : *left - *right;
}

}  // namespace

std::optional<long> Checker::whole_number(const ast::Expression& expression, Scope& scope, std::string_view what) {
  if (const auto quick = quick_index(expression, scope)) return quick;
  const auto value = constant(expression, scope, Measured::unknown(), what);
  if (!value) return std::nullopt;
  const double rounded = std::round(*value);
  if (!(std::abs(*value - rounded) < 1e-9) || std::abs(rounded) > 1e9) {
    fail("E219", expression.span, fmt::format("{} is a whole number", what), fmt::format("this is {:g}", *value));
    return std::nullopt;
  }
  return static_cast<long>(rounded);
}

std::optional<std::pair<long, long>> Checker::bounds(const ast::Range& range, Scope& scope) {
  constexpr std::string_view what = "the end of a range";
  const auto first = whole_number(*range.first, scope, what), last = whole_number(*range.last, scope, what);
  if (!first || !last) return std::nullopt;
  return std::pair{*first, *last};
}

std::optional<std::vector<long>> Checker::indices_of(const ast::Name& name, Scope& scope) {
  std::vector<long> indices;
  for (const ast::Expression& index : name.indices) {
    const auto value = whole_number(index, scope, "an index");
    if (!value) return std::nullopt;
    indices.push_back(*value);
  }
  return indices;
}

std::string indexed(std::string_view name, const std::vector<long>& indices) {
  std::string text(name);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    text += i == 0 ? '[' : ',';
    text += std::to_string(indices[i]);
  }
  if (!indices.empty()) text += ']';
  return text;
}

std::optional<std::string> Checker::key_of(const ast::Name& name, Scope& scope) {
  const std::string member = name.member.empty() ? std::string() : "." + name.member;
  if (name.indices.empty()) return name.text + member;
  const auto indices = indices_of(name, scope);
  if (!indices) return std::nullopt;
  return indexed(name.text, *indices) + member;
}

bool Checker::count_written_out(Span span) {
  if (++written_out_ <= most_written_out) return true;
  if (written_out_ > most_written_out + 1) return false;  // said already
  fail("E221", span, "the model is too large",
       fmt::format("more than {} members of families and terms of sums", most_written_out),
       "take fewer points, or write this system in C++");
  return false;
}

}  // namespace continuo::model::detail
