// continuo/simulation/program/model_program.hpp
// A checked model made ready to run: its equations, guards and actions as tapes. Made once, shared by every run.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/simulation/program/switches.hpp>
#include <continuo/symbolic/graph/table.hpp>
#include <continuo/symbolic/native/c_step.hpp>
#include <continuo/symbolic/native/native_function.hpp>
#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

/// One action of a block; `expression` counts the outputs of the block's tape.
struct ProgramAction {
  enum class Kind { assign, branch, go, mark, stop };
  Kind kind;
  std::size_t expression = 0;  // of assign: the value; of branch: the condition
  std::size_t target = 0;      // of assign: the state; of go: the mode; of stop: its number among all
  std::size_t after = 1;       // of stop
  std::string text;            // of mark and stop
  std::vector<ProgramAction> then, otherwise;
};

struct ProgramBlock {
  std::shared_ptr<const Tape> tape;
  std::vector<ProgramAction> actions;
};

/// The guards that are watched in one mode.
struct ProgramGuards {
  std::shared_ptr<const Tape> tape;
  std::vector<std::size_t> events;      // which of Model::events each output is
  std::shared_ptr<const Tape> truths;   // of those that are conditions: whether they hold
  std::vector<std::size_t> conditions;  // which of `events` each output of `truths` is
};

/// An input that follows a table over time.
struct TableInput {
  std::uint32_t variable;
  std::string name;
  Table table;
};

/// What every run of a program needs, each part made once. Threads may share it. A copy is empty, because the
/// expressions of a program that was copied may change.
template <class Key, class Part>
class SharedParts {
 public:
  SharedParts() = default;
  SharedParts(const SharedParts&) {}
  SharedParts& operator=(const SharedParts&) {
    parts_.clear();
    return *this;
  }
  /// The part of this key, made by `make` where there is none yet.
  template <class Make>
  [[nodiscard]] std::shared_ptr<Part> of(const Key& key, const Make& make) {
    const std::scoped_lock lock(mutex_);
    std::shared_ptr<Part>& part = parts_[key];
    if (!part) part = make();
    return part;
  }

 private:
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<Part>> parts_;
};

/// Gives the numbers of a method; there is one for each.
using StepFormula = CStepFormula (*)();

struct SeriesEquations;  // what all SolutionSeries of the same equations share

struct ModelProgram {
  explicit ModelProgram(Model model_);

  Model model;
  std::vector<Table> tables;              // those of the model, then one per input that is interpolated linearly
  std::vector<TableInput> step_inputs;    // constant between scheduled times
  std::vector<TableInput> linear_inputs;  // part of the expressions
  std::vector<std::shared_ptr<const Tape>> derivatives;  // by mode
  bool autonomous = false;                               // no derivative depends on the time
  std::vector<SwitchedEquations> switches;               // by mode
  std::uint32_t switch_variables = 0;                    // behind those of the model
  std::vector<ProgramGuards> guards;                     // by mode
  std::vector<NodeId> enclosed;                          // by Model::events: the guard for a search by enclosures
  std::vector<ProgramBlock> event_blocks;                // by Model::events
  std::vector<ProgramBlock> limit_blocks;                // by Model::events; without actions where there is no `then`
  std::vector<ProgramBlock> schedule_blocks;             // by Model::schedule
  std::vector<NodeId> always;  // what `check always` watches: each side minus the other, in the order of the checks
  NodeId energy_scale;         // the sum of the energies' absolute values; not valid without any
  std::size_t stops = 0;       // number of `stop` actions
  std::vector<char> counters;  // by state: it stands still between events and no equation reads it, like a counter
  std::vector<std::uint32_t> families;  // as TapeVariables says: u[1], u[2], ... are one, their derivatives another

  [[nodiscard]] TapeVariables tape_variables() const {
    return {.variables = model.layout.size + switch_variables,
            .steady_begin = model.layout.parameters,
            .steady_end = model.layout.inputs,
            .states_begin = model.layout.states,
            .states_end = model.layout.states + static_cast<std::uint32_t>(model.states.size()),
            .families = families};
  }
  /// Whether the expression contains the unknown of an algebraic equation.
  [[nodiscard]] bool reads_unknowns(NodeId node) const;
  /// The expression with interpolated inputs in place, as functions of time.
  [[nodiscard]] NodeId with_inputs(Graph& graph, NodeId node) const;
  /// A tape of these expressions, interpolated inputs in place.
  [[nodiscard]] std::shared_ptr<const Tape> tape_of(std::span<const NodeId> nodes) const;
  /// The same of what every run needs: made once.
  [[nodiscard]] std::shared_ptr<const Tape> shared_tape_of(std::span<const NodeId> nodes) const;
  /// The same of what every step evaluates: worth machine code, where the model has a compiler.
  [[nodiscard]] std::shared_ptr<const Tape> busy_tape_of(std::span<const NodeId> nodes) const;

  /// Steps of the method in machine code, with the equations of this mode; null where the model has no compiler.
  [[nodiscard]] std::shared_ptr<NativeFunction> step_code(std::size_t mode, StepFormula formula) const;

  mutable SharedParts<std::vector<NodeId>, const Tape> shared_tapes{};
  mutable SharedParts<std::pair<std::size_t, StepFormula>, NativeFunction> step_codes{};
  mutable SharedParts<std::vector<NodeId>, const SeriesEquations> series_equations{};  // by the nodes of derivatives
};

/// Inputs with points follow them, whoever gave the points: the file of the model or a caller.
[[nodiscard]] std::shared_ptr<const ModelProgram> compile(Model model);

}  // namespace continuo::model
