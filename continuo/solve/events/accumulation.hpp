// Events that accumulate: a ball whose bounces shrink to nothing (Zeno), a relay that flips at every instant
// (chattering). Both would occupy a simulator for ever at one time; they are detected and reported here.
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <continuo/solve/events/per_event.hpp>

namespace continuo {

/// Tracks the times of each event separately: different events at one instant are no accumulation.
template <class Real, std::size_t events = detail::any_count>
class AccumulationWatch {
 public:
  explicit AccumulationWatch(std::size_t size = 0) : tracks_(size) {}

  /// Event i fired at t. Gives the limit time where its firings accumulate.
  [[nodiscard]] std::optional<Real> fired(std::size_t i, Real t) {
    using std::abs, std::max;
    Track& track = tracks_[i];
    const Real gap = abs(t - track.t), forward = t >= track.t ? Real(1) : Real(-1);
    const bool same_instant = track.count > 0 && gap <= 16 * std::numeric_limits<Real>::epsilon() * abs(t);
    track.at_instant = same_instant ? track.at_instant + 1 : 0;
    const Real ratio = track.count > 0 && track.gap > 0 ? gap / track.gap : Real(2);
    // Eight gaps in a row, each a fixed part of the one before: a geometric series with the limit t + gap r/(1-r).
    const bool shrinks = ratio < Real(0.999) && (track.shrinking == 0 || abs(ratio - track.ratio) < Real(0.05));
    if (shrinks && track.shrinking == 0) track.start = t;
    track.shrinking = shrinks ? track.shrinking + 1 : 0;
    track.ratio = ratio;
    track.gap = gap;
    track.t = t;
    ++track.count;
    if (track.at_instant >= most_at_instant) return t;
    if (track.shrinking < 8) return std::nullopt;
    const Real rest = gap * ratio / (1 - ratio);
    const Real scale = max(abs(t), abs(t - track.start));
    if (rest > Real(1e4) * std::numeric_limits<Real>::epsilon() * scale) return std::nullopt;
    return t + forward * rest;
  }

  /// For checkpoints.
  template <class Archive>
  void transfer(Archive& archive) {
    for (Track& track : tracks_)
      archive(track.t, track.gap, track.ratio, track.start, track.count, track.shrinking, track.at_instant);
  }

  /// Resets the count of event i, after its accumulation has been handled.
  void forget(std::size_t i) { tracks_[i] = {}; }

 private:
  static constexpr int most_at_instant = 100;
  struct Track {
    Real t{}, gap{}, ratio{}, start{};
    int count = 0, shrinking = 0, at_instant = 0;
  };

  detail::PerEvent<Track, events> tracks_;
};

}  // namespace continuo
