// The elimination of a band from one of its ends: how BandedLU decomposes. Rows and columns are counted from that end.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/elimination/small_lu.hpp>

namespace continuo::detail {

/// The factors of the columns that are eliminated from one end; `right` columns behind the diagonal have entries, with
/// what pivoting moves there.
template <class Number>
struct BandEnd {
  std::size_t rows = 0, columns = 0;  // that it sees; that it eliminates
  std::size_t lowest = 0;             // of the pivots, from the diagonal
  std::vector<Number> inverse;        // of D
  std::vector<Number> left_factors;   // L without its diagonal, by columns
  std::vector<Number> right_factors;  // U without its diagonal, by columns
  std::vector<std::uint32_t> pivots;  // by how many rows the pivot lay below the diagonal

  BandEnd() = default;
  BandEnd(std::size_t rows_, std::size_t columns_, std::size_t lower, std::size_t right)
      : rows(rows_),
        columns(columns_),
        inverse(columns),
        left_factors(columns * lower),
        right_factors((columns + right) * right),
        pivots(columns) {}
};

/// The rows of c M - J, seen from an end: entry j of a row is that `lower` columns before the diagonal, and on. The
/// second end (direction = -1) counts from behind.
template <class Number, class Real, int direction>
struct BandRows {
  const Real* first;      // of J
  std::ptrdiff_t stride;  // from one entry to the next
  Number c;
  const Real* mass;  // of the first row; null for the identity

  template <class Entry, class Lower>
  [[gnu::always_inline]] Number operator()(std::size_t row, Entry j, Lower lower) const {
    const auto i = static_cast<std::ptrdiff_t>(row);
    const Number entry(-first[direction * (i + static_cast<std::ptrdiff_t>(j) * stride)]);
    if (j != lower) return entry;
    return entry + (mass == nullptr ? c : c * Number(mass[direction * i]));
  }
};

/// Under way. `window`: rows k ... k + lower as they are when column k is to be eliminated, from column k on; and
/// behind them row k of U. All of them move up and to the left by one from k to k + 1. Lower and Right are constants
/// where the band is narrow.
template <class Number, class Rows, class Lower, class Right, class Window>
class BandElimination {
 public:
  [[gnu::always_inline]] BandElimination(BandEnd<Number>& end, const Rows& rows, Lower lower, Right right,
                                         Window window)
      : end_(end), rows_(rows), lower_(lower), right_(right), window_(window) {
    end.lowest = 0;
    std::fill(window_.begin(), window_.end(), Number{});
    for (std::size_t i = 0; i < std::min<std::size_t>(lower, end.rows); ++i)
      for (std::size_t j = lower - i; j <= right; ++j) window_[i * (right + 1) + j + i - lower] = rows(i, j, lower);
  }

  /// What is left of row columns + i, from column `columns` on.
  [[nodiscard]] [[gnu::always_inline]] const Number& rest(std::size_t i, std::size_t j) const {
    return window_[i * (right_ + 1) + j];
  }
  /// Entry j of a row of the matrix.
  [[nodiscard]] [[gnu::always_inline]] Number row(std::size_t i, std::size_t j) const {
    return rows_(i, j, static_cast<std::size_t>(lower_));
  }

  /// Column k. False where its pivot is zero or not a number.
  [[nodiscard]] [[gnu::always_inline]] bool eliminate(std::size_t k) {
    const Lower lower = lower_;
    const Right right = right_;
    const auto at = [&](auto i, auto j)
                        __attribute__((always_inline)) -> Number& { return window_[i * (right + 1) + j]; };
    const bool inside = k + lower < end_.rows;
    each<0>(right, [&](auto j) __attribute__((always_inline)) {
      at(lower, j) = inside ? rows_(k + lower, j, lower) : Number{};
    });
    std::size_t pivot = 0;
    auto greatest = magnitude(at(std::size_t{0}, std::size_t{0}));
    each<1>(lower, [&](auto i) __attribute__((always_inline)) {
      if (const auto here = magnitude(window_[i * (right + 1)]); here > greatest) greatest = here, pivot = i;
    });
    if (!(greatest > 0) || !(greatest - greatest == 0)) return false;
    end_.pivots[k] = static_cast<std::uint32_t>(pivot);
    if (pivot != 0) {
      end_.lowest = std::max(end_.lowest, pivot);
      each<1>(lower, [&](auto i) __attribute__((always_inline)) {
        if (pivot == i) each<0>(right, [&](auto j) __attribute__((always_inline)) { std::swap(window_[j], at(i, j)); });
      });
    }
    const Number inverse = end_.inverse[k] = reciprocal(window_[0]);
    each<1>(right, [&](auto j) __attribute__((always_inline)) {
      end_.right_factors[(k + j) * right + right - j] = at(lower + 1, j) = window_[j] * inverse;
    });
    each<1>(lower, [&](auto i) __attribute__((always_inline)) {
      const Number below = window_[i * (right + 1)];
      end_.left_factors[k * lower + i - 1] = below * inverse;
      each<1>(right, [&](auto j) __attribute__((always_inline)) {
        window_[(i - 1) * (right + 1) + j - 1] = at(i, j) - below * at(lower + 1, j);
      });
      window_[(i - 1) * (right + 1) + right] = Number{};
    });
    return true;
  }

 private:
  /// body(i) for i = first, ..., last, written out where they are constants.
  template <std::size_t first, class Last, class Body>
  [[gnu::always_inline]] static void each(Last last, Body&& body) {
    if constexpr (std::is_same_v<Last, std::size_t>) {
      for (std::size_t i = first; i <= last; ++i) body(i);
    } else {
      unrolled<first, last + 1>(body);
    }
  }

  BandEnd<Number>& end_;
  Rows rows_;
  Lower lower_;
  Right right_;
  Window window_;
};

}  // namespace continuo::detail
