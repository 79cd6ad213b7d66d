// continuo/language/check/expressions/translator.cpp
// From an expression of the text to a node, with its unit checked on the way.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>

namespace continuo::model::detail {

namespace {

/// The parser allows expressions 500 operations tall; the stack holds a few of these on top of each other.
constexpr std::size_t deepest = 1200;

Op operation(ast::BinaryOperator op) {
  switch (op) {
    case ast::BinaryOperator::add:
      return Op::add;
    case ast::BinaryOperator::subtract:
      return Op::subtract;
    case ast::BinaryOperator::multiply:
      return Op::multiply;
    case ast::BinaryOperator::divide:
      return Op::divide;
    case ast::BinaryOperator::power:
      return Op::power;
    case ast::BinaryOperator::less:
    case ast::BinaryOperator::greater:
      return Op::less;
    case ast::BinaryOperator::less_equal:
    case ast::BinaryOperator::greater_equal:
      return Op::less_equal;
    case ast::BinaryOperator::equal:
      return Op::equal;
    case ast::BinaryOperator::not_equal:
      return Op::not_equal;
    case ast::BinaryOperator::logical_and:
      return Op::logical_and;
    case ast::BinaryOperator::logical_or:
      return Op::logical_or;
  }
  return Op::add;
}

/// The dimension, had degC and degF the zero of K.
Dimension with_one_zero(const Measured& measured) {
  constexpr std::size_t kelvin = 4;
  Dimension dimension = measured.unit.dimension();
  for (std::size_t scale = Dimension::count - 2; scale < Dimension::count; ++scale) {
    dimension.exponent[kelvin] += std::exchange(dimension.exponent[scale], 0);
  }
  return dimension;
}

bool differ_in_zero(const Measured& a, const Measured& b) {
  return a.is_known() && b.is_known() && with_one_zero(a) == with_one_zero(b);
}

bool swaps(ast::BinaryOperator op) {
  return op == ast::BinaryOperator::greater || op == ast::BinaryOperator::greater_equal;
}

}  // namespace

Value Checker::of_number(double value) {
  return {model_.graph.constant(value), Measured::number()};
}

Value Checker::bad() {
  return {.node = model_.graph.constant(0), .bad = true};
}

bool Checker::want_number(const ast::Expression& text, Value& value) {
  if (value.condition && !value.bad) {
    fail("E217", text.span, "a number is wanted here", fmt::format("{} is a condition", quote(text.span)),
         "choose a number by it: if " + std::string(source_.slice(text.span)) + " then 1 else 0");
    value = bad();
  }
  return !value.bad;
}

/// Both are looked at: two mistakes are two messages.
bool Checker::want_numbers(Term& a, Term& b) {
  const bool first = want_number(a.text, a.value);
  return want_number(b.text, b.value) && first;
}

bool Checker::want_condition(const ast::Expression& text, Value& value) {
  if (!value.condition && !value.bad) {
    fail("E217", text.span, "a condition is wanted here", fmt::format("{} is a number", quote(text.span)),
         "compare it with something, as in x > 0");
    value = bad();
  }
  return !value.bad;
}

Value Checker::elaborate(const ast::Expression& expression, Scope& scope) {
  if (scope.depth >= deepest) {
    fail("E221", expression.span, "definitions lean on each other too deeply", {}, "define names above their use");
    return bad();
  }
  ++scope.depth;
  Value value = elaborate_node(expression, scope);
  --scope.depth;
  return value;
}

Value Checker::elaborate_node(const ast::Expression& expression, Scope& scope) {
  return std::visit(
      [&](const auto& node) -> Value {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Number>) {
          return of_number(node.value);
        } else if constexpr (std::is_same_v<T, ast::Name>) {
          return lookup(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Unary>) {
          return unary(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Binary>) {
          return binary(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Call>) {
          return call(node, expression.span, scope);
        } else if constexpr (std::is_same_v<T, ast::Conditional>) {
          return conditional(node, expression.span, scope);
        } else if constexpr (std::is_same_v<T, ast::Quantity>) {
          return quantity(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Sum>) {
          return sum(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Missing>) {
          return bad();  // the parser has reported it, and no model is made of a text with errors
        } else {
          fail("E217", expression.span, "a number is wanted here",
               std::is_same_v<T, ast::Text> ? "this is a text" : "this is a list");
          return bad();
        }
      },
      expression.node);
}

Value Checker::unary(const ast::Unary& node, Scope& scope) {
  Value value = elaborate(*node.operand, scope);
  if (node.op == ast::UnaryOperator::negate) {
    if (want_number(*node.operand, value)) value.node = model_.graph.negate(value.node);
  } else if (want_condition(*node.operand, value)) {
    value.node = model_.graph.apply(Op::logical_not, value.node);
  }
  return value;
}

Value Checker::binary(const ast::Binary& node, Scope& scope) {
  Term a{*node.left, elaborate(*node.left, scope)}, b{*node.right, elaborate(*node.right, scope)};
  const Span sides = cover(a.text.span, b.text.span);  // without the brackets round them
  const Op op = operation(node.op);
  Graph& g = model_.graph;
  if (op == Op::logical_and || op == Op::logical_or) {
    const bool left = want_condition(a.text, a.value), right = want_condition(b.text, b.value);
    return left && right ? Value{.node = g.apply(op, a.value.node, b.value.node), .condition = true} : bad();
  }
  if (!want_numbers(a, b)) return bad();
  switch (op) {
    case Op::multiply:
      return {g.multiply(a.value.node, b.value.node), product(a.value.measured, b.value.measured)};
    case Op::divide:
      return {g.divide(a.value.node, b.value.node), quotient(a.value.measured, b.value.measured)};
    case Op::power:
      return raise(a, b, sides);
    default:
      break;
  }
  if (!align(a, b, sides, scope)) return bad();
  if (op == Op::add || op == Op::subtract) {
    return {g.apply(op, a.value.node, b.value.node), common(a.value.measured, b.value.measured)};
  }
  const bool swap = swaps(node.op);
  const NodeId left = swap ? b.value.node : a.value.node, right = swap ? a.value.node : b.value.node;
  return {.node = g.apply(op, left, right), .condition = true};
}

/// Brings b to the unit of a; false after saying that they do not fit.
bool Checker::align(const Term& a, Term& b, Span span, Scope& scope) {
  const auto factor = factor_between(b.value.measured, a.value.measured);
  if (factor) {
    if (*factor != 1) {
      b.value.node = model_.graph.multiply(b.value.node, model_.graph.constant(*factor));
      b.value.measured = a.value.measured;
    }
    return true;
  }
  std::string help = repair(b, a.value.measured, scope);
  if (help.empty()) help = repair(a, b.value.measured, scope);
  if (help.empty() && differ_in_zero(a.value.measured, b.value.measured)) {
    help = "degC and degF count from another zero than K: use K throughout";
  }
  fail("E201", span, "units do not match",
       fmt::format("{} is {}, {} is {}", quote(a.text.span), unit_text(a.value.measured), quote(b.text.span),
                   unit_text(b.value.measured)),
       std::move(help));
  return false;
}

Value Checker::raise(const Term& base, const Term& exponent, Span span) {
  const Value power_value = pure_number(exponent, "^");
  if (power_value.bad) return bad();
  const NodeId node = model_.graph.power(base.value.node, power_value.node);
  const Measured& measured = base.value.measured;
  if (!measured.is_known()) {
    const bool both = measured.is_number() && power_value.measured.is_number();
    return {node, both ? Measured::number() : Measured::unknown()};
  }
  if (measured.unit == Unit()) return {node, Measured::known(Unit())};
  const auto number = model_.graph.value(power_value.node);
  if (!number) {
    fail("E204", exponent.text.span, "the exponent of a quantity with a unit must be a number",
         fmt::format("{} is {}, and {} may change", quote(base.text.span), unit_text(measured),
                     quote(exponent.text.span)),
         "divide the base by a quantity of the same unit");
    return bad();
  }
  const auto unit = continuo::model::power(measured.unit, *number);
  if (unit) return {node, Measured::known(*unit)};
  fail("E204", span, "this power has no unit",
       fmt::format("{} is {}, and {:g} is no simple fraction", quote(base.text.span), unit_text(measured), *number));
  return bad();
}

Value Checker::conditional(const ast::Conditional& node, Span span, Scope& scope) {
  Value condition = elaborate(*node.condition, scope);
  Term yes{*node.when_true, elaborate(*node.when_true, scope)},
      no{*node.when_false, elaborate(*node.when_false, scope)};
  if (!want_condition(*node.condition, condition)) return bad();
  if (yes.value.bad || no.value.bad) return bad();
  const bool conditions = yes.value.condition && no.value.condition;
  if (!conditions && !want_numbers(yes, no)) return bad();
  if (!align(yes, no, span, scope)) return bad();
  return {.node = model_.graph.select(condition.node, yes.value.node, no.value.node),
          .measured = common(yes.value.measured, no.value.measured),
          .condition = conditions};
}

std::optional<Unit> Checker::unit_of(const ast::Unit& unit) {
  ParsedUnit parsed = parse_unit(unit.text);
  if (parsed.unit) return parsed.unit;
  fail("E203", unit.span, "this is not a unit", parsed.problem,
       parsed.suggestion.empty() ? std::string() : fmt::format("did you mean [{}]?", parsed.suggestion));
  return std::nullopt;
}

/// `3 [m]` states a unit, `a*b [m]` also converts to it.
Value Checker::quantity(const ast::Quantity& node, Scope& scope) {
  Value value = elaborate(*node.value, scope);
  const auto unit = unit_of(node.unit);
  if (!unit || !want_number(*node.value, value)) return bad();
  const Measured stated = Measured::known(*unit);
  const auto factor = factor_between(value.measured, stated);
  if (!factor) {
    fail("E201", cover(node.value->span, node.unit.span), "units do not match",
         fmt::format("{} is {}, not {}", quote(node.value->span), unit_text(value.measured), to_text(*unit)));
    return bad();
  }
  value.node = model_.graph.multiply(value.node, model_.graph.constant(*factor));
  value.measured = stated;
  return value;
}

Value Checker::sum(const ast::Sum& node, Scope& scope) {
  Value total = of_number(0);
  bool first = true;
  for_each_term(node, scope, [&] {
    if (total.bad) return;
    Term term{*node.body, elaborate(*node.body, scope)};
    if (!want_number(term.text, term.value)) {
      total = bad();
    } else if (first) {
      total = term.value;
      first = false;
    } else if (align({*node.body, total}, term, node.body->span, scope)) {
      total = {model_.graph.add(total.node, term.value.node), common(total.measured, term.value.measured)};
    } else {
      total = bad();
    }
  });
  return total;
}

}  // namespace continuo::model::detail
