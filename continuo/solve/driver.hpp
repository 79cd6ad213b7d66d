// The loop of a run: step by step, past the events of each. It knows the steps of a method only as `Steps`, so that it
// is compiled once for a system and not once for each method; `Integrator` gives it a method.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/solve/accumulation.hpp>
#include <continuo/solve/consistent.hpp>
#include <continuo/solve/guard_watch.hpp>
#include <continuo/solve/observer.hpp>
#include <continuo/solve/steps.hpp>

namespace continuo {

template <class System, State X, class Events>
class Driver {
 public:
  using Real = Scalar<X>;

  /// Takes one step, cut short at an event that changes the state, never beyond interval.to. True while there is more.
  template <class Observer = NoObserver>
  bool advance(Observer&& observer = {}) {
    if (!started_) start(observer);
    if (ended_) return false;
    if (!consistent_) return end_inconsistent();
    if (t_ == interval_.to) return end(Ending::reached_end, steps().stiff() ? stiff_hint : "");
    if (options_.interrupt && options_.interrupt->load(std::memory_order_relaxed)) return end(Ending::interrupted);
    if (statistics().steps + statistics().rejected >= options_.max_steps)
      return end(Ending::too_many_steps, steps().stiff() ? stiff_hint : "raise max_steps or loosen the tolerance");
    const Real limit = any_scheduled_ ? next_scheduled(t_, false) : interval_.to;
    // An event with an action could change everything; without one it is no use to go on to the limit of steps.
    if (const Real needed = any_turning_guard_ ? Real(0) : steps().endless(limit, options_); needed > 0) [[unlikely]]
      return end(Ending::too_many_steps, hint_of_endless(needed));
    if (!steps().take(limit, options_, outcome_)) {
      ended_ = true;
      return false;
    }
    pass_events(observer);
    if (!ended_ && t_ == interval_.to) return end(Ending::reached_end, steps().stiff() ? stiff_hint : "");
    return !ended_;
  }

  Real t() const { return t_; }
  const X& x() const { return x_; }
  const System& system() const { return steps().system(); }
  const Events& events() const { return events_; }
  const Outcome<Real>& outcome() const { return outcome_; }
  const Statistics& statistics() const { return steps().statistics(); }
  const Interval<Real>& interval() const { return interval_; }
  const Options<X>& options() const { return options_; }

  /// x at a time of the last step, on the dense output; after an event still what was before it, but for t().
  void at(Real t, X& x) {
    if (t == t_) {
      x = x_;
    } else {
      steps().at(t, x);
    }
  }

  /// The last step's dense output: coefficients in theta = (t - begin) / size, see Interpolant.
  std::span<const X> dense_output() { return steps().dense_output(); }
  Real step_begin() const { return steps().begin(); }
  Real step_size() const { return steps().size(); }

  /// Somebody else changed the state (a hand on the mouse): the run goes on from here.
  void set_state(const X& x) {
    x_ = x;
    restart();
  }
  /// Somebody changes the system (a parameter, an input): `change` gets it by reference.
  template <class Change>
  void change_system(Change&& change) {
    change(steps().system());
    restart();
  }
  /// Moves the end of the run.
  void extend_to(Real to) {
    interval_.to = to;
    if (ended_ && outcome_.ending == Ending::reached_end) ended_ = false;
  }

 protected:
  Driver(std::unique_ptr<Steps<System, X>> steps, X x0, Interval<Real> interval, Options<X> options, Events events)
      : options_(std::move(options)),
        interval_(interval),
        t_(interval.from),
        x_(x0),
        before_(std::move(x0)),
        steps_(std::move(steps)),
        events_(std::move(events)),
        watch_(events_.size()),
        accumulation_(events_.size()),
        guard_values_(events_.size()) {
    fired_.reserve(events_.size());
    next_fired_.reserve(events_.size());
    if (settle_algebraic()) this->steps().jump(t_, x_, options_);
    for (std::size_t i = 0; i < events_.size(); ++i) {
      any_guard_ = any_guard_ || events_.is_guard(i);
      any_turning_guard_ = any_turning_guard_ || (events_.is_guard(i) && can_change(events_, i));
      any_scheduled_ = any_scheduled_ || !events_.is_guard(i);
    }
  }

  Steps<System, X>& steps() { return *steps_; }
  const Steps<System, X>& steps() const { return *steps_; }

 private:
  static constexpr int most_rounds = 20, most_slides = 100;
  static constexpr const char* stiff_hint =
      "the system is stiff: stability, not accuracy, holds the steps of this method; name no method, or take rodas5p, "
      "radau or bdf";

  static std::string hint_of_endless(Real steps) {
    using std::floor, std::log10;
    const auto power = static_cast<int>(static_cast<double>(floor(log10(steps))));
    return "some 1e" + std::to_string(power) + " steps more would be needed; " + stiff_hint;
  }

