// The loop of a run: step by step, with the events of each step. It uses the steps of a method only through the base
// class `Steps`, so that it is compiled once for a system and not once for each method; `Integrator` adds the method.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/solve/driver/step_marks.hpp>
#include <continuo/solve/events/event_logic.hpp>
#include <continuo/solve/events/event_members.hpp>
#include <continuo/solve/observer.hpp>
#include <continuo/solve/steps/consistent.hpp>
#include <continuo/solve/steps/steps.hpp>

namespace continuo {

template <class System, State X, class Events>
class Driver {
 public:
  using Real = Scalar<X>;

  /// Takes one step, shortened at an event that changes data which f reads, never beyond interval.to. True while the
  /// run has not ended.
  template <class Observer = NoObserver>
  bool advance(Observer&& observer = {}) {
    if (!started_) {
      start(observer);
      end_instant(observer);
    }
    if (ended_) return false;
    if (!consistent_) return end_inconsistent();
    if (t_ == interval_.to) return end(Ending::reached_end, steps().stiff() ? stiff_hint : "");
    if (options_.interrupt && options_.interrupt->load(std::memory_order_relaxed)) return end(Ending::interrupted);
    if (statistics().steps + statistics().rejected >= options_.max_steps)
      return end(Ending::too_many_steps, hint_of_too_many());
    const Real limit = logic_.next_restart(t_, interval_.to);
    // A guard whose event restarts the motion could change the course of the run. Without one, a run that needs far too
    // many steps ends now, since continuing to the limit of steps would be useless.
    if (const Real needed = logic_.any_turning_guard() ? Real(0) : steps().endless(limit, options_); needed > 0)
        [[unlikely]]
      return end(Ending::too_many_steps, hint_of_endless(needed));
    begin_step();
    if constexpr (requires { observer.quiet_until(*this); }) pass_quietly(limit, observer.quiet_until(*this));
    if (!steps().take(limit, options_, outcome_)) {
      ended_ = true;
      return false;
    }
    marks_.mark(statistics().steps + statistics().rejected, steps().end());
    pass_events(observer);
    if (!ended_ && t_ == interval_.to) return end(Ending::reached_end, steps().stiff() ? stiff_hint : "");
    return !ended_;
  }

  [[nodiscard]] Real t() const { return t_; }
  [[nodiscard]] const X& x() const { return x_; }
  [[nodiscard]] const System& system() const { return steps().system(); }
  [[nodiscard]] const Events& events() const { return logic_.events(); }
  [[nodiscard]] const Outcome<Real>& outcome() const { return outcome_; }
  [[nodiscard]] const Statistics& statistics() const { return steps().statistics(); }
  [[nodiscard]] const Interval<Real>& interval() const { return interval_; }
  [[nodiscard]] const Options<X>& options() const { return options_; }

  /// x at a time of the last step, from the dense output, with the unknowns of algebraic equations solved for. At an
  /// event it is the state before it, except at t().
  void at(Real t, X& x) {
    if (t == t_) {
      x = x_;
      if (!solved_to_rounding_) solve_unknowns(t, x);
      if (!options_.signs.empty()) keep_signs(options_, x);
      return;
    }
    if constexpr (!FixedSize<X>) {
      if (dimension(x) != dimension(x_)) x = x_;
    }
    steps().at(t, x);
    for (const Shift& shift : shifts_)
      if (shift.earlier || forward() * (t - shift.t) > 0) x.data()[shift.component] = shift.value;
    complete(t, x);
  }

  /// The last step's dense output: coefficients in theta = (t - begin) / size, see Interpolant. Unknowns of algebraic
  /// equations are not solved for: they are as accurate as the polynomial of the method.
  [[nodiscard]] std::span<const X> dense_output() {
    const std::span<const X> output = steps().dense_output();
    if (shifted_.empty()) return output;
    shifted_output_.assign(output.begin(), output.end());
    for (const Shift& shift : shifted_) {
      shifted_output_[0].data()[shift.component] = shift.value;
      for (std::size_t j = 1; j < shifted_output_.size(); ++j) shifted_output_[j].data()[shift.component] = Real(0);
    }
    return shifted_output_;
  }
  [[nodiscard]] Real step_begin() const { return steps().begin(); }
  [[nodiscard]] Real step_size() const { return steps().size(); }

