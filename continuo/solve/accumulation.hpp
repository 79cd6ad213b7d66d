// continuo/solve/accumulation.hpp
// Events that accumulate: a ball whose bounces shrink to nothing (Zeno), a relay that flips at every instant
// (chattering, sliding). Both would keep a simulator busy for ever at one time; here they are found and named.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace continuo {

template <class Real>
class AccumulationWatch {
 public:
  explicit AccumulationWatch(std::size_t size = 0) : tracks_(size) {}

  /// Event i fired at t. Gives the limit time where its firings accumulate.
  std::optional<Real> fired(std::size_t i, Real t) {
    using std::abs, std::max;
    if (const auto limit = chattering(t)) return limit;
    Track& track = tracks_[i];
    const Real gap = abs(t - track.t), forward = t >= track.t ? Real(1) : Real(-1);
    const Real ratio = track.count > 0 && track.gap > 0 ? gap / track.gap : Real(2);
    // Eight gaps in a row, each a fixed part of the one before: a geometric series with the limit t + gap r/(1-r).
    const bool shrinks = ratio < Real(0.999) && (track.shrinking == 0 || abs(ratio - track.ratio) < Real(0.05));
    if (shrinks && track.shrinking == 0) track.start = t;
    track.shrinking = shrinks ? track.shrinking + 1 : 0;
    track.ratio = ratio;
    track.gap = gap;
    track.t = t;
    ++track.count;
    if (track.shrinking < 8) return std::nullopt;
    const Real rest = gap * ratio / (1 - ratio);
    const Real scale = max(abs(t), abs(t - track.start));
    if (rest > Real(1e4) * std::numeric_limits<Real>::epsilon() * scale) return std::nullopt;
    return t + forward * rest;
  }

 private:
  struct Track {
    Real t{}, gap{}, ratio{}, start{};
    int count = 0, shrinking = 0;
  };

  // A hundred events, each within sixteen units in the last place of the one before.
  std::optional<Real> chattering(Real t) {
    using std::abs;
    const bool same_instant = any_ && abs(t - last_) <= 16 * std::numeric_limits<Real>::epsilon() * abs(t);
    any_ = true;
    last_ = t;
    in_a_row_ = same_instant ? in_a_row_ + 1 : 0;
    return in_a_row_ >= 100 ? std::optional<Real>(t) : std::nullopt;
  }

  std::vector<Track> tracks_;
  Real last_{};
  bool any_ = false;
  int in_a_row_ = 0;
};

}  // namespace continuo
