// continuo/studies/equilibria/linear_model.cpp
// Differentiates a model at a point by its inputs, states and outputs.
#include <numeric>
#include <span>

#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/studies/linear_model.hpp>
#include <continuo/symbolic/graph/derivative.hpp>

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
  model::Evaluation evaluation(own.tape_of(of_entries), values);
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
  for (const model::State& state : model.states)
    if (!state.algebraic) linear.states.push_back(state.column);
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
  const std::size_t n = linear.states.size(), m = states.size() - n;
  const LinearColumns columns{.states = n, .unknowns = m, .inputs = inputs.size()};
  std::vector<std::uint32_t> variables(states);
  variables.insert(variables.end(), inputs.begin(), inputs.end());
  const auto rows = derivatives(*program, rates, variables, values, x, t);
  const auto equations = std::span(rows).subspan(n * columns.all());
  std::vector<double> square;
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t j = 0; j < m; ++j) square.push_back(equations[i * columns.all() + n + j]);
  linear.undetermined = undetermined_by(square, m);
  if (!linear.undetermined.equations.empty()) return linear;
  const auto split = [&](std::span<const double> of, std::vector<double>& by_states, std::vector<double>& by_inputs) {
    const auto kept = without_unknowns(of, equations, columns);
    const std::size_t width = n + inputs.size();
    for (std::size_t k = 0; k < kept.size(); ++k) (k % width < n ? by_states : by_inputs).push_back(kept[k]);
  };
  split(std::span(rows).first(n * columns.all()), linear.a, linear.b);
  split(derivatives(*program, outputs, variables, values, x, t), linear.c, linear.d);
  return linear;
}

}  // namespace continuo::studies