  /// Whether the run can begin. If it cannot, the first advance() ends it as invalid input, with the reason.
  [[nodiscard]] bool can_begin() { return problem().empty(); }
  /// For checkpoints, between two steps: reads or writes what the run from here on depends on. It is read into a driver
  /// that has been made for the same system, method and options, and has not made a step. `transfer_steps(steps,
  /// archive)` does the part of the method. The dense output of the last step is not kept.
  template <class Archive, class TransferSteps>
  void transfer(Archive& archive, TransferSteps&& transfer_steps) {
    archive.bind(steps().system());
    transfer_steps(steps(), archive);
    archive(t_, x_, started_, solved_to_rounding_, shifts_end_, restarts_, marks_, logic_);
    if constexpr (HasMassDiagonal<System, X>) unknowns_.transfer(archive, x_);
    std::size_t shifts = shifted_.size();
    archive.index(shifts, dimension(x_));
    if constexpr (Archive::reads) shifted_.resize(shifts, Shift{});
    for (Shift& shift : shifted_) {
      archive(shift.earlier, shift.t, shift.value);
      archive.index(shift.component, dimension(x_) - 1);
    }
  }

  /// Ends the run at its present time or at an earlier one of its last step, with the state x there: for observers.
  void stop(Real t, const X& x) {
    if (ended_) return;
    t_ = t;
    x_ = x;
    end(Ending::stopped_by_callback);
    stopped_ = true;
  }

  /// Sets the state from outside, for example where a user drags a body: the run continues from here. The state that
  /// the run has costs nothing; one that differs from it by no more than the tolerance (root mean square) is a
  /// correction: the method keeps its step size and its history, moved by the same way. Any other begins anew. f must
  /// be the same: change_system is for changes of it. A state of another size, or with a component that is not of its
  /// sign, ends the run as invalid input.
  void set_state(const X& x) {
    if (dimension(x) != dimension(x_)) {
      end(Ending::invalid_input, "set_state was given " + std::to_string(dimension(x)) + " components for a state of " +
                                     std::to_string(dimension(x_)));
      return;
    }
    if (std::string why = problem_of_signs(x); !why.empty()) {
      end(Ending::invalid_input, "set_state was given a state in which " + why);
      return;
    }
    if (std::equal(x.data(), x.data() + dimension(x), x_.data()) && (steps().jumped() || t_ == steps().end())) return;
    const bool keeps_history = t_ == steps().end() && shifted_.empty() && steps().is_near_end(x, options_);
    keep_last_step();
    x_ = x;
    keeps_history ? correct() : restart();
  }
  /// Continues from a state that may have another number of components: cells that have divided, particles that have
  /// left. The method begins anew with room for them, the statistics go on, and the last step is not known any more.
  /// Before that `change` gets the system by reference, if it must know. Tolerances and signs by component, pairs,
  /// masses and the pattern of the Jacobian must fit the new state: else the run ends as invalid input.
  template <class Change>
    requires(!FixedSize<X>)
  void resize(const X& x, Change&& change) {
    change(steps().system());
    before_ = x_;
    x_ = x;
    if (const std::string why = take_size(); !why.empty()) {
      x_ = before_;
      end(Ending::invalid_input, why);
      return;
    }
    before_ = x_;
    restart();
  }
  /// The same where the system need not know.
  void resize(const X& x)
    requires(!FixedSize<X>)
  {
    resize(x, [](System&) {});
  }
  /// Changes the system from outside, for example a parameter or an input: `change` gets it by reference.
  template <class Change>
  void change_system(Change&& change) {
    keep_last_step();
    change(steps().system());
    restart();
  }
  /// Moves the end of the run. An end before the present time ends the run as invalid input.
  void extend_to(Real to) {
    if (started_ && (!(forward() * (to - t_) >= 0) || !(Real(0) * to == Real(0)))) {
      end(Ending::invalid_input, "the new end of the run must be finite and not before its present time");
      return;
    }
    interval_.to = to;
    if (ended_ && outcome_.ending == Ending::reached_end) ended_ = false;
  }

 protected:
  /// Begins the steps of the method of the run.
  using Begin = std::unique_ptr<Steps<System, X>> (*)(System, X x0, Real t0, Real forward, const Options<X>&);

