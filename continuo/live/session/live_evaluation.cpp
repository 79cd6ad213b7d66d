// Writes into an evaluation only the parameters and inputs that differ from those it has.
#include <cstdint>
#include <utility>

#include <continuo/live/session/live_evaluation.hpp>

namespace continuo::live {

LiveEvaluation::LiveEvaluation(const LiveModel& shown, std::span<const model::NodeId> nodes, Variables variables)
    : program_(shown.program), evaluation_(program_->tape_of(nodes), *variables), variables_(std::move(variables)) {}

void LiveEvaluation::use(const Variables& variables) {
  if (variables_ == variables) return;
  const model::Layout& layout = program_->model.layout;
  for (std::uint32_t i = layout.parameters; i < layout.samples; ++i) {
    const double value = (*variables)[i];
    if ((*variables_)[i] != value) evaluation_.set(i, value);
  }
  variables_ = variables;
}

void LiveEvaluation::set_step_inputs(double t) {
  for (const model::TableInput& input : program_->step_inputs) evaluation_.set(input.variable, input.table.value(t));
}

void LiveEvaluation::append(double t, std::span<const double> x, std::vector<float>& to) {
  set_step_inputs(t);
  for (const double value : evaluation_(t, x)) to.push_back(static_cast<float>(value));
}

}  // namespace continuo::live
