// LU decomposition with partial pivoting of a matrix whose entries lie near its diagonal, P A = L D U with unit
// diagonals as in small_lu.hpp. The numbers may be real or complex, of any scalar.
//
//   BandedLU<double> lu(n, lower, upper);
//   lu(i, j) = ...;                     // for j - upper <= i <= j + lower, the others are zero
//   if (lu.factor()) lu.solve(b);
//
// Elimination sees lower + 1 rows at a time, a solution as many unknowns. For narrow bands that window is in registers:
// what one unknown waits for is then one product and one sum, no way through memory.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/small_lu.hpp>

namespace continuo {

template <class Number>
class BandedLU {
 public:
  BandedLU() = default;
  BandedLU(std::size_t size, std::size_t lower, std::size_t upper) : size_(size) {
    const std::size_t widest = std::max({lower, upper, std::size_t{1}});
    const bool narrow = widest <= greatest_narrow;
    lower_ = narrow ? widest : lower;
    upper_ = narrow ? widest : upper;
    const std::size_t right = lower_ + upper_;  // of the diagonal, with what pivoting moves there
    entries_.resize(size * (right + 1));
    inverse_.resize(size);
    left_factors_.resize(size * lower_);
    right_factors_.resize((size + right) * right);
    pivots_.resize(size);
    if (!narrow) window_.resize((lower_ + 2) * (right + 1));
  }

  std::size_t size() const { return size_; }

  void clear() { std::fill(entries_.begin(), entries_.end(), Number{}); }
  /// The matrix, row by row. `factor` leaves it as it is.
  Number& operator()(std::size_t row, std::size_t column) { return entries_[place(row, column)]; }
  /// Where (row, column) is among the entries, for who fills them many times.
  std::size_t place(std::size_t row, std::size_t column) const {
    return row * (lower_ + upper_ + 1) + lower_ + column - row;
  }
  Number* entries() { return entries_.data(); }

  /// False where a pivot is zero or not a number: the matrix is singular, or was not finite.
  bool factor() {
    return with_widths([&](auto lower, auto right) {
      if constexpr (std::is_same_v<decltype(lower), std::size_t>) {
        return eliminate(lower, right, window_);
      } else {
        std::array<Number, (lower + 2) * (right + 1)> window;
        return eliminate(lower, right, window);
      }
    });
  }

  /// b becomes the solution.
  void solve(Number* b) const {
    with_widths([&](auto lower, auto right) {
      if constexpr (std::is_same_v<decltype(lower), std::size_t>) {
        solve_wide(b);
      } else {
        solve_lower<lower>(b);
        if (filled_ > lower) {
          solve_upper<right, right>(b);
        } else {
          solve_upper<lower, right>(b);
        }
      }
      return true;
    });
  }

 private:
  static constexpr std::size_t greatest_narrow = 4;

  /// act(lower, lower + upper), as constants where the band is narrow.
  template <class Act>
  bool with_widths(Act&& act) const {
    if (window_.empty()) {
      const auto narrow = [&]<std::size_t B>() {
        return act(std::integral_constant<std::size_t, B>{}, std::integral_constant<std::size_t, 2 * B>{});
      };
      switch (lower_) {
        case 1:
          return narrow.template operator()<1>();
        case 2:
          return narrow.template operator()<2>();
        case 3:
          return narrow.template operator()<3>();
        case 4:
          return narrow.template operator()<4>();
      }
    }
    return act(lower_, lower_ + upper_);
  }

  /// body(i) for i = first, ..., last, written out where they are constants.
  template <std::size_t first, class Last, class Body>
  [[gnu::always_inline]] static void each(Last last, Body&& body) {
    if constexpr (std::is_same_v<Last, std::size_t>) {
      for (std::size_t i = first; i <= last; ++i) body(i);
    } else {
      detail::unrolled<first, last + 1>(body);
    }
  }

  /// `window`: rows k ... k + lower as they are when column k is to be eliminated, from column k on; and behind them
  /// row k of U. All of them move up and to the left by one from k to k + 1.
  template <class Lower, class Right, class Window>
  [[gnu::always_inline]] bool eliminate(Lower lower, Right right, Window& window) {
    const auto at = [&](auto i, auto j)
                        __attribute__((always_inline)) -> Number& { return window[i * (right + 1) + j]; };
    std::fill(window.begin(), window.end(), Number{});
    for (std::size_t i = 0; i < std::min<std::size_t>(lower, size_); ++i)
      for (std::size_t j = lower - i; j <= right; ++j)
        window[i * (right + 1) + j + i - lower] = entries_[i * (right + 1) + j];
    const Number none{};
    std::size_t lowest = 0;  // of the pivots, from the diagonal
    for (std::size_t k = 0; k < size_; ++k) {
      const bool inside = k + lower < size_;
      const Number* const next = inside ? entries_.data() + (k + lower) * (right + 1) : &none;
      each<0>(right, [&](auto j) __attribute__((always_inline)) { at(lower, j) = inside ? next[j] : Number{}; });
      std::size_t pivot = 0;
      auto greatest = magnitude(at(std::size_t{0}, std::size_t{0}));
      each<1>(lower, [&](auto i) __attribute__((always_inline)) {
        if (const auto here = magnitude(window[i * (right + 1)]); here > greatest) greatest = here, pivot = i;
      });
      if (!(greatest > 0) || !(greatest - greatest == 0)) return false;
      pivots_[k] = static_cast<std::uint32_t>(pivot);
      if (pivot != 0) {
        lowest = std::max(lowest, pivot);
        each<1>(lower, [&](auto i) __attribute__((always_inline)) {
          if (pivot == i)
            each<0>(right, [&](auto j) __attribute__((always_inline)) { std::swap(window[j], at(i, j)); });
        });
      }
      const Number inverse = inverse_[k] = reciprocal(window[0]);
      each<1>(right, [&](auto j) __attribute__((always_inline)) {
        right_factors_[(k + j) * right + right - j] = at(lower + 1, j) = window[j] * inverse;
      });
      each<1>(lower, [&](auto i) __attribute__((always_inline)) {
        const Number below = window[i * (right + 1)];
        left_factors_[k * lower + i - 1] = below * inverse;
        each<1>(right, [&](auto j) __attribute__((always_inline)) {
          window[(i - 1) * (right + 1) + j - 1] = at(i, j) - below * at(lower + 1, j);
        });
        window[(i - 1) * (right + 1) + right] = Number{};
      });
    }
    filled_ = upper_ + lowest;
    return true;
  }

