// continuo/worlds/plan_world.hpp
// The plan of a world: how its bodies are moved, from the mode that it names and from an experiment.
#pragma once
#include <optional>
#include <vector>

#include <continuo/simulation/experiment.hpp>

namespace continuo::worlds {

/// The plan, or nothing where `problems` has the reason: E33x, E34x.
[[nodiscard]] std::optional<model::Plan> plan_world(const model::Model& model, const model::Experiment& experiment,
                                                    std::vector<model::Diagnostic>& problems);

}  // namespace continuo::worlds
