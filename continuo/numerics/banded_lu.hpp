// LU decomposition with partial pivoting of a matrix whose entries lie near its diagonal, P A = L D U with unit
// diagonals as in small_lu.hpp. The numbers may be real or complex, of any scalar.
//
//   BandedLU<double> lu(n, lower, upper);
//   lu(i, j) = ...;                     // for j - upper <= i <= j + lower, the others are zero
//   if (lu.factor()) lu.solve(b);
//
// Each unknown waits for the one before it, and the processor with it. Narrow bands are therefore eliminated from both
// ends at once, two chains of half the length, until lower + upper unknowns are left in the middle, whose matrix is
// dense (J. Dongarra, A. Sameh, Parallel Computing 1 (1984) 223-235, for two processors). Elimination sees lower + 1
// rows at a time, a solution as many unknowns; for narrow bands that window is in registers.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/band_end.hpp>
#include <continuo/numerics/dense_lu.hpp>

namespace continuo {

template <class Number>
class BandedLU {
 public:
  BandedLU() = default;
  BandedLU(std::size_t size, std::size_t lower, std::size_t upper) : size_(size), lower_(lower), upper_(upper) {
    const std::size_t widest = std::max({lower, upper, std::size_t{1}});
    if (widest <= greatest_narrow && size >= 8 * widest) {
      lower_ = upper_ = widest;
      const std::size_t right = 2 * widest, left_over = right + size % 2, columns = (size - left_over) / 2;
      ends_ = {End(columns + lower_ + size % 2, columns, lower_, right), End(columns + lower_, columns, lower_, right)};
      middle_ = DenseLU<Number>(left_over);
    } else {
      ends_[0] = End(size, size, lower, lower + upper);
      window_.resize((lower + 2) * (lower + upper + 1));
    }
    entries_.resize((ends_[0].rows + ends_[1].rows) * (lower_ + upper_ + 1));
  }

  std::size_t size() const { return size_; }

  void clear() { std::fill(entries_.begin(), entries_.end(), Number{}); }
  /// The matrix, row by row. `factor` leaves it as it is.
  Number& operator()(std::size_t row, std::size_t column) { return entries_[place(row, column)]; }
  /// Where (row, column) is among the entries, for who fills them many times. The second end counts from behind.
  std::size_t place(std::size_t row, std::size_t column) const {
    const std::size_t width = lower_ + upper_ + 1;
    if (row < ends_[0].rows) return row * width + lower_ + column - row;
    return (ends_[0].rows + size_ - 1 - row) * width + lower_ + row - column;
  }
  Number* entries() { return entries_.data(); }

  /// False where a pivot is zero or not a number: the matrix is singular, or was not finite.
  bool factor() {
    if (is_wide()) return factor_wide();
    return with_width([&]<std::size_t B>() { return factor_narrow<B>(); });
  }

  /// b becomes the solution.
  void solve(Number* b) {
    if (is_wide()) return solve_wide(b);
    with_width([&]<std::size_t B>() {
      solve_narrow<B>(b);
      return true;
    });
  }

 private:
  using End = detail::BandEnd<Number>;
  static constexpr std::size_t greatest_narrow = 4;

  bool is_wide() const { return ends_[1].columns == 0; }

  /// act<B>() for the width of a narrow band.
  template <class Act>
  bool with_width(Act&& act) const {
    switch (lower_) {
      case 1:
        return act.template operator()<1>();
      case 2:
        return act.template operator()<2>();
      case 3:
        return act.template operator()<3>();
      default:
        return act.template operator()<4>();
    }
  }

  bool factor_wide() {
    detail::BandElimination<Number, std::size_t, std::size_t, std::vector<Number>&> elimination(
        ends_[0], entries_.data(), lower_, lower_ + upper_, window_);
    for (std::size_t k = 0; k < size_; ++k)
      if (!elimination.eliminate(k)) return false;
    filled_ = upper_ + ends_[0].lowest;
    return true;
  }

  template <std::size_t B>
  using Narrow =
      detail::BandElimination<Number, std::integral_constant<std::size_t, B>,
                              std::integral_constant<std::size_t, 2 * B>, std::array<Number, (B + 2) * (2 * B + 1)>>;

