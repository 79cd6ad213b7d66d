// The steps and the events of a run in their order, as an observer sees them: what the adjoint goes back over.
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <continuo/sensitivities/adjoint/step_adjoint.hpp>
#include <continuo/sensitivities/parametric_event.hpp>
#include <continuo/solve/observer.hpp>

namespace continuo::detail {

/// What determines the time of an event.
enum class EventTiming {
  fixed,    // a schedule, or the start of the run
  crossed,  // the motion crosses the guard
  set_off,  // an action of the same instant has carried the guard across
};
template <State X>
struct EventTaken {
  std::size_t event;
  Scalar<X> t;
  X before;
  EventTiming timing;
};
/// A state at a time that was asked for.
template <State X>
struct OutputTaken {
  std::size_t index;
  Scalar<X> t;
  X x;
};
/// One entry of a run: a step, an event or an output, by its place among those.
struct RunEntry {
  enum class Kind { step, event, output } kind;
  std::size_t place;
};

/// A run, entry by entry.
template <State X>
struct StepsOfRun {
  std::vector<RunEntry> entries;
  std::vector<StepTaken<X>> steps;
  std::vector<EventTaken<X>> events;
  std::vector<OutputTaken<X>> outputs;
  bool is_ambiguous = false;  // an event was set off by another than the one before it of its instant
};

template <State X, State P>
class StepsRecorder {
 public:
  using Real = Scalar<X>;

  /// All but x0 must outlive the recorder.
  StepsRecorder(const std::vector<ParametricEvent<X, P>>& events, const P& p, const X& x0, Real start,
                StepsOfRun<X>& run)
      : events_(events), p_(p), run_(run), x_(x0), start_(start) {}

  /// A piece of the present step, which is known from here to `to`.
  template <class I>
  void on_segment(I& integrator, Real, Real to) {
    using std::abs;
    const Real begin = integrator.step_begin(), size = integrator.step_size();
    if (!step_is_open_) add_step({begin, size, to, x_, false});
    step_is_open_ = true;
    StepTaken<X>& step = run_.steps.back();
    step.h = size;
    step.end = to;
    step.truncated = abs(to - (begin + size)) > 8 * std::numeric_limits<Real>::epsilon() * abs(to);
  }

  template <class I>
  void on_event(I&, const EventOccurrence<X>& now) {
    if (!instant_.empty() && instant_.front().t != now.t) instant_.clear();
    for (const std::size_t i : now.events) {
      if (!events_[i].ends_step()) continue;  // it is only noted
      const EventTiming timing = timing_of(i, now);
      // Between two crossings of one instant lies a step of no length.
      if (timing == EventTiming::crossed && !instant_.empty()) add_step({now.t, Real(0), now.t, now.before, false});
      instant_.push_back({now.t, now.before, now.after, timing});
      run_.entries.push_back({RunEntry::Kind::event, run_.events.size()});
      run_.events.push_back({i, now.t, now.before, timing});
    }
  }

  /// The end of a call of `advance`, with the state there.
  void end_step(const X& x) {
    step_is_open_ = false;
    x_ = x;
  }
  void output(std::size_t index, const Real& t, const X& x) {
    run_.entries.push_back({RunEntry::Kind::output, run_.outputs.size()});
    run_.outputs.push_back({index, t, x});
  }

 private:
  struct Change {
    Real t;
    X before, after;
    EventTiming timing;
  };

  void add_step(StepTaken<X> step) {
    run_.entries.push_back({RunEntry::Kind::step, run_.steps.size()});
    run_.steps.push_back(std::move(step));
  }

  [[nodiscard]] EventTiming timing_of(std::size_t i, const EventOccurrence<X>& now) {
    const ParametricEvent<X, P>& event = events_[i];
    if (!event.has_guard() || now.t == start_) return EventTiming::fixed;
    std::vector<Real> ignored;
    for (std::size_t c = instant_.size(); c-- > 0;) {
      const Change& change = instant_[c];
      if (event.guard(now.t, change.before, p_, ignored) != event.guard(now.t, change.after, p_, ignored)) {
        for (std::size_t later = c + 1; later < instant_.size(); ++later)
          run_.is_ambiguous = run_.is_ambiguous || instant_[later].timing != EventTiming::set_off;
        return EventTiming::set_off;
      }
    }
    return EventTiming::crossed;
  }

  const std::vector<ParametricEvent<X, P>>& events_;
  const P& p_;
  StepsOfRun<X>& run_;
  X x_;
  Real start_;
  bool step_is_open_ = false;
  std::vector<Change> instant_;  // what the events of the present instant have changed
};

}  // namespace continuo::detail
