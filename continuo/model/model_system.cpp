// continuo/model/model_system.cpp
#include <algorithm>
#include <numeric>
#include <utility>

#include <continuo/model/derivative.hpp>
#include <continuo/model/model_system.hpp>

namespace continuo::model {

ModelSystem::ModelSystem(std::shared_ptr<const ModelProgram> program, std::span<const double> variables)
    : program_(std::move(program)),
      mode_(program_->model.start_mode),
      variables_(variables.begin(), variables.end()),
      jacobians_(program_->model.modes.size()) {
  const Layout& layout = program_->model.layout;
  for (const auto& tape : program_->derivatives) derivatives_.emplace_back(tape, layout, variables);
  for (const ProgramGuards& guards : program_->guards) guards_.emplace_back(guards.tape, layout, variables);
  for (const ProgramBlock& block : program_->event_blocks) event_blocks_.emplace_back(block.tape, layout, variables);
  for (const ProgramBlock& block : program_->schedule_blocks) {
    schedule_blocks_.emplace_back(block.tape, layout, variables);
  }
  guard_values_.resize(program_->model.events.size());
}

template <class Visit>
void ModelSystem::for_each(Visit&& visit) {
  for (auto* list : {&derivatives_, &guards_, &event_blocks_, &schedule_blocks_}) std::ranges::for_each(*list, visit);
}

void ModelSystem::set(std::uint32_t variable, double value) {
  variables_[variable] = value;
  for (auto& jacobian : jacobians_) {
    if (jacobian) jacobian->set(variable, value);
  }
  for_each([&](Evaluation& evaluation) { evaluation.set(variable, value); });
}

void ModelSystem::guards(double t, const X& x, std::span<double> values) {
  const std::vector<std::size_t>& events = program_->guards[mode_].events;
  if (events.empty()) return;
  guards_[mode_](t, x, std::span(guard_values_).first(events.size()));
  for (std::size_t k = 0; k < events.size(); ++k) values[events[k]] = guard_values_[k];
}

void ModelSystem::jacobian(double t, const X& x, std::span<double> rows) {
  auto& mine = jacobians_[mode_];
  if (!mine) mine.emplace(*program_, mode_, variables_);
  (*mine)(t, x, rows);
}

ModelJacobian::ModelJacobian(const ModelProgram& program, std::size_t mode, std::span<const double> variables) {
  const Model& model = program.model;
  std::vector<std::uint32_t> columns(model.states.size());
  std::iota(columns.begin(), columns.end(), model.layout.states);
  // The derivatives are new nodes, so they need a graph of their own; inputs stay as they are: none is a state.
  ModelProgram own(model);
  own.tables = program.tables;
  own.linear_inputs = program.linear_inputs;
  std::vector<NodeId> nodes;
  for (const JacobianEntry& entry : jacobian(own.model.graph, own.model.modes[mode].derivatives, columns)) {
    pattern_.push_back({entry.row, entry.column});
    nodes.push_back(entry.value);
  }
  entries_ = Evaluation(own.tape_of(nodes), model.layout, variables);
  values_.resize(nodes.size());
}

void ModelJacobian::operator()(double t, std::span<const double> x, std::span<double> rows) {
  std::ranges::fill(rows, 0.0);
  entries_(t, x, values_);
  for (std::size_t k = 0; k < pattern_.size(); ++k) rows[pattern_[k].row * x.size() + pattern_[k].column] = values_[k];
}

}  // namespace continuo::model
