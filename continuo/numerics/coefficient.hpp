// continuo/numerics/coefficient.hpp
// A constant of a method, known to some 46 digits at compile time and rounded once, to the scalar that uses it:
//
//   constexpr Coefficient third = 1_c / 3;
//   constexpr Coefficient c4 = 0.9800255409045096857298102862870245954942137979563_c;
//   constexpr double a = third.as<double>();            // the double nearest to 1/3
//   constexpr long double b = third.as<long double>();  // the long double nearest to 1/3
//
// The value is an unevaluated sum of three doubles, each at most half a unit in the last place of the one before.
// Arithmetic on such sums: Y. Hida, X. S. Li, D. H. Bailey, "Algorithms for quad-double precision floating point
// arithmetic", ARITH-15 (2001); the summation is SumK of T. Ogita, S. M. Rump, S. Oishi, "Accurate sum and dot
// product", SIAM J. Sci. Comput. 26 (2005).
#pragma once
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace continuo {

/// An unevaluated sum of three doubles: a constant with some 46 digits, and arithmetic on it at compile time.
class Coefficient {
 public:
  constexpr Coefficient() = default;

  /// An integer, exactly: its halves of 32 bits are doubles.
  template <std::integral Integer>
  constexpr Coefficient(Integer n) {
    const bool negative = n < 0;
    const auto size = negative ? 0 - static_cast<std::uint64_t>(n) : static_cast<std::uint64_t>(n);
    *this = distil({4294967296.0 * static_cast<double>(size >> 32), static_cast<double>(size & 0xffffffffU)}, 2);
    if (negative) *this = -*this;
  }

  /// The value in the scalar type asked for: rounded once for float, double and long double, all the digits there are
  /// for wider types, a constant (no derivative, equal lanes) for dual numbers and lanes.
  template <class Real>
  [[nodiscard]] constexpr Real as() const {
    if constexpr (std::is_same_v<Real, double>) {
      return nearest();
    } else if constexpr (std::is_same_v<Real, float>) {
      return static_cast<float>(nearest());
    } else {
      return Real(part_[0]) + (Real(part_[1]) + Real(part_[2]));
    }
  }

  /// Sums, differences and products, with the last of the 46 digits rounded.
  /// @{
  friend constexpr Coefficient operator-(const Coefficient& a) {
    return Coefficient(-a.part_[0], -a.part_[1], -a.part_[2]);
  }
  friend constexpr Coefficient operator+(const Coefficient& a, const Coefficient& b) {
    return distil({a.part_[0], b.part_[0], a.part_[1], b.part_[1], a.part_[2], b.part_[2]}, 6);
  }
  friend constexpr Coefficient operator-(const Coefficient& a, const Coefficient& b) { return a + -b; }
  friend constexpr Coefficient operator*(const Coefficient& a, const Coefficient& b) {
    if (b.is_double()) return a.times(b.part_[0]);
    const Exact p = product(a.part_[0], b.part_[0]);
    const Exact q = product(a.part_[0], b.part_[1]);
    const Exact r = product(a.part_[1], b.part_[0]);
    const double low = a.part_[0] * b.part_[2] + a.part_[1] * b.part_[1] + a.part_[2] * b.part_[0];
    return distil({p.value, q.value, r.value, p.error, q.error, r.error, low}, 7);
  }
  /// @}
  /// Long division: each quotient removes some 53 bits of what is left.
  friend constexpr Coefficient operator/(const Coefficient& a, const Coefficient& b) {
    const double first = a.part_[0] / b.part_[0];
    const Coefficient rest = a - b.times(first);
    const double second = rest.part_[0] / b.part_[0];
    const Coefficient rest2 = rest - b.times(second);
    const double third = rest2.part_[0] / b.part_[0];
    return distil({first, second, third}, 3);
  }

  /// Adds or subtracts in place.
  /// @{
  constexpr Coefficient& operator+=(const Coefficient& b) { return *this = *this + b; }
  constexpr Coefficient& operator-=(const Coefficient& b) { return *this = *this - b; }
  /// @}

  friend constexpr bool operator==(const Coefficient&, const Coefficient&) = default;
  /// Whether it is exactly zero.
  [[nodiscard]] constexpr bool is_zero() const { return part_[0] == 0; }

 private:
  double part_[3] = {0, 0, 0};

  constexpr Coefficient(double high, double middle, double low) : part_{high, middle, low} {}

  struct Exact {  // value + error, without rounding
    double value, error;
  };

  [[nodiscard]] static constexpr Exact sum(double a, double b) {  // Knuth
    const double value = a + b;
    const double shadow = value - a;
    return {value, (a - (value - shadow)) + (b - shadow)};
  }

  [[nodiscard]] static constexpr Exact product(double a, double b) {
    const double value = a * b;
    if (!std::is_constant_evaluated()) return {value, std::fma(a, b, -value)};
    const Exact x = halves(a), y = halves(b);  // Dekker
    return {value, ((x.value * y.value - value) + x.value * y.error + x.error * y.value) + x.error * y.error};
  }
  [[nodiscard]] static constexpr Exact halves(double a) {  // Veltkamp: 26 bits each
    const double shifted = 134217729.0 * a;
    const double high = shifted - (shifted - a);
    return {high, a - high};
  }

  [[nodiscard]] constexpr bool is_double() const { return part_[1] == 0; }

  [[nodiscard]] constexpr Coefficient times(double b) const {
    const Exact p = product(part_[0], b), q = product(part_[1], b);
    return distil({p.value, q.value, p.error, q.error, part_[2] * b}, 5);
  }

  /// The sum of the first `count` terms as three doubles. The sums are written out, not called: this is what a
  /// compiler spends its time on when it reads a tableau.
  [[nodiscard]] static constexpr Coefficient distil(std::array<double, 7> given, std::size_t count) {
    double term[7] = {given[0], given[1], given[2], given[3], given[4], given[5], given[6]};
    for (std::size_t pass = 0; pass < 2; ++pass) {
      for (std::size_t i = count - 1; i-- > pass;) {
        const double a = term[i], b = term[i + 1], value = a + b, shadow = value - a;
        term[i + 1] = (a - (value - shadow)) + (b - shadow);
        term[i] = value;
      }
    }
    double low = 0;
    for (std::size_t i = count - 1; i >= 2; --i) low += term[i];
    const Exact upper = sum(term[0], term[1]);
    const Exact lower = sum(upper.error, low);
    const Exact top = sum(upper.value, lower.value);
    const Exact bottom = sum(top.error, lower.error);
    return Coefficient(top.value, bottom.value, bottom.error);
  }

  /// part_[0] is the nearest double, but for a tie that part_[2] breaks.
  [[nodiscard]] constexpr double nearest() const {
    const double twice = 2 * part_[1];
    const bool tie = twice != 0 && (part_[0] + twice) - part_[0] == twice;
    return tie && part_[2] != 0 && (part_[2] > 0) == (part_[1] > 0) ? part_[0] + twice : part_[0];
  }

  friend consteval Coefficient operator""_c(const char* text);
};

/// A decimal literal, `0.161_c` or `4711_c`: any number of digits before the point, up to 45 kept behind it.
consteval Coefficient operator""_c(const char* text) {
  // Fifteen digits at a time fit a double; those behind the point are multiples of 1e-15, 1e-30 and 1e-45.
  constexpr Coefficient power[] = {
      Coefficient(0x1.203af9ee75616p-50, -0x1.937831647f5a0p-104, -0x1.3ebdf50b238dep-158),
      Coefficient(0x1.4484bfeebc2a0p-100, -0x1.e72f6d3e432b6p-154, 0x1.a051a31be599ap-208),
      Coefficient(0x1.6d601ad376ab9p-150, 0x1.a27ac0f72f8c0p-206, -0x1.796ed97d96558p-260)};
  const auto digit = [](char letter) {
    if (letter < '0' || letter > '9') throw "a coefficient is a plain decimal number";
    return static_cast<double>(letter - '0');
  };
  Coefficient value;
  int count = 0;
  for (double chunk = 0; *text != '.' && *text != '\0'; ++text) {
    chunk = 10 * chunk + digit(*text);
    if (++count == 15 || text[1] == '.' || text[1] == '\0') {
      double scale = 1;
      for (; count > 0; --count) scale *= 10;
      value = value.is_zero() ? Coefficient(chunk, 0, 0) : value.times(scale) + Coefficient(chunk, 0, 0);
      chunk = 0;
    }
  }
  if (*text == '.') ++text;
  for (const Coefficient& unit : power) {
    if (*text == '\0') break;
    double chunk = 0;
    for (int i = 0; i < 15; ++i) {
      chunk *= 10;
      if (*text != '\0') chunk += digit(*text++);
    }
    value = value.is_zero() ? unit.times(chunk) : value + unit.times(chunk);
  }
  return value;
}

/// The scalar a coefficient is kept in beside states of `Real`: Real itself, or what Real is made of where that
/// multiplies it directly (the lane of Lanes, the number inside a dual number).
template <class Real>
struct CoefficientScalar {
  using type = Real;
};
/// The scalar of lanes and dual numbers: the number inside.
template <class Real>
  requires std::floating_point<typename Real::Scalar>
struct CoefficientScalar<Real> {
  using type = typename Real::Scalar;
};
/// The scalar in which a coefficient is multiplied with states of `Real`.
template <class Real>
using CoefficientOf = typename CoefficientScalar<Real>::type;

}  // namespace continuo
