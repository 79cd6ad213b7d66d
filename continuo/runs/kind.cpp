// The kinds of runs, and what of them differs.
#include <continuo/language/world.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::runs {

std::string_view name_of(Solver solver) {
  switch (solver) {
    case Solver::integration:
      return "integration";
    case Solver::collocation:
      return "collocation";
    case Solver::world:
      return "world";
  }
  return "";
}

Kind kind_of(const model::Model& model) {
  const bool has_start = !model.needs_boundary_solver();
  if (model.has_world())
    return {.solver = Solver::world,
            .has_start = has_start,
            .has_exact_derivatives = false,
            .has_absolute_tolerances = false,
            .has_rows_at_any_time = false,
            .can_be_recorded = true,
            .cost = "collisions"};
  return {.solver = has_start ? Solver::integration : Solver::collocation,
          .has_start = has_start,
          .can_be_recorded = has_start};
}

double cost_of(const model::Model& model, const model::Run& run) {
  return kind_of(model).solver == Solver::world ? collisions_of(*model.world, run.final_state())
                                                : static_cast<double>(run.statistics.evaluations);
}

std::optional<model::Diagnostic> no_study_of_equations(const model::Model& model) {
  if (kind_of(model).solver != Solver::world) return std::nullopt;
  return model::no_study_of_worlds(model);
}

}  // namespace continuo::runs
