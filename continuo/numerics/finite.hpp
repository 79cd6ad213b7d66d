// continuo/numerics/finite.hpp
// Tests for finite numbers: neither infinite nor not a number.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include <continuo/numerics/state.hpp>

namespace continuo {

/// Whether all numbers of a range are finite; of complex ones, both parts.
template <class Values>
[[nodiscard]] bool all_finite(const Values& values) {
  return std::all_of(std::begin(values), std::end(values), [](const auto& value) {
    if constexpr (requires { value.imag(); })
      return std::isfinite(value.real()) && std::isfinite(value.imag());
    else
      return std::isfinite(value);
  });
}

namespace detail {

// The same for states of every scalar, registers and numbers with derivatives too, without a branch for each number.

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
[[nodiscard]] constexpr bool is_finite_state(const X& x) {
  return zero_if_all_finite(x) == Scalar<X>(0);
}

}  // namespace detail

}  // namespace continuo
