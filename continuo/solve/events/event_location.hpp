// Finds the first place of a step where a guard changes its side.
//
// The side of a guard is kept by the driver (GuardState). Zero belongs to the side it was reached from, so that a root
// on a step's end is found by one of the two steps, once. A guard that is at zero after an event has the side to which
// the motion carries it; until it has left the band around zero, whose width is the rounding of g, it crosses where it
// leaves the band on the other side: so a ball whose bounces are too small for the number format does not fall through
// its floor.
//
// Guards that can be enclosed over parts of a step (a model's) are searched by proof (numerics/root_isolation.hpp): no
// root of the dense output is missed. Other guards are sampled, and so are the parts that enclosures leave undecided:
// at nine points, and at more where these do not resolve g. Two roots are missed where they are nearer to each other
// than a polynomial of degree eight over a part can show.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/bernstein.hpp>
#include <continuo/numerics/root_bracketing.hpp>
#include <continuo/numerics/root_isolation.hpp>
#include <continuo/solve/direction.hpp>
#include <continuo/solve/events/per_event.hpp>

namespace continuo {

template <class Real>
[[nodiscard]] int sign_of(Real value) {
  return (value > Real(0)) - (value < Real(0));
}

/// Whether an event that watches this direction fires where the side becomes `side`.
[[nodiscard]] constexpr bool watches(Direction direction, int side) {
  return direction == Direction::crosses || (direction == Direction::falls) == (side < 0);
}

/// The state of one guard.
template <class Real>
struct GuardState {
  int side = 0;          // 0: g has been zero since the run began
  bool at_zero = false;  // within `band` of zero since its last event, or since the run began
  bool active = true;
  Real band{};
  int returns = 0;  // crossings in a row out of the band to the far side, without leaving it to the other

  /// For checkpoints.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(side, at_zero, active, band, returns);
  }

  /// The value that g has to pass for its side to change.
  [[nodiscard]] Real level() const { return at_zero && side != 0 ? -Real(side) * band : Real(0); }
};

/// The first crossing of a segment, and the guards that take part in it.
template <class Real>
struct Crossing {
  Real offset;                      // on the far side of all of them
  std::vector<std::size_t> guards;  // in order of declaration
};

/// No guard can be enclosed.
struct NotEnclosed {
  [[nodiscard]] static constexpr bool has(std::size_t) { return false; }
};

/// The guards of a source of events over the step of this size that it has taken, by offsets into the step.
template <class Events, class Real>
struct EnclosedStep {
  Events& events;
  Real size;

  [[nodiscard]] bool has(std::size_t i) const { return events.is_enclosed(i); }
  void enclose_all(Real from, Real to) { events.enclose_all(from / size, to / size); }
  /// Whether guard i stays on its side over the whole step: beyond zero, or in the band in which it begins.
  [[nodiscard]] bool stays(std::size_t i, const GuardState<Real>& state) const {
    const auto& whole = events.whole(i);
    if (state.side > 0 ? whole.lo > 0 : whole.hi < 0) return true;
    return state.at_zero && whole.lo > -state.band && whole.hi < state.band;
  }
};

/// The guards of one run. Places are offsets s from the start of the step: these numbers are denser than those at t, so
/// that a ball at t = 1000 is located on the floor, not a hundred thousand roundings of h below it. `evaluate(s, span)`
/// gives all guards at a place of the present segment, and `evaluate(array, span)` those at several places, one place
/// after the other.
template <class Real, std::size_t count = detail::any_count>
class EventLocator {
  template <class T, std::size_t each = 1>
  using PerGuard = detail::PerEvent<T, count, each>;

 public:
  /// The samples of a segment behind its beginning.
  static constexpr std::size_t later_samples = bernstein::count - 1;

  explicit EventLocator(std::size_t size = 0)
      : states_(size),
        scanned_(size),
        moves_on_(size),
        first_(size),
        scratch_(size),
        samples_(bernstein::count * size) {
    crossing_.guards.reserve(size);
  }

