// continuo/solve/options.hpp
// The options of a run, each with a good default: solve(f, x0, {0, 10}, Tsitouras5{}, {.rtol = 1e-9}).
#pragma once
#include <atomic>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/solve/correction.hpp>
#include <continuo/solve/event.hpp>
#include <continuo/solve/steps/controller.hpp>

namespace continuo {

/// The time span of a run. If `to` is less than `from`, time runs backwards.
template <class Real>
struct Interval {
  Real from;  // the time at which the run begins
  Real to;    // the time at which it ends
};

/// A function that watches a run. It returns nothing, or a bool: `false` ends the run.
template <class... Arguments>
class Callback {
 public:
  Callback() = default;
  /// No function.
  explicit(false) Callback(std::nullptr_t) {}
  /// Any function of these arguments that returns nothing or a bool; anything else is refused by the compiler.
  template <class F>
    requires(!std::same_as<std::remove_cvref_t<F>, Callback>)
  explicit(false) Callback(F&& f) {
    if constexpr (check<std::remove_cvref_t<F>>()) {
      using Result = std::invoke_result_t<std::remove_cvref_t<F>&, Arguments...>;
      if constexpr (std::same_as<Result, bool>) {
        f_ = std::forward<F>(f);
      } else if constexpr (requires { f.target_type(); }) {  // a std::function may be empty
        if (f) wrap(std::forward<F>(f));
      } else {
        wrap(std::forward<F>(f));
      }
    }
  }

  /// Whether there is a function.
  explicit operator bool() const { return static_cast<bool>(f_); }
  /// Whether the run is to continue.
  bool operator()(Arguments... arguments) const { return f_(arguments...); }

 private:
  template <class F>
  [[nodiscard]] static consteval bool check() {
    constexpr bool callable = std::invocable<F&, Arguments...>;
    static_assert(callable,
                  "a callback of a run gets constants: [](double t, const X& x) for saved states, [](double t) for the "
                  "progress, with X the type of the state x0");
    if constexpr (callable) {
      using Result = std::invoke_result_t<F&, Arguments...>;
      constexpr bool usable = std::same_as<Result, void> || std::same_as<Result, bool>;
      static_assert(usable, "a callback of a run returns nothing, or a bool of which false ends the run");
      return usable;
    } else {
      return false;
    }
  }
  template <class F>
  void wrap(F&& f) {
    f_ = [call = std::forward<F>(f)](Arguments... arguments) mutable {
      call(arguments...);
      return true;
    };
  }

  std::function<bool(Arguments...)> f_;
};

/// The states that a run keeps. For `times` and `grid` these are the states at the times asked for and no others: one
/// for each time up to the end of the run, after the events at that time. The other kinds also keep the state before
/// and after every event, and the last one.
template <State X>
struct Save {
  using Real = Scalar<X>;
  /// Every accepted step, given times, a regular grid, every step with its polynomial, or the last state alone.
  enum class Kind { steps, times, grid, dense, end };
  Kind kind = Kind::steps;  // which states are kept
  using Watcher = Callback<Real, const X&>;
  std::vector<Real> times{};  // Kind::times, in the direction of time, within the run
  Real spacing{};             // Kind::grid: from, from + spacing, ...
  Watcher callback{};         // gets every saved state; with it no states are stored

