// Where in time the steps of a run lie, for the message of a run with too many of them.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace continuo {

/// The times after every so many steps, at most 64 of them. When there are 64, every other one is dropped, and the
/// distance doubles.
template <class Real>
class StepMarks {
 public:
  /// For checkpoints.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(times_);
    archive.index(count_, most);
    archive(every_, next_);
  }

  /// `steps`: tries so far, rejected ones with them.
  void mark(std::size_t steps, const Real& t) {
    if (steps < next_) return;
    if (count_ == most) thin_out();
    times_[count_++] = t;
    next_ = steps + every_;
  }

  /// At how many tries the next time is noted.
  [[nodiscard]] std::size_t next() const { return next_; }

  /// The times between which half of the steps lie, if their distance is at most a tenth of the way.
  [[nodiscard]] std::optional<std::pair<Real, Real>> crowd() const {
    if (count_ < least) return std::nullopt;
    const std::size_t half = count_ / 2;
    std::size_t densest = 0;
    for (std::size_t k = 0; k + half < count_; ++k)
      if (way(k, k + half) < way(densest, densest + half)) densest = k;
    if (!(way(densest, densest + half) <= way(0, count_ - 1) / 10)) return std::nullopt;
    return std::pair(times_[densest], times_[densest + half]);
  }

 private:
  static constexpr std::size_t most = 64, least = 8;

  [[nodiscard]] Real way(std::size_t from, std::size_t to) const {
    using std::abs;
    return abs(times_[to] - times_[from]);
  }
  void thin_out() {
    for (std::size_t k = 0; k < most / 2; ++k) times_[k] = times_[2 * k];
    count_ = most / 2;
    every_ *= 2;
  }

  std::array<Real, most> times_{};
  std::size_t count_ = 0, every_ = 1, next_ = 0;
};

}  // namespace continuo
