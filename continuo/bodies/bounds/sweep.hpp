// A box that moves along a straight way, or a point, whose way is a ray; and when it enters bounds (T. L. Kay, J. T.
// Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986: the bounds are grown by the box, which becomes a point, and are
// the intersection of slabs).
//
//   const BoxSweep<double, 3> ray{.begin = {x, x}, .way = direction, .end = infinity};
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
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
      has_still_ = has_still_ || is_still_[axis];
      // The inverse of a subnormal number overflows. What is not finite decides nothing below, as NaN.
      inverse_[axis] = Real(1) / way;
      if (!(inverse_[axis] - inverse_[axis] == Real(0))) inverse_[axis] = std::numeric_limits<Real>::quiet_NaN();
      is_backward_[axis] = inverse_[axis] < Real(0) ? 1 : 0;
      leading_[axis] = is_backward_[axis] != 0 ? begin_.lower[axis] : begin_.upper[axis];
      trailing_[axis] = is_backward_[axis] != 0 ? begin_.upper[axis] : begin_.lower[axis];
    }
  }

  /// The fraction at which the box enters `bounds`, to rounding; infinity if it does not before `end`, or if `bounds`
  /// are empty. Without branches that depend on the bounds: they would be unpredictable.
  [[nodiscard]] Real entry(const Bounds<Real, Dim>& bounds, const Real& end) const {
    constexpr Real never = std::numeric_limits<Real>::infinity();
    const std::array<const V*, 2> corners{&bounds.lower, &bounds.upper};
    Real from(0), to = end;
    bool is_missed = false;
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      const Real near = ((*corners[is_backward_[axis]])[axis] - leading_[axis]) * inverse_[axis];
      const Real far = ((*corners[1 - is_backward_[axis]])[axis] - trailing_[axis]) * inverse_[axis];
      from = near > from ? near : from;  // no comparison holds for a NaN
      to = far < to ? far : to;
      is_missed |= bounds.lower[axis] > bounds.upper[axis];
    }
    if (has_still_) is_missed |= is_beside(bounds);
    return is_missed || is_beyond(from, to) ? never : std::min(from, std::numeric_limits<Real>::max());
  }

  /// Whether a fraction is above another by more than rounding: a difference, an inverse and a product, of half a unit
  /// in the last place each, on both sides.
  [[nodiscard]] static bool is_beyond(const Real& fraction, const Real& end) {
    return fraction > end + (8 * std::numeric_limits<Real>::epsilon() * end + std::numeric_limits<Real>::min());
  }

 private:
  using V = Vector<Real, Dim>;
  /// Whether the box does not overlap bounds along an axis on which it does not move.
  [[nodiscard]] bool is_beside(const Bounds<Real, Dim>& bounds) const {
    for (std::size_t axis = 0; axis < V::size(); ++axis)
      if (is_still_[axis] &&
          (bounds.lower[axis] - begin_.upper[axis] > Real(0) || bounds.upper[axis] - begin_.lower[axis] < Real(0)))
        return true;
    return false;
  }

  Bounds<Real, Dim> begin_;
  V inverse_{};                                        // of the way
  V leading_{}, trailing_{};                           // sides of the box, along the way
  std::array<std::uint8_t, V::size()> is_backward_{};  // 0 or 1
  std::array<bool, V::size()> is_still_{};
  bool has_still_ = false;
};

}  // namespace continuo
