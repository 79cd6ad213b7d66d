// continuo/studies/linear_model.cpp
#include <numeric>

#include <continuo/model/derivative.hpp>
#include <continuo/model/evaluation.hpp>
#include <continuo/studies/linear_model.hpp>

namespace continuo::studies {

namespace {

/// d nodes / d variables at a point, row by row.
std::vector<double> derivatives(const model::ModelProgram& program, const std::vector<model::NodeId>& nodes,
                                const std::vector<std::uint32_t>& variables, const std::vector<double>& values,
                                std::span<const double> x, double t) {
  // The derivatives are new nodes, so they need a graph of their own.
  model::ModelProgram own(program.model);
  own.tables = program.tables;
  own.linear_inputs = program.linear_inputs;
  const auto entries = model::jacobian(own.model.graph, nodes, variables);
  std::vector<model::NodeId> of_entries;
  for (const auto& entry : entries) of_entries.push_back(entry.value);
  model::Evaluation evaluation(own.tape_of(of_entries), own.model.layout, values);
  const std::vector<double> numbers = evaluation(t, x);
  std::vector<double> rows(nodes.size() * variables.size());
  for (std::size_t e = 0; e < entries.size(); ++e)
    rows[entries[e].row * variables.size() + entries[e].column] = numbers[e];
  return rows;
}

}  // namespace

LinearModel linearize_model(const std::shared_ptr<const model::ModelProgram>& program, std::vector<double> x, double t,
                            const model::Overrides& parameters, std::size_t mode) {
  const model::Model& model = program->model;
  LinearModel linear;
  std::vector<std::uint32_t> states(model.states.size()), inputs;
  std::iota(states.begin(), states.end(), model.layout.states);
  for (const model::State& state : model.states) linear.states.push_back(state.column);
  for (const model::Input& input : model.inputs) {
    inputs.push_back(input.variable);
    linear.inputs.push_back(input.name);
  }
  std::vector<model::NodeId> outputs;
  for (const model::Quantity& output : model.outputs) {
    outputs.push_back(output.node);
    linear.outputs.push_back(output.name);
  }
  const std::vector<double> values = model::start_values(model, parameters);
  const auto& rates = model.modes[mode].derivatives;
  linear.a = derivatives(*program, rates, states, values, x, t);
  linear.b = derivatives(*program, rates, inputs, values, x, t);
  linear.c = derivatives(*program, outputs, states, values, x, t);
  linear.d = derivatives(*program, outputs, inputs, values, x, t);
  return linear;
}

}  // namespace continuo::studies
