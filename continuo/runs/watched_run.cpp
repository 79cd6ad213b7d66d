// Each model to the module that can run it and show it.
#include <utility>

#include <continuo/boundary/watched_boundary.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/watched_run.hpp>
#include <continuo/worlds/simulate_world.hpp>

namespace continuo::runs {

WatchedRun run(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
               const RunRequest& request, model::MotionWatcher& watcher) {
  const Solver solver = kind_of(program->model).solver;
  if (solver == Solver::world) {
    model::Simulated simulated = run(program, experiment, request);
    const bool is_shown = simulated.run && worlds::show_world(program, experiment, *simulated.run, watcher);
    return {std::move(simulated), is_shown};
  }
  if (solver == Solver::collocation && !request.from_start)
    return {boundary::simulate_boundary(program, experiment, request.boundary, watcher)};
  return {model::simulate(
      program, experiment,
      {.on_row = request.on_row, .watcher = &watcher, .log = request.log ? request.log->integration() : nullptr})};
}

}  // namespace continuo::runs
