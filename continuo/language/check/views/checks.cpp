// continuo/language/check/views/checks.cpp
// The left side says what is measured and in which unit, the right side what it should be.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/names/functions.hpp>
#include <continuo/language/check/views/checks.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

Relation relation_of(ast::Relation relation) {
  switch (relation) {
    case ast::Relation::equal:
      return Relation::equal;
    case ast::Relation::less:
      return Relation::less;
    case ast::Relation::less_equal:
      return Relation::less_equal;
    case ast::Relation::greater:
      return Relation::greater;
    case ast::Relation::greater_equal:
      return Relation::greater_equal;
  }
  return Relation::equal;
}

}  // namespace

void Checks::check_event_name(const std::string& begin, Span span) {
  if (begin.empty()) return;
  std::vector<std::string> names;
  for (const When& event : model_.events) names.push_back(event.name);
  for (const Scheduled& event : model_.schedule) names.push_back(event.name);
  const auto fits = [&](const std::string& name) { return name.starts_with(begin); };
  if (std::ranges::any_of(names, fits)) return;
  // Contacts are named as they happen.
  if (expressions_.workspace.declared.world.text &&
      (begin.find(" meets") != std::string::npos || begin.find(" leaves") != std::string::npos))
    return;
  const std::string near = did_you_mean(begin, names);
  report_.fail("E281", span, fmt::format("no event begins with \"{}\"", begin), {},
               !near.empty()   ? near
               : names.empty() ? "the model has no events"
                               : "the events are " + listed(names));
}

Moment Checks::moment(const ast::Moment& text, Scope& scope, Span span) {
  Moment result;
  if (const auto* at = std::get_if<ast::AtTime>(&text)) {
    result.kind = Moment::Kind::time;
    result.time = expressions_.values.time_setting(at->time, scope, "the time of a check");
    if (result.time) expressions_.values.check_time_in_run(*result.time, at->time.span);
  } else if (const auto* event = std::get_if<ast::AtEvent>(&text)) {
    result.kind = Moment::Kind::event;
    const auto number = expressions_.indices.whole_number(event->number, scope, "the number of an event");
    if (number && *number < 1) report_.fail("E281", event->number.span, "events count from 1");
    result.number = static_cast<std::size_t>(std::max(number.value_or(1), 1L));
    result.event = event->event;
    result.after = event->after;
    check_event_name(event->event, span);
  }
  return result;
}

/// `h(1)` alone is h at 1.
Value Checks::value_at(const ast::ValueOf& text, Scope& scope, Span span, Check& check) {
  check.measure = Measure::value;
  const WorldExpressions* world = expressions_.workspace.world;
  const auto* call = std::get_if<ast::Call>(&text.expression.node);
  const bool plain = call && call->arguments.size() == 1 && !is_function(call->callee.text) &&
                     !(world && world->is_query(call->callee, scope)) &&
                     std::holds_alternative<ast::AtEnd>(text.moment);
  Value value;
  if (plain) {
    ast::Expression name{call->callee, call->callee.span};
    check.moment = moment(ast::AtTime{call->arguments[0]}, scope, span);
    value = expressions_.values.number_of(name, scope);
  } else {
    check.moment = moment(text.moment, scope, span);
    value = expressions_.values.number_of(text.expression, scope);
  }
  check.node = value.node;
  return value;
}

/// The left side: what is measured, and in which unit.
Value Checks::measure(const ast::Measure& text, Span span, Scope& scope, Check& check) {
  const auto value = [&](const ast::Expression& expression) {
    const Value v = expressions_.values.number_of(expression, scope);
    check.node = v.node;
    return v;
  };
  const Value time{.node = graph_.constant(0), .measured = expressions_.workspace.time.in_expressions()};
  const Value pure{.node = graph_.constant(0), .measured = Measured::known(Unit())};
  if (const auto* of = std::get_if<ast::ValueOf>(&text)) return value_at(*of, scope, span, check);
  if (const auto* always = std::get_if<ast::AlwaysValueOf>(&text)) {
    check.measure = Measure::always;
    return value(always->expression);
  }
  if (std::holds_alternative<ast::EnergyDrift>(text)) {
    check.measure = Measure::energy_drift;
    if (!model_.total_energy.valid()) {
      report_.fail("E281", span, "there is no energy to drift", {},
                   "declare it: energy kinetic = ..., potential = ...");
    }
    return pure;
  }
  if (const auto* event = std::get_if<ast::TimeOfEvent>(&text)) {
    check.measure = Measure::event_time;
    check.moment = moment(event->event, scope, span);
    return time;
  }
  if (const auto* events = std::get_if<ast::CountOfEvents>(&text)) {
    check.measure = Measure::event_count;
    check.moment.kind = Moment::Kind::event;
    check.moment.event = events->event;
    check_event_name(events->event, span);
    return pure;
  }
  check.measure = Measure::end_time;
  return time;
}

/// What is to hold always is looked at while the run goes on, when later values are not known.
bool Checks::are_at_start(const std::vector<Sample>& samples, const ast::Check& text) const {
  const auto& from = expressions_.workspace.run.from;
  const double start = from ? from->value : 0;
  if (std::ranges::all_of(samples, [&](const Sample& sample) { return sample.when.value == start; })) return true;
  report_.fail("E281", cover(text.measure_span, text.value.span),
               "what holds always can be held against values at the start only",
               "a time here is another one than the start of the run",
               "check the value at that time for itself, or write down the number");
  return false;
}

void Checks::add(const ast::Check& text, const Scope& outer, Span span) {
  std::vector<Sample> samples;
  Scope scope = outer;
  scope.samples = &samples;
  Check check{};
  check.span = span;
  check.relation = relation_of(text.relation);
  std::string quoted = report_.quote(span);
  check.text = quoted.substr(1, quoted.size() - 2);
  Term left{text.value, measure(text.measure, text.measure_span, scope, check)};
  Term right{text.value, expressions_.values.number_of(text.value, scope)};
  if (left.value.bad || right.value.bad) return;
  if (!factor_between(right.value.measured, left.value.measured)) {
    report_.fail("E201", cover(text.measure_span, text.value.span), "units do not match",
                 fmt::format("{} is {}, {} is {}", report_.quote(text.measure_span), unit_text(left.value.measured),
                             report_.quote(text.value.span), unit_text(right.value.measured)));
    return;
  }
  check.value = expressions_.operations.in_unit(text.value, right.value, left.value.measured, "the measured value");
  const Measured both = left.value.measured.is_known() ? left.value.measured : right.value.measured;
  check.unit = both.is_known() && !(both.unit == Unit()) ? to_text(both.unit) : std::string();
  if (text.tolerance) {
    const Value tolerance = expressions_.values.number_of(*text.tolerance, scope);
    if (!tolerance.bad)
      check.tolerance = expressions_.operations.in_unit(*text.tolerance, tolerance, both, "the check");
  }
  if (check.measure == Measure::always && !are_at_start(samples, text)) return;
  check.samples = std::move(samples);
  made_.push_back(std::move(check));
}

std::vector<Check> Checks::make() {
  for (const Placed<ast::Check>& check : expressions_.workspace.declared.checks)
    add(*check.text, check.scope, check.span);
  return std::move(made_);
}

}  // namespace continuo::model::detail
