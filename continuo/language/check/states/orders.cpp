// continuo/language/check/states/orders.cpp
// A variable has the order of its highest derivative anywhere in the text.
#include <algorithm>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/names/functions.hpp>
#include <continuo/language/check/states/orders.hpp>
#include <continuo/language/syntax/format.hpp>

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
std::optional<std::size_t> StateOrders::see_base(const ast::Name& name, Scope& scope, int order) {
  if (!name.member.empty()) return std::nullopt;  // of a body: it is there, or the lookup says so
  const auto indexed_name = expressions_.indices.name_of(name, scope);
  if (!indexed_name) return std::nullopt;
  const Symbol* known = declared_.symbols.find(*indexed_name, Scope::no_mode);
  if (known && known->kind != Symbol::Kind::base) {
    const std::string key = indexed_name->text();
    const bool unknown = known->kind == Symbol::Kind::unknown;
    if (auto* said = report_.fail(
            "E213", name.span, fmt::format("`{}` cannot have an equation and a definition", key),
            "an equation or initial value for it",
            unknown ? "an unknown has no derivative and its start is a guess; drop `unknown`, or the primes"
                    : fmt::format("drop the definition of `{}` or this", key))) {
      said->related.push_back({known->span, "defined here"});
    }
    return std::nullopt;
  }
  const std::size_t index = known ? known->index : declared_.bases.size();
  if (!known) {
    const Symbol symbol{Symbol::Kind::base, index, name.span};
    if (!declared_.symbols.declare(name.text, indexed_name->indices, Scope::no_mode, symbol, report_))
      return std::nullopt;
    declared_.bases.push_back({indexed_name->text(), name.text, 0, 0, name.span});
  }
  Base& base = declared_.bases[index];
  if (order > base.order) {
    base.order = order;
    base.span = name.span;
  }
  return index;
}

void StateOrders::see_primes(const ast::Expression& expression, Scope& scope) {
  if (!has_primes(expression)) return;
  std::visit(
      [&](const auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Name>) {
          const auto key = expressions_.indices.name_of(node, scope);
          const Symbol* known = key ? declared_.symbols.find(*key, scope.mode) : nullptr;
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
          expressions_.indices.for_each_term(node, scope, [&] { see_primes(*node.body, scope); });
        } else if constexpr (std::is_same_v<T, ast::List>) {
          for (const ast::Expression& item : node.items) see_primes(item, scope);
        }
      },
      expression.node);
}

/// On the walk: what an equation determines comes in the order of the text.
void StateOrders::see_equation(const ast::Equation& equation, Scope& scope, Span span) {
  const ast::Name* left = explicit_left(equation);
  if (left && !left->member.empty()) return refuse_equation_of_body(*left, report_);
  std::size_t of = EquationText::no_base;
  if (left) {
    // A mode may have another meaning for a name, which is not looked for here.
    const auto base = see_base(*left, scope, left->primes);
    if (base && scope.mode == Scope::no_mode) of = *base;
  } else {
    see_primes(equation.left, scope);
    see_primes(equation.right, scope);
  }
  declared_.equations.push_back({&equation, scope, span, of});
}

void StateOrders::see_condition(const ast::Condition& condition, Scope& scope, Span span) {
  if (const ast::Name& name = condition.name; !name.member.empty()) {
    report_.fail("E226", name.span, fmt::format("the start of `{}` stands in the world", to_text(name)), {},
                 fmt::format("write it there: body {} at (0, 0) velocity (0, 0)", name.text));
    return;
  }
  if (const auto base = see_base(condition.name, scope, 0))
    declared_.conditions.push_back({&condition, scope, span, *base});
}

void StateOrders::finish() {
  std::unordered_map<const ast::Equation*, bool> has_primes_on_right;  // the same for all members of a family
  for (const EquationText& equation : declared_.equations) {
    if (!explicit_left(*equation.text)) continue;
    const auto [known, is_new] = has_primes_on_right.try_emplace(equation.text, false);
    if (is_new) known->second = has_primes(equation.text->right);
    if (!known->second) continue;
    Scope scope = equation.scope;
    see_primes(equation.text->right, scope);
  }
  sort_conditions();
  for (const ConditionText& condition : declared_.conditions) {
    Base& base = declared_.bases[condition.base];
    if (!base.has_equation) base.order = std::max(base.order, condition.text->name.primes + 1);
  }
}

/// Each base is given its conditions, in the order of the text.
void StateOrders::sort_conditions() {
  std::vector<std::size_t> end(declared_.bases.size(), 0);
  for (const ConditionText& condition : declared_.conditions) ++end[condition.base];
  std::size_t before = 0;
  for (std::size_t& place : end) place = std::exchange(before, before + place);  // where the conditions of each begin
  declared_.conditions_by_base.resize(declared_.conditions.size());
  for (std::size_t i = 0; i < declared_.conditions.size(); ++i)
    declared_.conditions_by_base[end[declared_.conditions[i].base]++] = i;
  std::size_t begin = 0;
  for (std::size_t b = 0; b < declared_.bases.size(); ++b) {
    Base& base = declared_.bases[b];
    base.conditions = std::span(declared_.conditions_by_base).subspan(begin, end[b] - begin);
    begin = end[b];
    if (!base.conditions.empty() && base.order == 0) base.has_equation = false;
  }
}

}  // namespace continuo::model::detail
