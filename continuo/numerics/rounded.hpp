// A number with a bound of its rounding: what was meant lies within value - rounding and value + rounding.
//
//   const Rounded<double> x(0.1, 1e-17), y(3);   // 3 is exact
//   const auto z = x * y - 0.3;                  // value 5.55e-17, rounding 5.78e-17: it may be zero
//   z > 0;                                       // Truth::undecided
//
// Midpoint and radius: F. Johansson, "Arb: efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE
// Trans. Comput. 66 (2017). Of sums and products, quotients and roots the error of the operation itself is known
// without rounding (T. Ogita, S. M. Rump, S. Oishi, "Accurate sum and dot product", SIAM J. Sci. Comput. 26 (2005),
// algorithms 3.1 and 3.3), so what is computed exactly has rounding 0. The bound is of first order: the roundings of
// the bounds themselves, underflow, and the squares of roundings in the functions below are left out. Who builds on it
// adds a margin.
#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

namespace continuo {

/// Of a comparison whose sides are not known exactly.
enum class Truth { no, yes, undecided };

/// Whether it holds, without doubt.
[[nodiscard]] constexpr bool certainly(bool truth) {
  return truth;
}
[[nodiscard]] constexpr bool certainly(Truth truth) {
  return truth == Truth::yes;
}
/// The opposite; undecided stays undecided.
constexpr Truth operator!(Truth truth) {
  if (truth == Truth::undecided) return truth;
  return truth == Truth::yes ? Truth::no : Truth::yes;
}

/// A number with a bound of its rounding.
template <std::floating_point Real>
struct Rounded {
  Real value{}, rounding{};

  /// Zero, exactly.
  constexpr Rounded() = default;
  /// A number; exact unless a rounding is given.
  constexpr Rounded(Real value_, Real rounding_ = 0) : value(value_), rounding(rounding_) {}
  /// A number of which nothing is known.
  [[nodiscard]] static constexpr Rounded anything() {
    return {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()};
  }

  /// Whether it is zero without rounding.
  [[nodiscard]] constexpr bool is_exactly_zero() const { return value == 0 && rounding == 0; }
  /// Whether it has a bounded rounding and a value.
  [[nodiscard]] bool is_known() const { return rounding < std::numeric_limits<Real>::infinity() && !std::isnan(value); }

  /// The negative.
  friend Rounded operator-(const Rounded& a) { return {-a.value, a.rounding}; }
  /// The sum, with its rounding.
  friend Rounded operator+(const Rounded& a, const Rounded& b) {
    const Real sum = a.value + b.value, shadow = sum - a.value;
    const Real error = (a.value - (sum - shadow)) + (b.value - shadow);
    // A growth without bound (of a root at zero) outweighs every number.
    if (std::isinf(sum) && (std::isinf(a.value) || std::isinf(b.value))) return {sum, a.rounding + b.rounding};
    return known(sum, a.rounding + b.rounding + std::abs(error));
  }
  /// The difference, with its rounding.
  friend Rounded operator-(const Rounded& a, const Rounded& b) { return a + -b; }
  /// Zero times whatever there is, is zero.
  friend Rounded operator*(const Rounded& a, const Rounded& b) {
    if (a.is_exactly_zero() || b.is_exactly_zero()) return {};
    const Real product = a.value * b.value;
    if (std::isinf(a.value) || std::isinf(b.value)) return a.has_sign() && b.has_sign() ? product : anything();
    return known(product, std::abs(a.value) * b.rounding + std::abs(b.value) * a.rounding + a.rounding * b.rounding +
                              std::abs(std::fma(a.value, b.value, -product)));
  }
  /// The quotient, with its rounding; anything where b may be zero.
  friend Rounded operator/(const Rounded& a, const Rounded& b) {
    if (!b.has_sign()) return anything();
    if (a.is_exactly_zero()) return {};
    const Real quotient = a.value / b.value, rest = std::fma(-quotient, b.value, a.value);
    return known(quotient,
                 (std::abs(rest) + a.rounding + std::abs(quotient) * b.rounding) / (std::abs(b.value) - b.rounding));
  }

  /// Equal numbers count as equal, however they are rounded: so a tie is a tie.
  friend Truth operator==(const Rounded& a, const Rounded& b) {
    if (a.value == b.value && a.is_known() && b.is_known()) return Truth::yes;
    return std::abs(a.value - b.value) > a.rounding + b.rounding ? Truth::no : Truth::undecided;
  }
  /// Comparisons, decided where the numbers differ by more than their roundings.
  /// @{
  friend Truth operator!=(const Rounded& a, const Rounded& b) { return !(a == b); }
  friend Truth operator<(const Rounded& a, const Rounded& b) {
    const Truth same = a == b;
    if (same != Truth::no) return !same;
    return a.value < b.value ? Truth::yes : Truth::no;
  }
  friend Truth operator>(const Rounded& a, const Rounded& b) { return b < a; }
  friend Truth operator<=(const Rounded& a, const Rounded& b) { return !(b < a); }
  friend Truth operator>=(const Rounded& a, const Rounded& b) { return !(a < b); }
  /// @}

