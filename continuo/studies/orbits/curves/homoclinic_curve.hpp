// Curves of homoclinic orbits in two constants, from a start to where they end, with the places where they are more
// than that. Where the saddle becomes a saddle-node, the central homoclinic orbits of saddle-nodes begin, and end where
// they are not central any more, where other orbits of saddles begin: all of them are followed. Internal to
// orbit_curve.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/orbits/curves/homoclinic_steps.hpp>

namespace continuo::studies::detail {

inline constexpr double truncated_well = 1e-6;   // of the ranges: by how much constants may be off
inline constexpr double resolved_well = 1e-4;    // likewise of the orbit
inline constexpr double shrunk_to_rest = 5e-4;   // of the greatest size on the curve
inline constexpr double exactly_there = 1e-6;    // of a test that is of the size of 1
inline constexpr double above_rounding = 1e-9;   // likewise
inline constexpr std::size_t points_round = 12;  // of a closed curve

/// What a place where this test is zero is; nothing where the zero is none.
[[nodiscard]] std::optional<OrbitDegeneracy> degeneracy_of(HomoclinicTest test, const HomoclinicPlace& place);

/// The first one is that from the start; at most so many, and one at least.
[[nodiscard]] std::vector<OrbitCurve> homoclinic_curves(const ParametricSystem& system, const OrbitMark& start,
                                                        const OrbitCurveOptions& options, std::size_t most);

}  // namespace continuo::studies::detail
