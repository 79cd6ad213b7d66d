// continuo/language/check/expressions/values.cpp
// Numbers, conditions, constants and times, each with a message where something else stands.
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

Values::Values(Expressions& expressions)
    : expressions_(expressions),
      workspace_(expressions.workspace),
      report_(expressions.report),
      operations_(expressions.operations) {}

/// What the expression at hand holds of highest derivatives is replaced; before the equations are solved it stays.
Value Values::settle(Value value, Span span, const std::vector<std::uint32_t>& highest) const {
  if (highest.empty() || value.bad || !value.node.valid()) return value;
  if (workspace_.declared.has_modes()) {
    const Base& base = workspace_.declared.bases[highest.front()];
    report_.fail("E218", span, fmt::format("`{}` is another one in each mode", with_primes(base.name, base.order)), {},
                 "write out what you want of it");
    return operations_.bad();
  }
  if (workspace_.solved.empty()) return value;
  value.node = substitute(workspace_.graph, value.node, [&](std::uint32_t variable) -> std::optional<NodeId> {
    if (variable < highest_begin) return std::nullopt;
    return workspace_.solved[variable - highest_begin];
  });
  return value;
}

Value Values::settled(const ast::Expression& expression, Scope& scope) const {
  std::vector<std::uint32_t> highest;
  Scope inner = scope;
  inner.highest = &highest;
  Value value = expressions_.translator.translate(expression, inner);
  return settle(std::move(value), expression.span, highest);
}

Value Values::number_of(const ast::Expression& expression, Scope& scope) const {
  Value value = settled(expression, scope);
  operations_.want_number(expression, value);
  return value;
}

Value Values::condition_of(const ast::Expression& expression, Scope& scope) const {
  Value value = settled(expression, scope);
  operations_.want_condition(expression, value);
  return value;
}

/// A number that does not follow a parameter that changes later.
std::optional<double> Values::constant(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                       std::string_view what) const {
  Scope inner = scope;
  inner.constant = what;
  inner.samples = nullptr;
  const Value value = expressions_.translator.translate(expression, inner);
  if (value.bad) return std::nullopt;
  const auto number = workspace_.graph.value(operations_.in_unit(expression, value, wanted, what));
  if (!number) report_.fail("E222", expression.span, fmt::format("{} must be constant", what));
  return number;
}

/// A number that may depend on parameters and follows them.
std::optional<Setting> Values::setting(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                       std::string_view what) const {
  const Value value = number_of(expression, scope);
  if (value.bad || !only_parameters(value.node, expression.span, what)) return std::nullopt;
  const NodeId node = operations_.in_unit(expression, value, wanted, what);
  const double number = evaluate(workspace_.graph, node, workspace_.registers);
  if (std::isfinite(number)) return Setting{node, number};
  report_.fail("E222", expression.span, fmt::format("{} must be a finite number", what), not_finite(number));
  return std::nullopt;
}

/// A time without unit is in the unit of the run.
std::optional<Setting> Values::time_setting(const ast::Expression& expression, Scope& scope,
                                            std::string_view what) const {
  const std::size_t before = report_.errors();
  const auto found = setting(expression, scope, workspace_.time.in_experiment(), what);
  if (!found || report_.errors() > before || workspace_.time.unit) return found;
  const Value value = number_of(expression, scope);
  if (!value.measured.is_known()) return found;
  report_.fail("E201", expression.span, "units do not match",
               fmt::format("{} is {}, and time has no unit", report_.quote(expression.span), unit_text(value.measured)),
               "give the run one, as in run 0..60 [s]");
  return std::nullopt;
}

bool Values::only_parameters(NodeId node, Span span, std::string_view what, std::string help) const {
  const Layout& layout = workspace_.layout;
  for (const std::uint32_t variable : variables_of(workspace_.graph, node)) {
    if (variable >= layout.parameters && variable < layout.inputs) continue;
    if (variable >= layout.samples && variable < layout.size) continue;  // `x(10)` in a condition: a number
    report_.fail("E222", span, fmt::format("{} may depend on parameters only", what),
                 fmt::format("`{}` changes with time", name_of_variable(workspace_, variable)), std::move(help));
    return false;
  }
  return true;
}

/// A time in the run; the end of the run decides, where it is known.
void Values::check_time_in_run(const Setting& time, Span span) const {
  if (is_in_run(time, workspace_.run)) return;
  const double from = workspace_.run.from->value, to = workspace_.run.to->value;
  report_.fail("E281", span, "this time is not in the run", fmt::format("the run goes from {:g} to {:g}", from, to));
}

bool is_in_run(const Setting& time, const RunSettings& run) {
  if (!run.from || !run.to) return true;
  const double from = run.from->value, to = run.to->value, slack = 1e-12 * (to - from);
  if (!(from < to)) return true;  // said elsewhere
  return time.value >= from - slack && time.value <= to + slack;
}

}  // namespace continuo::model::detail
