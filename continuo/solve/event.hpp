// Events: the instants at which something happens, and the actions there. docs/events.md states the rules; in short:
//   1. A guard has a side, the sign of g, at every point of the motion and before and after every action. It fires
//      where its side changes in the watched direction, whether the motion or an action has changed it.
//   2. The state at an event lies on the far side of its root.
//   3. Events of one instant fire in the order of declaration, each on the state that the one before has left; within
//      one event `before` is the state from before it. Guards that an action has carried across zero fire in the next
//      round.
//
//   auto floor = falls("floor", [](double, const X& x) { return x[0]; },
//                      [](auto& now) { now.x[0] = 0; now.x[1] = -0.9 * now.before[1]; });
#pragma once
#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/decimal_ticks.hpp>
#include <continuo/numerics/state.hpp>
#include <continuo/solve/direction.hpp>

namespace continuo {

namespace detail {
struct NotCopied {
  NotCopied() = default;
  NotCopied(const NotCopied&) = delete;
  NotCopied& operator=(const NotCopied&) = delete;
};
/// In the place of a guard or an action that an event does not have.
struct NoFunction {};
}  // namespace detail

/// The data that an action reads and may change. An action gets them by reference.
template <State X>
struct EventAction {
  Scalar<X> t;           // the time of the event
  const X& before;       // the state before it
  X& x;                  // the state after it; starts as `before`
  bool stop = false;     // set it to end the run here
  bool restart = false;  // set it where the action changed f but not x (a mode kept outside the state)
  // Set it where the action moves x by no more than the tolerance, and f is the same: at the end of a step, where a
  // scheduled event happens, the method keeps its history, moved by the same way. A greater change begins anew.
  bool correction = false;
  // Set it where the action changes the number of components: the method begins anew with room for the new ones.
  bool resize = false;
  [[no_unique_address]] detail::NotCopied not_copied{};
};

/// A guard g(t, x): the event happens where its sign changes. It returns a number; a truth value or a whole number has
/// no zero to locate.
template <State X>
class Guard {
 public:
  Guard() = default;
  /// No guard.
  explicit(false) Guard(detail::NoFunction) {}
  /// Any function of (t, x) that returns a real number. A bool or a whole number is refused by the compiler.
  template <class G>
    requires(!std::same_as<std::remove_cvref_t<G>, Guard>)
  explicit(false) Guard(G&& g) {
    if constexpr (check<std::remove_cvref_t<G>>()) g_ = std::forward<G>(g);
  }

  /// Whether there is a guard.
  explicit operator bool() const { return static_cast<bool>(g_); }
  /// g(t, x).
  Scalar<X> operator()(const Scalar<X>& t, const X& x) const { return g_(t, x); }

 private:
  template <class G>
  [[nodiscard]] static consteval bool check() {
    constexpr bool callable = std::invocable<G&, Scalar<X>, const X&>;
    static_assert(callable, "a guard is called as g(t, x), with t a number and x of the type of the state x0");
    if constexpr (callable) {
      using Value = std::remove_cvref_t<std::invoke_result_t<G&, Scalar<X>, const X&>>;
      constexpr bool whole = std::is_integral_v<Value>, number = std::convertible_to<Value, Scalar<X>>;
      static_assert(!std::same_as<Value, bool>,
                    "the guard returns bool: it must return a number that changes its sign at the event, such as x[0] "
                    "- 1 for the condition x[0] > 1");
      static_assert(!whole || std::same_as<Value, bool>,
                    "the guard returns a whole number: it must return a real number that changes its sign at the "
                    "event");
      static_assert(number || whole, "the guard must return a number of the type of the components of x0");
      return number && !whole;
    } else {
      return false;
    }
  }

