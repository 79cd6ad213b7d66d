// Decides which events fire, and when: the sides of guards from event to event, and the schedule. docs/events.md states
// the rules. The driver changes the state; this class only reads it.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <continuo/solve/event.hpp>
#include <continuo/solve/events/accumulation.hpp>
#include <continuo/solve/events/event_location.hpp>
#include <continuo/solve/events/event_members.hpp>
#include <continuo/solve/events/guard_motion.hpp>
#include <continuo/solve/events/per_event.hpp>
#include <continuo/solve/steps/consistent.hpp>
#include <continuo/solve/steps/steps.hpp>

namespace continuo {

template <class System, State X, class Events>
class EventLogic {
  static constexpr std::size_t count = detail::count_of_events<Events>;
  template <class T>
  using PerGuard = detail::PerEvent<T, count>;

 public:
  using Real = Scalar<X>;
  using StepsOf = Steps<System, X>;

  EventLogic(Events events, const X& x, Real forward, Real longest)
      : events_(std::move(events)),
        watch_(events_.size()),
        accumulation_(events_.size()),
        g_(events_.size()),
        rounding_(events_.size()),
        wide_(events_.size()),
        scratch_(events_.size()),
        slack_(events_.size()),
        marks_(events_.size()),
        jumps_(events_.size()),
        held_(events_.size()),
        turned_back_(events_.size()),
        forward_(forward),
        longest_(longest),
        moved_(x),
        first_(x),
        second_(x) {
    for (std::size_t i = 0; i < events_.size(); ++i) {
      any_guard_ = any_guard_ || events_.is_guard(i);
      any_turning_guard_ = any_turning_guard_ || (events_.is_guard(i) && can_restart(i));
      any_scheduled_ = any_scheduled_ || !events_.is_guard(i);
    }
    fired_.reserve(events_.size());
    next_.reserve(events_.size());
  }

  /// For checkpoints, between two steps.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(events_, accumulation_, g_, rounding_, wide_, slack_, marks_, jumps_, held_, turned_back_);
    for (GuardState<Real>& state : watch_.states()) archive(state);
    for (std::optional<Real>* time : {&last_event_, &scheduled_at_}) archive.optional(*time);
    archive(size_, jumped_, restarted_);
    if constexpr (Archive::reads) clear();
  }

  /// For states of the size of x from here on.
  void resize(const X& x) { moved_ = first_ = second_ = x; }

  [[nodiscard]] const Events& events() const { return events_; }
  [[nodiscard]] Events& events() { return events_; }
  [[nodiscard]] bool any_guard() const { return any_guard_; }
  /// Whether there is a guard whose event can change the motion.
  [[nodiscard]] bool any_turning_guard() const { return any_turning_guard_; }
  [[nodiscard]] AccumulationWatch<Real, count>& accumulation() { return accumulation_; }

  [[nodiscard]] bool can_restart(std::size_t i) const {
    if constexpr (detail::HasCanRestart<Events>) {
      return events_.can_restart(i);
    } else {
      return true;
    }
  }

  // ---- the schedule

  /// The first scheduled time after t of an event that can change the motion, at most `to`: a step ends there.
  [[nodiscard]] Real next_restart(Real t, Real to) const {
    return next_scheduled(t, to, [&](std::size_t i) { return can_restart(i); });
  }
  /// The first scheduled time after t of the other events, which happen within steps; none where it is beyond `to`.
  [[nodiscard]] std::optional<Real> next_quiet(Real t, Real to) const {
    const Real none = forward_ * std::numeric_limits<Real>::infinity();
    const Real next = next_scheduled(t, none, [&](std::size_t i) { return !can_restart(i); });
    return forward_ * (next - to) <= 0 ? std::optional<Real>(next) : std::nullopt;
  }

  /// Begins the list of an instant with the events that are scheduled for t and have not fired yet.
  void begin_instant(Real t) {
    fired_.clear();
    if (!any_scheduled_ || scheduled_at_ == t) return;
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (!events_.is_guard(i) && events_.next_time(i, t, true) == t) fired_.push_back(i);
    if (!fired_.empty()) scheduled_at_ = t;
  }
  [[nodiscard]] std::span<const std::size_t> fired() const { return fired_; }

