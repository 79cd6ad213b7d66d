// The summary of one outcome over many runs.
#include <algorithm>
#include <bit>
#include <cmath>

#include <continuo/studies/sweep/outcome_summary.hpp>

namespace continuo::studies {

void OutcomeSummary::add(double value) {
  if (!std::isfinite(value)) {
    ++missing_;
    return;
  }
  ++count_;
  lowest_ = std::fmin(lowest_, value), highest_ = std::fmax(highest_, value);
  sum_.add(value);
  squares_.add(value);
  sketch_.add(value);
}

void OutcomeSummary::merge(const OutcomeSummary& other) {
  count_ += other.count_;
  missing_ += other.missing_;
  lowest_ = std::fmin(lowest_, other.lowest_), highest_ = std::fmax(highest_, other.highest_);
  sum_.add(other.sum_);
  squares_.add(other.squares_);
  sketch_.merge(other.sketch_);
}

double OutcomeSummary::mean() const {
  return count_ > 0 ? sum_.divided_by(count_) : std::numeric_limits<double>::quiet_NaN();
}

double OutcomeSummary::deviation() const {
  return deviation_of(sum_, squares_, count_);
}

std::vector<double> OutcomeSummary::quantiles(std::span<const double> parts) const {
  const auto sorted = sketch_.sorted();
  std::vector<double> result;
  for (const double p : parts) result.push_back(p == 0 ? lowest_ : p == 1 ? highest_ : quantile_of(sorted, p));
  return result;
}

double OutcomeSummary::quantile_error() const {
  return count_ > 0 ? static_cast<double>(sketch_.rank_error()) / static_cast<double>(count_) : 0;
}

Histogram OutcomeSummary::histogram(std::size_t parts) const {
  Histogram result{lowest_, highest_, std::vector<std::uint64_t>(parts)};
  const double width = highest_ / 2 - lowest_ / 2;  // half of it: the whole may be beyond the largest number
  for (const auto& [value, weight] : sketch_.sorted()) {
    const double place = width > 0 ? (value / 2 - lowest_ / 2) / width * static_cast<double>(parts) : 0;
    result.counts[std::min(static_cast<std::size_t>(place), parts - 1)] += weight;
  }
  return result;
}

std::size_t summary_capacity(std::size_t outcomes, std::uint64_t runs, std::size_t bytes) {
  const std::size_t each = bytes / std::max<std::size_t>(outcomes, 1);
  constexpr std::size_t least = 64, fixed = sizeof(OutcomeSummary);
  const auto values = each > fixed ? (each - fixed) / sizeof(double) : 0;
  if (runs <= values) return std::max<std::size_t>(static_cast<std::size_t>(runs), least);
  std::size_t capacity = QuantileSketch::usual_capacity;
  const auto levels = [&] { return 2 + static_cast<std::size_t>(std::bit_width(runs / capacity)); };
  while (capacity > least && capacity * levels() > values) capacity /= 2;
  return capacity;
}

}  // namespace continuo::studies
