// continuo/language/check/expressions/operations.cpp
// Operators and elementary functions as nodes; E201, E202 and E204 where units do not fit.
#include <array>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/expressions/operations.hpp>

namespace continuo::model::detail {

namespace {

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

NodeId logarithm_with_root(Graph& g, NodeId x, double shift) {  // log(x + sqrt(x^2 + shift))
  const NodeId root = g.apply(Op::square_root, g.add(g.multiply(x, x), g.constant(shift)));
  return g.apply(Op::logarithm, g.add(x, root));
}

}  // namespace

bool Operations::want_number(const ast::Expression& text, Value& value) const {
  if (value.condition && !value.bad) {
    report_.fail("E217", text.span, "a number is wanted here",
                 fmt::format("{} is a condition", report_.quote(text.span)),
                 "choose a number by it: if " + std::string(report_.slice(text.span)) + " then 1 else 0");
    value = bad();
  }
  return !value.bad;
}

/// Both are looked at: two mistakes are two messages.
bool Operations::want_numbers(Term& a, Term& b) const {
  const bool first = want_number(a.text, a.value);
  return want_number(b.text, b.value) && first;
}

bool Operations::want_condition(const ast::Expression& text, Value& value) const {
  if (!value.condition && !value.bad) {
    report_.fail("E217", text.span, "a condition is wanted here",
                 fmt::format("{} is a number", report_.quote(text.span)), "compare it with something, as in x > 0");
    value = bad();
  }
  return !value.bad;
}

/// Brings b to the unit of a; false after saying that they do not fit.
bool Operations::align(const Term& a, Term& b, Span span, const Repair& repair) const {
  const auto factor = factor_between(b.value.measured, a.value.measured);
  if (factor) {
    if (*factor != 1) {
      b.value.node = graph_.multiply(b.value.node, graph_.constant(*factor));
      b.value.measured = a.value.measured;
    }
    return true;
  }
  std::string help = repair(b, a.value.measured);
  if (help.empty()) help = repair(a, b.value.measured);
  if (help.empty() && differ_in_zero(a.value.measured, b.value.measured)) {
    help = "degC and degF count from another zero than K: use K throughout";
  }
  report_.fail("E201", span, "units do not match",
               fmt::format("{} is {}, {} is {}", report_.quote(a.text.span), unit_text(a.value.measured),
                           report_.quote(b.text.span), unit_text(b.value.measured)),
               std::move(help));
  return false;
}

Value Operations::raise(const Term& base, const Term& exponent, Span span) const {
  const Value power_value = pure_number(exponent, "^");
  if (power_value.bad) return bad();
  const NodeId node = graph_.power(base.value.node, power_value.node);
  const Measured& measured = base.value.measured;
  if (!measured.is_known()) {
    const bool both = measured.is_number() && power_value.measured.is_number();
    return {node, both ? Measured::number() : Measured::unknown()};
  }
  if (measured.unit == Unit()) return {node, Measured::known(Unit())};
  const auto number = graph_.value(power_value.node);
  if (!number) {
    report_.fail("E204", exponent.text.span, "the exponent of a quantity with a unit must be a number",
                 fmt::format("{} is {}, and {} may change", report_.quote(base.text.span), unit_text(measured),
                             report_.quote(exponent.text.span)),
                 "divide the base by a quantity of the same unit");
    return bad();
  }
  const auto unit = continuo::model::power(measured.unit, *number);
  if (unit) return {node, Measured::known(*unit)};
  report_.fail("E204", span, "this power has no unit",
               fmt::format("{} is {}, and {:g} is no simple fraction", report_.quote(base.text.span),
                           unit_text(measured), *number));
  return bad();
}

/// A pure number for a function that takes nothing else: degrees become radians, per cent fractions.
Value Operations::pure_number(const Term& argument, std::string_view function) const {
  Value value = argument.value;
  if (!value.measured.is_known()) return value;
  const auto factor = factor_between(value.measured, Measured::known(Unit()));
  if (!factor) {
    report_.fail("E202", argument.text.span, fmt::format("`{}` takes a pure number", function),
                 fmt::format("{} is {}", report_.quote(argument.text.span), unit_text(value.measured)),
                 "divide it by a quantity of the same unit");
    return bad();
  }
  value.node = graph_.multiply(value.node, graph_.constant(*factor));
  value.measured = Measured::known(Unit());
  return value;
}

NodeId Operations::in_unit(const ast::Expression& expression, const Value& value, const Measured& wanted,
                           std::string_view what) const {
  const auto factor = factor_between(value.measured, wanted);
  if (!factor) {
    report_.fail("E201", expression.span, "units do not match",
                 fmt::format("{} is {}, {} is {}", report_.quote(expression.span), unit_text(value.measured), what,
                             unit_text(wanted)));
    return value.node;
  }
  return *factor == 1 ? value.node : graph_.multiply(value.node, graph_.constant(*factor));
}

Value Operations::logical(Op op, Term a, Term b) const {
  const bool left = want_condition(a.text, a.value), right = want_condition(b.text, b.value);
  return left && right ? Value{.node = graph_.apply(op, a.value.node, b.value.node), .condition = true} : bad();
}

Value Operations::root(std::string_view name, const Value& x, Span span) const {
  const NodeId node = function_of_one(graph_, name, x.node);
  if (!x.measured.is_known()) return {node, x.measured};
  const auto unit = continuo::model::power(x.measured.unit, 1, name == "sqrt" ? 2 : 3);
  if (unit) return {node, Measured::known(*unit)};
  report_.fail("E204", span, fmt::format("no unit is the root of {}", unit_text(x.measured)));
  return bad();
}

Value Operations::in_stated_unit(const ast::Expression& text, Value value, const Unit& unit, Span span) const {
  const auto factor = factor_between(value.measured, Measured::known(unit));
  if (!factor) {
    report_.fail("E201", span, "units do not match",
                 fmt::format("{} is {}, not {}", report_.quote(text.span), unit_text(value.measured), to_text(unit)));
    return bad();
  }
  value.node = graph_.multiply(value.node, graph_.constant(*factor));
  value.measured = Measured::known(unit);
  return value;
}

// ---- functions ------------------------------------------------------------------------------------------------------

NodeId function_of_one(Graph& g, std::string_view name, NodeId x) {
  static constexpr std::array<std::pair<std::string_view, Op>, 18> direct = {{
      {"sin", Op::sine},
      {"cos", Op::cosine},
      {"tan", Op::tangent},
      {"asin", Op::arc_sine},
      {"acos", Op::arc_cosine},
      {"atan", Op::arc_tangent},
      {"sinh", Op::hyperbolic_sine},
      {"cosh", Op::hyperbolic_cosine},
      {"tanh", Op::hyperbolic_tangent},
      {"exp", Op::exponential},
      {"log", Op::logarithm},
      {"ln", Op::logarithm},
      {"log10", Op::logarithm10},
      {"floor", Op::floor},
      {"ceil", Op::ceiling},
      {"abs", Op::absolute},
      {"sign", Op::sign},
      {"smooth", Op::smooth},
  }};
  for (const auto& [known, op] : direct) {
    if (known == name) return g.apply(op, x);
  }
  if (name == "sqrt") return g.apply(Op::square_root, x);
  const NodeId one = g.constant(1), half = g.constant(0.5);
  if (name == "round") return g.apply(Op::floor, g.add(x, half));
  if (name == "log2") return g.divide(g.apply(Op::logarithm, x), g.constant(std::numbers::ln2));
  if (name == "asinh") {  // odd: taken from the positive side, where nothing cancels
    const NodeId size = g.apply(Op::absolute, x);
    return g.apply(Op::smooth, g.multiply(g.apply(Op::sign, x), logarithm_with_root(g, size, 1)));
  }
  if (name == "acosh") return logarithm_with_root(g, x, -1);
  if (name == "atanh") return g.multiply(half, g.apply(Op::logarithm, g.divide(g.add(one, x), g.subtract(one, x))));
  const NodeId root = g.power(g.apply(Op::absolute, x), g.constant(1.0 / 3));  // cbrt
  return g.multiply(g.apply(Op::sign, x), root);
}

NodeId function_of_two(Graph& g, std::string_view name, NodeId a, NodeId b) {
  const Op op = name == "min"     ? Op::minimum
                : name == "max"   ? Op::maximum
                : name == "mod"   ? Op::modulo
                : name == "hypot" ? Op::hypotenuse
                                  : Op::arc_tangent2;
  return g.apply(op, a, b);
}

}  // namespace continuo::model::detail
