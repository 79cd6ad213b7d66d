// continuo/language/check/expressions/values.cpp
// Expressions where something particular is wanted: a number, a condition, a constant, a time.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/names/checker.hpp>
#include <continuo/language/syntax/format.hpp>

namespace continuo::model::detail {

/// What the expression at hand holds of highest derivatives is replaced; before the equations are solved it stays.
Value Checker::settle(Value value, Span span, const std::vector<std::uint32_t>& highest) {
  if (highest.empty() || value.bad || !value.node.valid()) return value;
  if (model_.modes.size() > 1) {
    const Base& base = bases_[highest.front()];
    fail("E218", span, fmt::format("`{}` is another one in each mode", with_primes(base.name, base.order)), {},
         "write out what you want of it");
    return bad();
  }
  if (solved_.empty()) return value;
  value.node = substitute(model_.graph, value.node, [&](std::uint32_t variable) -> std::optional<NodeId> {
    if (variable < highest_begin) return std::nullopt;
    return solved_[variable - highest_begin];
  });
  return value;
}

Value Checker::settled(const ast::Expression& expression, Scope& scope) {
  std::vector<std::uint32_t> highest;
  Scope inner = scope;
  inner.highest = &highest;
  Value value = elaborate(expression, inner);
  return settle(std::move(value), expression.span, highest);
}

Value Checker::number_of(const ast::Expression& expression, Scope& scope) {
  Value value = settled(expression, scope);
  want_number(expression, value);
  return value;
}

Value Checker::condition_of(const ast::Expression& expression, Scope& scope) {
  Value value = settled(expression, scope);
  want_condition(expression, value);
  return value;
}

NodeId Checker::in_unit(const ast::Expression& expression, const Value& value, const Measured& wanted,
                        std::string_view what) {
  const auto factor = factor_between(value.measured, wanted);
  if (!factor) {
    fail("E201", expression.span, "units do not match",
         fmt::format("{} is {}, {} is {}", quote(expression.span), unit_text(value.measured), what, unit_text(wanted)));
    return value.node;
  }
  return *factor == 1 ? value.node : model_.graph.multiply(value.node, model_.graph.constant(*factor));
}

/// A number that does not follow a parameter that changes later.
std::optional<double> Checker::constant(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                        std::string_view what) {
  Scope inner = scope;
  inner.constant = what;
  inner.samples = nullptr;
  const Value value = elaborate(expression, inner);
  if (value.bad) return std::nullopt;
  const auto number = model_.graph.value(in_unit(expression, value, wanted, what));
  if (!number) fail("E222", expression.span, fmt::format("{} must be constant", what));
  return number;
}

/// A number that may depend on parameters and follows them.
std::optional<Setting> Checker::setting(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                        std::string_view what) {
  const Value value = number_of(expression, scope);
  if (value.bad || !only_parameters(value.node, expression.span, what)) return std::nullopt;
  const NodeId node = in_unit(expression, value, wanted, what);
  const double number = evaluate(model_.graph, node, registers_);
  if (std::isfinite(number)) return Setting{node, number};
  fail("E222", expression.span, fmt::format("{} must be a finite number", what), not_finite(number));
  return std::nullopt;
}

/// A time without unit is in the unit of the run.
std::optional<Setting> Checker::time_setting(const ast::Expression& expression, Scope& scope, std::string_view what) {
  const std::size_t before = errors_;
  const auto found = setting(expression, scope, time_or_number(), what);
  if (!found || errors_ > before || time_unit_) return found;
  const Value value = number_of(expression, scope);
  if (!value.measured.is_known()) return found;
  fail("E201", expression.span, "units do not match",
       fmt::format("{} is {}, and time has no unit", quote(expression.span), unit_text(value.measured)),
       "give the run one, as in run 0..60 [s]");
  return std::nullopt;
}

bool Checker::only_parameters(NodeId node, Span span, std::string_view what, std::string help) {
  const Layout& layout = model_.layout;
  for (const std::uint32_t variable : variables_of(model_.graph, node)) {
    if (variable >= layout.parameters && variable < layout.inputs) continue;
    if (variable >= layout.samples && variable < layout.size) continue;  // `x(10)` in a condition: a number
    fail("E222", span, fmt::format("{} may depend on parameters only", what),
         fmt::format("`{}` changes with time", name_of(variable)), std::move(help));
    return false;
  }
  return true;
}

std::string Checker::name_of(std::uint32_t variable) const {
  if (variable >= highest_begin) {
    const Base& base = bases_[variable - highest_begin];
    return with_primes(base.name, base.order);
  }
  if (variable >= model_.layout.states && variable < model_.layout.unknowns) {  // also before they are named
    const std::size_t state = variable - model_.layout.states;
    const Base& base = bases_[base_of_state(state)];
    return with_primes(base.name, static_cast<int>(state - base.first));
  }
  if (variable >= model_.layout.unknowns) {
    for (const Definition& definition : definitions_) {
      if (definition.variable == variable) return definition.name;
    }
    for (const UnknownText& unknown : unknowns_) {
      if (unknown.variable == variable) return unknown.name;
    }
  }
  return variable_name(model_, variable);
}

// ---- what may have been meant ---------------------------------------------------------------------------------------

namespace {

/// The names of an expression in the order of the text, to be changed in place.
void collect_names(ast::Expression& expression, std::vector<ast::Name*>& names) {
  std::visit(
      [&](auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Name>) {
          names.push_back(&node);
        } else if constexpr (std::is_same_v<T, ast::Unary>) {
          collect_names(*node.operand, names);
        } else if constexpr (std::is_same_v<T, ast::Binary>) {
          collect_names(*node.left, names);
          collect_names(*node.right, names);
        } else if constexpr (std::is_same_v<T, ast::Call>) {
          for (ast::Expression& argument : node.arguments) collect_names(argument, names);
        }
      },
      expression.node);
}

}  // namespace

/// The term with one prime more or less somewhere, if that has the unit that is wanted.
std::string Checker::repair(const Term& term, const Measured& wanted, Scope& scope) {
  constexpr std::size_t most_tried = 12;
  if (silent_ || scope.is_constant()) return {};
  silent_ = true;
  Scope trial = scope;
  trial.highest = nullptr;
  std::string help;
  ast::Expression copy = term.text;
  std::vector<ast::Name*> names;
  collect_names(copy, names);
  for (std::size_t i = 0; i < std::min(names.size(), most_tried) && help.empty(); ++i) {
    const auto key = key_of(*names[i], scope);
    const Symbol* symbol = key ? find(*key, scope.mode) : nullptr;
    if (!symbol || symbol->kind != Symbol::Kind::base) continue;
    const int written = names[i]->primes;
    for (const int primes : {written + 1, written - 1}) {
      if (primes < 0 || primes > bases_[symbol->index].order) continue;
      names[i]->primes = primes;
      const Value value = elaborate(copy, trial);
      if (value.bad || !value.measured.is_known() || !factor_between(value.measured, wanted)) continue;
      help = fmt::format("did you mean {} ?", to_text(copy));
      break;
    }
    names[i]->primes = written;
  }
  silent_ = false;
  return help;
}

}  // namespace continuo::model::detail