  std::function<Scalar<X>(Scalar<X>, const X&)> g_;
};

/// The action of an event.
template <State X>
class Action {
 public:
  Action() = default;
  /// No action.
  explicit(false) Action(detail::NoFunction) {}
  /// Any function of EventAction<X>&. It returns nothing; what returns a bool is refused by the compiler.
  template <class A>
    requires(!std::same_as<std::remove_cvref_t<A>, Action>)
  explicit(false) Action(A&& action) {
    if constexpr (check<std::remove_cvref_t<A>>()) action_ = std::forward<A>(action);
  }

  /// Whether there is an action.
  explicit operator bool() const { return static_cast<bool>(action_); }
  /// Acts.
  void operator()(EventAction<X>& now) const { action_(now); }

 private:
  template <class A>
  [[nodiscard]] static consteval bool check() {
    constexpr bool callable = std::invocable<A&, EventAction<X>&>;
    static_assert(callable,
                  "an action is called with its data by reference: [](EventAction<X>& now), or [](auto& now)");
    if constexpr (callable) {
      constexpr bool returns_bool = std::same_as<std::invoke_result_t<A&, EventAction<X>&>, bool>;
      static_assert(!returns_bool, "the action returns bool, which has no effect: set now.stop to end the run");
      return !returns_bool;
    } else {
      return false;
    }
  }

  std::function<void(EventAction<X>&)> action_;
};

/// One event: a guard with a direction, or times. Without an action it is only noted.
template <State X>
struct Event {
  std::string name{};                        // in messages and Solution::event_names
  Guard<X> guard{};                          // empty: the event is scheduled
  Direction direction = Direction::crosses;  // the sign change of the guard that counts
  Action<X> action{};                        // empty: the event is only noted
  std::vector<Scalar<X>> times{};            // scheduled
  Scalar<X> period{};                        // > 0: scheduled at from, from + period, ...
  Scalar<X> from{};                          // the first time of a period
  std::size_t stop_after = 0;                // the run stops at this many firings; 0: never
  Action<X> at_limit{};                      // where the firings accumulate; empty: the run ends there
};

/// An event as falls, rises, crosses, at and every make it where no type of state is named. It becomes an `Event` for
/// the state of the run.
template <class G, class A, class Real = double, class L = detail::NoFunction>
struct EventOf {
  std::string name;            // as Event::name, and so are the others
  G guard;                     // no function: the event is scheduled
  Direction direction;         // the sign change of the guard that counts
  A action;                    // no function: the event is only noted
  std::vector<Real> times{};   // scheduled
  Real period{};               // > 0: scheduled at from, from + period, ...
  Real from{};                 // the first time of a period
  std::size_t stop_after = 0;  // the run stops at this many firings; 0: never
  L at_limit{};                // where the firings accumulate; no function: the run ends there

  /// The same event with an action where its firings accumulate.
  template <class Limit>
  [[nodiscard]] EventOf<G, A, Real, Limit> then(Limit limit) const {
    return {name, guard, direction, action, times, period, from, stop_after, std::move(limit)};
  }

