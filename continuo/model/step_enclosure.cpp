// continuo/model/step_enclosure.cpp
#include <algorithm>

#include <continuo/model/step_enclosure.hpp>
#include <continuo/numerics/polynomial_enclosure.hpp>

namespace continuo::model {

namespace {

Enclosure<double> time_over(const Step& step, double from, double to) {
  return Enclosure<double>(step.begin) + Enclosure<double>(from, to) * Enclosure<double>(step.size);
}

}  // namespace

StepEnclosure::StepEnclosure(const ModelProgram& program, std::span<const NodeId> nodes,
                             std::span<const double> variables)
    : tape_(program.tape_of(nodes)),
      states_begin_(program.model.layout.states),
      variables_(variables.begin(), variables.end()),
      coefficients_(greatest_enclosed_degree + 1) {
  reads_time_ = !program.linear_inputs.empty();  // whose tables are read by time
  for (const std::uint32_t variable : variables_of(program.model.graph, nodes)) {
    reads_time_ = reads_time_ || variable == Layout::time;
    if (variable >= states_begin_ && variable - states_begin_ < program.model.states.size())
      components_.push_back(variable - states_begin_);
  }
}

std::span<const EnclosureWithSlope<double>> StepEnclosure::over(const Step& step, double from, double to) {
  prepare(with_slopes_);
  auto& registers = with_slopes_.numbers;
  if (reads_time_) registers[Layout::time] = {time_over(step, from, to), Enclosure<double>(step.size)};
  for (const std::uint32_t i : components_)
    registers[states_begin_ + i] = enclose_polynomial(component(step, i), from, to);
  tape_->evaluate<EnclosureWithSlope<double>>(registers, with_slopes_.outputs);
  return with_slopes_.outputs;
}

std::span<const Enclosure<double>> StepEnclosure::values_over(const Step& step, double from, double to) {
  prepare(values_);
  auto& registers = values_.numbers;
  if (reads_time_) registers[Layout::time] = time_over(step, from, to);
  for (const std::uint32_t i : components_) registers[states_begin_ + i] = component_over(step, i, from, to);
  tape_->evaluate<Enclosure<double>>(registers, values_.outputs);
  return values_.outputs;
}

void StepEnclosure::set(std::uint32_t variable, double value) {
  variables_[variable] = value;
  with_slopes_.is_prepared = values_.is_prepared = false;
}

template <class Number>
void StepEnclosure::prepare(Registers<Number>& registers) {
  if (registers.is_prepared) return;
  registers.numbers.resize(tape_->register_count());
  registers.outputs.resize(tape_->output_count());
  std::ranges::transform(variables_, registers.numbers.begin(), [](double value) { return Number(value); });
  tape_->prepare<Number>(registers.numbers);
  registers.is_prepared = true;
}

Enclosure<double> StepEnclosure::component_over(const Step& step, std::size_t i, double from, double to) {
  if (from == 0 && to == 1) {
    const std::vector<double>* const c = step.coefficients.data();
    return enclose_whole_polynomial<double>(step.coefficients.size(), [c, i](std::size_t j) { return c[j][i]; });
  }
  return from == to ? polynomial_at(component(step, i), from) : enclose_polynomial(component(step, i), from, to).value;
}

std::span<const double> StepEnclosure::component(const Step& step, std::size_t i) {
  for (std::size_t j = 0; j < step.coefficients.size(); ++j) coefficients_[j] = step.coefficients[j][i];
  return std::span<const double>(coefficients_).first(step.coefficients.size());
}

}  // namespace continuo::model