  Driver(std::unique_ptr<Steps<System, X>> steps, Begin begin, X x0, Interval<Real> interval, Options<X> options,
         Events events)
      : options_(std::move(options)),
        interval_(interval),
        t_(interval.from),
        x_(x0),
        before_(x0),
        at_crossing_(std::move(x0)),
        begin_(begin),
        steps_(std::move(steps)),
        logic_(std::move(events), x_, interval.to < interval.from ? Real(-1) : Real(1), length_of(interval)),
        guard_values_(logic_.events().size()),
        later_values_(logic_.events().size()) {
    if (settle_algebraic()) this->steps().jump(t_, x_, options_);
  }

  [[nodiscard]] Steps<System, X>& steps() { return *steps_; }
  [[nodiscard]] const Steps<System, X>& steps() const { return *steps_; }

 private:
  using Logic = EventLogic<System, X, Events>;
  static constexpr const char* stiff_hint =
      "the system is stiff: stability, not accuracy, holds the steps of this method; name no method, or take rodas5p, "
      "radau or bdf";

  /// The new value of a component that an event has changed, that f does not read and that is constant between events.
  /// The steps do not have this change.
  struct Shift {
    bool earlier;  // than the present step
    Real t;
    std::size_t component;
    Real value;
  };

  [[nodiscard]] static Real length_of(const Interval<Real>& interval) {
    using std::abs;
    return abs(interval.to - interval.from);
  }

  /// The hint for a run with too many steps: where they lie, and remedies.
  [[nodiscard]] std::string hint_of_too_many() {
    const std::size_t all = statistics().steps + statistics().rejected;
    const auto crowd = marks_.crowd();
    std::string hint =
        crowd ? where_steps_lie(static_cast<double>(crowd->first), static_cast<double>(crowd->second)) : std::string();
    const auto add = [&](bool applies, const char* what) {
      if (applies) hint += (hint.empty() ? "" : "; ") + std::string(what);
    };
    add(2 * statistics().rejected > all, "most of the steps were rejected");
    add(2 * restarts_ > all, "most of the steps end at events");
    add(steps().stiff(), stiff_hint);
    add(!steps().stiff(), "raise max_steps or loosen the tolerance");
    return hint;
  }
  [[nodiscard]] static std::string hint_of_endless(Real steps) {
    using std::floor, std::log10;
    const auto power = static_cast<int>(static_cast<double>(floor(log10(steps))));
    return "some 1e" + std::to_string(power) + " steps more would be needed; " + stiff_hint;
  }

  [[nodiscard]] Real forward() const { return interval_.to < interval_.from ? Real(-1) : Real(1); }

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
    if (!problem().empty()) {
      end(Ending::invalid_input, problem());
      return;
    }
    if (!consistent_) {
      end_inconsistent();
      return;
    }
    logic_.begin_instant(t_);
    logic_.arm(steps(), t_, x_);
    fire(observer);
  }

  /// Why the run cannot begin; empty where it can.
  [[nodiscard]] const std::string& problem() {
    if (problem_) return *problem_;
    // A method asks for the pairs of the system: they are tested before.
    std::string why = detail::problem_of_structure(system(), x_);
    if (why.empty()) why = wrong_input(steps().needs(x_), system(), x_, interval_, options_);
    if constexpr (detail::HasProblem<Events, X>) {
      if (why.empty() && dimension(x_) == 0) why = "the state is empty: x0 must have a component for each equation";
      if (why.empty()) why = detail::problem_of_pattern(steps().system(), x_);
      if (why.empty()) why = events().problem(t_, interval_.to, x_);
    }
    return problem_.emplace(std::move(why));
  }

  // `at` tells of the last step also after a change of the state or of f.
  void keep_last_step() {
    if (statistics().steps > 0) steps().dense_output();
  }
  void restart() {
    problem_.reset();
    settle_algebraic();
    begin_anew();
    logic_.arm(steps(), t_, x_);
    logic_.clear();
  }
  // Continues from x_, which is near to the end of the last step.
  void correct() {
    settle_algebraic();
    steps().move_end(x_);
    logic_.arm(steps(), t_, x_);
    logic_.clear();
  }
  void begin_anew() {
    steps().jump(t_, x_, options_);
    shifts_end_ = true;
  }

