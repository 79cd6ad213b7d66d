// continuo/simulation/program/model_derivatives.cpp
// Compiles and evaluates df/dx and df/dt of a model, dense, banded or by pattern.
#include <algorithm>
#include <numeric>

#include <continuo/simulation/program/model_derivatives.hpp>
#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::model {

namespace {
/// Of a sliding motion each component may depend on each other one.
constexpr std::size_t largest_full = 100;
}  // namespace

ModelDerivatives::ModelDerivatives(const ModelProgram& program, std::span<const double> variables, bool held) {
  // The derivatives are new nodes, so they need a graph of their own; inputs stay as they are: none is a state.
  ModelProgram own(program.model);
  own.tables = program.tables;
  own.linear_inputs = program.linear_inputs;
  own.switch_variables = program.switch_variables;
  bool slides = false;
  for (std::size_t mode = 0; held && mode < own.model.modes.size(); ++mode) {
    if (program.switches[mode].empty()) continue;
    own.model.modes[mode].derivatives = program.switches[mode].derivatives;
    slides = slides || program.switches[mode].slides;
  }
  const Model& model = own.model;
  std::vector<std::uint32_t> columns(model.states.size());
  std::iota(columns.begin(), columns.end(), model.layout.states);
  constexpr std::uint32_t time[] = {Layout::time};
  std::vector<std::vector<JacobianEntry>> entries;
  std::vector<MatrixPlace> all;
  for (const Mode& mode : model.modes) {
    for (const JacobianEntry& entry : entries.emplace_back(model::jacobian(own.model.graph, mode.derivatives, columns)))
      all.push_back({entry.row, entry.column});
  }
  for (std::uint32_t row = 0; slides && columns.size() <= largest_full && row < columns.size(); ++row)
    for (std::uint32_t column = 0; column < columns.size(); ++column) all.push_back({row, column});
  pattern_ = SparsePattern(columns.size(), all);
  if (pattern_.is_banded()) places_in_band_ = pattern_.places_in_band();
  for (std::size_t mode = 0; mode < model.modes.size(); ++mode) {
    OfMode& mine = modes_.emplace_back();
    std::vector<NodeId> nodes(pattern_.entries(), own.model.graph.constant(0));
    for (const JacobianEntry& entry : entries[mode]) nodes[pattern_.find(entry.row, entry.column)] = entry.value;
    mine.entries = Evaluation(own.busy_tape_of(nodes), variables);
    if (pattern_.is_banded()) mine.in_band = mine.entries.outputs_at(places_in_band_);
    nodes.clear();
    for (const JacobianEntry& entry : model::jacobian(own.model.graph, model.modes[mode].derivatives, time)) {
      mine.moving.push_back(entry.row);
      nodes.push_back(entry.value);
    }
    mine.by_time = Evaluation(own.tape_of(nodes), variables);
  }
  values_.resize(std::max(columns.size(), pattern_.entries()));
}

void ModelDerivatives::jacobian_values(std::size_t mode, double t, std::span<const double> x,
                                       std::span<double> values) {
  modes_[mode].entries(t, x, values);
}

void ModelDerivatives::jacobian_band(std::size_t mode, double t, std::span<const double> x, std::span<double> band) {
  OfMode& mine = modes_[mode];
  if (!mine.entries.is_native()) return mine.entries(t, x, band, mine.in_band);
  mine.entries(t, x, values_);
  for (std::size_t k = 0; k < places_in_band_.size(); ++k) band[places_in_band_[k]] = values_[k];
}

void ModelDerivatives::jacobian(std::size_t mode, double t, std::span<const double> x, std::span<double> rows) {
  std::ranges::fill(rows, 0.0);
  modes_[mode].entries(t, x, values_);
  for (std::size_t column = 0; column < pattern_.size(); ++column) {
    for (std::size_t k = pattern_.begin(column); k < pattern_.end(column); ++k)
      rows[pattern_.row(k) * x.size() + column] = values_[k];
  }
}

void ModelDerivatives::time_derivative(std::size_t mode, double t, std::span<const double> x, std::span<double> dfdt) {
  OfMode& mine = modes_[mode];
  std::ranges::fill(dfdt, 0.0);
  mine.by_time(t, x, std::span(values_).first(mine.moving.size()));
  for (std::size_t k = 0; k < mine.moving.size(); ++k) dfdt[mine.moving[k]] = values_[k];
}

void ModelDerivatives::set(std::uint32_t variable, double value) {
  for (OfMode& mine : modes_) {
    mine.entries.set(variable, value);
    mine.by_time.set(variable, value);
  }
}

}  // namespace continuo::model
