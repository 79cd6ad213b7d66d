// continuo/methods/support/weighted_norm.hpp
#pragma once
#include <cmath>
#include <cstddef>

#include <continuo/methods/method.hpp>

namespace continuo {

/// Root mean square of part(i) for each i below n; 0 where there is none.
template <class Real, class Part>
[[nodiscard]] Real root_mean_square(std::size_t n, Part&& part) {
  using std::sqrt;
  Real sum(0);
  for (std::size_t i = 0; i < n; ++i) {
    const Real value = part(i);
    sum += value * value;
  }
  return n == 0 ? sum : Real(sqrt(sum / Real(static_cast<double>(n))));
}

/// Root mean square of the components of v against the tolerance between x and x_new.
template <State X>
[[nodiscard]] Scalar<X> weighted_norm(const X& v, const X& x, const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
  return root_mean_square<Scalar<X>>(dimension(v), [&](std::size_t i) {
    return Scalar<X>(v.data()[i] / tolerance.scale_of_step(i, x.data()[i], x_new.data()[i]));
  });
}

namespace detail {

/// The greater one; not a number where one of them is none.
template <class Real>
[[nodiscard]] Real greater(const Real& a, const Real& b) {
  return b <= a ? a : b + (a - a);
}

}  // namespace detail

}  // namespace continuo
