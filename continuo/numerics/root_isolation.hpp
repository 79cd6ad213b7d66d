// continuo/numerics/root_isolation.hpp
// All changes of side of a function over an interval, by proof: where enclosures exclude the other side there is none,
// where the slope excludes zero there is one at most, and the rest is divided.
//
//   using E = EnclosureWithSlope<double>;
//   const auto f = [](const E& theta) { return theta * theta - E(2.0); };
//   isolate_crossings(
//       0.0, 4.0, -1, [&](double a, double b) { return f(E({a, b}, Enclosure(1.0))); },
//       [&](double a) { return f(E(a)).value; },
//       [](double a, double b, int, bool) { return fmt::print("one from {} to {}\n", a, b), false; },  // true: enough
//       [](double a, double b) { return fmt::print("perhaps some from {} to {}\n", a, b), false; });
//
// The function has a side, the sign that it had last for certain. Zero, and what is zero up to rounding, belongs to the
// side that it was reached from: touches are no crossings. A jump from one side to the other is one, between
// neighbouring numbers or a few roundings apart.
//
// R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval Analysis (2009), chapters 6 and 8.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/numerics/enclosure_with_slope.hpp>

namespace continuo {

/// What is known of a function, and how much may be spent on it.
template <class Real>
struct IsolationLimits {
  Real band = 0;                // where it begins the function is zero up to here, by its rounding
  bool begins_on_side = false;  // for certain, so that nobody need look
  std::size_t budget = 2000;    // evaluations; no quarter of the interval takes from what the later ones need
};

/// The result of a search for crossings.
template <class Real>
struct Isolation {
  int side;                     // at the end of what was looked at
  bool proved = true;           // no stretch was left undecided
  bool stopped = false;         // a callback asked for it; what lies beyond was not looked at
  std::size_t evaluations = 0;  // of enclosures
  // After a change of side that stopped it: up to here the function only moves on, away from zero.
  Real moves_on_to = std::numeric_limits<Real>::quiet_NaN();
};

namespace isolating {

/// A part still to be looked at, with the sign at its start: 0 where it is not known for certain. It is known from
/// `known_at` on, where the function is not as near to zero as it may be at the start.
template <class Real>
struct Piece {
  Real from, to;
  int sign;
  Real known_at;
};

/// A walk from left to right over pieces, the leftmost on top of the pile.
template <class Real, class Enclose, class Value, class Visit, class Undecided>
class Walk {
 public:
  Walk(Real from, Real to, int side, Enclose& enclose, Value& value, Visit& visit, Undecided& undecided,
       const IsolationLimits<Real>& limits)
      : from_(from),
        to_(to),
        band_(std::max(limits.band, least_band())),
        least_width_(std::numeric_limits<Real>::epsilon() * std::max(std::abs(from), std::abs(to))),
        budget_(limits.budget),
        begins_on_side_(limits.begins_on_side),
        enclose_(enclose),
        value_(value),
        visit_(visit),
        undecided_(undecided),
        held_(from),
        result_{.side = side} {}

  [[nodiscard]] Isolation<Real> run() {
    push({from_, to_, 0, from_});
    while (count_ > 0 && !result_.stopped) {
      const Piece<Real> piece = pile_[--count_];
      if (piece.sign != 0) meet(piece.sign, piece.known_at);
      if (piece.sign != 0 && !result_.stopped) held_ = piece.from;
      if (result_.stopped || !(piece.from < piece.to)) continue;
      while (piece.from >= end_of_part() && part_ < parts) ++part_;
      if (result_.evaluations >= budget_ * part_ / parts) {
        give_up(piece);
      } else {
        look_at(piece);
      }
    }
    return result_;
  }

 private:
  static constexpr std::size_t parts = 4;
  static constexpr Real width_of_jump = 64;
  static constexpr Real undefined_parts = 16;  // where the function has no value, no smaller ones are looked at
  // Division goes down to the least width, which is reached by as many halvings as the format has digits.
  static constexpr std::size_t deepest = 2 * std::numeric_limits<Real>::digits;

  [[nodiscard]] Real end_of_part() const { return from_ + (to_ - from_) * static_cast<Real>(part_) / parts; }

  void push(const Piece<Real>& piece) { pile_[count_++] = piece; }

  [[nodiscard]] int certain_sign(const Enclosure<Real>& value) const {
    return (value.lo > band_) - (value.hi < -band_);
  }

  /// Nowhere beyond zero, seen from the side, or all the way in the band where it began.
  [[nodiscard]] bool is_free(const Enclosure<Real>& value) const {
    const Real zero = least_band();
    const bool on_side = (result_.side < 0 || value.lo >= -zero) && (result_.side > 0 || value.hi <= zero);
    return on_side || (value.lo >= -band_ && value.hi <= band_);
  }

  /// The function has this sign there for certain.
  void meet(int sign, Real where) {
    if (sign == -result_.side) result_.stopped = visit_(held_, where, sign, !has_left_);
    result_.side = sign;
    held_ = where;
    has_left_ = true;
    band_ = least_band();
  }

  void meet_at(Real where) {
    if (const int sign = certain_sign(value_at(where)); sign != 0) meet(sign, where);
  }

  [[nodiscard]] Enclosure<Real> value_at(Real theta) {
    ++result_.evaluations;
    return value_(theta);
  }

  /// Whether that is all there is to know of the piece.
  [[nodiscard]] bool settles(const Enclosure<Real>& value, const Piece<Real>& piece) {
    const int sign = certain_sign(value);
    if (sign == 0 && !is_free(value)) return false;
    if (sign != 0) meet(sign, piece.from);
    if (!result_.stopped) held_ = piece.to;
    return true;
  }

