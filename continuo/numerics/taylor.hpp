// Truncated Taylor series of functions of one variable s: c[0] + c[1] s + ... + c[order] s^order. A formula evaluated
// on them gives the derivatives of what it computes, exact but for rounding:
//
//   using Series = Taylor<double, 3>;
//   const Series x(2.0, 1.0);                       // 2 + s
//   const Series y = x * x - sin(x);                // y.c[k] = the k-th derivative by s at s = 0, divided by k!
//
// The recurrences: A. Griewank, A. Walther, "Evaluating Derivatives", 2nd ed., SIAM (2008), chapter 13, tables 13.1 and
// 13.2. Each follows from a linear differential equation of the function, compared coefficient by coefficient.
//
// Everything is the limit from the right, at s = 0+: two series compare as their functions do just after s = 0, by the
// first coefficients that differ. So abs and select take the branch that comes, the floor of what falls from a whole
// number is one less, and a root of what leaves zero is a root of its leading term. Coefficients that the given ones do
// not determine are NaN; an infinite one says that the function leaves its value faster than any straight line.
//
// Scalar is a floating-point number, or a Rounded one: then comparisons may be undecided.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>

#include <continuo/numerics/rounded.hpp>

namespace continuo {

/// A truncated power series: the coefficients c[k] of s^k.
template <class Scalar_, std::size_t order_>
struct Taylor {
  using Scalar = Scalar_;
  static constexpr std::size_t order = order_;

  std::array<Scalar, order + 1> c{};

  /// Zero.
  constexpr Taylor() = default;
  /// A constant.
  template <class Number>
    requires std::convertible_to<Number, Scalar>
  constexpr Taylor(const Number& value) {
    c[0] = Scalar(value);
  }
  /// value + slope*s
  constexpr Taylor(const Scalar& value, const Scalar& slope) { c[0] = value, c[1] = slope; }

  /// Negative, sum and difference.
  /// @{
  friend Taylor operator-(Taylor a) {
    for (Scalar& coefficient : a.c) coefficient = -coefficient;
    return a;
  }
  friend Taylor operator+(Taylor a, const Taylor& b) {
    for (std::size_t k = 0; k <= order; ++k) a.c[k] = a.c[k] + b.c[k];
    return a;
  }
  friend Taylor operator-(Taylor a, const Taylor& b) {
    for (std::size_t k = 0; k <= order; ++k) a.c[k] = a.c[k] - b.c[k];
    return a;
  }
  /// @}
  /// The product, truncated. Costs order^2 / 2 products.
  [[gnu::noinline]] friend Taylor operator*(const Taylor& a, const Taylor& b) {
    Taylor product;
    for (std::size_t k = 0; k <= order; ++k) {
      for (std::size_t j = 0; j <= k; ++j) product.c[k] = product.c[k] + times(a.c[j], b.c[k - j]);
    }
    return product;
  }
  /// q b = a
  [[gnu::noinline]] friend Taylor operator/(const Taylor& a, const Taylor& b) {
    Taylor quotient;
    for (std::size_t k = 0; k <= order; ++k) {
      Scalar rest = a.c[k];
      for (std::size_t j = 1; j <= k; ++j) rest = rest - times(b.c[j], quotient.c[k - j]);
      quotient.c[k] = rest / b.c[0];
    }
    return quotient;
  }

