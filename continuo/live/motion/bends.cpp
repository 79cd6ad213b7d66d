// Compares rows with straight lines between their neighbours.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <continuo/live/motion/bends.hpp>

namespace continuo::live {

namespace {

// Of what a plot or the scene shows, some hundreds of pixels high: about one of them. What a float rounds is no bend.
constexpr float overlooked = 1.0F / 500, rounding = 1e-6F;
constexpr float endless = std::numeric_limits<float>::infinity();

}  // namespace

void Bends::Range::take(float value) {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

float Bends::Range::largest() const {
  return high >= low ? std::max(std::abs(low), std::abs(high)) : 0;
}

Bends::Bends(const LiveModel& shown) {
  constexpr std::size_t widest = 100;
  too_wide_ = shown.columns.size() > widest || shown.paths.size() > widest;
  std::set<std::size_t> columns;
  for (const LivePlot& plot : shown.plots) {
    for (const LiveCurve& curve : plot.curves) columns.insert(curve.column);
    if (plot.against) columns.insert(plot.against->column);
  }
  columns_.assign(columns.begin(), columns.end());
  ranges_.assign(columns_.size(), {endless, -endless});
  reach_.assign(shown.paths.size(), {endless, -endless});
}

void Bends::see(const Row& row) {
  for (std::size_t k = 0; k < columns_.size(); ++k) ranges_[k].take(row.values[columns_[k]]);
  for (std::size_t k = 0; k < reach_.size(); ++k) reach_[k].take(row.path[k]);
}

bool Bends::between(const Row& a, const Row& middle, const Row& b) const {
  if (!(b.t > a.t)) return false;
  const auto part = static_cast<float>((middle.t - a.t) / (b.t - a.t));
  const auto misses = [&](float from, float at, float to, float allowed) {
    return std::abs(from + part * (to - from) - at) > allowed;
  };
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const std::size_t i = columns_[k];
    const float allowed = std::max(overlooked * ranges_[k].width(), rounding * ranges_[k].largest());
    if (misses(a.values[i], middle.values[i], b.values[i], allowed)) return true;
  }
  float widest = 0, largest = 0;
  for (const Range& range : reach_) {
    widest = std::max(widest, range.width());
    largest = std::max(largest, range.largest());
  }
  const float allowed = std::max(overlooked * widest, rounding * largest);
  for (std::size_t k = 0; k < reach_.size(); ++k) {
    if (misses(a.path[k], middle.path[k], b.path[k], allowed)) return true;
  }
  return false;
}

}  // namespace continuo::live
