// continuo/numerics/enclosure.hpp
// Arithmetic on intervals: whatever numbers the operands hold, their sum, product, ... lies in the result.
//
//   const Enclosure<double> x{1, 2}, y{-1, 3};
//   const auto z = x * y - Enclosure(0.5);      // holds every x*y - 0.5: a little more than [-2.5, 5.5]
//   if (z.lo > 0) ...                           // positive, proved
//   (x < y).may_hold, (x < y).may_fail          // both: it depends on the numbers
//
// Bounds are computed in the usual rounding and then moved outwards, which is many times faster than to change the
// mode of rounding. Let r be the rounded and v the exact bound. Both are within half a unit in the last place of r, and
// r - ulp(r) is a number of the format, at least r - |r|*epsilon. As rounding keeps the order,
// round(r - round(|r|*epsilon)) <= r - ulp(r) <= v. The product |r|*epsilon never gets below the smallest unit. A sum
// has no underflow, being exact there; products and quotients are moved by `underflow` besides. The same holds for the
// rounded result of every pair of numbers in the operands, because rounding keeps the order: what a program computes
// with the same operations is enclosed too.
//
// What is undefined somewhere (a division by what may be zero, a logarithm of what may be negative) or not a number is
// the entire line, and so is every function of the entire line, even one that is bounded: no comparison with it decides
// anything, as none with NaN holds. An operation on single numbers that is exact remains a single number: counters stay
// whole.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

namespace continuo {

/// What a comparison of enclosures says: one of both at least.
struct Decision {
  bool may_hold, may_fail;
  /// The decision of the opposite comparison.
  friend Decision operator!(Decision a) { return {a.may_fail, a.may_hold}; }
};

/// All numbers from lo to hi, both included unless infinite. Neither is ever NaN.
template <class Real>
struct Enclosure {
  static constexpr Real infinity = std::numeric_limits<Real>::infinity();

  Real lo{}, hi{};

  /// The number zero.
  Enclosure() = default;
  /// A single number; the entire line where it is not finite.
  explicit Enclosure(Real value) : Enclosure(value, value) {
    if (!std::isfinite(value)) *this = entire();
  }
  /// The numbers between two bounds, from <= to.
  Enclosure(Real from, Real to) : lo(from), hi(to) {}
  /// All numbers: nothing is known.
  static Enclosure entire() { return {-infinity, infinity}; }

  /// Whether it is a single number.
  bool is_point() const { return !(lo < hi); }
  /// Whether nothing is known: both bounds are infinite.
  bool is_entire() const { return !(lo > -infinity || hi < infinity); }
  /// Whether both bounds are finite.
  bool is_bounded() const { return lo > -infinity && hi < infinity; }
  /// Whether a number is in it.
  bool holds(Real value) const { return lo <= value && value <= hi; }
  /// The greatest absolute value.
  Real magnitude() const { return std::max(std::abs(lo), std::abs(hi)); }
};

/// Absolute error of products and quotients near zero, generously: so far above the smallest normal number that no
/// product with it is slow for being denormal, and so far below all that is computed with that nobody sees it.
template <class Real>
inline constexpr Real underflow =
    std::numeric_limits<Real>::min() / (std::numeric_limits<Real>::epsilon() * std::numeric_limits<Real>::epsilon());

namespace enclosing {

/// What overflowed or became NaN is unbounded. Rare, and therefore kept apart.
template <class Real>
[[gnu::noinline, gnu::cold]] Enclosure<Real> unbounded(Real lo, Real hi) {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  return {lo > -infinity ? lo : -infinity, hi < infinity ? hi : infinity};
}
template <class Real>
[[gnu::always_inline]] inline Enclosure<Real> bounded(Real lo, Real hi) {
  if (hi - lo < std::numeric_limits<Real>::infinity()) [[likely]]
    return {lo, hi};
  return unbounded(lo, hi);
}

/// Bounds of sums, rounded by half a unit at most.
template <class Real>
[[gnu::always_inline]] inline Enclosure<Real> widened(Real lo, Real hi) {
  constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
  return bounded(lo - std::abs(lo) * epsilon, hi + std::abs(hi) * epsilon);
}

/// Bounds with an error of `units` in the last place, and with underflow.
template <int units = 1, class Real>
[[gnu::always_inline]] inline Enclosure<Real> widened_by(Real lo, Real hi) {
  constexpr Real part = units * std::numeric_limits<Real>::epsilon();
  return bounded(lo - (std::abs(lo) * part + underflow<Real>), hi + (std::abs(hi) * part + underflow<Real>));
}

/// The least of four quotients or products to the greatest. One of them is NaN for 0*infinity: then, and for
/// -infinity beside infinity, the sum is.
template <class Real>
[[gnu::always_inline]] inline Enclosure<Real> from_corners(Real a, Real b, Real c, Real d) {
  const Real sum = (a + b) + (c + d);
  if (sum != sum) [[unlikely]]
    return Enclosure<Real>::entire();
  return widened_by(std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d)));
}

