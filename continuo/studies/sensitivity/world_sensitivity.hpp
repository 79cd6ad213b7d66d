// Sensitivities of a world of bodies, by differences of whole runs. Internal to sensitivity.
//
// Between impacts a motion is a smooth function of p, and so it is through an impact that takes place whatever p is:
// where a body is depends on p without a jump, but with a kink where the impact is just now. A difference is taken
// between runs that have had as many collisions at that instant as the run itself, on both sides of p where both have,
// else on the one; where neither has, places, which do not jump, are compared over both all the same, and nothing is
// said of velocities (not a number). Over a width that is asked for both sides are compared whatever happens there.
#pragma once
#include <memory>

#include <continuo/studies/sensitivity.hpp>
#include <continuo/studies/sensitivity/sensitive_program.hpp>

namespace continuo::studies::detail {

[[nodiscard]] SensitivityRun world_sensitivity(const std::shared_ptr<const SensitiveProgram>& program,
                                               const SensitivityRequest& request);

/// Whether a state of bodies, or a measure of the world, jumps at impacts.
[[nodiscard]] bool jumps_at_impacts(const model::Model& model, std::size_t state);

}  // namespace continuo::studies::detail