  // Solves for the unknowns of algebraic equations wherever a run starts again. True where there are any.
  bool settle_algebraic() {
    if constexpr (HasMassDiagonal<System, X>) {
      if (!has_mass<X>(system())) return false;
      consistent_ = make_consistent(steps().system(), t_, x_, steps().tolerance(options_), SolvedTo::rounding);
      solved_to_rounding_ = true;
      steps().statistics().evaluations += static_cast<std::size_t>(consistent_.evaluations);
      return true;
    }
    return false;
  }
  // Within a step, the polynomial gives only the first guess for the unknowns. If Newton's iteration does not converge
  // from there, the values of the polynomial remain.
  void solve_unknowns(Real t, X& x) {
    if constexpr (HasMassDiagonal<System, X>) {
      if (!has_mass<X>(system())) return;
      solved_ = x;
      const Consistency found =
          unknowns_.solve(steps().system(), t, solved_, steps().tolerance(options_), SolvedTo::rounding);
      steps().statistics().evaluations += static_cast<std::size_t>(found.evaluations);
      if (found) x = solved_;
    }
  }
  // What the polynomial of a step does not say: the invariants, the unknowns, the signs.
  void complete(Real t, X& x) {
    if (options_.projection) static_cast<void>(project(options_, t, x, solved_));
    solve_unknowns(t, x);
    if (!options_.signs.empty()) keep_signs(options_, x);
  }
  [[nodiscard]] std::string problem_of_signs(const X& x) const {
    for (std::size_t i = 0; i < std::min(options_.signs.size(), dimension(x)); ++i)
      if (!detail::has_sign(options_.signs[i], x.data()[i]))
        return component_name(system(), i) + " is not " + detail::words_for(options_.signs[i]);
    return {};
  }
  bool end_inconsistent() {
    if (const std::string why = problem_of_result(steps().system(), t_, x_); !why.empty())
      return end(Ending::invalid_input, why);
    end(Ending::nonlinear_solve_failed, hint_of(consistent_));
    outcome_.component = component_name(system(), consistent_.equation);
    return false;
  }

  void begin_step() {
    if (std::exchange(shifts_end_, false)) shifted_.clear();
    for (Shift& shift : shifted_) shift.earlier = true;
    shifts_ = shifted_;
  }

  // Lets the steps go on as long as nothing happens that anybody sees.
  void pass_quietly(Real limit, Real until) {
    const bool has_guards = logic_.any_guard();
    if (has_guards && !logic_.may_pass_quietly(steps())) return;
    if (!shifted_.empty() || forward() * (until - t_) <= 0) return;
    const std::size_t tries = statistics().steps + statistics().rejected;
    if (options_.max_steps < tries + 2) return;
    if (const std::optional<Real> tick = logic_.next_quiet(t_, until)) until = *tick;
    const std::size_t most = options_.max_steps - tries - 1,
                      before_mark = std::max(marks_.next(), tries + 1) - tries - 1;
    const std::size_t made = steps().take_quietly({.limit = limit,
                                                   .until = until,
                                                   .most = std::min(most, times_.size()),
                                                   .most_unseen = std::min(most, before_mark),
                                                   .times = times_,
                                                   .has_guards = has_guards},
                                                  options_);
    if (made == 0) return;
    for (std::size_t k = 1; k <= made; ++k)
      if (tries + k >= marks_.next()) marks_.mark(tries + k, times_[k - 1]);
    t_ = steps().end();
    x_ = steps().x_end();
    if (has_guards) logic_.pass_quietly(steps(), t_, x_);
  }

