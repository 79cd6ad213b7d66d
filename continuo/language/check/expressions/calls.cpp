// continuo/language/check/expressions/calls.cpp
// Calls: elementary functions, tables, and h(1) in checks and conditions.
#include <array>

#include <fmt/format.h>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/names/functions.hpp>
#include <continuo/language/syntax/blackboard.hpp>
#include <continuo/language/text/words.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

using enum Function::Units;

std::string here(std::size_t count) {
  return fmt::format("here {} {}", count == 1 ? "is" : "are", count);
}

}  // namespace

Calls::Calls(Expressions& expressions)
    : expressions_(expressions),
      workspace_(expressions.workspace),
      report_(expressions.report),
      operations_(expressions.operations) {}

Value Calls::call(const ast::Call& node, Span span, Scope& scope) const {
  const std::string& name = node.callee.text;
  if (name == "interp") return interpolation(node, span, scope);
  const Function* function = node.callee.indices.empty() && node.callee.primes == 0 ? find_function(name) : nullptr;
  const WorldExpressions* world = workspace_.world;
  if (!function && world && world->is_query(node.callee, scope)) return world->query(node, span, scope, expressions_);
  if (!function) return sample(node, span, scope);
  const std::size_t count = node.arguments.size();
  if (count < function->least || count > function->most) {
    report_.fail("E216", span, fmt::format("`{}` takes {}", name, arguments_of(*function)), here(count));
    return operations_.bad();
  }
  std::vector<Term> arguments;
  bool good = true;
  for (const ast::Expression& argument : node.arguments) {
    arguments.push_back({argument, expressions_.translator.translate(argument, scope)});
    good = operations_.want_number(argument, arguments.back().value) && good;
  }
  return good ? apply_function(name, arguments, span, scope) : operations_.bad();
}

Value Calls::apply_function(std::string_view name, std::vector<Term>& arguments, Span span, Scope& scope) const {
  const Function& function = *find_function(name);
  Graph& g = workspace_.graph;
  Value first = arguments[0].value;
  switch (function.units) {
    case pure: {
      Value value = operations_.pure_number(arguments[0], name);
      if (!value.bad) value.node = function_of_one(g, name, value.node);
      return value;
    }
    case root:
      return operations_.root(name, first, span);
    case sign:
      return {function_of_one(g, name, first.node),
              first.measured.is_known() ? Measured::known(Unit()) : first.measured};
    case Function::Units::power:
      return operations_.raise(arguments[0], arguments[1], span);
    case same:
    case ratio:
      break;
  }
  if (arguments.size() == 1) return {function_of_one(g, name, first.node), first.measured};
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const Term so_far{arguments[0].text, first};
    Term next = arguments[i];
    if (!expressions_.translator.align(so_far, next, span, scope)) return operations_.bad();
    first.measured = common(first.measured, next.value.measured);
    first.node = function_of_two(g, name, first.node, next.value.node);
  }
  if (function.units == ratio && first.measured.is_known()) first.measured = Measured::known(Unit());
  return first;
}

Value Calls::interpolation(const ast::Call& node, Span span, Scope& scope) const {
  if (node.arguments.size() != 2) {
    report_.fail("E216", span, "`interp` takes a table and a number", here(node.arguments.size()));
    return operations_.bad();
  }
  const auto* name = std::get_if<ast::Name>(&node.arguments[0].node);
  const Symbol* table = name && name->indices.empty() && name->primes == 0
                            ? workspace_.declared.symbols.find({name->text}, scope.mode)
                            : nullptr;
  if (!table || table->kind != Symbol::Kind::table) {
    std::vector<std::string> tables;
    for (const TableFile& known : workspace_.declared.tables) tables.push_back(known.name);
    const std::string near = name ? did_you_mean(name->text, tables) : std::string();
    report_.fail("E271", node.arguments[0].span, "`interp` wants the name of a table here", "this is none",
                 near.empty() ? "declare it: table NAME from \"file.csv\"" : near);
    return operations_.bad();
  }
  Value x = expressions_.translator.translate(node.arguments[1], scope);
  if (!operations_.want_number(node.arguments[1], x)) return operations_.bad();
  return {workspace_.graph.interpolate(static_cast<std::uint32_t>(table->index), x.node), Measured::unknown()};
}

/// `h(1)`: what h is at a time; anything else with brackets behind it is a mistake.
Value Calls::sample(const ast::Call& node, Span span, Scope& scope) const {
  const auto key = expressions_.indices.name_of(node.callee, scope);
  if (!key) return operations_.bad();
  if (!workspace_.declared.symbols.find(*key, scope.mode) && !workspace_.declared.symbols.family(node.callee.text)) {
    return unknown_function(node.callee);
  }
  if (!scope.samples || node.arguments.size() != 1) {
    report_.fail("E282", span, "a value at a time can only stand in a check or a condition", {},
                 fmt::format("to multiply, write {}*(...)", report_.slice(node.callee.span)));
    return operations_.bad();
  }
  std::vector<std::uint32_t> highest;
  Scope inner = scope;
  inner.samples = nullptr;
  inner.moment = nullptr;
  inner.highest = &highest;
  Value value = expressions_.lookup.lookup(node.callee, inner);
  if (!scope.moment) value = expressions_.values.settle(std::move(value), span, highest);  // in a check
  const auto when = expressions_.values.time_setting(node.arguments[0], inner, "a time");
  if (value.bad || !when) return operations_.bad();
  expressions_.values.check_time_in_run(*when, node.arguments[0].span);
  const std::uint32_t variable = workspace_.layout.size++;
  scope.samples->push_back({variable, value.node, *when});
  value.node = workspace_.graph.variable(variable);
  return value;
}

Value Calls::unknown_function(const ast::Name& callee) const {
  std::vector<std::string> names = function_names();
  names.insert(names.begin(), "interp");
  if (workspace_.declared.world.text) names.insert(names.end(), {"distance", "within", "ray"});
  std::string near = did_you_mean(callee.text, names);
  if (const auto here = function_from_elsewhere(callee.text); !here.empty()) near = here;
  if (is_function(callee.member))
    near = with_corrected_line("functions have no name before them", report_.source(), callee.span, callee.member);
  report_.fail("E215", callee.span, fmt::format("there is no function `{}`", callee.text), {}, near);
  return operations_.bad();
}

}  // namespace continuo::model::detail
