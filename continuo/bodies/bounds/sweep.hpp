// A box that moves along a straight way, or a point, whose way is a ray; and when it enters bounds (T. L. Kay, J. T.
// Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986: the bounds are grown by the box, which becomes a point, and are
// the intersection of slabs).
//
//   const BoxSweep<double, 3> ray{.begin = {x, x}, .way = direction, .end = infinity};
#pragma once
#include <algorithm>
#include <array>
#include <bit>
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

/// Four bounds whose slabs are compared together, and numbers of what they bound. Bounds that are not set are empty.
template <class Real, int Dim>
struct SweptNode {
  static constexpr std::size_t lanes = 4;
  // Registers that every machine has.
  using Register [[gnu::vector_size(16)]] = Real;
  static constexpr std::size_t parts = lanes * sizeof(Real) / sizeof(Register), width = lanes / parts;
  struct Part {
    Register numbers;
  };

  std::array<std::array<std::array<Part, parts>, 2>, static_cast<std::size_t>(Dim)> bounds{};  // lower, upper
  std::array<std::uint32_t, lanes> children{};

  SweptNode() {
    for (std::size_t lane = 0; lane < lanes; ++lane) set(lane, {});
  }
  void set(std::size_t lane, const Bounds<Real, Dim>& box) {
    for (std::size_t axis = 0; axis < bounds.size(); ++axis) {
      bounds[axis][0][lane / width].numbers[lane % width] = box.lower[axis];
      bounds[axis][1][lane / width].numbers[lane % width] = box.upper[axis];
    }
  }
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
      is_forward_[axis] = way > Real(0);
      near_from_[axis] = is_forward_[axis] ? begin_.upper[axis] : begin_.lower[axis];
      far_from_[axis] = is_forward_[axis] ? begin_.lower[axis] : begin_.upper[axis];
      // The inverse of a subnormal number overflows. What is not finite decides nothing, beyond that empty bounds are
      // not met.
      inverse_[axis] = Real(1) / way;
      is_decided_[axis] = inverse_[axis] - inverse_[axis] == Real(0);
    }
  }

  /// The fraction at which the box enters `bounds`, to rounding; infinity if it does not before `end`, or if `bounds`
  /// are empty.
  [[nodiscard]] Real entry(const Bounds<Real, Dim>& bounds, const Real& end) const {
    constexpr Real never = std::numeric_limits<Real>::infinity();
    Real from(0), to = end;
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      const Real lower = bounds.lower[axis], upper = bounds.upper[axis];
      if (is_missed(lower, upper, axis)) return never;
      if (!is_decided_[axis]) continue;
      const Real near = ((is_forward_[axis] ? lower : upper) - near_from_[axis]) * inverse_[axis];
      const Real far = ((is_forward_[axis] ? upper : lower) - far_from_[axis]) * inverse_[axis];
      if (near > from) from = near;
      if (far < to) to = far;
    }
    return is_beyond(from, to) ? never : std::min(from, std::numeric_limits<Real>::max());
  }

  /// The same of four bounds, in lanes.
  [[nodiscard]] std::array<Real, SweptNode<Real, Dim>::lanes> entries(const SweptNode<Real, Dim>& node,
                                                                      const Real& end) const {
    using Node = SweptNode<Real, Dim>;
    using Register = typename Node::Register;
    constexpr Real most = std::numeric_limits<Real>::max(), never = std::numeric_limits<Real>::infinity();
    std::array<typename Node::Part, Node::parts> entered;
    for (std::size_t part = 0; part < Node::parts; ++part) {
      Register from{}, to = Register{} + end;
      for (std::size_t axis = 0; axis < V::size(); ++axis) {
        const Register lower = node.bounds[axis][0][part].numbers, upper = node.bounds[axis][1][part].numbers;
        if (is_decided_[axis]) {
          const Register near = ((is_forward_[axis] ? lower : upper) - near_from_[axis]) * inverse_[axis];
          const Register far = ((is_forward_[axis] ? upper : lower) - far_from_[axis]) * inverse_[axis];
          from = near > from ? near : from;
          to = far < to ? far : to;
        } else {
          for (std::size_t k = 0; k < Node::width; ++k)
            if (is_missed(lower[k], upper[k], axis)) to[k] = -never;
        }
      }
      from = from < most ? from : Register{} + most;
      entered[part].numbers = from > with_rounding(to) ? Register{} + never : from;
    }
    return std::bit_cast<std::array<Real, Node::lanes>>(entered);
  }

  /// Whether a fraction is above another by more than rounding: a difference, an inverse and a product, of half a unit
  /// in the last place each, on both sides.
  [[nodiscard]] static bool is_beyond(const Real& fraction, const Real& end) { return fraction > with_rounding(end); }

 private:
  using V = Vector<Real, Dim>;
  template <class Number>
  [[nodiscard]] static Number with_rounding(const Number& end) {
    return end + (end * (8 * std::numeric_limits<Real>::epsilon()) + std::numeric_limits<Real>::min());
  }
  /// Whether bounds are empty, or beside a box that does not move along this axis.
  [[nodiscard]] bool is_missed(const Real& lower, const Real& upper, std::size_t axis) const {
    if (!is_still_[axis]) return lower > upper;
    return lower - begin_.upper[axis] > Real(0) || upper - begin_.lower[axis] < Real(0);
  }

  Bounds<Real, Dim> begin_;
  V inverse_{};                 // of the way
  V near_from_{}, far_from_{};  // the corners of the box that meet the nearer and the farther bounds
  std::array<bool, V::size()> is_still_{}, is_forward_{}, is_decided_{};
};

}  // namespace continuo
