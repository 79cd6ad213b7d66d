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

/// What a place where this test is zero is; nothing where the zero is none.
std::optional<OrbitDegeneracy> degeneracy_of(HomoclinicTest test, const HomoclinicPlace& place);

/// The first one is that from the start; at most so many, and one at least.
std::vector<OrbitCurve> homoclinic_curves(const ParametricSystem& system, const OrbitMark& start,
                                          const OrbitCurveOptions& options, std::size_t most);

}  // namespace continuo::studies::detail
