// The ranges in which a curve is followed: where it leaves them, and how much of one it has covered.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>

namespace continuo::studies::detail {

template <std::size_t N>
[[nodiscard]] bool is_within(const std::array<double, N>& constants, const std::array<double, N>& low,
                             const std::array<double, N>& high) {
  for (std::size_t k = 0; k < N; ++k)
    if (!(constants[k] >= low[k] && constants[k] <= high[k])) return false;
  return true;
}

/// The range that is left first on the way from a place inside to one outside.
struct LeftRange {
  std::size_t constant = 0;
  double bound = 0;
  double part = 2;  // of the way
};
template <std::size_t N>
[[nodiscard]] LeftRange left_range(const std::array<double, N>& inside, const std::array<double, N>& outside,
                                   const std::array<double, N>& low, const std::array<double, N>& high) {
  LeftRange left;
  for (std::size_t k = 0; k < N; ++k) {
    const double to = outside[k], bound = std::clamp(to, low[k], high[k]);
    if (to == bound) continue;
    const double part = (bound - inside[k]) / (to - inside[k]);
    if (part < left.part) left = {k, bound, part};
  }
  return left;
}

/// Tells how much of a range has been covered.
class CoveredRange {
 public:
  /// `progress`, which may be empty, is kept by who calls.
  CoveredRange(double low, double high, const std::function<void(double part)>& progress)
      : whole_(high - low), progress_(progress) {}
  void report(double value) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
    if (progress_) progress_(std::min((high_ - low_) / whole_, 1.0));
  }

 private:
  double whole_;
  const std::function<void(double part)>& progress_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

}  // namespace continuo::studies::detail
