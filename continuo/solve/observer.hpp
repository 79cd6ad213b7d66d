// continuo/solve/observer.hpp
// The interface of observers, which watch a run step by step and event by event.
#pragma once
#include <cstddef>
#include <span>

#include <continuo/numerics/state.hpp>

namespace continuo {

/// The events of one instant. The references are valid during the call that gets it.
template <State X>
struct EventOccurrence {
  Scalar<X> t;                          // the instant
  std::span<const std::size_t> events;  // by number, in order of declaration
  const X& before;                      // the state before all of them
  const X& after;                       // the state after all of them
};

/// An observer of a run. The run calls `on_segment(integrator, from, to)` for every piece of the trajectory that is
/// final (integrator.at(t, x) gives x there), and `on_event(integrator, EventOccurrence)` at every event. One that has
/// `quiet_until(integrator)` gets no pieces that end before that time, where the run can do without.
struct NoObserver {
  /// Does nothing.
  template <class I, class Real>
  void on_segment(I&, Real, Real) {}
  /// Does nothing.
  template <class I, class Occurrence>
  void on_event(I&, const Occurrence&) {}
};

}  // namespace continuo
