// continuo/solve/solve.hpp
// From start to end in one call:
//
//   auto oscillator = [](double, const std::array<double, 2>& x) { return std::array{x[1], -x[0]}; };
//   auto solution = solve(oscillator, std::array{1.0, 0.0}, {0, 10}, Dop853{}, {.rtol = 1e-10});
//   if (!solution.outcome) std::puts(describe(solution.outcome).c_str());
#pragma once
#include <concepts>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/solve/erased_system.hpp>
#include <continuo/solve/integrator.hpp>
#include <continuo/solve/solution.hpp>

namespace continuo {

/// Records those states of a run that `save` selects.
template <State X>
class SolutionRecorder {
 public:
  using Real = Scalar<X>;

  /// Records the initial state where `save` selects it. `save` and `solution` must outlive the recorder.
  SolutionRecorder(const Save<X>& save, Interval<Real> interval, const X& x0, Solution<X>& solution)
      : save_(save), interval_(interval), x_(x0), solution_(solution) {
    solution_.last = x0;
    solution_.dense = save_.kind == Save<X>::Kind::dense;
  }

  /// Records the start. A time asked for is recorded at the end of its instant.
  template <class I>
  void begin(I& integrator) {
    if (only_times()) {
      skip_to(integrator.t());
    } else if (save_.kind != Save<X>::Kind::end) {
      keep(integrator, integrator.t(), x_);
    }
  }

  /// Up to when no state is selected.
  template <class I>
  [[nodiscard]] Real quiet_until(I&) const {
    const Real end = forward() * std::numeric_limits<Real>::infinity();
    if (save_.kind == Save<X>::Kind::end) return end;
    return only_times() && running_ ? next_ : -end;
  }

  /// Records the selected states of a piece of the motion.
  template <class I>
  void on_segment(I& integrator, Real from, Real to) {
    if (save_.kind == Save<X>::Kind::end) return;
    if (only_times()) {
      for (; running_ && index_ < count_ && forward() * (next_ - to) < 0; next_ = time(++index_)) {
        integrator.at(next_, x_);
        keep(integrator, next_, x_);
      }
      return;
    }
    if (save_.kind == Save<X>::Kind::dense) {
      const std::span<const X> output = integrator.dense_output();
      solution_.segments.push_back(
          {from, to, integrator.step_begin(), integrator.step_size(), {output.begin(), output.end()}});
    }
    integrator.at(to, x_);
    keep(integrator, to, x_);
  }

  /// Records the events of an instant, and the states before and after them.
  template <class I>
  void on_event(I& integrator, const EventOccurrence<X>& now) {
    for (const std::size_t event : now.events) solution_.events.push_back({event, now.t, now.before, now.after});
    if (save_.kind == Save<X>::Kind::end || only_times()) return;
    if (!kept_at(now.t)) keep(integrator, now.t, now.before);
    if (dimension(now.after) != dimension(now.before) ||
        !std::equal(now.after.data(), now.after.data() + dimension(now.after), now.before.data()))
      keep(integrator, now.t, now.after);
  }

  /// The end of an instant: its events have acted.
  template <class I>
  void on_instant(I& integrator) {
    if (!only_times()) return;
    const Real t = integrator.t();
    for (; running_ && index_ < count_ && forward() * (next_ - t) <= 0; next_ = time(++index_)) {
      integrator.at(t, x_);
      keep(integrator, next_, x_);
    }
  }

  /// Records the last state.
  template <class I>
  void finish(I& integrator) {
    const bool kept = kept_at(integrator.t());
    if (!kept) integrator.at(integrator.t(), x_);  // with its unknowns solved for
    solution_.last = x_;
    if (kept || only_times() || (save_.callback && integrator.outcome().ending == Ending::invalid_input)) return;
    keep(integrator, integrator.t(), x_);
  }

 private:
  [[nodiscard]] Real forward() const { return interval_.to < interval_.from ? Real(-1) : Real(1); }
  [[nodiscard]] bool only_times() const {
    return save_.kind == Save<X>::Kind::times || save_.kind == Save<X>::Kind::grid;
  }

  void skip_to(Real start) {
    using std::abs, std::floor;
    count_ = save_.times.size();
    if (save_.kind == Save<X>::Kind::grid) {
      // One part in a million of a spacing is rounding, not another output.
      count_ = static_cast<std::size_t>(floor(abs(interval_.to - interval_.from) / save_.spacing + Real(1e-6))) + 1;
    }
    next_ = time(0);
    while (index_ < count_ && forward() * (next_ - start) < 0) next_ = time(++index_);
  }

  [[nodiscard]] Real time(std::size_t index) const {
    if (index >= count_) return forward() * std::numeric_limits<Real>::infinity();
    const Real t = save_.kind == Save<X>::Kind::times ? save_.times[index]
                                                      : interval_.from + forward() * Real(index) * save_.spacing;
    if (forward() * (t - interval_.to) > 0) return interval_.to;  // by rounding
    return forward() * (t - interval_.from) < 0 ? interval_.from : t;
  }

  [[nodiscard]] bool kept_at(Real t) const { return any_ && last_ == t; }

