// continuo/language/check/products.cpp
// Moves the products of the passes to their places in the model.
#include <filesystem>

#include <continuo/language/check/products.hpp>

namespace continuo::model::detail {

Model empty_model(const ast::Model& tree, const Source& source) {
  Model model;
  model.name = tree.name ? tree.name->text : std::filesystem::path(source.name()).stem().string();
  model.heading = tree.heading;
  model.text = {source.name(), source.text()};
  return model;
}

void store(const TimeUnit& found, Model& model) {
  model.has_units = found.model_has_units;
  model.time_unit = found.text();
}

void store(const Declarations& declared, Model& model) {
  model.tables = declared.tables;
  for (const ModeText& mode : declared.modes) model.modes.push_back({mode.name, {}, mode.span});
}

void store(Parameters made, Model& model) {
  model.parameters = std::move(made.all);
  model.parameter_order = std::move(made.order);
}

void store(BoundaryProblem made, Model& model) {
  model.boundary = std::move(made.conditions);
  model.guesses = std::move(made.guesses);
}

void store(SolvedEquations made, Model& model, Workspace& workspace) {
  for (std::size_t mode = 0; mode < model.modes.size(); ++mode)
    model.modes[mode].derivatives = std::move(made.derivatives[mode]);
  model.algebraic = std::move(made.algebraic);
  model.masses = std::move(made.masses);
  workspace.solved = std::move(made.highest);
}

void store(PairedStates made, Model& model) {
  model.pairs = std::move(made.all);
  model.all_paired = made.is_everything;
  model.accelerations_depend_on_velocities = made.accelerations_depend_on_velocities;
}

void store(Quantities made, Model& model) {
  model.lets = std::move(made.lets);
  model.outputs = std::move(made.outputs);
  model.energies = std::move(made.energies);
  model.total_energy = made.total_energy;
  model.total_energy_unit = std::move(made.total_energy_unit);
  model.energy_terms = std::move(made.energy_terms);
}

void store(EventList made, Model& model) {
  model.events = std::move(made.events);
  model.schedule = std::move(made.schedule);
  model.event_order = std::move(made.order);
}

}  // namespace continuo::model::detail
