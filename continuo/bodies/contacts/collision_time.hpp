// continuo/bodies/contacts/collision_time.hpp
// Collision times of objects on known paths: closed forms, written so that no digits cancel, and isolated roots of a
// polynomial where there is no closed form.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/numerics/bernstein.hpp>
#include <continuo/numerics/vector.hpp>

namespace continuo {

namespace detail {

/// Whether two bodies in contact approach each other. By rounding, tangential motion can look like an approach, and
/// would be found again and again: so an approach counts only beyond `tiny`. An approach that does not count lowers the
/// squared distance by at most b^2 / |rate|^2, which is tiny^2 of it, before the two separate.
template <class Real, int Dim>
[[nodiscard]] bool approaches(const Vector<Real, Dim>& apart, const Vector<Real, Dim>& rate) {
  constexpr Real tiny = 8 * std::numeric_limits<Real>::epsilon();
  const Real b = dot(apart, rate);
  return b < Real(0) && b * b > tiny * tiny * squared(apart) * squared(rate);
}

}  // namespace detail

/// The first t >= 0 at which a point that is `apart` and moves at `rate` comes within `reach` of the origin; infinity
/// where it never does. A point that is within reach already collides at once if it approaches, and never if it
/// recedes, so that two spheres that rounding leaves an ulp inside each other do no harm (M. Bannerman, S. Strobl, A.
/// Formella, T. Poschel, Comp. Part. Mech. 1 (2014) 191-198).
template <class Real, int Dim>
[[nodiscard]] Real time_to_touch(const Vector<Real, Dim>& apart, const Vector<Real, Dim>& rate, const Real& reach) {
  using std::sqrt;
  constexpr Real never = std::numeric_limits<Real>::infinity();
  const Real b = dot(apart, rate);
  if (!(b < Real(0))) return never;
  const Real c = squared(apart) - reach * reach;
  if (c <= Real(0)) return detail::approaches(apart, rate) ? Real(0) : never;
  const Real square = b * b - squared(rate) * c;
  return square < Real(0) ? never : c / (sqrt(square) - b);
}

/// The same where the point also accelerates, within `horizon`; infinity where it does not touch by then. |apart + rate
/// t + acceleration t^2 / 2|^2 - reach^2 is a polynomial of degree 4, whose roots the Bernstein basis isolates.
template <class Real, int Dim>
[[nodiscard]] Real time_to_touch(const Vector<Real, Dim>& apart, const Vector<Real, Dim>& rate,
                                 const Vector<Real, Dim>& acceleration, const Real& reach, const Real& horizon) {
  constexpr Real never = std::numeric_limits<Real>::infinity();
  const auto gap = [&](const Real& t) {
    return squared(apart + rate * t + acceleration * (t * t / 2)) - reach * reach;
  };
  // Finds a root between the two times by bisection.
  const auto touch_between = [&](Real low, Real high) {
    for (int i = 0; i < 2 * std::numeric_limits<Real>::digits && low < high; ++i) {
      const Real middle = low + (high - low) / 2;
      if (middle == low || middle == high) break;
      (gap(middle) > Real(0) ? low : high) = middle;
    }
    return low;
  };
  if (!(gap(Real(0)) > Real(0))) {
    if (detail::approaches(apart, rate)) return Real(0);
    // At rest on each other, and pressed together.
    const bool parts = detail::approaches(apart, Vector<Real, Dim>(-rate));
    if (!parts && dot(apart, acceleration) < Real(0)) return Real(0);
    // The point recedes and is pulled back, perhaps after so short a flight that rounding hides it. Then the contact is
    // where the point has come as near again. To second order |apart|^2 changes by 2 b t + curve t^2.
    const Real curve = squared(rate) + dot(apart, acceleration);
    if (parts && curve < Real(0)) {
      const Real back = -2 * dot(apart, rate) / curve;
      if (2 * back < horizon && !(gap(2 * back) > Real(0)))
        return gap(back / 2) > Real(0) ? touch_between(back / 2, Real(2 * back)) : back;
    }
  }
  std::array<double, bernstein::count> values{};
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = static_cast<double>(gap(horizon * static_cast<Real>(bernstein::nodes[k])));
  Real found = never;
  bernstein::isolate_sign_changes(bernstein::from_values(values), [&](double from, double to) {
    const Real low = horizon * static_cast<Real>(from), high = horizon * static_cast<Real>(to);
    if (!(gap(low) > gap(high))) return false;  // parts here
    found = touch_between(low, high);
    return true;
  });
  return found;
}

/// The first t >= 0 at which a gap s that changes at speed w and acceleration a closes; infinity where it never does.
/// A gap that is closed already counts where it closes further.
template <class Real>
[[nodiscard]] Real time_to_close(const Real& s, const Real& w, const Real& a) {
  using std::sqrt;
  constexpr Real never = std::numeric_limits<Real>::infinity();
  if (s <= Real(0) && (w < Real(0) || (w == Real(0) && a < Real(0)))) return Real(0);
  const Real square = w * w - 2 * a * s;
  if (a < Real(0)) {  // s + w t + a t^2 / 2 = 0 has a root behind any maximum
    if (square < Real(0)) return Real(0);
    const Real root = sqrt(square);
    return w > Real(0) ? (w + root) / -a : 2 * s / (root - w);
  }
  if (!(w < Real(0)) || square < Real(0)) return never;
  return 2 * s / (sqrt(square) - w);
}

}  // namespace continuo
