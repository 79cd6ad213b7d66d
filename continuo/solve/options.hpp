// continuo/solve/options.hpp
// The options of a run, each with a good default: solve(f, x0, {0, 10}, Tsitouras5{}, {.rtol = 1e-9}).
#pragma once
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <continuo/solve/event.hpp>
#include <continuo/solve/steps/controller.hpp>

namespace continuo {

/// The time span of a run. If `to` is less than `from`, time runs backwards.
template <class Real>
struct Interval {
  Real from, to;
};

/// The states that a run keeps.
template <State X>
struct Save {
  using Real = Scalar<X>;
  /// Every accepted step, given times, a regular grid, every step with its polynomial, or the last state alone.
  enum class Kind { steps, times, grid, dense, end };
  Kind kind = Kind::steps;
  std::vector<Real> times{};                       // Kind::times, in the direction of time
  Real spacing{};                                  // Kind::grid: from, from + spacing, ...
  std::function<void(Real, const X&)> callback{};  // gets every saved state; with it nothing is stored

  /// Keeps the state after every accepted step.
  [[nodiscard]] static Save every_step() { return {}; }
  /// Keeps the states at these times, in the direction of time.
  [[nodiscard]] static Save at(std::vector<Real> times) { return {.kind = Kind::times, .times = std::move(times)}; }
  /// Keeps the states at from, from + spacing, and so on.
  [[nodiscard]] static Save every(Real spacing) { return {.kind = Kind::grid, .spacing = spacing}; }
  /// Keeps every step with its polynomial, so that the solution can be evaluated anywhere. Costs the memory of all
  /// polynomials.
  [[nodiscard]] static Save dense() { return {.kind = Kind::dense}; }
  /// Keeps the last state alone.
  [[nodiscard]] static Save only_end() { return {.kind = Kind::end}; }
};

/// The options of a run.
template <State X>
struct Options {
  using Real = Scalar<X>;
  Real rtol = Real(1e-6), atol = Real(1e-9);
  std::vector<Real> rtol_each{}, atol_each{};  // one per component, instead of the above
  Real step = 0;                               // > 0: fixed steps of this size, no error control
  Real first_step = 0;                         // 0: Hairer's estimate
  Real max_step = std::numeric_limits<Real>::infinity();
  Controller controller = PI;
  std::size_t max_steps = 10'000'000;  // accepted and rejected together
  std::size_t max_rejects_in_a_row = 60;
  std::vector<Event<X>> events{};
  Save<X> save{};
  const std::atomic<bool>* interrupt = nullptr;  // the run ends as `interrupted` once it is true
  std::function<void(Real)> progress{};          // called with t now and then (about every thousand steps)
};

}  // namespace continuo
