// continuo/methods/support/stiffness_watch.hpp
// Is it stiffness, not what the solution does, that holds the steps of an explicit method? The dominant eigenvalue of
// df/dx is followed by a power iteration on differences of f, one evaluation a probe, a few steps apart: the direction
// found so far is carried along the trajectory. E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II",
// IV.2, tests h |lambda| at the boundary of the stability region; the iteration is the one of B. P. Sommeijer, L. F.
// Shampine, J. G. Verwer, "RKC", J. Comput. Appl. Math. 88 (1998).
//
// With a strict tolerance that test comes too late: a method of high order then steps well inside its region, and yet
// by the clock of lambda, for its error has terms such as (h lambda)^k h^2 x''. What counts there is that the solution
// itself is much slower than lambda: |x''| << |lambda| |x'|, with x'' from one more evaluation. The same shows a fast
// oscillation, of eigenvalues on the imaginary axis, that could happen and does not, or only about as far as the
// tolerance lets it, which is what it comes to by rounding where steps are as long as stability allows: what moves with
// lambda in x is |x''| / |lambda|^2 at most.
//
// Which of the two it is, decay or oscillation, is in the square of df/dx: its Rayleigh quotient along the direction of
// the iteration is Re(lambda^2), positive for a decay and negative for an oscillation, whose own df/dx turns a
// direction by a right angle or, where positions and velocities are measured in different units, by anything.
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

  explicit StiffnessWatch(const X& x) : direction_(x), moved_(x), slope_(x), before_(x) {}

  /// One evaluation of f at a distance of about one tolerance from x, where f(t, x) = fx; the direction is turned
  /// towards the dominant one.
  template <class System>
  void probe(System& system, const Real& t, const X& x, const X& fx, const Tolerance<Real>& tolerance) {
    using std::abs, std::max, std::sqrt;
    const std::size_t n = dimension(x);
    const auto size = [&](std::size_t i) { return tolerance.scale(i, x.data()[i], x.data()[i]); };
    if (!begun_) {
      // Not along an axis, nor along f: both may be invariant.
      for (std::size_t i = 0; i < n; ++i) direction_.data()[i] = size(i) * spread(i);
      begun_ = true;
    }
    // So many tolerances that the difference stands out of rounding, of all components the same number: weights that
    // change with the phase of an oscillation make it seem to grow.
    Real length(0), tolerances(1);
    for (std::size_t i = 0; i < n; ++i) {
      length += squared(direction_.data()[i] / size(i));
      tolerances = max(tolerances, sqrt(std::numeric_limits<Real>::epsilon()) * abs(x.data()[i]) / size(i));
    }
    length = sqrt(length / Real(static_cast<double>(n))) / tolerances;
    if (!(length > 0) || !(length < std::numeric_limits<Real>::infinity())) {
      begun_ = false;
      growth_ = Real(0);
      return;
    }
    for (std::size_t i = 0; i < n; ++i) moved_.data()[i] = x.data()[i] + direction_.data()[i] / length;
    evaluate(system, t, moved_, slope_);
    Real product(0), square(0), grown(0), turned(0);
    for (std::size_t i = 0; i < n; ++i) {
      const Real step = moved_.data()[i] - x.data()[i], change = slope_.data()[i] - fx.data()[i];
      const Real weight = Real(1) / squared(size(i));
      product += weight * step * change;
      square += weight * step * step;
      grown += weight * change * change;
      turned += weight * before_.data()[i] * change;
      direction_.data()[i] = change;
      before_.data()[i] = step;
    }
    if (!(square > 0)) return;
    // With the direction before this one of the same length, of which df/dx has made this one times `length`.
    turn_ = growth_ > 0 ? length * turned / square : Real(0);
    // Twice df/dx: of a position and its velocity each grows alone by what the other is, by 1 and by lambda^2.
    const Real growth = sqrt(grown / square);
    radius_ = growth_ > 0 ? sqrt(growth * growth_) : growth;
    growth_ = growth;
    real_part_ = product / square;
  }

  /// For checkpoints: what the next probe depends on.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(direction_, before_, growth_, radius_, real_part_, turn_, begun_);
  }

  /// |lambda| and Re(lambda) of the dominant eigenvalue, as far as the iteration has come.
  [[nodiscard]] Real radius() const { return radius_; }
  [[nodiscard]] Real real_part() const { return real_part_; }
  /// Whether it is nearer to the imaginary axis than to the real one.
  [[nodiscard]] bool oscillates() const { return turn_ < Real(-0.3) * squared(radius_); }

  /// Whether stiffness holds a step of this size, as of the last probe, which was made here; an oscillation that is
  /// below so many tolerances is none. Adds to `evaluations`.
  template <class System>
  [[nodiscard]] bool holds(System& system, const Real& t, const X& x, const X& fx, const Real& h,
                           const Tolerance<Real>& tolerance, int& evaluations, double unseen = unseen_by_default) {
    if (bounds(h)) return true;
    using std::abs;
    if (!(radius_ * abs(h) > Real(felt))) return false;
    ++evaluations;
    return follows_slow_solution(system, t, x, fx, h, tolerance, Real(unseen));
  }

  /// Whether a step h is at the boundary of an explicit method's stability region, on the side where solutions decay:
  /// the regions of the methods here reach from about 2 to 6 along the negative axis.
  [[nodiscard]] bool bounds(const Real& h) const {
    using std::abs;
    return radius_ * abs(h) > 1 && !oscillates() && real_part_ * (h < 0 ? Real(-1) : Real(1)) < Real(-0.7) * growth_;
  }

 private:
  // From this h |lambda| on, lambda can be what a step goes by. A stiff method costs some ten times as much a step, and
  // takes steps of about a third of the solution's own time.
  static constexpr double felt = 0.1, much_slower = 30;
  static constexpr double unseen_by_default = 10;  // tolerances

  // x'' by a difference along the solution, so short that it does not leave it as seen by lambda.
  template <class System>
  [[nodiscard]] bool follows_slow_solution(System& system, const Real& t, const X& x, const X& fx, const Real& h,
                                           const Tolerance<Real>& tolerance, const Real& unseen) {
    using std::max;
    const Real apart = (h < 0 ? Real(-felt) : Real(felt)) / radius_;
    const std::size_t n = dimension(x);
    for (std::size_t i = 0; i < n; ++i) moved_.data()[i] = x.data()[i] + apart * fx.data()[i];
    evaluate(system, t + apart, moved_, slope_);
    Real bend(0), slope(0), greatest(0);  // squares of |x''| and |x'|, in tolerances
    for (std::size_t i = 0; i < n; ++i) {
      const Real size = size_of(x.data()[i], i, tolerance);
      const Real part = squared((slope_.data()[i] - fx.data()[i]) / (apart * size));
      bend += part / Real(static_cast<double>(n));
      greatest = max(greatest, part);
      slope += squared(fx.data()[i] / size) / Real(static_cast<double>(n));
    }
    // A method that damps at infinity would damp an oscillation as well: it must not be there to be seen.
    const Real square = squared(radius_);
    if (oscillates()) return greatest < squared(unseen * square);
    return squared(Real(much_slower)) * bend < square * slope || bend < squared(Real(unseen_by_default) * square);
  }

  [[nodiscard]] static Real squared(const Real& x) { return x * x; }
  [[nodiscard]] static Real spread(std::size_t i) {
    return (i % 2 ? Real(-1) : Real(1)) * (Real(1) + Real(static_cast<double>(i % 7)) / Real(7));
  }
  // A tolerance, but enough for the difference to stand out of rounding.
  [[nodiscard]] static Real size_of(const Real& x, std::size_t i, const Tolerance<Real>& tolerance) {
    using std::abs, std::max, std::sqrt;
    return max(tolerance.scale(i, x, x), sqrt(std::numeric_limits<Real>::epsilon()) * abs(x));
  }

  X direction_, moved_, slope_, before_;
  Real growth_{}, radius_{}, real_part_{}, turn_{};
  bool begun_ = false;
};

}  // namespace continuo
