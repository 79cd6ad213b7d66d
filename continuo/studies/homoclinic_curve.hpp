// A curve of homoclinic orbits in two constants, from its start to where it ends, with the places where they are more
// than that. Internal to orbit_curve.
#pragma once
#include <optional>

#include <continuo/studies/homoclinic_steps.hpp>
#include <continuo/studies/orbit_curve.hpp>

namespace continuo::studies::detail {

/// What a place where this test is zero is; nothing where the zero is none.
std::optional<OrbitDegeneracy> degeneracy_of(HomoclinicTest test, const HomoclinicPlace& place);

OrbitCurve homoclinic_curve(const ParametricSystem& system, const OrbitMark& start, const OrbitCurveOptions& options);

}  // namespace continuo::studies::detail
