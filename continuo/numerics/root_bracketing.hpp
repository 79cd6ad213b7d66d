// continuo/numerics/root_bracketing.hpp
// A root between two points of opposite sign, enclosed until the two are neighbours in the number format.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace continuo {

/// The enclosure of a change of sign: f has its first sign at `near` and the other at `far`; far >= near or far <=
/// near.
template <class Real>
struct Bracket {
  Real near, far;
};

namespace bracketing {

/// A place and the value of f there.
template <class Real>
struct Point {
  Real t, value;
};

/// Where the parabola t(value) through three points has the value 0, if it has one between the first two: f has to be
/// monotone over the three, the last beyond one of the others.
template <class Real>
[[nodiscard]] std::optional<Real> inverse_quadratic(const Point<Real>& near, const Point<Real>& far,
                                                    const Point<Real>& last) {
  if (!(last.value < near.value || last.value > far.value)) return std::nullopt;
  const Real first = (far.t - near.t) / (far.value - near.value),
             second = (last.t - near.t) / (last.value - near.value);
  const Real t = near.t - near.value * first + near.value * far.value * ((second - first) / (last.value - far.value));
  const bool is_between = t > std::min(near.t, far.t) && t < std::max(near.t, far.t);
  return is_between ? std::optional<Real>(t) : std::nullopt;
}

}  // namespace bracketing

/// Narrows [near, far], where `beyond(t)` is f(t) with its sign turned so that it is <= 0 at near and > 0 at far, until
/// no number lies strictly between. Zero counts as the near side, so that f has truly changed its sign at `far`.
///
/// Inverse quadratic interpolation by both ends and the end before; where it has come to one side twice, the next place
/// is as far behind the guess as that end is before it, so that both ends close in. Where the values are not monotone,
/// Illinois false position. A bisection whenever three steps have not halved the enclosure bounds the count of
/// evaluations by about three times the bits of Real; a smooth f takes some ten.
/// R. P. Brent, "Algorithms for Minimization without Derivatives" (1973), chapter 4; M. Dowell, P. Jarratt, "A modified
/// regula falsi method", BIT 11 (1971); the safeguard is T. J. Dekker's (1969).
///
/// Numbers near zero are denser than values of f, which is then zero over a stretch of them. Secants from such a zero
/// lead to its neighbour, one number at a time: so the end of the stretch is searched in strides that double.
template <class Real, class F>
[[nodiscard]] Bracket<Real> enclose_root(F&& beyond, Real near_t, Real far_t, Real value_near, Real value_far) {
  using std::abs, std::max, std::min, std::nextafter;
  bracketing::Point<Real> near{near_t, value_near}, far{far_t, value_far};
  bracketing::Point<Real> last{near_t, std::numeric_limits<Real>::quiet_NaN()};
  int slow = 0, side = 0;  // of the last place
  Real width = far_t - near_t, stride = 0, stale = 1;
  while (true) {
    const Real middle = near.t + (far.t - near.t) / 2;
    if (middle == near.t || middle == far.t) return {near.t, far.t};
    Real t = middle;
    if (near.value == 0) {
      stride = stride == 0 ? 2 * (nextafter(near.t, far.t) - near.t) : 2 * stride;
      if (abs(stride) < abs(middle - near.t)) t = near.t + stride;
    } else if (slow < 3) {
      if (const std::optional<Real> guess = bracketing::inverse_quadratic(near, far, last)) {
        t = stale == 1 ? *guess : *guess + (*guess - (side > 0 ? far.t : near.t));
      } else {
        const Real f_near = side > 0 ? stale * near.value : near.value,
                   f_far = side < 0 ? stale * far.value : far.value;
        t = far.t - f_far * ((far.t - near.t) / (f_far - f_near));
      }
      // A guess that falls on an end is moved to that end's neighbour: this is what closes the enclosure in one go.
      const Real least = min(near.t, far.t), greatest = max(near.t, far.t);
      if (!(t > least)) t = nextafter(least, greatest);
      if (!(t < greatest)) t = nextafter(greatest, least);
    } else {
      slow = 0;
    }
    const bracketing::Point<Real> here{t, beyond(t)};
    const int now = here.value > 0 ? 1 : -1;
    last = std::exchange(now > 0 ? far : near, here);
    stale = now == side ? stale / 2 : Real(1);
    side = now;
    slow = abs(far.t - near.t) > abs(width) / 2 ? slow + 1 : 0;
    if (slow == 0) width = far.t - near.t;
  }
}

}  // namespace continuo
