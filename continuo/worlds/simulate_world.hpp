// continuo/worlds/simulate_world.hpp
// A whole run of a model with a world, as `simulate` does for equations: rows, events, contacts, checks.
//
//   const model::Simulated simulated = worlds::simulate_world(program, {.method = "fast", .step = 0.01});
//
// Events are looked for between looks: in the exact mode a thousand in a run, every row, at contacts and where
// conditions turn (world_looks.cpp); there the instant is then found to neighbouring times, by moving a copy of the
// world again. In the fast mode every step ends with a look, and an event happens there. Rows of the fast mode are the
// first ends of steps that are not before the wanted times.
#pragma once
#include <memory>

#include <continuo/model/simulate.hpp>

namespace continuo::worlds {

model::Simulated simulate_world(const std::shared_ptr<const model::ModelProgram>& program,
                                const model::Experiment& experiment = {});

/// By simulate_world where the model has a world, else by model::simulate.
model::Simulated simulate_any(const std::shared_ptr<const model::ModelProgram>& program,
                              const model::Experiment& experiment = {});

}  // namespace continuo::worlds
