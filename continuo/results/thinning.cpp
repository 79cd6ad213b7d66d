// A picture a thousand pixels wide shows no more than a few points per pixel. Curves over an ascending axis keep the
// first, lowest, highest and last point of every pixel column, which draws the same picture; other curves (orbits) drop
// points that lie within half a pixel of the last one kept.
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

Curve thinned(const Curve& curve, std::size_t pixels) {
  const std::size_t size = curve.x.size();
  const bool all_finite = std::ranges::all_of(curve.y, [](double y) { return std::isfinite(y); });
  if (size <= 4 * pixels || !all_finite) return curve;
  const auto [x_low, x_high] = bounds_of(curve.x);
  const auto [y_low, y_high] = bounds_of(curve.y);
  Curve result = curve;
  result.x.clear();
  result.y.clear();
  const auto width = static_cast<double>(pixels);

  if (std::ranges::is_sorted(curve.x)) {
    const auto column = [&](std::size_t i) { return std::floor((curve.x[i] - x_low) / (x_high - x_low) * width); };
    for (std::size_t begin = 0, end = 0; begin < size; begin = end) {
      while (end < size && column(end) == column(begin)) ++end;
      keep_column(curve, begin, end, result);
    }
    return result;
  }
  keep(curve, 0, result);
  for (std::size_t i = 1; i < size; ++i) {
    const double dx = (curve.x[i] - result.x.back()) / (x_high - x_low);
    const double dy = (curve.y[i] - result.y.back()) / (y_high - y_low);
    if (i + 1 == size || std::hypot(dx, dy) * width >= 0.5) keep(curve, i, result);
  }
  return result;
}

}  // namespace continuo::results
