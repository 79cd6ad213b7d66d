// continuo/numerics/elimination/elimination_plan.hpp
// What there is to do to eliminate sparse matrices of one pattern with known pivots, and to solve with the factors. A
// plan has no entries of a matrix: all who have matrices of the pattern can use one.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace continuo::detail {

/// Pivots in their order: row[k] and column[k] of pivot k, and the first pivot of each block, with the number of pivots
/// at the end.
struct PivotOrder {
  std::span<const std::int32_t> row, column, blocks;
};

class EliminationPlan {
 public:
  /// For the matrices of a pattern (the first entry of each column, the row of each entry) with these pivots.
  EliminationPlan(std::span<const std::int32_t> starts, std::span<const std::int32_t> rows, const PivotOrder& pivots)
      : row_(pivots.row.begin(), pivots.row.end()),
        column_(pivots.column.begin(), pivots.column.end()),
        blocks_(pivots.blocks.begin(), pivots.blocks.end()),
        is_listed_(row_.size() <= greatest_size && list(starts, rows)) {}

  /// Whether there is a list. There is none where it would be too long to pay, or the matrix is not of these blocks.
  [[nodiscard]] bool is_listed() const { return is_listed_; }
  [[nodiscard]] bool is_for(const PivotOrder& pivots) const {
    return std::ranges::equal(pivots.row, row_) && std::ranges::equal(pivots.column, column_) &&
           std::ranges::equal(pivots.blocks, blocks_);
  }

  /// The number of pivots, and of the values that the elimination keeps.
  [[nodiscard]] std::size_t size() const { return row_.size(); }
  [[nodiscard]] std::size_t values() const { return unknown_.size(); }
  /// The row and the column of pivot k in the matrix.
  [[nodiscard]] std::size_t row(std::size_t k) const { return static_cast<std::size_t>(row_[k]); }
  [[nodiscard]] std::size_t column(std::size_t k) const { return static_cast<std::size_t>(column_[k]); }

  // The values: for each pivot itself, from `first` on, the entries below it, from `below`, and on its right, from
  // `right`, up to the next one's `first`; then for each column the entries above its block, from `above` on.
  [[nodiscard]] std::size_t first(std::size_t k) const { return first_[k]; }
  [[nodiscard]] std::size_t below(std::size_t k) const { return below_[k]; }
  [[nodiscard]] std::size_t right(std::size_t k) const { return right_[k]; }
  [[nodiscard]] std::size_t above(std::size_t k) const { return above_[k]; }
  /// Of a value: the turn of its row (below, above) or of its column (right).
  [[nodiscard]] std::size_t unknown(std::size_t value) const { return unknown_[value]; }
  /// The values that change by below * right, pivot after pivot.
  [[nodiscard]] const std::uint32_t* targets() const { return target_.data(); }
  /// Of an entry of the pattern: its value, and the turn of its row.
  [[nodiscard]] std::size_t entries() const { return place_.size(); }
  [[nodiscard]] std::size_t place(std::size_t entry) const { return place_[entry]; }
  [[nodiscard]] std::size_t turn_of_entry(std::size_t entry) const { return entry_row_[entry]; }

  /// y[target] -= value * y[source].
  struct Product {
    std::uint32_t target, source;
  };
  /// Those of a solution, and where the value of each is.
  [[nodiscard]] std::span<const Product> products() const { return products_; }
  [[nodiscard]] std::span<const std::uint32_t> values_of_products() const { return value_of_product_; }

 private:
  // Beyond these a list is no faster than a solver that goes column by column, and the list would fill the cache.
  static constexpr std::size_t greatest_size = 500, most_products = 50'000;

  /// The entries of one block, its rows and columns from 0: as bits, then as places in `value_`.
  struct Block {
    std::size_t first, size;
    std::vector<char> is_there;
    std::vector<std::uint32_t> value;
    Block(std::size_t first_, std::size_t size_) : first(first_), size(size_), is_there(size_ * size_, 0) {}
  };

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
    for (Block& block : blocks) {
      if (!list_block(block)) return false;
    }
    first_.push_back(unknown_.size());
    list_above(starts, rows, turn_of_row, turn_of_column, block_of, blocks);
    list_products();
    return true;
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
    std::vector<std::uint32_t> values;
    const auto add = [&](std::size_t target, std::size_t source, std::size_t value, bool is_lower) {
      const std::size_t turn = std::max({changed[target], changed[source], is_lower ? 0 : read[target]});
      in_order.push_back({static_cast<std::uint32_t>(target), static_cast<std::uint32_t>(source)});
      values.push_back(static_cast<std::uint32_t>(value));
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
    for (const std::size_t i : order) products_.push_back(in_order[i]), value_of_product_.push_back(values[i]);
  }

  std::vector<std::int32_t> row_, column_, blocks_;
  std::vector<std::size_t> first_, below_, right_, above_;
  std::vector<std::uint32_t> unknown_, target_, place_, entry_row_, value_of_product_;
  std::vector<Product> products_;
  bool is_listed_;
};

}  // namespace continuo::detail
