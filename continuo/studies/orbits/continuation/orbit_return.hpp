// Whether a motion has come back to where it was, or has but for whole turns of angles. Internal to periodic_orbit.
#pragma once
#include <span>
#include <vector>

#include <continuo/studies/periodic_orbit.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies::detail {

/// Where each component ranges on the way.
struct Extent {
  std::vector<double> low, high;
  [[nodiscard]] double size(std::size_t i) const { return high[i] - low[i]; }
};
[[nodiscard]] Extent extent_of(const std::vector<std::vector<double>>& states);

struct Return {
  double time = 0;                // 0 where there is none
  std::vector<double> advance{};  // as PeriodicOrbit::advance
};
/// Between the last point of the section and one before that is alike to this part of the motion's size, or is but for
/// whole turns of angles. `noise` is what the integration leaves of a component that has come to rest.
[[nodiscard]] Return last_return(const ParametricSystem& system, std::span<const SectionPoint> points,
                                 const Extent& extent, const std::vector<std::vector<double>>& states, double part,
                                 double noise);

/// Whether a component goes on and on in one direction, as an angle that turns over does.
[[nodiscard]] bool goes_on(const std::vector<std::vector<double>>& states, const Extent& extent, std::size_t component);

}  // namespace continuo::studies::detail