  /// Comparisons by the first coefficients that differ: what holds just after s = 0.
  /// @{
  friend auto operator<(const Taylor& a, const Taylor& b) {
    for (std::size_t k = 0; k < order; ++k) {
      if (!certainly(a.c[k] == b.c[k])) return a.c[k] < b.c[k];
    }
    return a.c[order] < b.c[order];
  }
  friend auto operator>(const Taylor& a, const Taylor& b) { return b < a; }
  friend auto operator<=(const Taylor& a, const Taylor& b) {
    for (std::size_t k = 0; k < order; ++k) {
      if (!certainly(a.c[k] == b.c[k])) return a.c[k] <= b.c[k];
    }
    return a.c[order] <= b.c[order];
  }
  friend auto operator>=(const Taylor& a, const Taylor& b) { return b <= a; }
  /// @}
  /// Not equal where any coefficient differs: then they part, whatever the others do.
  friend auto operator==(const Taylor& a, const Taylor& b) {
    auto same = a.c[0] == b.c[0];
    for (std::size_t k = 1; k <= order && !certainly(!same); ++k) {
      const auto equal = a.c[k] == b.c[k];
      if (!certainly(equal)) same = equal;
    }
    return same;
  }
  /// The opposite of ==.
  friend auto operator!=(const Taylor& a, const Taylor& b) { return !(a == b); }

  /// a where it holds, b where it does not, else one of them.
  friend Taylor select(Truth condition, const Taylor& a, const Taylor& b)
    requires(!std::floating_point<Scalar>)
  {
    if (condition != Truth::undecided) return condition == Truth::yes ? a : b;
    Taylor either;
    /// The first series where the condition holds, else the second.
    for (std::size_t k = 0; k <= order; ++k) either.c[k] = hull(a.c[k], b.c[k]);
    return either;
  }
  friend Taylor select(bool condition, const Taylor& a, const Taylor& b) { return condition ? a : b; }

  /// Exactly zero times what is not known is zero.
  static Scalar times(const Scalar& a, const Scalar& b) {
    if constexpr (std::floating_point<Scalar>) {
      return a == 0 || b == 0 ? Scalar(0) : a * b;
    } else {
      return a * b;
    }
  }
  /// Whether a coefficient is exactly zero, without rounding.
  static bool is_zero(const Scalar& x) {
    if constexpr (std::floating_point<Scalar>) {
      return x == 0;
    } else {
      return x.is_exactly_zero();
    }
  }
  /// A coefficient that is not determined: NaN.
  static Scalar unknown() { return Scalar(std::numeric_limits<double>::quiet_NaN()); }

  /// The first coefficient that is not exactly zero; order + 1 where all are.
  std::size_t leading() const { return static_cast<std::size_t>(std::ranges::find_if_not(c, is_zero) - c.begin()); }
  /// Whether all coefficients but the first are exactly zero.
  bool is_constant() const { return std::ranges::all_of(c.begin() + 1, c.end(), is_zero); }
};

template <class Type>
inline constexpr bool is_taylor = false;
template <class Scalar, std::size_t order>
inline constexpr bool is_taylor<Taylor<Scalar, order>> = true;

/// The number itself, without its rounding.
template <std::floating_point Real>
[[nodiscard]] Real midpoint(Real x) {
  return x;
}
template <class Real>
[[nodiscard]] Real midpoint(const Rounded<Real>& x) {
  return x.value;
}

namespace detail {

/// j/k x
template <class Scalar>
[[nodiscard]] Scalar part(std::size_t j, std::size_t k, const Scalar& x) {
  return j == k ? x : Scalar(static_cast<double>(j)) * x / Scalar(static_cast<double>(k));
}

/// y with y' = slope a' and y(0) = value. `slope` gives its coefficients 0..k - 1 when y's are known up to k - 1.
template <class Scalar, std::size_t order, class Slope>
[[nodiscard]] Taylor<Scalar, order> integral(const Scalar& value, const Taylor<Scalar, order>& a, Slope&& slope) {
  using Series = Taylor<Scalar, order>;
  Series y(value);
  for (std::size_t k = 1; k <= order; ++k) {
    Scalar sum(0);
    for (std::size_t j = 1; j <= k; ++j) sum = sum + part(j, k, Series::times(a.c[j], slope(y, k - j)));
    y.c[k] = sum;
  }
  return y;
}

/// y with y' = slope a' of which the slope is known.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> along(const Scalar& value, const Taylor<Scalar, order>& slope,
                                          const Taylor<Scalar, order>& a) {
  return integral(value, a, [&](const auto&, std::size_t k) { return slope.c[k]; });
}

/// a/s^m of which the last m coefficients are not known.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> shifted_down(const Taylor<Scalar, order>& a, std::size_t m) {
  Taylor<Scalar, order> shifted;
  for (std::size_t k = 0; k <= order; ++k) shifted.c[k] = k + m <= order ? a.c[k + m] : shifted.unknown();
  return shifted;
}
/// a s^m
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> shifted_up(const Taylor<Scalar, order>& a, std::size_t m) {
  Taylor<Scalar, order> shifted;
  for (std::size_t k = m; k <= order; ++k) shifted.c[k] = a.c[k - m];
  return shifted;
}

