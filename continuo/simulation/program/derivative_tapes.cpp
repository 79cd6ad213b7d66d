// Differentiates the equations of a model and compiles what comes of it.
#include <numeric>

#include <continuo/simulation/program/derivative_tapes.hpp>
#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::model {

namespace {
/// Of a sliding motion each component may depend on each other one.
constexpr std::size_t largest_full = 100;
}  // namespace

DerivativeTapes derivative_tapes(const ModelProgram& program, bool held) {
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
  DerivativeTapes tapes{.pattern = SparsePattern(columns.size(), all), .modes = {}};
  for (std::size_t mode = 0; mode < model.modes.size(); ++mode) {
    DerivativeTapes::OfMode& mine = tapes.modes.emplace_back();
    std::vector<NodeId> nodes(tapes.pattern.entries(), own.model.graph.constant(0));
    for (const JacobianEntry& entry : entries[mode]) nodes[tapes.pattern.find(entry.row, entry.column)] = entry.value;
    mine.entries = own.tape_of(nodes);
    nodes.clear();
    for (const JacobianEntry& entry : model::jacobian(own.model.graph, model.modes[mode].derivatives, time)) {
      mine.moving.push_back(entry.row);
      nodes.push_back(entry.value);
    }
    mine.by_time = own.tape_of(nodes);
  }
  return tapes;
}

}  // namespace continuo::model
