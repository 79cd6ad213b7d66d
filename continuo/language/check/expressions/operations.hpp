// continuo/language/check/expressions/operations.hpp
// The result of operators: a node and its unit. Knows no names and no scopes.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include <continuo/language/check/names/report.hpp>
#include <continuo/language/check/names/scope.hpp>
#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model::detail {

class Operations {
 public:
  /// What may have been meant by a term that should have this unit; empty where nothing comes to mind.
  using Repair = std::function<std::string(const Term&, const Measured&)>;

  Operations(Graph& graph, Report& report) : graph_(graph), report_(report) {}

  [[nodiscard]] Value of_number(double value) const { return {graph_.constant(value), Measured::number()}; }
  [[nodiscard]] Value bad() const { return {.node = graph_.constant(0), .bad = true}; }
  /// These make the value bad, and say so, where it is of the other sort.
  bool want_number(const ast::Expression& text, Value& value) const;
  [[nodiscard]] bool want_numbers(Term& a, Term& b) const;
  bool want_condition(const ast::Expression& text, Value& value) const;

  [[nodiscard]] Value logical(Op op, Term a, Term b) const;
  /// Brings b to the unit of a; false after saying that they do not fit.
  [[nodiscard]] bool align(const Term& a, Term& b, Span span, const Repair& repair) const;
  [[nodiscard]] Value raise(const Term& base, const Term& exponent, Span span) const;
  [[nodiscard]] Value root(std::string_view name, const Value& x, Span span) const;
  /// A pure number for a function that takes nothing else: degrees become radians, per cent fractions.
  [[nodiscard]] Value pure_number(const Term& argument, std::string_view function) const;
  /// Converted by a unit that is written behind it: `3 [m]` states it, `a*b [m]` also converts to it.
  [[nodiscard]] Value in_stated_unit(const ast::Expression& text, Value value, const Unit& unit, Span span) const;
  /// The node in this unit; E201 where it does not fit `what`.
  [[nodiscard]] NodeId in_unit(const ast::Expression& text, const Value& value, const Measured& wanted,
                               std::string_view what) const;

 private:
  Graph& graph_;
  Report& report_;
};

/// The node of a function of one argument, of two; names as in functions.hpp.
[[nodiscard]] NodeId function_of_one(Graph& graph, std::string_view name, NodeId x);
[[nodiscard]] NodeId function_of_two(Graph& graph, std::string_view name, NodeId a, NodeId b);

}  // namespace continuo::model::detail
