// continuo/numerics/sparse_pattern.cpp
// Patterns of sparse matrices: search, bandwidth, and columns grouped for differences.
#include <algorithm>
#include <mutex>
#include <utility>

#include <continuo/numerics/sparse_pattern.hpp>

namespace continuo {

struct SparsePattern::Kept {
  std::mutex mutex;
  std::shared_ptr<const PatternAnalysis> analysis;
};

SparsePattern::SparsePattern(std::size_t size, std::span<const MatrixPlace> places) : kept_(std::make_shared<Kept>()) {
  std::vector<std::vector<std::int32_t>> columns(size);
  for (const MatrixPlace& place : places) columns[place.column].push_back(static_cast<std::int32_t>(place.row));
  starts_.push_back(0);
  for (std::size_t j = 0; j < size; ++j) {
    std::vector<std::int32_t>& rows = columns[j];
    rows.push_back(static_cast<std::int32_t>(j));
    std::ranges::sort(rows);
    rows.erase(std::ranges::unique(rows).begin(), rows.end());
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    starts_.push_back(static_cast<std::int32_t>(rows_.size()));
  }
}

std::shared_ptr<const PatternAnalysis> SparsePattern::analysis() const {
  if (!kept_) return nullptr;
  const std::lock_guard<std::mutex> lock(kept_->mutex);
  return kept_->analysis;
}

void SparsePattern::keep(std::shared_ptr<const PatternAnalysis> analysis) const {
  if (!kept_) return;
  const std::lock_guard<std::mutex> lock(kept_->mutex);
  kept_->analysis = std::move(analysis);
}

std::size_t SparsePattern::find(std::size_t row, std::size_t column) const {
  const auto first = rows_.begin() + starts_[column], last = rows_.begin() + starts_[column + 1];
  const auto found = std::lower_bound(first, last, static_cast<std::int32_t>(row));
  return found == last || *found != static_cast<std::int32_t>(row) ? entries()
                                                                   : static_cast<std::size_t>(found - rows_.begin());
}

SparsePattern::Bandwidth SparsePattern::bandwidth() const {
  Bandwidth width{0, 0};
  for (std::size_t j = 0; j < size(); ++j) {
    for (std::size_t p = begin(j); p < end(j); ++p) {
      if (row(p) > j) width.lower = std::max(width.lower, row(p) - j);
      if (row(p) < j) width.upper = std::max(width.upper, j - row(p));
    }
  }
  return width;
}

bool SparsePattern::is_banded() const {
  constexpr std::size_t greatest_part = 4;
  const auto [lower, upper] = bandwidth();
  return (2 * lower + upper + 1) * size() <= greatest_part * entries();
}

BandLayout SparsePattern::band() const {
  const auto [lower, upper] = bandwidth();
  return {size(), lower, upper};
}

std::vector<std::uint32_t> SparsePattern::places_in_band() const {
  const BandLayout layout = band();
  std::vector<std::uint32_t> places;
  for (std::size_t column = 0; column < size(); ++column)
    for (std::size_t p = begin(column); p < end(column); ++p)
      places.push_back(static_cast<std::uint32_t>(layout.place(row(p), column)));
  return places;
}

ColumnGroups::ColumnGroups(const SparsePattern& pattern) {
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> group_of(pattern.size(), none);
  std::vector<std::size_t> taken_by(pattern.size(), none);  // by row: the last group that has an entry there
  starts_.push_back(0);
  for (std::size_t group = 0; columns_.size() < pattern.size(); ++group) {
    for (std::size_t j = 0; j < pattern.size(); ++j) {
      if (group_of[j] != none) continue;
      bool free = true;
      for (std::size_t p = pattern.begin(j); free && p < pattern.end(j); ++p) free = taken_by[pattern.row(p)] != group;
      if (!free) continue;
      group_of[j] = group;
      columns_.push_back(j);
      for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p) taken_by[pattern.row(p)] = group;
    }
    starts_.push_back(columns_.size());
  }
}

}  // namespace continuo
