// Sums over the stages of a collocation method, for all components: a matrix of numbers times a row of states. Written
// out over the stages, so that the loop over the components is one that compilers turn into lanes.
#pragma once
#include <array>
#include <cstddef>

#include <continuo/methods/implicit/constant_mass.hpp>
#include <continuo/numerics/elimination/small_lu.hpp>
#include <continuo/numerics/state.hpp>

namespace continuo::collocation {

/// Of one component: sum_j matrix[m][j] x[j] for each m.
template <class Real, std::size_t rows, std::size_t columns>
[[nodiscard]] [[gnu::always_inline]] inline std::array<Real, rows> product(
    const std::array<std::array<Real, columns>, rows>& matrix, const std::array<Real, columns>& x) {
  std::array<Real, rows> sums{};
  detail::unrolled<0, rows>([&](auto m) __attribute__((always_inline)) {
    detail::unrolled<0, columns>([&](auto j) __attribute__((always_inline)) { sums[m] += matrix[m][j] * x[j]; });
  });
  return sums;
}

/// body(i) for every component of x. What body writes for one, it must not read for another. Few components are taken
/// one by one: they have just been computed that way, and a register loaded from there would have to wait.
template <State X, class Body>
[[gnu::always_inline]] inline void for_each_component(const X& x, Body&& body) {
  const std::size_t size = dimension(x);
  if constexpr (fixed_size<X>() <= 4) {
#pragma GCC unroll 1
    for (std::size_t i = 0; i < size; ++i) body(i);
  } else {
#if !defined(__clang__)  // see for_each_unit
#pragma GCC ivdep
#endif
    for (std::size_t i = 0; i < size; ++i) body(i);
  }
}

/// take(i, sums) for every component i of the states.
template <State X, std::size_t rows, std::size_t columns, std::size_t most, class Take>
[[gnu::always_inline]] inline void for_each_sums(const std::array<std::array<Scalar<X>, columns>, rows>& matrix,
                                                 const std::array<X, most>& states, Take&& take) {
  for_each_component(states[0], [&](std::size_t i) __attribute__((always_inline)) {
    std::array<Scalar<X>, columns> x;
    detail::unrolled<0, columns>([&](auto j) __attribute__((always_inline)) { x[j] = states[j].data()[i]; });
    take(i, product(matrix, x));
  });
}

/// The sum of the components, in four parts that do not wait for each other.
template <State X>
[[nodiscard]] Scalar<X> total(const X& x) {
  std::array<Scalar<X>, 4> parts{};
  const std::size_t n = dimension(x), whole = n - n % 4;
  for (std::size_t i = 0; i < whole; i += 4)
    for (std::size_t j = 0; j < 4; ++j) parts[j] += x.data()[i + j];
  for (std::size_t i = whole; i < n; ++i) parts[0] += x.data()[i];
  return (parts[0] + parts[1]) + (parts[2] + parts[3]);
}

}  // namespace continuo::collocation