  /// turn(r, moved, k, inside) for k = 0, 1, ..., n - 1, where `inside` says that k + beyond < n. What moves through a
  /// window of `period` places by one each time stays where it is while r = k modulo `period` and moved = 0 are
  /// constants of the code; with r = 0 and moved = 1 the turn moves it. So it does for complex numbers, for which the
  /// registers would not last.
  template <std::size_t period, std::size_t beyond, class Turn>
  [[gnu::always_inline]] static void in_turns(std::size_t n, Turn&& turn) {
    constexpr std::integral_constant<std::size_t, 0> zero;
    constexpr std::integral_constant<std::size_t, 1> one;
    std::size_t k = 0;
    if constexpr (std::is_floating_point_v<Number>) {
      for (; k + period - 1 + beyond < n; k += period)
        detail::unrolled<0, period>([&](auto r) __attribute__((always_inline)) { turn(r, zero, k + r, true); });
    }
    for (; k < n; ++k) turn(zero, one, k, k + beyond < n);
  }

  /// b becomes D^-1 L^-1 P b.
  template <std::size_t lower>
  void solve_lower(Number* b) const {
    constexpr std::size_t period = lower + 1;
    std::array<Number, period> ahead{};  // b[k], ..., b[k + lower], as far as they are known, from place r on
    for (std::size_t i = 0; i < std::min(lower, size_); ++i) ahead[i] = b[i];
    in_turns<period, lower>(size_, [&](auto r, auto moved, std::size_t k, bool inside) __attribute__((always_inline)) {
      ahead[(r + lower) % period] = inside ? b[k + lower] : Number{};
      if (const std::uint32_t pivot = pivots_[k]; pivot != 0) {
        detail::unrolled<1, period>([&](auto i) __attribute__((always_inline)) {
          if (pivot == i) std::swap(ahead[r], ahead[(r + i) % period]);
        });
      }
      const Number known = ahead[r];
      const Number* const left = left_factors_.data() + k * lower;
      b[k] = known * inverse_[k];
      detail::unrolled<1, period>([&](auto i) __attribute__((always_inline)) {
        ahead[(r + i - moved) % period] = ahead[(r + i) % period] - left[i - 1] * known;
      });
    });
  }
  /// b becomes U^-1 b, where U has entries in `upper` columns behind the diagonal, and room for `room`.
  template <std::size_t upper, std::size_t room>
  void solve_upper(Number* b) const {
    constexpr std::size_t period = upper + 1;
    std::array<Number, period> ahead{};  // b[k], ..., b[k - upper], as far as they are known, from place r on
    for (std::size_t i = 0; i < std::min(upper, size_); ++i) ahead[i] = b[size_ - 1 - i];
    in_turns<period, upper>(size_, [&](auto r, auto moved, std::size_t j, bool inside) __attribute__((always_inline)) {
      const std::size_t k = size_ - 1 - j;
      ahead[(r + upper) % period] = inside ? b[k - upper] : Number{};
      const Number known = b[k] = ahead[r];
      const Number* const column = right_factors_.data() + (k + 1) * room;
      detail::unrolled<1, period>([&](auto i) __attribute__((always_inline)) {
        ahead[(r + i - moved) % period] = ahead[(r + i) % period] - *(column - i) * known;
      });
    });
  }

  void solve_wide(Number* b) const {
    for (std::size_t k = 0; k < size_; ++k) {
      if (pivots_[k] != 0) std::swap(b[k], b[k + pivots_[k]]);
      const Number* const left = left_factors_.data() + k * lower_;
      const std::size_t below = std::min(lower_, size_ - 1 - k);
      const Number known = b[k];
      Number* const rest = b + k + 1;
      for (std::size_t i = 0; i < below; ++i) rest[i] -= left[i] * known;
      b[k] = known * inverse_[k];
    }
    for (std::size_t k = size_; k-- > 0;) {
      const std::size_t room = lower_ + upper_, above = std::min(filled_, k);
      const Number* const column = right_factors_.data() + (k + 1) * room - above;
      const Number known = b[k];
      Number* const rest = b + (k - above);
      for (std::size_t i = 0; i < above; ++i) rest[i] -= column[i] * known;
    }
  }

  std::size_t size_ = 0, lower_ = 0, upper_ = 0;
  std::size_t filled_ = 0;  // how far U reaches: upper, and further by pivoting
  std::vector<Number> entries_;
  std::vector<Number> inverse_;        // of D
  std::vector<Number> left_factors_;   // L without its diagonal, by columns
  std::vector<Number> right_factors_;  // U without its diagonal, by columns
  std::vector<Number> window_;         // see eliminate; empty where it is in registers
  std::vector<std::uint32_t> pivots_;  // by how many rows the pivot lay below the diagonal
};

}  // namespace continuo
