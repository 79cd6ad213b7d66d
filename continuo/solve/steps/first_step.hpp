// continuo/solve/steps/first_step.hpp
// The size of the first step. E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", II.4.
#pragma once
#include <algorithm>
#include <cmath>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// A step whose explicit Euler increment and second derivative are small against the tolerance, never longer than
/// `longest`. f0 = f(t, x); forward is +1 or -1; f1 and x1 are scratch. One evaluation.
template <State X, class System>
[[nodiscard]] Scalar<X> first_step(System& system, Scalar<X> t, const X& x, const X& f0, int order, Scalar<X> forward,
                                   Scalar<X> longest, const Tolerance<Scalar<X>>& tolerance, X& x1, X& f1) {
  using std::max, std::min, std::pow;
  using Real = Scalar<X>;
  const Real size = weighted_norm(x, x, x, tolerance), slope = weighted_norm(f0, x, x, tolerance);
  Real h0 = size < Real(1e-5) || slope < Real(1e-5) ? Real(1e-6) : Real(0.01) * size / slope;
  h0 = min(h0, longest);
  for (std::size_t i = 0; i < dimension(x); ++i) x1.data()[i] = x.data()[i] + forward * h0 * f0.data()[i];
  evaluate(system, t + forward * h0, x1, f1);
  for (std::size_t i = 0; i < dimension(x); ++i) f1.data()[i] -= f0.data()[i];
  const Real bend = weighted_norm(f1, x, x, tolerance) / h0;
  const Real steepest = max(slope, bend);
  Real h1 = steepest <= Real(1e-15) ? max(Real(1e-6), h0 * Real(1e-3))
                                    : pow(Real(0.01) / steepest, Real(1) / Real(order + 1));
  if (!(h1 > 0)) h1 = h0 * Real(1e-3);  // f is not finite nearby: begin small, and leave the rest to step control
  return min(min(100 * h0, h1), longest);
}

}  // namespace continuo
