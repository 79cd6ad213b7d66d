// continuo/model/model_derivatives.cpp
#include <algorithm>
#include <numeric>

#include <continuo/model/derivative.hpp>
#include <continuo/model/model_derivatives.hpp>

namespace continuo::model {

ModelDerivatives::ModelDerivatives(const ModelProgram& program, std::span<const double> variables) {
  // The derivatives are new nodes, so they need a graph of their own; inputs stay as they are: none is a state.
  ModelProgram own(program.model);
  own.tables = program.tables;
  own.linear_inputs = program.linear_inputs;
  const Model& model = own.model;
  std::vector<std::uint32_t> columns(model.states.size());
  std::iota(columns.begin(), columns.end(), model.layout.states);
  constexpr std::uint32_t time[] = {Layout::time};
  std::vector<MatrixPlace> all;
  for (const Mode& mode : model.modes) {
    OfMode& mine = modes_.emplace_back();
    std::vector<NodeId> nodes;
    for (const JacobianEntry& entry : model::jacobian(own.model.graph, mode.derivatives, columns)) {
      mine.places.push_back({entry.row, entry.column});
      nodes.push_back(entry.value);
    }
    mine.entries = Evaluation(own.tape_of(nodes), model.layout, variables);
    all.insert(all.end(), mine.places.begin(), mine.places.end());
    nodes.clear();
    for (const JacobianEntry& entry : model::jacobian(own.model.graph, mode.derivatives, time)) {
      mine.moving.push_back(entry.row);
      nodes.push_back(entry.value);
    }
    mine.by_time = Evaluation(own.tape_of(nodes), model.layout, variables);
  }
  pattern_ = SparsePattern(columns.size(), all);
  std::size_t most = columns.size();
  for (OfMode& mine : modes_) {
    for (const MatrixPlace& place : mine.places) mine.entry.push_back(pattern_.find(place.row, place.column));
    most = std::max(most, mine.places.size());
  }
  values_.resize(most);
}

void ModelDerivatives::jacobian_values(std::size_t mode, double t, std::span<const double> x,
                                       std::span<double> values) {
  OfMode& mine = modes_[mode];
  std::ranges::fill(values, 0.0);
  mine.entries(t, x, std::span(values_).first(mine.places.size()));
  for (std::size_t k = 0; k < mine.entry.size(); ++k) values[mine.entry[k]] = values_[k];
}

void ModelDerivatives::jacobian(std::size_t mode, double t, std::span<const double> x, std::span<double> rows) {
  OfMode& mine = modes_[mode];
  std::ranges::fill(rows, 0.0);
  mine.entries(t, x, std::span(values_).first(mine.places.size()));
  for (std::size_t k = 0; k < mine.places.size(); ++k)
    rows[mine.places[k].row * x.size() + mine.places[k].column] = values_[k];
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
