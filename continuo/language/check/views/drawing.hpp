// continuo/language/check/views/drawing.hpp
// `draw { ... }`: shapes whose places are expressions.
#pragma once
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

class Drawing {
 public:
  /// `states`: of the model, to tell which points can be dragged.
  Drawing(Expressions& expressions, const std::vector<State>& states) : expressions_(expressions), states_(states) {}
  [[nodiscard]] std::vector<DrawItem> make();

 private:
  void add(const std::vector<ast::DrawItem>& items, Scope& scope);
  void add_shape(const ast::Shape& shape, Span span, Scope& scope);
  [[nodiscard]] bool depends_on_states(const DrawArgument& point) const;
  [[nodiscard]] NodeId drawn(const ast::Expression& expression, Scope& scope, bool of_point);
  [[nodiscard]] DrawArgument argument_of(const ast::Expression& expression, Scope& scope, bool of_point);

  Expressions& expressions_;
  const std::vector<State>& states_;
  Measured unit_ = Measured::unknown();  // of the first point that has one: of all that is drawn
  std::vector<DrawItem> made_;
};

}  // namespace continuo::model::detail
