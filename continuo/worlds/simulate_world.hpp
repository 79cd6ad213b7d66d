// continuo/worlds/simulate_world.hpp
// A whole run of a model with a world, as `simulate` does for equations: rows, events, contacts, checks.
//
//   const model::Simulated simulated = worlds::simulate_world(program, {.method = "fast", .step = 0.01});
//
// Events are looked for between looks: in the exact mode a thousand in a run, every row, at contacts and where
// conditions turn (event_search.cpp); there the instant is then found to neighbouring times, by moving a copy of the
// world again. In the fast mode every step ends with a look, and an event happens there. Rows of the fast mode are the
// first ends of steps that are not before the wanted times.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include <continuo/simulation/simulate.hpp>
#include <continuo/worlds/run_log.hpp>

namespace continuo::worlds {

/// With a log it is recorded as it goes.
[[nodiscard]] model::Simulated simulate_world(const std::shared_ptr<const model::ModelProgram>& program,
                                              const model::Experiment& experiment = {}, RunLog* log = nullptr);

/// The run that was recorded, told again. The program must be of its text; numbers that do not fit it are told (E325).
[[nodiscard]] model::Simulated replay_world(const std::shared_ptr<const model::ModelProgram>& program,
                                            const RunRecording& recording);

/// What of a run that goes on may be other than recorded.
struct GoOn {
  std::optional<double> to{};
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double t)> progress{};
};
/// The recorded run up to one of its checkpoints, and from there on simulated: to the end that it was to have, to the
/// same bits as without a break, or to another.
[[nodiscard]] model::Simulated resume_world(const std::shared_ptr<const model::ModelProgram>& program,
                                            const RunRecording& recording, std::size_t checkpoint, const GoOn& how = {},
                                            RunLog* log = nullptr);

}  // namespace continuo::worlds
