// What one run of an ensemble has for itself: its result, its rows and its events. The rules of events are those of
// `solve` (docs/events.md), kept by the same logic; here is the loop over the instants of a step, see Driver.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <continuo/ensembles/ensemble_options.hpp>
#include <continuo/ensembles/lanes/run_events.hpp>
#include <continuo/ensembles/lanes/run_steps.hpp>
#include <continuo/ensembles/run_start.hpp>
#include <continuo/solve/events/event_logic.hpp>

namespace continuo::detail {

/// Looks through the state of guards, in the way of a checkpoint: whether each has a side and has left zero.
class GuardsAreClear {
 public:
  static constexpr bool reads = false;
  template <class... Parts>
  void operator()(Parts&... parts) {
    (look(parts), ...);
  }
  template <class Value>
  void optional(Value&) {}
  [[nodiscard]] bool clear() const { return clear_; }

 private:
  bool clear_ = true;
  template <class Part>
  void look(const Part& part) {
    if constexpr (requires { part.at_zero; }) clear_ = clear_ && (!part.active || (part.side != 0 && !part.at_zero));
  }
};

/// What is the same for all runs.
template <State X, State P, class... E>
struct RunSettings {
  Interval<double> interval;
  Options<X> options;  // of one run
  bool keep_events;
  const std::tuple<E...>& events;
  RunWatcher<X>* watcher = nullptr;  // may be null
  std::string problem{};             // why no run can begin; empty where they can

  [[nodiscard]] double forward() const { return interval.to < interval.from ? -1.0 : 1.0; }
};

template <class F, State X, State P, class M, class... E>
class RunOfLane {
 public:
  using System = SystemWithParameters<F, P>;
  using Source = RunEvents<X, E...>;
  using Settings = RunSettings<X, P, E...>;
  using Result = RunResult<X, P>;
  static constexpr bool has_events = sizeof...(E) > 0;

  RunOfLane(F& f, const Settings& settings, const RunStart<X, P>& start)
      : settings_(settings),
        steps_(System{&f, start.p}, start.x, settings.forward()),
        begins_with_(Source(settings.events), start.x, settings.forward(),
                     std::abs(settings.interval.to - settings.interval.from)),
        logic_(begins_with_),
        x_(start.x),
        before_(start.x),
        samples_(start.x) {}

  /// Begins a run: its first events happen. False where it has ended at once.
  [[nodiscard]] bool begin(std::size_t run, RunStart<X, P>&& start) {
    result_.run = run;
    clear(result_.outcome);
    result_.events.clear();
    result_.rows.clear();
    t_ = settings_.interval.from;
    x_ = std::move(start.x);
    steps_.system().p = std::move(start.p);
    steps_.begin_run(t_, x_, settings_.options);
    if constexpr (has_events) logic_ = begins_with_;
    next_row_ = 0;
    ended_ = false;
    events_ = 0;
    if (const std::string why = problem(); !why.empty()) return end(Ending::invalid_input, why);
    skip_rows();
    if constexpr (has_events) {
      logic_.begin_instant(t_);
      logic_.arm(steps_, t_, x_);
      fire();
      look_at_guards();
    }
    if (!ended_) rows_of_instant();
    if (!ended_ && t_ == settings_.interval.to) return end(Ending::reached_end);
    return !ended_;
  }

  [[nodiscard]] double t() const { return t_; }
  [[nodiscard]] const X& x() const { return x_; }
  [[nodiscard]] const P& p() const { return steps_.system().p; }
  [[nodiscard]] RunSteps<System, X, M>& steps() { return steps_; }
  [[nodiscard]] Result& result() { return result_; }

