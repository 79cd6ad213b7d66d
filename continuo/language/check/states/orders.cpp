// continuo/language/check/states/orders.cpp
// Orders from primes, the places of all variables, the units of states.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/names/functions.hpp>
#include <continuo/language/syntax/format.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

bool has_primes(const ast::Expression& expression) {
  return std::visit(
      [&](const auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Name>) {
          return node.primes > 0;
        } else if constexpr (std::is_same_v<T, ast::Unary>) {
          return has_primes(*node.operand);
        } else if constexpr (std::is_same_v<T, ast::Binary>) {
          return has_primes(*node.left) || has_primes(*node.right);
        } else if constexpr (std::is_same_v<T, ast::Call>) {
          return std::ranges::any_of(node.arguments, has_primes);
        } else if constexpr (std::is_same_v<T, ast::Conditional>) {
          return has_primes(*node.condition) || has_primes(*node.when_true) || has_primes(*node.when_false);
        } else if constexpr (std::is_same_v<T, ast::Quantity>) {
          return has_primes(*node.value);
        } else if constexpr (std::is_same_v<T, ast::Sum>) {
          return has_primes(*node.body);
        } else if constexpr (std::is_same_v<T, ast::List>) {
          return std::ranges::any_of(node.items, has_primes);
        } else {
          return false;
        }
      },
      expression.node);
}

/// `x' = ...`: the equation says itself what it determines.
const ast::Name* explicit_left(const ast::Equation& equation) {
  const auto* name = std::get_if<ast::Name>(&equation.left.node);
  return name && name->primes > 0 ? name : nullptr;
}

}  // namespace

/// A variable with a derivative of at least this order; the first sight of it decides its place.
std::optional<std::size_t> Checker::see_base(const ast::Name& name, Scope& scope, int order) {
  if (!name.member.empty()) return std::nullopt;  // of a body: it is there, or the lookup says so
  const auto indices = indices_of(name, scope);
  if (!indices) return std::nullopt;
  const std::string key = indexed(name.text, *indices);
  const Symbol* known = find(key, Scope::no_mode);
  if (known && known->kind != Symbol::Kind::base) {
    const bool unknown = known->kind == Symbol::Kind::unknown;
    if (auto* said =
            fail("E213", name.span, fmt::format("`{}` cannot have an equation and a definition", key),
                 "an equation or initial value for it",
                 unknown ? "an unknown has no derivative and its start is a guess; drop `unknown`, or the primes"
                         : fmt::format("drop the definition of `{}` or this", key))) {
      said->related.push_back({known->span, "defined here"});
    }
    return std::nullopt;
  }
  if (!known) {
    const Symbol symbol{Symbol::Kind::base, bases_.size(), name.span};
    if (!declare(key, key, symbol, name.text, *indices)) return std::nullopt;
    bases_.push_back({key, name.text, 0, 0, name.span});
    known = find(key, Scope::no_mode);
  }
  Base& base = bases_[known->index];
  if (order > base.order) {
    base.order = order;
    base.span = name.span;
  }
  return known->index;
}

void Checker::see_primes(const ast::Expression& expression, Scope& scope) {
  if (!has_primes(expression)) return;
  std::visit(
      [&](const auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Name>) {
          const auto key = key_of(node, scope);
          const Symbol* known = key ? find(*key, scope.mode) : nullptr;
          if (!known && (!meaning_of_its_own(node.text).empty() || is_function(node.text))) return;  // said on lookup
          if (!known || known->kind == Symbol::Kind::base) see_base(node, scope, node.primes);
        } else if constexpr (std::is_same_v<T, ast::Unary>) {
          see_primes(*node.operand, scope);
        } else if constexpr (std::is_same_v<T, ast::Binary>) {
          see_primes(*node.left, scope);
          see_primes(*node.right, scope);
        } else if constexpr (std::is_same_v<T, ast::Call>) {
          for (const ast::Expression& argument : node.arguments) see_primes(argument, scope);
        } else if constexpr (std::is_same_v<T, ast::Conditional>) {
          see_primes(*node.condition, scope);
          see_primes(*node.when_true, scope);
          see_primes(*node.when_false, scope);
        } else if constexpr (std::is_same_v<T, ast::Quantity>) {
          see_primes(*node.value, scope);
        } else if constexpr (std::is_same_v<T, ast::Sum>) {
          for_each_term(node, scope, [&] { see_primes(*node.body, scope); });
        } else if constexpr (std::is_same_v<T, ast::List>) {
          for (const ast::Expression& item : node.items) see_primes(item, scope);
        }
      },
      expression.node);
}

/// On the walk: what an equation determines comes in the order of the text.
void Checker::see_equation(const ast::Equation& equation, Scope& scope) {
  if (const ast::Name* left = explicit_left(equation)) {
    if (!left->member.empty()) {
      equations_.pop_back();
      return refuse_equation_of_body(*left);
    }
    see_base(*left, scope, left->primes);
  } else {
    see_primes(equation.left, scope);
    see_primes(equation.right, scope);
  }
}

void Checker::see_condition(const ast::Condition& condition, Scope& scope, Span span) {
  if (const ast::Name& name = condition.name; !name.member.empty()) {
    fail("E226", name.span, fmt::format("the start of `{}` stands in the world", to_text(name)), {},
         fmt::format("write it there: body {} at (0, 0) velocity (0, 0)", name.text));
    return;
  }
  if (const auto base = see_base(condition.name, scope, 0)) conditions_.push_back({&condition, scope, span, *base});
}

