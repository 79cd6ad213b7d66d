// LU factorization with partial pivoting of a matrix c M - J whose entries lie near its diagonal, P A = L D U with unit
// diagonals as in small_lu.hpp. The numbers are double or ComplexNumber<double>, which banded_lu.cpp is compiled for.
//
//   const BandLayout band(n, lower, upper);
//   std::vector<double> j(band.numbers());
//   j[band.place(row, column)] = ...;        // for row - lower <= column <= row + upper, the others are zero
//   BandedLU<double> lu(band);
//   if (lu.factor(j, c)) lu.solve(b);        // (c - j) x = b
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
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/band_end.hpp>
#include <continuo/numerics/band_layout.hpp>
#include <continuo/numerics/band_straight.hpp>
#include <continuo/numerics/dense_lu.hpp>

namespace continuo {

/// The factors of a band matrix, which solve for as many right-hand sides as wanted. For a matrix of n rows, factoring
/// costs about n * lower * (lower + upper) products, a solution n * (2 lower + upper).
template <class Number>
class BandedLU {
 public:
  using Real = decltype(magnitude(Number{}));

  BandedLU() = default;
  /// Allocates for matrices of this layout; nothing is allocated afterwards.
  explicit BandedLU(const BandLayout& layout);

  /// The number of rows.
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Decomposes c M - J. `jacobian` is J as it lies in the layout, `mass` the diagonal of M, or empty for the identity.
  /// False where a pivot is zero or not a number: the matrix is singular, or was not finite.
  [[nodiscard]] bool factor(std::span<const Real> jacobian, const Number& c, std::span<const Real> mass = {});

  /// b becomes the solution.
  void solve(Number* b);

 private:
  using End = detail::BandEnd<Number>;
  template <int direction>
  using Rows = detail::BandRows<Number, Real, direction>;
  using FromTop = Rows<1>;
  using FromBottom = Rows<-1>;

  [[nodiscard]] bool is_wide() const { return ends_[1].columns == 0; }

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

  [[nodiscard]] bool factor_wide(const FromTop& rows) {
    detail::BandElimination<Number, FromTop, std::size_t, std::size_t, std::vector<Number>&> elimination(
        ends_[0], rows, lower_, lower_ + upper_, window_);
    for (std::size_t k = 0; k < size_; ++k)
      if (!elimination.eliminate(k)) return false;
    reach_ = upper_ + ends_[0].lowest;
    return true;
  }

  template <std::size_t B, class Rows>
  using Pivoting =
      detail::BandElimination<Number, Rows, std::integral_constant<std::size_t, B>,
                              std::integral_constant<std::size_t, 2 * B>, std::array<Number, (B + 2) * (2 * B + 1)>>;

  /// Mostly the diagonal has the greatest entries: that is tried first.
  template <std::size_t B>
  [[nodiscard]] bool factor_narrow(const FromTop& top, const FromBottom& bottom) {
    reach_ = B;
    if (eliminate<B>(detail::StraightElimination<Number, FromTop, B>(straight_, 0, top),
                     detail::StraightElimination<Number, FromBottom, B>(straight_, 1, bottom))) {
      straight_.template prepare<B>();
      return middle_.factor();
    }
    reach_ = 2 * B;
    return eliminate<B>(Pivoting<B, FromTop>(ends_[0], top, {}, {}, {}),
                        Pivoting<B, FromBottom>(ends_[1], bottom, {}, {}, {})) &&
           middle_.factor();
  }

  template <std::size_t B, class Top, class Bottom>
  [[nodiscard]] [[gnu::always_inline]] bool eliminate(Top top, Bottom bottom) {
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
    if (regular) fill_middle<B>(top, bottom);
    return regular;
  }

  /// What both ends have left over, and the row that neither has seen where there is one. Compiled into the caller and
  /// written out, as the windows would not be in registers otherwise.
  template <std::size_t B, class Top, class Bottom>
  [[gnu::always_inline]] void fill_middle(const Top& top, const Bottom& bottom) {
    const std::size_t s = middle_.size();
    auto& matrix = middle_.matrix();
    std::fill(matrix.begin(), matrix.end(), Number{});
    detail::unrolled<0, B>([&](auto i) __attribute__((always_inline)) {
      detail::unrolled<0, 2 * B>([&](auto j) __attribute__((always_inline)) {
        matrix[i * s + j] = top.rest(i, j);
        matrix[(s - 1 - i) * s + s - 1 - j] = bottom.rest(i, j);
      });
    });
    if (s > 2 * B) {
      for (std::size_t j = 0; j < s; ++j) matrix[B * s + j] = top.row(ends_[0].columns + B, j);
    }
  }

  template <std::size_t B>
  void solve_narrow(Number* b) {
    if (reach_ == B) {
      straight_.template solve_lower<B>(b, b + size_ - 1);
      middle_.solve(b + straight_.columns);
      straight_.template solve_upper<B>(b, b + size_ - 1);
    } else {
      solve_lower<B>(b);
      middle_.solve(b + ends_[0].columns);
      for (std::size_t end = 0; end < 2; ++end) insert_middle(end, b);
      solve_upper<2 * B>(b);
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
  [[nodiscard]] [[gnu::always_inline]] Number& at(Number* b, std::size_t end, std::size_t i) const {
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
    const std::size_t columns = ends_[e].columns;
    for (std::size_t c = columns; c < columns + reach_; ++c)
      for (std::size_t i = c - columns + 1; i <= reach_; ++i)
        at(b, e, c - i) -= ends_[e].right_factors[(c + 1) * reach_ - i] * at(b, e, c);
  }

  /// b becomes U^-1 b, where U has entries in `upper` columns behind the diagonal.
  template <std::size_t upper>
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
        const Number* const column = ends_[e].right_factors.data() + (k + 1) * upper;
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
      const std::size_t room = lower_ + upper_, above = std::min(reach_, k);
      const Number* const column = end.right_factors.data() + (k + 1) * room - above;
      const Number known = b[k];
      Number* const rest = b + (k - above);
      for (std::size_t i = 0; i < above; ++i) rest[i] -= column[i] * known;
    }
  }

  BandLayout layout_;
  std::size_t size_ = 0, lower_ = 0, upper_ = 0;  // those of the layout
  // How far U reaches: upper, and further by pivoting. As many numbers each of its columns has where the band is
  // narrow.
  std::size_t reach_ = 0;
  std::array<End, 2> ends_{};
  detail::StraightFactors<Number> straight_;  // instead of theirs, where no row of a narrow band has to move
  DenseLU<Number> middle_{0};
  std::vector<Number> window_;  // see BandElimination; empty where it is in registers
};

extern template class BandedLU<double>;
extern template class BandedLU<ComplexNumber<double>>;

}  // namespace continuo
