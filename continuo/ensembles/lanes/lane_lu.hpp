// LU factorization of W matrices of one size at once, one per lane, each with pivots of its own: what DenseLU does with
// one matrix, operation by operation. Where rows change their places, those of all lanes go through a `select`.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/lanes.hpp>

namespace continuo::detail {

/// The exchanges of rows of a factorization, in their order.
template <class Wide>
class LaneExchanges {
 public:
  using Mask = typename Wide::Mask;

  void forget() { list_.clear(); }
  /// Exchanges rows k and i of a matrix of n columns in these lanes.
  void exchange(const Mask& lanes, std::size_t k, std::size_t i, std::size_t n, Wide* a) {
    if (any(lanes)) exchange_some(lanes, k, i, n, a);
  }
  /// The same with a right-hand side.
  void repeat(Wide* b) const {
    for (const One& one : list_) swap(one.lanes, b[one.k], b[one.i]);
  }

 private:
  struct One {
    Mask lanes;
    std::size_t k, i;
  };
  [[gnu::noinline]] void exchange_some(const Mask& lanes, std::size_t k, std::size_t i, std::size_t n, Wide* a) {
    for (std::size_t j = 0; j < n; ++j) swap(lanes, a[k * n + j], a[i * n + j]);
    list_.push_back({lanes, k, i});
  }
  static void swap(const Mask& lanes, Wide& a, Wide& b) {
    const Wide kept = a;
    a = select(lanes, b, a);
    b = select(lanes, kept, b);
  }
  std::vector<One> list_;  // keeps its room from matrix to matrix
};

/// Brings the greatest of a[k..n-1][k] to the diagonal.
template <class Wide>
void exchange_for_greatest(std::size_t k, std::size_t n, Wide* a, LaneExchanges<Wide>& exchanges) {
  Wide pivot(static_cast<double>(k)), greatest = abs(a[k * n + k]);
  for (std::size_t i = k + 1; i < n; ++i) {
    const Wide here = abs(a[i * n + k]);
    const auto exceeds = here > greatest;
    greatest = select(exceeds, here, greatest);
    pivot = select(exceeds, Wide(static_cast<double>(i)), pivot);
  }
  if (all(pivot == Wide(static_cast<double>(k)))) [[likely]]
    return;
  for (std::size_t i = k + 1; i < n; ++i) exchanges.exchange(pivot == Wide(static_cast<double>(i)), k, i, n, a);
}

/// Row i minus a multiple of row k, from column k + 1 on; not where there is nothing to eliminate, which would change
/// the sign of zeros.
template <class Wide>
void eliminate_row(std::size_t k, std::size_t i, std::size_t n, const Wide& inverse, Wide* a) {
  const auto nothing = a[i * n + k] == Wide(0.0);
  if (none(nothing)) {
    const Wide factor = a[i * n + k] = a[i * n + k] * inverse;
    for (std::size_t j = k + 1; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
  } else if (!all(nothing)) {
    const Wide factor = a[i * n + k] * inverse;
    a[i * n + k] = select(nothing, a[i * n + k], factor);
    for (std::size_t j = k + 1; j < n; ++j)
      a[i * n + j] = select(nothing, a[i * n + j], a[i * n + j] - factor * a[k * n + j]);
  }
}

/// The lanes whose pivot can be divided by.
template <class Wide>
[[nodiscard]] typename Wide::Mask is_regular(const Wide& pivot) {
  const Wide size = abs(pivot);
  return (size > Wide(0.0)) & (size - size == Wide(0.0));
}

/// Of at most eight rows: as SmallLU.
template <class Wide, std::size_t N>
class SmallLaneLU {
 public:
  using Mask = typename Wide::Mask;

  explicit SmallLaneLU(std::size_t) {}
  [[nodiscard]] Wide* matrix() { return entries_.data(); }
  void begin_run(std::size_t) {}

  /// The lanes whose matrix is regular.
  [[nodiscard]] Mask factor() {
    exchanges_.forget();
    std::array<Wide, N * N> a = entries_;
    Mask regular(true);
    unrolled<0, N>([&](auto k) __attribute__((always_inline)) {
      if constexpr (N <= 4) {
        for (std::size_t i = k + 1; i < N; ++i)
          exchanges_.exchange(abs(a[i * N + k]) > abs(a[k * N + k]), k, i, N, a.data());
      } else {
        exchange_for_greatest<Wide>(k, N, a.data(), exchanges_);
      }
      regular = regular & is_regular(a[k * N + k]);
      const Wide inverse = reciprocal(a[k * N + k]);
      a[k * N + k] = inverse;
      unrolled<k + 1, N>([&](auto i) __attribute__((always_inline)) {
        if constexpr (N <= 4) {
          const Wide factor = a[i * N + k] = a[i * N + k] * inverse;
          unrolled<k + 1, N>([&](auto j) __attribute__((always_inline)) { a[i * N + j] -= factor * a[k * N + j]; });
        } else {
          eliminate_row<Wide>(k, i, N, inverse, a.data());
        }
      });
      unrolled<k + 1, N>([&](auto j) __attribute__((always_inline)) { a[k * N + j] = a[k * N + j] * inverse; });
    });
    entries_ = a;
    return regular;
  }

  [[gnu::always_inline]] void solve(Wide* b) const {
    exchanges_.repeat(b);
    std::array<Wide, N> y;
    unrolled<0, N>([&](auto i) __attribute__((always_inline)) { y[i] = b[i]; });
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
  std::array<Wide, N * N> entries_{};
  LaneExchanges<Wide> exchanges_;
};

/// Of a size that is known at run time: as PlainLU where it works column by column.
template <class Wide>
class PlainLaneLU {
 public:
  using Mask = typename Wide::Mask;
  /// Larger matrices of all lanes do not fit the cache next to the processor, and are decomposed one by one.
  static constexpr std::size_t greatest_size = 16;

  explicit PlainLaneLU(std::size_t size) : size_(size), entries_(size * size) {}
  [[nodiscard]] Wide* matrix() { return entries_.data(); }

  [[nodiscard]] Mask factor() {
    const std::size_t n = size_;
    Wide* const a = entries_.data();
    exchanges_.forget();
    Mask regular(true);
    for (std::size_t k = 0; k < n; ++k) {
      exchange_for_greatest(k, n, a, exchanges_);
      regular = regular & is_regular(a[k * n + k]);
      const Wide inverse = reciprocal(a[k * n + k]);
      a[k * n + k] = inverse;
      for (std::size_t i = k + 1; i < n; ++i) eliminate_row(k, i, n, inverse, a);
    }
    return regular;
  }
  void solve(Wide* b) const {
    const std::size_t n = size_;
    const Wide* const a = entries_.data();
    exchanges_.repeat(b);
    for (std::size_t k = 0; k < n; ++k) {
      const Wide x = b[k];
      for (std::size_t i = k + 1; i < n; ++i) b[i] -= a[i * n + k] * x;
    }
    for (std::size_t k = n; k-- > 0;) {
      const Wide x = b[k] = b[k] * a[k * n + k];
      for (std::size_t i = 0; i < k; ++i) b[i] -= a[i * n + k] * x;
    }
  }

 private:
  std::size_t size_;
  std::vector<Wide> entries_;
  LaneExchanges<Wide> exchanges_;
};

/// Of other sizes, whose factorization may remember the pivots of the matrix before: one lane after the other.
template <class Wide, std::size_t N>
class ApartLaneLU {
 public:
  using Mask = typename Wide::Mask;
  using One = DenseLU<double, N>;

  explicit ApartLaneLU(std::size_t size) : size_(size), right_(size), entries_(size * size) {
    for (std::size_t lane = 0; lane < Wide::width; ++lane) lanes_.emplace_back(size);
  }
  [[nodiscard]] Wide* matrix() { return entries_.data(); }
  void begin_run(std::size_t lane) { lanes_[lane] = One(size_); }

  [[nodiscard]] Mask factor() {
    Wide regular(0.0);
    for (std::size_t lane = 0; lane < Wide::width; ++lane) {
      auto& matrix = lanes_[lane].matrix();
      for (std::size_t i = 0; i < size_ * size_; ++i) matrix[i] = entries_[i][lane];
      regular.set(lane, lanes_[lane].factor() ? 1.0 : 0.0);
    }
    regular_ = regular != Wide(0.0);
    return regular_;
  }
  void solve(Wide* b) {
    for (std::size_t lane = 0; lane < Wide::width; ++lane) {
      if (!regular_[lane]) continue;
      for (std::size_t i = 0; i < size_; ++i) right_[i] = b[i][lane];
      lanes_[lane].solve(right_.data());
      for (std::size_t i = 0; i < size_; ++i) b[i].set(lane, right_[i]);
    }
  }

 private:
  std::size_t size_;
  std::vector<double> right_;
  std::vector<Wide> entries_;
  std::vector<One> lanes_;
  Mask regular_;
};

}  // namespace continuo::detail
