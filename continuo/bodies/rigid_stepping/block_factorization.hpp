// The sparse factorization of a symmetric positive definite matrix of small dense blocks, one row and column of blocks
// for each body of an island: A = L L^T, where the order of elimination is that of least degree (D. J. Rose, 1972), so
// that chains, trees and stacks have no fill-in.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace continuo {

/// A block, by columns.
template <int Size>
using Block = std::array<double, static_cast<std::size_t>(Size* Size)>;

/// The pattern of L.
class BlockPattern {
 public:
  struct Entry {
    std::uint32_t row = 0;    // place in the order of elimination
    std::uint32_t block = 0;  // its number
  };
  /// Chooses the order of elimination of `size` bodies that `edges` connect. False where L would need more than
  /// `most_updates` products of blocks.
  [[nodiscard]] bool analyse(std::size_t size, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges,
                             std::size_t most_updates) {
    find_near(size, edges);
    if (!needs_at_most(most_updates, size, near_.size() / 2)) return false;
    std::vector<std::vector<std::uint32_t>> near(size);
    for (std::size_t i = 0; i < size; ++i)
      near[i].assign(near_.begin() + static_cast<std::ptrdiff_t>(first_[i]),
                     near_.begin() + static_cast<std::ptrdiff_t>(first_[i + 1]));
    return eliminate(near, most_updates);
  }

  [[nodiscard]] std::size_t size() const { return order_.size(); }
  [[nodiscard]] std::size_t blocks() const { return entries_.size(); }
  /// The place of a body in the order of elimination.
  [[nodiscard]] std::uint32_t place(std::size_t body) const { return place_[body]; }
  /// The blocks of L below the diagonal in a column, by increasing rows.
  [[nodiscard]] std::span<const Entry> column(std::size_t place) const {
    return std::span(entries_).subspan(begin_[place], begin_[place + 1] - begin_[place]);
  }
  /// The number of the block of two places, of which `column` is the earlier.
  [[nodiscard]] std::uint32_t find(std::uint32_t row, std::uint32_t in_column) const {
    const auto entries = column(in_column);
    return std::ranges::lower_bound(entries, row, {}, &Entry::row)->block;
  }

