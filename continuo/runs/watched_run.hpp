// Any model, run, and its motion shown to somebody who wants to see it between its rows.
//
//   results::MotionCurves curves(program, plots);
//   const runs::WatchedRun watched = runs::run(program, {.rtol = 1e-9}, {}, curves);
#pragma once
#include <memory>

#include <continuo/runs/run.hpp>
#include <continuo/simulation/motion_watcher.hpp>

namespace continuo::runs {

/// A run, and whether the watcher has seen all of it. Bodies are moved a second time for that, which can be too long,
/// or end elsewhere where a motion multiplies every rounding: then what the watcher has seen is not this run.
struct WatchedRun {
  model::Simulated simulated;
  bool is_shown = true;
};

/// The run is the same as without a watcher, to the last bit.
[[nodiscard]] WatchedRun run(const std::shared_ptr<const model::ModelProgram>& program,
                             const model::Experiment& experiment, const RunRequest& request,
                             model::MotionWatcher& watcher);

}  // namespace continuo::runs
