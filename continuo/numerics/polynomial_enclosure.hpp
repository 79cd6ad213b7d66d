// continuo/numerics/polynomial_enclosure.hpp
// The range and the slope of a polynomial over a part of 0..1, such as a component of a method's dense output.
//
//   const double c[] = {1, -3, 2};                            // 1 - 3 theta + 2 theta^2
//   const auto x = enclose_polynomial<double>(c, 0.2, 0.3);   // x.value: [0.28, 0.48], x.slope: [-2.2, -1.8]
//
// The polynomial is written about the middle m of the part, p(m + s) = sum_k d_k s^k with |s| <= r; then each power of
// s is replaced by its range: an odd one lies between -r^k and r^k, an even one between 0 and r^k. The excess is of
// second order in r.
//
// Rounding. A coefficient c_j takes part in d_k through at most 2 n + 2 rounded operations, in the sum of ranges
// through 2 n + 3 more, and the sum over k of binomial(j, k) m^(j - k) r^k is (m + r)^j <= 1. Horner's rule, by which
// others compute p, has 2 n; the method `taylor` computes it from series in another unit of time, by powers of the
// square of s, with 2 n that separate the coefficients and 3.5 n + 5 in the sum. Together they are within
// (9.5 n + 10) u A, where u is half of epsilon and A = to * sum over j > 0 of |c_j|, for the slope the sum of j |c_j|
// (N. J. Higham, Accuracy and Stability of Numerical Algorithms, chapters 3 and 5). The range is widened by that, and
// so holds what others compute. c_0 enters by a sum at the end.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <continuo/numerics/enclosure_with_slope.hpp>

