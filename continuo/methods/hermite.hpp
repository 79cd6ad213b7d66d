// continuo/methods/hermite.hpp
#pragma once
#include <array>

namespace continuo::detail {

/// One component of the cubic in theta that has values x, x_new and slopes (times h) first, last at theta = 0, 1:
/// with d = x_new - x the powers are x, first, 3 d - 2 first - last, first + last - 2 d.
template <class Real>
std::array<Real, 4> cubic_hermite(const Real& x, const Real& x_new, const Real& first, const Real& last) {
  const Real difference = x_new - x;
  return {x, first, Real(3) * difference - Real(2) * first - last, first + last - Real(2) * difference};
}

}  // namespace continuo::detail