  /// The event for states of the type X.
  template <State X>
  explicit(false) operator Event<X>() const {
    Event<X> event{.name = name, .guard = guard, .direction = direction, .action = action};
    for (const Real& time : times) event.times.push_back(static_cast<Scalar<X>>(time));
    event.period = static_cast<Scalar<X>>(period);
    event.from = static_cast<Scalar<X>>(from);
    event.stop_after = stop_after;
    event.at_limit = at_limit;
    return event;
  }
};

/// An event where the guard falls through zero, for the state of the run.
template <class G, class A = detail::NoFunction>
  requires(!State<G>)
[[nodiscard]] EventOf<G, A> falls(std::string name, G guard, A action = {}) {
  return {std::move(name), std::move(guard), Direction::falls, std::move(action)};
}
/// An event where the guard rises through zero, for the state of the run.
template <class G, class A = detail::NoFunction>
  requires(!State<G>)
[[nodiscard]] EventOf<G, A> rises(std::string name, G guard, A action = {}) {
  return {std::move(name), std::move(guard), Direction::rises, std::move(action)};
}
/// An event where the guard passes through zero in either direction, for the state of the run.
template <class G, class A = detail::NoFunction>
  requires(!State<G>)
[[nodiscard]] EventOf<G, A> crosses(std::string name, G guard, A action = {}) {
  return {std::move(name), std::move(guard), Direction::crosses, std::move(action)};
}
/// An event at these times.
template <class A, class Real = double>
  requires(!State<A>)
[[nodiscard]] EventOf<detail::NoFunction, A, Real> at(std::string name, std::vector<Real> times, A action) {
  return {std::move(name), {}, Direction::crosses, std::move(action), std::move(times)};
}
/// An event at from, from + period, from + 2 period, ...: where these are decimals, at the decimals (DecimalTicks).
template <class Real, class From, class A>
  requires(!State<Real>)
[[nodiscard]] EventOf<detail::NoFunction, A, std::common_type_t<Real, From, double>> every(std::string name,
                                                                                           Real period, From from,
                                                                                           A action) {
  using Time = std::common_type_t<Real, From, double>;
  return {std::move(name),        {}, Direction::crosses, std::move(action), {}, static_cast<Time>(period),
          static_cast<Time>(from)};
}

// The same for states of a named type X.
/// An event where the guard falls through zero, for states of the type X.
template <State X>
[[nodiscard]] Event<X> falls(std::string name, Guard<X> guard, Action<X> action = {}) {
  return {
      .name = std::move(name), .guard = std::move(guard), .direction = Direction::falls, .action = std::move(action)};
}
/// An event where the guard goes from below zero to above.
template <State X>
[[nodiscard]] Event<X> rises(std::string name, Guard<X> guard, Action<X> action = {}) {
  return {
      .name = std::move(name), .guard = std::move(guard), .direction = Direction::rises, .action = std::move(action)};
}
/// An event where the guard changes its sign.
template <State X>
[[nodiscard]] Event<X> crosses(std::string name, Guard<X> guard, Action<X> action = {}) {
  return {.name = std::move(name), .guard = std::move(guard), .action = std::move(action)};
}
/// An event at given times, which are in ascending order.
template <State X>
[[nodiscard]] Event<X> at(std::string name, std::vector<Scalar<X>> times, Action<X> action) {
  return {.name = std::move(name), .action = std::move(action), .times = std::move(times)};
}
/// An event at from, from + period, from + 2 period, ..., for states of the type X.
template <State X>
[[nodiscard]] Event<X> every(std::string name, Scalar<X> period, Scalar<X> from, Action<X> action) {
  return {.name = std::move(name), .action = std::move(action), .period = period, .from = from};
}

/// The effects of firing an event.
struct EventResponse {
  bool stop = false;     // the run ends here
  bool restart = false;  // data that f reads has changed: the motion begins again
  bool changed = false;  // something else has changed: a state that f does not read and that is constant between events
  bool correction = false;  // restart, only because x has moved: see EventAction::correction
  bool resize = false;      // restart, with another number of components
};

/// The functions of a source of events, which the driver calls. `size()` counts guards and scheduled events together,
/// in the order of declaration.
///   name(i), direction(i), active(system, i)
///   is_guard(i); guards(system, t, x, span of size() values): g_i, anything for those not guards or not active
///   next_time(i, t, inclusive): the first scheduled time > t (>= t where inclusive), infinity where none
///   fire(system, i, t, before, x) -> EventResponse; x begins as `before`
/// A source is copied: an event may be tried on copies of the source and the system, so `fire` changes only these two
/// and x. `check_event_source` (check_event_source.hpp) tells by a sentence what a type lacks to be a source, and
/// refuses an optional member with another signature. Optional members, with the default in brackets:
///   can_restart(i) [true]: firing may change what f reads, or stop the run
///   can_assign(i) [can_restart(i)]: firing may change a state
///   carried(system, i, t, x, forward) [by differences]: the side to which the motion takes guard i from zero, if known
///   take_step(system, begin, size, coefficients), is_enclosed(i), enclose_all(a, b), whole(i), enclosure(i, a, b),
///     value_enclosure(i, a) [by samples]: guards enclosed over parts a..b of 0..1 of a step, see event_location.hpp
///   watched_by(system) [false]: steps that the system takes itself (own_steps.hpp) have no root of a guard in them
///   is_condition(i) [false]: the guard is positive where a condition holds, and never zero
///   renews_guard(i) [false]: only the motion crosses the guard, and firing gives it another meaning
///   has_limit_action(i) [false], at_limit(system, i, t, before, x) -> EventResponse: where the firings accumulate
///   problem(from, to, x) [empty]: why an event cannot happen as it is given in a run over this time from x
template <class S, class System, class X>
concept EventSource =
    State<X> && std::copy_constructible<S> &&
    requires(S& s, const S& constant, System& system, const X& before, X& x, std::span<Scalar<X>> values) {
      { constant.size() } -> std::convertible_to<std::size_t>;
      { constant.name(std::size_t{}) } -> std::convertible_to<std::string_view>;
      { constant.direction(std::size_t{}) } -> std::same_as<Direction>;
      { constant.is_guard(std::size_t{}) } -> std::convertible_to<bool>;
      { constant.active(system, std::size_t{}) } -> std::convertible_to<bool>;
      { constant.next_time(std::size_t{}, Scalar<X>{}, true) } -> std::convertible_to<Scalar<X>>;
      s.guards(system, Scalar<X>{}, before, values);
      { s.fire(system, std::size_t{}, Scalar<X>{}, before, x) } -> std::same_as<EventResponse>;
    };

/// A source of events that consists of a list of `Event`.
template <State X>
class EventList {
 public:
  using Real = Scalar<X>;
  EventList() = default;
  /// These events, in this order.
  explicit EventList(std::vector<Event<X>> events) : events_(std::move(events)) {
    memory_.reserve(events_.size());
    for (const Event<X>& event : events_) memory_.push_back({.ticks = {event.from, event.period}});
  }

