// continuo/numerics/elimination/small_lu.hpp
// LU factorization with partial pivoting of matrices of at most eight rows, written out by the compiler. A solution is
// a chain of operations that wait for each other, and an implicit method asks for many with one matrix; therefore both
// factors get a unit diagonal (P A = L D U), so that the chain has no division and no product by the diagonal, and the
// newest unknown enters each sum last.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <continuo/numerics/complex_number.hpp>

namespace continuo {

inline constexpr std::size_t greatest_small_size = 8;

namespace detail {

/// body(First), ..., body(Last - 1), each with the number as a constant.
template <std::size_t First, std::size_t Last, class Body>
[[gnu::always_inline]] inline void unrolled(Body&& body) {
  if constexpr (First < Last) {
    [&]<std::size_t... i>(std::index_sequence<i...>) __attribute__((always_inline)) {
      (body(std::integral_constant<std::size_t, First + i>{}), ...);
    }(std::make_index_sequence<Last - First>());
  }
}

template <class Number, std::size_t N>
class SmallLU {
 public:
  [[nodiscard]] std::array<Number, N * N>& matrix() { return entries_; }

  [[nodiscard]] bool factor() {
    // Few rows are in registers; of many, those that have nothing to be eliminated are left as they are.
    constexpr bool in_registers = N <= 4;
    std::conditional_t<in_registers, std::array<Number, N * N>, std::array<Number, N * N>&> a = entries_;
    std::array<std::uint32_t, N> order;
    for (std::size_t i = 0; i < N; ++i) order[i] = static_cast<std::uint32_t>(i);
    bool regular = true;
    unrolled<0, N>([&](auto k) __attribute__((always_inline)) {
      exchange_rows<k>(a, order);
      const auto size_of_pivot = magnitude(a[k * N + k]);
      regular = regular && size_of_pivot > 0 && size_of_pivot - size_of_pivot == 0;
      const Number inverse = reciprocal(a[k * N + k]);
      a[k * N + k] = inverse;
      unrolled<k + 1, N>([&](auto i) __attribute__((always_inline)) {
        if (!in_registers && a[i * N + k] == Number{}) return;
        const Number factor = a[i * N + k] = a[i * N + k] * inverse;
        unrolled<k + 1, N>([&](auto j) __attribute__((always_inline)) { a[i * N + j] -= factor * a[k * N + j]; });
      });
      unrolled<k + 1, N>([&](auto j) __attribute__((always_inline)) { a[k * N + j] = a[k * N + j] * inverse; });
    });
    if constexpr (in_registers) entries_ = a;
    order_ = order;
    in_order_ = true;
    for (std::size_t i = 0; i < N; ++i) in_order_ = in_order_ && order[i] == i;
    return regular;
  }

  [[gnu::always_inline]] void solve(Number* b) const {
    std::array<Number, N> y;
    if (in_order_) {  // as a rule, and then y is b, in registers
      unrolled<0, N>([&](auto i) __attribute__((always_inline)) { y[i] = b[i]; });
    } else {
      unrolled<0, N>([&](auto i) __attribute__((always_inline)) { y[i] = b[order_[i]]; });
    }
    unrolled<1, N>([&](auto i) __attribute__((always_inline)) {
      unrolled<0, i>([&](auto j) __attribute__((always_inline)) { y[i] -= entries_[i * N + j] * y[j]; });
    });
    unrolled<0, N>([&](auto i) __attribute__((always_inline)) { y[i] = y[i] * entries_[i * N + i]; });
    unrolled<1, N>([&](auto up) __attribute__((always_inline)) {
      constexpr std::size_t i = N - 1 - up;
      unrolled<0, up>([&](auto left) __attribute__((always_inline)) {
        y[i] -= entries_[i * N + (N - 1 - left)] * y[N - 1 - left];
      });
    });
    unrolled<0, N>([&](auto i) __attribute__((always_inline)) { b[i] = y[i]; });
  }

 private:
  /// Brings the greatest of a[k..N-1][k] to the diagonal.
  template <std::size_t k>
  [[gnu::always_inline]] static void exchange_rows(std::array<Number, N * N>& a, std::array<std::uint32_t, N>& order) {
    if constexpr (N <= 4) {
      // Rows stay in registers; the branches go the same way from step to step.
      unrolled<k + 1, N>([&](auto i) __attribute__((always_inline)) {
        if (magnitude(a[i * N + k]) > magnitude(a[k * N + k])) exchange<i, k>(a, order);
      });
    } else {
      std::size_t pivot = k;
      auto greatest = magnitude(a[k * N + k]);
      for (std::size_t i = k + 1; i < N; ++i) {
        if (const auto here = magnitude(a[i * N + k]); here > greatest) greatest = here, pivot = i;
      }
      if (pivot == k) return;
      for (std::size_t j = 0; j < N; ++j) std::swap(a[k * N + j], a[pivot * N + j]);
      std::swap(order[k], order[pivot]);
    }
  }
  template <std::size_t i, std::size_t k>
  [[gnu::always_inline]] static void exchange(std::array<Number, N * N>& a, std::array<std::uint32_t, N>& order) {
    unrolled<0, N>([&](auto j) __attribute__((always_inline)) { std::swap(a[i * N + j], a[k * N + j]); });
    std::swap(order[i], order[k]);
  }

  std::array<Number, N * N> entries_{};
  std::array<std::uint32_t, N> order_{};
  bool in_order_ = true;
};

}  // namespace detail
}  // namespace continuo
