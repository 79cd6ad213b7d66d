// continuo/numerics/dense_lu.hpp
// LU factorization with partial pivoting of a matrix stored row by row. For sizes known when compiling the loops are
// unrolled and the matrix stays on the stack; the numbers may be real or complex, of any scalar.
//
//   DenseLU<double, 3> lu(3);
//   lu.matrix() = {...};
//   if (lu.factor()) lu.solve(b);
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/elimination/listed_lu.hpp>
#include <continuo/numerics/elimination/small_lu.hpp>

namespace continuo {

/// The size of a matrix that is known only at run time.
inline constexpr std::size_t run_time_size = static_cast<std::size_t>(-1);

/// Numbers or rows for a state of N components: an array, or a vector where N is known at run time only.
template <class T, std::size_t N, std::size_t Count>
using BlockOf = std::conditional_t<N == run_time_size, std::vector<T>, std::array<T, N == run_time_size ? 1 : Count>>;

namespace detail {

template <class Number, std::size_t N>
class PlainLU {
 public:
  explicit PlainLU(std::size_t size) : size_(size) {
    if constexpr (N == run_time_size) {
      entries_.resize(size * size);
      pivots_.resize(size);
    }
  }

  std::size_t size() const {
    if constexpr (N == run_time_size) {
      return size_;
    } else {
      return N;
    }
  }
  /// To be filled before `factor`, which overwrites it.
  auto& matrix() { return entries_; }

  /// False where a pivot is zero or not a number: the matrix is singular, or was not finite.
  bool factor() {
    const std::size_t n = size();
    Number* const a = entries_.data();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t pivot = greatest_in_column(k);
      pivots_[k] = static_cast<std::uint32_t>(pivot);
      if (pivot != k) {
        for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[pivot * n + j]);
      }
      const auto size_of_pivot = magnitude(a[k * n + k]);
      if (!(size_of_pivot > 0) || !(size_of_pivot - size_of_pivot == 0)) return false;
      const Number inverse = reciprocal(a[k * n + k]);
      a[k * n + k] = inverse;
      for (std::size_t i = k + 1; i < n; ++i) {
        if (a[i * n + k] == Number{}) continue;
        const Number factor = a[i * n + k] = a[i * n + k] * inverse;
        for (std::size_t j = k + 1; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      }
    }
    return true;
  }

  /// b becomes the solution.
  void solve(Number* b) const {
    const std::size_t n = size();
    const Number* const a = entries_.data();
    for (std::size_t k = 0; k < n; ++k) std::swap(b[k], b[pivots_[k]]);
    if (n <= greatest_size_in_cache) {
      // Column by column: each entry of b changes without waiting for the sum of the one before.
      for (std::size_t k = 0; k < n; ++k) {
        const Number x = b[k];
        for (std::size_t i = k + 1; i < n; ++i) b[i] -= a[i * n + k] * x;
      }
      for (std::size_t k = n; k-- > 0;) {
        const Number x = b[k] = b[k] * a[k * n + k];
        for (std::size_t i = 0; i < k; ++i) b[i] -= a[i * n + k] * x;
      }
      return;
    }
    for (std::size_t i = 1; i < n; ++i) {
      Number sum = b[i];
      for (std::size_t j = 0; j < i; ++j) sum -= a[i * n + j] * b[j];
      b[i] = sum;
    }
    for (std::size_t i = n; i-- > 0;) {
      Number sum = b[i];
      for (std::size_t j = n; j-- > i + 1;) sum -= a[i * n + j] * b[j];  // the newest last: all wait for it
      b[i] = sum * a[i * n + i];
    }
  }

 private:
  static constexpr std::size_t greatest_size_in_cache = 48;

  std::size_t greatest_in_column(std::size_t k) const {
    const std::size_t n = size();
    std::size_t pivot = k;
    auto greatest = magnitude(entries_[k * n + k]);
    for (std::size_t i = k + 1; i < n; ++i) {
      if (const auto here = magnitude(entries_[i * n + k]); here > greatest) greatest = here, pivot = i;
    }
    return pivot;
  }

  std::size_t size_;
  BlockOf<Number, N, N * N> entries_{};
  BlockOf<std::uint32_t, N, N> pivots_{};
};

}  // namespace detail

/// For sizes that are too large to be written out, or known at run time only: loops over rows. Factoring costs n^3 / 3
/// products, a solution n^2.
template <class Number, std::size_t N = run_time_size>
class DenseLU : public detail::PlainLU<Number, N> {
 public:
  using detail::PlainLU<Number, N>::PlainLU;
};

/// For at most eight rows, written out by the compiler.
template <class Number, std::size_t N>
  requires(N <= greatest_small_size)
class DenseLU<Number, N> : public detail::SmallLU<Number, N> {
 public:
  /// The size is known already.
  explicit DenseLU(std::size_t) {}
  /// The number of rows.
  static constexpr std::size_t size() { return N; }
};

/// With a list where that is less work.
template <class Number, std::size_t N>
  requires(N > greatest_small_size && N <= greatest_listed_size)
class DenseLU<Number, N> {
 public:
  /// The size is known already; `size` must be N.
  explicit DenseLU(std::size_t size) : plain_(size) {}
  /// The number of rows.
  static constexpr std::size_t size() { return N; }
  /// The entries, row by row, to be filled before each call of `factor`.
  std::array<Number, N * N>& matrix() { return plain_.matrix(); }

  /// Decomposes the matrix. False where a pivot is zero or not a number: the matrix is singular, or was not finite.
  bool factor() {
    const auto result = listed_.factor(plain_.matrix());
    is_listed_ = result != Listed::Result::not_listed;
    return is_listed_ ? result == Listed::Result::done : plain_.factor();
  }
  /// b becomes the solution. `factor` must have succeeded.
  void solve(Number* b) const {
    if (is_listed_) {
      listed_.solve(b);
    } else {
      plain_.solve(b);
    }
  }

 private:
  using Listed = detail::ListedLU<Number, N>;
  Listed listed_;
  detail::PlainLU<Number, N> plain_;
  bool is_listed_ = false;
};

}  // namespace continuo
