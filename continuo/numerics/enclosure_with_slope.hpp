// continuo/numerics/enclosure_with_slope.hpp
// A function of one variable theta over an interval: where its values lie, and how steep it is.
//
//   const EnclosureWithSlope<double> theta{{0, 1}, Enclosure(1.0)};   // the variable itself
//   const auto f = exp(theta) - EnclosureWithSlope(4.0);               // slope.lo > 0: it grows, proved
//
// The promise: f(a) is in `value` for every a of the interval, and f(a) - f(b) is in slope*(a - b) for every two of
// them. A kink needs no care then: differences of min(f, g) lie between those of f and of g. Products keep the promise
// as f(a) g(a) - f(b) g(b) = f(a)(g(a) - g(b)) + g(b)(f(a) - f(b)), smooth functions by the mean value theorem. What
// may jump (a condition that is not decided between branches of any kind, sign, floor) has the entire line as slope.
#pragma once
#include <continuo/numerics/enclosure.hpp>
#include <continuo/numerics/enclosure_functions.hpp>

namespace continuo {

/// The range of a function over an interval, and the range of its difference quotients.
template <class Real>
struct EnclosureWithSlope {
  Enclosure<Real> value, slope;

  /// Zero.
  EnclosureWithSlope() = default;
  /// A constant.
  explicit EnclosureWithSlope(Real number) : value(number) {}
  /// A function with these values and these difference quotients.
  EnclosureWithSlope(const Enclosure<Real>& values, const Enclosure<Real>& slopes) : value(values), slope(slopes) {}

