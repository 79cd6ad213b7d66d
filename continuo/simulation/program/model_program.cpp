// continuo/simulation/program/model_program.cpp
// Compiles a checked model: equations, blocks of actions, watched quantities, tables.
#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>

#include <continuo/simulation/program/fused_equations.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model {

namespace {

/// Collects the expressions of a block and lays out its actions.
class BlockCompiler {
 public:
  explicit BlockCompiler(std::size_t& stops) : stops_(stops) {}

  std::vector<ProgramAction> actions(const Block& block) {
    std::vector<ProgramAction> compiled;
    for (const Action& action : block) {
      compiled.push_back(std::visit([this](const auto& what) { return compile(what); }, action.what));
    }
    return compiled;
  }
  const std::vector<NodeId>& expressions() const { return expressions_; }

 private:
  using Kind = ProgramAction::Kind;

  std::size_t expression(NodeId node) {
    expressions_.push_back(node);
    return expressions_.size() - 1;
  }
  static ProgramAction make(Kind kind) {
    ProgramAction action{};
    action.kind = kind;
    return action;
  }

  ProgramAction compile(const Assign& assign) {
    ProgramAction action = make(Kind::assign);
    action.expression = expression(assign.value);
    action.target = assign.state;
    return action;
  }
  ProgramAction compile(const If& branch) {
    ProgramAction action = make(Kind::branch);
    action.expression = expression(branch.condition);
    action.then = actions(branch.then);
    action.otherwise = actions(branch.otherwise);
    return action;
  }
  ProgramAction compile(const Go& go) {
    ProgramAction action = make(Kind::go);
    action.target = go.mode;
    return action;
  }
  ProgramAction compile(const Mark& mark) {
    ProgramAction action = make(Kind::mark);
    action.text = mark.text;
    return action;
  }
  ProgramAction compile(const Stop& stop) {
    ProgramAction action = make(Kind::stop);
    action.text = stop.text;
    action.after = stop.after;
    action.target = stops_++;
    return action;
  }

  std::size_t& stops_;
  std::vector<NodeId> expressions_;
};

ProgramBlock block_of(ModelProgram& program, const Block& block) {
  BlockCompiler compiler(program.stops);
  ProgramBlock compiled;
  compiled.actions = compiler.actions(block);
  compiled.tape = program.tape_of(compiler.expressions());
  return compiled;
}

/// Whether a guard made of conditions can be zero for longer than an instant: one of its comparisons jumps, or is of
/// what stands still.
bool rests_at_zero(const Model& model, NodeId guard) {
  const Node& node = model.graph[guard];
  if (node.op == Op::minimum || node.op == Op::maximum)
    return rests_at_zero(model, node.a) || rests_at_zero(model, node.b);
  if (node.op == Op::negate) return rests_at_zero(model, node.a);
  if (node.corners) return true;
  return std::ranges::none_of(variables_of(model.graph, guard), [&](std::uint32_t v) {
    const bool state = v >= model.layout.states && v - model.layout.states < model.states.size();
    return v == Layout::time || (state && !stands_still(model, v - model.layout.states));
  });
}

/// The guard of an event as it is enclosed: where that of a condition is zero, the condition itself decides the side.
NodeId enclosed_guard(Model& model, const When& event) {
  if (!event.truth.valid() || !rests_at_zero(model, event.guard)) return event.guard;
  Graph& g = model.graph;
  constexpr double least = 1e-150;  // more than nothing to the isolation of roots
  return g.add(event.guard, g.select(event.truth, g.constant(least), g.constant(-least)));
}

void compile_equations(ModelProgram& program) {
  Model& model = program.model;
  for (const When& event : model.events) program.enclosed.push_back(enclosed_guard(model, event));
  for (std::size_t mode = 0; mode < model.modes.size(); ++mode) {
    program.derivatives.push_back(program.tape_of(model.modes[mode].derivatives));
    if (model.native) model.native->watch(program.derivatives.back(), fusing_of(program));
    ProgramGuards guards;
    std::vector<NodeId> nodes, truths;
    for (std::size_t i = 0; i < model.events.size(); ++i) {
      if (model.events[i].mode.value_or(mode) != mode) continue;
      if (model.events[i].truth.valid()) {
        guards.conditions.push_back(guards.events.size());
        truths.push_back(model.events[i].truth);
      }
      guards.events.push_back(i);
      nodes.push_back(model.events[i].guard);
    }
    guards.tape = program.busy_tape_of(nodes);
    guards.truths = program.tape_of(truths);
    program.guards.push_back(std::move(guards));
  }
}

void compile_blocks(ModelProgram& program) {
  for (std::size_t i = 0; i < program.model.events.size(); ++i) {
    program.event_blocks.push_back(block_of(program, program.model.events[i].actions));
  }
  for (std::size_t i = 0; i < program.model.schedule.size(); ++i) {
    program.schedule_blocks.push_back(block_of(program, program.model.schedule[i].actions));
  }
  for (std::size_t i = 0; i < program.model.events.size(); ++i) {
    program.limit_blocks.push_back(block_of(program, program.model.events[i].limit_actions));
  }
}

void place_watched(ModelProgram& program) {
  Graph& graph = program.model.graph;
  for (const NodeId energy : program.model.energy_terms) {
    const NodeId size = graph.apply(Op::absolute, energy);
    program.energy_scale = program.energy_scale.valid() ? graph.add(program.energy_scale, size) : size;
  }
  for (const Check& check : program.model.checks) {
    if (check.measure != Measure::always) continue;
    program.always.push_back(graph.subtract(check.node, check.value));
  }
}

void place_tables(ModelProgram& program) {
  for (const TableFile& file : program.model.tables) program.tables.push_back(*file.points);
  for (const Input& input : program.model.inputs) {
    if (!input.points) continue;
    const bool step = input.points->between() == Table::Between::step;
    (step ? program.step_inputs : program.linear_inputs).push_back({input.variable, input.name, *input.points});
  }
  for (const TableInput& input : program.linear_inputs) program.tables.push_back(input.table);
}

}  // namespace

