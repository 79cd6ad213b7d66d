// continuo/solve/steps/first_step.hpp
// The size of the first step. E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", II.4.
#pragma once
#include <algorithm>
#include <cmath>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

namespace detail {

struct Power {
  template <class Real>
  [[nodiscard]] Real operator()(const Real& base, const Real& exponent) const {
    using std::pow;
    return pow(base, exponent);
  }
};
struct Choose {
  template <class Real>
  [[nodiscard]] Real operator()(bool condition, const Real& yes, const Real& no) const {
    return condition ? yes : no;
  }
};

}  // namespace detail

/// A step whose explicit Euler increment and second derivative are small against the tolerance, never longer than
/// `longest`. f0 = f(t, x); forward is +1 or -1; f1 and x1 are scratch. One evaluation. For lanes of numbers, which
/// have no `if`, `choose(condition, yes, no)` and `power(base, exponent)` are given.
template <State X, class System, class PowerOf = detail::Power, class ChoiceOf = detail::Choose>
[[nodiscard]] Scalar<X> first_step(System& system, const Scalar<X>& t, const X& x, const X& f0, int order,
                                   const Scalar<X>& forward, const Scalar<X>& longest,
                                   const Tolerance<Scalar<X>>& tolerance, X& x1, X& f1, PowerOf power = {},
                                   ChoiceOf choose = {}) {
  using std::max, std::min;
  using Real = Scalar<X>;
  const Real size = weighted_norm(x, x, x, tolerance), slope = weighted_norm(f0, x, x, tolerance);
  const auto is_small = (size < Real(1e-5)) | (slope < Real(1e-5));
  const Real h0 = min(choose(is_small, Real(1e-6), Real(Real(0.01) * size / slope)), longest);
  for (std::size_t i = 0; i < dimension(x); ++i) x1.data()[i] = x.data()[i] + forward * h0 * f0.data()[i];
  evaluate(system, t + forward * h0, x1, f1);
  for (std::size_t i = 0; i < dimension(x); ++i) f1.data()[i] -= f0.data()[i];
  const Real bend = weighted_norm(f1, x, x, tolerance) / h0;
  const Real steepest = max(slope, bend);
  const Real by_bend = power(Real(Real(0.01) / steepest), Real(Real(1.0) / Real(static_cast<double>(order + 1))));
  const Real h1 = choose(steepest <= Real(1e-15), max(Real(1e-6), Real(h0 * Real(1e-3))), by_bend);
  // Where h1 is not above zero, f is not finite nearby: begin small, and leave the rest to step control.
  return min(min(Real(Real(100.0) * h0), choose(h1 > Real(0.0), h1, Real(h0 * Real(1e-3)))), longest);
}

}  // namespace continuo
