// continuo/solve/outcome.hpp
// The outcome of a run, and its cost.
#pragma once
#include <cstddef>
#include <string>

#include <continuo/status/status.hpp>

namespace continuo {

/// How a run ended. t and h are those of the last attempt; `error` is its estimate in units of the tolerance
/// (accepted where <= 1), `component` the worst of it.
template <class Real>
struct Outcome {
  Ending ending = Ending::reached_end;  // why the run ended
  Real t{};                             // the time of the last attempt
  Real h{};                             // its step size
  Real error{};                         // its error estimate, in units of the tolerance
  std::string component{};              // the worst component by name; empty where none is to blame
  std::string event{};                  // the event that stopped the run or accumulates
  Real limit_time{};                    // the limit of the times of accumulating events
  std::string hint{};                   // what to try

  /// Whether the run reached its end, or an event stopped it.
  explicit operator bool() const { return succeeded(ending); }
};

/// "half of the steps lie between t = 1 and t = 1.01".
[[nodiscard]] std::string where_steps_lie(double from, double to);

/// One sentence: how the run ended, its place, the cause, and a remedy.
[[nodiscard]] std::string describe(const Outcome<double>& outcome);

/// The outcome as a Status, as other functions of the library return it; its place is the time.
[[nodiscard]] Status status(const Outcome<double>& outcome);

namespace detail {
/// Compiled once: every program that includes <chrono> compiles a fifth of a second longer.
[[nodiscard]] double seconds_of_steady_clock();
}  // namespace detail

/// The cost of a run.
struct Statistics {
  std::size_t steps = 0;           // accepted
  std::size_t rejected = 0;        // tried and not accepted
  std::size_t evaluations = 0;     // of f
  std::size_t jacobians = 0;       // df/dx computed, for implicit methods
  std::size_t factorizations = 0;  // of their matrices
  std::size_t linear_solves = 0;   // with these factors
  std::size_t events = 0;          // fired
  double seconds = 0;              // wall time

  /// For checkpoints.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(steps, rejected, evaluations, jacobians, factorizations, linear_solves, events, seconds);
  }
};

}  // namespace continuo
