// continuo/numerics/complex_number.hpp
// Complex arithmetic over any real scalar. std::complex is unspecified for scalars that are not built in, and its
// product looks for infinities at every turn.
#pragma once
#include <cmath>

namespace continuo {

/// A complex number re + i im. Infinities and NaN get no special treatment.
template <class Real>
struct ComplexNumber {
  Real re{};  // the real part
  Real im{};  // the imaginary part

  /// Zero.
  constexpr ComplexNumber() = default;
  /// A real number.
  constexpr ComplexNumber(const Real& re_) : re(re_), im(Real(0)) {}
  /// re + i im.
  constexpr ComplexNumber(const Real& re_, const Real& im_) : re(re_), im(im_) {}

  /// The operations in place.
  /// @{
  [[gnu::always_inline]] constexpr ComplexNumber& operator+=(const ComplexNumber& b) {
    return re += b.re, im += b.im, *this;
  }
  [[gnu::always_inline]] constexpr ComplexNumber& operator-=(const ComplexNumber& b) {
    return re -= b.re, im -= b.im, *this;
  }
  [[gnu::always_inline]] constexpr ComplexNumber& operator*=(const ComplexNumber& b) { return *this = *this * b; }
  /// @}

  /// Sum, difference, negative and product, by the formulas of the field, without a test for overflow.
  /// @{
  [[gnu::always_inline]] friend constexpr ComplexNumber operator+(ComplexNumber a, const ComplexNumber& b) {
    return a += b;
  }
  [[gnu::always_inline]] friend constexpr ComplexNumber operator-(ComplexNumber a, const ComplexNumber& b) {
    return a -= b;
  }
  [[gnu::always_inline]] friend constexpr ComplexNumber operator-(const ComplexNumber& a) { return {-a.re, -a.im}; }
  [[gnu::always_inline]] friend constexpr ComplexNumber operator*(const ComplexNumber& a, const ComplexNumber& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  /// @}
  friend constexpr bool operator==(const ComplexNumber&, const ComplexNumber&) = default;
};

/// What a pivot is chosen by: |re| + |im|.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real magnitude(const ComplexNumber<Real>& z) {
  using std::abs;
  return abs(z.re) + abs(z.im);
}
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real magnitude(const Real& x) {
  using std::abs;
  return abs(x);
}

/// 1/z, scaled so that neither square overflows (R. L. Smith, "Algorithm 116", CACM 5 (1962)).
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline ComplexNumber<Real> reciprocal(const ComplexNumber<Real>& z) {
  using std::abs;
  if (abs(z.re) >= abs(z.im)) {
    const Real ratio = z.im / z.re, denominator = z.re + z.im * ratio;
    return {Real(1) / denominator, -ratio / denominator};
  }
  const Real ratio = z.re / z.im, denominator = z.re * ratio + z.im;
  return {ratio / denominator, Real(-1) / denominator};
}
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real reciprocal(const Real& x) {
  return Real(1) / x;
}

}  // namespace continuo