/// The error of sum = a + b, exactly. D. E. Knuth, The Art of Computer Programming II, 4.2.2, theorem B.
template <class Real>
Real error_of_sum(Real a, Real b, Real sum) {
  const Real b_there = sum - a;
  return (a - (sum - b_there)) + (b - b_there);
}

/// Far enough from underflow for the error of a product to be a number of the format.
template <class Real>
bool is_exact_product(Real a, Real b, Real product) {
  return product == 0 ? a == 0 || b == 0 : std::abs(product) > underflow<Real> && std::fma(a, b, -product) == 0;
}

// Single numbers are rare: kept apart, so that the code for intervals is short enough to be put in place.
template <class Real>
[[gnu::noinline, gnu::cold]] Enclosure<Real> sum_of_numbers(Real a, Real b) {
  const Real sum = a + b;
  return error_of_sum(a, b, sum) == 0 ? Enclosure<Real>(sum) : widened(sum, sum);
}
template <class Real>
[[gnu::noinline, gnu::cold]] Enclosure<Real> product_of_numbers(Real a, Real b) {
  const Real product = a * b;
  return is_exact_product(a, b, product) ? Enclosure<Real>(product) : widened_by(product, product);
}
template <class Real>
[[gnu::noinline, gnu::cold]] Enclosure<Real> quotient_of_numbers(Real a, Real b) {
  const Real quotient = a / b;
  return is_exact_product(quotient, b, a) ? Enclosure<Real>(quotient) : widened_by(quotient, quotient);
}
template <class Real>
bool are_numbers(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return a.is_point() && b.is_point();
}

}  // namespace enclosing

/// Everything in a or in b.
template <class Real>
Enclosure<Real> hull(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

/// What is in both; for two enclosures of the same number, which therefore have one in common.
template <class Real>
Enclosure<Real> intersection(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

/// The negatives of all numbers in a; exact.
template <class Real>
Enclosure<Real> operator-(const Enclosure<Real>& a) {
  return {-a.hi, -a.lo};
}

// Sums and products are put in place: a call takes a fifth of their time (measured).
/// Contains the sum of any number in a and any number in b.
template <class Real>
[[gnu::always_inline]] inline Enclosure<Real> operator+(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  if (enclosing::are_numbers(a, b)) [[unlikely]]
    return enclosing::sum_of_numbers(a.lo, b.lo);
  return enclosing::widened(a.lo + b.lo, a.hi + b.hi);
}

/// Contains the difference of any number in a and any number in b.
template <class Real>
[[gnu::always_inline]] inline Enclosure<Real> operator-(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return a + -b;
}

/// Contains the squares of all numbers in a, and none below zero.
template <class Real>
[[gnu::always_inline]] inline Enclosure<Real> square(const Enclosure<Real>& a) {
  if (a.is_entire()) return a;
  if (a.is_point()) [[unlikely]]
    return enclosing::product_of_numbers(a.lo, a.lo);
  const Real lo = a.lo * a.lo, hi = a.hi * a.hi;
  const bool around_zero = a.lo <= 0 && a.hi >= 0;
  const Enclosure<Real> bounds = enclosing::widened_by(around_zero ? Real(0) : std::min(lo, hi), std::max(lo, hi));
  return {std::max(bounds.lo, Real(0)), bounds.hi};
}

/// One object times itself is a square, which has no negative numbers.
template <class Real>
[[gnu::always_inline]] inline Enclosure<Real> operator*(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  if (&a == &b) return square(a);
  if (enclosing::are_numbers(a, b)) [[unlikely]]
    return enclosing::product_of_numbers(a.lo, b.lo);
  return enclosing::from_corners(a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi);
}

/// Contains the quotient of any number in a and any number in b; the entire line where b contains zero.
template <class Real>
Enclosure<Real> operator/(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  if (b.lo <= 0 && b.hi >= 0) return Enclosure<Real>::entire();
  if (enclosing::are_numbers(a, b)) [[unlikely]]
    return enclosing::quotient_of_numbers(a.lo, b.lo);
  return enclosing::from_corners(a.lo / b.lo, a.lo / b.hi, a.hi / b.lo, a.hi / b.hi);
}

/// Whether the comparison may hold, and may fail, for numbers of a and b.
/// @{
template <class Real>
Decision operator<(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return {a.lo < b.hi, a.hi >= b.lo};
}
template <class Real>
Decision operator<=(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return {a.lo <= b.hi, a.hi > b.lo};
}
template <class Real>
Decision operator>(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return b < a;
}
template <class Real>
Decision operator>=(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return b <= a;
}
template <class Real>
Decision operator==(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return {a.lo <= b.hi && b.lo <= a.hi, !(a.is_point() && b.is_point() && a.lo == b.lo)};
}
template <class Real>
Decision operator!=(const Enclosure<Real>& a, const Enclosure<Real>& b) {
  return !(a == b);
}
/// @}

/// `yes` where the condition holds, otherwise `no`; both, where it is not decided.
template <class Real>
Enclosure<Real> select(Decision condition, const Enclosure<Real>& yes, const Enclosure<Real>& no) {
  if (!condition.may_fail) return yes;
  return condition.may_hold ? hull(yes, no) : no;
}

}  // namespace continuo
