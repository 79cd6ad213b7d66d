// continuo/language/check/expressions/indices.hpp
// `for i in 1..N` and the terms of a sum, one after the other.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/language/check/names/checker.hpp>

namespace continuo::model::detail {

/// "u[3]", "a[1,2]".
std::string indexed(std::string_view name, const std::vector<long>& indices);

/// "this is time" of t, "3.14159..." of pi, else nothing.
std::string_view meaning_of_its_own(std::string_view name);

/// Calls body() with the index in the scope, for each of its values; stops where the model becomes too large.
/// False where the ends of the range are wrong.
template <class Body>
bool Checker::for_each_index(const ast::Identifier& index, const ast::Range& range, Scope& scope, Body&& body) {
  const auto ends = bounds(range, scope);
  if (!ends) return false;
  scope.indices.push_back({index.text, 0});
  const std::size_t place = scope.indices.size() - 1;
  for (long i = ends->first; i <= ends->second && count_written_out(range.span); ++i) {
    scope.indices[place].value = i;
    body();
  }
  scope.indices.pop_back();
  return true;
}

/// The terms of a sum that its condition lets through.
template <class Body>
void Checker::for_each_term(const ast::Sum& sum, Scope& scope, Body&& body) {
  for_each_index(sum.index, sum.range, scope, [&] {
    if (sum.condition) {
      const auto holds = constant(**sum.condition, scope, Measured::unknown(), "the condition of a sum");
      if (!holds || *holds == 0) return;
    }
    body();
  });
}

}  // namespace continuo::model::detail
