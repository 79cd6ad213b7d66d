// continuo/numerics/elimination/listed_lu.hpp
// LU factorization of matrices of some ten to thirty rows that are mostly zeros, as those of chemical systems are. What
// there is to do is listed once, in an order that leaves most zeros what they are, and done for every matrix with the
// same zeros: P A Q = L D U with unit diagonals as in small_lu.hpp.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <continuo/numerics/complex_number.hpp>

namespace continuo {

inline constexpr std::size_t greatest_listed_size = 32;

namespace detail {

/// The pivots of elimination and what they leave to do. The pivot with the fewest entries beside and below it comes
/// next, (r - 1) (c - 1) being least, of those that are not much smaller than the rest of their column (H. Markowitz,
/// Management Sci. 3 (1957); threshold: I. Duff, A. Erisman, J. Reid, "Direct Methods for Sparse Matrices", 7.2).
template <std::size_t N>
class EliminationList {
 public:
  static_assert(N <= greatest_listed_size);
  /// Beyond this many products elimination is faster without a list.
  static constexpr std::size_t most_products = N * N * 2;

  std::array<std::uint8_t, N> row{}, column{};  // of each pivot in turn
  /// The values: for each pivot itself, the entries below it, the entries on its right. At `first` of the pivot, at
  /// `below`, at `right`, up to the next one's `first`.
  std::array<std::uint16_t, N + 1> first{}, below{}, right{};
  std::array<std::uint16_t, N * N> entry{};           // of each value, in the matrix row by row
  std::array<std::uint8_t, N * N> unknown{};          // of each value: the place that its row (below) or its column
                                                      // (right) has among the pivots
  std::array<std::uint16_t, most_products> target{};  // the value that changes by below * right, pivot after pivot
  [[nodiscard]] std::size_t values() const { return first[N]; }

  enum class Result { done, singular, too_many };

  /// Learns the zeros of `matrix`, besides those it knows, and takes pivots by its numbers.
  template <class Number>
  [[nodiscard]] Result choose(std::array<Number, N * N> matrix, double least_pivot) {
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < N; ++j)
        if (!(matrix[i * N + j] == Number{})) pattern_[i] |= bit(j);
    std::array<std::uint32_t, N> rows = pattern_, columns{};  // of what is left, filling up
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < N; ++j)
        if (rows[i] & bit(j)) columns[j] |= bit(i);
    std::array<std::uint32_t, N> right_of{}, below_of{};
    for (std::size_t k = 0; k < N; ++k) {
      const auto [i, j] = cheapest(matrix, rows, columns, least_pivot);
      if (i == N) return Result::singular;
      row[k] = static_cast<std::uint8_t>(i);
      column[k] = static_cast<std::uint8_t>(j);
      right_of[k] = rows[i] & ~bit(j);
      below_of[k] = columns[j] & ~bit(i);
      eliminate(matrix, rows, columns, i, j);
    }
    return list(right_of, below_of);
  }

 private:
  struct Place {
    std::size_t row, column;
  };
  [[nodiscard]] static constexpr std::uint32_t bit(std::size_t i) { return std::uint32_t{1} << i; }
  template <class Visit>
  static void for_each_bit(std::uint32_t set, Visit&& visit) {
    for (; set != 0; set &= set - 1) visit(static_cast<std::size_t>(std::countr_zero(set)));
  }

  /// Row N where a column has nothing to divide by.
  template <class Number>
  [[nodiscard]] static Place cheapest(const std::array<Number, N * N>& matrix, const std::array<std::uint32_t, N>& rows,
                                      const std::array<std::uint32_t, N>& columns, double least_pivot) {
    Place best{N, N};
    int least_cost = std::numeric_limits<int>::max();
    double best_ratio = 0;
    for (std::size_t j = 0; j < N; ++j) {
      if (columns[j] == 0) continue;  // done
      using Real = decltype(magnitude(matrix[0]));
      Real greatest(0);
      for_each_bit(columns[j], [&](std::size_t i) {
        const Real size = magnitude(matrix[i * N + j]);
        if (!(size <= greatest)) greatest = size;
      });
      if (!(greatest > 0) || !(greatest - greatest == 0)) return {N, N};
      const int in_column = std::popcount(columns[j]) - 1;
      for_each_bit(columns[j], [&](std::size_t i) {
        const auto ratio = static_cast<double>(magnitude(matrix[i * N + j]) / greatest);
        const int cost = in_column * (std::popcount(rows[i]) - 1);
        if (ratio < least_pivot || cost > least_cost || (cost == least_cost && ratio <= best_ratio)) return;
        best = {i, j};
        least_cost = cost;
        best_ratio = ratio;
      });
    }
    return best;
  }

  template <class Number>
  static void eliminate(std::array<Number, N * N>& matrix, std::array<std::uint32_t, N>& rows,
                        std::array<std::uint32_t, N>& columns, std::size_t i, std::size_t j) {
    const Number inverse = reciprocal(matrix[i * N + j]);
    const std::uint32_t right = rows[i] & ~bit(j), below = columns[j] & ~bit(i);
    for_each_bit(below, [&](std::size_t r) {
      const Number factor = matrix[r * N + j] * inverse;
      for_each_bit(right, [&](std::size_t c) { matrix[r * N + c] -= factor * matrix[i * N + c]; });
      rows[r] = (rows[r] | right) & ~bit(j);
    });
    for_each_bit(right, [&](std::size_t c) { columns[c] = (columns[c] | below) & ~bit(i); });
    rows[i] = columns[j] = 0;
  }

