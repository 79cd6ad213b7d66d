// continuo/live/motion/point_rate.hpp
// The velocity and the acceleration of a drawn point: derivatives by time along the motion, exact.
//
//   const auto v = rate_along_motion(model, l*sin(theta), mode);     // l*cos(theta)*theta'
#pragma once
#include <cstddef>
#include <optional>

#include <continuo/language/model.hpp>

namespace continuo::live {

/// d node / dt along the motion in a mode, per unit of time of the model; nothing where the motion does not say it: of
/// what depends on inputs, on unknowns of equations without derivatives, or on velocities of bodies.
[[nodiscard]] std::optional<model::NodeId> rate_along_motion(model::Model& model, model::NodeId node, std::size_t mode);

}  // namespace continuo::live
