// A curve of homoclinic orbits in two constants, from its start to where it ends, with the places where they are more
// than that. Internal to orbit_curve.
#pragma once
#include <continuo/studies/orbit_curve.hpp>

namespace continuo::studies::detail {

OrbitCurve homoclinic_curve(const ParametricSystem& system, const OrbitMark& start, const OrbitCurveOptions& options);

}  // namespace continuo::studies::detail