  // ---- guards over a step

  /// The first crossing on offsets from..to of the present step; evaluate(offset, values) gives the guards. `from_here`
  /// says that the search begins where the guards were settled, armed or fired last: there they are known.
  template <class Evaluate>
  [[nodiscard]] const Crossing<Real>* first_crossing(Real from, Real to, Real instant, bool from_here,
                                                     Evaluate&& evaluate) {
    const auto direction = [this](std::size_t i) { return events_.direction(i); };
    const std::span<const Real> known = from_here ? std::span<const Real>(g_) : std::span<const Real>();
    if constexpr (has_enclosures) {
      return watch_.first_crossing(from, to, instant, known, evaluate, direction,
                                   EnclosedStep<Events, Real>{events_, size_});
    } else {
      return watch_.first_crossing(from, to, instant, known, evaluate, direction, NotEnclosed{});
    }
  }
  /// Gives the source of events the dense output of the step that is to be searched.
  void take_step(StepsOf& steps, std::span<const X> dense_output) {
    size_ = steps.size();
    guards_changed_ = false;
    watch_.begin_search();
    if constexpr (has_enclosures) events_.take_step(steps.system(), steps.begin(), size_, dense_output);
  }
  /// Whether an action since then may have changed what guards are made of.
  [[nodiscard]] bool guards_changed() const { return guards_changed_; }
  static constexpr bool has_enclosures = detail::HasEnclosures<Events, System, X>;

  /// Whether the system can take steps in which no guard has a root, and every guard is on its side, not at zero.
  [[nodiscard]] bool may_pass_quietly(StepsOf& steps) const {
    if constexpr (detail::HasWatchedBySystem<Events, System>) {
      if (!events_.watched_by(steps.system())) return false;
      const PerGuard<GuardState<Real>>& states = watch_.states();
      for (std::size_t i = 0; i < events_.size(); ++i)
        if (watched(i) && states[i].active &&
            (states[i].at_zero || states[i].side == 0 || sign_of(g_[i]) != states[i].side))
          return false;
      return true;
    } else {
      return false;
    }
  }
  /// Steps without roots have led to (t, x): no guard has changed its side.
  void pass_quietly(StepsOf& steps, Real t, const X& x) { evaluate(steps, t, x, g_); }

  /// Updates the sides at (t, x), the end of the segment that was searched last, in which there is no event.
  void settle(StepsOf& steps, Real t, const X& x) {
    evaluate(steps, t, x, g_);
    watch_.settle(g_);
  }

  // ---- an instant

