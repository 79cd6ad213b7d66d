// continuo/numerics/polynomial_enclosure.hpp
// The range and the slope of a polynomial over a part of 0..1, such as a component of a method's dense output.
//
//   const double c[] = {1, -3, 2};                            // 1 - 3 theta + 2 theta^2
//   const auto x = enclose_polynomial<double>(c, 0.2, 0.3);   // x.value: [0.28, 0.48], x.slope: [-2.2, -1.8]
//
// The polynomial is written about the middle m of the part, p(m + s) = sum d_k s^k with |s| <= r; then each power of s
// is replaced by its range. The excess is of second order in r for the value, against d_1.
//
// Rounding. With A = sum over j > 0 of |c_j| (|m| + r)^j, a coefficient of p takes part in d_k through at most
// 2 n + 2 rounded operations, in the sum of ranges through 2 n + 3 more: together within (4 n + 5) u A, where u is half
// of epsilon (N. J. Higham, Accuracy and Stability of Numerical Algorithms, chapters 3 and 5). Horner's rule, by which
// others compute p, is within 2 n u A. The range is widened by both, which encloses the values so computed too. c_0
// enters by a sum at the end.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <continuo/numerics/enclosure_with_slope.hpp>

namespace continuo {

inline constexpr std::size_t greatest_enclosed_degree = 31;

/// sum_j c[j] theta^j for theta in from..to, a part of 0..1. At least one coefficient.
template <class Real>
EnclosureWithSlope<Real> enclose_polynomial(std::span<const Real> c, Real from, Real to) {
  const std::size_t n = c.size() - 1;
  Real weight = 0, slope_weight = 0;  // sum |c_j| to^j over j > 0, sum j |c_j| to^(j - 1)
  for (std::size_t j = n; j > 0; --j) {
    slope_weight = slope_weight * to + static_cast<Real>(j) * std::abs(c[j]);
    weight = (weight + std::abs(c[j])) * to;
  }
  if (slope_weight == 0) return EnclosureWithSlope<Real>(c[0]);

  constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
  const Real middle = from + (to - from) / 2;
  const Real radius = std::max(to - middle, middle - from) * (1 + 2 * epsilon);
  std::array<Real, greatest_enclosed_degree + 1> d;
  std::copy(c.begin(), c.end(), d.begin());
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = n; j-- > k;) d[j] += middle * d[j + 1];

  // Odd powers of s lie between -r^k and r^k, even ones between 0 and r^k.
  Real lo = 0, hi = 0, slope_lo = 0, slope_hi = 0, power = 1;
  for (std::size_t k = 1; k <= n; ++k) {
    const Real slope_term = static_cast<Real>(k) * d[k] * power;
    power *= radius;
    const Real term = d[k] * power, size = std::abs(term), slope_size = std::abs(slope_term);
    if (k % 2 == 1) {
      lo -= size, hi += size;
      slope_lo += std::min(slope_term, Real(0)), slope_hi += std::max(slope_term, Real(0));
    } else {
      lo += std::min(term, Real(0)), hi += std::max(term, Real(0));
      slope_lo -= slope_size, slope_hi += slope_size;
    }
  }
  // d_1 itself is no range.
  if (d[1] > 0) slope_lo += d[1];
  if (d[1] < 0) slope_hi += d[1];

  const Real rounding = (3 * static_cast<Real>(n) + 5) * epsilon;
  const Real excess = rounding * weight + 2 * epsilon * std::abs(d[0]) + underflow<Real>;
  const Real slope_excess = rounding * slope_weight + underflow<Real>;
  return {enclosing::widened(d[0] + lo - excess, d[0] + hi + excess),
          enclosing::widened(slope_lo - slope_excess, slope_hi + slope_excess)};
}

/// The value for one theta in 0..1.
template <class Real>
Enclosure<Real> polynomial_at(std::span<const Real> c, Real theta) {
  const std::size_t n = c.size() - 1;
  Real weight = 0, value = 0;
  for (std::size_t j = n; j > 0; --j) {
    weight = (weight + std::abs(c[j])) * theta;
    value = (value + c[j]) * theta;
  }
  if (weight == 0) return Enclosure<Real>(c[0]);
  // This sum and somebody else's: the motion by Horner's rule, and one more rounding each.
  constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
  const Real excess =
      (2 * static_cast<Real>(n) + 2) * epsilon * weight + 2 * epsilon * std::abs(c[0] + value) + underflow<Real>;
  return enclosing::widened(c[0] + value - excess, c[0] + value + excess);
}

}  // namespace continuo
