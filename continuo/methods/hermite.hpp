// continuo/methods/hermite.hpp
#pragma once

namespace continuo::detail {

/// The cubic in theta that has values x, x_new and slopes (times h) first, last at theta = 0, 1: with d = x_new - x its
/// powers are x, first, 3 d - 2 first - last, first + last - 2 d. U is a component or a register of them.
template <class Real, class U, class Powers>
inline void set_cubic_hermite(const U& x, const U& x_new, const U& first, const U& last, Powers& c) {
  const U difference = x_new - x;
  c[0] = x;
  c[1] = first;
  c[2] = Real(3) * difference - Real(2) * first - last;
  c[3] = first + last - Real(2) * difference;
}

}  // namespace continuo::detail
