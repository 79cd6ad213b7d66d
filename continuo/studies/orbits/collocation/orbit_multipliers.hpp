// What becomes of neighbours of a closed orbit after one period. Internal to orbit_continuation.
#pragma once
#include <complex>
#include <span>
#include <vector>

#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>

namespace continuo::studies::detail {

/// The multipliers but that of the shift along the orbit, by descending size. `sizes`: of the components. None where f
/// vanishes on the way.
[[nodiscard]] std::vector<std::complex<double>> multipliers_of(const ParametricSystem& system,
                                                               const OrbitCollocation& orbit, std::span<const double> z,
                                                               std::span<const double> sizes);

}  // namespace continuo::studies::detail
