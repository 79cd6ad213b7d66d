// continuo/worlds/prepared_world.hpp
// A world at the start of a run, with the plan of that run, or the reason why it cannot begin. Internal to worlds.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

inline constexpr std::size_t contacts_of_one_look = 10'000;

/// A world at its start, with its plan.
struct PreparedWorld {
  std::optional<model::Plan> plan;
  std::unique_ptr<WorldRun> world;  // null where it cannot begin
};
/// `initial`: values of states in place of the model's.
[[nodiscard]] PreparedWorld prepare_world(const std::shared_ptr<const model::ModelProgram>& program,
                                          const model::Experiment& experiment, std::vector<model::Diagnostic>& problems,
                                          std::span<const std::pair<std::size_t, double>> initial = {});

}  // namespace continuo::worlds