 private:
  /// The neighbours of each body, in one list, since most dense graphs are rejected by their number.
  void find_near(std::size_t size, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges) {
    first_.assign(size + 1, 0);
    for (const auto& [a, b] : edges) ++first_[a + 1], ++first_[b + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    near_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& [a, b] : edges) near_[next[a]++] = b, near_[next[b]++] = a;
    const auto begin = near_.begin();
    auto end = begin;
    for (std::size_t i = 0; i < size; ++i) {
      const auto of_i = begin + static_cast<std::ptrdiff_t>(first_[i]),
                 last = begin + static_cast<std::ptrdiff_t>(next[i]);
      first_[i] = static_cast<std::size_t>(end - begin);
      std::sort(of_i, last);
      end = std::copy(of_i, std::unique(of_i, last), end);
    }
    first_[size] = static_cast<std::size_t>(end - begin);
    near_.erase(end, near_.end());
  }
  /// False where no order of elimination can do: the columns of L have at least as many blocks as there are edges, and
  /// d of them need d (d + 1) / 2 products, of which the sum is least where all columns have the same number.
  [[nodiscard]] static bool needs_at_most(std::size_t most_updates, std::size_t size, std::size_t edges) {
    const double of_column = static_cast<double>(edges) / static_cast<double>(std::max<std::size_t>(size, 1));
    return static_cast<double>(edges) * (of_column + 1) / 2 <= static_cast<double>(most_updates);
  }
  [[nodiscard]] bool eliminate(std::vector<std::vector<std::uint32_t>>& near, std::size_t most_updates) {
    const std::size_t n = near.size();
    std::vector<std::vector<std::uint32_t>> by_degree(n + 1);
    for (std::uint32_t i = static_cast<std::uint32_t>(n); i-- > 0;) by_degree[near[i].size()].push_back(i);
    place_.assign(n, not_placed), order_.clear();
    std::vector<std::vector<std::uint32_t>> columns;
    std::vector<std::uint32_t> both;
    std::size_t updates = 0;
    for (std::size_t degree = 0; order_.size() < n;) {
      if (by_degree[degree].empty()) {
        ++degree;
        continue;
      }
      const std::uint32_t body = by_degree[degree].back();
      by_degree[degree].pop_back();
      if (place_[body] != not_placed || near[body].size() != degree) continue;
      updates += degree * (degree + 1) / 2;
      if (updates > most_updates) return false;
      place_[body] = static_cast<std::uint32_t>(order_.size());
      order_.push_back(body);
      for (const std::uint32_t i : near[body]) {
        join(near[i], near[body], i, body, both);
        by_degree[near[i].size()].push_back(i);
        degree = std::min(degree, near[i].size());
      }
      columns.push_back(std::move(near[body]));
    }
    store(columns);
    return true;
  }
  /// The neighbours of an eliminated body become neighbours of each other.
  static void join(std::vector<std::uint32_t>& of_i, const std::vector<std::uint32_t>& of_body, std::uint32_t i,
                   std::uint32_t body, std::vector<std::uint32_t>& both) {
    both.clear();
    std::ranges::set_union(of_i, of_body, std::back_inserter(both));
    std::erase_if(both, [&](std::uint32_t j) { return j == i || j == body; });
    of_i.assign(both.begin(), both.end());
  }
  void store(const std::vector<std::vector<std::uint32_t>>& columns) {
    entries_.clear(), begin_.assign(1, 0);
    for (const auto& bodies : columns) {
      const std::size_t first = entries_.size();
      for (const std::uint32_t body : bodies) entries_.push_back({place_[body], 0});
      std::sort(entries_.begin() + static_cast<std::ptrdiff_t>(first), entries_.end(),
                [](const Entry& a, const Entry& b) { return a.row < b.row; });
      for (std::size_t k = first; k < entries_.size(); ++k) entries_[k].block = static_cast<std::uint32_t>(k);
      begin_.push_back(entries_.size());
    }
  }

  static constexpr std::uint32_t not_placed = 0xffffffff;
  std::vector<std::uint32_t> place_, order_;
  std::vector<std::uint32_t> near_;  // the neighbours of one body after those of the other
  std::vector<std::size_t> first_;   // of each body there
  std::vector<Entry> entries_;
  std::vector<std::size_t> begin_;
};

/// A matrix of a pattern, and its factor.
template <int Size>
class BlockFactorization {
 public:
  void clear(const BlockPattern& pattern) {
    pattern_ = &pattern;
    diagonal_.assign(pattern.size(), {});
    below_.assign(pattern.blocks(), {});
  }
  /// The diagonal block of a body.
  [[nodiscard]] Block<Size>& diagonal(std::size_t body) { return diagonal_[pattern_->place(body)]; }
  /// Adds the block of row body i and column body j.
  void add(std::size_t body_i, std::size_t body_j, const Block<Size>& block) {
    const std::uint32_t i = pattern_->place(body_i), j = pattern_->place(body_j);
    Block<Size>& to = below_[i > j ? pattern_->find(i, j) : pattern_->find(j, i)];
    for (int c = 0; c < Size; ++c)
      for (int r = 0; r < Size; ++r) to[at(r, c)] += i > j ? block[at(r, c)] : block[at(c, r)];
  }