  void look_at(const Piece<Real>& piece) {
    ++result_.evaluations;
    const EnclosureWithSlope<Real> whole = enclose_(piece.from, piece.to);
    if (settles(whole.value, piece)) return;
    const bool is_first = piece.from == from_ && piece.to == to_;
    if (is_first && contradicts_start()) return push(piece);
    const int direction = (whole.slope.lo > 0) - (whole.slope.hi < 0);
    if (direction != 0) {
      pass_monotone(piece, direction);
    } else {
      look_from_middle(piece, whole);
    }
  }

  /// A side that is not that of the start is left there.
  [[nodiscard]] bool contradicts_start() {
    if (begins_on_side_) return false;
    const int sign = certain_sign(value_at(from_));
    if (sign == 0 || sign == result_.side) return false;
    meet(sign, from_);
    return true;
  }

  void pass_monotone(const Piece<Real>& piece, int direction) {
    if (held_ < piece.from) meet_at(piece.from);  // it may have jumped over what is too narrow to be looked at
    if (result_.stopped) return;
    if (direction == result_.side) {
      held_ = piece.to;
    } else {
      meet_at(piece.to);
      if (result_.stopped) result_.moves_on_to = piece.to;
    }
  }

  void look_from_middle(const Piece<Real>& piece, const EnclosureWithSlope<Real>& whole) {
    const Real middle = piece.from + (piece.to - piece.from) / 2;
    const Enclosure<Real> centre = value_at(middle), &slope = whole.slope;
    const Enclosure<Real> offset = Enclosure<Real>(piece.from, piece.to) - Enclosure<Real>(middle);
    const Enclosure<Real> value = intersection(whole.value, centre + slope * offset);
    if (settles(value, piece)) return;
    // Where nothing jumps, the width of the value at a point is its rounding.
    const int sign = certain_sign(centre);
    const bool is_rounding = centre.holds(0) && slope.is_bounded() && value.magnitude() <= 4 * centre.magnitude();
    const Real width = piece.to - piece.from;
    if (is_rounding || width <= least_width_) return;
    if (!centre.is_bounded() && width <= (to_ - from_) / undefined_parts) return leave(piece.from, piece.to);
    // At a jump the pieces on both sides of it may hold its place, up to the rounding of what jumps there: to divide
    // all of them to the last would use up what is there for the rest.
    if (sign == 0 && width <= width_of_jump * least_width_) return;
    const Real reach = sign > 0 ? centre.lo : sign < 0 ? -centre.hi : Real(0);
    const auto free_width = [&](Real steepness) {  // as far as the slope cannot bring the value in the middle to zero
      constexpr Real rounding = 1 - 4 * std::numeric_limits<Real>::epsilon();
      if (sign == 0) return Real(0);
      return steepness > 0 ? std::max(rounding * reach / steepness - least_width_, Real(0)) : piece.to - piece.from;
    };
    const Real left = free_width(sign > 0 ? slope.hi : -slope.lo), right = free_width(sign > 0 ? -slope.lo : slope.hi);
    push({std::min(middle + right, piece.to), piece.to, sign, middle});
    push({piece.from, std::max(middle - left, piece.from), 0, piece.from});
  }

  /// The part has used what it may: the rest of it remains undecided.
  void give_up(const Piece<Real>& piece) {
    Real end = piece.to;
    const Real stop = std::min(end_of_part(), to_);
    while (count_ > 0 && pile_[count_ - 1].from < stop) end = pile_[--count_].to;
    leave(piece.from, end);
  }

  void leave(Real from, Real to) {
    result_.proved = false;
    result_.stopped = undecided_(from, to);
    if (result_.stopped) return;
    if (const int sign = certain_sign(value_at(to)); sign != 0) result_.side = sign;
    held_ = to;
  }

  [[nodiscard]] static Real least_band() { return std::sqrt(std::numeric_limits<Real>::min()); }

  const Real from_, to_;
  Real band_;
  const Real least_width_;
  const std::size_t budget_;
  const bool begins_on_side_;
  Enclose& enclose_;
  Value& value_;
  Visit& visit_;
  Undecided& undecided_;
  Real held_;  // where the function was last on its side
  Isolation<Real> result_;
  bool has_left_ = false;  // the zero that it began at
  std::size_t part_ = 1, count_ = 0;
  std::array<Piece<Real>, deepest> pile_;
};

}  // namespace isolating

/// Looks over from..to, where the function begins on `side` (0: on none, it takes the first that it comes to).
///   enclose(a, b) -> EnclosureWithSlope over a..b
///   value(a) -> Enclosure at a, its rounding included
///   visit(a, b, side, from_band) -> stop?  Once for every change of side, from left to right: at a the function is on
///       its old side, up to rounding, at b for certain on the new one, and between them it changes once. a = b where
///       the function begins on the other side. from_band: until a it has not left the band that it began in.
///   undecided(a, b) -> stop?  In their place among the others: stretches on which nothing is known. The side after
///       them is the one that the function has at b.
template <class Real, class Enclose, class Value, class Visit, class Undecided>
Isolation<Real> isolate_crossings(Real from, Real to, int side, Enclose&& enclose, Value&& value, Visit&& visit,
                                  Undecided&& undecided, const IsolationLimits<Real>& limits = {}) {
  return isolating::Walk<Real, Enclose, Value, Visit, Undecided>(from, to, side, enclose, value, visit, undecided,
                                                                 limits)
      .run();
}

}  // namespace continuo