  [[nodiscard]] PerGuard<GuardState<Real>>& states() { return states_; }
  [[nodiscard]] const PerGuard<GuardState<Real>>& states() const { return states_; }
  /// The crossing that was found last.
  [[nodiscard]] Crossing<Real>& crossing() { return crossing_; }
  /// The side on which a guard of the last crossing arrived.
  [[nodiscard]] int side_after(std::size_t i) const { return scanned_[i].side; }
  [[nodiscard]] int returns_after(std::size_t i) const { return scanned_[i].returns; }

  /// To be called for every new dense output, and where the guards themselves have changed: what was proved of them
  /// does not hold any more.
  void begin_search() { std::ranges::fill(moves_on_, MovesOn{}); }

  /// The first crossing on from..to (negative when time runs backwards), or null. `direction(i)` says which crossings
  /// of guard i count; the others only move its side. Crossings less than `instant` apart are one. `known` are the
  /// guards at `from`, empty where they have not been evaluated there.
  template <class Evaluate, class DirectionOf, class Enclosed>
  [[nodiscard]] const Crossing<Real>* first_crossing(Real from, Real to, Real instant, std::span<const Real> known,
                                                     Evaluate&& evaluate, DirectionOf&& direction, Enclosed enclosed) {
    resampled_ = true;
    bool found = false;
    bool all_enclosed = false;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      first_[i] = std::numeric_limits<Real>::quiet_NaN();
      if (!states_[i].active) continue;
      scanned_[i] = states_[i];
      if (moves_on_[i].holds(from, to, states_[i].side)) continue;
      Scan scan{.state = states_[i], .guard = i, .direction = direction(i), .from = from};
      if (enclosed.has(i) && scan.state.side != 0) {
        if constexpr (!std::is_same_v<Enclosed, NotEnclosed>) {
          if (!std::exchange(all_enclosed, true)) enclosed.enclose_all(from, to);
        }
        if (is_far(scan, enclosed)) continue;
        if (!known.empty()) scan.at_from = known[i];
        const bool begins_on_side = !known.empty() && !scan.state.at_zero && sign_of(known[i]) == scan.state.side;
        isolate(scan, from, to, begins_on_side, evaluate, enclosed);
      } else {
        if (resampled_) sample(from, to, known, evaluate);
        if (cheap_no(scan)) continue;
        search(scan, from, to, evaluate, 0);
      }
      first_[i] = scan.crossing;
      scanned_[i] = scan.state;
      found = found || !std::isnan(static_cast<double>(scan.crossing));
    }
    return found ? gather(from, to, instant) : nullptr;
  }

  /// After a segment without an event: updates the guards to their values at its end.
  void settle(std::span<const Real> g) {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      GuardState<Real>& state = states_[i];
      if (!state.active) continue;
      state = scanned_[i];
      if (state.at_zero && Real(state.side) * g[i] > state.band) state.at_zero = false, state.returns = 0;
    }
  }

 private:
  /// Between two offsets of the present step a guard is proved to move away from zero, to this side.
  struct MovesOn {
    Real from = std::numeric_limits<Real>::quiet_NaN(), to{};
    int side = 0;

    [[nodiscard]] bool holds(Real begin, Real end, int present) const {
      using std::abs;
      return abs(begin) >= abs(from) && abs(end) <= abs(to) && present == side;
    }
  };

  struct Scan {
    GuardState<Real> state;  // advances along the segment
    std::size_t guard;
    Direction direction;
    Real crossing = std::numeric_limits<Real>::quiet_NaN();

    Real from{};                                            // where the search began
    Real at_from = std::numeric_limits<Real>::quiet_NaN();  // the value there, if it is known

    void arrive_at(int side) { state = {.side = side, .band = state.band}; }
  };

  template <class Evaluate>
  void sample(Real from, Real to, std::span<const Real> known, Evaluate& evaluate) {
    static_assert(bernstein::nodes.front() == 0);
    const std::span<Real> first(samples_.data(), states_.size());
    const std::span<Real> later = std::span<Real>(samples_).subspan(first.size());
    if (known.empty()) {
      evaluate(from, first);
    } else {
      std::ranges::copy(known, first.begin());
    }
    std::array<Real, later_samples> places;
    for (std::size_t k = 0; k < later_samples; ++k) places[k] = time(from, to, bernstein::nodes[k + 1]);
    evaluate(places, later);
    resampled_ = false;
  }

  [[nodiscard]] const Real& sample_of(std::size_t guard, std::size_t k) const {
    return samples_[k * states_.size() + guard];
  }

  [[nodiscard]] static Real time(Real from, Real to, double part) {
    return part == 1 ? to : from + Real(part) * (to - from);
  }

  [[nodiscard]] std::array<double, bernstein::count> values(const Scan& scan) const {
    std::array<double, bernstein::count> value;
    const Real level = scan.state.level();
    for (std::size_t k = 0; k < bernstein::count; ++k) value[k] = static_cast<double>(sample_of(scan.guard, k) - level);
    return value;
  }

  template <class Evaluate>
  [[nodiscard]] Real guard_at(std::size_t guard, Real t, Evaluate& evaluate) {
    evaluate(t, scratch_);
    return scratch_[guard];
  }

  template <class Enclosed>
  [[nodiscard]] static bool is_far(const Scan& scan, const Enclosed& enclosed) {
    if constexpr (std::is_same_v<Enclosed, NotEnclosed>) {
      return false;
    } else {
      return enclosed.stays(scan.guard, scan.state);
    }
  }

  // Searches by proof, and samples the parts that remain undecided.
  template <class Evaluate, class Enclosed>
  void isolate(Scan& scan, Real from, Real to, bool begins_on_side, Evaluate& evaluate, Enclosed& enclosed) {
    if constexpr (!std::is_same_v<Enclosed, NotEnclosed>) {
      const Real size = enclosed.size;
      // The ends of a step are rounded, and its polynomials end at 1.
      const double first = from / size, last = std::fmin(to / size, 1.0);
      const auto offset = [&](double theta) { return theta == first ? from : theta == last ? to : Real(theta) * size; };
      const auto found = isolate_crossings(
          first, last, scan.state.side, [&](double a, double b) { return enclosed.events.enclosure(scan.guard, a, b); },
          [&](double a) { return enclosed.events.value_enclosure(scan.guard, a); },
          [&](double a, double b, int side, bool from_band) {
            if (!from_band) scan.state.at_zero = false;
            if (b == last) return cross(scan, offset(a), to, evaluate);  // by the first value of the next segment
            return side != scan.state.side &&
                   arrive_beyond(scan, side, offset(a), offset(b), guard_at(scan.guard, offset(b), evaluate), evaluate);
          },
          [&](double a, double b) { return search_anew(scan, offset(a), offset(b), evaluate, 0); },
          {.band = scan.state.at_zero ? scan.state.band : Real(0), .begins_on_side = begins_on_side});
      if (!std::isnan(static_cast<double>(found.moves_on_to)))
        moves_on_[scan.guard] = {scan.crossing, offset(found.moves_on_to), scan.state.side};
    }
  }

  // Whether a guard is far from zero by all nine samples: its distance from zero exceeds its possible change between
  // them, which is taken as its whole range over the step.
  [[nodiscard]] bool cheap_no(const Scan& scan) const {
    if (scan.state.side == 0) return false;
    Real least = sample_of(scan.guard, 0), greatest = least;
    for (std::size_t k = 1; k < bernstein::count; ++k) {
      const Real g = sample_of(scan.guard, k);
      if (!(g >= least)) least = g;
      if (!(g <= greatest)) greatest = g;
    }
    const Real range = greatest - least;
    return scan.state.side > 0 ? least > range : greatest < -range;
  }

  // Searches one segment, whose samples are in samples_; halves it where nine points do not resolve g near zero.
  template <class Evaluate>
  bool search(Scan& scan, Real from, Real to, Evaluate& evaluate, int depth) {
    if (scan.state.side == 0) return leave_zero(scan, from, to, evaluate, depth);
    auto value = values(scan);
    // Zero belongs to the side from which it was reached, and so do values within the band.
    if (!(value[0] * scan.state.side > 0)) value[0] = scan.state.side * std::numeric_limits<double>::min();
    const auto b = bernstein::from_values(value);
    const double error = bernstein::interpolation_error(value);
    double largest = 0, nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < bernstein::count; ++k) {
      // These comparisons ignore NaN, as fmax and fmin do, which would be function calls.
      if (const double size = std::abs(value[k]); size > largest) largest = size;
      if (const double distance = b[k] * scan.state.side; distance < nearest) nearest = distance;
    }
    if (nearest > error) return false;
    if (!(error <= 1e-6 * largest) && depth < 4) return search_halves(scan, from, to, evaluate, depth);
    const auto visit = [&](double left, double right) {
      if (const std::size_t k = crossing_sample(value, scan.state.side, left, right); k != 0)
        return cross_between_samples(scan, value, k, from, to, evaluate);
      return cross(scan, time(from, to, left), time(from, to, right), evaluate);
    };
    const bool smooth = error <= 0.1 * largest;
    if (smooth ? bernstein::isolate_sign_changes(b, visit) : between_samples(value, visit)) return true;
    // The last check: whatever the polynomial shows, a guard that ends on the other side has crossed.
    return cross(scan, from, to, evaluate);
  }

  // Of the samples in a part in which the polynomial changes its sign once, the first one on the far side; 0 where no
  // two of them enclose the change, or where the guard is zero at the first of them.
  [[nodiscard]] static std::size_t crossing_sample(const std::array<double, bernstein::count>& value, int side,
                                                   double left, double right) {
    constexpr double zero = std::numeric_limits<double>::min();
    for (std::size_t k = 1; k < bernstein::count && bernstein::nodes[k] <= right; ++k)
      if (bernstein::nodes[k - 1] >= left && value[k - 1] * side > zero && value[k] * side < 0) return k;
    return 0;
  }

  // Between the samples k - 1 and k, whose values are known, the guard changes its side.
  template <class Evaluate>
  [[nodiscard]] bool cross_between_samples(Scan& scan, const std::array<double, bernstein::count>& value, std::size_t k,
                                           Real from, Real to, Evaluate& evaluate) {
    const int side = -scan.state.side;
    const auto sample = [&](std::size_t i) {
      return bracketing::Point<Real>{time(from, to, bernstein::nodes[i]), Real(side) * Real(value[i])};
    };
    return arrive_between(scan, side, sample(k - 1), sample(k), evaluate);
  }

  template <class Evaluate>
  [[nodiscard]] bool search_halves(Scan& scan, Real from, Real to, Evaluate& evaluate, int depth) {
    const Real middle = time(from, to, 0.5);
    return search_anew(scan, from, middle, evaluate, depth + 1) || search_anew(scan, middle, to, evaluate, depth + 1);
  }

  template <class Evaluate>
  [[nodiscard]] bool search_anew(Scan& scan, Real from, Real to, Evaluate& evaluate, int depth) {
    sample(from, to, {}, evaluate);
    resampled_ = true;
    return search(scan, from, to, evaluate, depth);
  }

  // A guard that has been zero since the run began: where it leaves its band it gets a side.
  template <class Evaluate>
  [[nodiscard]] bool leave_zero(Scan& scan, Real from, Real to, Evaluate& evaluate, int depth) {
    using std::abs;
    const Real band = scan.state.band;
    for (std::size_t k = 1; k < bernstein::count; ++k) {
      const Real g = sample_of(scan.guard, k);
      if (!(abs(g) > band)) continue;
      const auto beyond = [&](Real s) { return abs(guard_at(scan.guard, s, evaluate)) - band; };
      const Real near = time(from, to, bernstein::nodes[k - 1]), far = time(from, to, bernstein::nodes[k]);
      const Real place = enclose_root(beyond, near, far, Real(-band), Real(abs(g) - band)).far;
      scan.arrive_at(sign_of(guard_at(scan.guard, place, evaluate)));
      if (watches(scan.direction, scan.state.side)) {
        scan.crossing = place;
        return true;
      }
      return place != to && search_anew(scan, place, to, evaluate, depth);
    }
    return false;
  }

  // The changes of sign that the samples themselves show, for a guard with jumps.
  template <class Visit>
  [[nodiscard]] static bool between_samples(const std::array<double, bernstein::count>& value, Visit&& visit) {
    for (std::size_t k = 1; k < bernstein::count; ++k)
      if (sign_of(value[k - 1]) != sign_of(value[k]) && visit(bernstein::nodes[k - 1], bernstein::nodes[k]))
        return true;
    return false;
  }

  template <class Evaluate>
  [[nodiscard]] bool cross(Scan& scan, Real near, Real far, Evaluate& evaluate) {
    const Real at_far = guard_at(scan.guard, far, evaluate);
    const int side = sign_of(at_far - scan.state.level());
    return side != 0 && side != scan.state.side && arrive_beyond(scan, side, near, far, at_far, evaluate);
  }

  // Between near and far the guard changes to this side. Where it is known only by proof, its value at far may still be
  // zero by rounding: then that is the place.
  template <class Evaluate>
  [[nodiscard]] bool arrive_beyond(Scan& scan, int side, Real near, Real far, Real g_far, Evaluate& evaluate) {
    using std::min;
    const Real level = scan.state.level();
    const Real at_far = Real(side) * (g_far - level);
    Real at_near(0);
    if (at_far > 0 && watches(scan.direction, side)) {
      const bool is_known = near == scan.from && !std::isnan(static_cast<double>(scan.at_from));
      const Real g_near = is_known ? scan.at_from : guard_at(scan.guard, near, evaluate);
      at_near = min(Real(0), Real(Real(side) * (g_near - level)));
    }
    return arrive_between(scan, side, {near, at_near}, {far, at_far}, evaluate);
  }

  // The values are those of the guard, with its sign turned so that it rises from its level.
  template <class Evaluate>
  [[nodiscard]] bool arrive_between(Scan& scan, int side, const bracketing::Point<Real>& near,
                                    const bracketing::Point<Real>& far, Evaluate& evaluate) {
    const Real level = scan.state.level();
    const GuardState<Real> before = scan.state;
    scan.arrive_at(side);
    if (!watches(scan.direction, side)) return false;
    const auto beyond = [&](Real s) { return Real(side) * (guard_at(scan.guard, s, evaluate) - level); };
    scan.crossing = far.value > 0 ? enclose_root(beyond, near.t, far.t, near.value, far.value).far : far.t;
    // A guard that began at zero has left its band if it is beyond it half way.
    const Real half_way = scan.from + (scan.crossing - scan.from) / 2;
    const bool stayed = before.at_zero && !(Real(before.side) * guard_at(scan.guard, half_way, evaluate) > before.band);
    scan.state.returns = stayed ? before.returns + 1 : 0;
    return true;
  }

  [[nodiscard]] const Crossing<Real>* gather(Real from, Real to, Real instant) {
    const Real forward = to >= from ? Real(1) : Real(-1);
    Real first = std::numeric_limits<Real>::quiet_NaN();
    for (const Real& t : first_)
      if (!std::isnan(static_cast<double>(t)) && !(forward * t >= forward * first)) first = t;
    crossing_.offset = first;
    crossing_.guards.clear();
    for (std::size_t i = 0; i < first_.size(); ++i) {
      if (!(forward * (first_[i] - first) <= instant)) continue;
      crossing_.guards.push_back(i);
      if (forward * first_[i] > forward * crossing_.offset) crossing_.offset = first_[i];
    }
    return &crossing_;
  }

  PerGuard<GuardState<Real>> states_, scanned_;
  PerGuard<MovesOn> moves_on_;
  PerGuard<Real> first_, scratch_;
  PerGuard<Real, bernstein::count> samples_;  // those of all guards at one place side by side
  bool resampled_ = false;
  Crossing<Real> crossing_{};
};

}  // namespace continuo
