// continuo/numerics/elimination/sparse_elimination.hpp
// The elimination of sparse matrices of one pattern with pivots that are known, as a list of what there is to do: for
// matrices of some dozen to some hundred rows this takes a fraction of the time of a general sparse solver, which is
// spent on columns of three entries.
//
//   SparseElimination<double> elimination;
//   if (elimination.plan(pattern_starts, pattern_rows, {rows, columns, blocks}))
//     elimination.scale_by(values);
//   if (elimination.factor(values)) elimination.solve(b);
//
// The matrix, its rows and columns in the order of the pivots, is block upper triangular: D L U with unit diagonals in
// each block, and above the blocks the entries divided by the pivot of their row. So a solution divides the right side
// by the pivots, and all that is left are products of one kind, which are listed for the whole matrix: those that do
// not wait for each other come together, so that the processor has several at once at work.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <continuo/numerics/complex_number.hpp>

namespace continuo::detail {

/// Pivots in their order: row[k] and column[k] of pivot k, and the first pivot of each block, with the number of pivots
/// at the end.
struct PivotOrder {
  std::span<const std::int32_t> row, column, blocks;
};

template <class Number>
class SparseElimination {
 public:
  /// Lists what there is to do for the matrices of a pattern (the first entry of each column, the row of each entry)
  /// with these pivots. False where the list would be too long to pay, or the matrix is not of these blocks.
  [[nodiscard]] bool plan(std::span<const std::int32_t> starts, std::span<const std::int32_t> rows, PivotOrder pivots) {
    if (pivots.row.size() > greatest_size) return false;
    if (std::ranges::equal(pivots.row, row_) && std::ranges::equal(pivots.column, column_) &&
        std::ranges::equal(pivots.blocks, blocks_))
      return is_listed_;
    row_.assign(pivots.row.begin(), pivots.row.end());
    column_.assign(pivots.column.begin(), pivots.column.end());
    blocks_.assign(pivots.blocks.begin(), pivots.blocks.end());
    is_listed_ = list(starts, rows);
    return is_listed_;
  }

  /// Rows are scaled from now on by the powers of two that bring the greatest entry of each in this matrix near one.
  void scale_by(const Number* values) {
    std::vector<double> greatest(row_.size(), 0.0);
    for (std::size_t p = 0; p < place_.size(); ++p)
      greatest[entry_row_[p]] = std::max(greatest[entry_row_[p]], magnitude(values[p]));
    scale_.resize(row_.size());
    for (std::size_t k = 0; k < row_.size(); ++k) {
      const double size = greatest[k];
      scale_[k] = size > 0 && std::isfinite(size) ? std::ldexp(1.0, std::clamp(-std::ilogb(size), -1000, 1000)) : 1.0;
    }
  }

  /// False where a pivot is zero, not finite, or much smaller than what it divides.
  [[nodiscard]] bool factor(const Number* values) {
    std::ranges::fill(value_, Number{});
    for (std::size_t p = 0; p < place_.size(); ++p) value_[place_[p]] = scaled(values[p], scale_[entry_row_[p]]);
    bool good = true;
    const std::uint32_t* target = target_.data();
    for (std::size_t k = 0; k < row_.size(); ++k) {
      const std::size_t below = below_[k], right = right_[k], end = first_[k + 1];
      Number& pivot = value_[first_[k]];
      const double size_of_pivot = magnitude(pivot);
      good = good && size_of_pivot > 0 && std::isfinite(size_of_pivot);
      const Number inverse = pivot = reciprocal(pivot);
      for (std::size_t p = below; p < right; ++p) {
        const Number factor = value_[p] * inverse;
        good = good && magnitude(factor) <= greatest_multiplier;
        for (std::size_t q = right; q < end; ++q) value_[*target++] -= factor * value_[q];
      }
      for (std::size_t q = right; q < end; ++q) value_[q] = value_[q] * inverse;
    }
    divide_by_pivots();
    return good;
  }

  /// b becomes the solution. `factor` must have succeeded.
  void solve(Number* b) {
    for (std::size_t k = 0; k < row_.size(); ++k) y_[k] = start_[k] * b[row_[k]];
    for (const Product& one : products_) y_[one.target] -= value_[one.value] * y_[one.source];
    for (std::size_t k = 0; k < row_.size(); ++k) b[column_[k]] = y_[k];
  }

