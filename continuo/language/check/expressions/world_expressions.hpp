// continuo/language/check/expressions/world_expressions.hpp
// What expressions ask of a world: `ball.x`, `distance(ball, wall)`. world/ answers.
#pragma once
#include <continuo/language/check/names/report.hpp>
#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

class Expressions;

class WorldExpressions {
 public:
  virtual ~WorldExpressions() = default;
  /// `ball.x`, `grain[3].y'`, `ball.mass`, `world.kinetic`.
  [[nodiscard]] virtual Value member(const ast::Name& name, Scope& scope, Expressions& expressions) const = 0;
  [[nodiscard]] virtual bool is_query(const ast::Name& callee, const Scope& scope) const = 0;
  [[nodiscard]] virtual Value query(const ast::Call& node, Span span, Scope& scope, Expressions& expressions) const = 0;
};

/// E226: bodies are moved by forces, and the world is only looked at.
void refuse_equation_of_body(const ast::Name& name, Report& report);

}  // namespace continuo::model::detail
