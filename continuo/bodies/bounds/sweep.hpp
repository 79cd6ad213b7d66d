// A box that moves along a straight way, or a point, whose way is a ray; and when it enters bounds (T. L. Kay, J. T.
// Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986: the bounds are grown by the box, which becomes a point, and are
// the intersection of slabs).
//
//   const BoxSweep<double, 3> ray{.begin = {x, x}, .way = direction, .end = infinity};
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include <continuo/bodies/bounds/bounds.hpp>
#include <continuo/numerics/vector.hpp>

namespace continuo {

/// A box that moves by `way` times a fraction that grows from 0 to `end`. A ray is the sweep of a point.
template <class Real, int Dim>
struct BoxSweep {
  Bounds<Real, Dim> begin{};        // the box before it moves
  Vector<Real, Dim> way{};          // may be 0
  Real end = static_cast<Real>(1);  // the greatest fraction; infinity for a ray without end
};

/// The slabs of a sweep, prepared for many bounds. Where rounding, overflow or a NaN leave undecided whether bounds are
/// hit, they are.
template <class Real, int Dim>
class SweepSlabs {
 public:
  /// Prepares a sweep.
  explicit SweepSlabs(const BoxSweep<Real, Dim>& sweep) : begin_(sweep.begin) {
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      const Real way = sweep.way[axis];
      is_still_[axis] = way == Real(0);
      // The inverse of a subnormal number overflows. What is not finite decides nothing below, as NaN.
      inverse_[axis] = Real(1) / way;
      if (!(inverse_[axis] - inverse_[axis] == Real(0))) inverse_[axis] = std::numeric_limits<Real>::quiet_NaN();
    }
  }

  /// The fraction at which the box enters `bounds`, to rounding; infinity if it does not before `end`, or if `bounds`
  /// are empty.
  [[nodiscard]] Real entry(const Bounds<Real, Dim>& bounds, const Real& end) const {
    constexpr Real never = std::numeric_limits<Real>::infinity();
    Real from(0), to = end;
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      const Real lower = bounds.lower[axis] - begin_.upper[axis], upper = bounds.upper[axis] - begin_.lower[axis];
      if (is_still_[axis] ? lower > Real(0) || upper < Real(0) : bounds.lower[axis] > bounds.upper[axis]) return never;
      if (is_still_[axis]) continue;
      const bool is_forward = inverse_[axis] >= Real(0);
      const Real near = (is_forward ? lower : upper) * inverse_[axis];
      const Real far = (is_forward ? upper : lower) * inverse_[axis];
      if (near > from) from = near;
      if (far < to) to = far;
    }
    return is_beyond(from, to) ? never : std::min(from, std::numeric_limits<Real>::max());
  }

  /// Whether a fraction is above another by more than rounding: a difference, an inverse and a product, of half a unit
  /// in the last place each, on both sides.
  [[nodiscard]] static bool is_beyond(const Real& fraction, const Real& end) {
    return fraction > end + (8 * std::numeric_limits<Real>::epsilon() * end + std::numeric_limits<Real>::min());
  }

 private:
  using V = Vector<Real, Dim>;
  Bounds<Real, Dim> begin_;
  V inverse_{};  // of the way
  std::array<bool, V::size()> is_still_{};
};

}  // namespace continuo
