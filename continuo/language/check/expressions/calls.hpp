// continuo/language/check/expressions/calls.hpp
// Calls: elementary functions, tables, and h(1) in checks and conditions.
#pragma once
#include <string_view>
#include <vector>

#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

class Expressions;
class Operations;
class Report;
struct Workspace;

class Calls {
 public:
  explicit Calls(Expressions& expressions);

  [[nodiscard]] Value call(const ast::Call& node, Span span, Scope& scope) const;

 private:
  [[nodiscard]] Value apply_function(std::string_view name, std::vector<Term>& arguments, Span span,
                                     Scope& scope) const;
  [[nodiscard]] Value interpolation(const ast::Call& node, Span span, Scope& scope) const;
  [[nodiscard]] Value sample(const ast::Call& node, Span span, Scope& scope) const;
  [[nodiscard]] Value unknown_function(const ast::Name& callee) const;

  Expressions& expressions_;
  Workspace& workspace_;
  Report& report_;
  const Operations& operations_;
};

}  // namespace continuo::model::detail
