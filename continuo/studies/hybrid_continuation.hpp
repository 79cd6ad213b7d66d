// How a closed orbit of a model with all that happens in it, events, modes, jumps, the time, changes when one parameter
// does: a branch of fixed points of the return, followed round its folds by pseudo-arclength, as orbit_continuation.hpp
// follows those of smooth equations, with the same marks and ends. Where an event is only touched (grazing), or two
// come at once, the derivative ends, and the branch with it.
//
//   const HybridOrbit orbit = find_hybrid_orbit(program, experiment, {.forcing = period});
//   const OrbitBranch branch =
//       continue_hybrid_orbit(program, experiment, orbit, {{.constant = p, .low = 0, .high = 1}, period});
#pragma once
#include <memory>
#include <optional>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/studies/hybrid_orbit.hpp>
#include <continuo/studies/orbit_continuation.hpp>

namespace continuo::studies {

/// `constant` is one of the model's parameters, by number.
struct HybridContinuationOptions : OrbitContinuationOptions {
  /// What depends on the time has this period where the parameter is now; nothing where no time matters.
  std::optional<double> forcing{};
};

/// From an orbit at the parameter's present value in the experiment, in both directions.
[[nodiscard]] OrbitBranch continue_hybrid_orbit(const std::shared_ptr<const model::ModelProgram>& program,
                                                const model::Experiment& experiment, const HybridOrbit& start,
                                                const HybridContinuationOptions& options);
/// From a period doubling: the orbits of twice the period. From a crossing: the other branch, in both directions.
[[nodiscard]] OrbitBranch continue_hybrid_orbit(const std::shared_ptr<const model::ModelProgram>& program,
                                                const model::Experiment& experiment, const OrbitMark& start,
                                                const HybridContinuationOptions& options);

}  // namespace continuo::studies