  /// The number of events.
  [[nodiscard]] std::size_t size() const { return events_.size(); }
  /// The name of event i.
  [[nodiscard]] std::string_view name(std::size_t i) const { return events_[i].name; }
  /// The direction in which the guard of event i is watched.
  [[nodiscard]] Direction direction(std::size_t i) const { return events_[i].direction; }
  /// Whether event i has a guard; else it is scheduled.
  [[nodiscard]] bool is_guard(std::size_t i) const { return static_cast<bool>(events_[i].guard); }
  /// Whether event i may change the state or stop the run.
  [[nodiscard]] bool can_restart(std::size_t i) const { return events_[i].action || events_[i].stop_after != 0; }
  /// Whether event i may change the state.
  [[nodiscard]] bool can_assign(std::size_t i) const { return static_cast<bool>(events_[i].action); }
  /// Whether event i has an action at the limit of its times.
  [[nodiscard]] bool has_limit_action(std::size_t i) const { return static_cast<bool>(events_[i].at_limit); }
  /// Whether event i is watched: always.
  template <class System>
  [[nodiscard]] bool active(const System&, std::size_t) const {
    return true;
  }

  /// values[i] = the guard of event i at (t, x); those of scheduled events stay as they are.
  template <class System>
  void guards(const System&, Real t, const X& x, std::span<Real> values) const {
    Real* value = values.data();
    for (const Event<X>& event : events_) {
      if (event.guard) *value = event.guard(t, x);
      ++value;
    }
  }

