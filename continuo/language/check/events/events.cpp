// continuo/language/check/events/events.cpp
// Guards are numbers that rise through zero; times are settings.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/events/events.hpp>
#include <continuo/language/syntax/format.hpp>

namespace continuo::model::detail {

namespace {

/// `x[i]` with i known: the name of an event says which member of the family it is of.
void write_out(ast::Expression& expression, const Instance& instance) {
  const auto inside = [&](ast::Expression& part) { write_out(part, instance); };
  std::visit(
      [&](auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Name>) {
          std::ranges::for_each(node.indices, inside);
          const Index* known = instance.find_index(node.text);
          if (known && node.indices.empty() && node.primes == 0) {
            expression.node = ast::Number{static_cast<double>(known->value)};
          }
        } else if constexpr (std::is_same_v<T, ast::Unary>) {
          inside(*node.operand);
        } else if constexpr (std::is_same_v<T, ast::Binary>) {
          inside(*node.left);
          inside(*node.right);
        } else if constexpr (std::is_same_v<T, ast::Call>) {
          std::ranges::for_each(node.arguments, inside);
        } else if constexpr (std::is_same_v<T, ast::List>) {
          std::ranges::for_each(node.items, inside);
        } else if constexpr (std::is_same_v<T, ast::Quantity>) {
          inside(*node.value);
        }
      },
      expression.node);
}

}  // namespace

EventList Events::make() {
  for (const EventText& event : expressions_.workspace.declared.events) {
    Scope scope = event.scope;
    std::visit([&](const auto* text) { add(*text, scope, event.span); }, event.text);
  }
  return std::move(made_);
}

void Events::add(const ast::When& text, Scope& scope, Span span) {
  ast::When written = text;
  write_out(written.subject, scope);
  if (written.level) write_out(*written.level, scope);
  When event{.name = event_name(written),
             .guard = {},
             .direction = Direction::rises,
             .mode = {},
             .actions = {},
             .limit_actions = {},
             .span = span};
  if (text.mode) {
    event.mode = mode_named(expressions_.workspace.declared, *text.mode, report_);
    if (!event.mode) return;
    scope.mode = static_cast<int>(*event.mode);
  }
  make_guard(event, text, scope);
  event.actions = actions_.actions_of(text.actions, scope);
  if (text.limit_actions) event.limit_actions = actions_.actions_of(*text.limit_actions, scope);
  event.has_limit = text.limit_actions.has_value();
  if (event.guard.valid() && graph_.value(event.guard)) {
    report_.warn("E291", text.subject.span, "this event never happens", "its condition does not change");
  }
  made_.order.push_back({false, made_.events.size()});
  made_.events.push_back(std::move(event));
}

void Events::add(const ast::At& text, Scope& scope, Span span) {
  ast::At written = text;
  write_out(written.time, scope);
  const auto time = expressions_.values.time_setting(text.time, scope, "the time of an event");
  add_scheduled({Scheduled::Kind::at, event_name(written), time, {}, {}, span}, text.actions, scope);
}

void Events::add(const ast::Every& text, Scope& scope, Span span) {
  ast::Every written = text;
  write_out(written.period, scope);
  const auto period = expressions_.values.time_setting(text.period, scope, "the period of an event");
  if (period && !(period->value > 0)) {
    report_.fail("E261", text.period.span, "the period must be greater than zero",
                 fmt::format("this is {:g}", period->value));
  }
  std::optional<Setting> first;
  if (text.from) first = expressions_.values.time_setting(*text.from, scope, "the time of an event");
  add_scheduled({Scheduled::Kind::every, event_name(written), period, first, {}, span}, text.actions, scope);
}

void Events::add(const ast::Initially& text, Scope& scope, Span span) {
  add_scheduled({Scheduled::Kind::initially, event_name(text), {}, {}, {}, span}, text.actions, scope);
}

void Events::add_scheduled(Scheduled event, const std::vector<ast::Action>& actions, Scope& scope) {
  event.actions = actions_.actions_of(actions, scope);
  made_.order.push_back({true, made_.schedule.size()});
  made_.schedule.push_back(std::move(event));
}

void Events::make_guard(When& event, const ast::When& text, Scope& scope) {
  if (text.direction) {
    Term subject{text.subject, expressions_.values.number_of(text.subject, scope)},
        level{*text.level, expressions_.values.number_of(*text.level, scope)};
    const Span both = cover(text.subject.span, text.level->span);
    if (!subject.value.bad && !level.value.bad && expressions_.translator.align(subject, level, both, scope)) {
      event.guard = graph_.subtract(subject.value.node, level.value.node);
    }
    event.direction = *text.direction;
  } else {
    const Value condition = guard(text.subject, scope);
    if (!condition.bad) {
      event.guard = condition.node;
      event.truth = expressions_.values.condition_of(text.subject, scope).node;
    }
  }
}

/// Only actions change it: it is made of parameters, of inputs that follow no straight lines, and of states that stand
/// still in every mode.
bool Events::changes_at_events_only(NodeId node) const {
  const Layout& layout = model_.layout;
  return std::ranges::all_of(variables_of(graph_, node), [&](std::uint32_t v) {
    if (v >= layout.parameters && v < layout.inputs) return true;
    if (v >= layout.inputs && v < layout.samples) {
      const auto input = std::ranges::find(model_.inputs, v, &Input::variable);
      return !input->points || input->points->between() == Table::Between::step;
    }
    if (v < layout.states || v >= layout.unknowns) return false;
    return stands_still(model_, v - layout.states);
  });
}

/// A number that rises through zero where the condition becomes true. Comparisons stay smooth, so that the instant is
/// found as precisely as that of a level.
Value Events::guard(const ast::Expression& condition, Scope& scope) {
  Graph& g = graph_;
  if (const auto* node = std::get_if<ast::Unary>(&condition.node);
      node && node->op == ast::UnaryOperator::logical_not) {
    Value inner = guard(*node->operand, scope);
    inner.node = g.negate(inner.node);
    return inner;
  }
  const auto* node = std::get_if<ast::Binary>(&condition.node);
  using enum ast::BinaryOperator;
  if (node && (node->op == logical_and || node->op == logical_or)) {
    const Value a = guard(*node->left, scope), b = guard(*node->right, scope);
    return {.node = g.apply(node->op == logical_and ? Op::minimum : Op::maximum, a.node, b.node),
            .bad = a.bad || b.bad};
  }
  const bool less_than = node && (node->op == less || node->op == less_equal);
  if (less_than || (node && (node->op == greater || node->op == greater_equal))) {
    Term a{*node->left, expressions_.values.number_of(*node->left, scope)},
        b{*node->right, expressions_.values.number_of(*node->right, scope)};
    if (a.value.bad || b.value.bad || !expressions_.translator.align(a, b, condition.span, scope))
      return expressions_.operations.bad();
    return {.node = less_than ? g.subtract(b.value.node, a.value.node) : g.subtract(a.value.node, b.value.node)};
  }
  Value value = expressions_.values.condition_of(condition, scope);
  if (value.bad) return value;
  if (node && (node->op == equal || node->op == not_equal) && !changes_at_events_only(value.node)) {
    report_.fail("E217", condition.span, "an event cannot wait for equality of what moves",
                 "two such numbers are equal at single instants only", "write: when A crosses B");
    return expressions_.operations.bad();
  }
  value.node = g.select(value.node, g.constant(1), g.constant(-1));
  return value;
}

}  // namespace continuo::model::detail
