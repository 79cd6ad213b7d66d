// continuo/numerics/enclosure_functions.hpp
// Elementary functions of enclosures: the range over the interval, a few units in the last place wider.
//
//   sin(Enclosure<double>(0, 2))    // [0, 1], a little wider
//
// The functions of <cmath> are trusted to be within 2 units in the last place of the exact value (those of the GNU C
// library are, by its manual's table of errors), and to be exact in sign; bounds are moved by 4.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include <continuo/numerics/enclosure.hpp>

namespace continuo {

namespace enclosing {

inline constexpr int units = 4;

/// Of a function that grows.
template <class Real, class Function>
[[nodiscard]] Enclosure<Real> growing(const Enclosure<Real>& a, Function&& function) {
  return widened_by<units>(Real(function(a.lo)), Real(function(a.hi)));
}
/// Bounds that a function keeps everywhere.
template <class Real>
[[nodiscard]] Enclosure<Real> within(const Enclosure<Real>& a, Real least, Real greatest) {
  return {std::max(a.lo, least), std::min(a.hi, greatest)};
}
/// A function that grows between these bounds.
template <class Real, class Function>
[[nodiscard]] Enclosure<Real> growing_within(const Enclosure<Real>& a, Real least, Real greatest, Function&& function) {
  return a.is_entire() ? a : within(growing(a, function), least, greatest);
}
template <class Real>
[[nodiscard]] bool is_within(const Enclosure<Real>& a, Real least, Real greatest) {
  return a.lo >= least && a.hi <= greatest;
}

/// The whole numbers k with (k + shift) pi in an angle, up to its rounding: those that just miss it may be among them.
template <class Real>
struct HalfTurns {
  Real first, last;
  [[nodiscard]] bool none() const { return first > last; }
  [[nodiscard]] bool several() const { return first < last; }
  [[nodiscard]] bool one_is_even() const { return first == 2 * std::floor(first / 2); }
};

template <class Real>
[[nodiscard]] HalfTurns<Real> half_turns(const Enclosure<Real>& angle, Real shift) {
  const Real from = angle.lo * std::numbers::inv_pi_v<Real>, to = angle.hi * std::numbers::inv_pi_v<Real>;
  // A rounding each of 1/pi, of the product and of the sum, and as much again.
  const Real rounding = 4 * std::numeric_limits<Real>::epsilon() * (std::max(std::abs(from), std::abs(to)) + 1);
  return {std::ceil(from - shift - rounding), std::floor(to - shift + rounding)};
}

/// Of a wave that has its extremes at (k + shift) pi, 1 for even k and -1 for odd.
template <class Real, class Function>
[[nodiscard]] Enclosure<Real> wave(const Enclosure<Real>& angle, Real shift, Function&& function) {
  if (angle.is_entire()) return angle;
  const HalfTurns<Real> extremes = half_turns(angle, shift);
  if (extremes.several()) return {Real(-1), Real(1)};
  const Real first = function(angle.lo), last = function(angle.hi);
  Enclosure<Real> range = widened_by<units>(std::min(first, last), std::max(first, last));
  if (!extremes.none()) (extremes.one_is_even() ? range.hi : range.lo) = extremes.one_is_even() ? Real(1) : Real(-1);
  return within(range, Real(-1), Real(1));
}

}  // namespace enclosing

/// The range of the sine. In -1..1, unless the angle is entirely unknown.
template <class Real>
[[nodiscard]] Enclosure<Real> sin(const Enclosure<Real>& a) {
  return enclosing::wave(a, Real(0.5), [](Real x) { return std::sin(x); });
}
/// The range of the cosine. In -1..1, unless the angle is entirely unknown.
template <class Real>
[[nodiscard]] Enclosure<Real> cos(const Enclosure<Real>& a) {
  return enclosing::wave(a, Real(0), [](Real x) { return std::cos(x); });
}

/// Poles are at (k + 1/2) pi.
template <class Real>
[[nodiscard]] Enclosure<Real> tan(const Enclosure<Real>& a) {
  if (!a.is_bounded() || !enclosing::half_turns(a, Real(0.5)).none()) return Enclosure<Real>::entire();
  return enclosing::growing(a, [](Real x) { return std::tan(x); });
}

/// The range of the arc sine; the entire line where a reaches beyond -1..1.
template <class Real>
[[nodiscard]] Enclosure<Real> asin(const Enclosure<Real>& a) {
  if (!enclosing::is_within(a, Real(-1), Real(1))) return Enclosure<Real>::entire();
  return enclosing::growing(a, [](Real x) { return std::asin(x); });
}
/// The range of the arc cosine; the entire line where a reaches beyond -1..1.
template <class Real>
[[nodiscard]] Enclosure<Real> acos(const Enclosure<Real>& a) {
  if (!enclosing::is_within(a, Real(-1), Real(1))) return Enclosure<Real>::entire();
  return enclosing::growing(-a, [](Real x) { return std::acos(-x); });
}
/// The range of the arc tangent.
template <class Real>
[[nodiscard]] Enclosure<Real> atan(const Enclosure<Real>& a) {
  return enclosing::growing_within(a, Real(-2), Real(2), [](Real x) { return std::atan(x); });
}

/// The range of the absolute value; exact.
template <class Real>
[[nodiscard]] Enclosure<Real> abs(const Enclosure<Real>& a) {
  if (a.lo >= 0 || a.is_entire()) return a;
  if (a.hi <= 0) return -a;
  return {Real(0), a.magnitude()};
}

/// The range of a hyperbolic function.
/// @{
template <class Real>
[[nodiscard]] Enclosure<Real> sinh(const Enclosure<Real>& a) {
  return enclosing::growing(a, [](Real x) { return std::sinh(x); });
}
template <class Real>
[[nodiscard]] Enclosure<Real> cosh(const Enclosure<Real>& a) {
  return enclosing::growing_within(abs(a), Real(1), Enclosure<Real>::infinity, [](Real x) { return std::cosh(x); });
}
template <class Real>
[[nodiscard]] Enclosure<Real> tanh(const Enclosure<Real>& a) {
  return enclosing::growing_within(a, Real(-1), Real(1), [](Real x) { return std::tanh(x); });
}
/// @}

/// The range of the exponential, never below zero.
template <class Real>
[[nodiscard]] Enclosure<Real> exp(const Enclosure<Real>& a) {
  return enclosing::growing_within(a, Real(0), Enclosure<Real>::infinity, [](Real x) { return std::exp(x); });
}
/// The range of the natural logarithm; the entire line where a is not above zero.
template <class Real>
[[nodiscard]] Enclosure<Real> log(const Enclosure<Real>& a) {
  if (!(a.lo > 0)) return Enclosure<Real>::entire();
  return enclosing::growing(a, [](Real x) { return std::log(x); });
}
/// The range of the decimal logarithm; the entire line where a is not above zero.
template <class Real>
[[nodiscard]] Enclosure<Real> log10(const Enclosure<Real>& a) {
  if (!(a.lo > 0)) return Enclosure<Real>::entire();
  return enclosing::growing(a, [](Real x) { return std::log10(x); });
}

/// The range of the square root; the entire line where a reaches below zero. Of a single number with an exact root it
/// is that root.
template <class Real>
[[nodiscard]] Enclosure<Real> sqrt(const Enclosure<Real>& a) {
  if (!(a.lo >= 0)) return Enclosure<Real>::entire();
  const Real lo = std::sqrt(a.lo), hi = std::sqrt(a.hi);
  if (a.is_point() && enclosing::is_exact_product(lo, lo, a.lo)) return Enclosure<Real>(lo);
  return enclosing::widened(lo, hi);  // of zero it is zero
}

/// The range of sqrt(x^2 + y^2).
template <class Real>
[[nodiscard]] Enclosure<Real> hypot(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return sqrt(square(a) + square(b));
}

/// The range of the lesser, or of the greater, of two numbers; exact.
/// @{
template <class Real>
[[nodiscard]] Enclosure<Real> min(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  if (a.is_entire() || b.is_entire()) return Enclosure<Real>::entire();
  return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)};
}
template <class Real>
[[nodiscard]] Enclosure<Real> max(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  if (a.is_entire() || b.is_entire()) return Enclosure<Real>::entire();
  return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)};
}
/// @}