  template <class I>
  void keep(I& integrator, Real t, const X& x) {
    if (!running_) return;
    any_ = true;
    last_ = t;
    if (&x != &x_) x_ = x;
    if (!save_.callback) {
      solution_.t.push_back(t);
      solution_.x.push_back(x);
    } else if (!save_.callback(t, x)) {
      running_ = false;
      integrator.stop(t, x);
    }
  }

  const Save<X>& save_;
  Interval<Real> interval_;
  X x_;
  Solution<X>& solution_;
  Real next_{}, last_{};
  std::size_t index_ = 0, count_ = 0;
  bool any_ = false, running_ = true;
};

/// Runs an integrator to its end.
template <class System, State X, class Events>
[[nodiscard]] Solution<X> run(Driver<System, X, Events>& integrator) {
  Solution<X> solution;
  const double begin = detail::seconds_of_steady_clock();
  for (std::size_t i = 0; i < integrator.events().size(); ++i)
    solution.event_names.emplace_back(integrator.events().name(i));
  const Options<X>& options = integrator.options();
  SolutionRecorder<X> keeper(options.save, integrator.interval(), integrator.x(), solution);
  if (integrator.can_begin()) keeper.begin(integrator);
  for (std::size_t count = 1; integrator.advance(keeper); ++count)
    if (count % 1024 == 0 && options.progress && !options.progress(integrator.t()))
      integrator.stop(integrator.t(), X(integrator.x()));
  keeper.finish(integrator);
  solution.outcome = integrator.outcome();
  solution.statistics = integrator.statistics();
  solution.statistics.seconds = detail::seconds_of_steady_clock() - begin;
  return solution;
}

namespace detail {
template <class X>
struct TypesOfRun {  // of what is no state, so that check_call can tell the reason
  using Real = double;
  using Result = Solution<std::vector<double>>;
  using Settings = Options<std::vector<double>>;
};
template <State X>
struct TypesOfRun<X> {
  using Real = Scalar<X>;
  using Result = Solution<X>;
  using Settings = Options<X>;
};

/// Refuses a type that is no method for this system, with a sentence; true where it is one.
template <class System, State X, class M>
[[nodiscard]] consteval bool check_method_of_run() {
  if constexpr (std::convertible_to<M, std::string_view>) {
    static_assert(
        !std::convertible_to<M, std::string_view>,
        "the method is a text: a type is needed, such as Dop853{}; for a name known at run time see with_method.hpp");
    return false;
  } else if constexpr (std::same_as<M, AnyMethod<System, X>>) {
    return true;
  } else {
    return check_method<M, X, System>();
  }
}

/// Refuses a call of `solve` that cannot be made, with a sentence; true where it can.
template <class System, class X, class M>
[[nodiscard]] consteval bool check_call() {
  if constexpr (!check_state<X>()) {
    return false;
  } else {
    constexpr bool callable = check_right_hand_side<ReferredSystem<System>, X>();
    if constexpr (callable) {
      check_system<ReferredSystem<System>, X>();
      return check_method_of_run<System, X, M>();
    } else {
      return false;
    }
  }
}

struct EventsOfOptions {};
}  // namespace detail

/// Integrates dx/dt = f(t, x) from x(from) = x0. A failure on the way does not throw: see Solution::outcome. The run
/// copies f; std::ref(f) integrates f itself. `events` may be a source of events of your own, see EventSource.
template <class System, class X, class M, class Events = detail::EventsOfOptions,
          bool Optimized = detail::program_is_optimized>  // of the type, lest a program has two functions of one name
  requires(!std::same_as<M, typename detail::TypesOfRun<X>::Settings>)
[[nodiscard]] typename detail::TypesOfRun<X>::Result solve(System system, X x0,
                                                           Interval<typename detail::TypesOfRun<X>::Real> interval,
                                                           M method,
                                                           typename detail::TypesOfRun<X>::Settings options = {},
                                                           Events events = {}) {
  if constexpr (!detail::check_call<HeldSystem<System>, X, M>()) {
    return {};
  } else if constexpr (std::same_as<Events, detail::EventsOfOptions> &&
                       detail::runs_in_library<HeldSystem<System>, X, M, Optimized>) {
    return detail::RunsInLibrary<X>::run(ErasedSystem<X>(std::move(system)), std::move(x0), interval, M::name,
                                         std::move(options));
  } else if constexpr (std::same_as<Events, detail::EventsOfOptions>) {
    Integrator<HeldSystem<System>, X, M> integrator(std::move(system), std::move(x0), interval, method,
                                                    std::move(options));
    return continuo::run(integrator);
  } else if constexpr (!detail::ResemblesEventSource<Events>) {
    static_assert(detail::ResemblesEventSource<Events>,
                  "the last argument of solve is no source of events for this system: see the concept EventSource; a "
                  "list of events belongs to the options, {.events = {...}}");
    return {};
  } else if constexpr (check_event_source<Events, HeldSystem<System>, X>()) {
    Integrator<HeldSystem<System>, X, M, Events> integrator(std::move(system), std::move(x0), interval, method,
                                                            std::move(options), std::move(events));
    return continuo::run(integrator);
  } else {
    return {};
  }
}

}  // namespace continuo