  /// The time up to which the next step may go.
  [[nodiscard]] double limit() const {
    if constexpr (Source::any_scheduled) {
      return logic_.next_restart(t_, settings_.interval.to);
    } else {
      return settings_.interval.to;
    }
  }
  /// Whether the next step has to be searched for events in any case. Else only where a guard comes near to zero.
  [[nodiscard]] bool must_look() const { return Source::any_scheduled || (Source::any_guard && !clear_); }
  /// Whether a row lies within the step to `end`.
  [[nodiscard]] bool has_row_before(double end) const {
    const std::vector<double>& times = settings_.options.save.times;
    return next_row_ < times.size() && settings_.forward() * (times[next_row_] - end) < 0;
  }

  /// Whether somebody wants to see the step to `end`.
  [[nodiscard]] bool is_watched(double end) const {
    return settings_.watcher && settings_.watcher->wants(result_.run, end);
  }

  /// Goes through the instants of the step that steps() has taken. True where the motion has been changed on the way,
  /// or has ended: then it goes on from t() and x(), if at all.
  [[nodiscard]] bool pass_step() {
    t_ = steps_.begin();
    const double length = steps_.end() - t_;
    if constexpr (has_events) {
      double offset = 0;
      const double begin = steps_.begin(),
                   instant = 4 * std::numeric_limits<double>::epsilon() * std::abs(steps_.end());
      bool known = known_;
      while (true) {
        const std::optional<double> tick = logic_.next_quiet(t_, steps_.end());
        const bool to_tick = tick && *tick != steps_.end();
        const Crossing<double>* crossing = first_crossing(offset, to_tick ? *tick - begin : length, instant, known);
        if (!crossing && !to_tick) break;
        if (crossing && !is_event(*crossing, length)) {
          offset = crossing->offset;
          known = false;
          continue;
        }
        arrive(crossing, tick, offset, length, instant);
        rows_of_segment(t_);
        logic_.begin_instant(t_);
        logic_.arrive(steps_, t_, x_, crossing);
        const bool changed = fire();
        if (ended_) return true;
        rows_of_instant();
        if (changed) return jump();
        if (t_ == steps_.end()) return finish_step();
        known = true;
      }
    }
    return end_step();
  }

  /// The end of the step without anything in it that needs a look.
  void skip_step() { known_ = false; }
  [[nodiscard]] bool ends_at(double end) const { return end == settings_.interval.to; }

  /// Ends the run where it is. Returns false.
  bool end(Ending ending, std::string hint = {}) {
    Outcome<double>& outcome = result_.outcome;
    outcome.ending = ending;
    outcome.t = t_;
    outcome.h = ending == Ending::reached_end ? 0.0 : steps_.size();
    if (!hint.empty()) outcome.hint = std::move(hint);
    ended_ = true;
    return false;
  }
  [[nodiscard]] bool ended() const { return ended_; }
  /// Sets where it is, for what happens next.
  void set_place(double t, X&& x) {
    t_ = t;
    x_ = std::move(x);
  }
  /// The result, with the last state. The run has none of its own until it begins anew.
  [[nodiscard]] Result&& finish() {
    result_.x = std::move(x_);
    result_.p = std::move(steps_.system().p);
    return std::move(result_);
  }
  [[nodiscard]] std::size_t events() const { return events_; }

 private:
  // An assignment of an empty one would move its strings.
  static void clear(Outcome<double>& outcome) {
    outcome.error = outcome.limit_time = 0;
    outcome.component.clear();
    outcome.event.clear();
    outcome.hint.clear();
  }

  using Logic = EventLogic<System, X, Source>;
  static constexpr std::size_t places = EventLocator<double>::later_samples;

  [[nodiscard]] std::string problem() {
    if (!settings_.problem.empty()) return settings_.problem;
    for (std::size_t i = 0; i < dimension(x_); ++i)
      if (!is_finite(x_.data()[i])) return component_name(steps_.system(), i) + " is not finite at the start";
    if constexpr (Source::any_guard) {
      std::array<double, Source::count> g{};
      logic_.events().guards(steps_.system(), t_, x_, std::span<double>(g));
      for (std::size_t i = 0; i < g.size(); ++i)
        if (std::isnan(g[i]))
          return "the event `" + std::string(logic_.events().name(i)) +
                 "` has a guard that is not a number at the start of the run";
    }
    return {};
  }

