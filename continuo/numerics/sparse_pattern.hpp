// continuo/numerics/sparse_pattern.hpp
// Which entries of a square matrix may differ from zero, column by column, and which columns share no row.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/numerics/band_layout.hpp>

namespace continuo {

struct MatrixPlace {
  std::uint32_t row, column;
};

/// Columns one after another, the rows of each ascending; every diagonal entry is there.
class SparsePattern {
 public:
  SparsePattern() = default;
  /// Places in any order, doubles allowed.
  SparsePattern(std::size_t size, std::span<const MatrixPlace> places);

  [[nodiscard]] std::size_t size() const { return starts_.empty() ? 0 : starts_.size() - 1; }
  [[nodiscard]] std::size_t entries() const { return rows_.size(); }
  [[nodiscard]] std::size_t begin(std::size_t column) const { return static_cast<std::size_t>(starts_[column]); }
  [[nodiscard]] std::size_t end(std::size_t column) const { return static_cast<std::size_t>(starts_[column + 1]); }
  [[nodiscard]] std::size_t row(std::size_t entry) const { return static_cast<std::size_t>(rows_[entry]); }
  /// Which entry is (row, column); entries() where it is none.
  [[nodiscard]] std::size_t find(std::size_t row, std::size_t column) const;
  /// How far the entries reach below and above the diagonal.
  struct Bandwidth {
    std::size_t lower, upper;
  };
  [[nodiscard]] Bandwidth bandwidth() const;
  /// Whether a factorization as a band, with what pivoting adds, has at most four times the entries of the pattern:
  /// then it takes a half to a third of the time of a sparse solver, which is faster where most of a band would be
  /// empty.
  [[nodiscard]] bool is_banded() const;
  [[nodiscard]] BandLayout band() const;
  /// Of the entries in that layout.
  [[nodiscard]] std::vector<std::uint32_t> places_in_band() const;

  // In the form that sparse solvers read.
  [[nodiscard]] std::span<const std::int32_t> starts() const { return starts_; }
  [[nodiscard]] std::span<const std::int32_t> rows() const { return rows_; }

 private:
  std::vector<std::int32_t> starts_, rows_;
};

/// Groups of columns of which no two have an entry in the same row: one evaluation of f gives the differences of a
/// whole group. Greedy, in the order of the columns (A. Curtis, M. Powell, J. Reid, J. Inst. Maths Applics 13 (1974)).
class ColumnGroups {
 public:
  ColumnGroups() = default;
  explicit ColumnGroups(const SparsePattern& pattern);

  [[nodiscard]] std::size_t count() const { return starts_.empty() ? 0 : starts_.size() - 1; }
  [[nodiscard]] std::span<const std::size_t> group(std::size_t i) const {
    return std::span(columns_).subspan(starts_[i], starts_[i + 1] - starts_[i]);
  }

 private:
  std::vector<std::size_t> starts_, columns_;
};

}  // namespace continuo
