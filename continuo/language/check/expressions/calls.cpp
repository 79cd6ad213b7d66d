// continuo/language/check/expressions/calls.cpp
// Calls: elementary functions, tables, and h(1) in checks.
#include <algorithm>
#include <array>
#include <numbers>

#include <fmt/format.h>

#include <continuo/language/check/names/checker.hpp>
#include <continuo/language/check/names/functions.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

using enum Function::Units;
constexpr std::size_t many = 1000;

constexpr std::array<Function, 34> functions = {{
    {"sin", 1, 1, pure},    {"cos", 1, 1, pure},    {"tan", 1, 1, pure},      {"asin", 1, 1, pure},
    {"acos", 1, 1, pure},   {"atan", 1, 1, pure},   {"sinh", 1, 1, pure},     {"cosh", 1, 1, pure},
    {"tanh", 1, 1, pure},   {"asinh", 1, 1, pure},  {"acosh", 1, 1, pure},    {"atanh", 1, 1, pure},
    {"exp", 1, 1, pure},    {"log", 1, 1, pure},    {"ln", 1, 1, pure},       {"log2", 1, 1, pure},
    {"log10", 1, 1, pure},  {"floor", 1, 1, pure},  {"ceil", 1, 1, pure},     {"round", 1, 1, pure},
    {"sqrt", 1, 1, root},   {"cbrt", 1, 1, root},   {"abs", 1, 1, same},      {"min", 2, many, same},
    {"max", 2, many, same}, {"mod", 2, 2, same},    {"hypot", 2, many, same}, {"atan2", 2, 2, ratio},
    {"sign", 1, 1, sign},   {"pow", 2, 2, power},   {"if", 0, 0, pure},       {"not", 0, 0, pure},
    {"interp", 2, 2, pure}, {"smooth", 1, 1, same},
}};

std::string here(std::size_t count) {
  return fmt::format("here {} {}", count == 1 ? "is" : "are", count);
}

NodeId logarithm_with_root(Graph& g, NodeId x, double shift) {  // log(x + sqrt(x^2 + shift))
  const NodeId root = g.apply(Op::square_root, g.add(g.multiply(x, x), g.constant(shift)));
  return g.apply(Op::logarithm, g.add(x, root));
}

NodeId one_argument(Graph& g, std::string_view name, NodeId x) {
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

NodeId two_arguments(Graph& g, std::string_view name, NodeId a, NodeId b) {
  const Op op = name == "min"     ? Op::minimum
                : name == "max"   ? Op::maximum
                : name == "mod"   ? Op::modulo
                : name == "hypot" ? Op::hypotenuse
                                  : Op::arc_tangent2;
  return g.apply(op, a, b);
}

}  // namespace

const Function* find_function(std::string_view name) {
  const auto* found = std::ranges::find(functions, name, &Function::name);
  return found == functions.end() || found->most == 0 || name == "interp" ? nullptr : found;
}

bool is_function(std::string_view name) {
  return name == "interp" || find_function(name) != nullptr;
}

std::string arguments_of(const Function& function) {
  if (function.most == many) return fmt::format("at least {} arguments", function.least);
  return function.least == 1 ? "one argument" : fmt::format("{} arguments", function.least);
}

std::string example_of_call(std::string_view name) {
  if (name == "interp") return "interp(TABLE, x)";
  const Function* function = find_function(name);
  return fmt::format("{}({})", name, function && function->least > 1 ? "..., ..." : "...");
}

/// A pure number for a function that takes nothing else: degrees become radians, per cent fractions.
Value Checker::pure_number(const Term& argument, std::string_view function) {
  Value value = argument.value;
  if (!value.measured.is_known()) return value;
  const auto factor = factor_between(value.measured, Measured::known(Unit()));
  if (!factor) {
    fail("E202", argument.text.span, fmt::format("`{}` takes a pure number", function),
         fmt::format("{} is {}", quote(argument.text.span), unit_text(value.measured)),
         "divide it by a quantity of the same unit");
    return bad();
  }
  value.node = model_.graph.multiply(value.node, model_.graph.constant(*factor));
  value.measured = Measured::known(Unit());
  return value;
}