  /// Gives every guard its side, at the beginning of a run or after a change of the state from outside. A guard at zero
  /// that the motion carries to the side that its event watches is no crossing, unless the event would turn the motion
  /// back: a ball that lies on the floor does not fall through it. The events of such guards are added to the list of
  /// the instant.
  void arm(StepsOf& steps, Real t, const X& x) {
    if (!any_guard_) return;
    std::ranges::fill(slack_, Real(0));
    evaluate(steps, t, x, g_);
    find_rounding(steps, t, x);
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if (!place(steps, i, t, x)) continue;
      GuardState<Real>& state = watch_.states()[i];
      if (!state.at_zero || state.side == 0) continue;
      const bool starts_false = is_condition(i) && sign_of(g_[i]) < 0 && state.side > 0;
      held_[i] = watches(events_.direction(i), state.side) && restores(steps, i, t, x, -state.side);
      if (starts_false || held_[i]) add(fired_, i);
    }
    std::sort(fired_.begin(), fired_.end());
  }

  /// Tests whether guards jump at a crossing that was located on the dense output. `values` are the guards there;
  /// later_t and later_x belong to a place a millionth of the step later. Unless g jumps, its value on the far side is
  /// less than its change up to the later place, or is rounding.
  void look_at(StepsOf& steps, const Crossing<Real>& crossing, std::span<const Real> values, Real later_t,
               const X& later_x) {
    using std::abs;
    std::ranges::fill(jumps_, char{0});
    std::ranges::fill(slack_, Real(0));
    evaluate(steps, later_t, later_x, g_);
    bool rounded = false;
    for (const std::size_t i : crossing.guards) {
      const Real beyond = values[i] - watch_.states()[i].level(), becomes = abs(g_[i] - values[i]);
      if (!(abs(beyond) > becomes)) continue;
      if (!std::exchange(rounded, true)) find_rounding(steps, later_t, later_x);
      jumps_[i] = abs(beyond) > becomes + 4 * rounding_[i];
    }
  }
  /// Whether a guard that takes no part in a crossing may leave zero before it.
  [[nodiscard]] bool others_are_at_zero(const Crossing<Real>& crossing) const {
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (watch_.states()[i].active && watch_.states()[i].at_zero &&
          std::ranges::find(crossing.guards, i) == crossing.guards.end())
        return true;
    return false;
  }
  /// Updates guards by their values half way to a crossing: a guard that takes no part in it and is beyond its band has
  /// left zero.
  void leave_zero(const Crossing<Real>& crossing, std::span<const Real> values) {
    using std::abs;
    for (std::size_t i = 0; i < events_.size(); ++i) {
      GuardState<Real>& state = watch_.states()[i];
      if (!state.active || !state.at_zero || !(abs(values[i]) > state.band)) continue;
      if (std::ranges::find(crossing.guards, i) == crossing.guards.end()) state.at_zero = false;
    }
  }
  /// Finds the error of guards after a step to the instant, whose state has an error of the size of the tolerance.
  void allow_for(StepsOf& steps, Real t, const X& x, const Tolerance<Real>& tolerance) {
    using std::min;
    const Real few(2), many(1 << 10);
    evaluate(steps, t, x, g_);
    changes_by_tolerance(steps, t, x, tolerance, few, slack_);
    // Near a jump a guard changes by as much over a longer way: that is no inaccuracy.
    changes_by_tolerance(steps, t, x, tolerance, many, wide_);
    for (std::size_t i = 0; i < events_.size(); ++i) slack_[i] = min(slack_[i], wide_[i] / (many / (2 * few)));
  }
  /// Whether guard i of the crossing that was looked at jumps across zero.
  [[nodiscard]] bool jumps(std::size_t i) const { return jumps_[i] != 0; }
  /// Adds the guards that cross at the instant t to its list, before any action. `crossing` has the guards that were
  /// located; it is null where the instant is a scheduled one.
  void arrive(StepsOf& steps, Real t, const X& x, const Crossing<Real>* crossing) {
    if (!any_guard_) return;
    evaluate(steps, t, x, g_);
    find_rounding(steps, t, x);
    std::ranges::fill(marks_, char{0});
    if (!crossing) {
      std::ranges::fill(jumps_, char{0});
      std::ranges::fill(slack_, Real(0));
    }
    if (crossing)
      for (const std::size_t i : crossing->guards) cross(i);
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (marks_[i] == 0) pass(steps, i, t, x);
    std::sort(fired_.begin(), fired_.end());
  }

  /// Whether a guard of the crossing may leave a zero that it had from the start of the run.
  [[nodiscard]] bool leaves_first_zero(const Crossing<Real>& crossing) const {
    return std::ranges::any_of(crossing.guards, [this](std::size_t i) { return watch_.states()[i].side == 0; });
  }
  /// Removes from the last crossing the guards that leave a zero that they had from the start of the run, and whose
  /// events would not turn the motion back: these only get their side. False where no guard is left.
  [[nodiscard]] bool keep_true_crossings(StepsOf& steps, Real t, const X& x) {
    std::vector<std::size_t>& guards = watch_.crossing().guards;
    std::erase_if(guards, [&](std::size_t i) {
      GuardState<Real>& state = watch_.states()[i];
      if (state.side != 0 || restores(steps, i, t, x, -watch_.side_after(i))) return false;
      state = {.side = watch_.side_after(i)};
      return true;
    });
    return !guards.empty();
  }

  /// Begins a round of the instant, in which the events of `fired()` act one after the other.
  void begin_round() {
    next_.clear();
    std::ranges::fill(marks_, char{0});
    std::ranges::fill(turned_back_, char{0});
    for (const std::size_t i : fired_) marks_[i] = pending;
    jumped_ = restarted_ = false;
  }
  /// Updates the guards after event i has acted and has left x.
  void acted(StepsOf& steps, std::size_t i, const EventResponse& response, Real t, const X& x) {
    marks_[i] = response.restart ? turned : done;
    restarted_ = restarted_ || response.restart;
    if (!any_guard_ || !(response.restart || response.changed)) return;
    jumped_ = guards_changed_ = true;
    evaluate(steps, t, x, g_);
    bool rounded = false;
    for (std::size_t k = 0; k < events_.size(); ++k) {
      if (!watched(k)) continue;
      GuardState<Real>& state = watch_.states()[k];
      if (!state.active || !events_.active(steps.system(), k) || sign_of(g_[k]) == state.side) continue;
      if (k == i && renews_guard(i)) continue;
      if (!std::exchange(rounded, true)) find_rounding(steps, t, x);
      jump(k);
    }
    // Another event of the round may carry the guard across once more.
    if (response.restart && fired_.size() > 1 && watched(i) && watch_.states()[i].active && !renews_guard(i)) {
      if (!rounded) find_rounding(steps, t, x);
      turned_back_[i] = is_still_zero(i) && way_from_zero(steps, i, t, x).side == -watch_.states()[i].side;
    }
  }
  /// Ends a round, in which every event has acted. Guards at zero get the side to which the motion carries them;
  /// `fired()` becomes the list of the next round.
  void end_round(StepsOf& steps, Real t, const X& x) {
    std::ranges::fill(held_, char{0});
    if (any_guard_ && jumped_) {
      evaluate(steps, t, x, g_);
      find_rounding(steps, t, x);
      for (std::size_t i = 0; i < events_.size(); ++i) carry(steps, i, t, x);
    }
    last_event_ = t;
    std::swap(fired_, next_);
    std::sort(fired_.begin(), fired_.end());
  }
  /// Whether event i fires because the motion, which was not turned back, would leave zero at once by the far side: a
  /// ball without restitution on its floor. If the action changes nothing either, the event would fire for ever.
  [[nodiscard]] bool is_held(std::size_t i) const { return held_[i] != 0; }
  /// Whether event i has fired too often without its guard leaving zero in between, so that the motion stays there.
  [[nodiscard]] bool stays(std::size_t i) const { return watch_.states()[i].returns >= most_returns; }
  void clear() { fired_.clear(); }

 private:
  static constexpr int most_returns = 20;
  static constexpr double chatter = 1e-6;  // of the longest way that the motion is followed
  static constexpr char pending = 1, done = 2, turned = 3;

  static void add(std::vector<std::size_t>& list, std::size_t i) {
    if (std::ranges::find(list, i) == list.end()) list.push_back(i);
  }

  [[nodiscard]] bool watched(std::size_t i) const { return events_.is_guard(i); }

  /// Whether a guard was made of a condition: its sign, even at zero, tells whether the condition is true.
  [[nodiscard]] bool is_condition(std::size_t i) const {
    if constexpr (detail::HasIsCondition<Events>) {
      return events_.is_condition(i);
    } else {
      return false;
    }
  }

  /// Whether a guard belongs to a jump of the equations, which only the motion crosses: where an action changes the
  /// state, the source settles the jumps itself. Firing gives such a guard another meaning, and it gets the side of its
  /// new values.
  [[nodiscard]] bool renews_guard(std::size_t i) const {
    if constexpr (detail::HasRenewsGuard<Events>) {
      return events_.renews_guard(i);
    } else {
      return false;
    }
  }

  template <class Counts>
  [[nodiscard]] Real next_scheduled(Real t, Real to, Counts&& counts) const {
    Real next = to;
    for (std::size_t i = 0; any_scheduled_ && i < events_.size(); ++i) {
      if (events_.is_guard(i) || !counts(i)) continue;
      const Real time = events_.next_time(i, t, false);
      if (time < next) next = time;
    }
    return next;
  }

  void evaluate(StepsOf& steps, Real t, const X& x, PerGuard<Real>& values) {
    events_.guards(steps.system(), t, x, std::span<Real>(values));
  }

  void find_rounding(StepsOf& steps, Real t, const X& x) {
    using std::abs, std::min;
    const Real few(4), many(1 << 20);
    largest_changes(steps, t, x, few, rounding_);
    const auto is_near = [&](std::size_t i) {
      return watched(i) && rounding_[i] > 0 && abs(g_[i]) <= 8 * rounding_[i];
    };
    bool any = false;
    for (std::size_t i = 0; i < events_.size() && !any; ++i) any = is_near(i);
    if (!any) return;
    // Near a jump a guard changes by as much over a longer way: that is no rounding.
    largest_changes(steps, t, x, many, wide_);
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (is_near(i)) rounding_[i] = min(rounding_[i], wide_[i] / (many / (2 * few)));
  }
  /// The change of guard i by the rounding error that a step leaves in the state, which has the size of the change over
  /// the step and not that of the state: where bodies meet in the origin, all positions are near zero.
  [[nodiscard]] Real change_by_rounding_of_step(StepsOf& steps, std::size_t i, Real t, const X& x) {
    using std::abs, std::max;
    const Real part = 16 * std::numeric_limits<Real>::epsilon() * abs(steps.size());
    first_ = steps.slope(t, x);
    Real change(0);
    for (int pattern = 0; pattern < 2; ++pattern) {
      for (std::size_t k = 0; k < dimension(x); ++k) {
        const Real moved = part * first_.data()[k];
        moved_.data()[k] = x.data()[k] + (pattern == 0 || k % 2 == 0 ? moved : -moved);
      }
      evaluate(steps, t, moved_, scratch_);
      change = max(change, abs(scratch_[i] - g_[i]));
    }
    return change;
  }
  void changes_by_tolerance(StepsOf& steps, Real t, const X& x, const Tolerance<Real>& tolerance, Real times,
                            PerGuard<Real>& changes) {
    using std::abs, std::max;
    std::ranges::fill(changes, Real(0));
    for (int pattern = 0; pattern < 2; ++pattern) {
      for (std::size_t k = 0; k < dimension(x); ++k) {
        const Real part = times * tolerance.scale(k, x.data()[k], x.data()[k]);
        moved_.data()[k] = x.data()[k] + (pattern == 0 || k % 2 == 0 ? part : -part);
      }
      evaluate(steps, t, moved_, scratch_);
      for (std::size_t i = 0; i < events_.size(); ++i)
        if (watched(i)) changes[i] = max(changes[i], abs(scratch_[i] - g_[i]));
    }
  }
  void largest_changes(StepsOf& steps, Real t, const X& x, Real units, PerGuard<Real>& changes) {
    using std::abs, std::max;
    std::ranges::fill(changes, Real(0));
    const auto look = [&](Real moved_t, const X& moved) {
      evaluate(steps, moved_t, moved, scratch_);
      for (std::size_t i = 0; i < events_.size(); ++i)
        if (watched(i)) changes[i] = max(changes[i], abs(scratch_[i] - g_[i]));
    };
    for_each_rounded(t, x, moved_, look, units);
  }

  [[nodiscard]] Carried carried(StepsOf& steps, std::size_t i, Real t, const X& x) {
    if constexpr (detail::HasCarried<Events, System, X>) {
      if (const std::optional<Carried> known = events_.carried(steps.system(), i, t, x, forward_)) {
        if (known->order != 1 || known->surely) return *known;
        // Near a jump of the equations the derivative may have an error beyond rounding, which differences show.
        const Carried seen = carried_to_first_orders(steps, i, t, x);
        return seen.surely ? seen : *known;
      }
    }
    return carried_to_first_orders(steps, i, t, x);
  }

  // The side to which the motion carries a guard at zero. If only the inaccuracy of a step keeps a condition from zero,
  // derivatives show the direction of its nearest part, not whether the condition becomes true: `x > 1 and x < 1` rises
  // until x = 1 and falls from there on. So the sign is taken where the motion has left the range of the inaccuracy.
  [[nodiscard]] Carried way_from_zero(StepsOf& steps, std::size_t i, Real t, const X& x) {
    using std::abs;
    if (is_condition(i) && abs(g_[i]) > rounding_[i])
      if (const int side = sign_beyond(steps, i, t, x, 2 * inaccuracy(i)); side != 0) return {side, 1, true};
    return carried(steps, i, t, x);
  }

  [[nodiscard]] Carried carried_to_first_orders(StepsOf& steps, std::size_t i, Real t, const X& x) {
    return carried_by_differences(
        t, x, g_[i], forward_ * length_to_follow(steps, t), rounding_[i], first_, second_, moved_,
        [&](Real at, X& y) {
          solve_unknowns(steps, at, y);
          evaluate(steps, at, y, scratch_);
          return scratch_[i];
        },
        [&](Real at, X y, X& out) {
          solve_unknowns(steps, at, y);
          out = steps.slope(at, y);
        });
  }

  // The sign, a little later, of a condition at zero that no derivative carries away from zero: one part of it may stay
  // at zero for good, where its sign tells whether it is true, while other parts leave zero.
  [[nodiscard]] int sign_a_little_later(StepsOf& steps, std::size_t i, Real t, const X& x) {
    sign_beyond(steps, i, t, x, rounding_[i]);
    return sign_of(scratch_[i]);
  }
  // The sign of guard i, in scratch_, where the motion has taken it beyond the band; 0 where it does not soon.
  int sign_beyond(StepsOf& steps, std::size_t i, Real t, const X& x, Real band) {
    using std::abs;
    const Real longest = forward_ * length_to_follow(steps, t) / 10000;
    first_ = steps.slope(t, x);
    for (Real dt = longest / 10000; abs(dt) <= abs(longest); dt *= 4) {
      for (std::size_t k = 0; k < dimension(x); ++k) moved_.data()[k] = x.data()[k] + dt * first_.data()[k];
      solve_unknowns(steps, t + dt, moved_);
      evaluate(steps, t + dt, moved_, scratch_);
      if (abs(scratch_[i]) > band) return sign_of(scratch_[i]);
    }
    return 0;
  }

  /// How far the motion may be followed without reaching the next event.
  [[nodiscard]] Real length_to_follow(const StepsOf& steps, Real t) const {
    using std::abs, std::max, std::min;
    const Real length = min(max(abs(steps.size()), longest_ / Real(1e6)), longest_);  // a step to an event is short
    const Real same_instant = 1000 * std::numeric_limits<Real>::epsilon() * abs(t);
    return last_event_ && abs(t - *last_event_) > same_instant ? min(length, abs(t - *last_event_)) : length;
  }

  static void solve_unknowns(StepsOf& steps, Real t, X& x) {
    if constexpr (HasMassDiagonal<System, X>) {
      const Tolerance<Real> close{std::numeric_limits<Real>::epsilon() * 1000, std::numeric_limits<Real>::epsilon()};
      if (has_mass<X>(steps.system())) make_consistent(steps.system(), t, x, close);
    }
  }

  /// The possible error of g at the present instant. The place of a jump of the equations that the motion has not
  /// reached is defined by the system, to rounding.
  [[nodiscard]] Real inaccuracy(std::size_t i) const {
    return renews_guard(i) ? rounding_[i] : std::max(rounding_[i], slack_[i]);
  }
  [[nodiscard]] bool at_zero(std::size_t i) const {
    using std::abs;
    return !(abs(g_[i]) > inaccuracy(i));
  }

  /// Whether guard i is at zero, or in the band that it has not left since its last event.
  [[nodiscard]] bool is_still_zero(std::size_t i) const {
    using std::abs;
    const GuardState<Real>& state = watch_.states()[i];
    return at_zero(i) || (state.at_zero && abs(g_[i]) <= state.band);
  }

  // Sets the state of a guard from its present value, without a past. False where it is not watched now.
  bool place(StepsOf& steps, std::size_t i, Real t, const X& x) {
    GuardState<Real>& state = watch_.states()[i];
    state = {};
    state.active = watched(i) && events_.active(steps.system(), i);
    if (!state.active) return false;
    state.at_zero = at_zero(i);
    state.band = rounding_[i];
    state.side = state.at_zero ? way_from_zero(steps, i, t, x).side : sign_of(g_[i]);
    if (state.side == 0 && is_condition(i)) state.side = sign_a_little_later(steps, i, t, x);
    return true;
  }

  // Processes a located crossing. A step to the instant may leave g a little on either side of zero, which counts as
  // zero.
  void cross(std::size_t i) {
    using std::abs, std::max;
    GuardState<Real>& state = watch_.states()[i];
    state.side = watch_.side_after(i);
    state.returns = watch_.returns_after(i);
    slack_[i] = jumps_[i] ? Real(0) : max(rounding_[i] + abs(g_[i]), slack_[i]);
    state.band = slack_[i];
    state.at_zero = !jumps_[i];
    marks_[i] = turned;
    add(fired_, i);
  }

  // Processes any other guard at an instant, before the actions: it may have moved to its other side, unwatched, or be
  // at zero on its way there.
  void pass(StepsOf& steps, std::size_t i, Real t, const X& x) {
    using std::abs;
    GuardState<Real>& state = watch_.states()[i];
    if (!state.active || state.side == 0) return;
    bool zero = is_still_zero(i);
    if (!zero && sign_of(g_[i]) == state.side) {
      if (state.at_zero && !(Real(state.side) * g_[i] <= state.band)) state.at_zero = false;
      return;
    }
    int side = !zero ? sign_of(g_[i]) : state.at_zero ? state.side : way_from_zero(steps, i, t, x).side;
    if (side == 0 && is_condition(i)) side = sign_a_little_later(steps, i, t, x);
    if (side == 0 || side == state.side) return;
    if (!zero && !renews_guard(i) && abs(g_[i]) <= change_by_rounding_of_step(steps, i, t, x)) {
      zero = true;
      slack_[i] = std::max(slack_[i], rounding_[i] + abs(g_[i]));
    }
    state = {.side = side, .at_zero = zero, .active = true, .band = inaccuracy(i)};
    if (watches(events_.direction(i), side)) add(fired_, i);
  }

  // After an action: processes a guard that is on the other side of zero now, beyond rounding.
  void jump(std::size_t i) {
    if (is_still_zero(i)) return;
    GuardState<Real>& state = watch_.states()[i];
    const int side = sign_of(g_[i]);
    const bool from_zero = state.side == 0;
    state = {.side = side, .at_zero = false, .active = true, .band = rounding_[i]};
    const Direction direction = events_.direction(i);
    if (renews_guard(i)) return;
    if (watches(direction, side) && !(from_zero && direction == Direction::crosses)) add(next_, i);
  }

  // At the end of a round: gives a guard at zero the side to which the motion carries it.
  void carry(StepsOf& steps, std::size_t i, Real t, const X& x) {
    using std::abs, std::max;
    GuardState<Real>& state = watch_.states()[i];
    if (!watched(i)) return;
    const bool was_active = std::exchange(state.active, events_.active(steps.system(), i));
    if (!state.active) return;
    if (!was_active) return enter(steps, i, t, x);
    const bool fired = marks_[i] == done || marks_[i] == turned;
    if (fired && jumps_[i] && sign_of(g_[i]) == state.side) return;
    const Real band = state.at_zero ? max(state.band, inaccuracy(i)) : inaccuracy(i);
    state.at_zero = abs(g_[i]) <= band;
    state.band = band;
    if (!state.at_zero) {
      if (fired) state.side = sign_of(g_[i]);
      return;
    }
    if (!restarted_ && !is_condition(i)) return;
    const Carried way = way_from_zero(steps, i, t, x);
    marks_[i] == turned ? turn(steps, i, way, t, x) : take(steps, i, way, t, x);
  }

  // Processes a guard that the present mode watches and the previous one did not.
  void enter(StepsOf& steps, std::size_t i, Real t, const X& x) {
    const Direction direction = events_.direction(i);
    place(steps, i, t, x);
    const GuardState<Real>& state = watch_.states()[i];
    if (state.at_zero && state.side != 0 && direction != Direction::crosses && watches(direction, state.side))
      add(next_, i);
  }

  // Processes a guard at zero whose event has acted.
  void turn(StepsOf& steps, std::size_t i, const Carried& way, Real t, const X& x) {
    using std::abs;
    GuardState<Real>& state = watch_.states()[i];
    if (renews_guard(i)) {
      if (way.side != 0) state.side = way.side;
    } else if (way.side == 0 && is_condition(i)) {
      state.side = sign_a_little_later(steps, i, t, x);
      // A part of the condition stays at zero for good. So the guard has not left zero since the previous event, which
      // is no chattering unless hardly any time has passed.
      if (!last_event_ || abs(t - *last_event_) > longest_ * Real(chatter)) state.returns = 0;
    } else if (way.side != state.side) {
      // The motion was turned back, which is a crossing too for an event that watches both directions, or it stays at
      // zero. The guard may be no further beyond zero than it is now.
      state.side = -state.side;
      state.band = abs(g_[i]) + rounding_[i];
      if (way.side != 0 && watches(events_.direction(i), state.side)) add(next_, i);
    } else if (turned_back_[i]) {
      // The event turned the motion back, and a later event of the round has carried it across again: of three balls
      // that meet in one point, the first two collide twice.
      add(next_, i);
    } else if (way.order > 1 || !way.surely) {
      held_[i] = 1;
      add(next_, i);
    }
  }
  // Processes any other guard at zero.
  void take(StepsOf& steps, std::size_t i, const Carried& way, Real t, const X& x) {
    GuardState<Real>& state = watch_.states()[i];
    const int side = way.side != 0 ? way.side : is_condition(i) ? sign_a_little_later(steps, i, t, x) : 0;
    if (side == 0 || side == state.side) return;
    const bool from_zero = state.side == 0;
    state.side = side;
    const Direction direction = events_.direction(i);
    if (renews_guard(i)) return;
    if (watches(direction, side) && !(from_zero && direction == Direction::crosses)) add(next_, i);
  }

  // Whether the event of guard i, which the motion carries from zero to the far side, would turn the motion back. It is
  // tried on copies, a little beyond zero.
  [[nodiscard]] bool restores(StepsOf& steps, std::size_t i, Real t, const X& x, int near) {
    if constexpr (detail::HasCanAssign<Events>) {
      if (!events_.can_assign(i)) return false;
    } else if (!can_restart(i)) {
      return false;
    }
    for (const double part : {1e-4, 1e-6, 1e-8})
      if (restores_after(steps, i, t, x, near, forward_ * longest_ * Real(part))) return true;
    return false;
  }

  [[nodiscard]] bool restores_after(StepsOf& steps, std::size_t i, Real t, const X& x, int near, Real dt) {
    Events events = events_;
    System system = steps.system();
    X slope = steps.slope(t, x), before = x;
    for (std::size_t k = 0; k < dimension(x); ++k) before.data()[k] += dt * slope.data()[k];
    const X later = steps.slope(t + dt, before);
    for (std::size_t k = 0; k < dimension(x); ++k)
      before.data()[k] = x.data()[k] + dt * (slope.data()[k] + later.data()[k]) / 2;
    X after = before;
    if (!events.fire(system, i, t + dt, before, after).restart || dimension(after) != dimension(x)) return false;
    events.guards(system, t + dt, after, std::span<Real>(scratch_));
    const Real g = scratch_[i];
    continuo::evaluate(system, t + dt, after, slope);
    divide_by_mass(system, slope);
    for (std::size_t k = 0; k < dimension(x); ++k) after.data()[k] += dt * slope.data()[k];
    events.guards(system, t + 2 * dt, after, std::span<Real>(scratch_));
    return Real(near) * (scratch_[i] - g) > 0 || Real(near) * g > 0;
  }

  Events events_;
  EventLocator<Real, count> watch_;
  AccumulationWatch<Real, count> accumulation_;
  PerGuard<Real> g_, rounding_, wide_, scratch_;
  PerGuard<Real> slack_;        // of the last instant that a step was taken to
  PerGuard<char> marks_;        // of the present round
  PerGuard<char> jumps_;        // of the guards of the last crossing: g jumps across zero
  PerGuard<char> held_;         // the event fires because the motion would leave zero at once by its far side
  PerGuard<char> turned_back_;  // of the present round: the guard was turned back by its own event
  std::vector<std::size_t> fired_, next_;
  std::optional<Real> last_event_, scheduled_at_;
  Real forward_, longest_, size_{};
  X moved_, first_, second_;  // scratch
  bool any_guard_ = false, any_turning_guard_ = false, any_scheduled_ = false;
  bool jumped_ = false, restarted_ = false;  // of the present round
  bool guards_changed_ = false;
};

}  // namespace continuo