  /// The first scheduled time of event i after t, or at t where `inclusive`; infinity where there is none.
  [[nodiscard]] Real next_time(std::size_t i, Real t, bool inclusive) const {
    if (inclusive) return first_time(i, t, inclusive);
    const Memory& memory = memory_[i];
    if (!(t >= memory.asked && t < memory.next)) {
      memory.asked = t;
      memory.next = first_time(i, t, inclusive);
    }
    return memory.next;
  }
  /// Why an event cannot happen as it is given, in a run over this time from x; empty where all can.
  [[nodiscard]] std::string problem(Real from, Real to, const X& x) const {
    for (std::size_t i = 0; i < events_.size(); ++i) {
      const std::string what = problem_of(events_[i], from, to, x);
      if (!what.empty()) return "the event `" + events_[i].name + "` " + what;
      if (events_[i].period > 0 && !memory_[i].ticks.advances(to))
        return "the period of the event `" + events_[i].name + "` is below the spacing of numbers at its times";
    }
    return {};
  }

  /// Executes the action of event i on x, which begins as `before`.
  template <class System>
  [[nodiscard]] EventResponse fire(System&, std::size_t i, Real t, const X& before, X& x) {
    EventAction<X> now{t, before, x};
    if (events_[i].action) events_[i].action(now);
    if (++memory_[i].fired == events_[i].stop_after) now.stop = true;
    return response(now);
  }
  /// Executes the action of event i at the limit of its times.
  template <class System>
  [[nodiscard]] EventResponse at_limit(System&, std::size_t i, Real t, const X& before, X& x) {
    EventAction<X> now{t, before, x};
    events_[i].at_limit(now);
    return response(now);
  }

 private:
  [[nodiscard]] Real first_time(std::size_t i, const Real& t, bool inclusive) const {
    const Event<X>& event = events_[i];
    Real first = std::numeric_limits<Real>::infinity();
    for (const Real& time : event.times)
      if ((inclusive ? time >= t : time > t) && time < first) first = time;
    if (event.period > 0) {
      const Real tick = memory_[i].ticks.next(t, inclusive);
      if (tick < first) first = tick;
    }
    return first;
  }

  [[nodiscard]] static EventResponse response(const EventAction<X>& now) {
    bool changed = now.restart || dimension(now.x) != dimension(now.before);
    for (std::size_t k = 0; !changed && k < dimension(now.x); ++k) changed = now.x.data()[k] != now.before.data()[k];
    return {.stop = now.stop,
            .restart = changed,
            .changed = false,
            .correction = now.correction && !now.restart,
            .resize = now.resize};
  }

  [[nodiscard]] static std::string problem_of(const Event<X>& event, Real from, Real to, const X& x) {
    const auto finite = [](const Real& value) { return Real(0) * value == Real(0); };
    if (!finite(event.period) || event.period < 0 || !finite(event.from))
      return "must have a period of at least 0 and a first time, both finite";
    for (const Real& time : event.times)
      if (!finite(time)) return "has a time that is not finite";
    const bool scheduled = !event.times.empty() || event.period > 0;
    if (event.guard) {
      if (scheduled || event.from != Real(0)) return "has a guard and times: give the times to an event of their own";
      const Real g = event.guard(from, x);
      if (!(g == g)) return "has a guard that is not a number at the start of the run";
      return {};
    }
    if (!(event.period > 0) && event.from != Real(0))
      return "has a first time and no period: give it a period, or `times`";
    if (!scheduled) return "has neither a guard nor times, so that it never happens";
    if (event.direction != Direction::crosses) return "has times and a direction: only a guard has one";
    if (event.at_limit) return "has times and an action at the limit: only the firings of a guard accumulate";
    if (to < from) return "has times in a run that goes backwards: only guards are watched there";
    return {};
  }

  /// What a run remembers of an event.
  struct Memory {
    DecimalTicks<Real> ticks;
    std::size_t fired = 0;
    /// No scheduled time lies between the two, and one at the second: the answer for many short steps.
    mutable Real asked = std::numeric_limits<Real>::infinity(), next = asked;
  };

  std::vector<Event<X>> events_;
  std::vector<Memory> memory_;
};

}  // namespace continuo