  /// One of the two, it is not known which. Two that differ by more than their roundings, and in sign, are anything:
  /// the middle of them would pass for a zero.
  friend Rounded hull(const Rounded& a, const Rounded& b) {
    const Real apart = std::abs(a.value - b.value);
    if (apart <= a.rounding + b.rounding) return known(a.value, std::max(a.rounding, apart + b.rounding));
    if (!a.has_sign() || !b.has_sign() || (a.value > 0) != (b.value > 0)) return anything();
    const Real low = std::min(a.value - a.rounding, b.value - b.rounding);
    const Real high = std::max(a.value + a.rounding, b.value + b.rounding);
    return known(low / 2 + high / 2, high / 2 - low / 2);
  }

  /// The square root. Its rounding stays bounded at zero.
  friend Rounded sqrt(const Rounded& a) {
    const Real root = std::sqrt(a.value);
    if (a.value <= a.rounding) return known(root, std::sqrt(a.value + a.rounding));
    const Real rest = std::abs(std::fma(-root, root, a.value));
    return known(root, (rest + a.rounding) / (root + std::sqrt(a.value - a.rounding)));
  }
  /// The whole number below the value; exact, since the rounding of a is ignored.
  friend Rounded floor(const Rounded& a) { return std::floor(a.value); }

  // Functions of the standard library, by their slopes.
  /// Functions of the standard library, whose rounding follows from their slopes.
  /// @{
  friend Rounded sin(const Rounded& a) { return function(std::sin(a.value), std::cos(a.value), a); }
  friend Rounded cos(const Rounded& a) { return function(std::cos(a.value), std::sin(a.value), a); }
  friend Rounded asin(const Rounded& a) {
    return function(std::asin(a.value), 1 / std::sqrt((1 - a.value) * (1 + a.value)), a);
  }
  friend Rounded acos(const Rounded& a) {
    return function(std::acos(a.value), 1 / std::sqrt((1 - a.value) * (1 + a.value)), a);
  }
  friend Rounded atan(const Rounded& a) { return function(std::atan(a.value), 1 / (1 + a.value * a.value), a); }
  friend Rounded sinh(const Rounded& a) { return function(std::sinh(a.value), std::cosh(a.value), a); }
  friend Rounded cosh(const Rounded& a) { return function(std::cosh(a.value), std::sinh(a.value), a); }
  friend Rounded tanh(const Rounded& a) {
    const Real y = std::tanh(a.value);
    return function(y, (1 - y) * (1 + y), a);
  }
  /// @}
  /// Exponential and logarithms.
  /// @{
  friend Rounded exp(const Rounded& a) { return function(std::exp(a.value), std::exp(a.value), a); }
  friend Rounded log(const Rounded& a) { return function(std::log(a.value), 1 / a.value, a); }
  friend Rounded log10(const Rounded& a) {
    return function(std::log10(a.value), 1 / (std::numbers::ln10_v<Real> * a.value), a);
  }
  /// @}
  /// a^b.
  friend Rounded pow(const Rounded& a, const Rounded& b) {
    const Real power = std::pow(a.value, b.value);
    Real bound = library(power);
    if (a.rounding > 0) bound += std::abs(b.value * std::pow(a.value, b.value - 1)) * a.rounding;
    if (b.rounding > 0) bound += std::abs(std::log(a.value) * power) * b.rounding;
    return known(power, bound);
  }
  /// The angle of (x, y). Near the negative x axis its rounding contains a whole turn.
  friend Rounded atan2(const Rounded& y, const Rounded& x) {
    const Real angle = std::atan2(y.value, x.value);
    if (y.value == 0 && y.rounding == 0) return known(angle, x.has_sign() ? library(angle) : anything().rounding);
    const Real square = x.value * x.value + y.value * y.value;
    Real bound = library(angle) + (std::abs(x.value) * y.rounding + std::abs(y.value) * x.rounding) / square;
    if (x.value < 0 && y.value != 0 && std::abs(y.value) <= y.rounding) bound += 2 * std::numbers::pi_v<Real>;
    return known(angle, bound);
  }

 private:
  bool has_sign() const { return std::abs(value) > rounding; }
  static Rounded known(Real value, Real rounding) {
    return rounding < std::numeric_limits<Real>::infinity() ? Rounded{value, rounding} : anything();
  }
  /// The functions of the usual libraries are off by less than two units in the last place.
  static Real library(Real value) { return 2 * std::numeric_limits<Real>::epsilon() * std::abs(value); }
  static Rounded function(Real value, Real slope, const Rounded& a) {
    return known(value, library(value) + (a.rounding > 0 ? std::abs(slope) * a.rounding : 0));
  }
};

}  // namespace continuo
