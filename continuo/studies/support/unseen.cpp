// Looks for what moves a model beside the equations of one mode.
#include <algorithm>
#include <array>
#include <cmath>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <continuo/simulation/program/jumps.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::studies {

bool changes_something(const model::Block& block) {
  return std::ranges::any_of(block, [](const model::Action& action) {
    if (const auto* branch = std::get_if<model::If>(&action.what))
      return changes_something(branch->then) || changes_something(branch->otherwise);
    return std::holds_alternative<model::Assign>(action.what) || std::holds_alternative<model::Go>(action.what);
  });
}

std::optional<model::Span> changes_at_set_times(const model::Model& model) {
  for (const model::Scheduled& scheduled : model.schedule)
    if (changes_something(scheduled.actions)) return scheduled.span;
  return std::nullopt;
}

std::optional<model::Span> changes_by_event(const model::Model& model, std::size_t mode) {
  for (const model::When& when : model.events)
    if (when.mode.value_or(mode) == mode && (changes_something(when.actions) || changes_something(when.limit_actions)))
      return when.span;
  return changes_at_set_times(model);
}

std::optional<Unseen> unseen_of(const model::ModelProgram& program, std::size_t mode) {
  const model::Model& model = program.model;
  if (const auto span = changes_by_event(model, mode)) return Unseen{*span, "an event changes the motion"};
  const std::vector<model::Jump> jumps = model::jumps_of(model, mode);
  if (!jumps.empty()) {
    const model::State& state = model.states[jumps.front().state];
    return Unseen{state.span, fmt::format("the equation of `{}` jumps with `{}`",
                                          state.algebraic ? state.column : state.column + "'",
                                          model::text_of(model, jumps.front()))};
  }
  return std::nullopt;
}

std::optional<std::size_t> depends_on_time(const model::ModelProgram& program, std::size_t mode) {
  const model::Model& model = program.model;
  const std::vector<model::NodeId>& equations = model.modes[mode].derivatives;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    for (const std::uint32_t v : model::variables_of(model.graph, equations[i])) {
      const bool moved = std::ranges::any_of(
          model.inputs, [&](const model::Input& input) { return input.variable == v && input.points.has_value(); });
      if (v == model::Layout::time || moved) return i;
    }
  }
  return std::nullopt;
}

std::optional<std::string> jump_at(const model::ModelProgram& program, std::size_t mode, std::span<const double> x,
                                   const model::Overrides& parameters) {
  constexpr double near = 1e-9;
  const model::Model& model = program.model;
  std::vector<double> variables = model::start_values(model, parameters);
  std::ranges::copy(x, variables.begin() + model.layout.states);
  for (const model::Jump& jump : model::jumps_of(model, mode)) {
    const std::array nodes{jump.first, jump.second};
    const std::vector<double> values = model::evaluate(model, nodes, variables);
    const double size = std::max({1.0, std::abs(values[0]), std::abs(values[1])});
    if (model::distance_to(model.graph[jump.node].op, values[0], values[1]) <= near * size)
      return model::text_of(model, jump);
  }
  return std::nullopt;
}

}  // namespace continuo::studies
