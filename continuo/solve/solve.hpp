// continuo/solve/solve.hpp
// From start to end in one call:
//
//   auto oscillator = [](double, const std::array<double, 2>& x) { return std::array{x[1], -x[0]}; };
//   auto solution = solve(oscillator, std::array{1.0, 0.0}, {0, 10}, Dop853{}, {.rtol = 1e-10});
//   if (!solution.outcome) std::puts(describe(solution.outcome).c_str());
#pragma once
#include <chrono>
#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

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
    if (save_.kind == Save<X>::Kind::times || save_.kind == Save<X>::Kind::grid) skip_to_start();
    if (save_.kind == Save<X>::Kind::end) return;
    if (save_.kind == Save<X>::Kind::times && !(next_ == interval.from)) return;
    keep(interval.from, x0);
    if (next_ == interval.from) next_ = time(++index_);
  }

  /// Records the selected states of a piece of the motion.
  template <class I>
  void on_segment(I& integrator, Real from, Real to) {
    switch (save_.kind) {
      case Save<X>::Kind::steps:
        integrator.at(to, x_);
        keep(to, x_);
        break;
      case Save<X>::Kind::dense: {
        const std::span<const X> output = integrator.dense_output();
        solution_.segments.push_back(
            {from, to, integrator.step_begin(), integrator.step_size(), {output.begin(), output.end()}});
        integrator.at(to, x_);
        keep(to, x_);
        break;
      }
      case Save<X>::Kind::times:
      case Save<X>::Kind::grid:
        for (; index_ < count_ && forward() * (next_ - to) <= 0; next_ = time(++index_)) {
          integrator.at(next_, x_);
          keep(next_, x_);
        }
        break;
      case Save<X>::Kind::end:
        break;
    }
  }

  /// Records the events of an instant, and the states before and after them.
  template <class I>
  void on_event(I&, const EventOccurrence<X>& now) {
    for (const std::size_t event : now.events) solution_.events.push_back({event, now.t, now.before, now.after});
    if (save_.kind == Save<X>::Kind::end) return;
    if (!kept_at(now.t)) keep(now.t, now.before);
    if (!std::equal(now.after.data(), now.after.data() + dimension(now.after), now.before.data()))
      keep(now.t, now.after);
  }

  /// Records the state at the end of the run.
  template <class I>
  void finish(I& integrator) {
    if (kept_at(integrator.t())) return;
    integrator.at(integrator.t(), x_);  // with its unknowns solved for
    keep(integrator.t(), x_);
  }

 private:
  [[nodiscard]] Real forward() const { return interval_.to < interval_.from ? Real(-1) : Real(1); }

  void skip_to_start() {
    using std::abs, std::floor;
    count_ = save_.times.size();
    if (save_.kind == Save<X>::Kind::grid) {
      // One part in a million of a spacing is rounding, not another output.
      count_ =
          save_.spacing > 0
              ? static_cast<std::size_t>(floor(abs(interval_.to - interval_.from) / save_.spacing + Real(1e-6))) + 1
              : 0;
    }
    next_ = time(0);
    while (index_ < count_ && forward() * (next_ - interval_.from) < 0) next_ = time(++index_);
  }

  [[nodiscard]] Real time(std::size_t index) const {
    if (index >= count_) return forward() * std::numeric_limits<Real>::infinity();
    if (save_.kind == Save<X>::Kind::times) return save_.times[index];
    const Real t = interval_.from + forward() * Real(index) * save_.spacing;
    return forward() * (t - interval_.to) > 0 ? interval_.to : t;
  }

  [[nodiscard]] bool kept_at(Real t) const { return any_ && last_ == t; }

  void keep(Real t, const X& x) {
    any_ = true;
    last_ = t;
    if (save_.callback) {
      save_.callback(t, x);
      return;
    }
    solution_.t.push_back(t);
    solution_.x.push_back(x);
  }

  const Save<X>& save_;
  Interval<Real> interval_;
  X x_;
  Solution<X>& solution_;
  Real next_{}, last_{};
  std::size_t index_ = 0, count_ = 0;
  bool any_ = false;
};

/// Runs an integrator to its end.
template <class System, State X, class Events>
[[nodiscard]] Solution<X> run(Driver<System, X, Events>& integrator) {
  Solution<X> solution;
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < integrator.events().size(); ++i)
    solution.event_names.emplace_back(integrator.events().name(i));
  const Options<X>& options = integrator.options();
  SolutionRecorder<X> keeper(options.save, integrator.interval(), integrator.x(), solution);
  for (std::size_t count = 1; integrator.advance(keeper); ++count)
    if (count % 1024 == 0 && options.progress) options.progress(integrator.t());
  keeper.finish(integrator);
  solution.outcome = integrator.outcome();
  solution.statistics = integrator.statistics();
  solution.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return solution;
}

/// Integrates dx/dt = f(t, x) from x(from) = x0. A failure on the way does not throw: see Solution::outcome.
template <class System, State X, class M>
  requires(!std::same_as<M, Options<X>>)  // without a method: automatic.hpp
[[nodiscard]] Solution<X> solve(System system, X x0, Interval<std::type_identity_t<Scalar<X>>> interval, M method,
                                std::type_identity_t<Options<X>> options = {}) {
  Integrator<System, X, M> integrator(std::move(system), std::move(x0), interval, method, std::move(options));
  return run(integrator);
}

/// The same with a source of events of your own (see EventSource).
template <class System, State X, class M, class Events>
[[nodiscard]] Solution<X> solve(System system, X x0, Interval<std::type_identity_t<Scalar<X>>> interval, M method,
                                std::type_identity_t<Options<X>> options, Events events) {
  Integrator<System, X, M, Events> integrator(std::move(system), std::move(x0), interval, method, std::move(options),
                                              std::move(events));
  return run(integrator);
}

}  // namespace continuo
