// continuo/simulation/program/step_enclosure.cpp
// Encloses a model's expressions over a part of a step from its dense output.
#include <algorithm>

#include <continuo/numerics/polynomial_enclosure.hpp>
#include <continuo/simulation/program/step_enclosure.hpp>

namespace continuo::model {

StepEnclosure::StepEnclosure(const ModelProgram& program, std::span<const NodeId> nodes,
                             std::span<const double> variables, std::span<const UnknownBlock> blocks)
    : tape_(program.shared_tape_of(nodes)),
      states_begin_(program.model.layout.states),
      variables_(variables.begin(), variables.end()) {
  for (const UnknownBlock& block : blocks) unknowns_.emplace_back(program, block, variables);
  reads_time_ = !program.linear_inputs.empty();  // whose tables are read by time
  for (const std::uint32_t variable : variables_of(program.model.graph, nodes)) {
    reads_time_ = reads_time_ || variable == Layout::time;
    const std::uint32_t component = variable - states_begin_;
    if (variable >= states_begin_ && component < program.model.states.size() && !is_solved_for(component))
      components_.push_back(component);
  }
}

bool StepEnclosure::is_solved_for(std::uint32_t component) const {
  return std::ranges::any_of(unknowns_, [component](const UnknownEnclosure& block) {
    return std::ranges::binary_search(block.components(), component);
  });
}

std::span<const EnclosureWithSlope<double>> StepEnclosure::over(const Step& step, double from, double to) {
  // Over a whole step, ranges of the terms often show already that nothing turns.
  if (from == 0 && to == 1 && unknowns_.empty()) {
    const std::span<const EnclosureWithSlope<double>> quick =
        over(step, from, to, [](std::span<const double> c) { return enclose_whole_polynomial_with_slope(c); });
    if (std::ranges::all_of(quick, [](const auto& each) { return !each.slope.holds(0); })) return quick;
  }
  return over(step, from, to, [from, to](std::span<const double> c) { return enclose_polynomial(c, from, to); });
}

template <class EnclosePolynomial>
std::span<const EnclosureWithSlope<double>> StepEnclosure::over(const Step& step, double from, double to,
                                                                const EnclosePolynomial& enclose) {
  with_slopes_.prepare(*tape_, variables_);
  if (reads_time_) with_slopes_[Layout::time] = {step.time(from, to), Enclosure<double>(step.size)};
  for (const std::uint32_t i : components_) with_slopes_[states_begin_ + i] = enclose(component_.of(step, i));
  for (UnknownEnclosure& block : unknowns_) {
    block.over(step, from, to);
    const std::span<const Enclosure<double>> values = block.values(), slopes = block.slopes();
    for (std::size_t k = 0; k < values.size(); ++k)
      with_slopes_[states_begin_ + block.components()[k]] = {values[k], slopes[k]};
  }
  return with_slopes_.evaluate(*tape_);
}

std::span<const Enclosure<double>> StepEnclosure::values_over(const Step& step, double from, double to) {
  values_.prepare(*tape_, variables_);
  if (reads_time_) values_[Layout::time] = step.time(from, to);
  for (const std::uint32_t i : components_) values_[states_begin_ + i] = component_over(step, i, from, to);
  for (UnknownEnclosure& block : unknowns_) {
    block.over(step, from, to);
    for (std::size_t k = 0; k < block.components().size(); ++k)
      values_[states_begin_ + block.components()[k]] = block.values()[k];
  }
  return values_.evaluate(*tape_);
}

void StepEnclosure::set(std::uint32_t variable, double value) {
  variables_[variable] = value;
  with_slopes_.forget();
  values_.forget();
  for (UnknownEnclosure& block : unknowns_) block.set(variable, value);
}

Enclosure<double> StepEnclosure::component_over(const Step& step, std::size_t i, double from, double to) {
  // Nearly always the part is the whole step, but for the rounding of its end; where it is the rest behind an event,
  // the range over the whole is so cheap that it pays to ask by that first.
  if (from != to) {
    const std::vector<double>* const c = step.coefficients.data();
    return enclose_whole_polynomial<double>(step.coefficients.size(), [c, i](std::size_t j) { return c[j][i]; });
  }
  return polynomial_at(component_.of(step, i), from);
}

}  // namespace continuo::model