  Real forward() const { return interval_.to < interval_.from ? Real(-1) : Real(1); }

  bool end(Ending ending, std::string hint = {}) {
    outcome_ = {};
    outcome_.ending = ending;
    outcome_.t = t_;
    outcome_.h = ending == Ending::reached_end ? Real(0) : steps().size();
    outcome_.hint = std::move(hint);
    ended_ = true;
    return false;
  }

  template <class Observer>
  void start(Observer& observer) {
    started_ = true;
    if (const std::string why = wrong_input(steps().needs(x_), system(), x_, interval_, options_); !why.empty()) {
      end(Ending::invalid_input, why);
      return;
    }
    if (!consistent_) {
      end_inconsistent();
      return;
    }
    arm_all();
    if (!any_scheduled_) return;
    fired_.clear();
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (!events_.is_guard(i) && events_.next_time(i, t_, true) == t_) fired_.push_back(i);
    if (!fired_.empty()) fire(observer);
  }

  void restart() {
    settle_algebraic();
    steps().jump(t_, x_, options_);
    arm_all();
  }

  // Unknowns of algebraic equations follow the rest of the state wherever a run begins anew. True where there are any.
  bool settle_algebraic() {
    if constexpr (HasMassDiagonal<System, X>) {
      if (!has_mass<X>(system())) return false;
      consistent_ = make_consistent(steps().system(), t_, x_, steps().tolerance(options_));
      steps().statistics().evaluations += static_cast<std::size_t>(consistent_.evaluations);
      return true;
    }
    return false;
  }
  bool end_inconsistent() {
    end(Ending::nonlinear_solve_failed, hint_of(consistent_));
    outcome_.component = component_name(system(), consistent_.equation);
    return false;
  }

  // A guard that is zero now is no event until it has left zero.
  void arm_all() {
    if (!any_guard_) return;
    events_.guards(steps().system(), t_, x_, std::span<Real>(guard_values_));
    for (std::size_t i = 0; i < events_.size(); ++i) arm(i);
  }
  void arm(std::size_t i) {
    GuardState<Real>& state = watch_.states()[i];
    state = {};
    state.active = events_.is_guard(i) && events_.active(steps().system(), i);
    if (state.active) state.side = sign_of(guard_values_[i]);
  }

  Real next_scheduled(Real t, bool inclusive) const {
    Real next = interval_.to;
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if (events_.is_guard(i)) continue;
      const Real time = events_.next_time(i, t, inclusive);
      if (time < next) next = time;
    }
    return next;
  }

  // The events of the step that was just taken, in the order of time.
  template <class Observer>
  void pass_events(Observer& observer) {
    using std::abs;
    const Real begin = steps().begin(), length = steps().end() - begin;
    const Real instant = 4 * std::numeric_limits<Real>::epsilon() * abs(steps().end());
    const auto evaluate_guards = [&](Real offset, std::span<Real> values) {
      state_at(offset, length, before_);
      events_.guards(steps().system(), offset == length ? steps().end() : begin + offset, before_, values);
    };
    Real from = t_, offset = t_ - begin;
    while (any_guard_) {
      const Crossing<Real>* crossing = watch_.first_crossing(offset, length, instant, evaluate_guards,
                                                             [this](std::size_t i) { return events_.direction(i); });
      if (!crossing) break;
      offset = crossing->offset;
      t_ = offset == length ? steps().end() : begin + offset;
      state_at(offset, length, x_);
      observer.stretch(*this, from, t_);
      fired_ = crossing->guards;
      add_scheduled();
      if (fire(observer)) return;
      if (t_ == steps().end()) return;
      from = t_;
    }
    t_ = steps().end();
    x_ = steps().x_end();
    observer.stretch(*this, from, t_);
    if (any_guard_) {
      events_.guards(steps().system(), t_, x_, std::span<Real>(guard_values_));
      watch_.settle(guard_values_);
    }
    if (!any_scheduled_) return;
    fired_.clear();
    add_scheduled();
    if (fired_.empty()) return;
    steps().dense_output();  // while the state and f are those of the step: `at` promises it
    fire(observer);
  }

  // x at an offset into the last step: by theta, which keeps what is lost in begin + offset.
  void state_at(Real offset, Real length, X& x) {
    if (offset == length) {
      x = steps().x_end();
    } else {
      steps().at_part(offset / steps().size(), x);
    }
  }

  void add_scheduled() {
    if (!any_scheduled_ || t_ != steps().end()) return;
    const std::size_t guards = fired_.size();
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (!events_.is_guard(i) && events_.next_time(i, t_, true) == t_) fired_.push_back(i);
    if (guards > 0) std::sort(fired_.begin(), fired_.end());
  }

