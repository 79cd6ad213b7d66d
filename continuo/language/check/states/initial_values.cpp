// continuo/language/check/states/initial_values.cpp
// Conditions at the start are initial values; once one stands elsewhere all are boundary values.
#include <algorithm>
#include <cmath>
#include <ranges>
#include <set>

#include <fmt/format.h>

#include <continuo/language/check/states/initial_values.hpp>
#include <continuo/language/check/states/starts.hpp>

namespace continuo::model::detail {

InitialValues::InitialValues(Expressions& expressions, std::vector<State>& states)
    : expressions_(expressions),
      report_(expressions.report),
      declared_(expressions.workspace.declared),
      run_(expressions.workspace.run),
      states_(states),
      start_time_(run_.from ? run_.from->value : 0),
      seen_(states.size()),
      has_wrong_value_(states.size(), false) {}

BoundaryProblem InitialValues::make() {
  bool all_at_start = true;
  const auto is_elsewhere = [&](const Setting& time) { return time.value != start_time_; };
  for (std::size_t i = 0; i < declared_.conditions.size(); ++i) {
    const std::optional<Setting>& time = find_time(i);
    if (time && is_elsewhere(*time)) all_at_start = false;
    if (std::ranges::any_of(expressions_.workspace.conditions.samples_of(i), is_elsewhere, &Sample::when))
      all_at_start = false;
  }
  std::size_t next = 0;
  for (const Time& time : times_)
    for (; next < time.end; ++next) place_condition(next, time.time, all_at_start);
  if (all_at_start) {
    missing_conditions();
    solve_starts(expressions_, states_, start_time_);
  } else {
    count_conditions();
  }
  make_guesses();
  return std::move(made_);
}

/// A number, as in u[i](0) = ..., is the same for all members of a family.
const std::optional<Setting>& InitialValues::find_time(std::size_t index) {
  const ConditionText& condition = declared_.conditions[index];
  const bool is_number = std::holds_alternative<ast::Number>(condition.text->time.node);
  if (is_number && index > 0 && times_.back().time && declared_.conditions[index - 1].text == condition.text) {
    times_.back().end = index + 1;
    return times_.back().time;
  }
  Scope scope = condition.scope;
  times_.push_back(
      {index + 1, expressions_.values.time_setting(condition.text->time, scope, "the time of a condition")});
  return times_.back().time;
}

/// Where the state has a value at this time first, and whether that is here.
std::pair<Span, bool> InitialValues::see(std::size_t state, double time, Span span) {
  Seen& first = seen_[state];
  if (std::isnan(first.time)) {
    first = {time, span};
    return {span, true};
  }
  if (first.time == time) return {first.span, false};
  const auto [other, is_new] = later_.try_emplace({state, time}, span);
  return {other->second, is_new};
}

/// Of a boundary-value problem: as many as there are numbers to find.
void InitialValues::count_conditions() const {
  const std::size_t needed = states_.size() + declared_.unknowns.size();
  if (report_.errors() > 0 || made_.conditions.size() == needed) return;
  report_.fail("E244", declared_.conditions.back().span,
               fmt::format("{} boundary conditions are needed, one per state{}", needed,
                           declared_.unknowns.empty() ? "" : " and unknown"),
               fmt::format("here are {}", made_.conditions.size()));
}

void InitialValues::place_condition(std::size_t index, const std::optional<Setting>& time, bool initial) {
  const ConditionText& condition = declared_.conditions[index];
  const Value& value = expressions_.workspace.conditions.of(index).value;
  const std::vector<Sample>& samples = expressions_.workspace.conditions.samples_of(index);
  const Base& base = declared_.bases[condition.base];
  const int primes = condition.text->name.primes;
  if (primes >= base.order) {
    report_.fail(
        "E242", condition.text->name.span, fmt::format("`{}` needs no initial value", with_primes(base.name, primes)),
        primes == base.order
            ? "it follows from its equation"
            : fmt::format("the highest derivative in the equations is `{}`", with_primes(base.name, base.order)));
    return;
  }
  const std::size_t state = base.first + static_cast<std::size_t>(primes);
  const auto stands_alone = [&] {
    return expressions_.values.only_parameters(value.node, condition.text->value.span, "a condition at several times",
                                               "name what changes with a time, as in x(0)");
  };
  if (value.bad || !time || (!initial && !stands_alone())) {
    has_wrong_value_[state] = true;
    static_cast<void>(see(state, 0, condition.span));
    return;
  }
  const auto [first, is_new] = see(state, time->value, condition.span);
  if (!is_new) {
    auto* said = report_.fail("E241", condition.span,
                              fmt::format("`{}({:g})` is given twice", with_primes(base.name, primes), time->value));
    if (said && first != condition.span) said->related.push_back({first, "first here"});
    return;
  }
  const Measured& unit = expressions_.workspace.units.of_state(state);
  const bool fits = factor_between(value.measured, unit).has_value();  // then nobody reads the name
  const NodeId node = expressions_.operations.in_unit(
      condition.text->value, value, unit, fits ? std::string() : fmt::format("`{}`", with_primes(base.name, primes)));
  if (time->value == start_time_ && (initial || samples.empty())) {
    states_[state].initial = node;
    states_[state].span = condition.span;
  }
  if (initial) return;
  if (!is_in_run(*time, run_)) {
    report_.fail("E245", condition.span, "this condition stands outside of the run",
                 fmt::format("the run goes from {:g} to {:g}", start_time_, run_.to->value),
                 "let the run reach it, or move it");
  }
  made_.conditions.push_back({state, *time, node, samples, condition.span});
}

/// One message per family, about its first member without a value.
void InitialValues::missing_conditions() const {
  std::set<std::string> said;
  for (std::size_t b = 0; b < declared_.bases.size(); ++b) {
    const Base& base = declared_.bases[b];
    if (base.in_world || !base.has_equation || declared_.symbols.is_lost(base.family)) continue;
    const auto is_missing = [&](int k) {
      const std::size_t state = base.first + static_cast<std::size_t>(k);
      return !states_[state].initial.valid() && !has_wrong_value_[state];
    };
    if (std::ranges::none_of(std::views::iota(0, base.order), is_missing) || !said.emplace(base.family).second)
      continue;
    std::vector<std::string> missing, needed;
    for (int k = 0; k < base.order; ++k) {
      const std::string text = fmt::format("{}({:g})", with_primes(base.name, k), start_time_);
      needed.push_back(text);
      if (is_missing(k)) missing.push_back(text);
    }
    std::string statement;
    for (const std::string& text : missing) statement += (statement.empty() ? "" : ";  ") + text + " = ...";
    report_.fail("E240", base.span, fmt::format("{} {} missing", listed(missing), missing.size() == 1 ? "is" : "are"),
                 fmt::format("`{}` needs {}", with_primes(base.name, base.order), listed(needed)), "add " + statement);
  }
}

void InitialValues::make_guesses() {
  for (const Placed<ast::Guess>& guess : declared_.guesses) {
    Scope scope = guess.scope;
    const auto key = expressions_.indices.name_of(guess.text->name, scope);
    const Symbol* symbol = key ? declared_.symbols.find(*key, Scope::no_mode) : nullptr;
    if (!key) continue;
    const ast::Name& name = guess.text->name;
    if (!symbol || symbol->kind != Symbol::Kind::base || name.primes >= declared_.bases[symbol->index].order) {
      report_.fail(
          "E242", name.span,
          fmt::format("`{}` is no state, so there is nothing to guess", with_primes(key->text(), name.primes)));
      continue;
    }
    const std::size_t state = declared_.bases[symbol->index].first + static_cast<std::size_t>(name.primes);
    const Value value = expressions_.values.number_of(guess.text->value, scope);
    if (value.bad) continue;
    made_.guesses.push_back(
        {state,
         expressions_.operations.in_unit(guess.text->value, value, expressions_.workspace.units.of_state(state),
                                         report_.quote(name.span)),
         guess.span});
  }
  for (State& state : states_) {  // of a boundary-value problem: where the search begins
    if (!state.initial.valid()) state.initial = expressions_.workspace.graph.constant(0);
  }
}

}  // namespace continuo::model::detail
