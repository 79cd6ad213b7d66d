// Quantiles of a stream in bounded memory.
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/studies/sweep/quantile_sketch.hpp>

namespace continuo::studies {

QuantileSketch::QuantileSketch(std::size_t capacity) : capacity_(std::max<std::size_t>(capacity, 2)) {}

void QuantileSketch::add(double value) {
  std::vector<double>& values = levels_[0].values;
  if (values.size() == values.capacity())
    values.reserve(std::min(std::max<std::size_t>(2 * values.size(), 16), capacity_ + 1));
  values.push_back(value);
  ++count_;
  if (values.size() > capacity_) settle(0);
}

void QuantileSketch::merge(const QuantileSketch& other) {
  if (levels_.size() < other.levels_.size()) levels_.resize(other.levels_.size());
  for (std::size_t level = 0; level < other.levels_.size(); ++level) {
    const std::vector<double>& values = other.levels_[level].values;
    levels_[level].values.insert(levels_[level].values.end(), values.begin(), values.end());
  }
  count_ += other.count_;
  too_high_ += other.too_high_;
  too_low_ += other.too_low_;
  for (std::size_t level = 0; level < levels_.size(); ++level)
    if (levels_[level].values.size() > capacity_) settle(level);
}

/// Halves the values of a level, and those of the levels above that become too many.
void QuantileSketch::settle(std::size_t level) {
  if (level + 1 == levels_.size()) levels_.emplace_back();
  Level& own = levels_[level];
  std::vector<double>& higher = levels_[level + 1].values;
  std::ranges::sort(own.values);
  const std::size_t pairs = own.values.size() / 2;
  const std::size_t kept = own.takes_higher ? 1 : 0;
  for (std::size_t i = 0; i < pairs; ++i) higher.push_back(own.values[2 * i + kept]);
  // Where an odd number of the values is below a place, one more or one fewer is counted there.
  (own.takes_higher ? too_low_ : too_high_) += std::uint64_t{1} << level;
  own.takes_higher = !own.takes_higher;
  own.values.erase(own.values.begin(), own.values.begin() + static_cast<std::ptrdiff_t>(2 * pairs));
  if (higher.size() > capacity_) settle(level + 1);
}

std::uint64_t QuantileSketch::rank_error() const {
  return std::max(too_high_, too_low_);
}

std::vector<QuantileSketch::Weighted> QuantileSketch::sorted() const {
  std::vector<Weighted> result;
  for (std::size_t level = 0; level < levels_.size(); ++level)
    for (const double value : levels_[level].values) result.push_back({value, std::uint64_t{1} << level});
  std::ranges::sort(result, [](const Weighted& a, const Weighted& b) {
    return a.value < b.value || (a.value == b.value && a.weight < b.weight);
  });
  return result;
}

double quantile_of(std::span<const QuantileSketch::Weighted> sorted, double p) {
  if (sorted.empty() || !(p >= 0 && p <= 1)) return std::numeric_limits<double>::quiet_NaN();
  std::uint64_t count = 0;
  bool are_alone = true;
  for (const auto& [value, weight] : sorted) count += weight, are_alone = are_alone && weight == 1;
  const double place = p * static_cast<double>(count - 1);
  const double whole = std::floor(place);
  if (are_alone) {
    const auto i = static_cast<std::size_t>(whole);
    const double low = sorted[i].value, part = place - whole;
    return part > 0 ? (1 - part) * low + part * sorted[i + 1].value : low;
  }
  std::uint64_t before = 0;
  for (const auto& [value, weight] : sorted) {
    before += weight;
    if (static_cast<double>(before) > whole) return value;
  }
  return sorted.back().value;
}

}  // namespace continuo::studies