  [[nodiscard]] const Crossing<double>* first_crossing(double offset, double to, double instant, bool known) {
    if constexpr (!Source::any_guard) {
      return nullptr;
    } else {
      const auto evaluate = [this](const auto& place, auto&& values) { this->guards_at(place, values); };
      return logic_.first_crossing(offset, to, instant, known, evaluate);
    }
  }
  [[nodiscard]] bool is_event(const Crossing<double>& found, double length) {
    if (!logic_.leaves_first_zero(found)) return true;
    state_at(found.offset, length, before_);
    return logic_.keep_true_crossings(steps_, steps_.begin() + found.offset, before_);
  }

  // Goes to the crossing, or without one to the tick.
  void arrive(const Crossing<double>* crossing, const std::optional<double>& tick, double& offset, double length,
              double instant) {
    const double begin = steps_.begin();
    if (crossing) {
      look_at(*crossing, offset, length);
      offset = crossing->offset;
      t_ = offset == length ? steps_.end() : begin + offset;
      if (tick && std::abs(t_ - *tick) <= instant) t_ = *tick;
      state_at(offset, length, x_);
    } else {
      offset = *tick - begin;
      t_ = *tick;
      state_at(offset, length, x_);
      if (Source::any_guard) logic_.settle(steps_, t_, x_);
    }
  }
  void look_at(const Crossing<double>& crossing, double from, double length) {
    std::array<double, Source::count> values{};
    const std::span<double> g(values);
    if (logic_.others_are_at_zero(crossing)) {
      guards_at(from + (crossing.offset - from) / 2, g);
      logic_.leave_zero(crossing, g);
    }
    guards_at(crossing.offset, g);
    const double later = crossing.offset + length / 1e6;
    state_at(later, length, before_);
    logic_.look_at(steps_, crossing, g, steps_.begin() + later, before_);
  }

  void state_at(double offset, double length, X& x) {
    if (offset == length) {
      x = steps_.x_end();
    } else {
      steps_.at_part(offset / steps_.size(), x);
    }
  }
  void guards_at(double offset, std::span<double> values) {
    const double length = steps_.end() - steps_.begin();
    state_at(offset, length, before_);
    logic_.events().guards(steps_.system(), offset == length ? steps_.end() : steps_.begin() + offset, before_, values);
  }
  void guards_at(const std::array<double, places>& offsets, std::span<double> values) {
    const double length = steps_.end() - steps_.begin();
    std::array<double, places> parts;
    for (std::size_t k = 0; k < places; ++k) parts[k] = offsets[k] / steps_.size();
    steps_.at_parts(parts, std::span<X, places>(samples_.states));
    for (std::size_t k = 0; k < places; ++k) {
      const std::span<double> here = values.subspan(k * Source::count, Source::count);
      if (offsets[k] == length) {
        guards_at(length, here);
      } else {
        logic_.events().guards(steps_.system(), steps_.begin() + offsets[k], samples_.states[k], here);
      }
    }
  }

  // The end of a step in which nothing has happened.
  [[nodiscard]] bool end_step() {
    t_ = steps_.end();
    x_ = steps_.x_end();
    rows_of_segment(t_);
    bool changed = false;
    if constexpr (has_events) {
      if (Source::any_guard) logic_.settle(steps_, t_, x_);
      logic_.begin_instant(t_);
      if (!logic_.fired().empty()) {
        steps_.dense_output();  // as for one run: f at the end of the step is kept
        logic_.arrive(steps_, t_, x_, nullptr);
        changed = fire();
      }
    }
    if (ended_) return true;
    rows_of_instant();
    return changed ? jump() : finish_step();
  }
  [[nodiscard]] bool jump() {
    steps_.jump(t_, x_, settings_.options);
    static_cast<void>(finish_step());
    return true;
  }
  [[nodiscard]] bool finish_step() {
    known_ = true;
    look_at_guards();
    if (t_ != settings_.interval.to) return false;
    end(Ending::reached_end);
    return true;
  }

