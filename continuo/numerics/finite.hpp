// continuo/numerics/finite.hpp
// Tests for finite numbers that hold for every scalar, and need no branch where many numbers are tested at once.
#pragma once
#include <cstddef>

#include <continuo/numerics/state.hpp>

namespace continuo::detail {

/// 0, or not a number where `number` is infinite or none; of a register, each of its numbers.
template <class Number>
[[gnu::always_inline, nodiscard]] constexpr Number zero_if_finite(const Number& number) {
  return number - number;
}

/// 0, or not a number where a component of x is not finite.
template <State X>
[[nodiscard]] constexpr Scalar<X> zero_if_all_finite(const X& x) {
  Scalar<X> sum(0);
  for (std::size_t i = 0; i < dimension(x); ++i) sum += zero_if_finite(x.data()[i]);
  return sum;
}

template <class Real>
[[nodiscard]] constexpr bool is_finite(const Real& number) {
  return zero_if_finite(number) == Real(0);
}
template <State X>
[[nodiscard]] constexpr bool all_finite(const X& x) {
  return zero_if_all_finite(x) == Scalar<X>(0);
}

}  // namespace continuo::detail
