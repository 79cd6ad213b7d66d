// continuo/solve/guard_watch.hpp
// Watches the guards of events along one step and finds the first that truly crosses zero.
//
// A guard is armed once it has been away from zero: `side` is the sign it had there. It crosses when it takes the other
// sign strictly; zero itself belongs to the side it came from, so a root on a step's end is found by one of the two
// steps, once. After its event a guard within `band` (the rounding of g at that state) of zero is not armed.
//
// The floor that is never pierced: where the action turned the trajectory back (the rate of g points away from the
// far side, or is zero), leaving the band by the far side is the event again. Bounces too small for the number format
// therefore accumulate and are named; they never pass.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <continuo/numerics/bernstein.hpp>
#include <continuo/numerics/root_bracketing.hpp>
#include <continuo/solve/event.hpp>

namespace continuo {

template <class Real>
int sign_of(Real value) {
  return (value > Real(0)) - (value < Real(0));
}

/// What is remembered of one guard.
template <class Real>
struct GuardState {
  int side = 0;              // sign of g when last armed; 0: not armed
  int far_side = 0;          // sign of g beyond its last event
  bool turned_back = false;  // not armed, and leaving by far_side is the event again
  bool active = true;
  Real band{};     // |g| up to here is zero for a guard that is not armed
  int slides = 0;  // firings in a row by leaving the band: the trajectory is held at zero
};

/// Where the first crossing of a stretch lies and which guards take part.
template <class Real>
struct Crossing {
  Real offset;                      // on the far side of all of them
  std::vector<std::size_t> guards;  // in order of declaration
};

/// The guards of one run. Places are offsets s from the start of the step: there the numbers lie denser than at t, and
/// a ball at t = 1000 is found on the floor, not a hundred thousand roundings of h below it. `evaluate(s, span)` gives
/// all guards at a place of the current stretch.
template <class Real>
class GuardWatch {
 public:
  explicit GuardWatch(std::size_t size = 0)
      : states_(size),
        scanned_(size),
        first_(size),
        scratch_(size),
        samples_(bernstein::count, std::vector<Real>(size)) {
    crossing_.guards.reserve(size);
  }

  std::vector<GuardState<Real>>& states() { return states_; }

  /// The first crossing on from..to (negative when time runs backwards), or null. `direction(i)` says which crossings
  /// of guard i count; the others only move its side. Crossings less than `instant` apart are one.
  template <class Evaluate, class DirectionOf>
  const Crossing<Real>* first_crossing(Real from, Real to, Real instant, Evaluate&& evaluate, DirectionOf&& direction) {
    sample(from, to, evaluate);
    bool found = false;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      first_[i] = std::numeric_limits<Real>::quiet_NaN();
      if (!states_[i].active) continue;
      scanned_[i] = states_[i];
      Scan scan{states_[i], i, direction(i)};
      if (cheap_no(scan)) continue;
      search(scan, from, to, evaluate, 0);
      first_[i] = scan.crossing;
      scanned_[i] = scan.state;
      found = found || !std::isnan(static_cast<double>(scan.crossing));
      if (resampled_) sample(from, to, evaluate);
    }
    return found ? gather(from, to, instant) : nullptr;
  }