/// The range of the next whole number below, or above; exact.
/// @{
template <class Real>
[[nodiscard]] Enclosure<Real> floor(const Enclosure<Real>& a) {
  return {std::floor(a.lo), std::floor(a.hi)};
}
template <class Real>
[[nodiscard]] Enclosure<Real> ceil(const Enclosure<Real>& a) {
  return {std::ceil(a.lo), std::ceil(a.hi)};
}
/// @}
/// The range of the sign, -1, 0 or 1.
template <class Real>
[[nodiscard]] Enclosure<Real> sign(const Enclosure<Real>& a) {
  if (a.is_entire()) return a;
  const auto of = [](Real x) { return Real((x > 0) - (x < 0)); };
  return {of(a.lo), of(a.hi)};
}

namespace enclosing {

/// a - b*floor(a/b) where the integer is not decided: from 0 to b, or a rounding beyond.
template <class Real>
[[nodiscard]] Enclosure<Real> any_remainder(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  const Real rounding = units * std::numeric_limits<Real>::epsilon() * a.magnitude() + underflow<Real>;
  return bounded(std::min(b.lo, Real(0)) - rounding, std::max(b.hi, Real(0)) + rounding);
}

}  // namespace enclosing

/// a - b*floor(a/b): has the sign of b.
template <class Real>
[[nodiscard]] Enclosure<Real> mod(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  const Enclosure<Real> times = floor(a / b);
  return times.is_point() ? a - b * times : enclosing::any_remainder(a, b);
}

