// continuo/numerics/root_bracketing.hpp
// A root between two points of opposite sign, enclosed until the two are neighbours in the number format.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

namespace continuo {

/// The enclosure of a change of sign: f has its first sign at `near` and the other at `far`; far >= near or far <=
/// near.
template <class Real>
struct Bracket {
  Real near, far;
};

/// Narrows [near, far], where `beyond(t)` is f(t) with its sign turned so that it is <= 0 at near and > 0 at far, until
/// no number lies strictly between. Zero counts as the near side, so that f has truly changed its sign at `far`.
///
/// Illinois false position with a bisection whenever three steps have not halved the enclosure, so the count of
/// evaluations is bounded by about three times the bits of Real; a smooth f takes eight to twelve.
/// M. Dowell, P. Jarratt, "A modified regula falsi method", BIT 11 (1971); the safeguard is T. J. Dekker's (1969).
///
/// Numbers near zero are denser than values of f, which is then zero over a stretch of them. Secants from such a zero
/// lead to its neighbour, one number at a time: so the end of the stretch is searched in strides that double.
template <class Real, class F>
[[nodiscard]] Bracket<Real> enclose_root(F&& beyond, Real near, Real far, Real value_near, Real value_far) {
  using std::abs, std::max, std::min, std::nextafter;
  int slow = 0, last_side = 0;
  Real width = far - near, stride = 0;
  while (true) {
    const Real middle = near + (far - near) / 2;
    if (middle == near || middle == far) return {near, far};
    Real t = middle;
    if (value_near == 0) {
      stride = stride == 0 ? nextafter(near, far) - near : 2 * stride;
      if (abs(stride) < abs(middle - near)) t = near + stride;
    } else if (slow < 3 && value_far != value_near) {
      t = far - value_far * ((far - near) / (value_far - value_near));
      // A guess that falls on an end is moved to that end's neighbour: this is what closes the enclosure in one go.
      const Real least = min(near, far), greatest = max(near, far);
      if (!(t > least)) t = nextafter(least, greatest);
      if (!(t < greatest)) t = nextafter(greatest, least);
    } else {
      slow = 0;
    }
    const Real value = beyond(t);
    if (value > 0) {
      far = t, value_far = value;
      if (last_side > 0) value_near /= 2;
      last_side = 1;
    } else {
      near = t, value_near = value;
      if (last_side < 0) value_far /= 2;
      last_side = -1;
    }
    slow = abs(far - near) > abs(width) / 2 ? slow + 1 : 0;
    if (slow == 0) width = far - near;
  }
}

}  // namespace continuo
