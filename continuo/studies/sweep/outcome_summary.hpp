// What many runs say of one number: its mean, deviation, extremes, quantiles and histogram, computed as the runs end,
// without a store of them.
//
//   OutcomeSummary summary;
//   for (const double landing : landings) summary.add(landing);  // NaN: a run that failed
//   summary.mean(), summary.deviation(), summary.quantiles(std::array{0.05, 0.95});
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/studies/sweep/exact_sum.hpp>
#include <continuo/studies/sweep/quantile_sketch.hpp>

namespace continuo::studies {

/// Counts of values in parts of equal width.
struct Histogram {
  double low = 0, high = 0;           // of the first part and of the last; equal where all values are
  std::vector<std::uint64_t> counts;  // exact where the quantiles are, else each within twice their bound
};

/// The summary of one outcome over many runs. Sums are exact, so that the mean, the deviation and the extremes are the
/// same to the bit in whatever order values are added and summaries merged. The quantiles are as well while they are
/// exact; beyond this the same order must be kept: that of the numbers of the runs.
class OutcomeSummary {
 public:
  /// `capacity`: how many values the quantiles are exact for (`QuantileSketch`).
  explicit OutcomeSummary(std::size_t capacity = QuantileSketch::usual_capacity) : sketch_(capacity) {}

  /// Takes the outcome of one run. What is not finite is counted apart and changes nothing else.
  void add(double value);
  /// Takes those of another summary, whose runs follow the own ones.
  void merge(const OutcomeSummary& other);

  /// How many runs have a value.
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// How many have none, because they failed or the value is infinite.
  [[nodiscard]] std::uint64_t missing() const { return missing_; }
  /// The mean to the last bit but one; NaN without values.
  [[nodiscard]] double mean() const;
  /// The standard deviation of the sample, with the divisor count - 1; NaN for fewer than two values.
  [[nodiscard]] double deviation() const;
  /// The least value; NaN without values.
  [[nodiscard]] double lowest() const { return lowest_; }
  /// The greatest value; NaN without values.
  [[nodiscard]] double highest() const { return highest_; }
  /// The values that these parts, from 0 to 1, of the values do not exceed: 0.5 is the median. NaN without values.
  [[nodiscard]] std::vector<double> quantiles(std::span<const double> parts) const;
  /// How far the parts may be from those asked for: 0 while the quantiles are exact.
  [[nodiscard]] double quantile_error() const;
  /// Counts in `parts` >= 1 parts of equal width between the extremes.
  [[nodiscard]] Histogram histogram(std::size_t parts) const;

 private:
  std::uint64_t count_ = 0, missing_ = 0;
  double lowest_ = std::numeric_limits<double>::quiet_NaN();
  double highest_ = std::numeric_limits<double>::quiet_NaN();
  ExactSum sum_;
  ExactSumOfSquares squares_;
  QuantileSketch sketch_;
};

/// The capacity with which the summaries of so many outcomes over so many runs stay within this memory.
[[nodiscard]] std::size_t summary_capacity(std::size_t outcomes, std::uint64_t runs, std::size_t bytes = 150'000'000);

}  // namespace continuo::studies
