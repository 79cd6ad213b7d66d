// What following a curve in the plane of two constants takes, whatever is solved for at each place: the ranges, where
// the curve closes, how large the orbits are. Internal to orbit_curve.
#pragma once
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/support/ranges_of_constants.hpp>

namespace continuo::studies::detail {

inline constexpr double same_orbit_on_chord = 2e-3;  // in sizes: chords of a curve are not nearer to it

[[nodiscard]] inline bool is_inside(const OrbitCurvePoint& point, const OrbitCurveOptions& options) {
  return is_within(point.constants, options.low, options.high);
}
[[nodiscard]] inline LeftRange left_range(const OrbitCurvePoint& inside, const OrbitCurvePoint& outside,
                                          const OrbitCurveOptions& options) {
  return left_range(inside.constants, outside.constants, options.low, options.high);
}
/// `options.constants`: which of the system's are followed.
template <class Options>
[[nodiscard]] OrbitCurveEnd end_of_range(const ParametricSystem& system, const Options& options,
                                         const LeftRange& left) {
  return {OrbitCurveEnding::bound,
          fmt::format("{} reaches the end of its range", system.constant_name(options.constants[left.constant]))};
}

/// Whether the curve passes its first point again between two neighbours. `origin` has a period or none is compared.
[[nodiscard]] bool comes_back(const OrbitCurvePoint& a, const OrbitCurvePoint& b, const OrbitCurvePoint& origin,
                              const OrbitCurveOptions& options);

/// The sizes of homoclinic orbits along a curve: how far each component goes from the saddle.
class SizesOnCurve {
 public:
  /// Of the component of which most is left, in parts of the greatest so far.
  [[nodiscard]] double part_of(const OrbitCurvePoint& point);
  void forget() { greatest_.clear(); }
  [[nodiscard]] double greatest(std::size_t component) const { return greatest_[component]; }

 private:
  std::vector<double> greatest_{};
};

}  // namespace continuo::studies::detail