 private:
  // Beyond these a list is no faster than a solver that goes column by column, and the list would fill the cache.
  static constexpr std::size_t greatest_size = 500, most_products = 50'000;
  // Pivots that were chosen for a matrix have multipliers up to some thousand (KLU prefers the diagonal down to a
  // thousandth). Kept ones cost at most a digit more.
  static constexpr double greatest_multiplier = 1e4;

  [[nodiscard]] static double scaled(double x, double scale) { return x * scale; }
  [[nodiscard]] static ComplexNumber<double> scaled(const ComplexNumber<double>& z, double scale) {
    return {z.re * scale, z.im * scale};
  }

  /// The entries of one block, its rows and columns from 0: as bits, then as places in `value_`.
  struct Block {
    std::size_t first, size;
    std::vector<char> is_there;
    std::vector<std::uint32_t> value;
    Block(std::size_t first_, std::size_t size_) : first(first_), size(size_), is_there(size_ * size_, 0) {}
  };

  /// y[target] -= value * y[source].
  struct Product {
    std::uint32_t target, source, value;
  };

  /// The entries below the pivots and above the blocks are those of L and of what lies beside it in the same rows.
  void divide_by_pivots() {
    const auto divide = [&](std::size_t from, std::size_t to) {
      for (std::size_t p = from; p < to; ++p) value_[p] = value_[p] * value_[first_[unknown_[p]]];
    };
    for (std::size_t k = 0; k < row_.size(); ++k) {
      start_[k] = scaled(value_[first_[k]], scale_[k]);
      divide(below_[k], right_[k]);
      divide(above_[k], above_[k + 1]);
    }
  }

  [[nodiscard]] bool list(std::span<const std::int32_t> starts, std::span<const std::int32_t> rows) {
    const std::size_t size = row_.size();
    std::vector<std::size_t> turn_of_row(size), turn_of_column(size), block_of(size);
    for (std::size_t k = 0; k < size; ++k) {
      turn_of_row[static_cast<std::size_t>(row_[k])] = k;
      turn_of_column[static_cast<std::size_t>(column_[k])] = k;
    }
    std::vector<Block> blocks;
    for (std::size_t b = 0; b + 1 < blocks_.size(); ++b) {
      const auto begin = static_cast<std::size_t>(blocks_[b]), end = static_cast<std::size_t>(blocks_[b + 1]);
      blocks.emplace_back(begin, end - begin);
      std::fill(block_of.begin() + blocks_[b], block_of.begin() + blocks_[b + 1], b);
    }
    for (std::size_t j = 0; j < size; ++j)
      for (auto p = static_cast<std::size_t>(starts[j]); p < static_cast<std::size_t>(starts[j + 1]); ++p) {
        const std::size_t r = turn_of_row[static_cast<std::size_t>(rows[p])], c = turn_of_column[j];
        if (block_of[r] > block_of[c]) return false;
        Block& block = blocks[block_of[r]];
        if (block_of[r] == block_of[c]) block.is_there[(r - block.first) * block.size + c - block.first] = 1;
      }
    clear();
    for (Block& block : blocks) {
      if (!list_block(block)) return false;
    }
    first_.push_back(unknown_.size());
    list_above(starts, rows, turn_of_row, turn_of_column, block_of, blocks);
    list_products();
    value_.resize(unknown_.size());
    start_.resize(size), y_.resize(size);
    return true;
  }

  void clear() {
    first_.clear(), below_.clear(), right_.clear(), above_.clear();
    unknown_.clear(), target_.clear(), place_.clear(), entry_row_.clear(), products_.clear();
  }

  /// Fills the block as elimination does, and lists its values and products. False where these are too many.
  [[nodiscard]] bool list_block(Block& block) {
    const std::size_t m = block.size;
    for (std::size_t k = 0; k < m; ++k) {
      block.is_there[k * m + k] = 1;
      for (std::size_t r = k + 1; r < m; ++r) {
        if (!block.is_there[r * m + k]) continue;
        for (std::size_t c = k + 1; c < m; ++c) block.is_there[r * m + c] |= block.is_there[k * m + c];
      }
    }
    block.value.assign(m * m, 0);
    const auto add = [&](std::size_t r, std::size_t c, std::size_t unknown) {
      if (!block.is_there[r * m + c]) return;
      block.value[r * m + c] = static_cast<std::uint32_t>(unknown_.size());
      unknown_.push_back(static_cast<std::uint32_t>(block.first + unknown));
    };
    for (std::size_t k = 0; k < m; ++k) {
      first_.push_back(unknown_.size());
      add(k, k, k);
      below_.push_back(unknown_.size());
      for (std::size_t r = k + 1; r < m; ++r) add(r, k, r);
      right_.push_back(unknown_.size());
      for (std::size_t c = k + 1; c < m; ++c) add(k, c, c);
    }
    for (std::size_t k = 0; k < m; ++k)
      for (std::size_t r = k + 1; r < m; ++r) {
        if (!block.is_there[r * m + k]) continue;
        for (std::size_t c = k + 1; c < m; ++c)
          if (block.is_there[k * m + c]) target_.push_back(block.value[r * m + c]);
        if (target_.size() > most_products) return false;
      }
    return true;
  }