  // Fires what stands in fired_ at (t_, x_), round by round. True where the step ends here.
  template <class Observer>
  bool fire(Observer& observer) {
    bool restarted = false;
    for (int round = 0; !fired_.empty(); ++round) {
      if (round == most_rounds) return accumulate(fired_.front(), t_, "its action and others keep firing each other");
      before_ = x_;
      const EventResponse response = events_.fire(steps().system(), fired_, t_, before_, x_);
      steps().statistics().events += fired_.size();
      if (response.restart) settle_algebraic();
      observer.happening(*this, Happening<X>{t_, fired_, before_, x_});
      restarted = restarted || response.restart;
      if (!consistent_) return !end_inconsistent();
      if (response.stop) {
        end(Ending::stopped_by_event);
        outcome_.event = events_.name(fired_.front());
        return true;
      }
      for (const std::size_t i : fired_)
        if (const auto limit = limit_of(i); limit && events_.is_guard(i))
          return accumulate(i, *limit, "give the model a mode to rest in, or stop at the event");
      if (any_guard_) after_round(response.restart);
      std::swap(fired_, next_fired_);
      if (!any_guard_) fired_.clear();
    }
    if (restarted) steps().jump(t_, x_, options_);
    return restarted;
  }

  std::optional<Real> limit_of(std::size_t event) {
    if (watch_.states()[event].slides >= most_slides) return t_;
    return accumulation_.fired(event, t_);
  }

  bool accumulate(std::size_t event, Real limit, std::string hint) {
    end(Ending::events_accumulate, std::move(hint));
    outcome_.event = events_.name(event);
    outcome_.limit_time = limit;
    return true;
  }

  // Guards after a round of actions: those that fired are disarmed, those pushed through zero fire next.
  void after_round(bool changed) {
    events_.guards(steps().system(), t_, x_, std::span<Real>(guard_values_));
    next_fired_.clear();
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if (!events_.is_guard(i)) continue;
      GuardState<Real>& state = watch_.states()[i];
      const bool was_active = state.active;
      const bool fired = std::find(fired_.begin(), fired_.end(), i) != fired_.end();
      if (!was_active || !events_.active(steps().system(), i)) {
        arm(i);
      } else if (fired) {
        disarm(i, changed);
      } else if (const int side = sign_of(guard_values_[i]); side != 0 && state.side == -side) {
        state.side = state.far_side = side;
        const Direction direction = events_.direction(i);
        if (direction == Direction::crosses || (direction == Direction::falls) == (side < 0)) next_fired_.push_back(i);
      }
    }
  }

  void disarm(std::size_t i, bool changed) {
    using std::abs, std::max;
    GuardState<Real>& state = watch_.states()[i];
    const Real g = guard_values_[i];
    const int far_side = state.far_side;
    state = {.far_side = far_side, .band = 4 * rounding_of(i, g), .slides = state.slides};
    if (changed && Real(far_side) * rate_of(i, g) <= 0) {
      // Beyond zero by the last bits of t: the turned trajectory has to come back through there.
      state.turned_back = true;
      if (sign_of(g) == far_side) state.band = max(state.band, abs(g));
    }
    if (abs(g) > state.band) state.side = sign_of(g);
  }

  // What g loses by rounding at this state: its change when t and x move by two units in the last place.
  Real rounding_of(std::size_t i, Real g) {
    using std::abs;
    const Real part = 1 + 4 * std::numeric_limits<Real>::epsilon();
    X& moved = before_;
    for (std::size_t k = 0; k < dimension(x_); ++k) moved.data()[k] = part * x_.data()[k];
    return abs(guard_at(i, part * t_, moved) - g);
  }

  // The sign of dg/dt along f after the action, by a difference over a thousandth of the last step.
  Real rate_of(std::size_t i, Real g) {
    const Real dt = Real(1e-3) * (steps().size() != 0 ? steps().size() : Real(1e-6) * (interval_.to - interval_.from));
    const X& slope = steps().slope(t_, x_);
    X& moved = before_;
    for (std::size_t k = 0; k < dimension(x_); ++k) moved.data()[k] = x_.data()[k] + dt * slope.data()[k];
    return forward() * (guard_at(i, t_ + dt, moved) - g);
  }

  Real guard_at(std::size_t i, Real t, const X& x) {
    rate_values_.resize(events_.size());
    events_.guards(steps().system(), t, x, std::span<Real>(rate_values_));
    return rate_values_[i];
  }

  Options<X> options_;
  Interval<Real> interval_;
  Real t_;
  X x_, before_;
  StepsValue<System, X> steps_;
  Events events_;
  GuardWatch<Real> watch_;
  AccumulationWatch<Real> accumulation_;
  std::vector<Real> guard_values_, rate_values_;
  std::vector<std::size_t> fired_, next_fired_;
  Consistency consistent_;
  bool started_ = false, ended_ = false, any_guard_ = false, any_scheduled_ = false;
  bool any_turning_guard_ = false;  // one that can change the run
  Outcome<Real> outcome_;
};

}  // namespace continuo
