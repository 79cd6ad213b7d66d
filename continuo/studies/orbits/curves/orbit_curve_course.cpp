// Leaves the ranges of two constants, reports progress, and closes curves.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/orbits/curves/orbit_curve_course.hpp>

namespace continuo::studies::detail {

namespace {

/// What points of a curve have in common whatever their mesh, in sizes. The length of the interval on which a
/// homoclinic orbit is solved for says nothing of it.
std::vector<double> seen_from_outside(const OrbitCurvePoint& point, const OrbitCurveOptions& options,
                                      const OrbitCurvePoint& unit) {
  std::vector<double> v;
  for (std::size_t k = 0; k < 2; ++k) v.push_back(point.constants[k] / (options.high[k] - options.low[k]));
  if (point.eigenvalues.empty()) v.push_back(point.period / unit.period);
  for (std::size_t i = 0; i < point.low.size(); ++i) {
    const double size = std::max({std::abs(unit.low[i]), std::abs(unit.high[i]), 1e-12});
    v.push_back(point.low[i] / size);
    v.push_back(point.high[i] / size);
  }
  return v;
}

}  // namespace

OrbitCurve followed_both_ways(OrbitBifurcation kind, const OrbitCurvePoint& first,
                              const std::function<OrbitCurveEnd(OrbitCurve& curve, double direction)>& followed) {
  OrbitCurve curve{.kind = kind}, back{.kind = kind}, ahead{.kind = kind};
  curve.ends[0] = followed(back, -1);
  std::ranges::reverse(back.points);
  std::ranges::reverse(back.marks);
  for (DegenerateOrbit& point : back.marks) point.next = back.points.size() - point.next;
  curve.points = std::move(back.points);
  curve.marks = std::move(back.marks);
  curve.points.push_back(first);
  if (curve.ends[0].ending == OrbitCurveEnding::closed || curve.ends[0].ending == OrbitCurveEnding::interrupted) {
    curve.ends[1] = curve.ends[0];
    if (curve.ends[0].ending == OrbitCurveEnding::interrupted) return curve;
    curve.points.insert(curve.points.begin(), first);
    for (DegenerateOrbit& point : curve.marks) ++point.next;
    return curve;
  }
  curve.ends[1] = followed(ahead, 1);
  for (DegenerateOrbit& point : ahead.marks) point.next += curve.points.size();
  curve.points.insert(curve.points.end(), ahead.points.begin(), ahead.points.end());
  curve.marks.insert(curve.marks.end(), ahead.marks.begin(), ahead.marks.end());
  return curve;
}

bool is_inside(const OrbitCurvePoint& point, const OrbitCurveOptions& options) {
  for (std::size_t k = 0; k < 2; ++k)
    if (!(point.constants[k] >= options.low[k] && point.constants[k] <= options.high[k])) return false;
  return true;
}

LeftRange left_range(const OrbitCurvePoint& inside, const OrbitCurvePoint& outside, const OrbitCurveOptions& options) {
  LeftRange left;
  double part = 2;
  for (std::size_t k = 0; k < 2; ++k) {
    const double to = outside.constants[k], limit = std::clamp(to, options.low[k], options.high[k]);
    if (to == limit) continue;
    const double at = (limit - inside.constants[k]) / (to - inside.constants[k]);
    if (at < part) part = at, left = {k, limit};
  }
  return left;
}

OrbitCurveEnd end_of_range(const ParametricSystem& system, const OrbitCurveOptions& options, const LeftRange& left) {
  return {OrbitCurveEnding::bound,
          fmt::format("{} reaches the end of its range", system.constant_name(options.constants[left.constant]))};
}

bool comes_back(const OrbitCurvePoint& a, const OrbitCurvePoint& b, const OrbitCurvePoint& origin,
                const OrbitCurveOptions& options) {
  if (a.low.empty() || origin.low.empty()) return false;
  const auto u = seen_from_outside(a, options, origin), v = seen_from_outside(b, options, origin),
             o = seen_from_outside(origin, options, origin);
  double whole = 0, along = 0, apart = 0;
  for (std::size_t i = 0; i < o.size(); ++i) {
    whole += (v[i] - u[i]) * (v[i] - u[i]);
    along += (v[i] - u[i]) * (o[i] - u[i]);
  }
  const double part = along / whole;
  if (!(part > 0 && part <= 1)) return false;
  for (std::size_t i = 0; i < o.size(); ++i) apart += std::pow(u[i] + part * (v[i] - u[i]) - o[i], 2);
  return std::sqrt(apart) < 0.1 * std::sqrt(whole);
}

void CoveredRange::report(double value) {
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
  const double whole = options_.high[1] - options_.low[1];
  if (options_.progress) options_.progress(std::min((high_ - low_) / whole, 1.0));
}

}  // namespace continuo::studies::detail
