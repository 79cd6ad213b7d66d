// continuo/language/check/expressions/translator.hpp
// From an expression of the text to a node, with its unit checked on the way.
#pragma once
#include <optional>

#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

class Expressions;
class Operations;
class Report;
struct Workspace;

class Translator {
 public:
  explicit Translator(Expressions& expressions);

  [[nodiscard]] Value translate(const ast::Expression& expression, Scope& scope) const;
  /// Brings b to the unit of a; false after saying that they do not fit, and what may have been meant.
  [[nodiscard]] bool align(const Term& a, Term& b, Span span, Scope& scope) const;
  /// What a node comes to that consists of numbers and of parameters that decide the size of a family: these change
  /// only when the model is read again.
  [[nodiscard]] std::optional<double> structural_number(NodeId node) const;

 private:
  [[nodiscard]] Value translate_node(const ast::Expression& expression, Scope& scope) const;
  [[nodiscard]] Value unary(const ast::Unary& node, Scope& scope) const;
  [[nodiscard]] Value binary(const ast::Binary& node, Scope& scope) const;
  [[nodiscard]] Value conditional(const ast::Conditional& node, Span span, Scope& scope) const;
  [[nodiscard]] Choice known_choice(NodeId condition) const;
  [[nodiscard]] Value quantity(const ast::Quantity& node, Scope& scope) const;
  [[nodiscard]] Value sum(const ast::Sum& node, Scope& scope) const;

  Expressions& expressions_;
  Workspace& workspace_;
  Report& report_;
  const Operations& operations_;
};

/// The operation that stands for an operator of the text; that of > and >= has its sides exchanged.
[[nodiscard]] Op operation_of(ast::BinaryOperator op);

}  // namespace continuo::model::detail