  // Fires the events of the instant, round by round. True where one has changed the motion.
  bool fire() {
    bool restarted = false;
    while (!logic_.fired().empty()) {
      logic_.begin_round();
      std::optional<std::size_t> stopped;
      for (const std::size_t i : logic_.fired()) {
        const EventResponse response = act(i, false);
        restarted = restarted || response.restart;
        if (response.stop && !stopped) stopped = i;
      }
      if (stopped) {
        end(Ending::stopped_by_event);
        result_.outcome.event = logic_.events().name(*stopped);
      }
      if (ended_) return true;
      logic_.end_round(steps_, t_, x_);
      if (events_ >= settings_.options.max_steps) {
        end(Ending::too_many_steps, "as many events as the run may have steps: look for one that fires without end");
        return true;
      }
    }
    return restarted;
  }
  [[nodiscard]] EventResponse act(std::size_t i, bool at_limit) {
    before_ = x_;
    EventResponse response = at_limit ? logic_.events().at_limit(steps_.system(), i, t_, before_, x_)
                                      : logic_.events().fire(steps_.system(), i, t_, before_, x_);
    if (!at_limit) ++events_;
    if (settings_.keep_events) result_.events.push_back({i, t_, before_, x_});
    logic_.acted(steps_, i, response, t_, x_);
    if (at_limit || !logic_.events().is_guard(i)) return response;
    std::optional<double> limit = logic_.accumulation().fired(i, t_);
    if (!limit && ((logic_.is_held(i) && !response.restart) || logic_.stays(i))) limit = t_;
    if (!limit) return response;
    logic_.accumulation().forget(i);
    if (!logic_.events().has_limit_action(i)) {
      if (!ended_) {
        end(Ending::events_accumulate, "give the event a `then` for what happens at the limit, or stop at it");
        result_.outcome.event = logic_.events().name(i);
        result_.outcome.limit_time = *limit;
      }
      return response;
    }
    const EventResponse further = act(i, true);
    response.stop = response.stop || further.stop;
    response.restart = response.restart || further.restart;
    return response;
  }

  void look_at_guards() {
    if constexpr (Source::any_guard) {
      GuardsAreClear guards;
      logic_.transfer(guards);
      clear_ = guards.clear();
    }
  }

  void skip_rows() {
    while (next_row_ < settings_.options.save.times.size() &&
           settings_.forward() * (settings_.options.save.times[next_row_] - t_) < 0)
      ++next_row_;
  }
  void rows_of_segment(double to) {
    const double length = steps_.end() - steps_.begin();
    while (has_row_before(to)) {
      state_at(settings_.options.save.times[next_row_++] - steps_.begin(), length, before_);
      result_.rows.push_back(before_);
    }
    if (is_watched(to)) show(to);
  }
  void show(double to) {
    settings_.watcher->on_piece(result_.run, to, [this](double t, X& x) {
      if (t == t_) {
        x = x_;
      } else {
        steps_.at(t, x);
      }
    });
  }
  void rows_of_instant() {
    const std::vector<double>& times = settings_.options.save.times;
    for (; next_row_ < times.size() && settings_.forward() * (times[next_row_] - t_) <= 0; ++next_row_)
      result_.rows.push_back(x_);
  }

  struct Samples {
    std::vector<X> states;
    explicit Samples(const X& x) : states(places, x) {}
  };

  const Settings& settings_;
  RunSteps<System, X, M> steps_;
  Logic begins_with_, logic_;
  double t_ = 0;
  X x_, before_;
  Samples samples_;
  Result result_;
  std::size_t next_row_ = 0, events_ = 0;
  bool ended_ = true, clear_ = false;
  bool known_ = true;  // the guards, where the next step begins
};

}  // namespace continuo::detail
