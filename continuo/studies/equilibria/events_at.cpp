// Finds the events of a model that fire, or must be met, at a point.
#include <algorithm>
#include <cmath>

#include <continuo/studies/equilibria/events_at.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::studies {

namespace {

/// How large the sides of `lhs - rhs` are: what is small beside them is nothing.
double size_of_sides(const model::Model& model, model::NodeId guard, std::span<const double> variables) {
  double size = 0;
  for (const model::NodeId side : model::arguments(model.graph[guard]))
    size = std::max(size, std::abs(model::evaluate(model, side, variables)));
  return size > 0 ? size : 1;
}

}  // namespace

std::vector<EventAt> events_at(const model::ModelProgram& program, std::size_t mode, std::span<const double> x,
                               const model::Overrides& parameters) {
  constexpr double near = 1e-9;
  const model::Model& model = program.model;
  std::vector<double> variables = model::start_values(model, parameters);
  std::ranges::copy(x, variables.begin() + model.layout.states);
  std::vector<EventAt> found;
  for (const model::When& when : model.events) {
    if (when.mode.value_or(mode) != mode) continue;
    if (!changes_something(when.actions) && !changes_something(when.limit_actions)) continue;
    const bool is_condition = when.truth.valid();
    const double guard = model::evaluate(model, when.guard, variables);
    const bool rises = when.direction == Direction::rises, falls = when.direction == Direction::falls;
    if (std::abs(guard) <= near * size_of_sides(model, when.guard, variables)) {
      found.push_back({when.name, EventAt::Where::on_surface, is_condition});
    } else if ((rises && guard > 0) || (falls && guard < 0)) {
      found.push_back({when.name, EventAt::Where::beyond, is_condition});
    }
  }
  return found;
}

}  // namespace continuo::studies
