// The factorization of a narrow band whose rows may stay where they are, as they mostly may: U reaches no further than
// the band, and both ends go through the same arithmetic, each in a lane of one register. BandedLU says the rest.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <continuo/numerics/band_end.hpp>
#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/elimination/small_lu.hpp>

namespace continuo::detail {

/// A number for the first end and one for the second.
template <class Number>
struct BothEnds {
  Number top, bottom;

  friend BothEnds operator-(const BothEnds& a, const BothEnds& b) { return {a.top - b.top, a.bottom - b.bottom}; }
  friend BothEnds operator*(const BothEnds& a, const BothEnds& b) { return {a.top * b.top, a.bottom * b.bottom}; }
  [[nodiscard]] const Number& first() const { return top; }
  [[nodiscard]] const Number& second() const { return bottom; }
  void set(std::size_t end, const Number& number) { (end == 0 ? top : bottom) = number; }
};
template <>
struct BothEnds<double> {
  using Register [[gnu::vector_size(16)]] = double;
  Register both;

  BothEnds() : both{} {}
  BothEnds(double top_, double bottom_) : both{top_, bottom_} {}
  explicit BothEnds(const Register& both_) : both(both_) {}
  friend BothEnds operator-(const BothEnds& a, const BothEnds& b) { return BothEnds(a.both - b.both); }
  friend BothEnds operator*(const BothEnds& a, const BothEnds& b) { return BothEnds(a.both * b.both); }
  [[nodiscard]] double first() const { return both[0]; }
  [[nodiscard]] double second() const { return both[1]; }
  void set(std::size_t end, double number) { both[end] = number; }
};

/// y_i = b_i - sum_q c_iq y_(i-q) for i = 0, 1, ..., q = 1 ... B. Each y waits for the one before it, a product and a
/// difference long. Of real numbers four are therefore made at a time where the band is at most two wide: they go
/// through each other before the ones ahead of them are known, with which they are then joined by as many products as
/// the band is wide (S. C. Chen, D. J. Kuck, IEEE Trans. Comput. C-24 (1975) 701-717, for linear recurrences).
template <class Number>
class BandRecurrence {
 public:
  using Both = BothEnds<Number>;

  BandRecurrence() = default;
  BandRecurrence(std::size_t size, std::size_t width)
      : coefficients_(size * width), joining_(size / group * group * width) {}

  template <std::size_t B>
  [[nodiscard]] [[gnu::always_inline]] Both& coefficient(std::size_t i, std::size_t q) {
    return coefficients_[i * B + q - 1];
  }

  /// To be called when the coefficients are there.
  template <std::size_t B>
  void prepare() {
    if constexpr (!is_grouped<B>()) return;
    for (std::size_t i = 0; i + group <= coefficients_.size() / B; i += group) {
      const Both* const c = coefficients_.data() + i * B;
      Both* const joining = joining_.data() + i * B;
      unrolled<0, group>([&](auto r) __attribute__((always_inline)) {
        unrolled<1, B + 1>([&](auto q) __attribute__((always_inline)) {  // of the one q before the group
          Both sum = r + q <= B ? c[r * B + r + q - 1] : Both{};
          unrolled<1, std::min<std::size_t>(r, B) + 1>([&](auto p) __attribute__((always_inline)) {
            sum = sum - c[r * B + p - 1] * joining[(r - p) * B + q - 1];
          });
          joining[r * B + q - 1] = sum;
        });
      });
    }
  }

  /// For i < n; y holds y_-1, y_-2, ..., y_-B, and becomes the last ones. get(i) is b_i, put(i, y_i) what becomes of
  /// it.
  template <std::size_t B, class Get, class Put>
  [[gnu::always_inline]] void run(std::size_t n, std::array<Both, B>& y, Get&& get, Put&& put) const {
    std::size_t i = 0;
    const Both* c = coefficients_.data();
    if constexpr (is_grouped<B>()) {
      for (const Both* joining = joining_.data(); i + group <= n; i += group, c += group * B, joining += group * B) {
        std::array<Both, group> made;
        unrolled<0, group>([&](auto r) __attribute__((always_inline)) {
          made[r] = get(i + r);
          unrolled<1, std::min<std::size_t>(r, B) + 1>(
              [&](auto p) __attribute__((always_inline)) { made[r] = made[r] - c[r * B + p - 1] * made[r - p]; });
        });
        unrolled<0, group>([&](auto r) __attribute__((always_inline)) {
          unrolled<0, B>([&](auto q) __attribute__((always_inline)) { made[r] = made[r] - joining[r * B + q] * y[q]; });
          put(i + r, made[r]);
        });
        unrolled<0, B>([&](auto q) __attribute__((always_inline)) { y[q] = made[group - 1 - q]; });
      }
    }
    for (; i < n; ++i, c += B) {
      Both made = get(i);
      unrolled<0, B>([&](auto q) __attribute__((always_inline)) { made = made - c[B - 1 - q] * y[B - 1 - q]; });
      put(i, made);
      unrolled<1, B>([&](auto q) __attribute__((always_inline)) { y[B - q] = y[B - 1 - q]; });
      y[0] = made;
    }
  }

 private:
  static constexpr std::size_t group = 4;
  template <std::size_t B>
  [[nodiscard]] static constexpr bool is_grouped() {
    return std::is_same_v<Number, double> && B <= 2;
  }

  std::vector<Both> coefficients_;  // by i, those of the nearest first
  std::vector<Both> joining_;       // of the numbers before the group, for each of a group
};

/// The factors of as many columns at either end.
template <class Number>
struct StraightFactors {
  using Both = BothEnds<Number>;