  /// Keeps the state after every accepted step.
  [[nodiscard]] static Save every_step(Watcher callback = {}) { return {.callback = std::move(callback)}; }
  /// Keeps the states at these times, in the direction of time.
  [[nodiscard]] static Save at(std::vector<Real> times, Watcher callback = {}) {
    return {.kind = Kind::times, .times = std::move(times), .callback = std::move(callback)};
  }
  /// Keeps the states at from, from + spacing, and so on.
  [[nodiscard]] static Save every(Real spacing, Watcher callback = {}) {
    return {.kind = Kind::grid, .spacing = spacing, .callback = std::move(callback)};
  }
  /// Keeps every step with its polynomial, so that the solution can be evaluated anywhere. Costs the memory of all
  /// polynomials.
  [[nodiscard]] static Save dense() { return {.kind = Kind::dense}; }
  /// Keeps the last state alone.
  [[nodiscard]] static Save only_end() { return {.kind = Kind::end}; }
};

namespace detail {
struct NoCallback {};
}  // namespace detail

/// The states to keep, where no type of state is named: it becomes a `Save` for the state of the run.
template <class Real = double, class Call = detail::NoCallback>
struct SaveOf {
  /// As Save::Kind.
  enum class Kind { steps, times, grid, dense, end };
  Kind kind;                  // which states are kept
  std::vector<Real> times{};  // Kind::times, in the direction of time, within the run
  Real spacing{};             // Kind::grid: from, from + spacing, ...
  Call callback{};            // gets every saved state; with it no states are stored

  /// The same, with a function that gets the states instead of the solution.
  template <class F>
  [[nodiscard]] SaveOf<Real, F> into(F f) const {
    return {static_cast<typename SaveOf<Real, F>::Kind>(kind), times, spacing, std::move(f)};
  }

  /// The same for states of the type X.
  template <State X>
  explicit(false) operator Save<X>() const {
    Save<X> save{.kind = static_cast<typename Save<X>::Kind>(kind), .spacing = static_cast<Scalar<X>>(spacing)};
    for (const Real& time : times) save.times.push_back(static_cast<Scalar<X>>(time));
    if constexpr (!std::same_as<Call, detail::NoCallback>) save.callback = callback;
    return save;
  }
};

/// Keeps the state after every accepted step.
[[nodiscard]] inline SaveOf<> save_every_step() {
  return {SaveOf<>::Kind::steps};
}
/// Keeps the states at these times, in the direction of time.
template <class Real = double>
[[nodiscard]] SaveOf<Real> save_at(std::vector<Real> times) {
  return {SaveOf<Real>::Kind::times, std::move(times)};
}
/// Keeps the states at from, from + spacing, and so on.
template <class Real>
[[nodiscard]] SaveOf<std::common_type_t<Real, double>> save_every(Real spacing) {
  using Time = std::common_type_t<Real, double>;
  return {SaveOf<Time>::Kind::grid, {}, static_cast<Time>(spacing)};
}
/// Keeps every step with its polynomial, so that the solution can be evaluated anywhere.
[[nodiscard]] inline SaveOf<> save_dense() {
  return {SaveOf<>::Kind::dense};
}
/// Keeps the last state alone.
[[nodiscard]] inline SaveOf<> save_only_end() {
  return {SaveOf<>::Kind::end};
}

/// The options of a run.
template <State X>
struct Options {
  using Real = Scalar<X>;
  Real rtol = Real(1e-6);                                 // the error allowed in a step, relative to each component
  Real atol = Real(1e-9);                                 // and its absolute part, in the unit of the components
  std::vector<Real> rtol_each{};                          // one per component, instead of rtol
  std::vector<Real> atol_each{};                          // one per component, instead of atol
  Real step = 0;                                          // > 0: fixed steps of this size, no error control
  Real first_step = 0;                                    // the size that is tried first; 0: Hairer's estimate
  Real max_step = std::numeric_limits<Real>::infinity();  // no step is longer
  Controller controller = PI;                             // how the next step follows from the error
  std::size_t max_steps = 10'000'000;                     // accepted and rejected together
  std::size_t max_rejects_in_a_row = 60;                  // at more the run ends as `too_many_rejects`
  std::vector<Event<X>> events{};                         // in the order in which they fire at one instant
  Save<X> save{};                                         // which states the solution keeps
  const std::atomic<bool>* interrupt = nullptr;           // the run ends as `interrupted` once it is true
  Callback<Real> progress{};                              // called with t now and then (about every thousand steps)
  Projection<X> projection{};                             // onto invariants, after every step
  std::vector<Sign> signs{};                              // of the components, one for each; empty: any
};

}  // namespace continuo