namespace continuo {

/// That of the dense output of taylor, the greatest of all methods.
inline constexpr std::size_t greatest_enclosed_degree = 20;

namespace enclosing {

/// What coefficients can be off by together, for the sum of their sizes 1.
template <class Real>
[[nodiscard]] constexpr Real polynomial_rounding(std::size_t count) {
  return (5 * static_cast<Real>(count) + 2) * std::numeric_limits<Real>::epsilon();
}

/// Of `count` coefficients, a constant for the loops' sake.
template <std::size_t count, class Real>
[[nodiscard]] EnclosureWithSlope<Real> polynomial_over(std::span<const Real> c, Real from, Real to) {
  std::array<Real, count> d{};
  for (std::size_t j = 0; j < c.size(); ++j) d[j] = c[j];
  Real weight = 0, slope_weight = 0;
  for (std::size_t j = 1; j < count; ++j) {
    weight += std::abs(d[j]);
    slope_weight += static_cast<Real>(j) * std::abs(d[j]);
  }
  if (weight == 0) return EnclosureWithSlope<Real>(d[0]);

  constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
  const Real middle = from + (to - from) / 2;
  const Real radius = std::max(to - middle, middle - from) * (1 + 2 * epsilon);
  for (std::size_t k = 0; k + 1 < count; ++k)
    for (std::size_t j = count - 1; j-- > k;) d[j] += middle * d[j + 1];

  // The sums of sizes and of terms, of even and of odd powers: max(a, 0) = (|a| + a)/2.
  Real size[2] = {}, sum[2] = {}, slope_size[2] = {}, slope_sum[2] = {}, power = 1;
  for (std::size_t k = 1; k < count; ++k) {
    const Real slope_term = static_cast<Real>(k) * d[k] * power, term = d[k] * (power *= radius);
    size[k % 2] += std::abs(term), sum[k % 2] += term;
    if (k > 1) slope_size[k % 2] += std::abs(slope_term), slope_sum[k % 2] += slope_term;
  }
  constexpr Real rounding = polynomial_rounding<Real>(count);
  const Real excess = rounding * weight * to + 2 * epsilon * std::abs(d[0]) + underflow<Real>;
  const Real slope_excess = rounding * slope_weight + underflow<Real>;
  return {widened(d[0] + (sum[0] - size[0]) / 2 - size[1] - excess, d[0] + (sum[0] + size[0]) / 2 + size[1] + excess),
          widened(d[1] + (slope_sum[1] - slope_size[1]) / 2 - slope_size[0] - slope_excess,
                  d[1] + (slope_sum[1] + slope_size[1]) / 2 + slope_size[0] + slope_excess)};
}

}  // namespace enclosing

/// sum_j c[j] theta^j for theta in from..to, a part of 0..1. At least one coefficient.
template <class Real>
[[nodiscard]] EnclosureWithSlope<Real> enclose_polynomial(std::span<const Real> c, Real from, Real to) {
  if (c.size() <= 4) return enclosing::polynomial_over<4>(c, from, to);
  if (c.size() <= 8) return enclosing::polynomial_over<8>(c, from, to);
  if (c.size() <= 16) return enclosing::polynomial_over<16>(c, from, to);
  return enclosing::polynomial_over<greatest_enclosed_degree + 1>(c, from, to);
}

/// The values on all of 0..1 in a fifth of the time, from the ranges of the terms as they are: two or three times as
/// wide where the motion turns. `coefficient(j)` gives c_j for j in 0..count.
template <class Real, class Coefficient>
[[nodiscard]] Enclosure<Real> enclose_whole_polynomial(std::size_t count, const Coefficient& coefficient) {
  // max(c, 0) = (|c| + c)/2; two sums of each, as one addition does not wait for the other then.
  Real weight = 0, total = 0, other_weight = 0, other_total = 0;
  std::size_t j = 1;
  for (; j + 1 < count; j += 2) {
    const Real c = coefficient(j), d = coefficient(j + 1);
    weight += std::abs(c), total += c;
    other_weight += std::abs(d), other_total += d;
  }
  if (j < count) weight += std::abs(coefficient(j)), total += coefficient(j);
  weight += other_weight, total += other_total;
  const Real first = coefficient(0);
  if (weight == 0) return Enclosure<Real>(first);
  const Real reach = weight / 2 + enclosing::polynomial_rounding<Real>(count) * weight;
  return enclosing::widened_by<2>(first + (total / 2 - reach), first + (total / 2 + reach));
}

/// The values and slopes on all of 0..1 from the ranges of the terms as they are: 5 n operations for n^2, and nearly as
/// narrow where the coefficients fall quickly.
template <class Real>
[[nodiscard]] EnclosureWithSlope<Real> enclose_whole_polynomial_with_slope(std::span<const Real> c) {
  const Enclosure<Real> value = enclose_whole_polynomial<Real>(c.size(), [c](std::size_t j) { return c[j]; });
  Real weight = 0, total = 0, factor = 1;
  for (std::size_t j = 2; j < c.size(); ++j) {
    factor += 1;
    weight += factor * std::abs(c[j]), total += factor * c[j];
  }
  const Real first = c.size() > 1 ? c[1] : Real(0);
  if (weight == 0 && first == 0) return EnclosureWithSlope<Real>(c[0]);
  const Real excess = enclosing::polynomial_rounding<Real>(c.size()) * (weight + std::abs(first)) + underflow<Real>;
  return {value, enclosing::widened(first + (total - weight) / 2 - excess, first + (total + weight) / 2 + excess)};
}

/// The value for one theta in 0..1.
template <class Real>
[[nodiscard]] Enclosure<Real> polynomial_at(std::span<const Real> c, Real theta) {
  const std::size_t n = c.size() - 1;
  Real weight = 0, value = 0;
  for (std::size_t j = n; j > 0; --j) {
    weight = (weight + std::abs(c[j])) * theta;
    value = (value + c[j]) * theta;
  }
  if (weight == 0) return Enclosure<Real>(c[0]);
  constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
  const Real excess = enclosing::polynomial_rounding<Real>(c.size()) * weight + 2 * epsilon * std::abs(c[0] + value);
  return enclosing::widened_by(c[0] + value - excess, c[0] + value + excess);
}

}  // namespace continuo