  std::size_t columns = 0;
  std::vector<Both> inverse;            // of D
  BandRecurrence<Number> lower, upper;  // L and U without their diagonals; U from its last row on
  std::vector<Both> below;              // of L in the rows of the middle

  StraightFactors() = default;
  StraightFactors(std::size_t columns_, std::size_t width)
      : columns(columns_), inverse(columns), lower(columns, width), upper(columns, width), below(width * width) {}

  template <std::size_t B>
  [[nodiscard]] [[gnu::always_inline]] Both& in_lower(std::size_t row, std::size_t column) {
    if (row < columns) return lower.template coefficient<B>(row, row - column);
    return below[(row - columns) * B + columns - 1 - column];
  }
  template <std::size_t B>
  [[nodiscard]] [[gnu::always_inline]] Both& in_upper(std::size_t row, std::size_t column) {
    return upper.template coefficient<B>(columns - 1 - row, column - row);
  }
  template <std::size_t B>
  void prepare() {
    lower.template prepare<B>();
    upper.template prepare<B>();
  }

  /// The unknowns i of both ends, each counted from there.
  [[nodiscard]] [[gnu::always_inline]] static Both get(const Number* b, const Number* last, std::size_t i) {
    return {b[i], *(last - i)};
  }
  [[gnu::always_inline]] static void put(const Both& value, std::size_t i, Number* b, Number* last) {
    b[i] = value.first(), *(last - i) = value.second();
  }

  /// b ... last become D^-1 L^-1 b.
  template <std::size_t B>
  void solve_lower(Number* b, Number* last) const {
    std::array<Both, B> y{};
    lower.template run<B>(
        columns, y, [&](std::size_t i) __attribute__((always_inline)) { return get(b, last, i); },
        [&](std::size_t i, const Both& known) __attribute__((always_inline)) { put(known * inverse[i], i, b, last); });
    for (std::size_t i = 0; i < B; ++i) {
      Both rest = get(b, last, columns + i);
      for (std::size_t q = 0; q + i < B; ++q) rest = rest - below[i * B + q] * y[q];
      put(rest, columns + i, b, last);
    }
  }

  /// b ... last, of which the middle is known, become U^-1 b.
  template <std::size_t B>
  void solve_upper(Number* b, Number* last) const {
    std::array<Both, B> y;
    for (std::size_t q = 0; q < B; ++q) y[q] = get(b, last, columns + q);
    upper.template run<B>(
        columns, y, [&](std::size_t i) __attribute__((always_inline)) { return get(b, last, columns - 1 - i); },
        [&](std::size_t i, const Both& known) __attribute__((always_inline)) { put(known, columns - 1 - i, b, last); });
  }
};

/// Under way at one end. `window`: rows and columns k ... k + B as they are when column k is to be eliminated.
template <class Number, class Rows, std::size_t B>
class StraightElimination {
 public:
  [[gnu::always_inline]] StraightElimination(StraightFactors<Number>& factors, std::size_t end, const Rows& rows)
      : factors_(factors), end_(end), rows_(rows) {
    unrolled<0, B + 1>([&](auto i) __attribute__((always_inline)) {
      unrolled<0, B + 1>([&](auto j) __attribute__((always_inline)) { window_[i][j] = rows(i, B + j - i, B); });
    });
  }

  /// What is left of row columns + i, from column `columns` on.
  [[nodiscard]] [[gnu::always_inline]] Number rest(std::size_t i, std::size_t j) const {
    if (j <= B) return window_[i][j];
    return j <= B + i ? rows_(factors_.columns + i, B + j - i, B) : Number{};
  }
  /// Entry j of a row of the matrix.
  [[nodiscard]] [[gnu::always_inline]] Number row(std::size_t i, std::size_t j) const { return rows_(i, j, B); }

  /// Column k. False where its pivot is zero or not a number, or another one of the column is greater.
  [[nodiscard]] [[gnu::always_inline]] bool eliminate(std::size_t k) {
    const auto greatest = magnitude(window_[0][0]);
    bool stays = greatest > 0 && greatest - greatest == 0;
    unrolled<1, B + 1>([&](auto i)
                           __attribute__((always_inline)) { stays = stays && !(magnitude(window_[i][0]) > greatest); });
    if (!stays) return false;
    const Number inverse = reciprocal(window_[0][0]);
    factors_.inverse[k].set(end_, inverse);
    const auto pivot_row = window_[0];
    unrolled<1, B + 1>([&](auto j) __attribute__((always_inline)) {
      factors_.template in_upper<B>(k, k + j).set(end_, pivot_row[j] * inverse);
    });
    unrolled<1, B + 1>([&](auto i) __attribute__((always_inline)) {
      const Number below = window_[i][0];
      factors_.template in_lower<B>(k + i, k).set(end_, below * inverse);
      unrolled<1, B + 1>([&](auto j) __attribute__((always_inline)) {
        // The next pivot waits for the reciprocal, but not for a product more.
        window_[i - 1][j - 1] = window_[i][j] - (below * pivot_row[j]) * inverse;
      });
      window_[i - 1][B] = rows_(k + i, std::integral_constant<std::size_t, 2 * B + 1 - i>{}, B);
    });
    unrolled<0, B + 1>([&](auto j) __attribute__((always_inline)) { window_[B][j] = rows_(k + 1 + B, j, B); });
    return true;
  }

 private:
  StraightFactors<Number>& factors_;
  std::size_t end_;
  Rows rows_;
  std::array<std::array<Number, B + 1>, B + 1> window_;
};

}  // namespace continuo::detail
