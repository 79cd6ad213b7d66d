// Leaves the ranges of two constants, reports progress, and closes curves.
#include <algorithm>
#include <cmath>

#include <continuo/studies/orbits/curves/orbit_curve_course.hpp>
#include <continuo/studies/support/chord.hpp>

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

bool comes_back(const OrbitCurvePoint& a, const OrbitCurvePoint& b, const OrbitCurvePoint& origin,
                const OrbitCurveOptions& options) {
  if (a.low.empty() || origin.low.empty()) return false;
  const auto from = seen_from_outside(a, options, origin), to = seen_from_outside(b, options, origin);
  const Chord chord(from, to, seen_from_outside(origin, options, origin));
  return chord.passes() && chord.apart < 0.1 * chord.length;
}

double SizesOnCurve::part_of(const OrbitCurvePoint& point) {
  greatest_.resize(point.x.size());
  double part = 0;
  for (std::size_t i = 0; i < point.x.size(); ++i) {
    const double size = std::max(point.high[i] - point.x[i], point.x[i] - point.low[i]);
    greatest_[i] = std::max(greatest_[i], size);
    if (greatest_[i] > 0) part = std::max(part, size / greatest_[i]);
  }
  return part;
}

}  // namespace continuo::studies::detail