/// y = a^p where a(0) is not zero: a y' = p y a'.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> power_away_from_zero(const Taylor<Scalar, order>& a, const Scalar& value,
                                                         const Scalar& p) {
  using Series = Taylor<Scalar, order>;
  Series y(value);
  for (std::size_t k = 1; k <= order; ++k) {
    Scalar sum(0);
    for (std::size_t j = 1; j <= k; ++j) {
      const Scalar weight = p * Scalar(static_cast<double>(j)) - Scalar(static_cast<double>(k - j));
      sum = sum + Series::times(weight, Series::times(a.c[j], y.c[k - j]));
    }
    y.c[k] = sum / (Scalar(static_cast<double>(k)) * a.c[0]);
  }
  return y;
}

/// a^p for p > 0 that is no whole number, where a(0) = 0: with a = s^m b, it is s^(m p) b^p.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> power_at_zero(const Taylor<Scalar, order>& a, double p) {
  using std::pow;
  using Series = Taylor<Scalar, order>;
  const std::size_t m = a.leading();
  const double shift = static_cast<double>(m) * p, whole = std::ceil(shift);
  const auto first = whole > static_cast<double>(order) ? order + 1 : static_cast<std::size_t>(whole);
  Series y;
  const auto unknown_from = [&y](std::size_t k) {
    for (; k <= order; ++k) y.c[k] = Series::unknown();
  };
  if (m > order) return unknown_from(first), y;  // a may go on with a term of order + 1
  if (!certainly(a.c[m] > Scalar(0))) return unknown_from(1), y;
  if (first > order) return y;
  if (shift == whole) {
    const Series rest = shifted_down(a, m);
    return shifted_up(power_away_from_zero(rest, Scalar(pow(rest.c[0], Scalar(p))), Scalar(p)), first);
  }
  y.c[first] = Scalar(std::numeric_limits<double>::infinity());
  return unknown_from(first + 1), y;
}

template <class Series>
[[nodiscard]] Series whole_power(Series a, unsigned n) {
  Series power(1);
  for (bool begun = false; n > 0; n >>= 1, a = a * a) {
    if (n % 2 == 1) power = begun ? power * a : a, begun = true;
  }
  return power;
}

/// y with y' = y w' and this value: exp(w), up to a factor.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> exponential_of(const Scalar& value, const Taylor<Scalar, order>& w) {
  return integral(value, w, [](const auto& y, std::size_t k) { return y.c[k]; });
}

/// Both of a pair of functions whose slopes are second and sign*first: sin and cos, sinh and cosh.
template <class Scalar, std::size_t order>
[[nodiscard]] std::array<Taylor<Scalar, order>, 2> pair_of(const Scalar& first, const Scalar& second,
                                                           const Taylor<Scalar, order>& a, double sign) {
  using Series = Taylor<Scalar, order>;
  std::array<Series, 2> pair{Series(first), Series(second)};
  for (std::size_t k = 1; k <= order; ++k) {
    Scalar of_first(0), of_second(0);
    for (std::size_t j = 1; j <= k; ++j) {
      of_first = of_first + part(j, k, Series::times(a.c[j], pair[1].c[k - j]));
      of_second = of_second + part(j, k, Series::times(a.c[j], pair[0].c[k - j]));
    }
    pair[0].c[k] = of_first;
    pair[1].c[k] = Scalar(sign) * of_second;
  }
  return pair;
}

}  // namespace detail

