// What an ensemble knows of each of its runs.
#pragma once
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <continuo/numerics/state.hpp>
#include <continuo/solve/outcome.hpp>
#include <continuo/solve/solution.hpp>

namespace continuo {

/// The result of one run.
template <State X, State P>
struct RunResult {
  std::size_t run = 0;                   // its number: its place in the list of starts
  Outcome<double> outcome{};             // why it ended, and when: a run that fails is a result too
  X x{};                                 // its last valid state, at outcome.t
  P p{};                                 // its parameters, as its events have left them
  std::size_t steps = 0;                 // accepted
  std::size_t rejected = 0;              // tried and not accepted
  std::vector<EventRecord<X>> events{};  // what has occurred, in the order of time
  std::vector<X> rows{};                 // the states at EnsembleOptions::save_at, as far as the run has come
};

/// The results of an ensemble.
template <State X, State P>
struct Ensemble {
  std::vector<RunResult<X, P>> runs{};     // by number; empty where EnsembleOptions::finished has got them
  std::vector<std::string> event_names{};  // by the number of the event, see EventRecord::event
  bool complete = true;                    // false: ended early, by `interrupt` or by `finished`

  /// The number of runs that have not come to their end, nor were stopped by an event: among those in `runs`.
  [[nodiscard]] std::size_t failures() const {
    return static_cast<std::size_t>(std::ranges::count_if(runs, [](const auto& one) { return !one.outcome; }));
  }
};

}  // namespace continuo