/// After the walk: primes on the right of explicit equations may raise an order; then every variable has its place.
void Checker::lay_out() {
  for (Placed<ast::Equation>& equation : equations_) {
    if (explicit_left(*equation.text)) see_primes(equation.text->right, equation.scope);
  }
  for (const ConditionText& condition : conditions_) {
    Base& base = bases_[condition.base];
    if (base.order == 0) without_equation_.insert(condition.base);
  }
  for (const ConditionText& condition : conditions_) {
    Base& base = bases_[condition.base];
    if (without_equation_.contains(condition.base)) base.order = std::max(base.order, condition.text->name.primes + 1);
  }
  Layout& layout = model_.layout;
  std::size_t states = 0;
  for (Base& base : bases_) {
    base.first = states;
    states += static_cast<std::size_t>(base.order);
  }
  for (std::size_t i = 0; i < definitions_.size(); ++i) {
    if (definitions_[i].kind == Definition::Kind::parameter) parameter_order_.push_back(i);
  }
  // Unknowns lie behind the states: together they are what a solver solves for.
  std::uint32_t next = layout.unknowns = layout.states + static_cast<std::uint32_t>(states);
  for (UnknownText& unknown : unknowns_) unknown.variable = next++;
  layout.parameters = next;
  std::ranges::sort(parameter_order_, {},
                    [&](std::size_t i) { return std::pair(definitions_[i].text->span.begin, i); });
  for (const std::size_t i : parameter_order_) definitions_[i].variable = next++;
  layout.inputs = next;
  for (Definition& definition : definitions_) {
    if (definition.kind == Definition::Kind::input) definition.variable = next++;
  }
  layout.samples = layout.size = next;
  registers_.assign(next, 0.0);
  measures_.resize(states);
  measure_progress_.resize(states, Progress::untouched);
}

void Checker::name_states() {
  for (std::size_t b = 0; b < bases_.size(); ++b) {
    const Base& base = bases_[b];
    for (int k = 0; k < base.order; ++k) {
      const auto variable = model_.layout.states + static_cast<std::uint32_t>(model_.states.size());
      if (k > 0) hold_to_chain(b, k);
      const Measured measured = state_measure(b, k);
      model_.states.push_back({.base = base.name,
                               .primes = k,
                               .column = with_primes(base.name, k),
                               .variable = variable,
                               .unit = measured.is_known() ? to_text(measured.unit) : std::string(),
                               .initial = NodeId{},
                               .span = base.span,
                               .in_world = base.in_world});
    }
  }
}

/// The unit written beside x'(0) must be that of x by that of t, up to a factor.
void Checker::hold_to_chain(std::size_t index, int primes) {
  const Base& base = bases_[index];
  const Measured below = state_measure(index, primes - 1), own = state_measure(index, primes), rate = per_time(below);
  if (factor_between(own, rate)) return;
  const std::string name = with_primes(base.name, primes);
  for (const std::size_t i : base.conditions) {
    if (conditions_[i].text->name.primes != primes) continue;
    fail("E201", conditions_[i].span, "units do not match",
         fmt::format("`{}` is {}, so `{}` is {}, not {}", with_primes(base.name, primes - 1), unit_text(below), name,
                     unit_text(rate), unit_text(own)));
    conditions_[i].value.bad = true;
  }
  measures_[base.first + static_cast<std::size_t>(primes)] = rate;
}

// ---- units ----------------------------------------------------------------------------------------------------------

/// Of t in expressions: unknown where only the experiment has units.
Measured Checker::time_measure() const {
  return t_is_known_ ? time_or_number() : Measured::unknown();
}

/// Of times of the experiment and of events.
Measured Checker::time_or_number() const {
  return time_unit_ ? Measured::known(*time_unit_) : Measured::unknown();
}

/// Divided by the time unit so many times; multiplied where `times` is negative.
Measured Checker::per_time(const Measured& measured, int times) const {
  if (!measured.is_known() || !time_unit_) return Measured::unknown();
  Unit unit = measured.unit;
  for (int i = 0; i < times; ++i) unit = unit / *time_unit_;
  for (int i = times; i < 0; ++i) unit = unit * *time_unit_;
  return Measured::known(std::move(unit));
}

/// What the author wrote beside the initial value of this very component.
Measured Checker::own_measure(std::size_t base, int primes, std::size_t depth) {
  for (const std::size_t i : bases_[base].conditions) {
    ConditionText& condition = conditions_[i];
    if (condition.text->name.primes != primes) continue;
    const Value& value = condition_value(i, depth);
    if (value.measured.is_known()) return value.measured;
  }
  return Measured::unknown();
}

/// Its own initial value's unit, else the nearest one's of its chain times the unit of time.
Measured Checker::state_measure(std::size_t base, int primes, std::size_t depth) {
  const std::size_t state = bases_[base].first + static_cast<std::size_t>(primes);
  if (measure_progress_[state] == Progress::done) return measures_[state];
  if (measure_progress_[state] == Progress::busy) return Measured::unknown();
  measure_progress_[state] = Progress::busy;
  Measured found = own_measure(base, primes, depth);
  const int order = bases_[base].order;
  for (int distance = 1; distance < order && !found.is_known(); ++distance) {
    for (const int other : {primes - distance, primes + distance}) {
      if (other < 0 || other >= order || found.is_known()) continue;
      found = per_time(own_measure(base, other, depth), primes - other);
    }
  }
  measure_progress_[state] = Progress::done;
  measures_[state] = found;
  return found;
}

}  // namespace continuo::model::detail
