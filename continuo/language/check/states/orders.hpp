// continuo/language/check/states/orders.hpp
// Which variables have derivatives, and of which order: read off the primes in equations and conditions.
#pragma once
#include <optional>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

/// Fills Declarations::bases, ::equations and ::conditions in the order of the text.
class StateOrders {
 public:
  StateOrders(Declarations& declared, Expressions& expressions)
      : declared_(declared), expressions_(expressions), report_(expressions.report) {}

  void see_equation(const ast::Equation& equation, Scope& scope, Span span);
  void see_condition(const ast::Condition& condition, Scope& scope, Span span);
  /// After the last equation: primes on the right of explicit ones may raise an order, and what has conditions only
  /// has the order that these ask for.
  void finish();

 private:
  std::optional<std::size_t> see_base(const ast::Name& name, Scope& scope, int order);
  void see_primes(const ast::Expression& expression, Scope& scope);
  void sort_conditions();

  Declarations& declared_;
  Expressions& expressions_;
  Report& report_;
};

}  // namespace continuo::model::detail
