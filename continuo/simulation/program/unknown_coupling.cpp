// Assigns an equation to each unknown, and finds the block of unknowns of an expression.
#include <algorithm>

#include <continuo/simulation/program/unknown_coupling.hpp>

namespace continuo::model {

namespace {

std::vector<std::uint32_t> components_of_unknowns(const Model& model) {
  std::vector<std::uint32_t> components;
  for (std::uint32_t i = 0; i < model.states.size(); ++i)
    if (model.states[i].algebraic) components.push_back(i);
  return components;
}

/// The places among `components` of those that the expression contains.
std::vector<std::size_t> unknowns_in(const Model& model, NodeId expression, std::span<const std::uint32_t> components) {
  std::vector<std::size_t> found;
  for (const std::uint32_t variable : variables_of(model.graph, expression)) {
    const auto at = std::ranges::lower_bound(components, variable - model.layout.states);
    if (variable >= model.layout.states && at != components.end() && *at == variable - model.layout.states)
      found.push_back(static_cast<std::size_t>(at - components.begin()));
  }
  return found;
}

std::vector<std::vector<std::size_t>> contained_unknowns(const Model& model, std::span<const NodeId> equations,
                                                         std::span<const std::uint32_t> components) {
  std::vector<std::vector<std::size_t>> contained;
  for (const std::uint32_t i : components) contained.push_back(unknowns_in(model, equations[i], components));
  return contained;
}

}  // namespace

UnknownCoupling::UnknownCoupling(const ModelProgram& program, std::span<const NodeId> equations)
    : program_(&program),
      components_(components_of_unknowns(program.model)),
      assignment_(components_.size(), contained_unknowns(program.model, equations, components_)) {
  for (const std::uint32_t i : components_) residuals_.push_back(equations[i]);
  (void)assignment_.first_left_over();
}

std::optional<UnknownBlock> UnknownCoupling::block(NodeId expression) const {
  std::vector<std::size_t> needed = unknowns_in(program_->model, expression, components_);
  for (std::size_t next = 0; next < needed.size(); ++next) {
    const std::size_t equation = assignment_.equation_of(needed[next]);
    if (equation == Assignment::npos) return std::nullopt;
    for (const std::size_t unknown : assignment_.contained_in(equation))
      if (std::ranges::find(needed, unknown) == needed.end()) needed.push_back(unknown);
    if (needed.size() > most_enclosed_unknowns) return std::nullopt;
  }
  std::ranges::sort(needed);
  UnknownBlock block;
  for (const std::size_t unknown : needed) {
    block.components.push_back(components_[unknown]);
    block.residuals.push_back(residuals_[assignment_.equation_of(unknown)]);
  }
  return block;
}

}  // namespace continuo::model
