// Differentiates a model by its parameters and initial values, and compiles the result.
#include <algorithm>
#include <numeric>
#include <variant>

#include <continuo/runs/kind.hpp>
#include <continuo/studies/sensitivity/sensitive_program.hpp>

namespace continuo::studies::detail {

using model::Graph;
using model::NodeId;

namespace {
constexpr std::size_t largest_full = 100;  // components of a matrix that is full where the motion slides
}

SensitiveProgram::SensitiveProgram(std::shared_ptr<const model::ModelProgram> program,
                                   std::vector<Influence> influences, const model::Overrides& overrides,
                                   bool start_is_given)
    : program_(std::move(program)),
      influences_(std::move(influences)),
      n_(program_->model.states.size()),
      own_(program_->model) {
  const model::Model& model = program_->model;
  own_.tables = program_->tables;
  own_.linear_inputs = program_->linear_inputs;
  own_.model.layout.size = registers_of_s() + static_cast<std::uint32_t>(n_ * count());
  for (const model::State& state : model.states) names_.push_back(state.column);
  for (const Influence& influence : influences_)
    for (const model::State& state : model.states)
      names_.push_back("d " + state.column + " / d " + name_of(model, influence));
  differentiate_parameters(overrides);
  Graph& graph = own_.model.graph;
  for (std::size_t k = 0; k < count(); ++k) {
    const bool moves = model.run.from && !start_is_given;
    start_time_.push_back(moves ? by_parameters(graph, model.run.from->node, k) : graph.constant(0));
  }
  if (!runs::kind_of(model).has_exact_derivatives) return;
  add_equations();
  add_start();
  add_events();
}

/// Other parameters may follow from those that move; one that is set, or moves itself, follows from none.
void SensitiveProgram::differentiate_parameters(const model::Overrides& overrides) {
  const model::Model& model = program_->model;
  Graph& graph = own_.model.graph;
  const auto moves = [&](std::size_t i) {
    return std::ranges::any_of(influences_, [&](const Influence& influence) {
      return influence.kind == Influence::Kind::parameter && influence.index == i;
    });
  };
  parameters_.resize(count());
  for (std::size_t k = 0; k < count(); ++k) {
    if (influences_[k].kind != Influence::Kind::parameter) continue;
    const std::size_t own = influences_[k].index;
    parameters_[k].emplace_back(model.parameters[own].variable, graph.constant(1));
    for (const std::size_t i : model.parameter_order) {
      const model::Parameter& parameter = model.parameters[i];
      if (moves(i) || overrides.contains(parameter.name)) continue;
      const NodeId derivative = by_parameters(graph, parameter.expression, k);
      if (!graph.is(derivative, 0)) parameters_[k].emplace_back(parameter.variable, derivative);
    }
  }
}

/// dv/dp: with t and the states held.
NodeId SensitiveProgram::by_parameters(Graph& graph, NodeId node, std::size_t k) const {
  NodeId sum = graph.constant(0);
  for (const auto& [variable, derivative] : parameters_[k]) {
    if (!model::depends_on(graph, node, variable)) continue;
    sum = graph.add(sum, graph.multiply(model::differentiate(graph, node, variable), derivative));
  }
  return sum;
}

/// dv/dx S + dv/dp: with t held.
NodeId SensitiveProgram::variation(Graph& graph, NodeId node, std::size_t k) const {
  NodeId sum = by_parameters(graph, node, k);
  const std::uint32_t states = program_->model.layout.states;
  for (const std::uint32_t variable : model::variables_of(graph, node)) {
    if (variable < states || variable >= states + n_) continue;
    const auto place = static_cast<std::uint32_t>(k * n_ + (variable - states));
    sum = graph.add(
        sum, graph.multiply(model::differentiate(graph, node, variable), graph.variable(registers_of_s() + place)));
  }
  return sum;
}

void SensitiveProgram::add_equations() {
  Graph& graph = own_.model.graph;
  const model::Model& model = program_->model;
  const model::SwitchedEquations none{};
  for (std::size_t mode = 0; mode < model.modes.size(); ++mode) {
    // Collocation takes the equations as they stand.
    const model::SwitchedEquations& held = runs::kind_of(model).has_start ? program_->switches[mode] : none;
    std::vector<NodeId>& nodes = rate_nodes_.emplace_back();
    for (const NodeId node : held.empty() ? model.modes[mode].derivatives : held.derivatives)
      nodes.push_back(program_->with_inputs(graph, node));
    for (std::size_t k = 0; k < count(); ++k)
      for (std::size_t i = 0; i < n_; ++i) nodes.push_back(variation(graph, nodes[i], k));
    rates_.push_back(own_.busy_tape_of(nodes));
    surfaces_.push_back(surfaces_of(held));
  }
}

SensitiveSurfaces SensitiveProgram::surfaces_of(const model::SwitchedEquations& equations) {
  SensitiveSurfaces result;
  Graph& graph = own_.model.graph;
  const std::uint32_t states = program_->model.layout.states;
  std::vector<NodeId> outputs, approach;
  for (const model::Switch& one : equations.switches) {
    result.surface.push_back(variation_of(one.surface, outputs));
    NodeId rate = model::differentiate(graph, one.surface, model::Layout::time);
    for (const std::uint32_t variable : model::variables_of(graph, one.surface)) {
      if (variable < states || variable >= states + n_) continue;
      rate = graph.add(rate, graph.multiply(model::differentiate(graph, one.surface, variable),
                                            equations.derivatives[variable - states]));
    }
    approach.push_back(rate);
    for (std::size_t k = 0; k < count(); ++k) approach.push_back(variation(graph, rate, k));
  }
  result.tape = own_.tape_of(outputs);
  result.approach = own_.tape_of(approach);
  return result;
}

void SensitiveProgram::add_start() {
  Graph& graph = own_.model.graph;
  const model::Model& model = program_->model;
  if (!runs::kind_of(model).has_start) return;  // there are no initial values
  for (std::size_t k = 0; k < count(); ++k) {
    for (std::size_t i = 0; i < n_; ++i) {
      const Influence& influence = influences_[k];
      const bool own = influence.kind == Influence::Kind::initial && influence.index == i;
      // An initial value that is an influence stands for itself, whatever the text says.
      const bool given = std::ranges::any_of(influences_, [&](const Influence& other) {
        return other.kind == Influence::Kind::initial && other.index == i;
      });
      const NodeId node = program_->with_inputs(graph, model.states[i].initial);
      NodeId start = own || given ? graph.constant(own ? 1 : 0) : by_parameters(graph, node, k);
      if (!given) {
        const NodeId by_time = model::differentiate(graph, node, model::Layout::time);
        start = graph.add(start, graph.multiply(by_time, start_time_[k]));
      }
      start_.push_back(start);
    }
  }
}

Variation SensitiveProgram::variation_of(NodeId node, std::vector<NodeId>& outputs) {
  Graph& graph = own_.model.graph;
  node = program_->with_inputs(graph, node);
  Variation result{.value = outputs.size(), .along = outputs.size() + 1, .by_time = 0, .by_state = 0, .states = {}};
  outputs.push_back(node);
  for (std::size_t k = 0; k < count(); ++k) outputs.push_back(variation(graph, node, k));
  result.by_time = outputs.size();
  outputs.push_back(model::differentiate(graph, node, model::Layout::time));
  result.by_state = outputs.size();
  const std::uint32_t states = program_->model.layout.states;
  for (const std::uint32_t variable : model::variables_of(graph, node)) {
    if (variable < states || variable >= states + n_) continue;
    result.states.push_back(variable - states);
    outputs.push_back(model::differentiate(graph, node, variable));
  }
  return result;
}

std::vector<SensitiveAction> SensitiveProgram::actions_of(const model::Block& block, std::vector<NodeId>& outputs) {
  std::vector<SensitiveAction> actions;
  for (const model::Action& action : block) {
    if (const auto* assign = std::get_if<model::Assign>(&action.what)) {
      actions.push_back({.kind = SensitiveAction::Kind::assign,
                         .value = variation_of(assign->value, outputs),
                         .target = assign->state});
    } else if (const auto* branch = std::get_if<model::If>(&action.what)) {
      SensitiveAction made{.kind = SensitiveAction::Kind::branch, .condition = outputs.size()};
      outputs.push_back(program_->with_inputs(own_.model.graph, branch->condition));
      made.then = actions_of(branch->then, outputs);
      made.otherwise = actions_of(branch->otherwise, outputs);
      actions.push_back(std::move(made));
    }
  }
  return actions;
}

void SensitiveProgram::add_events() {
  const model::Model& model = program_->model;
  Graph& graph = own_.model.graph;
  for (const model::EventOrder& place : model.event_order) {
    SensitiveEvent event;
    std::vector<NodeId> outputs;
    if (place.scheduled) {
      const model::Scheduled& scheduled = model.schedule[place.index];
      using Kind = model::Scheduled::Kind;
      for (std::size_t k = 0; k < count(); ++k) {
        const NodeId time = scheduled.time ? by_parameters(graph, scheduled.time->node, k) : graph.constant(0);
        const bool repeats = scheduled.kind == Kind::every;
        event.period.push_back(repeats ? time : graph.constant(0));
        event.first.push_back(scheduled.first                     ? by_parameters(graph, scheduled.first->node, k)
                              : repeats                           ? graph.add(start_time_[k], time)
                              : scheduled.kind == Kind::initially ? start_time_[k]
                                                                  : time);
      }
      event.actions = actions_of(scheduled.actions, outputs);
    } else {
      const model::When& when = model.events[place.index];
      event.guard = variation_of(when.guard, outputs);
      event.actions = actions_of(when.actions, outputs);
    }
    event.tape = own_.tape_of(outputs);
    events_.push_back(std::move(event));
  }
}

const SensitiveProgram::Jacobians& SensitiveProgram::jacobians() const {
  if (jacobians_) return *jacobians_;
  auto made = std::make_unique<Jacobians>();
  model::ModelProgram graphs(own_.model);
  graphs.tables = own_.tables;
  std::vector<std::uint32_t> columns(n_ * (1 + count()));
  std::iota(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(n_), program_->model.layout.states);
  std::iota(columns.begin() + static_cast<std::ptrdiff_t>(n_), columns.end(), registers_of_s());
  constexpr std::uint32_t time[] = {model::Layout::time};
  std::vector<MatrixPlace> all;
  const auto entries = [&](const std::vector<NodeId>& nodes, std::span<const std::uint32_t> by) {
    Entries result;
    std::vector<NodeId> values;
    for (const model::JacobianEntry& entry : model::jacobian(graphs.model.graph, nodes, by)) {
      result.places.push_back({entry.row, entry.column});
      values.push_back(entry.value);
    }
    result.tape = graphs.tape_of(values);
    return result;
  };
  for (const std::vector<NodeId>& nodes : rate_nodes_) {
    made->by_state.push_back(entries(nodes, columns));
    made->by_time.push_back(entries(nodes, time));
    const auto& places = made->by_state.back().places;
    all.insert(all.end(), places.begin(), places.end());
  }
  // Where the motion slides everything may depend on everything.
  const bool slides = std::ranges::any_of(program_->switches, &model::SwitchedEquations::slides);
  for (std::uint32_t row = 0; slides && columns.size() <= largest_full && row < columns.size(); ++row)
    for (std::uint32_t column = 0; column < columns.size(); ++column) all.push_back({row, column});
  made->pattern = SparsePattern(columns.size(), all);
  jacobians_ = std::move(made);
  return *jacobians_;
}

std::vector<double> SensitiveProgram::evaluate(const std::vector<NodeId>& nodes,
                                               const std::vector<double>& variables) const {
  return model::evaluate(own_.model, nodes, variables);
}

// x(t0(p), p) = x0(p): S = dx0/dp - x' t0'.
std::vector<double> SensitiveProgram::start(const std::vector<double>& variables,
                                            const std::vector<double>& rates) const {
  std::vector<double> s = evaluate(start_, variables);
  const std::vector<double> moved = evaluate(start_time_, variables);
  for (std::size_t k = 0; k < count(); ++k)
    for (std::size_t i = 0; i < n_ && moved[k] != 0; ++i)
      if (!program_->model.states[i].algebraic) s[k * n_ + i] -= rates[i] * moved[k];
  return s;
}

std::shared_ptr<const model::Tape> SensitiveProgram::along(const std::vector<NodeId>& quantities) const {
  model::ModelProgram graphs(own_.model);
  graphs.tables = own_.tables;
  std::vector<NodeId> nodes;
  for (const NodeId quantity : quantities) {
    const NodeId node = program_->with_inputs(graphs.model.graph, quantity);
    nodes.push_back(node);
    for (std::size_t k = 0; k < count(); ++k) nodes.push_back(variation(graphs.model.graph, node, k));
  }
  return graphs.tape_of(nodes);
}

std::shared_ptr<const model::Tape> SensitiveProgram::along(NodeId quantity, std::span<const std::uint32_t> by) const {
  model::ModelProgram graphs(own_.model);
  graphs.tables = own_.tables;
  Graph& graph = graphs.model.graph;
  const NodeId node = program_->with_inputs(graph, quantity);
  std::vector<NodeId> nodes{node};
  for (std::size_t k = 0; k < count(); ++k) nodes.push_back(variation(graph, node, k));
  for (const std::uint32_t variable : by) nodes.push_back(model::differentiate(graph, node, variable));
  return graphs.tape_of(nodes);
}

std::vector<double> SensitiveProgram::moves_of(NodeId constant, const std::vector<double>& variables) const {
  model::ModelProgram graphs(own_.model);
  std::vector<NodeId> nodes;
  for (std::size_t k = 0; k < count(); ++k) nodes.push_back(by_parameters(graphs.model.graph, constant, k));
  return model::evaluate(graphs.model, nodes, variables);
}

}  // namespace continuo::studies::detail
