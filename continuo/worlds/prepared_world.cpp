// continuo/worlds/prepared_world.cpp
// Checks, plans and builds a world for a run.
#include <continuo/worlds/plan_world.hpp>
#include <continuo/worlds/prepared_world.hpp>

namespace continuo::worlds {

namespace {

using model::Diagnostic;

std::optional<Diagnostic> refusal(const model::Model& model) {
  if (model.needs_dae_solver())
    return model::error("E323", model.algebraic.front().span, "equations `0 = ...` cannot stand beside a world", "",
                        "solve this one for its unknown and name it: let ... = ...");
  if (model.needs_boundary_solver())
    return model::error("E323", model.boundary.front().span, "a world begins at the start of its run",
                        "this condition stands at another time", "give all initial values at the start");
  return std::nullopt;
}

}  // namespace

PreparedWorld prepare_world(const std::shared_ptr<const model::ModelProgram>& program,
                            const model::Experiment& experiment, std::vector<Diagnostic>& problems,
                            std::span<const std::pair<std::size_t, double>> initial) {
  const model::Model& model = program->model;
  if (auto problem = refusal(model)) {
    problems.push_back(std::move(*problem));
    return {};
  }
  auto planned = plan_world(model, experiment, problems);
  if (!planned) return {};
  for (const model::TableInput& input : program->step_inputs)
    planned->variables[input.variable] = input.table.value(planned->from);
  for (const auto& [state, value] : initial) planned->variables[model.states[state].variable] = value;
  WorldOptions options = options_of(*planned);
  options.most_contacts = contacts_of_one_look;
  options.interrupt = experiment.interrupt;
  auto started = start_world(program, options, planned->variables);
  if (!started)
    problems.push_back(model::error("E324", model.world->span, "the world cannot begin", started.status().message));
  return {std::move(planned), started ? *std::move(started) : nullptr};
}

}  // namespace continuo::worlds
