// continuo/methods/support/weighted_norm.hpp
#pragma once
#include <cmath>
#include <cstddef>

#include <continuo/methods/method.hpp>

namespace continuo {

/// Root mean square of the components of v against the tolerance between x and x_new.
template <State X>
Scalar<X> weighted_norm(const X& v, const X& x, const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
  using std::sqrt;
  Scalar<X> sum(0);
  const std::size_t n = dimension(v);
  for (std::size_t i = 0; i < n; ++i) {
    const Scalar<X> part = v.data()[i] / tolerance.scale_of_step(i, x.data()[i], x_new.data()[i]);
    sum += part * part;
  }
  return n == 0 ? sum : sqrt(sum / Scalar<X>(static_cast<double>(n)));
}

namespace detail {

/// The greater one; not a number where one of them is none.
template <class Real>
Real greater(const Real& a, const Real& b) {
  return b <= a ? a : b + (a - a);
}

}  // namespace detail

}  // namespace continuo