namespace enclosing {

/// x^n of a whole n for any x: even, odd, and with a pole at zero where n is negative.
template <class Real>
[[nodiscard]] Enclosure<Real> whole_power(const Enclosure<Real>& x, Real n) {
  if (n == 0) return Enclosure<Real>(Real(1));
  if (n < 0 && x.lo <= 0 && x.hi >= 0) return Enclosure<Real>::entire();
  if (x.is_entire()) return x;
  const bool is_even = std::fmod(n, Real(2)) == 0;
  const Enclosure<Real> base = is_even ? abs(x) : x;
  const Real first = std::pow(base.lo, n), last = std::pow(base.hi, n);
  const Enclosure<Real> range = widened_by<units>(std::min(first, last), std::max(first, last));
  return is_even ? within(range, Real(0), Enclosure<Real>::infinity) : range;
}

}  // namespace enclosing

/// Of a positive x it is monotone in x for every y and in y for every x: the extremes are at corners.
template <class Real>
[[nodiscard]] Enclosure<Real> pow(const Enclosure<Real>& x, const Enclosure<Real>& y) {
  if (y.is_point() && std::floor(y.lo) == y.lo) return enclosing::whole_power(x, y.lo);
  if (!(x.lo > 0 || (x.lo == 0 && y.lo > 0)) || !x.is_bounded() || !y.is_bounded()) return Enclosure<Real>::entire();
  const Real a = std::pow(x.lo, y.lo), b = std::pow(x.lo, y.hi), c = std::pow(x.hi, y.lo), d = std::pow(x.hi, y.hi);
  const auto range = enclosing::widened_by<enclosing::units>(std::min({a, b, c, d}), std::max({a, b, c, d}));
  return {std::max(range.lo, Real(0)), range.hi};
}

/// The angle of (x, y). It jumps from -pi to pi where y changes its sign at a negative x; elsewhere the extremes of the
/// angle of a rectangle are at its corners.
template <class Real>
[[nodiscard]] bool is_angle_continuous(const Enclosure<Real>& y, const Enclosure<Real>& x) {
  return x.lo > 0 || y.lo > 0 || y.hi < 0;
}
/// The range of the angle of (x, y), in -pi..pi up to rounding.
template <class Real>
[[nodiscard]] Enclosure<Real> atan2(const Enclosure<Real>& y, const Enclosure<Real>& x) {
  if (y.is_entire() || x.is_entire()) return Enclosure<Real>::entire();
  constexpr Real pi = std::numbers::pi_v<Real>;
  const Enclosure<Real> circle = enclosing::widened_by<enclosing::units>(-pi, pi);
  if (!is_angle_continuous(y, x) || !x.is_bounded() || !y.is_bounded()) return circle;
  const Real a = std::atan2(y.lo, x.lo), b = std::atan2(y.lo, x.hi), c = std::atan2(y.hi, x.lo),
             d = std::atan2(y.hi, x.hi);
  return enclosing::widened_by<enclosing::units>(std::min({a, b, c, d}), std::max({a, b, c, d}));
}

}  // namespace continuo