  // Processes the events of the last step, in the order of time.
  template <class Observer>
  void pass_events(Observer& observer) {
    using std::abs;
    const Real begin = steps().begin();
    Real length = steps().end() - begin, from = t_, offset = t_ - begin;
    const Real instant = 4 * std::numeric_limits<Real>::epsilon() * abs(steps().end());
    const auto evaluate = [&](const auto& place, auto&& values) { guards_at(place, length, values); };
    bool from_here = true;  // the search begins at t_
    bool knows_step = false;
    while (true) {
      if (logic_.any_guard() && Logic::has_enclosures && (!std::exchange(knows_step, true) || logic_.guards_changed()))
        logic_.take_step(steps(), dense_output());
      const std::optional<Real> tick = logic_.next_quiet(t_, steps().end());
      const bool to_tick = tick && *tick != steps().end();
      const Real to = to_tick ? *tick - begin : length;
      const Crossing<Real>* crossing =
          logic_.any_guard() ? logic_.first_crossing(offset, to, instant, from_here, evaluate) : nullptr;
      if (!crossing && !to_tick) break;
      if (crossing && !is_event(*crossing, length)) {
        offset = crossing->offset;
        from_here = false;
        continue;
      }
      if (crossing) {
        look_at(*crossing, offset, length);
        const std::optional<Real> landed = land(*crossing, length);
        if (!landed) return end_before_event();
        offset = *landed;
        const bool is_new_step = steps().end() - begin != length;
        length = steps().end() - begin;
        t_ = offset == length ? steps().end() : begin + offset;
        if (tick && abs(t_ - *tick) <= instant) t_ = *tick;
        if (is_new_step || offset != crossing->offset) {
          state_at(offset, length, x_);
        } else {
          x_ = at_crossing_;
        }
        solved_to_rounding_ = true;
        if (is_new_step) {
          knows_step = false;
          steps().dense_output();  // computed while the state and f are those of the step, for `at`
          logic_.allow_for(steps(), t_, x_, steps().tolerance(options_));
        }
      } else {
        offset = to;
        t_ = *tick;
        state_at(offset, length, x_);
        solved_to_rounding_ = true;
        if (logic_.any_guard()) logic_.settle(steps(), t_, x_);
      }
      observer.on_segment(*this, from, t_);
      if (stopped_) return;
      logic_.begin_instant(t_);
      logic_.arrive(steps(), t_, x_, crossing);
      const bool step_ends = fire(observer) || t_ == steps().end();
      end_instant(observer);
      if (step_ends || stopped_) return;
      from = t_;
      from_here = true;
    }
    end_step(from, observer);
  }

  template <class Observer>
  void end_step(Real from, Observer& observer) {
    t_ = steps().end();
    x_ = steps().x_end();
    shift(x_);
    if (logic_.any_guard()) solve_unknowns(t_, x_);
    if (!options_.signs.empty()) keep_signs(options_, x_);
    solved_to_rounding_ = logic_.any_guard();
    observer.on_segment(*this, from, t_);
    if (stopped_) return;
    if (logic_.any_guard()) logic_.settle(steps(), t_, x_);
    logic_.begin_instant(t_);
    if (!logic_.fired().empty()) {
      steps().dense_output();  // computed while the state and f are those of the step, for `at`
      logic_.arrive(steps(), t_, x_, nullptr);
      fire(observer);
    }
    end_instant(observer);
  }

  // The events of the present instant, if any, have acted.
  template <class Observer>
  void end_instant(Observer& observer) {
    if constexpr (requires { observer.on_instant(*this); }) {
      if (!stopped_) observer.on_instant(*this);
    }
  }

  // Whether a crossing is an event, and not only a guard that leaves the zero at which it began.
  [[nodiscard]] bool is_event(const Crossing<Real>& found, Real length) {
    if (!logic_.leaves_first_zero(found)) return true;
    state_at(found.offset, length, before_);
    return logic_.keep_true_crossings(steps(), steps().begin() + found.offset, before_);
  }

  std::span<const Real> guards_at(Real offset, Real length, std::span<Real> values) {
    state_at(offset, length, before_);
    logic_.events().guards(steps().system(), offset == length ? steps().end() : steps().begin() + offset, before_,
                           values);
    return values;
  }

  // The guards at the places of a sample, one place after the other; the last may be the end of the step.
  template <std::size_t Count>
  void guards_at(const std::array<Real, Count>& places, Real length, std::span<Real> values) {
    const auto values_at = [size = values.size() / Count, values](std::size_t k) {
      return values.subspan(k * size, size);
    };
    if constexpr (FixedSize<X> && Count == Steps<System, X>::parts_at_once) {
      std::array<Real, Count> parts;
      for (std::size_t k = 0; k < Count; ++k) parts[k] = places[k] / steps().size();
      samples_.resize(Count, x_);
      steps().at_parts(parts, std::span<X, Count>(samples_));
      for (std::size_t k = 0; k < Count; ++k) {
        if (places[k] == length) {
          guards_at(length, length, values_at(k));
        } else {
          const Real t = steps().begin() + places[k];
          shift(samples_[k]);
          complete(t, samples_[k]);
          logic_.events().guards(steps().system(), t, samples_[k], values_at(k));
        }
      }
    } else {
      for (std::size_t k = 0; k < Count; ++k) guards_at(places[k], length, values_at(k));
    }
  }

