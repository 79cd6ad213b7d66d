// continuo/solve/observer.hpp
// Who watches a run, step by step and event by event.
#pragma once
#include <cstddef>
#include <span>

#include <continuo/numerics/state.hpp>

namespace continuo {

/// An event as it happened. The references hold during the call that gets it.
template <State X>
struct Happening {
  Scalar<X> t;
  std::span<const std::size_t> events;  // by number, in order of declaration
  const X& before;
  const X& after;
};

/// Who watches a run: `on_segment(integrator, from, to)` for every piece of trajectory that stands (integrator.at(t, x)
/// gives x there), `on_event(integrator, Happening)` at every event.
struct NoObserver {
  template <class I, class Real>
  void on_segment(I&, Real, Real) {}
  template <class I, class H>
  void on_event(I&, const H&) {}
};

}  // namespace continuo
