// Quantiles of a stream of numbers in bounded memory, with a bound of the error that always holds.
//
// Values are gathered in a buffer. A full buffer is sorted, and every second value goes on to the next level, where
// each counts for twice as many. G. S. Manku, S. Rajagopalan, B. G. Lindsay, "Approximate medians and other quantiles
// in one pass and with limited memory", SIGMOD (1998). No chance is involved: the same values in the same order give
// the same bits. Each halving moves the rank of any value by at most the weight of one, in turn upwards and downwards.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace continuo::studies {

/// A stream of finite numbers, of which quantiles will be asked.
class QuantileSketch {
 public:
  static constexpr std::size_t usual_capacity = std::size_t{1} << 20;  // 8 MB

  /// `capacity`: how many values are kept on each level; up to so many, quantiles are exact. At least 2.
  explicit QuantileSketch(std::size_t capacity = usual_capacity);

  /// Takes one finite number.
  void add(double value);
  /// Takes the values of another sketch, which follow the own ones.
  void merge(const QuantileSketch& other);

  /// How many values were taken.
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// By how much the rank of a quantile may be wrong, in values; 0 while every value is kept.
  [[nodiscard]] std::uint64_t rank_error() const;

  /// A value that is kept, and how many it stands for.
  struct Weighted {
    double value = 0;
    std::uint64_t weight = 1;
  };
  /// What is kept, in rising order.
  [[nodiscard]] std::vector<Weighted> sorted() const;

 private:
  void settle(std::size_t level);

  struct Level {
    std::vector<double> values{};
    bool takes_higher = false;  // of two neighbours, at the next halving: in turn, so that errors cancel
  };
  std::size_t capacity_;
  std::uint64_t count_ = 0;
  std::uint64_t too_high_ = 0, too_low_ = 0;  // by how many values a rank may be
  std::vector<Level> levels_{1};
};

/// The value that a part p of the values does not exceed: between two of them in a straight line where each counts once
/// (type 7 of R. J. Hyndman, Y. Fan, "Sample quantiles in statistical packages", The American Statistician 50 (1996)),
/// else the value that holds the place. NaN without values.
[[nodiscard]] double quantile_of(std::span<const QuantileSketch::Weighted> sorted, double p);

}  // namespace continuo::studies
