// continuo/numerics/sparse_pattern.hpp
// Which entries of a square matrix may differ from zero, column by column, and which columns share no row.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/numerics/band_layout.hpp>

namespace continuo {

/// The place of an entry.
struct MatrixPlace {
  std::uint32_t row;     // from 0
  std::uint32_t column;  // from 0
};

/// What a sparse solver has found out about a pattern.
class PatternAnalysis {
 public:
  /// Frees it.
  virtual ~PatternAnalysis() = default;
};

/// Columns one after another, the rows of each ascending; every diagonal entry is there.
class SparsePattern {
 public:
  SparsePattern() = default;
  /// Places in any order, doubles allowed.
  SparsePattern(std::size_t size, std::span<const MatrixPlace> places);

  /// The number of columns.
  [[nodiscard]] std::size_t size() const { return starts_.empty() ? 0 : starts_.size() - 1; }
  /// The number of entries.
  [[nodiscard]] std::size_t entries() const { return rows_.size(); }
  /// The first entry of a column.
  [[nodiscard]] std::size_t begin(std::size_t column) const { return static_cast<std::size_t>(starts_[column]); }
  /// The entry after the last one of a column.
  [[nodiscard]] std::size_t end(std::size_t column) const { return static_cast<std::size_t>(starts_[column + 1]); }
  /// The row of an entry.
  [[nodiscard]] std::size_t row(std::size_t entry) const { return static_cast<std::size_t>(rows_[entry]); }
  /// Which entry is (row, column); entries() where it is none.
  [[nodiscard]] std::size_t find(std::size_t row, std::size_t column) const;
  /// How far the entries reach below and above the diagonal.
  struct Bandwidth {
    std::size_t lower;  // rows below the diagonal
    std::size_t upper;  // rows above it
  };
  /// How far the entries reach from the diagonal. Costs a pass over the columns.
  [[nodiscard]] Bandwidth bandwidth() const;
  /// Whether a factorization as a band, with what pivoting adds, has at most four times the entries of the pattern:
  /// then it takes a half to a third of the time of a sparse solver, which is faster where most of a band would be
  /// empty.
  [[nodiscard]] bool is_banded() const;
  /// The layout of a band that contains all entries.
  [[nodiscard]] BandLayout band() const;
  /// Of the entries in that layout.
  [[nodiscard]] std::vector<std::uint32_t> places_in_band() const;

  // In the form that sparse solvers read.
  /// For each column the number of its first entry, and last the number of entries.
  [[nodiscard]] std::span<const std::int32_t> starts() const { return starts_; }
  /// The row of each entry.
  [[nodiscard]] std::span<const std::int32_t> rows() const { return rows_; }
  /// What is kept for whoever has matrices of the pattern next: all copies of it share this. Null before `keep`. Both
  /// may be called by several threads.
  [[nodiscard]] std::shared_ptr<const PatternAnalysis> analysis() const;
  /// Keeps an analysis in place of the last one.
  void keep(std::shared_ptr<const PatternAnalysis> analysis) const;

 private:
  struct Kept;
  std::vector<std::int32_t> starts_, rows_;
  std::shared_ptr<Kept> kept_;  // null where there are no columns
};

/// Groups of columns of which no two have an entry in the same row: one evaluation of f gives the differences of a
/// whole group. Greedy, in the order of the columns (A. Curtis, M. Powell, J. Reid, J. Inst. Maths Applics 13 (1974)).
class ColumnGroups {
 public:
  ColumnGroups() = default;
  /// Groups the columns of a pattern, once; costs about the number of entries times the number of groups.
  explicit ColumnGroups(const SparsePattern& pattern);

  /// The number of groups.
  [[nodiscard]] std::size_t count() const { return starts_.empty() ? 0 : starts_.size() - 1; }
  /// The columns of a group.
  [[nodiscard]] std::span<const std::size_t> group(std::size_t i) const {
    return std::span(columns_).subspan(starts_[i], starts_[i + 1] - starts_[i]);
  }

 private:
  std::vector<std::size_t> starts_, columns_;
};

}  // namespace continuo
