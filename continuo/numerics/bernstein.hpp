// continuo/numerics/bernstein.hpp
// All changes of sign of a smooth function on 0..1, two in one step included: sample it at nine points, write the
// interpolating polynomial in the Bernstein basis, split by de Casteljau until each piece changes sign once or never.
// By Descartes' rule a polynomial has no more roots in the interval than its Bernstein coefficients have sign changes.
// G. Farouki, V. T. Rajan, "On the numerical condition of polynomials in Bernstein form", CAGD 4 (1987).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace continuo::bernstein {

inline constexpr std::size_t degree = 8, count = degree + 1;

/// A function on an interval by its Bernstein coefficients.
using Coefficients = std::array<double, count>;

namespace detail {

// cos(k pi / 8)
inline constexpr std::array<double, 5> cosine{1, 0.92387953251128675613, 0.70710678118654752440, 0.38268343236508977173,
                                              0};

[[nodiscard]] constexpr double lobatto(std::size_t k) {
  return k == 0 ? 0.0 : k == degree ? 1.0 : k <= 4 ? (1 - cosine[k]) / 2 : (1 + cosine[degree - k]) / 2;
}

using Matrix = std::array<std::array<double, count>, count>;

// values_i = sum_j binomial(8, j) theta_i^j (1 - theta_i)^(8 - j) coefficient_j, inverted by Gauss and Jordan.
[[nodiscard]] constexpr Matrix coefficients_from_values() {
  Matrix left{}, right{};
  for (std::size_t i = 0; i < count; ++i) {
    const double theta = lobatto(i);
    double binomial = 1;
    for (std::size_t j = 0; j < count; ++j) {
      double term = binomial;
      for (std::size_t p = 0; p < j; ++p) term *= theta;
      for (std::size_t p = j; p < degree; ++p) term *= 1 - theta;
      left[i][j] = term;
      binomial = binomial * static_cast<double>(degree - j) / static_cast<double>(j + 1);
    }
    right[i][i] = 1;
  }
  for (std::size_t column = 0; column < count; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column; row < count; ++row) {
      const double here = left[row][column], best = left[pivot][column];
      if ((here < 0 ? -here : here) > (best < 0 ? -best : best)) pivot = row;
    }
    std::swap(left[column], left[pivot]);
    std::swap(right[column], right[pivot]);
    const double scale = 1 / left[column][column];
    for (std::size_t j = 0; j < count; ++j) left[column][j] *= scale, right[column][j] *= scale;
    for (std::size_t row = 0; row < count; ++row) {
      if (row == column) continue;
      const double factor = left[row][column];
      for (std::size_t j = 0; j < count; ++j) {
        left[row][j] -= factor * left[column][j];
        right[row][j] -= factor * right[column][j];
      }
    }
  }
  return right;
}

inline constexpr Matrix inverse = coefficients_from_values();

}  // namespace detail

/// Where to sample: the Chebyshev-Lobatto points of 0..1, ends included.
inline constexpr std::array<double, count> nodes = [] {
  std::array<double, count> theta{};
  for (std::size_t k = 0; k < count; ++k) theta[k] = detail::lobatto(k);
  return theta;
}();

/// The coefficients of the polynomial through the values at the nodes. The ends are taken over exactly.
[[nodiscard]] inline Coefficients from_values(const std::array<double, count>& value) {
  Coefficients b{};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) b[i] += detail::inverse[i][j] * value[j];
  b.front() = value.front();
  b.back() = value.back();
  return b;
}

/// How far the function may stray from the polynomial through its values: twice the last two Chebyshev coefficients,
/// which bound the next ones where the series converges.
[[nodiscard]] inline double interpolation_error(const std::array<double, count>& value) {
  double last = (value[0] + value[degree]) / 2, before_last = (value[0] - value[degree]) / 2;
  for (std::size_t j = 1; j < degree; ++j) {
    last += (j % 2 ? -1 : 1) * value[j];
    const std::size_t k = 7 * j % 16;
    const double angle_cosine = k <= 4    ? detail::cosine[k]
                                : k <= 8  ? -detail::cosine[8 - k]
                                : k <= 12 ? -detail::cosine[k - 8]
                                          : detail::cosine[16 - k];
    before_last += angle_cosine * value[j];
  }
  return 2 * (std::abs(last) / degree + 2 * std::abs(before_last) / degree);
}

/// Changes of sign along the coefficients, zeros passed over.
[[nodiscard]] inline int sign_changes(const Coefficients& b) {
  int changes = 0;
  double previous = 0;
  for (const double value : b) {
    if (value == 0) continue;
    if (previous != 0 && (value > 0) != (previous > 0)) ++changes;
    previous = value;
  }
  return changes;
}

/// The coefficients on the two parts of the interval, cut at `part`.
[[nodiscard]] inline std::array<Coefficients, 2> split(Coefficients b, double part) {
  Coefficients left{}, right{};
  for (std::size_t level = 0; level < count; ++level) {
    left[level] = b.front();
    right[degree - level] = b[degree - level];
    for (std::size_t i = 0; i + level < degree; ++i) b[i] += part * (b[i + 1] - b[i]);
  }
  return {left, right};
}

/// Calls visit(a, b) for every piece of 0..1 in which the polynomial changes its sign once, from left to right, until
/// visit returns true. A pair of roots closer than 2^-40 counts as a touch and is passed over.
template <class Visit>
bool isolate_sign_changes(const Coefficients& b, Visit&& visit, double from = 0, double width = 1) {
  const int changes = sign_changes(b);
  if (changes == 0) return false;
  const bool ends_differ = (b.front() > 0 && b.back() < 0) || (b.front() < 0 && b.back() > 0);
  if (changes == 1 && ends_differ) return visit(from, from + width);
  constexpr double closest = 1.0 / (1LL << 40);
  if (width < closest) return ends_differ && visit(from, from + width);
  // Roots like to lie at round parts of a step; a cut there would belong to neither side.
  double part = 0.4871;
  auto pieces = split(b, part);
  if (pieces[1].front() == 0) pieces = split(b, part = 0.5193);
  const double middle = from + part * width;
  return isolate_sign_changes(pieces[0], visit, from, part * width) ||
         isolate_sign_changes(pieces[1], visit, middle, from + width - middle);
}

}  // namespace continuo::bernstein