  void look_at(const Crossing<Real>& crossing, Real from, Real length) {
    if (logic_.others_are_at_zero(crossing))
      logic_.leave_zero(crossing, guards_at(from + (crossing.offset - from) / 2, length, guard_values_));
    state_at(crossing.offset, length, at_crossing_);
    const Real t = crossing.offset == length ? steps().end() : steps().begin() + crossing.offset;
    logic_.events().guards(steps().system(), t, at_crossing_, std::span<Real>(guard_values_));
    const Real later = crossing.offset + length / Real(1000000);
    state_at(later, length, before_);
    logic_.look_at(steps(), crossing, guard_values_, steps().begin() + later, before_);
  }

  // x at an offset into the last step, computed by theta, which keeps the digits that begin + offset would lose.
  void state_at(Real offset, Real length, X& x) {
    if (offset == length) {
      x = steps().x_end();
      shift(x);
      solve_unknowns(steps().end(), x);
      if (!options_.signs.empty()) keep_signs(options_, x);
      return;
    }
    steps().at_part(offset / steps().size(), x);
    shift(x);
    complete(steps().begin() + offset, x);
  }
  void shift(X& x) const {
    for (const Shift& one : shifted_) x.data()[one.component] = one.value;
  }

  // The polynomial of a stiff step leaves the slow solution between its ends. So for an event that restarts the motion,
  // this function takes a step of the method to the event, and the end of that step becomes the instant of the event.
  // Returns the offset of the event; none where the equations of no step can be solved any more.
  [[nodiscard]] std::optional<Real> land(const Crossing<Real>& crossing, Real length) {
    using std::abs;
    const Real place = crossing.offset;
    const bool restarts = std::ranges::any_of(crossing.guards, [this](std::size_t i) { return logic_.can_restart(i); });
    // Within some roundings of t from the beginning no step is possible, and the polynomial has not left the solution.
    const Real nothing = 1000 * std::numeric_limits<Real>::epsilon() * abs(steps().begin());
    if (!restarts || place == length || !steps().lands() || abs(place) <= nothing) return place;
    const std::size_t guard = crossing.guards.front();
    if (logic_.jumps(guard)) return land_beyond_jump(guard, place, length);
    // The slope of the guard by a difference over a thousandth of the step.
    const Real apart = length / 1000, before = guards_at(place - apart, length, later_values_)[guard];
    const Real slope = (guards_at(place, length, guard_values_)[guard] - before) / apart;
    // One part of a condition may keep it at zero until another part leaves zero. Then, as with a jump, only the side
    // is known.
    if (abs(before) <= std::numeric_limits<Real>::min()) return land_beyond_jump(guard, place, length);
    Real h = place, best = place, taken = length, least = std::numeric_limits<Real>::infinity();
    for (int tries = 0; tries < 4 && steps().retake(h, options_); ++tries) {
      taken = h;
      events_guards(steps().end(), steps().x_end());
      const Real g = guard_values_[guard];
      if (!(abs(g) < least)) break;
      least = abs(g);
      best = h;
      const Real next = h - g / slope;
      const Real unit = 2 * std::numeric_limits<Real>::epsilon() * abs(steps().end());
      if (!(forward() * next > 0) || forward() * (next - length) >= 0 || abs(next - h) <= unit) break;
      h = next;
    }
    if (taken != best && !steps().retake(best, options_)) return stay(place, length);
    return steps().end() - steps().begin();
  }
  // Restores the original step, with the event on its dense output.
  [[nodiscard]] std::optional<Real> stay(Real place, Real length) {
    return steps().retake(length, options_) ? std::optional<Real>(place) : std::nullopt;
  }
  void end_before_event() {
    t_ = steps().begin();
    x_ = steps().x_begin();
    solved_to_rounding_ = false;
    end(Ending::nonlinear_solve_failed,
        "Newton's iteration does not converge on a step to the event: take smaller steps");
  }
  // Of a guard that jumps only the side is known. Finds the first step that ends beyond the jump, among steps that are
  // longer by some units in the last place.
  [[nodiscard]] std::optional<Real> land_beyond_jump(std::size_t guard, Real place, Real length) {
    using std::abs;
    const int far = sign_of(guards_at(place, length, guard_values_)[guard]);
    Real longer = 2 * std::numeric_limits<Real>::epsilon() * abs(place);
    constexpr int most_tries = 24;
    Real h = place;
    for (int tries = 0; tries < most_tries && steps().retake(h, options_); ++tries) {
      if (is_surely_on(far, guard)) return steps().end() - steps().begin();
      h = place + forward() * longer;
      longer *= 4;
    }
    return stay(place, length);
  }
  // Whether the guard is on this side at the end of the step, and at all states that rounding may give when the
  // unknowns are solved for again.
  [[nodiscard]] bool is_surely_on(int side, std::size_t guard) {
    events_guards(steps().end(), steps().x_end());
    if (sign_of(guard_values_[guard]) != side) return false;
    if constexpr (HasMassDiagonal<System, X>) {
      if (!has_mass<X>(system())) return true;
      X solved = steps().x_end();
      shift(solved);
      solve_unknowns(steps().end(), solved);
      for (const Real roundings : {Real(-16), Real(16)}) {
        before_ = solved;
        for (std::size_t i = 0; i < dimension(before_); ++i)
          if (is_algebraic<X>(system(), i)) before_.data()[i] *= 1 + roundings * std::numeric_limits<Real>::epsilon();
        logic_.events().guards(steps().system(), steps().end(), before_, std::span<Real>(guard_values_));
        if (sign_of(guard_values_[guard]) != side) return false;
      }
    }
    return true;
  }
  void events_guards(Real t, X x) {
    shift(x);
    solve_unknowns(t, x);
    logic_.events().guards(steps().system(), t, x, std::span<Real>(guard_values_));
  }

