// The events of one run of an ensemble, as the logic of events asks for them: guards and actions are those of all runs,
// the parameters are the run's own.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/ensembles/lanes/system_with_parameters.hpp>
#include <continuo/numerics/decimal_ticks.hpp>
#include <continuo/solve/event.hpp>

namespace continuo::detail {

template <class E>
inline constexpr bool has_guard = !std::same_as<std::remove_cvref_t<decltype(std::declval<E>().guard)>, NoFunction>;
template <class E>
inline constexpr bool has_action = !std::same_as<std::remove_cvref_t<decltype(std::declval<E>().action)>, NoFunction>;
template <class E>
inline constexpr bool has_at_limit =
    !std::same_as<std::remove_cvref_t<decltype(std::declval<E>().at_limit)>, NoFunction>;

/// A source of events (EventSource). A copy has its own counts and the same functions, which are not owned.
template <State X, class... E>
class RunEvents {
 public:
  using List = std::tuple<E...>;
  static constexpr std::size_t count = sizeof...(E);
  static constexpr bool any_guard = (has_guard<E> || ...), any_scheduled = (!has_guard<E> || ...);

  explicit RunEvents(const List& list) : list_(&list) {
    each([&](std::size_t i, const auto& event) {
      memory_[i].ticks = {static_cast<double>(event.from), static_cast<double>(event.period)};
    });
  }

  [[nodiscard]] std::size_t size() const { return count; }
  [[nodiscard]] std::string_view name(std::size_t i) const {
    return at(i, std::string_view(), [](const auto& event) { return std::string_view(event.name); });
  }
  [[nodiscard]] Direction direction(std::size_t i) const {
    return at(i, Direction::crosses, [](const auto& event) { return event.direction; });
  }
  [[nodiscard]] bool is_guard(std::size_t i) const {
    return at(i, false, [](const auto& event) { return has_guard<decltype(event)>; });
  }
  [[nodiscard]] bool can_restart(std::size_t i) const {
    return at(i, false, [](const auto& event) { return has_action<decltype(event)> || event.stop_after != 0; });
  }
  [[nodiscard]] bool can_assign(std::size_t i) const {
    return at(i, false, [](const auto& event) { return has_action<decltype(event)>; });
  }
  [[nodiscard]] bool has_limit_action(std::size_t i) const {
    return at(i, false, [](const auto& event) { return has_at_limit<decltype(event)>; });
  }
  template <class System>
  [[nodiscard]] bool active(const System&, std::size_t) const {
    return true;
  }

  template <class System>
  void guards(const System& system, double t, const X& x, std::span<double> values) const {
    each([&](std::size_t i, const auto& event) {
      if constexpr (has_guard<decltype(event)>) values[i] = guard_value(event.guard, t, x, system.p);
    });
  }

  [[nodiscard]] double next_time(std::size_t i, double t, bool inclusive) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    return at(i, never, [&](const auto& event) {
      double first = never;
      for (const auto& given : event.times) {
        const auto time = static_cast<double>(given);
        if ((inclusive ? time >= t : time > t) && time < first) first = time;
      }
      if (event.period > 0) first = std::min(first, memory_[i].ticks.next(t, inclusive));
      return first;
    });
  }

  template <class System>
  [[nodiscard]] EventResponse fire(System& system, std::size_t i, double t, const X& before, X& x) {
    EventAction<X> now{t, before, x};
    const auto earlier = system.p;
    each([&](std::size_t k, const auto& event) {
      if (k != i) return;
      if constexpr (has_action<decltype(event)>) act(event.action, now, system.p);
      if (++memory_[i].fired == event.stop_after) now.stop = true;
    });
    return response(now, !same(earlier, system.p));
  }
  template <class System>
  [[nodiscard]] EventResponse at_limit(System& system, std::size_t i, double t, const X& before, X& x) {
    EventAction<X> now{t, before, x};
    const auto earlier = system.p;
    each([&](std::size_t k, const auto& event) {
      if constexpr (has_at_limit<decltype(event)>)
        if (k == i) act(event.at_limit, now, system.p);
    });
    return response(now, !same(earlier, system.p));
  }

  /// Why an event cannot happen as it is given; empty where all can.
  [[nodiscard]] std::string problem(const Interval<double>& interval) const {
    std::string why;
    each([&](std::size_t, const auto& event) {
      if (!why.empty()) return;
      const std::string what = problem_of(event, interval);
      if (!what.empty()) why = "the event `" + event.name + "` " + what;
    });
    return why;
  }

 private:
  struct Memory {
    DecimalTicks<double> ticks;
    std::size_t fired = 0;
  };
  const List* list_;
  std::array<Memory, count> memory_;

  template <class Visit>
  void each(Visit&& visit) const {
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      (visit(i, std::get<i>(*list_)), ...);
    }(std::index_sequence_for<E...>());
  }
  template <class Result, class Ask>
  [[nodiscard]] Result at(std::size_t place, Result otherwise, Ask&& ask) const {
    Result result = otherwise;
    each([&](std::size_t i, const auto& event) {
      if (i == place) result = ask(event);
    });
    return result;
  }

  template <class Action, class P>
  static void act(const Action& action, EventAction<X>& now, P& p) {
    if constexpr (std::is_invocable_v<const Action&, EventAction<X>&, P&>) {
      action(now, p);
    } else {
      action(now);
    }
  }
  template <class Numbers>
  [[nodiscard]] static bool same(const Numbers& a, const Numbers& b) {
    return std::equal(a.data(), a.data() + a.size(), b.data(), b.data() + b.size());
  }
  [[nodiscard]] static EventResponse response(const EventAction<X>& now, bool other_parameters) {
    return {.stop = now.stop,
            .restart = now.restart || other_parameters || !same(now.x, now.before),
            .changed = false,
            .correction = false,
            .resize = false};
  }

  template <class Event>
  [[nodiscard]] static std::string problem_of(const Event& event, const Interval<double>& interval) {
    if (!std::isfinite(static_cast<double>(event.period)) || event.period < 0 || !std::isfinite(event.from))
      return "must have a period of at least 0 and a first time, both finite";
    for (const auto& time : event.times)
      if (!std::isfinite(static_cast<double>(time))) return "has a time that is not finite";
    if constexpr (has_guard<Event>) {
      return {};
    } else {
      if (event.times.empty() && !(event.period > 0)) return "has neither a guard nor times, so that it never happens";
      if (interval.to < interval.from) return "has times in a run that goes backwards: only guards are watched there";
      const DecimalTicks<double> ticks{static_cast<double>(event.from), static_cast<double>(event.period)};
      if (event.period > 0 && !ticks.advances(interval.to))
        return "has a period below the spacing of numbers at its times";
      return {};
    }
  }
};

}  // namespace continuo::detail
