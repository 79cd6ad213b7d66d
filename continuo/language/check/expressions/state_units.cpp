// continuo/language/check/expressions/state_units.cpp
// Units of states come from their conditions, and through those of their chain, x, x', ...
#include <utility>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

ConditionValues::Entry& ConditionValues::of(std::size_t index, std::size_t depth) {
  if (index < entries_.size() && entries_[index].progress != Progress::untouched) return entries_[index];
  return of(Expressions(workspace_), index, depth);
}

ConditionValues::Entry& ConditionValues::of(const Expressions& expressions, std::size_t index, std::size_t depth) {
  const auto& conditions = workspace_.declared.conditions;
  if (entries_.size() < conditions.size()) entries_.resize(conditions.size());
  Entry& entry = entries_[index];
  if (entry.progress != Progress::untouched) return entry;
  entry.progress = Progress::busy;
  const ast::Condition& text = *conditions[index].text;
  Scope scope = conditions[index].scope;
  std::vector<Sample> samples;
  scope.samples = &samples;
  scope.moment = &text.time;
  scope.depth = depth;
  entry.value = members_.translate(expressions, text.value, scope);
  expressions.operations.want_number(text.value, entry.value);
  if (!samples.empty()) samples_.emplace(index, std::move(samples));
  entry.progress = Progress::done;
  return entry;
}

const std::vector<Sample>& ConditionValues::samples_of(std::size_t condition) const {
  static const std::vector<Sample> none;
  const auto found = samples_.find(condition);
  return found == samples_.end() ? none : found->second;
}

void ConditionValues::find_all() {
  const Expressions expressions(workspace_);
  for (std::size_t i = 0; i < workspace_.declared.conditions.size(); ++i) of(expressions, i, 0);
}

void StateUnits::reserve(std::size_t states) {
  units_.resize(states);
  progress_.resize(states, Progress::untouched);
}

void StateUnits::set(std::size_t state, const Measured& unit) {
  units_[state] = unit;
  progress_[state] = Progress::done;
}

/// What the author wrote beside the initial value of this very component.
Measured StateUnits::own(std::size_t base, int primes, std::size_t depth) {
  for (const std::size_t i : workspace_.declared.bases[base].conditions) {
    if (workspace_.declared.conditions[i].text->name.primes != primes) continue;
    const Value& value = workspace_.conditions.of(i, depth).value;
    if (value.measured.is_known()) return value.measured;
  }
  return Measured::unknown();
}

Measured StateUnits::of(std::size_t base, int primes, std::size_t depth) {
  const std::size_t state = workspace_.declared.bases[base].first + static_cast<std::size_t>(primes);
  if (progress_[state] == Progress::done) return units_[state];
  if (progress_[state] == Progress::busy) return Measured::unknown();
  progress_[state] = Progress::busy;
  Measured found = own(base, primes, depth);
  const int order = workspace_.declared.bases[base].order;
  for (int distance = 1; distance < order && !found.is_known(); ++distance) {
    for (const int other : {primes - distance, primes + distance}) {
      if (other < 0 || other >= order || found.is_known()) continue;
      found = workspace_.time.per_time(own(base, other, depth), primes - other);
    }
  }
  progress_[state] = Progress::done;
  units_[state] = found;
  return found;
}

}  // namespace continuo::model::detail