/// The square root. At zero it is that of the leading term, whose coefficients may be infinite or unknown.
template <class Scalar, std::size_t order>
[[nodiscard]] [[gnu::noinline]] Taylor<Scalar, order> sqrt(const Taylor<Scalar, order>& a) {
  using std::sqrt;
  using Series = Taylor<Scalar, order>;
  if (Series::is_zero(a.c[0])) return detail::power_at_zero(a, 0.5);
  Series root(Scalar(sqrt(a.c[0])));
  for (std::size_t k = 1; k <= order; ++k) {  // r r = a
    Scalar rest = a.c[k];
    for (std::size_t j = 1; j < k; ++j) rest = rest - Series::times(root.c[j], root.c[k - j]);
    root.c[k] = rest / (Scalar(2) * root.c[0]);
  }
  return root;
}

/// The exponential.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> exp(const Taylor<Scalar, order>& a) {
  using std::exp;
  return detail::exponential_of(Scalar(exp(a.c[0])), a);
}

/// The natural logarithm.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> log(const Taylor<Scalar, order>& a) {
  using std::log;
  return detail::along(Scalar(log(a.c[0])), 1.0 / a, a);
}

/// The decimal logarithm.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> log10(const Taylor<Scalar, order>& a) {
  using std::log10, std::log;
  return detail::along(Scalar(log10(a.c[0])), Taylor<Scalar, order>(Scalar(1) / Scalar(log(Scalar(10)))) / a, a);
}

/// a^b. Whole exponents up to 16 are products, exact at zero and for negative numbers.
template <class Scalar, std::size_t order>
[[nodiscard]] [[gnu::noinline]] Taylor<Scalar, order> pow(const Taylor<Scalar, order>& a,
                                                          const Taylor<Scalar, order>& b) {
  using std::pow;
  using Series = Taylor<Scalar, order>;
  const Scalar value = pow(a.c[0], b.c[0]);
  if (!b.is_constant()) {
    // Both exp(b log a); the value as the library has it.
    return detail::exponential_of(value, b * log(a));
  }
  const auto exponent = static_cast<double>(midpoint(b.c[0]));
  const bool is_whole = exponent == std::floor(exponent);
  // Squares of squares: exact at zero, where the recurrence divides by it, and for negative numbers. Beyond 16 the
  // recurrence takes fewer operations, and at zero nothing is left.
  if (is_whole && std::abs(exponent) <= 16) {
    const Series power = detail::whole_power(a, static_cast<unsigned>(std::abs(exponent)));
    return exponent < 0 ? 1.0 / power : power;
  }
  if (Series::is_zero(a.c[0]) && exponent > 0) return is_whole ? Series(0) : detail::power_at_zero(a, exponent);
  return detail::power_away_from_zero(a, value, b.c[0]);
}

