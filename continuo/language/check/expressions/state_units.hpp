// continuo/language/check/expressions/state_units.hpp
// Conditions, `x(0) = 3 [m]`, each translated when it is first asked for; and the units of states, which they state.
#pragma once
#include <cstddef>
#include <map>
#include <vector>

#include <continuo/language/check/expressions/family_translator.hpp>
#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

class Expressions;
struct Workspace;

class ConditionValues {
 public:
  struct Entry {
    Value value{};
    Progress progress = Progress::untouched;
  };

  explicit ConditionValues(Workspace& workspace) : workspace_(workspace) {}

  /// `depth`: of the expression that asks.
  Entry& of(std::size_t condition, std::size_t depth = 0);
  void find_all();
  /// `x(10)` in the value of a condition that has been found: few have any.
  [[nodiscard]] const std::vector<Sample>& samples_of(std::size_t condition) const;
  /// By condition.
  [[nodiscard]] const std::map<std::size_t, std::vector<Sample>>& samples() const { return samples_; }

 private:
  Entry& of(const Expressions& expressions, std::size_t condition, std::size_t depth);

  Workspace& workspace_;
  std::vector<Entry> entries_;
  std::map<std::size_t, std::vector<Sample>> samples_;
  FamilyTranslator members_;
};

class StateUnits {
 public:
  explicit StateUnits(Workspace& workspace) : workspace_(workspace) {}

  /// Its own initial value's unit, else the nearest one's of its chain times the unit of time.
  Measured of(std::size_t base, int primes, std::size_t depth = 0);
  /// Of a state whose unit has been found.
  [[nodiscard]] const Measured& of_state(std::size_t state) const { return units_[state]; }
  void set(std::size_t state, const Measured& unit);
  void reserve(std::size_t states);

 private:
  [[nodiscard]] Measured own(std::size_t base, int primes, std::size_t depth);

  Workspace& workspace_;
  std::vector<Measured> units_;
  std::vector<Progress> progress_;
};

}  // namespace continuo::model::detail
