// continuo/model/model_system.cpp
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/model/model_system.hpp>

namespace continuo::model {

ModelSystem::ModelSystem(std::shared_ptr<const ModelProgram> program, std::span<const double> variables)
    : program_(std::move(program)), mode_(program_->model.start_mode), variables_(variables.begin(), variables.end()) {
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
  if (derivatives_of_f_) derivatives_of_f_->set(variable, value);
  for_each([&](Evaluation& evaluation) { evaluation.set(variable, value); });
}

void ModelSystem::guards(double t, const X& x, std::span<double> values) {
  const std::vector<std::size_t>& events = program_->guards[mode_].events;
  if (events.empty()) return;
  guards_[mode_](t, x, std::span(guard_values_).first(events.size()));
  for (std::size_t k = 0; k < events.size(); ++k) values[events[k]] = guard_values_[k];
}

ModelDerivatives& ModelSystem::derivatives_of_f() {
  if (!derivatives_of_f_) derivatives_of_f_.emplace(*program_, variables_);
  return *derivatives_of_f_;
}

// An input that follows a table over time is a variable to the graph, so its change is measured: by a difference.
void ModelSystem::time_derivative(double t, const X& x, X& dfdt) {
  if (program_->linear_inputs.empty()) {
    derivatives_of_f().time_derivative(mode_, t, x, dfdt);
    return;
  }
  const double moved = t + std::sqrt(std::numeric_limits<double>::epsilon()) * std::max(1.0, std::abs(t));
  X now(x.size());
  (*this)(t, x, now);
  (*this)(moved, x, dfdt);
  for (std::size_t i = 0; i < x.size(); ++i) dfdt[i] = (dfdt[i] - now[i]) / (moved - t);
}

}  // namespace continuo::model