  /// After a stretch without an event: the guards as they stand at its end.
  void settle(std::span<const Real> g) {
    using std::abs;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      GuardState<Real>& state = states_[i];
      if (state.active) state = scanned_[i];
      if (!state.active || !(abs(g[i]) > state.band)) continue;
      state = {.side = sign_of(g[i])};
    }
  }

 private:
  struct Scan {
    GuardState<Real> state;  // moves along the stretch
    std::size_t guard;
    Direction direction;
    Real crossing = std::numeric_limits<Real>::quiet_NaN();

    bool counts(int new_side) const {
      return direction == Direction::crosses || (direction == Direction::falls) == (new_side < 0);
    }
  };

  template <class Evaluate>
  void sample(Real from, Real to, Evaluate& evaluate) {
    for (std::size_t k = 0; k < bernstein::count; ++k) evaluate(time(from, to, bernstein::nodes[k]), samples_[k]);
    resampled_ = false;
  }

  static Real time(Real from, Real to, double part) { return part == 1 ? to : from + Real(part) * (to - from); }

  std::array<double, bernstein::count> values(std::size_t guard) const {
    std::array<double, bernstein::count> value;
    for (std::size_t k = 0; k < bernstein::count; ++k) value[k] = static_cast<double>(samples_[k][guard]);
    return value;
  }

  template <class Evaluate>
  Real guard_at(std::size_t guard, Real t, Evaluate& evaluate) {
    evaluate(t, scratch_);
    return scratch_[guard];
  }

  // A guard far from zero by all nine samples: its distance from zero exceeds what it could move between them, taken
  // as its whole range over the step.
  bool cheap_no(const Scan& scan) const {
    if (scan.state.side == 0) return false;
    Real least = samples_[0][scan.guard], greatest = least;
    for (std::size_t k = 1; k < bernstein::count; ++k) {
      const Real g = samples_[k][scan.guard];
      if (!(g >= least)) least = g;
      if (!(g <= greatest)) greatest = g;
    }
    const Real range = greatest - least;
    return scan.state.side > 0 ? least > range : greatest < -range;
  }

  // Searches one stretch whose samples stand in samples_; halves it where nine points do not resolve g near zero.
  template <class Evaluate>
  bool search(Scan& scan, Real from, Real to, Evaluate& evaluate, int depth) {
    auto value = values(scan.guard);
    // Within its band a guard that is not armed is at zero: only then the root it comes from is no root of its own.
    if (scan.state.side == 0 && std::abs(value[0]) <= static_cast<double>(scan.state.band)) value[0] = 0;
    // Zero belongs to the side it was reached from.
    if (scan.state.side != 0 && value[0] == 0) value[0] = scan.state.side * std::numeric_limits<double>::min();
    const auto b = bernstein::from_values(value);
    const double error = bernstein::interpolation_error(value);
    double largest = 0, nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < bernstein::count; ++k) {
      largest = std::fmax(largest, std::abs(value[k]));
      nearest = std::fmin(nearest, b[k] * (scan.state.side != 0 ? scan.state.side : sign_of(b[k])));
    }
    if (scan.state.side != 0 && nearest > error) return false;
    if (!(error <= 1e-6 * largest) && depth < 4) {
      const Real middle = time(from, to, 0.5);
      resampled_ = true;
      for (const auto& [start, end] : {std::pair{from, middle}, std::pair{middle, to}}) {
        for (std::size_t k = 0; k < bernstein::count; ++k) evaluate(time(start, end, bernstein::nodes[k]), samples_[k]);
        if (search(scan, start, end, evaluate, depth + 1)) return true;
      }
      return false;
    }
    const auto visit = [&](double left, double right) {
      return pass_samples(scan, value, left, from, to, evaluate) ||
             cross(scan, time(from, to, left), time(from, to, right), evaluate);
    };
    const bool smooth = error <= 0.1 * largest;
    if (smooth ? bernstein::isolate_sign_changes(b, visit) : between_samples(value, visit)) return true;
    // The last net: whatever the polynomial said, a guard that ends on the other side has crossed.
    return pass_samples(scan, value, 1, from, to, evaluate) || cross(scan, from, to, evaluate);
  }

  // The changes of sign that the samples themselves show, for a guard with jumps.
  template <class Visit>
  static bool between_samples(const std::array<double, bernstein::count>& value, Visit&& visit) {
    for (std::size_t k = 1; k < bernstein::count; ++k)
      if (sign_of(value[k - 1]) != sign_of(value[k]) && visit(bernstein::nodes[k - 1], bernstein::nodes[k]))
        return true;
    return false;
  }

  // A guard that is not armed comes to `part` of the stretch: somewhere before it may have left its band.
  template <class Evaluate>
  bool pass_samples(Scan& scan, const std::array<double, bernstein::count>& value, double part, Real from, Real to,
                    Evaluate& evaluate) {
    for (std::size_t k = 1; k < bernstein::count && bernstein::nodes[k] <= part && scan.state.side == 0; ++k)
      if (pass(scan, from, time(from, to, bernstein::nodes[k]), Real(value[k]), evaluate)) return true;
    if (scan.state.side != 0 || part == 1) return false;
    const Real t = time(from, to, part);
    return pass(scan, from, t, guard_at(scan.guard, t, evaluate), evaluate);
  }

  template <class Evaluate>
  bool pass(Scan& scan, Real from, Real t, Real g, Evaluate& evaluate) {
    using std::abs, std::min;
    const Real band = scan.state.band;
    if (!(abs(g) > band)) return false;
    scan.state.side = sign_of(g);
    const int slides = std::exchange(scan.state.slides, 0);
    if (!scan.state.turned_back || scan.state.side != scan.state.far_side) return false;
    scan.state.slides = slides + 1;
    const Real side = Real(scan.state.side);
    const auto beyond = [&](Real s) { return side * guard_at(scan.guard, s, evaluate) - band; };
    scan.crossing = enclose_root(beyond, from, t, min(Real(0), beyond(from)), side * g - band).far;
    return true;
  }

  template <class Evaluate>
  bool cross(Scan& scan, Real near, Real far, Evaluate& evaluate) {
    using std::min;
    if (scan.state.side == 0) return false;
    const Real g_far = guard_at(scan.guard, far, evaluate);
    const int side = sign_of(g_far);
    if (side == 0 || side == scan.state.side) return false;
    scan.state.side = side;
    if (!scan.counts(side)) return false;
    const auto beyond = [&](Real s) { return Real(side) * guard_at(scan.guard, s, evaluate); };
    scan.crossing = enclose_root(beyond, near, far, min(Real(0), beyond(near)), Real(side) * g_far).far;
    return true;
  }

  const Crossing<Real>* gather(Real from, Real to, Real instant) {
    const Real forward = to >= from ? Real(1) : Real(-1);
    Real first = std::numeric_limits<Real>::quiet_NaN();
    for (const Real& t : first_)
      if (!std::isnan(static_cast<double>(t)) && !(forward * t >= forward * first)) first = t;
    crossing_.offset = first;
    crossing_.guards.clear();
    for (std::size_t i = 0; i < first_.size(); ++i) {
      if (!(forward * (first_[i] - first) <= instant)) continue;
      crossing_.guards.push_back(i);
      states_[i].far_side = scanned_[i].side;
      states_[i].slides = scanned_[i].slides;
      if (forward * first_[i] > forward * crossing_.offset) crossing_.offset = first_[i];
    }
    return &crossing_;
  }

  std::vector<GuardState<Real>> states_, scanned_;
  std::vector<Real> first_, scratch_;
  std::vector<std::vector<Real>> samples_;
  bool resampled_ = false;
  Crossing<Real> crossing_{};
};

}  // namespace continuo
