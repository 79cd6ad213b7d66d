// The elimination of a band from one of its ends: how BandedLU decomposes. Rows and columns are counted from that end.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/small_lu.hpp>

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

/// Under way. `window`: rows k ... k + lower as they are when column k is to be eliminated, from column k on; and
/// behind them row k of U. All of them move up and to the left by one from k to k + 1. Lower and Right are constants
/// where the band is narrow.
template <class Number, class Lower, class Right, class Window>
class BandElimination {
 public:
  [[gnu::always_inline]] BandElimination(BandEnd<Number>& end, const Number* entries, Lower lower, Right right,
                                         Window window)
      : end_(end), entries_(entries), lower_(lower), right_(right), window_(window) {
    end.lowest = 0;
    std::fill(window_.begin(), window_.end(), Number{});
    for (std::size_t i = 0; i < std::min<std::size_t>(lower, end.rows); ++i)
      for (std::size_t j = lower - i; j <= right; ++j)
        window_[i * (right + 1) + j + i - lower] = entries[i * (right + 1) + j];
  }

  /// What is left of row columns + i, from column `columns` on.
  const Number& rest(std::size_t i, std::size_t j) const { return window_[i * (right_ + 1) + j]; }

  /// Column k. False where its pivot is zero or not a number.
  [[gnu::always_inline]] bool eliminate(std::size_t k) {
    const Lower lower = lower_;
    const Right right = right_;
    const auto at = [&](auto i, auto j)
                        __attribute__((always_inline)) -> Number& { return window_[i * (right + 1) + j]; };
    const Number none{};
    const bool inside = k + lower < end_.rows;
    const Number* const next = inside ? entries_ + (k + lower) * (right + 1) : &none;
    each<0>(right, [&](auto j) __attribute__((always_inline)) { at(lower, j) = inside ? next[j] : Number{}; });
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
  const Number* entries_;
  Lower lower_;
  Right right_;
  Window window_;
};

}  // namespace continuo::detail