  template <std::size_t B>
  bool factor_narrow() {
    Narrow<B> top(ends_[0], entries_.data(), {}, {}, {});
    Narrow<B> bottom(ends_[1], entries_.data() + ends_[0].rows * (2 * B + 1), {}, {}, {});
    const std::size_t columns = ends_[0].columns;
    bool regular = true;
    if constexpr (B <= 2) {  // both windows fit into the registers
      for (std::size_t k = 0; k < columns && regular; ++k) {
        regular = top.eliminate(k);
        regular = bottom.eliminate(k) && regular;
      }
    } else {
      for (std::size_t k = 0; k < columns && regular; ++k) regular = top.eliminate(k);
      for (std::size_t k = 0; k < columns && regular; ++k) regular = bottom.eliminate(k);
    }
    filled_ = upper_ + std::max(ends_[0].lowest, ends_[1].lowest);
    return regular && factor_middle<B>(top, bottom);
  }

  /// What both ends have left over, and the row that neither has seen where there is one.
  template <std::size_t B>
  bool factor_middle(const Narrow<B>& top, const Narrow<B>& bottom) {
    const std::size_t s = middle_.size();
    auto& matrix = middle_.matrix();
    std::fill(matrix.begin(), matrix.end(), Number{});
    for (std::size_t i = 0; i < B; ++i)
      for (std::size_t j = 0; j < 2 * B; ++j) {
        matrix[i * s + j] = top.rest(i, j);
        matrix[(s - 1 - i) * s + s - 1 - j] = bottom.rest(i, j);
      }
    if (s > 2 * B) {
      const Number* const unseen = entries_.data() + (ends_[0].columns + B) * (2 * B + 1);
      for (std::size_t j = 0; j < s; ++j) matrix[B * s + j] = unseen[j];
    }
    return middle_.factor();
  }

  template <std::size_t B>
  void solve_narrow(Number* b) {
    solve_lower<B>(b);
    middle_.solve(b + ends_[0].columns);
    for (std::size_t end = 0; end < 2; ++end) insert_middle(end, b);
    if (filled_ > B) {
      solve_upper<2 * B, 2 * B>(b);
    } else {
      solve_upper<B, 2 * B>(b);
    }
  }

  /// turn(r, moved, k, inside) for k = 0, 1, ..., n - 1, where `inside` says that k + beyond < room. What moves through
  /// a window of `period` places by one each time stays where it is while r = k modulo `period` and moved = 0 are
  /// constants of the code; with r = 0 and moved = 1 the turn moves it. So it does for complex numbers, for which the
  /// registers would not last.
  template <std::size_t period, std::size_t beyond, class Turn>
  [[gnu::always_inline]] static void in_turns(std::size_t n, std::size_t room, Turn&& turn) {
    constexpr std::integral_constant<std::size_t, 0> zero;
    constexpr std::integral_constant<std::size_t, 1> one;
    std::size_t k = 0;
    if constexpr (std::is_floating_point_v<Number>) {
      for (; k + period <= n && k + period - 1 + beyond < room; k += period)
        detail::unrolled<0, period>([&](auto r) __attribute__((always_inline)) { turn(r, zero, k + r, true); });
    }
    for (; k < n; ++k) turn(zero, one, k, k + beyond < room);
  }

  /// The unknown i of an end, counted from there.
  [[gnu::always_inline]] Number& at(Number* b, std::size_t end, std::size_t i) const {
    return end == 0 ? b[i] : b[size_ - 1 - i];
  }