  // Fires the list of the instant at (t_, x_), round by round. True where the step ends here.
  template <class Observer>
  bool fire(Observer& observer) {
    bool restarted = false, corrected = false;
    while (!logic_.fired().empty()) {
      logic_.begin_round();
      std::optional<std::size_t> stopped;
      for (const std::size_t i : logic_.fired()) {
        const EventResponse response = act(i, observer, false);
        if (stopped_) return true;
        restarted = restarted || (response.restart && !response.correction);
        corrected = corrected || response.correction;
        if (!consistent_) return !end_inconsistent();
        if (response.stop && !stopped) stopped = i;
      }
      if (stopped) return stop(*stopped);
      if (ended_) return true;
      logic_.end_round(steps(), t_, x_);
      if (statistics().events >= options_.max_steps || interrupted()) return end_among_events();
    }
    if (corrected && !restarted) {
      if (t_ == steps().end() && shifted_.empty() && steps().is_near_end(x_, options_)) {
        steps().move_end(x_);
      } else {
        restarted = true;
      }
    }
    if (restarted) begin_anew(), ++restarts_;
    return restarted;
  }

  // Fires one event, or, where its firings accumulate, its action at the limit.
  template <class Observer>
  [[nodiscard]] EventResponse act(std::size_t i, Observer& observer, bool at_limit) {
    before_ = x_;
    EventResponse response = at_limit ? limit_action(i) : logic_.events().fire(steps().system(), i, t_, before_, x_);
    if (!at_limit) ++steps().statistics().events;
    if constexpr (!FixedSize<X>) {
      if (dimension(x_) != dimension(before_)) {
        if (!response.resize) return end_resized(i);
        if (std::string why = take_size(); !why.empty()) return end_at_fault(i, "after its action " + why);
        response.restart = true;
        response.correction = false;
      }
    }
    if (std::string why = problem_of_signs(x_); !why.empty()) return end_at_fault(i, "after its action " + why);
    if (response.restart) settle_algebraic();
    if (response.changed && !response.restart) note_shifts();
    observer.on_event(*this, EventOccurrence<X>{t_, std::span<const std::size_t>(&i, 1), before_, x_});
    logic_.acted(steps(), i, response, t_, x_);
    if constexpr (!FixedSize<X>) {
      if (dimension(x_) != dimension(before_)) before_ = x_;  // states within steps are written to it
    }
    if (at_limit || !logic_.events().is_guard(i)) return response;
    std::optional<Real> limit = logic_.accumulation().fired(i, t_);
    if (!limit && ((logic_.is_held(i) && !response.restart) || logic_.stays(i))) limit = t_;
    if (!limit) return response;
    logic_.accumulation().forget(i);
    if (!has_limit_action(i)) {
      if (!ended_) accumulate(i, *limit);
      return response;
    }
    const EventResponse further = act(i, observer, true);
    return {response.stop || further.stop, response.restart || further.restart, response.changed || further.changed,
            response.correction && (further.correction || !further.restart), response.resize || further.resize};
  }

