// continuo/language/check/expressions/indices.hpp
// Indices: the numbers in `u[i-1]`, `for i in 1..N` and the terms of a sum written out.
#pragma once
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include <continuo/language/check/names/indexed_name.hpp>
#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

class Expressions;
class Report;
struct Workspace;

/// More members of families and terms of sums than this are a mistake, or a job for C++: a member with its equation
/// takes about a kilobyte, and a browser has four gigabytes.
inline constexpr std::size_t most_written_out = sizeof(void*) < 8 ? 500'000 : 4'000'000;

class Indices {
 public:
  explicit Indices(Expressions& expressions);

  [[nodiscard]] std::optional<long> whole_number(const ast::Expression& expression, Scope& scope,
                                                 std::string_view what) const;
  [[nodiscard]] std::optional<std::pair<long, long>> bounds(const ast::Range& range, Scope& scope) const;
  [[nodiscard]] std::optional<IndexValues> indices_of(const ast::Name& name, Scope& scope) const;
  /// The name as symbols have it: u[3], ball.x.
  [[nodiscard]] std::optional<IndexedName> name_of(const ast::Name& name, Scope& scope) const;
  /// One more member or term; false after saying that there are too many.
  [[nodiscard]] bool count_written_out(Span span) const;

  /// Calls body with the index in the scope, for each of its values, and tells it how many values come after this one;
  /// stops where the model becomes too large. False where the ends of the range are wrong.
  template <class Body>
  bool for_each_index(const ast::Identifier& index, const ast::Range& range, Scope& scope, Body&& body) const {
    const auto ends = bounds(range, scope);
    if (!ends) return false;
    if (!has_room(ends->first, ends->second, range.span)) return true;
    Index mine{index.text, 0, scope.innermost};
    scope.innermost = &mine;
    for (long i = ends->first; i <= ends->second && count_written_out(range.span); ++i) {
      mine.value = i;
      body(static_cast<std::size_t>(ends->second - i));
    }
    scope.innermost = mine.outer;
    return true;
  }

  /// The same where the body keeps the instance: every value of the index has an Index of its own, that stays.
  template <class Body>
  bool for_each_kept_index(const ast::Identifier& index, const ast::Range& range, Scope& scope, Body&& body) const {
    return for_each_index(index, range, scope, [&](std::size_t left) {
      const Index* const mine = scope.innermost;
      scope.innermost = keep(*mine);
      body(left);
      scope.innermost = mine;
    });
  }

  /// The terms of a sum that its condition lets through.
  template <class Body>
  void for_each_term(const ast::Sum& sum, Scope& scope, Body&& body) const {
    for_each_index(sum.index, sum.range, scope, [&](std::size_t) {
      if (is_wanted(sum, scope)) body();
    });
  }

 private:
  [[nodiscard]] bool has_room(long first, long last, Span span) const;
  void refuse_size(Span span) const;
  [[nodiscard]] const Index* keep(const Index& index) const;
  [[nodiscard]] bool is_wanted(const ast::Sum& sum, Scope& scope) const;

  Expressions& expressions_;
  Workspace& workspace_;
  Report& report_;
};

}  // namespace continuo::model::detail
