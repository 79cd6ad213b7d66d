// continuo/worlds/simulate_world.hpp
// A whole run of a model with a world, as `simulate` does for equations: rows, events, contacts, checks.
//
//   const model::Simulated simulated = worlds::simulate_world(program, {.method = "fast", .step = 0.01});
//
// Conditions of events are sampled. In the exact mode there are a thousand samples in a run, and more at every row, at
// contacts, and where conditions have a turning point (event_search.cpp). The instant of an event between two samples
// is then located to rounding, by moving the world again from a snapshot. In the fast mode conditions are sampled at
// the end of every step, and events happen there. Rows of the fast mode are the first ends of steps that are not before
// the wanted times.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include <continuo/simulation/motion_watcher.hpp>
#include <continuo/worlds/run_log.hpp>

namespace continuo::worlds {

/// With a log, the run is recorded while it advances.
[[nodiscard]] model::Simulated simulate_world(const std::shared_ptr<const model::ModelProgram>& program,
                                              const model::Experiment& experiment = {}, RunLog* log = nullptr);
/// The same with its rows handed over while it advances, as by model::simulate.
[[nodiscard]] model::Simulated simulate_world(const std::shared_ptr<const model::ModelProgram>& program,
                                              const model::Experiment& experiment, RunLog* log,
                                              const model::OnRow& on_row);

/// Shows the motion of a run to a watcher, between its rows and at its contacts, by moving the world once more; the run
/// itself is not touched by that. False where it cannot be shown so: it took too long for a second time, or stopping
/// more often has changed a motion that multiplies every rounding.
[[nodiscard]] bool show_world(const std::shared_ptr<const model::ModelProgram>& program,
                              const model::Experiment& experiment, const model::Run& run,
                              model::MotionWatcher& watcher);

/// Replays a recorded run. The program must be that of its text; a recording that does not fit the program is reported
/// (E325).
[[nodiscard]] model::Simulated replay_world(const std::shared_ptr<const model::ModelProgram>& program,
                                            const RunRecording& recording, const model::RowsOfRecording& rows = {});

/// Those options of a resumed run that may differ from the recorded ones.
struct GoOn {
  std::optional<double> to{};
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double t)> progress{};
  model::RowsOfRecording rows{};
};
/// Replays a recorded run up to one of its checkpoints, and simulates it from there to its planned end, or to another.
/// The results have the same bits as those without a break.
[[nodiscard]] model::Simulated resume_world(const std::shared_ptr<const model::ModelProgram>& program,
                                            const RunRecording& recording, std::size_t checkpoint, const GoOn& how = {},
                                            RunLog* log = nullptr);

}  // namespace continuo::worlds
