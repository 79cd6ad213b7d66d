// continuo/language/check/states/initial_values.hpp
// x(0) = ...: initial values, or boundary values where they stand at several times.
#pragma once
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

/// What the search of a boundary-value problem is given.
struct BoundaryProblem {
  std::vector<BoundaryCondition> conditions;
  std::vector<Guess> guesses;
};

/// Gives the states their initial values; what stands at several times is returned.
class InitialValues {
 public:
  InitialValues(Expressions& expressions, std::vector<State>& states);
  [[nodiscard]] BoundaryProblem make();

 private:
  void count_conditions() const;
  [[nodiscard]] const std::optional<Setting>& find_time(std::size_t index);
  void place_condition(std::size_t index, const std::optional<Setting>& time, bool initial);
  [[nodiscard]] std::pair<Span, bool> see(std::size_t state, double time, Span span);
  void missing_conditions() const;
  void make_guesses();

  Expressions& expressions_;
  Report& report_;
  const Declarations& declared_;
  const RunSettings& run_;
  std::vector<State>& states_;
  double start_time_;
  /// Where a state has a value at a time first.
  struct Seen {
    double time = std::numeric_limits<double>::quiet_NaN();  // of none
    Span span{};
  };

  /// Of the conditions before `end` and behind those of the times before it.
  struct Time {
    std::size_t end;
    std::optional<Setting> time;
  };

  std::vector<Time> times_;
  std::vector<Seen> seen_;                                // the first value of each state
  std::vector<bool> has_wrong_value_;                     // of each state: a value that is reported already
  std::map<std::pair<std::size_t, double>, Span> later_;  // at other times, by state and time
  BoundaryProblem made_;
};

}  // namespace continuo::model::detail
