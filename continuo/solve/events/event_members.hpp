// continuo/solve/events/event_members.hpp
// The members of a source of events, one concept each. The driver and the check of a source (check_event_source.hpp)
// find members by the same concepts.
#pragma once
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <continuo/solve/event.hpp>
#include <continuo/solve/events/guard_motion.hpp>

namespace continuo::detail {

template <class S>
concept HasSize = requires(const S& s) {
  { s.size() } -> std::convertible_to<std::size_t>;
};
template <class S>
concept HasNameOfEvent = requires(const S& s, std::size_t i) {
  { s.name(i) } -> std::convertible_to<std::string_view>;
};
template <class S>
concept HasDirection = requires(const S& s, std::size_t i) {
  { s.direction(i) } -> std::same_as<Direction>;
};
template <class S>
concept HasIsGuard = requires(const S& s, std::size_t i) {
  { s.is_guard(i) } -> std::convertible_to<bool>;
};
template <class S, class System>
concept HasActive = requires(const S& s, const System& system, std::size_t i) {
  { s.active(system, i) } -> std::convertible_to<bool>;
};
template <class S, class X>
concept HasNextTime = requires(const S& s, std::size_t i, const Scalar<X>& t, bool inclusive) {
  { s.next_time(i, t, inclusive) } -> std::convertible_to<Scalar<X>>;
};
template <class S, class System, class X>
concept HasGuards = requires(S& s, System& system, const Scalar<X>& t, const X& x, std::span<Scalar<X>> values) {
  s.guards(system, t, x, values);
};
template <class S, class System, class X>
concept HasFire = requires(S& s, System& system, std::size_t i, const Scalar<X>& t, const X& before, X& x) {
  { s.fire(system, i, t, before, x) } -> std::same_as<EventResponse>;
};

template <class S>
concept HasCanRestart = requires(const S& s, std::size_t i) {
  { s.can_restart(i) } -> std::convertible_to<bool>;
};
template <class S>
concept HasCanAssign = requires(const S& s, std::size_t i) {
  { s.can_assign(i) } -> std::convertible_to<bool>;
};
template <class S>
concept HasIsCondition = requires(const S& s, std::size_t i) {
  { s.is_condition(i) } -> std::convertible_to<bool>;
};
template <class S>
concept HasRenewsGuard = requires(const S& s, std::size_t i) {
  { s.renews_guard(i) } -> std::convertible_to<bool>;
};
template <class S, class System, class X>
concept HasLimitAction =
    requires(S& s, const S& constant, System& system, std::size_t i, const Scalar<X>& t, const X& before, X& x) {
      { constant.has_limit_action(i) } -> std::convertible_to<bool>;
      { s.at_limit(system, i, t, before, x) } -> std::same_as<EventResponse>;
    };
template <class S, class System, class X>
concept HasCarried = requires(S& s, System& system, std::size_t i, const Scalar<X>& t, const X& x) {
  { s.carried(system, i, t, x, t) } -> std::convertible_to<std::optional<Carried>>;
};
/// The system finds out itself whether a step may have a root of these guards in it (solve/steps/own_steps.hpp).
template <class S, class System>
concept HasWatchedBySystem = requires(const S& s, const System& system) {
  { s.watched_by(system) } -> std::convertible_to<bool>;
};
template <class S, class System, class X>
concept HasEnclosures =
    requires(S& s, System& system, std::size_t i, const Scalar<X>& a, std::span<const X> coefficients) {
      s.take_step(system, a, a, coefficients);
      { s.is_enclosed(i) } -> std::convertible_to<bool>;
      s.enclose_all(a, a);
      s.whole(i).lo;
      s.enclosure(i, a, a);
      s.value_enclosure(i, a);
    };
template <class S, class X>
concept HasProblem = requires(const S& s, const Scalar<X>& t, const X& x) {
  { s.problem(t, t, x) } -> std::convertible_to<std::string>;
};

}  // namespace continuo::detail