  /// The entries above the blocks, column by column; and where each entry of the pattern goes.
  void list_above(std::span<const std::int32_t> starts, std::span<const std::int32_t> rows,
                  const std::vector<std::size_t>& turn_of_row, const std::vector<std::size_t>& turn_of_column,
                  const std::vector<std::size_t>& block_of, const std::vector<Block>& blocks) {
    place_.resize(rows.size());
    entry_row_.resize(rows.size());
    for (std::size_t c = 0; c < column_.size(); ++c) {
      above_.push_back(unknown_.size());
      const auto j = static_cast<std::size_t>(column_[c]);
      for (auto p = static_cast<std::size_t>(starts[j]); p < static_cast<std::size_t>(starts[j + 1]); ++p) {
        const std::size_t r = turn_of_row[static_cast<std::size_t>(rows[p])];
        entry_row_[p] = static_cast<std::uint32_t>(r);
        if (block_of[r] == block_of[c]) {
          const Block& block = blocks[block_of[c]];
          place_[p] = block.value[(r - block.first) * block.size + turn_of_column[j] - block.first];
        } else {
          place_[p] = static_cast<std::uint32_t>(unknown_.size());
          unknown_.push_back(static_cast<std::uint32_t>(r));
        }
      }
    }
    above_.push_back(unknown_.size());
  }

  /// The products of a solution, in the order in which they could be done if as many as one likes were done at once: a
  /// product waits for all that change its source and for those that change its target before it. One with U or above
  /// the blocks also comes after all products with L that read its target.
  void list_products() {
    std::vector<std::size_t> changed(row_.size(), 0), read(row_.size(), 0), turns;
    std::vector<Product> in_order;
    const auto add = [&](std::size_t target, std::size_t source, std::size_t value, bool is_lower) {
      const std::size_t turn = std::max({changed[target], changed[source], is_lower ? 0 : read[target]});
      in_order.push_back(
          {static_cast<std::uint32_t>(target), static_cast<std::uint32_t>(source), static_cast<std::uint32_t>(value)});
      turns.push_back(turn);
      changed[target] = turn + 1;
      read[source] = std::max(read[source], turn);
    };
    for (std::size_t block = blocks_.size() - 1; block-- > 0;) {
      const auto begin = static_cast<std::size_t>(blocks_[block]), end = static_cast<std::size_t>(blocks_[block + 1]);
      for (std::size_t k = begin; k < end; ++k)
        for (std::size_t p = below_[k]; p < right_[k]; ++p) add(unknown_[p], k, p, true);
      for (std::size_t k = end; k-- > begin;)
        for (std::size_t p = first_[k + 1]; p-- > right_[k];) add(k, unknown_[p], p, false);
      for (std::size_t k = begin; k < end; ++k)
        for (std::size_t p = above_[k]; p < above_[k + 1]; ++p) add(unknown_[p], k, p, false);
    }
    std::vector<std::size_t> order(in_order.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(turns[i], i); });
    for (const std::size_t i : order) products_.push_back(in_order[i]);
  }

  bool is_listed_ = false;
  std::vector<std::int32_t> row_, column_, blocks_;
  // The values: for each pivot itself, from `first_` on, the entries below it, from `below_`, and on its right, from
  // `right_`, up to the next one's `first_`; then for each column the entries above its block, from `above_` on.
  std::vector<std::size_t> first_, below_, right_, above_;
  std::vector<std::uint32_t> unknown_;  // of each value: the turn of its row (below, above) or its column (right)
  std::vector<std::uint32_t> target_;   // the value that changes by below * right, pivot after pivot
  std::vector<std::uint32_t> place_, entry_row_;  // of each entry of the pattern: its value, the turn of its row
  std::vector<Product> products_;                 // of a solution
  std::vector<double> scale_;                     // of each row, by its turn
  std::vector<Number> value_, y_;
  std::vector<Number> start_;  // of each row, by its turn: its scale divided by its pivot
};

}  // namespace continuo::detail
