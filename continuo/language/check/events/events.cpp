// continuo/language/check/events/events.cpp
// Events: guards, times and what happens.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/names/checker.hpp>
#include <continuo/language/syntax/format.hpp>

namespace continuo::model::detail {

namespace {

/// `x[i]` with i known: the name of an event says which member of the family it is of.
void write_out(ast::Expression& expression, const std::vector<Index>& indices) {
  const auto inside = [&](ast::Expression& part) { write_out(part, indices); };
  std::visit(
      [&](auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Name>) {
          std::ranges::for_each(node.indices, inside);
          const auto known = std::ranges::find(indices, node.text, &Index::name);
          if (known != indices.end() && node.indices.empty() && node.primes == 0) {
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

void Checker::make_events() {
  for (EventText& event : events_) {
    std::visit([&](const auto* text) { make_event(*text, event.scope, event.span); }, event.text);
  }
}

void Checker::make_event(const ast::When& text, Scope& scope, Span span) {
  ast::When written = text;
  write_out(written.subject, scope.indices);
  if (written.level) write_out(*written.level, scope.indices);
  When event{.name = event_name(written),
             .guard = {},
             .direction = Direction::rises,
             .mode = {},
             .actions = {},
             .limit_actions = {},
             .span = span};
  if (text.mode) {
    event.mode = mode_named(*text.mode);
    if (!event.mode) return;
    scope.mode = static_cast<int>(*event.mode);
  }
  if (text.direction) {
    Term subject{text.subject, number_of(text.subject, scope)}, level{*text.level, number_of(*text.level, scope)};
    const Span both = cover(text.subject.span, text.level->span);
    if (!subject.value.bad && !level.value.bad && align(subject, level, both, scope)) {
      event.guard = model_.graph.subtract(subject.value.node, level.value.node);
    }
    event.direction = *text.direction;
  } else {
    const Value condition = guard(text.subject, scope);
    if (!condition.bad) {
      event.guard = condition.node;
      event.truth = condition_of(text.subject, scope).node;
    }
  }
  event.actions = actions_of(text.actions, scope);
  if (text.limit_actions) event.limit_actions = actions_of(*text.limit_actions, scope);
  event.has_limit = text.limit_actions.has_value();
  if (event.guard.valid() && model_.graph.value(event.guard)) {
    warn("E291", text.subject.span, "this event never happens", "its condition does not change");
  }
  model_.event_order.push_back({false, model_.events.size()});
  model_.events.push_back(std::move(event));
}

void Checker::make_scheduled(Scheduled event, const std::vector<ast::Action>& actions, Scope& scope) {
  event.actions = actions_of(actions, scope);
  model_.event_order.push_back({true, model_.schedule.size()});
  model_.schedule.push_back(std::move(event));
}

void Checker::make_event(const ast::At& text, Scope& scope, Span span) {
  ast::At written = text;
  write_out(written.time, scope.indices);
  const auto time = time_setting(text.time, scope, "the time of an event");
  make_scheduled({Scheduled::Kind::at, event_name(written), time, {}, {}, span}, text.actions, scope);
}

void Checker::make_event(const ast::Every& text, Scope& scope, Span span) {
  ast::Every written = text;
  write_out(written.period, scope.indices);
  const auto period = time_setting(text.period, scope, "the period of an event");
  if (period && !(period->value > 0)) {
    fail("E261", text.period.span, "the period must be greater than zero", fmt::format("this is {:g}", period->value));
  }
  std::optional<Setting> first;
  if (text.from) first = time_setting(*text.from, scope, "the time of an event");
  make_scheduled({Scheduled::Kind::every, event_name(written), period, first, {}, span}, text.actions, scope);
}

void Checker::make_event(const ast::Initially& text, Scope& scope, Span span) {
  make_scheduled({Scheduled::Kind::initially, event_name(text), {}, {}, {}, span}, text.actions, scope);
}

/// Only actions change it: it is made of parameters, of inputs that follow no straight lines, and of states that stand
/// still in every mode.
bool Checker::changes_at_events_only(NodeId node) const {
  const Layout& layout = model_.layout;
  return std::ranges::all_of(variables_of(model_.graph, node), [&](std::uint32_t v) {
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
Value Checker::guard(const ast::Expression& condition, Scope& scope) {
  Graph& g = model_.graph;
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
    Term a{*node->left, number_of(*node->left, scope)}, b{*node->right, number_of(*node->right, scope)};
    if (a.value.bad || b.value.bad || !align(a, b, condition.span, scope)) return bad();
    return {.node = less_than ? g.subtract(b.value.node, a.value.node) : g.subtract(a.value.node, b.value.node)};
  }
  Value value = condition_of(condition, scope);
  if (value.bad) return value;
  if (node && (node->op == equal || node->op == not_equal) && !changes_at_events_only(value.node)) {
    fail("E217", condition.span, "an event cannot wait for equality of what moves",
         "two such numbers are equal at single instants only", "write: when A crosses B");
    return bad();
  }
  value.node = g.select(value.node, g.constant(1), g.constant(-1));
  return value;
}

}  // namespace continuo::model::detail