/// Trigonometric functions.
/// @{
template <class Scalar, std::size_t order>
[[nodiscard]] [[gnu::noinline]] Taylor<Scalar, order> sin(const Taylor<Scalar, order>& a) {
  using std::sin, std::cos;
  return detail::pair_of(Scalar(sin(a.c[0])), Scalar(cos(a.c[0])), a, -1)[0];
}
template <class Scalar, std::size_t order>
[[nodiscard]] [[gnu::noinline]] Taylor<Scalar, order> cos(const Taylor<Scalar, order>& a) {
  using std::sin, std::cos;
  return detail::pair_of(Scalar(sin(a.c[0])), Scalar(cos(a.c[0])), a, -1)[1];
}
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> tan(const Taylor<Scalar, order>& a) {
  return sin(a) / cos(a);
}
/// @}
/// Inverse trigonometric functions.
/// @{
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> asin(const Taylor<Scalar, order>& a) {
  using std::asin;
  return detail::along(Scalar(asin(a.c[0])), 1.0 / sqrt((1.0 - a) * (1.0 + a)), a);
}
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> acos(const Taylor<Scalar, order>& a) {
  using std::acos;
  return detail::along(Scalar(acos(a.c[0])), -1.0 / sqrt((1.0 - a) * (1.0 + a)), a);
}
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> atan(const Taylor<Scalar, order>& a) {
  using std::atan;
  return detail::along(Scalar(atan(a.c[0])), 1.0 / (1.0 + a * a), a);
}
/// @}
/// Hyperbolic functions.
/// @{
template <class Scalar, std::size_t order>
[[nodiscard]] [[gnu::noinline]] Taylor<Scalar, order> sinh(const Taylor<Scalar, order>& a) {
  using std::sinh, std::cosh;
  return detail::pair_of(Scalar(sinh(a.c[0])), Scalar(cosh(a.c[0])), a, 1)[0];
}
template <class Scalar, std::size_t order>
[[nodiscard]] [[gnu::noinline]] Taylor<Scalar, order> cosh(const Taylor<Scalar, order>& a) {
  using std::sinh, std::cosh;
  return detail::pair_of(Scalar(sinh(a.c[0])), Scalar(cosh(a.c[0])), a, 1)[1];
}
/// @}
/// The slope is 1 - y^2.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> tanh(const Taylor<Scalar, order>& a) {
  using std::tanh;
  return detail::integral(Scalar(tanh(a.c[0])), a, [](const auto& y, std::size_t k) { return (1.0 - y * y).c[k]; });
}

/// What both have in common as a power of s stands before the root, so that a way through the corner is known to the
/// last coefficient.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> hypot(const Taylor<Scalar, order>& a, const Taylor<Scalar, order>& b) {
  const std::size_t m = std::min(a.leading(), b.leading());
  if (m == 0) return sqrt(a * a + b * b);
  if (m > order) return {};
  const auto x = detail::shifted_down(a, m), y = detail::shifted_down(b, m);
  return detail::shifted_up(sqrt(x * x + y * y), m);
}

/// The angle of (x, y), whose slope is (x y' - y x')/(x^2 + y^2). Out of the corner it is that of the way taken, and on
/// the negative axis y decides whether it is pi or -pi.
template <class Scalar, std::size_t order>
[[nodiscard]] [[gnu::noinline]] Taylor<Scalar, order> atan2(const Taylor<Scalar, order>& y,
                                                            const Taylor<Scalar, order>& x) {
  using std::atan2;
  using Series = Taylor<Scalar, order>;
  const std::size_t m = std::min(x.leading(), y.leading());
  if (m > order) return Series(Scalar(atan2(y.c[0], x.c[0])));
  if (m > 0) return atan2(detail::shifted_down(y, m), detail::shifted_down(x, m));
  Scalar height = y.c[0];
  if (Series::is_zero(height) && certainly(y < Series(0))) height = Scalar(-0.0);
  const Series square = x * x + y * y, by_y = x / square, by_x = -y / square;
  Series angle = detail::along(Scalar(0), by_y, y) + detail::along(Scalar(0), by_x, x);
  angle.c[0] = atan2(height, x.c[0]);
  return angle;
}

/// The absolute value: -a where a is negative just after s = 0.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> abs(const Taylor<Scalar, order>& a) {
  return select(a < Taylor<Scalar, order>(0), -a, a);
}

/// Of a whole number that falls: one less.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> floor(const Taylor<Scalar, order>& a) {
  using Series = Taylor<Scalar, order>;
  const double value = static_cast<double>(midpoint(a.c[0])), nearest = std::round(value);
  if (!std::isfinite(value)) return Series(Series::unknown());
  return select(a < Series(nearest), Series(nearest - 1), Series(nearest));
}
/// The next whole number above, just after s = 0.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> ceil(const Taylor<Scalar, order>& a) {
  return -floor(-a);
}

}  // namespace continuo
