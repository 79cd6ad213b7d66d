// The dispatcher: each model to the module that can run it.
#include <continuo/runs/kind.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/worlds/plan_world.hpp>
#include <continuo/worlds/simulate_world.hpp>

namespace continuo::runs {

model::Simulated run(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
                     const RunRequest& request) {
  const Solver solver = kind_of(program->model).solver;
  Log* const log = request.log;
  if (solver == Solver::world)
    return worlds::simulate_world(program, experiment, log ? log->world() : nullptr, request.on_row);
  if (solver == Solver::collocation && !request.from_start)
    return boundary::simulate_boundary(program, experiment, request.boundary);
  return model::simulate(program, experiment, {.on_row = request.on_row, .log = log ? log->integration() : nullptr});
}

std::optional<model::Plan> plan(const model::Model& model, const model::Experiment& experiment,
                                std::vector<model::Diagnostic>& problems) {
  switch (kind_of(model).solver) {
    case Solver::world:
      return worlds::plan_world(model, experiment, problems);
    case Solver::collocation:
      return boundary::plan_boundary(model, experiment, problems);
    case Solver::integration:
      break;
  }
  return model::plan(model, experiment, problems);
}

std::optional<model::Plan> plan_from_start(const model::ModelProgram& program, const model::Experiment& experiment,
                                           std::vector<model::Diagnostic>& problems) {
  // The inputs of a world are put in their places where it is built.
  if (kind_of(program.model).solver == Solver::world) return worlds::plan_world(program.model, experiment, problems);
  return model::plan_run(program, experiment, problems);
}

}  // namespace continuo::runs
