// continuo/solve/event.hpp
// When something happens, and what. The order of things at an event, as everywhere in Continuo:
//   1. x before: the state at the event's time t, on the far side of the root (the condition is true there).
//   2. Every event of that instant reads x before and writes x after, in the order of declaration.
//   3. Guards that the new state pushed through zero fire in a further round, until none does.
//
//   auto floor = falls<X>("floor", [](double, const X& x) { return x[0]; },
//                         [](auto& now) { now.x[0] = 0; now.x[1] = -0.9 * now.before[1]; });
#pragma once
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/numerics/state.hpp>
#include <continuo/solve/direction.hpp>

namespace continuo {

/// What an action sees and may change.
template <State X>
struct EventAction {
  Scalar<X> t;
  const X& before;
  X& x;  // starts as `before`
  bool stop = false;
  bool restart = false;  // set it where the action changed f but not x (a mode kept outside the state)
};

template <State X>
using Guard = std::function<Scalar<X>(Scalar<X>, const X&)>;
template <State X>
using Action = std::function<void(EventAction<X>&)>;

/// One event: a guard with a direction, or times. Without an action it is only noted.
template <State X>
struct Event {
  std::string name{};
  Guard<X> guard{};  // empty: the event is scheduled
  Direction direction = Direction::crosses;
  Action<X> action{};
  std::vector<Scalar<X>> times{};  // scheduled, in ascending order
  Scalar<X> period{}, from{};      // scheduled at from, from + period, ... where period > 0
  std::size_t stop_after = 0;      // the run stops at this many firings; 0: never
};

template <State X>
Event<X> falls(std::string name, Guard<X> guard, Action<X> action = {}) {
  return {
      .name = std::move(name), .guard = std::move(guard), .direction = Direction::falls, .action = std::move(action)};
}
template <State X>
Event<X> rises(std::string name, Guard<X> guard, Action<X> action = {}) {
  return {
      .name = std::move(name), .guard = std::move(guard), .direction = Direction::rises, .action = std::move(action)};
}
template <State X>
Event<X> crosses(std::string name, Guard<X> guard, Action<X> action = {}) {
  return {.name = std::move(name), .guard = std::move(guard), .action = std::move(action)};
}
template <State X>
Event<X> at(std::string name, std::vector<Scalar<X>> times, Action<X> action) {
  return {.name = std::move(name), .action = std::move(action), .times = std::move(times)};
}
/// Fires at from, from + period, from + 2 period, ...
template <State X>
Event<X> every(std::string name, Scalar<X> period, Scalar<X> from, Action<X> action) {
  return {.name = std::move(name), .action = std::move(action), .period = period, .from = from};
}

/// What firing did.
struct EventResponse {
  bool stop = false;
  bool restart = false;  // the state or f changed
};

/// The driver asks a source of events these things. `size()` counts guards and scheduled ones together, in the order
/// of declaration.
///   name(i), direction(i), active(system, i)
///   is_guard(i); guards(system, t, x, span of size() values): g_i, anything for those not guards or not active
///   next_time(i, t, inclusive): the first scheduled time > t (>= t where inclusive), infinity where none
///   fire(system, fired, t, before, x) -> EventResponse
/// and, where it knows, only_notes(i): firing changes nothing and never stops the run.
template <class S, class System, class X>
concept EventSource = State<X> && requires(S& s, const S& constant, System& system, const X& before, X& x,
                                           std::span<Scalar<X>> values, std::span<const std::size_t> fired) {
  { constant.size() } -> std::convertible_to<std::size_t>;
  { constant.name(std::size_t{}) } -> std::convertible_to<std::string_view>;
  { constant.direction(std::size_t{}) } -> std::same_as<Direction>;
  { constant.is_guard(std::size_t{}) } -> std::convertible_to<bool>;
  { constant.active(system, std::size_t{}) } -> std::convertible_to<bool>;
  { constant.next_time(std::size_t{}, Scalar<X>{}, true) } -> std::convertible_to<Scalar<X>>;
  s.guards(system, Scalar<X>{}, before, values);
  { s.fire(system, fired, Scalar<X>{}, before, x) } -> std::same_as<EventResponse>;
};

/// The source that a list of `Event` makes.
template <State X>
class EventList {
 public:
  using Real = Scalar<X>;
  EventList() = default;
  explicit EventList(std::vector<Event<X>> events) : events_(std::move(events)), fired_(events_.size(), 0) {}

  std::size_t size() const { return events_.size(); }
  std::string_view name(std::size_t i) const { return events_[i].name; }
  Direction direction(std::size_t i) const { return events_[i].direction; }
  bool is_guard(std::size_t i) const { return static_cast<bool>(events_[i].guard); }
  bool only_notes(std::size_t i) const { return !events_[i].action && events_[i].stop_after == 0; }
  template <class System>
  bool active(const System&, std::size_t) const {
    return true;
  }

  template <class System>
  void guards(const System&, Real t, const X& x, std::span<Real> values) const {
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (events_[i].guard) values[i] = events_[i].guard(t, x);
  }

  Real next_time(std::size_t i, Real t, bool inclusive) const {
    const Event<X>& event = events_[i];
    const auto past = [&](Real time) { return inclusive ? time >= t : time > t; };
    Real next = std::numeric_limits<Real>::infinity();
    for (const Real& time : event.times)
      if (past(time) && time < next) next = time;
    if (event.period > 0) {
      using std::floor;
      // k * period is computed afresh each time, so a million periods do not drift.
      Real k = floor((t - event.from) / event.period);
      if (k < 0) k = 0;
      while (!past(event.from + k * event.period)) k += 1;
      if (event.from + k * event.period < next) next = event.from + k * event.period;
    }
    return next;
  }

  template <class System>
  EventResponse fire(System&, std::span<const std::size_t> fired, Real t, const X& before, X& x) {
    EventAction<X> now{t, before, x};
    for (const std::size_t i : fired) {
      if (events_[i].action) events_[i].action(now);
      if (++fired_[i] == events_[i].stop_after) now.stop = true;
    }
    bool changed = now.restart;
    for (std::size_t k = 0; k < dimension(x); ++k) changed = changed || x.data()[k] != before.data()[k];
    return {now.stop, changed};
  }

 private:
  std::vector<Event<X>> events_;
  std::vector<std::size_t> fired_;
};

/// Whether an event of the source can change the run; so it is where nobody knows better.
template <class Source>
bool can_change(const Source& source, std::size_t i) {
  if constexpr (requires { source.only_notes(i); }) {
    return !source.only_notes(i);
  } else {
    return true;
  }
}

}  // namespace continuo
