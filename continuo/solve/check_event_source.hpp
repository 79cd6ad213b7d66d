// continuo/solve/check_event_source.hpp
// The check of a source of events of your own, at compile time. It refuses, with a sentence, a source that lacks a
// member, and one with an optional member that would be ignored because of its signature. `Integrator` makes this check
// of every source; beside the declaration of a source:
//
//   static_assert(check_event_source<MyEvents, MySystem, std::array<double, 2>>());
#pragma once
#include <concepts>
#include <cstddef>
#include <type_traits>

#include <continuo/solve/event.hpp>
#include <continuo/solve/events/event_members.hpp>

namespace continuo {

namespace detail {

// As for methods (check_method.hpp): a name that S has too is ambiguous in a class that derives from both.
struct NamesOfEvents {
  int can_restart, can_assign, is_condition, renews_guard, watched_by, has_limit_action, at_limit, carried, take_step,
      is_enclosed, enclose_all, whole, enclosure, value_enclosure, problem;
};
template <class S>
struct WithNamesOfEvents : S, NamesOfEvents {};
/// A type with one of these members is a source of events that may lack others.
template <class S>
concept ResemblesEventSource = HasNameOfEvent<S> || HasDirection<S> || HasIsGuard<S>;
template <class S>
concept DerivableSource = std::is_class_v<S> && !std::is_final_v<S>;

template <class S, class System, class Real, class X>
concept FireCopiesState = requires {
  static_cast<EventResponse (S::*)(System, std::size_t, Real, const X&, X)>(&S::fire);
} || requires { static_cast<EventResponse (S::*)(System, std::size_t, Real, const X&, X) const>(&S::fire); };
template <class S, class System, class X>
concept FireLosesState =
    FireCopiesState<S, System&, Scalar<X>, X> || FireCopiesState<S, System&, const Scalar<X>&, X> ||
    FireCopiesState<S, const System&, Scalar<X>, X> || FireCopiesState<S, const System&, const Scalar<X>&, X>;

template <class S, class System, State X>
consteval void check_required_members_of_source() {
  constexpr bool copyable = std::copy_constructible<S>;
  static_assert(copyable, "the source of events must be copyable: the driver tries an event on a copy of its source");
  constexpr bool has_size = HasSize<S>;
  static_assert(has_size, "the source of events lacks a public member: std::size_t size() const");
  constexpr bool has_name = HasNameOfEvent<S>;
  static_assert(has_name, "the source of events lacks a public member: std::string_view name(std::size_t i) const");
  constexpr bool has_direction = HasDirection<S>;
  static_assert(has_direction, "the source of events lacks a public member: Direction direction(std::size_t i) const");
  constexpr bool has_is_guard = HasIsGuard<S>;
  static_assert(has_is_guard, "the source of events lacks a public member: bool is_guard(std::size_t i) const");
  constexpr bool has_active = HasActive<S, System>;
  static_assert(has_active,
                "the source of events lacks a public member: bool active(const System& system, std::size_t i) const");
  constexpr bool has_next_time = HasNextTime<S, X>;
  static_assert(has_next_time,
                "the source of events lacks a public member, which returns infinity if there is no time: Real "
                "next_time(std::size_t i, Real t, bool inclusive) const");
  constexpr bool has_guards = HasGuards<S, System, X>;
  static_assert(has_guards,
                "the source of events lacks a public member: void guards(System& system, Real t, const X& x, "
                "std::span<Real> values)");
  constexpr bool has_fire = HasFire<S, System, X>;
  static_assert(has_fire,
                "the source of events lacks a public member: EventResponse fire(System& system, std::size_t i, Real t, "
                "const X& before, X& x)");
  constexpr bool fire_writes = !FireLosesState<S, System, X>;
  static_assert(fire_writes, "`fire` gets x by value, so that its changes of the state are lost: declare X& x");
}

template <class S, class System, State X>
  requires DerivableSource<S>
consteval void check_optional_members_of_source() {
  using With = WithNamesOfEvents<S>;
  constexpr bool keeps_can_restart = HasCanRestart<S> || requires { &With::can_restart; };
  static_assert(keeps_can_restart,
                "the member `can_restart` of the source of events would be ignored: it must be public and const: bool "
                "can_restart(std::size_t i) const");
  constexpr bool keeps_can_assign = HasCanAssign<S> || requires { &With::can_assign; };
  static_assert(keeps_can_assign,
                "the member `can_assign` of the source of events would be ignored: it must be public and const: bool "
                "can_assign(std::size_t i) const");
  constexpr bool keeps_is_condition = HasIsCondition<S> || requires { &With::is_condition; };
  static_assert(keeps_is_condition,
                "the member `is_condition` of the source of events would be ignored: it must be public and const: bool "
                "is_condition(std::size_t i) const");
  constexpr bool keeps_renews_guard = HasRenewsGuard<S> || requires { &With::renews_guard; };
  static_assert(keeps_renews_guard,
                "the member `renews_guard` of the source of events would be ignored: it must be public and const: bool "
                "renews_guard(std::size_t i) const");
  constexpr bool keeps_watched_by = HasWatchedBySystem<S, System> || requires { &With::watched_by; };
  static_assert(keeps_watched_by,
                "the member `watched_by` of the source of events would be ignored: it must be public and const: bool "
                "watched_by(const System& system) const");
  constexpr bool keeps_limit_action =
      HasLimitAction<S, System, X> || (requires { &With::has_limit_action; } && requires { &With::at_limit; });
  static_assert(
      keeps_limit_action,
      "the action at a limit would be ignored: it has two public members: bool has_limit_action(std::size_t i) "
      "const; EventResponse at_limit(System& system, std::size_t i, Real t, const X& before, X& x)");
  constexpr bool keeps_carried = HasCarried<S, System, X> || requires { &With::carried; };
  static_assert(
      keeps_carried,
      "the member `carried` of the source of events would be ignored: it must be public: "
      "std::optional<Carried> carried(const System& system, std::size_t i, Real t, const X& x, Real forward)");
  constexpr bool keeps_enclosures = HasEnclosures<S, System, X> ||
          (requires { &With::take_step; } && requires { &With::is_enclosed; } && requires { &With::enclose_all; } &&
           requires { &With::whole; } && requires { &With::enclosure; } && requires { &With::value_enclosure; });
  static_assert(keeps_enclosures,
                "the enclosures of guards would be ignored: they have six public members: void take_step(const System& "
                "system, Real "
                "begin, Real size, std::span<const X> coefficients); bool is_enclosed(std::size_t i) const; void "
                "enclose_all(Real "
                "a, Real b); const Enclosure<Real>& whole(std::size_t i); EnclosureWithSlope<Real> "
                "enclosure(std::size_t i, Real a, "
                "Real b); Enclosure<Real> value_enclosure(std::size_t i, Real a)");
  constexpr bool keeps_problem = HasProblem<S, X> || requires { &With::problem; };
  static_assert(keeps_problem,
                "the member `problem` of the source of events would be ignored: it must be public and const: "
                "std::string problem(Real from, Real to, const X& x) const");
}
template <class S, class System, State X>
consteval void check_optional_members_of_source() {
  constexpr bool derivable = !std::is_final_v<S>;
  static_assert(derivable,
                "the source of events is final: remove `final`, so that its optional members can be checked");
}

}  // namespace detail

/// Refuses, at compile time, a type S that is no source of events for runs of a System with states X, or of which a
/// part would be ignored. A call of it costs nothing; it returns true where it refuses nothing.
template <class S, class System, State X>
consteval bool check_event_source() {
  detail::check_required_members_of_source<S, System, X>();
  if constexpr (EventSource<S, System, X>) detail::check_optional_members_of_source<S, System, X>();
  return EventSource<S, System, X>;
}

}  // namespace continuo