  [[nodiscard]] bool has_limit_action(std::size_t i) const {
    if constexpr (detail::HasLimitAction<Events, System, X>) {
      return logic_.events().has_limit_action(i);
    } else {
      return false;
    }
  }
  [[nodiscard]] EventResponse limit_action(std::size_t i) {
    if constexpr (detail::HasLimitAction<Events, System, X>) {
      return logic_.events().at_limit(steps().system(), i, t_, before_, x_);
    } else {
      return {};
    }
  }

  // Begins the steps of the method anew for x_, of another size than they were. Returns why it cannot; empty where it
  // has.
  [[nodiscard]] std::string take_size() {
    problem_.reset();
    if (!problem().empty()) return *problem_;
    const Statistics so_far = statistics();
    steps_ = StepsValue<System, X>(begin_(std::move(steps().system()), x_, t_, forward(), options_));
    steps().follow(so_far);
    logic_.resize(x_);
    at_crossing_ = x_;
    shifts_.clear();
    shifted_.clear();
    return {};
  }
  [[nodiscard]] EventResponse end_resized(std::size_t event) {
    return end_at_fault(event, "its action has changed the number of components from " +
                                   std::to_string(dimension(before_)) + " to " + std::to_string(dimension(x_)) +
                                   ": an action that is to do so sets `resize`");
  }
  [[nodiscard]] EventResponse end_at_fault(std::size_t event, std::string why) {
    end(Ending::invalid_input, std::move(why));
    outcome_.event = events().name(event);
    x_ = before_;
    stopped_ = true;
    return {};
  }

  void note_shifts() {
    for (std::size_t k = 0; k < dimension(x_); ++k) {
      if (x_.data()[k] == before_.data()[k]) continue;
      shifts_.push_back({false, t_, k, x_.data()[k]});
      const auto known = std::ranges::find(shifted_, k, &Shift::component);
      known == shifted_.end() ? shifted_.push_back(shifts_.back()) : void(*known = shifts_.back());
    }
  }

  [[nodiscard]] bool stop(std::size_t event) {
    end(Ending::stopped_by_event);
    outcome_.event = events().name(event);
    return true;
  }
  void accumulate(std::size_t event, Real limit) {
    end(Ending::events_accumulate, "give the event a `then` for what happens at the limit, or stop at it");
    outcome_.event = events().name(event);
    outcome_.limit_time = limit;
  }
  [[nodiscard]] bool interrupted() const {
    return options_.interrupt && options_.interrupt->load(std::memory_order_relaxed);
  }
  [[nodiscard]] bool end_among_events() {
    if (interrupted()) {
      end(Ending::interrupted);
    } else {
      end(Ending::too_many_steps, "as many events as the run may have steps: look for one that fires without end");
    }
    return true;
  }

  Options<X> options_;
  Interval<Real> interval_;
  Real t_;
  X x_, before_, at_crossing_;
  std::array<Real, 64> times_{};  // of the ends of quiet steps
  std::vector<X> samples_;        // the states of the last sample of the guards
  X solved_ = x_;
  UnknownsSolver<X> unknowns_{x_};
  Begin begin_;
  StepsValue<System, X> steps_;
  Logic logic_;
  std::vector<Real> guard_values_, later_values_;
  std::vector<Shift> shifts_, shifted_;  // those of the present step in order; the last one of each component
  std::vector<X> shifted_output_;
  Consistency consistent_;
  StepMarks<Real> marks_;
  std::size_t restarts_ = 0;                                // by events
  bool started_ = false, ended_ = false, stopped_ = false;  // stopped_: from outside, or by a fault of an action
  std::optional<std::string> problem_;
  bool solved_to_rounding_ = true;  // the unknowns in x_
  bool shifts_end_ = false;         // the next step begins with the whole state
  Outcome<Real> outcome_;
};

}  // namespace continuo