  /// Whether it is a constant.
  bool is_steady() const { return slope.lo == 0 && slope.hi == 0; }
};

namespace enclosing {

template <class Real>
Enclosure<Real> one() {
  return Enclosure<Real>(Real(1));
}

/// A factor times the slope of a, which is zero for what does not move, such as a parameter, whatever the factor.
template <class Real>
Enclosure<Real> times_slope(const Enclosure<Real>& factor, const EnclosureWithSlope<Real>& a) {
  if (a.is_steady()) return {};
  return factor * a.slope;
}

}  // namespace enclosing

/// Negative, sum and difference of functions.
/// @{
template <class Real>
EnclosureWithSlope<Real> operator-(const EnclosureWithSlope<Real>& a) {
  return {-a.value, -a.slope};
}
template <class Real>
EnclosureWithSlope<Real> operator+(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  return {a.value + b.value, a.slope + b.slope};
}
template <class Real>
EnclosureWithSlope<Real> operator-(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  return {a.value - b.value, a.slope - b.slope};
}
/// @}
/// The square of a function.
template <class Real>
EnclosureWithSlope<Real> square(const EnclosureWithSlope<Real>& a) {
  return {square(a.value), enclosing::times_slope(a.value + a.value, a)};
}
/// The product of two functions; of one object with itself the square.
template <class Real>
EnclosureWithSlope<Real> operator*(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  if (&a == &b) return square(a);
  return {a.value * b.value, enclosing::times_slope(b.value, a) + enclosing::times_slope(a.value, b)};
}
/// (a/b)' = (a' - (a/b) b')/b
template <class Real>
EnclosureWithSlope<Real> operator/(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  const Enclosure<Real> quotient = a.value / b.value;
  return {quotient, (a.slope - enclosing::times_slope(quotient, b)) / b.value};
}

/// Whether the comparison may hold, and may fail, somewhere in the interval.
/// @{
template <class Real>
Decision operator<(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  return a.value < b.value;
}
template <class Real>
Decision operator<=(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  return a.value <= b.value;
}
template <class Real>
Decision operator==(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  return a.value == b.value;
}
template <class Real>
Decision operator!=(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  return a.value != b.value;
}
/// @}

/// Where the condition is not decided the function may jump, unless both are the same number.
template <class Real>
EnclosureWithSlope<Real> select(Decision condition, const EnclosureWithSlope<Real>& yes,
                                const EnclosureWithSlope<Real>& no) {
  if (!condition.may_fail) return yes;
  if (!condition.may_hold) return no;
  const Enclosure<Real> value = hull(yes.value, no.value);
  return {value, value.is_point() ? Enclosure<Real>() : Enclosure<Real>::entire()};
}

/// The lesser, the greater, or the absolute value of functions. At a kink the slope contains those of both sides.
/// @{
template <class Real>
EnclosureWithSlope<Real> min(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  if (a.value.hi <= b.value.lo) return a;
  if (b.value.hi <= a.value.lo) return b;
  return {min(a.value, b.value), hull(a.slope, b.slope)};
}
template <class Real>
EnclosureWithSlope<Real> max(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  if (a.value.lo >= b.value.hi) return a;
  if (b.value.lo >= a.value.hi) return b;
  return {max(a.value, b.value), hull(a.slope, b.slope)};
}
template <class Real>
EnclosureWithSlope<Real> abs(const EnclosureWithSlope<Real>& a) {
  if (a.value.lo >= 0) return a;
  if (a.value.hi <= 0) return -a;
  return {abs(a.value), hull(a.slope, -a.slope)};
}
/// @}

namespace enclosing {

/// A function that is constant between jumps, of which this is the range.
template <class Real>
EnclosureWithSlope<Real> with_jumps(const Enclosure<Real>& range) {
  return {range, range.is_point() ? Enclosure<Real>() : Enclosure<Real>::entire()};
}

}  // namespace enclosing

/// Functions that jump: the slope is zero where the value is a single number, else the entire line.
/// @{
template <class Real>
EnclosureWithSlope<Real> floor(const EnclosureWithSlope<Real>& a) {
  return enclosing::with_jumps(floor(a.value));
}
template <class Real>
EnclosureWithSlope<Real> ceil(const EnclosureWithSlope<Real>& a) {
  return enclosing::with_jumps(ceil(a.value));
}
template <class Real>
EnclosureWithSlope<Real> sign(const EnclosureWithSlope<Real>& a) {
  return enclosing::with_jumps(sign(a.value));
}
/// @}
/// a - b*floor(a/b), which has the sign of b. Where the quotient may pass a whole number, the slope is the entire line.
template <class Real>
EnclosureWithSlope<Real> mod(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  const EnclosureWithSlope<Real> times = floor(a / b);
  if (times.value.is_point()) return a - b * times;
  return {enclosing::any_remainder(a.value, b.value), Enclosure<Real>::entire()};
}

namespace enclosing {

/// 1/(2 root), the slope of a root: from zero on unbounded, but not negative.
template <class Real>
Enclosure<Real> slope_of_root(const Enclosure<Real>& root) {
  if (root.lo > 0 || !(root.lo == 0 && root.hi > 0)) return one<Real>() / (root + root);
  const Enclosure<Real> greatest(root.hi);
  return {(one<Real>() / (greatest + greatest)).lo, Enclosure<Real>::infinity};
}

}  // namespace enclosing

/// The square root. Its slope is unbounded where a reaches zero.
template <class Real>
EnclosureWithSlope<Real> sqrt(const EnclosureWithSlope<Real>& a) {
  const Enclosure<Real> root = sqrt(a.value);
  return {root, enclosing::times_slope(enclosing::slope_of_root(root), a)};
}
/// sqrt(a^2 + b^2).
template <class Real>
EnclosureWithSlope<Real> hypot(const EnclosureWithSlope<Real>& a, const EnclosureWithSlope<Real>& b) {
  return sqrt(square(a) + square(b));
}
/// Elementary functions, each with its derivative.
/// @{
template <class Real>
EnclosureWithSlope<Real> exp(const EnclosureWithSlope<Real>& a) {
  const Enclosure<Real> range = exp(a.value);
  return {range, enclosing::times_slope(range, a)};
}
template <class Real>
EnclosureWithSlope<Real> log(const EnclosureWithSlope<Real>& a) {
  const Enclosure<Real> range = log(a.value);
  return {range, range.is_bounded() ? a.slope / a.value : Enclosure<Real>::entire()};
}
template <class Real>
EnclosureWithSlope<Real> log10(const EnclosureWithSlope<Real>& a) {
  const Enclosure<Real> ten = log(Enclosure<Real>(Real(10)));
  return {log10(a.value), log(a).slope / ten};
}
template <class Real>
EnclosureWithSlope<Real> sin(const EnclosureWithSlope<Real>& a) {
  return {sin(a.value), enclosing::times_slope(cos(a.value), a)};
}
template <class Real>
EnclosureWithSlope<Real> cos(const EnclosureWithSlope<Real>& a) {
  return {cos(a.value), enclosing::times_slope(-sin(a.value), a)};
}
template <class Real>
EnclosureWithSlope<Real> tan(const EnclosureWithSlope<Real>& a) {
  const Enclosure<Real> range = tan(a.value);
  return {range, range.is_bounded() ? enclosing::times_slope(enclosing::one<Real>() + square(range), a) : range};
}
/// @}

namespace enclosing {

/// 1/sqrt(1 - x^2), the slope of asin.
template <class Real>
Enclosure<Real> slope_of_arc(const Enclosure<Real>& x) {
  return one<Real>() / sqrt((one<Real>() - x) * (one<Real>() + x));
}

}  // namespace enclosing

/// Inverse trigonometric and hyperbolic functions, each with its derivative.
/// @{
template <class Real>
EnclosureWithSlope<Real> asin(const EnclosureWithSlope<Real>& a) {
  return {asin(a.value), enclosing::times_slope(enclosing::slope_of_arc(a.value), a)};
}
template <class Real>
EnclosureWithSlope<Real> acos(const EnclosureWithSlope<Real>& a) {
  return {acos(a.value), enclosing::times_slope(-enclosing::slope_of_arc(a.value), a)};
}
template <class Real>
EnclosureWithSlope<Real> atan(const EnclosureWithSlope<Real>& a) {
  return {atan(a.value), a.slope / (enclosing::one<Real>() + square(a.value))};
}
template <class Real>
EnclosureWithSlope<Real> sinh(const EnclosureWithSlope<Real>& a) {
  return {sinh(a.value), enclosing::times_slope(cosh(a.value), a)};
}
template <class Real>
EnclosureWithSlope<Real> cosh(const EnclosureWithSlope<Real>& a) {
  return {cosh(a.value), enclosing::times_slope(sinh(a.value), a)};
}
template <class Real>
EnclosureWithSlope<Real> tanh(const EnclosureWithSlope<Real>& a) {
  const Enclosure<Real> range = tanh(a.value);
  const Enclosure<Real> rest = enclosing::one<Real>() - square(range);
  return {range, enclosing::times_slope(enclosing::within(rest, Real(0), Real(1)), a)};
}
/// @}

/// (x^y)' = y x^(y - 1) x' + x^y log(x) y', the last only where the exponent moves.
template <class Real>
EnclosureWithSlope<Real> pow(const EnclosureWithSlope<Real>& x, const EnclosureWithSlope<Real>& y) {
  const Enclosure<Real> range = pow(x.value, y.value);
  const Enclosure<Real> by_base = y.value * pow(x.value, y.value - enclosing::one<Real>());
  const Enclosure<Real> slope = enclosing::times_slope(by_base, x);
  if (y.is_steady()) return {range, slope};
  return {range, slope + enclosing::times_slope(range * log(x.value), y)};
}

/// atan2(y, x)' = (x y' - y x')/(x^2 + y^2) where it does not jump.
template <class Real>
EnclosureWithSlope<Real> atan2(const EnclosureWithSlope<Real>& y, const EnclosureWithSlope<Real>& x) {
  const Enclosure<Real> angle = atan2(y.value, x.value);
  if (!is_angle_continuous(y.value, x.value)) return {angle, Enclosure<Real>::entire()};
  const Enclosure<Real> turned = enclosing::times_slope(x.value, y) - enclosing::times_slope(y.value, x);
  return {angle, turned / (square(x.value) + square(y.value))};
}

}  // namespace continuo
