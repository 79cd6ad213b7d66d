// What following a curve in the plane of two constants takes, whatever is solved for at each place: both directions,
// the ranges, where the curve closes. Internal to orbit_curve.
#pragma once
#include <functional>
#include <limits>
#include <optional>

#include <continuo/studies/orbit_curve.hpp>

namespace continuo::studies::detail {

/// `followed(curve, direction)` appends what lies on one side of the first point and says why it ends; -1 comes first.
OrbitCurve followed_both_ways(OrbitBifurcation kind, const OrbitCurvePoint& first,
                              const std::function<OrbitCurveEnd(OrbitCurve& curve, double direction)>& followed);

bool is_inside(const OrbitCurvePoint& point, const OrbitCurveOptions& options);

/// The range that is left first between a place inside and one outside.
struct LeftRange {
  std::size_t constant = 0;  // 0 or 1
  double bound = 0;
};
LeftRange left_range(const OrbitCurvePoint& inside, const OrbitCurvePoint& outside, const OrbitCurveOptions& options);
OrbitCurveEnd end_of_range(const ParametricSystem& system, const OrbitCurveOptions& options, const LeftRange& left);

/// Whether the curve passes its first point again between two neighbours. `origin` has a period or none is compared.
bool comes_back(const OrbitCurvePoint& a, const OrbitCurvePoint& b, const OrbitCurvePoint& origin,
                const OrbitCurveOptions& options);

/// Tells the options' progress how much of the second range has been covered.
class CoveredRange {
 public:
  explicit CoveredRange(const OrbitCurveOptions& options) : options_(options) {}
  void report(double value);

 private:
  const OrbitCurveOptions& options_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

}  // namespace continuo::studies::detail
