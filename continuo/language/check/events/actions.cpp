// continuo/language/check/events/actions.cpp
// E251 and E252 where actions contradict each other or assign what is no state.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/events/actions.hpp>
#include <continuo/language/check/expressions/repair.hpp>
#include <continuo/language/check/names/functions.hpp>

namespace continuo::model::detail {

Block Actions::actions_of(const std::vector<ast::Action>& actions, Scope& scope) const {
  Block result = block(actions, scope);
  Taken taken;
  note_assignments(result, taken);
  return result;
}

Block Actions::block(const std::vector<ast::Action>& actions, Scope& scope) const {
  Block result;
  for (const ast::Action& action : actions) add(result, action, scope);
  return result;
}

void Actions::add(Block& to, const ast::Action& action, Scope& scope) const {
  std::visit(
      [&](const auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Assignment>) {
          if (auto made = assignment(node, scope)) to.push_back({*made, action.span});
        } else if constexpr (std::is_same_v<T, ast::If>) {
          const Value condition = expressions_.values.condition_of(node.condition, scope);
          Block then = block(node.then, scope), otherwise = block(node.otherwise, scope);
          to.push_back({If{condition.node, std::move(then), std::move(otherwise)}, action.span});
        } else if constexpr (std::is_same_v<T, ast::Go>) {
          if (const auto mode = mode_named(declared_, node.mode, report_)) to.push_back({Go{*mode}, action.span});
        } else if constexpr (std::is_same_v<T, ast::Mark>) {
          to.push_back({Mark{node.text}, action.span});
        } else if constexpr (std::is_same_v<T, ast::Stop>) {
          const auto after =
              node.after ? expressions_.indices.whole_number(*node.after, scope, "the count of `stop after`") : 1;
          if (after && *after < 1) report_.fail("E221", node.after->span, "`stop after` counts from 1");
          to.push_back({Stop{node.text, static_cast<std::size_t>(std::max(after.value_or(1), 1L))}, action.span});
        } else {
          expressions_.indices.for_each_index(node.index, node.range, scope, [&](std::size_t) {
            for (const ast::Action& member : node.body) add(to, member, scope);
          });
        }
      },
      action.node);
}

void Actions::refuse_without_symbol(const ast::Name& target, const std::string& key) const {
  const std::string_view meaning = meaning_of_its_own(target.text);
  if (!meaning.empty() || is_function(target.text)) {
    report_.fail(
        "E252", target.span, fmt::format("`{}` cannot be assigned", with_primes(key, target.primes)),
        meaning.empty() ? "this is a function" : std::string(meaning),
        target.text == "t" ? "time cannot be set; for a clock that can, write clock' = 1 and clock(0) = 0" : "");
  } else {
    expressions_.lookup.unknown_name(target, key, fmt::format("make it a state: {0}' = 0 and {0}(0) = ...", key));
  }
}

std::optional<Assign> Actions::assignment(const ast::Assignment& text, Scope& scope) const {
  const ast::Name& target = text.target;
  const auto indexed_name = expressions_.indices.name_of(target, scope);
  if (!indexed_name) return std::nullopt;
  const std::string key = indexed_name->text();
  const Symbol* symbol = declared_.symbols.find(*indexed_name, scope.mode);
  if (!symbol) {
    refuse_without_symbol(target, key);
    return std::nullopt;
  }
  if (symbol->kind == Symbol::Kind::body) {
    report_.fail("E252", target.span, fmt::format("`{}` cannot be assigned", key), "it is a body",
                 fmt::format("assign what of it changes: {0}.x := ..., {0}.x' := ...", key));
    return std::nullopt;
  }
  if (symbol->kind != Symbol::Kind::base) {
    report_.fail("E252", target.span, fmt::format("`{}` cannot be assigned", key), "only states change at an event",
                 fmt::format("make it a state: {0}' = 0 and {0}(0) = ... instead of its definition", key));
    return std::nullopt;
  }
  const Base& base = declared_.bases[symbol->index];
  const std::string name = with_primes(base.name, target.primes);
  if (base.is_measure) {
    report_.fail("E252", target.span, fmt::format("`{}` cannot be assigned", name), "it follows from the bodies",
                 "assign what of a body changes: ball.x := ..., ball.x' := ...");
    return std::nullopt;
  }
  if (target.primes >= base.order) {
    const bool highest = target.primes == base.order;
    report_.fail("E252", target.span, fmt::format("`{}` cannot be assigned", name),
                 highest ? "it follows from its equation" : fmt::format("`{}` is of order {}", base.name, base.order),
                 "assign one of its states, or go to another mode");
    return std::nullopt;
  }
  const Value value = expressions_.values.number_of(text.value, scope);
  if (value.bad) return std::nullopt;
  const std::size_t state = base.first + static_cast<std::size_t>(target.primes);
  const Measured& wanted = expressions_.workspace.units.of_state(state);
  if (!factor_between(value.measured, wanted)) {
    report_.fail("E201", cover(target.span, text.value.span), "units do not match",
                 fmt::format("`{}` is {}, {} is {}", name, unit_text(wanted), report_.quote(text.value.span),
                             unit_text(value.measured)),
                 repair(expressions_, {text.value, value}, wanted, scope));
    return std::nullopt;
  }
  return Assign{state, expressions_.operations.in_unit(text.value, value, wanted, name)};
}

/// All assignments of an event happen together, so on no path may one state be assigned twice.
void Actions::note_assignments(const Block& block, Taken& taken) const {
  for (const Action& action : block) {
    if (const auto* assign = std::get_if<Assign>(&action.what)) {
      const auto [before, is_new] = taken.states.try_emplace(assign->state, action.span);
      if (is_new) continue;
      auto* said = report_.fail(
          "E251", action.span,
          fmt::format("`{}` is assigned twice in one event",
                      name_of_variable(expressions_.workspace, expressions_.workspace.layout.states +
                                                                   static_cast<std::uint32_t>(assign->state))),
          "all assignments of an event happen together", "leave one, or choose by if ... else");
      if (said) said->related.push_back({before->second, "first here"});
    } else if (std::holds_alternative<Go>(action.what)) {
      if (taken.go) {
        auto* said =
            report_.fail("E251", action.span, "one event goes to two modes", {}, "leave one, or choose by if ... else");
        if (said) said->related.push_back({*taken.go, "first here"});
      }
      taken.go = action.span;
    } else if (const auto* choice = std::get_if<If>(&action.what)) {
      Taken then = taken, otherwise = taken;
      note_assignments(choice->then, then);
      note_assignments(choice->otherwise, otherwise);
      taken.states.merge(then.states);
      taken.states.merge(otherwise.states);
      if (!taken.go) taken.go = then.go ? then.go : otherwise.go;
    }
  }
}

}  // namespace continuo::model::detail