ModelProgram::ModelProgram(Model model_) : model(std::move(model_)), families(model.layout.size) {
  std::map<std::tuple<std::string_view, std::string_view, int>, std::uint32_t> numbers;
  for (const State& state : model.states) {
    const std::string_view base = state.base;
    const std::size_t bracket = base.find('['), end = base.find(']');
    if (bracket == std::string_view::npos || end == std::string_view::npos) continue;
    const std::tuple name(base.substr(0, bracket), base.substr(end), state.primes);  // grain[3].x: of all .x
    families[state.variable] = numbers.try_emplace(name, static_cast<std::uint32_t>(numbers.size() + 1)).first->second;
  }
}

bool ModelProgram::reads_unknowns(NodeId node) const {
  return std::ranges::any_of(variables_of(model.graph, node), [&](std::uint32_t v) {
    return v >= model.layout.states && v - model.layout.states < model.states.size() &&
           model.states[v - model.layout.states].algebraic;
  });
}

NodeId ModelProgram::with_inputs(Graph& graph, NodeId node) const {
  if (linear_inputs.empty()) return node;
  return substitute(graph, node, [&](std::uint32_t variable) -> std::optional<NodeId> {
    for (std::size_t i = 0; i < linear_inputs.size(); ++i) {
      if (linear_inputs[i].variable != variable) continue;
      const auto table = static_cast<std::uint32_t>(model.tables.size() + i);
      return graph.interpolate(table, graph.variable(Layout::time));
    }
    return std::nullopt;
  });
}

std::shared_ptr<const Tape> ModelProgram::tape_of(std::span<const NodeId> nodes) const {
  if (linear_inputs.empty()) return std::make_shared<const Tape>(model.graph, nodes, tape_variables(), tables);
  Graph graph = model.graph;
  std::vector<NodeId> replaced;
  for (const NodeId node : nodes) replaced.push_back(with_inputs(graph, node));
  return std::make_shared<const Tape>(graph, replaced, tape_variables(), tables);
}

std::shared_ptr<const Tape> ModelProgram::shared_tape_of(std::span<const NodeId> nodes) const {
  return shared_tapes.of({nodes.begin(), nodes.end()}, [&] { return tape_of(nodes); });
}

std::shared_ptr<const Tape> ModelProgram::busy_tape_of(std::span<const NodeId> nodes) const {
  std::shared_ptr<const Tape> tape = tape_of(nodes);
  if (model.native) model.native->watch(tape);
  return tape;
}

std::shared_ptr<NativeFunction> ModelProgram::step_code(std::size_t mode, StepFormula formula) const {
  if (!model.native) return nullptr;
  return step_codes.of({mode, formula},
                       [&] { return model.native->step_code(derivatives[mode], formula(), fusing_of(*this)); });
}

namespace {

/// No right-hand side of any mode reads the time.
bool is_autonomous(const ModelProgram& program) {
  if (!program.linear_inputs.empty()) return false;
  const Graph& graph = program.model.graph;
  return std::ranges::all_of(program.model.modes, [&](const Mode& mode) {
    return std::ranges::none_of(reachable(graph, mode.derivatives), [&](NodeId id) {
      return graph[id].op == Op::variable && graph[id].number == Layout::time;
    });
  });
}

/// Which states are only of interest to events and outputs.
std::vector<char> find_counters(const Model& model) {
  std::vector<char> counters(model.states.size(), 0);
  for (std::size_t i = 0; i < counters.size(); ++i) counters[i] = stands_still(model, i) ? 1 : 0;
  for (const Mode& mode : model.modes) {
    for (const std::uint32_t v : variables_of(model.graph, mode.derivatives))
      if (v >= model.layout.states && v < model.layout.parameters) counters[v - model.layout.states] = 0;
  }
  return counters;
}

}  // namespace

std::shared_ptr<const ModelProgram> compile(Model model) {
  auto program = std::make_shared<ModelProgram>(std::move(model));
  place_tables(*program);
  place_watched(*program);
  compile_equations(*program);
  compile_blocks(*program);
  program->autonomous = is_autonomous(*program);
  if (program->model.has_world()) {  // worlds/ locates events by samples, without counters and switches
    program->counters.assign(program->model.states.size(), 0);
    program->switches.resize(program->model.modes.size());
    return program;
  }
  program->counters = find_counters(program->model);
  for (std::size_t mode = 0; mode < program->model.modes.size(); ++mode)
    program->switches.push_back(switched_equations(*program, mode));
  return program;
}

}  // namespace continuo::model
