// continuo/numerics/listed_lu.hpp
// LU decomposition with partial pivoting of matrices of some ten to thirty rows, P A = L D U with unit diagonals as in
// small_lu.hpp. Those of chemical systems are mostly zeros, and so are their factors: what is not zero is listed once,
// and each of the many solutions goes along the list.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <continuo/numerics/complex_number.hpp>

namespace continuo {

inline constexpr std::size_t greatest_listed_size = 32;

namespace detail {

template <class Number, std::size_t N>
class ListedLU {
 public:
  std::array<Number, N * N>& matrix() { return entries_; }

  bool factor() {
    for (std::size_t i = 0; i < N; ++i) order_[i] = static_cast<std::uint8_t>(i);
    for (std::size_t k = 0; k < N; ++k) {
      Number* const pivot = row(k);
      exchange_rows(k);
      const auto size_of_pivot = magnitude(pivot[k]);
      if (!(size_of_pivot > 0) || !(size_of_pivot - size_of_pivot == 0)) return false;
      inverse_[k] = reciprocal(pivot[k]);
      // Rows as a whole, so that the loop is of known length: what is left of the diagonal gets nothing.
      std::array<Number, N> right_of_pivot;
      for (std::size_t j = 0; j < N; ++j) right_of_pivot[j] = j > k ? pivot[j] : Number{};
      for (std::size_t i = k + 1; i < N; ++i) {
        Number* const below = row(i);
        if (below[k] == Number{}) continue;
        const Number factor = below[k] * inverse_[k];
        for (std::size_t j = 0; j < N; ++j) below[j] -= factor * right_of_pivot[j];
        below[k] = factor;
      }
    }
    list();
    return true;
  }

  void solve(Number* b) const {
    std::array<Number, N> y;
    for (std::size_t i = 0; i < N; ++i) y[i] = b[order_[i]];
    for (std::size_t p = 0; p < lower_; ++p) y[to_[p]] -= value_[p] * y[from_[p]];
    for (std::size_t i = 0; i < N; ++i) y[i] = y[i] * inverse_[i];
    for (std::size_t p = lower_; p < count_; ++p) y[to_[p]] -= value_[p] * y[from_[p]];
    for (std::size_t i = 0; i < N; ++i) b[i] = y[i];
  }

 private:
  Number* row(std::size_t i) { return entries_.data() + i * N; }

  void exchange_rows(std::size_t k) {
    std::size_t pivot = k;
    auto greatest = magnitude(row(k)[k]);
    for (std::size_t i = k + 1; i < N; ++i) {
      if (const auto here = magnitude(row(i)[k]); here > greatest) greatest = here, pivot = i;
    }
    if (pivot == k) return;
    for (std::size_t j = 0; j < N; ++j) std::swap(row(k)[j], row(pivot)[j]);
    std::swap(order_[k], order_[pivot]);
  }

  /// In the order of `solve`: the columns of L, then those of U from the last to the first. One after the other they
  /// change different unknowns, and none has to wait for the one before.
  void list() {
    std::size_t p = 0;
    const auto add = [&](const Number& value, std::size_t to, std::size_t from) {
      if (value == Number{}) return;
      value_[p] = value;
      to_[p] = static_cast<std::uint8_t>(to);
      from_[p++] = static_cast<std::uint8_t>(from);
    };
    for (std::size_t j = 0; j < N; ++j)
      for (std::size_t i = j + 1; i < N; ++i) add(row(i)[j], i, j);
    lower_ = p;
    for (std::size_t j = N; j-- > 0;)
      for (std::size_t i = 0; i < j; ++i) add(row(i)[j] * inverse_[i], i, j);
    count_ = p;
  }

  std::array<Number, N * N> entries_{};
  std::array<Number, N*(N - 1)> value_{};  // of L and U, not on the diagonals
  std::array<std::uint8_t, N*(N - 1)> to_{}, from_{};
  std::size_t lower_ = 0, count_ = 0;
  std::array<Number, N> inverse_{};
  std::array<std::uint8_t, N> order_{};
};

}  // namespace detail
}  // namespace continuo