  [[nodiscard]] Result list(const std::array<std::uint32_t, N>& right_of,
                            const std::array<std::uint32_t, N>& below_of) {
    std::array<std::uint8_t, N> turn_of_row{}, turn_of_column{};
    for (std::size_t k = 0; k < N; ++k) {
      turn_of_row[row[k]] = static_cast<std::uint8_t>(k);
      turn_of_column[column[k]] = static_cast<std::uint8_t>(k);
    }
    std::array<std::uint16_t, N * N> value_of{};
    std::uint16_t count = 0;
    const auto add = [&](std::size_t i, std::size_t j, std::uint8_t turn) {
      entry[count] = static_cast<std::uint16_t>(i * N + j);
      unknown[count] = turn;
      value_of[i * N + j] = count++;
    };
    for (std::size_t k = 0; k < N; ++k) {
      first[k] = count;
      add(row[k], column[k], static_cast<std::uint8_t>(k));
      below[k] = count;
      for_each_bit(below_of[k], [&](std::size_t i) { add(i, column[k], turn_of_row[i]); });
      right[k] = count;
      for_each_bit(right_of[k], [&](std::size_t j) { add(row[k], j, turn_of_column[j]); });
    }
    first[N] = count;
    std::size_t products = 0;
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t p = below[k]; p < right[k]; ++p)
        for (std::size_t q = right[k]; q < first[k + 1]; ++q) {
          if (products == most_products) return Result::too_many;
          target[products++] = value_of[entry[p] / N * N + entry[q] % N];
        }
    }
    return Result::done;
  }

  std::array<std::uint32_t, N> pattern_{};  // by rows
};

template <class Number, std::size_t N>
class ListedLU {
 public:
  enum class Result { done, singular, not_listed };

  /// `not_listed`: the matrix has too few zeros, or the pivots have to change too often.
  [[nodiscard]] Result factor(const std::array<Number, N * N>& matrix) {
    if (hopeless_) return Result::not_listed;
    if (has_list_ && eliminate(matrix)) {
      credit_ += credit_ < most_credit ? 1 : 0;
      return Result::done;
    }
    if (credit_ < price_of_list) {
      ++credit_;
      return Result::not_listed;
    }
    credit_ -= price_of_list;
    const auto result = list_.choose(matrix, least_pivot);
    has_list_ = result == EliminationList<N>::Result::done;
    hopeless_ = result == EliminationList<N>::Result::too_many;
    if (hopeless_) return Result::not_listed;
    return has_list_ && eliminate(matrix) ? Result::done : Result::singular;
  }

  /// b becomes the solution.
  void solve(Number* b) const {
    std::array<Number, N> y;
    for (std::size_t k = 0; k < N; ++k) y[k] = b[list_.row[k]];
    for (std::size_t k = 0; k < N; ++k) {
      const Number known = y[k];
      for (std::size_t p = list_.below[k]; p < list_.right[k]; ++p) y[list_.unknown[p]] -= value_[p] * known;
      y[k] = known * value_[list_.first[k]];
    }
    for (std::size_t k = N; k-- > 0;) {
      Number sum = y[k];
      for (std::size_t p = list_.right[k]; p < list_.first[k + 1]; ++p) sum -= value_[p] * y[list_.unknown[p]];
      y[k] = sum;
    }
    for (std::size_t k = 0; k < N; ++k) b[list_.column[k]] = y[k];
  }

 private:
  // A pivot is at least this part of the greatest number in its column when it is chosen, and is kept while it is at
  // least the second part.
  static constexpr double least_pivot = 0.1, least_kept_pivot = 0.01;
  // To find a list costs as much as many an elimination: the first few are free, for zeros of the start of a run that
  // do not last; then there is one for as many eliminations at most.
  static constexpr int price_of_list = 16, most_credit = 6 * price_of_list;

  /// With the pivots there are. False where they will not do.
  [[nodiscard]] bool eliminate(const std::array<Number, N * N>& matrix) {
    using Real = decltype(magnitude(matrix[0]));
    const std::size_t values = list_.values();
    std::int64_t listed = 0, all = 0;
    for (std::size_t p = 0; p < values; ++p) {
      value_[p] = matrix[list_.entry[p]];
      listed += numbers_in(value_[p]);
    }
    for (const Number& number : matrix) all += numbers_in(number);
    if (all != listed) return false;
    constexpr Real most(1 / least_kept_pivot);
    bool good = true;
    const std::uint16_t* target = list_.target.data();
    for (std::size_t k = 0; k < N; ++k) {
      const std::size_t below = list_.below[k], right = list_.right[k], end = list_.first[k + 1];
      Number& pivot = value_[list_.first[k]];
      const Real size_of_pivot = magnitude(pivot);
      good = good && size_of_pivot > 0 && size_of_pivot - size_of_pivot == 0;
      const Number inverse = pivot = reciprocal(pivot);
      for (std::size_t p = below; p < right; ++p) {
        const Number factor = value_[p] = value_[p] * inverse;
        good = good && magnitude(factor) <= most;
        for (std::size_t q = right; q < end; ++q) value_[*target++] -= factor * value_[q];
      }
      for (std::size_t q = right; q < end; ++q) value_[q] = value_[q] * inverse;
    }
    return good;
  }

  template <class Real>
  [[nodiscard]] static std::int64_t numbers_in(const ComplexNumber<Real>& z) {
    return (z.re != Real(0) ? 1 : 0) + (z.im != Real(0) ? 1 : 0);
  }
  template <class Real>
  [[nodiscard]] static std::int64_t numbers_in(const Real& x) {
    return x != Real(0) ? 1 : 0;
  }

  EliminationList<N> list_;
  std::array<Number, N * N> value_{};  // of the list: 1/D, L, U
  int credit_ = most_credit;
  bool has_list_ = false, hopeless_ = false;
};

}  // namespace detail
}  // namespace continuo
