// continuo/language/check/states/initial_values.cpp
// x(0) = ...: initial values, or boundary values where they stand at several times.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/names/checker.hpp>

namespace continuo::model::detail {

const Value& Checker::condition_value(std::size_t index, std::size_t depth) {
  ConditionText& condition = conditions_[index];
  if (condition.progress == Progress::untouched) {
    condition.progress = Progress::busy;
    Scope scope = condition.scope;
    scope.samples = &condition.samples;
    scope.moment = &condition.text->time;
    scope.depth = depth;
    condition.value = elaborate(condition.text->value, scope);
    want_number(condition.text->value, condition.value);
    condition.progress = Progress::done;
  }
  return condition.value;
}

void Checker::make_conditions() {
  start_time_ = model_.run.from ? model_.run.from->value : 0;
  bool all_at_start = true;
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    ConditionText& condition = conditions_[i];
    condition.time = time_setting(condition.text->time, condition.scope, "the time of a condition");
    const auto is_elsewhere = [&](const Setting& time) { return time.value != start_time_; };
    if (condition.time && is_elsewhere(*condition.time)) all_at_start = false;
    if (std::ranges::any_of(condition.samples, is_elsewhere, &Sample::when)) all_at_start = false;
  }
  for (std::size_t i = 0; i < conditions_.size(); ++i) place_condition(i, all_at_start);
  if (all_at_start) {
    missing_conditions();
    solve_starts();
  } else {
    count_conditions();
  }
  make_guesses();
}

/// Of a boundary-value problem: as many as there are numbers to find.
void Checker::count_conditions() {
  const std::size_t needed = model_.states.size() + unknowns_.size();
  if (errors_ > 0 || model_.boundary.size() == needed) return;
  fail("E244", conditions_.back().span,
       fmt::format("{} boundary conditions are needed, one per state{}", needed,
                   unknowns_.empty() ? "" : " and unknown"),
       fmt::format("here are {}", model_.boundary.size()));
}

void Checker::place_condition(std::size_t index, bool initial) {
  ConditionText& condition = conditions_[index];
  const Base& base = bases_[condition.base];
  const int primes = condition.text->name.primes;
  if (primes >= base.order) {
    fail("E242", condition.text->name.span, fmt::format("`{}` needs no initial value", with_primes(base.name, primes)),
         primes == base.order
             ? "it follows from its equation"
             : fmt::format("the highest derivative in the equations is `{}`", with_primes(base.name, base.order)));
    return;
  }
  const std::size_t state = base.first + static_cast<std::size_t>(primes);
  const Value& value = condition_value(index);
  const auto stands_alone = [&] {
    return only_parameters(value.node, condition.text->value.span, "a condition at several times",
                           "name what changes with a time, as in x(0)");
  };
  if (value.bad || !condition.time || (!initial && !stands_alone())) {
    condition_seen_.try_emplace({state, 0.0}, condition.span);
    return;
  }
  const auto [first, is_new] = condition_seen_.try_emplace({state, condition.time->value}, condition.span);
  if (!is_new) {
    auto* said = fail("E241", condition.span,
                      fmt::format("`{}({:g})` is given twice", with_primes(base.name, primes), condition.time->value));
    if (said && first->second != condition.span) said->related.push_back({first->second, "first here"});
    return;
  }
  const NodeId node =
      in_unit(condition.text->value, value, measures_[state], "`" + with_primes(base.name, primes) + "`");
  if (condition.time->value == start_time_ && (initial || condition.samples.empty())) {
    model_.states[state].initial = node;
    model_.states[state].span = condition.span;
  }
  if (initial) return;
  if (!is_in_run(*condition.time)) {
    fail("E245", condition.span, "this condition stands outside of the run",
         fmt::format("the run goes from {:g} to {:g}", start_time_, model_.run.to->value),
         "let the run reach it, or move it");
  }
  model_.boundary.push_back({state, *condition.time, node, condition.samples, condition.span});
}

/// One message per family, about its first member without a value.
void Checker::missing_conditions() {
  std::set<std::string> said;
  for (std::size_t b = 0; b < bases_.size(); ++b) {
    const Base& base = bases_[b];
    if (base.in_world || without_equation_.contains(b) || lost_.contains(base.family)) continue;
    std::vector<std::string> missing, needed;
    for (int k = 0; k < base.order; ++k) {
      const std::size_t state = base.first + static_cast<std::size_t>(k);
      const std::string text = fmt::format("{}({:g})", with_primes(base.name, k), start_time_);
      needed.push_back(text);
      const bool wrong = condition_seen_.contains({state, 0.0});
      if (!model_.states[state].initial.valid() && !wrong) missing.push_back(text);
    }
    if (missing.empty() || !said.insert(base.family).second) continue;
    std::string statement;
    for (const std::string& text : missing) statement += (statement.empty() ? "" : ";  ") + text + " = ...";
    fail("E240", base.span, fmt::format("{} {} missing", listed(missing), missing.size() == 1 ? "is" : "are"),
         fmt::format("`{}` needs {}", with_primes(base.name, base.order), listed(needed)), "add " + statement);
  }
}

void Checker::make_guesses() {
  for (Placed<ast::Guess>& guess : guesses_) {
    const auto key = key_of(guess.text->name, guess.scope);
    const Symbol* symbol = key ? find(*key, Scope::no_mode) : nullptr;
    if (!key) continue;
    const ast::Name& name = guess.text->name;
    if (!symbol || symbol->kind != Symbol::Kind::base || name.primes >= bases_[symbol->index].order) {
      fail("E242", name.span,
           fmt::format("`{}` is no state, so there is nothing to guess", with_primes(*key, name.primes)));
      continue;
    }
    const std::size_t state = bases_[symbol->index].first + static_cast<std::size_t>(name.primes);
    const Value value = number_of(guess.text->value, guess.scope);
    if (value.bad) continue;
    model_.guesses.push_back(
        {state, in_unit(guess.text->value, value, measures_[state], quote(name.span)), guess.span});
  }
  for (State& state : model_.states) {  // of a boundary-value problem: where the search begins
    if (!state.initial.valid()) state.initial = model_.graph.constant(0);
  }
}

}  // namespace continuo::model::detail
