// df/dt where a run begins, for the slope of the unknowns of algebraic equations there.
#pragma once
#include <cmath>
#include <limits>

#include <continuo/methods/method.hpp>
#include <continuo/system/jacobian.hpp>
#include <continuo/system/system.hpp>

namespace continuo::detail {

template <class Real>
[[nodiscard]] Real sqrt_of_epsilon() {
  using std::sqrt;
  return sqrt(std::numeric_limits<Real>::epsilon());
}

/// df/dt; of a difference with a length that h says more of than t: near t = 0 the other would be so short that
/// rounding is all there is to see. Returns the number of evaluations.
template <class System, State X>
[[nodiscard]] int slope_in_time(System& system, const Scalar<X>& t, const Scalar<X>& h, const X& x, const X& fx,
                                X& dfdt) {
  using Real = Scalar<X>;
  using std::abs;
  if constexpr (HasTimeDerivative<System, X>) {
    system.time_derivative(t, x, dfdt);
    keep_size(x, dfdt);
    return 0;
  } else {
    const Real scale = Real(0.01) * abs(h) / sqrt_of_epsilon<Real>();
    return evaluate_time_derivative(system, t, abs(t) < scale ? (h < 0 ? -scale : scale) : h, x, fx, dfdt);
  }
}

}  // namespace continuo::detail
