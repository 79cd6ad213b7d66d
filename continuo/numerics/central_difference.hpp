// Derivatives by central differences, (f(x + h) - f(x - h)) / 2h. Which h: leaving out the higher terms costs h^2 f'''
// / 6, the rounding of f about epsilon f / h. In the size over which f changes by as much as it is, both are alike at
// the third root of epsilon, 6e-6, where ten digits are right. Where f is itself known to fewer digits, as a derivative
// by differences is or what an integration comes to, the third root of its own error takes the place of that of
// epsilon.
//
// Forward differences, for half the evaluations and eight digits: system/jacobian.hpp. Differences that know how far
// they can be trusted: system/differences.hpp.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace continuo {

/// h, of a number or of `scale`, whichever is larger; x + h is exact.
template <class Real>
[[nodiscard]] Real central_increment(const Real& x, const Real& scale) {
  using std::abs, std::cbrt, std::max;
  static const Real relative = cbrt(std::numeric_limits<Real>::epsilon());
  const Real moved = x + relative * max(Real(abs(x)), scale);
  return moved - x;
}

/// In sizes of the variable, for a derivative of a Jacobian, which may be exact or itself by central differences: ten
/// digits are right of the former, five of the latter.
inline constexpr double increment_for_jacobians = 1e-5;

/// f() where `value`, which f reads, is greater by the increment, and where it is less. It is as before afterwards.
template <class Real, class F>
[[nodiscard]] auto on_both_sides(Real& value, const Real& increment, const F& f) {
  const Real here = value;
  value = here + increment;
  auto above = f();
  value = here - increment;
  auto below = f();
  value = here;
  return std::pair(std::move(above), std::move(below));
}

/// df/dx row by row, by central differences of f(x, result) with `increment(j)` of x[j]. `rows` has a row for each
/// component of f.
template <class Real, class Increment, class F>
void difference_jacobian(std::vector<Real> x, const Increment& increment, const F& f, std::span<Real> rows) {
  const std::size_t n = x.size(), outputs = n == 0 ? 0 : rows.size() / n;
  std::vector<Real> above(outputs), below(outputs);
  for (std::size_t j = 0; j < n; ++j) {
    const Real here = x[j], h = increment(j);
    x[j] = here + h;
    f(x, above);
    x[j] = here - h;
    f(x, below);
    x[j] = here;
    for (std::size_t i = 0; i < outputs; ++i) rows[i * n + j] = (above[i] - below[i]) / (2 * h);
  }
}

}  // namespace continuo
