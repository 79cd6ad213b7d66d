// continuo/methods/implicit/newton.hpp
// The simplified Newton iteration of implicit methods: one matrix for all iterations, given up as soon as its rate of
// convergence says that it will not arrive. E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", IV.8.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>

namespace continuo {

/// What one iteration leaves to the next one, of the following step.
template <class Real>
struct NewtonMemory {
  Real remainder = 1;  // theta / (1 - theta) of the last iteration: how much of a correction is still to come
  Real rate = 0;       // theta: the last correction against the one before; near 1 the Jacobian has grown old
  int iterations = 0;  // of the last call
  bool finite = true;  // whether the corrections of the last call were
  // Whether the matrix is known to be good here: by a rate measured near this state, or because it is of here. A matrix
  // that has nothing to do with the equations may let only tiny corrections through, and theta is near 1 or far below
  // by chance: neither says that z is near the solution.
  bool matrix_is_known = true;
  // Whether the rate must be that of this call, not of one before: of algebraic equations what an iteration leaves is
  // not made smaller by a smaller h, and where a diode begins to conduct, the rate of the step before says nothing. An
  // unknown that is off stays off, and no h of the next step meets the tolerance then. Nor is a matrix taken at its
  // word that lets only small corrections through, all of the same size.
  bool measures_anew = false;
  Real rounding = 0;  // then: corrections that may be no more than it, in tolerances

  /// For checkpoints.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(remainder, rate, iterations, finite, matrix_is_known, measures_anew, rounding);
  }

  /// How the equations of a step have ended, after the last call.
  [[nodiscard]] StepStatus status(bool converged) const {
    if (converged) return StepStatus::done;
    return finite ? StepStatus::newton_diverged : StepStatus::not_finite;
  }

  /// Of equations that may be algebraic.
  void measure_anew(const Tolerance<Real>& tolerance) {
    measures_anew = true;
    rounding = 100 * std::numeric_limits<Real>::epsilon() / tolerance_as_number(tolerance);
  }
};

/// Iterates until what is still to come is below `target` (of a norm in which the tolerance is 1). `correct` makes one
/// correction and returns its norm. False where it diverges, or would need more than `most` iterations.
template <class Real, class Correct>
[[nodiscard]] bool newton(NewtonMemory<Real>& memory, const Real& target, int most, Correct&& correct) {
  using std::max, std::min, std::pow;
  const Real epsilon = std::numeric_limits<Real>::epsilon();
  // eq. 8.10': an estimate before the second correction is there.
  Real remainder = pow(max(memory.remainder, epsilon), Real(0.8));
  Real last = 0;
  for (int k = 0; k < most; ++k) {
    memory.iterations = k + 1;
    const Real size = correct();
    memory.finite = size < std::numeric_limits<Real>::infinity();
    if (!memory.finite) return false;
    if (k > 0) {
      const Real rate = size / last;
      memory.rate = rate;
      if (rate >= Real(0.99)) {  // diverging, or down to rounding
        return memory.matrix_is_known && size <= (memory.measures_anew ? min(target, memory.rounding) : target);
      }
      remainder = rate / (1 - rate);
      memory.matrix_is_known = true;
      if (remainder * size * pow(rate, most - 2 - k) > target && k + 1 < most) return false;  // eq. 8.11
    }
    const bool knows_rate = memory.matrix_is_known && (k > 0 || !memory.measures_anew || size <= Real(1e-4) * target);
    if ((knows_rate && remainder * size <= target) || size == 0) {
      memory.remainder = remainder;
      if (k == 0) memory.rate = 0;
      return true;
    }
    last = size;
  }
  return false;
}

/// The least increments for a Jacobian by differences: the error of rounding in f, weighted, stays below a thousandth
/// of 1/h in each column (A. Hindmarsh et al., "SUNDIALS", ACM TOMS 31 (2005), section 2.1, for CVODE). That counts on
/// 1/h, with which an error of J is compared; an algebraic equation has no such term, its column must be right by
/// itself, and rounding is that of its terms, not of their sum f, which is near 0. So with a mass no increment is below
/// that of Hairer & Wanner's RADAU5 for a component that is 0. Where nobody takes differences, nothing is computed.
template <State X>
class LeastIncrements {
 public:
  using Real = Scalar<X>;

  LeastIncrements(const Tolerance<Real>& tolerance, const Real& h, const X& x, const X& fx, bool has_mass)
      : tolerance_(tolerance), x_(x), fx_(fx), h_(h), has_mass_(has_mass) {}

  Real operator()(std::size_t j) const {
    using std::max, std::sqrt;
    if (!(factor_ > 0)) factor_ = factor();
    const Real least = factor_ * scale(j);
    return has_mass_ ? max(least, Real(sqrt(std::numeric_limits<Real>::epsilon() / Real(100000)))) : least;
  }

 private:
  [[nodiscard]] Real scale(std::size_t i) const { return tolerance_.scale(i, x_.data()[i], x_.data()[i]); }
  [[nodiscard]] Real factor() const {
    using std::abs, std::sqrt;
    const std::size_t n = dimension(x_);
    Real sum(0);
    for (std::size_t i = 0; i < n; ++i) {
      const Real part = fx_.data()[i] / scale(i);
      sum += part * part;
    }
    const Real least = 1000 * abs(h_) * std::numeric_limits<Real>::epsilon() * sqrt(Real(n) * sum);
    return least > 0 ? least : Real(1);
  }

  const Tolerance<Real>& tolerance_;
  const X &x_, &fx_;
  const Real h_;
  const bool has_mass_;
  mutable Real factor_{0};
};

}  // namespace continuo
