// How far below the tolerance the error of one step must stay for the error at the end to be in proportion to the
// tolerance.
//
// Over a time T there are T / h steps. Errors C h^(p+1) of each add up to T C h^p, which follows the tolerance where
// h ~ tolerance^(1/p). An estimate of order m, ~ h^m, is then ~ tolerance^(m/p): the tolerance times
// tolerance^((m-p)/p). That is the tolerance itself where an estimate of order m = p steers the result of order p
// (local extrapolation). Where the estimate is that of the error of the step, m = p + 1, it must stay the further below
// the stricter the tolerance is; so must what an iteration leaves behind in each step.
//
// L. F. Shampine, "Tolerance proportionality in ODE codes", Lecture Notes in Mathematics 1386 (1989) 118-136; G.
// Soderlind, L. Wang, "Adaptive time-stepping and computational stability", J. Comput. Appl. Math. 185 (2006) 225-243.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/methods/method.hpp>

namespace continuo {

/// The tolerance as one number: the relative one, or the absolute one where that is greater.
template <class Real>
[[nodiscard]] Real tolerance_as_number(const Tolerance<Real>& tolerance) {
  using std::max;
  const Real rtol = tolerance.rtol_each ? tolerance.rtol_each[0] : tolerance.rtol;
  const Real atol = tolerance.atol_each ? tolerance.atol_each[0] : tolerance.atol;
  return max(max(rtol, atol), std::numeric_limits<Real>::epsilon());
}

/// The relative tolerance as one number, that of the first component, but not below rounding.
template <class Real>
[[nodiscard]] Real relative_as_number(const Tolerance<Real>& tolerance) {
  using std::max;
  return max(tolerance.rtol_each ? tolerance.rtol_each[0] : tolerance.rtol, std::numeric_limits<Real>::epsilon());
}

/// By how much an error of order m of one step is held below the tolerance, in a method of order p. That many errors
/// may add up as `spare` says before it is above 1. Not below rounding, though: no step, however short, gets there.
template <class Real>
[[nodiscard]] Real strictness(const Tolerance<Real>& tolerance, int p, int m, double spare = 1) {
  using std::max, std::min, std::pow;
  if (m <= p) return Real(1);
  const Real exponent = Real(p - m) / Real(p), asked = tolerance_as_number(tolerance);
  const Real finest = asked / (4 * std::numeric_limits<Real>::epsilon());
  return max(Real(1), min(finest, Real(pow(asked, exponent) / Real(spare))));
}

/// Of one-step methods; what a problem amplifies its errors by comes on top.
inline constexpr double spare_of_one_step = 2;

/// With algebraic equations of index 1 that came of differentiating others, errors of a step drift off those instead of
/// dying out: what is held below the tolerance besides.
inline constexpr double spare_of_constraints = 3;

/// Whether the estimate of a method is that of the error of its own result.
template <class M>
[[nodiscard]] constexpr bool estimates_its_own_error() {
  return M::error_order + 1 > M::order;
}

/// Of the error estimate of a one-step method.
template <class M, class Real>
[[nodiscard]] Real strictness_of(const Tolerance<Real>& tolerance) {
  if constexpr (!estimates_its_own_error<M>()) {
    return Real(1);
  } else {
    return strictness(tolerance, M::order, M::error_order + 1, spare_of_one_step);
  }
}

/// How far an iteration goes, in tolerances: to a hundredth of the error that a step may have, but not beyond rounding.
template <class M, class Real>
[[nodiscard]] Real iteration_target(const Tolerance<Real>& tolerance) {
  using std::max;
  const Real rounding = 10 * std::numeric_limits<Real>::epsilon() / tolerance_as_number(tolerance);
  return max(rounding, Real(1e-2) / strictness(tolerance, M::order, M::order + 1, spare_of_one_step));
}

}  // namespace continuo