Value Checker::apply_function(std::string_view name, std::vector<Term>& arguments, Span span, Scope& scope) {
  const Function& function = *find_function(name);
  Graph& g = model_.graph;
  Value first = arguments[0].value;
  switch (function.units) {
    case pure: {
      Value value = pure_number(arguments[0], name);
      if (!value.bad) value.node = one_argument(g, name, value.node);
      return value;
    }
    case root: {
      const Value& x = first;
      const NodeId node = one_argument(g, name, x.node);
      if (!x.measured.is_known()) return {node, x.measured};
      const auto unit = continuo::model::power(x.measured.unit, 1, name == "sqrt" ? 2 : 3);
      if (unit) return {node, Measured::known(*unit)};
      fail("E204", span, fmt::format("no unit is the root of {}", unit_text(x.measured)));
      return bad();
    }
    case sign:
      return {one_argument(g, name, first.node), first.measured.is_known() ? Measured::known(Unit()) : first.measured};
    case Function::Units::power:
      return raise(arguments[0], arguments[1], span);
    case same:
    case ratio:
      break;
  }
  if (arguments.size() == 1) return {one_argument(g, name, first.node), first.measured};
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const Term so_far{arguments[0].text, first};
    Term next = arguments[i];
    if (!align(so_far, next, span, scope)) return bad();
    first.measured = common(first.measured, next.value.measured);
    first.node = two_arguments(g, name, first.node, next.value.node);
  }
  if (function.units == ratio && first.measured.is_known()) first.measured = Measured::known(Unit());
  return first;
}

Value Checker::call(const ast::Call& node, Span span, Scope& scope) {
  const std::string& name = node.callee.text;
  if (name == "interp") return interpolation(node, span, scope);
  const Function* function = node.callee.indices.empty() && node.callee.primes == 0 ? find_function(name) : nullptr;
  if (!function && asks_the_world(node.callee, scope)) return query(node, span, scope);
  if (!function) return sample(node, span, scope);
  const std::size_t count = node.arguments.size();
  if (count < function->least || count > function->most) {
    fail("E216", span, fmt::format("`{}` takes {}", name, arguments_of(*function)), here(count));
    return bad();
  }
  std::vector<Term> arguments;
  bool good = true;
  for (const ast::Expression& argument : node.arguments) {
    arguments.push_back({argument, elaborate(argument, scope)});
    good = want_number(argument, arguments.back().value) && good;
  }
  return good ? apply_function(name, arguments, span, scope) : bad();
}

Value Checker::interpolation(const ast::Call& node, Span span, Scope& scope) {
  if (node.arguments.size() != 2) {
    fail("E216", span, "`interp` takes a table and a number", here(node.arguments.size()));
    return bad();
  }
  const auto* name = std::get_if<ast::Name>(&node.arguments[0].node);
  const Symbol* table = name && name->indices.empty() && name->primes == 0 ? find(name->text, scope.mode) : nullptr;
  if (!table || table->kind != Symbol::Kind::table) {
    std::vector<std::string> tables;
    for (const TableFile& known : model_.tables) tables.push_back(known.name);
    const std::string near = name ? did_you_mean(name->text, tables) : std::string();
    fail("E271", node.arguments[0].span, "`interp` wants the name of a table here", "this is none",
         near.empty() ? "declare it: table NAME from \"file.csv\"" : near);
    return bad();
  }
  Value x = elaborate(node.arguments[1], scope);
  if (!want_number(node.arguments[1], x)) return bad();
  return {model_.graph.interpolate(static_cast<std::uint32_t>(table->index), x.node), Measured::unknown()};
}

/// `h(1)`: what h is at a time; anything else with brackets behind it is a mistake.
Value Checker::sample(const ast::Call& node, Span span, Scope& scope) {
  const auto key = key_of(node.callee, scope);
  if (!key) return bad();
  if (!find(*key, scope.mode) && families_.find(node.callee.text) == families_.end()) {
    std::vector<std::string> names{"interp"};
    for (const Function& known : functions) names.emplace_back(known.name);
    if (world_.text) names.insert(names.end(), {"distance", "within", "ray"});
    std::string near = did_you_mean(node.callee.text, names);
    if (const auto here = function_from_elsewhere(node.callee.text); !here.empty()) near = here;
    fail("E215", node.callee.span, fmt::format("there is no function `{}`", node.callee.text), {}, near);
    return bad();
  }
  if (!scope.samples || node.arguments.size() != 1) {
    fail("E282", span, "a value at a time can only stand in a check or a condition", {},
         fmt::format("to multiply, write {}*(...)", source_.slice(node.callee.span)));
    return bad();
  }
  Scope inner = scope;
  inner.samples = nullptr;
  inner.moment = nullptr;
  Value value = lookup(node.callee, inner);
  const auto when = time_setting(node.arguments[0], inner, "a time");
  if (value.bad || !when) return bad();
  check_time_in_run(*when, node.arguments[0].span);
  const std::uint32_t variable = model_.layout.size++;
  scope.samples->push_back({variable, value.node, *when});
  value.node = model_.graph.variable(variable);
  return value;
}

}  // namespace continuo::model::detail
