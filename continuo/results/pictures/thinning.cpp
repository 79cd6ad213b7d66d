// A picture a thousand pixels wide shows no more than a few points per pixel. Curves over an ascending axis keep the
// first, lowest, highest and last point of every pixel column, which draws the same picture; other curves (orbits) drop
// points that lie within half a pixel of the last one kept. Gaps stay, one for several in a row.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <continuo/results/figure.hpp>

namespace continuo::results {
namespace {

struct Bounds {
  double low, high;
};

Bounds bounds_of(const std::vector<double>& values) {
  Bounds bounds{INFINITY, -INFINITY};
  for (const double v : values) {
    if (std::isfinite(v)) bounds = {std::min(bounds.low, v), std::max(bounds.high, v)};
  }
  return bounds;
}

void keep(const Curve& from, std::size_t i, Curve& to) {
  to.x.push_back(from.x[i]);
  to.y.push_back(from.y[i]);
}

/// Points begin..end-1 lie in one pixel column.
void keep_column(const Curve& from, std::size_t begin, std::size_t end, Curve& to) {
  std::size_t low = begin, high = begin;
  for (std::size_t i = begin; i < end; ++i) {
    if (from.y[i] < from.y[low]) low = i;
    if (from.y[i] > from.y[high]) high = i;
  }
  std::array<std::size_t, 4> kept{begin, low, high, end - 1};
  std::ranges::sort(kept);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (i == 0 || kept[i] != kept[i - 1]) keep(from, kept[i], to);
  }
}

}  // namespace

namespace {

/// The points from `begin` to before `end`, none of which is a gap.
void thin_line(const Curve& curve, std::size_t begin, std::size_t end, Bounds across, Bounds upwards, double width,
               Curve& result) {
  if (std::is_sorted(curve.x.begin() + static_cast<std::ptrdiff_t>(begin),
                     curve.x.begin() + static_cast<std::ptrdiff_t>(end))) {
    const auto column = [&](std::size_t i) {
      return std::floor((curve.x[i] - across.low) / (across.high - across.low) * width);
    };
    for (std::size_t first = begin, next = begin; first < end; first = next) {
      while (next < end && column(next) == column(first)) ++next;
      if (next == first) next = end;  // no column is a number where the curve has no width
      keep_column(curve, first, next, result);
    }
    return;
  }
  keep(curve, begin, result);
  for (std::size_t i = begin + 1; i < end; ++i) {
    const double dx = (curve.x[i] - result.x.back()) / (across.high - across.low);
    const double dy = (curve.y[i] - result.y.back()) / (upwards.high - upwards.low);
    if (i + 1 == end || std::hypot(dx, dy) * width >= 0.5) keep(curve, i, result);
  }
}

}  // namespace

Curve thinned(const Curve& curve, std::size_t pixels) {
  const std::size_t size = curve.x.size();
  if (size <= 4 * pixels) return curve;
  const Bounds across = bounds_of(curve.x), upwards = bounds_of(curve.y);
  Curve result = curve;
  result.x.clear();
  result.y.clear();
  const auto is_gap = [&](std::size_t i) { return !std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i]); };
  for (std::size_t begin = 0, end = 0; begin < size; begin = end) {
    if (is_gap(begin)) {
      if (result.x.empty() || std::isfinite(result.x.back() + result.y.back())) keep(curve, begin, result);
      end = begin + 1;
      continue;
    }
    while (end < size && !is_gap(end)) ++end;
    thin_line(curve, begin, end, across, upwards, static_cast<double>(pixels), result);
  }
  return result;
}

}  // namespace continuo::results