  /// b becomes D^-1 L^-1 P b.
  template <std::size_t lower>
  void solve_lower(Number* b) const {
    constexpr std::size_t period = lower + 1;
    const std::size_t columns = ends_[0].columns;
    std::array<std::array<Number, period>, 2> aheads{};  // b[k], ..., b[k + lower], as far as known, from place r on
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t i = 0; i < lower; ++i) aheads[e][i] = at(b, e, i);
    const auto turn = [&](auto r, auto moved, std::size_t k, bool inside) __attribute__((always_inline)) {
      detail::unrolled<0, 2>([&](auto e) __attribute__((always_inline)) {
        auto& ahead = aheads[e];
        ahead[(r + lower) % period] = inside ? at(b, e, k + lower) : Number{};
        if (const std::uint32_t pivot = ends_[e].pivots[k]; pivot != 0) {
          detail::unrolled<1, period>([&](auto i) __attribute__((always_inline)) {
            if (pivot == i) std::swap(ahead[r], ahead[(r + i) % period]);
          });
        }
        const Number known = ahead[r];
        const Number* const left = ends_[e].left_factors.data() + k * lower;
        at(b, e, k) = known * ends_[e].inverse[k];
        detail::unrolled<1, period>([&](auto i) __attribute__((always_inline)) {
          ahead[(r + i - moved) % period] = ahead[(r + i) % period] - left[i - 1] * known;
        });
      });
    };
    in_turns<period, lower>(columns, size_, turn);
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t i = 0; i < lower; ++i) at(b, e, columns + i) = aheads[e][i];
  }

  /// Takes the unknowns of the middle out of the rows of an end.
  void insert_middle(std::size_t e, Number* b) const {
    const std::size_t room = lower_ + upper_, columns = ends_[e].columns;
    for (std::size_t c = columns; c < columns + filled_; ++c)
      for (std::size_t i = c - columns + 1; i <= filled_; ++i)
        at(b, e, c - i) -= ends_[e].right_factors[(c + 1) * room - i] * at(b, e, c);
  }

  /// b becomes U^-1 b, where U has entries in `upper` columns behind the diagonal, and room for `room`.
  template <std::size_t upper, std::size_t room>
  void solve_upper(Number* b) const {
    constexpr std::size_t period = upper + 1;
    const std::size_t columns = ends_[0].columns;
    std::array<std::array<Number, period>, 2> aheads{};  // b[k], ..., b[k - upper], as far as known, from place r on
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t i = 0; i < std::min(upper, columns); ++i) aheads[e][i] = at(b, e, columns - 1 - i);
    const auto turn = [&](auto r, auto moved, std::size_t j, bool inside) __attribute__((always_inline)) {
      const std::size_t k = columns - 1 - j;
      detail::unrolled<0, 2>([&](auto e) __attribute__((always_inline)) {
        auto& ahead = aheads[e];
        ahead[(r + upper) % period] = inside ? at(b, e, k - upper) : Number{};
        const Number known = at(b, e, k) = ahead[r];
        const Number* const column = ends_[e].right_factors.data() + (k + 1) * room;
        detail::unrolled<1, period>([&](auto i) __attribute__((always_inline)) {
          ahead[(r + i - moved) % period] = ahead[(r + i) % period] - *(column - i) * known;
        });
      });
    };
    in_turns<period, upper>(columns, columns, turn);
  }

  void solve_wide(Number* b) const {
    const End& end = ends_[0];
    for (std::size_t k = 0; k < size_; ++k) {
      if (end.pivots[k] != 0) std::swap(b[k], b[k + end.pivots[k]]);
      const Number* const left = end.left_factors.data() + k * lower_;
      const std::size_t below = std::min(lower_, size_ - 1 - k);
      const Number known = b[k];
      Number* const rest = b + k + 1;
      for (std::size_t i = 0; i < below; ++i) rest[i] -= left[i] * known;
      b[k] = known * end.inverse[k];
    }
    for (std::size_t k = size_; k-- > 0;) {
      const std::size_t room = lower_ + upper_, above = std::min(filled_, k);
      const Number* const column = end.right_factors.data() + (k + 1) * room - above;
      const Number known = b[k];
      Number* const rest = b + (k - above);
      for (std::size_t i = 0; i < above; ++i) rest[i] -= column[i] * known;
    }
  }

  std::size_t size_ = 0, lower_ = 0, upper_ = 0;
  std::size_t filled_ = 0;  // how far U reaches: upper, and further by pivoting
  std::vector<Number> entries_;
  std::array<End, 2> ends_{};
  DenseLU<Number> middle_{0};
  std::vector<Number> window_;  // see BandElimination; empty where it is in registers
};

extern template class BandedLU<double>;
extern template class BandedLU<ComplexNumber<double>>;

}  // namespace continuo