  /// Replaces the matrix by its factor. False where it is not positive definite.
  [[nodiscard]] bool factorize() {
    for (std::size_t j = 0; j < diagonal_.size(); ++j) {
      if (!cholesky(diagonal_[j])) return false;
      const auto column = pattern_->column(j);
      for (const auto& entry : column) divide(below_[entry.block], diagonal_[j]);
      for (std::size_t k = 0; k < column.size(); ++k) {
        subtract_product(diagonal_[column[k].row], below_[column[k].block], below_[column[k].block]);
        for (std::size_t i = k + 1; i < column.size(); ++i)
          subtract_product(below_[pattern_->find(column[i].row, column[k].row)], below_[column[i].block],
                           below_[column[k].block]);
      }
    }
    return true;
  }
  /// Replaces a right-hand side by the solution; body i has x[i].
  void solve(std::span<std::array<double, Size>> x) const {
    std::vector<std::array<double, Size>>& y = scratch_;
    y.resize(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) y[pattern_->place(i)] = x[i];
    for (std::size_t j = 0; j < y.size(); ++j) {
      forward(diagonal_[j], y[j]);
      for (const auto& entry : pattern_->column(j))
        for (int c = 0; c < Size; ++c)
          for (int r = 0; r < Size; ++r)
            y[entry.row][std::size_t(r)] -= below_[entry.block][at(r, c)] * y[j][std::size_t(c)];
    }
    for (std::size_t j = y.size(); j-- > 0;) {
      for (const auto& entry : pattern_->column(j))
        for (int c = 0; c < Size; ++c)
          for (int r = 0; r < Size; ++r)
            y[j][std::size_t(c)] -= below_[entry.block][at(r, c)] * y[entry.row][std::size_t(r)];
      backward(diagonal_[j], y[j]);
    }
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = y[pattern_->place(i)];
  }

 private:
  static constexpr std::size_t at(int row, int column) { return static_cast<std::size_t>(column * Size + row); }

  [[nodiscard]] static bool cholesky(Block<Size>& a) {
    for (int j = 0; j < Size; ++j) {
      double pivot = a[at(j, j)];
      for (int k = 0; k < j; ++k) pivot -= a[at(j, k)] * a[at(j, k)];
      if (!(pivot > 0)) return false;
      pivot = std::sqrt(pivot);
      a[at(j, j)] = pivot;
      for (int i = j + 1; i < Size; ++i) {
        double sum = a[at(i, j)];
        for (int k = 0; k < j; ++k) sum -= a[at(i, k)] * a[at(j, k)];
        a[at(i, j)] = sum / pivot;
      }
    }
    return true;
  }
  /// b L^-T.
  static void divide(Block<Size>& b, const Block<Size>& l) {
    for (int j = 0; j < Size; ++j) {
      for (int k = 0; k < j; ++k)
        for (int i = 0; i < Size; ++i) b[at(i, j)] -= b[at(i, k)] * l[at(j, k)];
      for (int i = 0; i < Size; ++i) b[at(i, j)] /= l[at(j, j)];
    }
  }
  /// a - b c^T.
  static void subtract_product(Block<Size>& a, const Block<Size>& b, const Block<Size>& c) {
    for (int k = 0; k < Size; ++k)
      for (int j = 0; j < Size; ++j)
        for (int i = 0; i < Size; ++i) a[at(i, j)] -= b[at(i, k)] * c[at(j, k)];
  }
  static void forward(const Block<Size>& l, std::array<double, Size>& y) {
    for (int j = 0; j < Size; ++j) {
      y[std::size_t(j)] /= l[at(j, j)];
      for (int i = j + 1; i < Size; ++i) y[std::size_t(i)] -= l[at(i, j)] * y[std::size_t(j)];
    }
  }
  static void backward(const Block<Size>& l, std::array<double, Size>& y) {
    for (int j = Size; j-- > 0;) {
      for (int i = j + 1; i < Size; ++i) y[std::size_t(j)] -= l[at(i, j)] * y[std::size_t(i)];
      y[std::size_t(j)] /= l[at(j, j)];
    }
  }

  const BlockPattern* pattern_ = nullptr;
  std::vector<Block<Size>> diagonal_, below_;
  mutable std::vector<std::array<double, Size>> scratch_;
};

}  // namespace continuo
