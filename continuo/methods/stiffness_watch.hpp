// continuo/methods/stiffness_watch.hpp
// Is it stability, not accuracy, that bounds the steps of an explicit method? The dominant eigenvalue of df/dx is
// followed by a power iteration on differences of f, one evaluation a probe, a few steps apart: the direction found so
// far is carried along the trajectory. E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", IV.2, tests
// h |lambda| at the boundary of the stability region; the iteration is the one of B. P. Sommeijer, L. F. Shampine, J.
// G. Verwer, "RKC", J. Comput. Appl. Math. 88 (1998).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/methods/method.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

template <State X>
class StiffnessWatch {
 public:
  using Real = Scalar<X>;

  explicit StiffnessWatch(const X& x) : direction_(x), moved_(x), slope_(x) {}

  /// One evaluation of f at a distance of about one tolerance from x, where f(t, x) = fx; the direction is turned
  /// towards the dominant one.
  template <class System>
  void probe(System& system, const Real& t, const X& x, const X& fx, const Tolerance<Real>& tolerance) {
    using std::sqrt;
    const std::size_t n = dimension(x);
    if (!begun_) {
      // Not along an axis, nor along f: both may be invariant.
      for (std::size_t i = 0; i < n; ++i) direction_.data()[i] = size_of(x.data()[i], i, tolerance) * spread(i);
      begun_ = true;
    }
    Real length(0);
    for (std::size_t i = 0; i < n; ++i) length += squared(direction_.data()[i] / size_of(x.data()[i], i, tolerance));
    length = sqrt(length / Real(static_cast<double>(n)));
    if (!(length > 0) || !(length < std::numeric_limits<Real>::infinity())) {
      begun_ = false;
      return;
    }
    for (std::size_t i = 0; i < n; ++i) moved_.data()[i] = x.data()[i] + direction_.data()[i] / length;
    evaluate(system, t, moved_, slope_);
    Real product(0), square(0), grown(0);
    for (std::size_t i = 0; i < n; ++i) {
      const Real step = moved_.data()[i] - x.data()[i], change = slope_.data()[i] - fx.data()[i];
      const Real weight = Real(1) / squared(size_of(x.data()[i], i, tolerance));
      product += weight * step * change;
      square += weight * step * step;
      grown += weight * change * change;
      direction_.data()[i] = change;
    }
    if (!(square > 0)) return;
    radius_ = sqrt(grown / square);
    real_part_ = product / square;
  }

  /// |lambda| and Re(lambda) of the dominant eigenvalue, as far as the iteration has come.
  Real radius() const { return radius_; }
  Real real_part() const { return real_part_; }

  /// Whether a step h is at the boundary of an explicit method's stability region, on the side where solutions decay:
  /// the regions of the methods here reach from about 2 to 6 along the negative axis.
  bool bounds(const Real& h) const {
    using std::abs;
    return radius_ * abs(h) > 1 && real_part_ * (h < 0 ? Real(-1) : Real(1)) < Real(-0.7) * radius_;
  }

 private:
  static Real squared(const Real& x) { return x * x; }
  static Real spread(std::size_t i) {
    return (i % 2 ? Real(-1) : Real(1)) * (Real(1) + Real(static_cast<double>(i % 7)) / Real(7));
  }
  // A tolerance, but enough for the difference to stand out of rounding.
  static Real size_of(const Real& x, std::size_t i, const Tolerance<Real>& tolerance) {
    using std::abs, std::max, std::sqrt;
    return max(tolerance.scale(i, x, x), sqrt(std::numeric_limits<Real>::epsilon()) * abs(x));
  }

  X direction_, moved_, slope_;
  Real radius_{}, real_part_{};
  bool begun_ = false;
};

}  // namespace continuo
