// The side to which the motion carries a guard that is zero now, for guards of which only values are known.
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/numerics/state.hpp>
#include <continuo/solve/events/event_location.hpp>

namespace continuo {

/// The side to which the motion carries a guard from zero, by its first derivative along the motion that is not zero
/// (to rounding), and the order of that derivative. Side 0: all derivatives up to the third are zero, or none is known.
struct Carried {
  int side = 0;
  int order = 0;
  bool surely = false;  // far beyond rounding

  static constexpr double far_beyond = 1e4;  // roundings
};

/// Three moves of t and of every component by `units` units in the last place, in different directions, since equal
/// relative moves leave a difference of equals unchanged: the largest change of a guard over them is its possible
/// rounding error. `g_at(t, x)` evaluates the guard; `moved` is scratch.
template <class Real, class X, class GuardAt>
void for_each_rounded(Real t, const X& x, X& moved, GuardAt&& g_at, Real units = 4) {
  const Real unit = units * std::numeric_limits<Real>::epsilon();
  for (int pattern = 0; pattern < 3; ++pattern) {
    for (std::size_t k = 0; k < dimension(x); ++k) {
      const bool up = pattern == 0 || (pattern == 1 ? k % 2 == 0 : k % 4 < 2);
      moved.data()[k] = (up ? 1 + unit : 1 - unit) * x.data()[k];
    }
    g_at((pattern == 1 ? 1 - unit : 1 + unit) * t, moved);
  }
}

namespace detail {

/// Finds the side by differences over the ways dt and 2 dt, along the parabola x + s f + s^2/2 f', where f' is a
/// difference of f as well. `first` is f(t, x), g0 the guard there.
template <class Real, class X, class GuardAt, class SlopeAt>
[[nodiscard]] Carried carried_over(Real t, const X& x, Real dt, Real rounding, const X& first, Real g0, X& second,
                                   X& moved, GuardAt& g_at, SlopeAt& slope_at) {
  using std::abs;
  for (std::size_t k = 0; k < dimension(x); ++k) moved.data()[k] = x.data()[k] + dt * first.data()[k];
  slope_at(t + dt, moved, second);
  const auto g_after = [&](Real s) {
    for (std::size_t k = 0; k < dimension(x); ++k)
      moved.data()[k] = x.data()[k] + s * (first.data()[k] + s / (2 * dt) * (second.data()[k] - first.data()[k]));
    return g_at(t + s, moved);
  };
  const Real g1 = g_after(dt), g2 = g_after(2 * dt);
  // Three values determine a parabola: its slope times dt and its second derivative times dt^2 at s = 0.
  const Real slope = (4 * g1 - g2 - 3 * g0) / 2, bend = g0 - 2 * g1 + g2;
  // The third derivative is not evaluated; over so short a way its part stays below a thousandth of that of the second.
  if (abs(slope) > 8 * rounding && abs(slope) > abs(bend) / 1000)
    return {sign_of(slope), 1, abs(slope) > Real(Carried::far_beyond) * rounding};
  if (abs(bend) > 8 * rounding) return {sign_of(bend), 2, false};
  return {};
}

}  // namespace detail

/// Finds the side by differences. `length` is how far the motion may be followed: less than the flight to the next
/// event. The shortest way over which g changes far beyond its `rounding` counts: over a longer one it may have turned.
/// g_at(t, x) is the guard, g0 its value at (t, x), slope_at(t, x, out) writes x'; first, second and moved are scratch.
template <class Real, class X, class GuardAt, class SlopeAt>
[[nodiscard]] Carried carried_by_differences(Real t, const X& x, Real g0, Real length, Real rounding, X& first,
                                             X& second, X& moved, GuardAt&& g_at, SlopeAt&& slope_at) {
  slope_at(t, x, first);
  Carried way;
  for (const double part : {1e-8, 1e-6, 1e-4, 1e-2}) {
    way = detail::carried_over(t, x, length * Real(part), rounding, first, g0, second, moved, g_at, slope_at);
    if (way.surely) return way;
  }
  return way;
}

}  // namespace continuo
