// continuo/language/model.hpp
// The checked model: plain data that the simulation, the results, the command line and the view read. Nothing here
// can be wrong any more: names are nodes of one expression graph, orders are reduced, families are written out and
// units agree (conversion factors stand in the graph).
//
//   Loaded loaded = load("models/bouncing_ball.sim");
//   if (!loaded) { for (const Diagnostic& d : loaded.diagnostics) ...; return 2; }
//   const Model& model = *loaded.model;
//   for (const State& s : model.states) fmt::print("{} [{}]\n", s.column, s.unit);
//
// Every number is stored as its author wrote it, in the unit that stands beside it; no unit is an empty text.
// Times are in `Model::time_unit`.
//
// Variables of the graph lie in one flat space (`Layout`): 0 is t, then the states, the parameters, the inputs, the
// unknowns of algebraic equations, and last the samples that only checks read. A tape's register file starts with them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <continuo/language/text/source.hpp>
#include <continuo/solve/event.hpp>
#include <continuo/symbolic/graph/expression.hpp>
#include <continuo/symbolic/graph/table.hpp>
#include <continuo/system/system.hpp>

namespace continuo::model {

class NativeCompiler;  // symbolic/native/native_compiler.hpp

/// A number that may depend on parameters, and its value with them as written. Times are in Model::time_unit.
struct Setting {
  NodeId node;
  double value;
};

/// Where the variables of each kind begin in the flat space. `size` is the number of all, samples included.
struct Layout {
  std::uint32_t states = 1, unknowns = 1, parameters = 1, inputs = 1, samples = 1, size = 1;
  static constexpr std::uint32_t time = 0;
};

/// The slider's range, both ends in the unit of the quantity.
struct Range {
  double low, high;
};

/// A parameter, or one member of a family.
struct Parameter {
  std::string name;        // "k", "m[3]"
  std::uint32_t variable;  // in the flat space
  NodeId expression;       // of other parameters; a constant where `independent`
  double value;            // of `expression` with every parameter as written
  std::string unit;
  std::optional<Range> range;
  std::string comment;  // what the author wrote beside it
  bool independent;     // no other parameter in `expression`: setting others leaves it as it is
  bool structural;      // decides the size of a family: only CheckOptions::overrides can change it
  Span span;
};

/// A control over time: live, by its key, or from a file.
struct Input {
  std::string name;
  std::uint32_t variable;
  double value;  // until somebody moves it
  std::string unit;
  std::optional<Range> range;
  std::string key;              // "w", empty for none
  std::string file;             // where the values come from; empty for none
  std::optional<Table> points;  // of the file: t, and the column named like the input, else the second
  std::string comment;
  Span span;
};

/// One component of the reduced first-order system, in the order of the text: h, h', then the next name.
struct State {
  std::string base;    // "h", "u[3]"
  int primes;          // 0 for h, 1 for h'
  std::string column;  // "h'"
  std::uint32_t variable;
  std::string unit;
  NodeId initial;          // of parameters, inputs at the start and t, the start; re-evaluated when one changes
  Span span;               // of its initial condition
  bool algebraic = false;  // the unknown of an equation `0 = ...`: `initial` is a guess, it stands after the others
  bool in_world = false;   // of a body, or a measure of the world: it has no equation
};

/// One right-hand side per state, in the states' order and in their units per unit of time; for an algebraic state what
/// is to be zero.
/// A model without modes has one mode named "".
struct Mode {
  std::string name;
  std::vector<NodeId> derivatives;
  Span span;
};

/// A named expression: a `let`, an `output` or an `energy`.
struct Quantity {
  std::string name;
  NodeId node;
  std::string unit;
  Span span;
};

// ---- events ---------------------------------------------------------------------------------------------------------

struct Action;
/// The actions of an event, or of one branch of an `if`.
using Block = std::vector<Action>;

/// Every expression of a block reads the state from before the event; assignments take effect together at its end.
struct Assign {
  std::size_t state;  // index into Model::states
  NodeId value;       // in the state's unit
};
/// One of two blocks.
struct If {
  NodeId condition;  // not zero: true
  Block then, otherwise;
};
/// Changes the mode.
struct Go {
  std::size_t mode;
};
/// Labels the event in the event list.
struct Mark {
  std::string text;
};
/// Ends the run when it is reached the `after`th time.
struct Stop {
  std::string text;  // may be empty
  std::size_t after = 1;
};
/// One action of an event.
struct Action {
  std::variant<Assign, If, Go, Mark, Stop> what;
  Span span;
};

/// `when lhs falls through rhs in MODE { ... }`: a root of guard = lhs - rhs. `when a < b { ... }`: the condition
/// becomes true where guard = b - a rises through zero; `and`, `or`, `not` are min, max and the sign of guards.
/// `then { ... }` after it: where its times close in on a limit, these are the actions there, and the run goes on.
struct When {
  std::string name;  // for tables: "h falls through 0"
  NodeId guard;
  NodeId truth{};  // of a condition: whether it holds, which decides where the guard is zero; not valid for a level
  Direction direction;
  std::optional<std::size_t> mode;  // nothing: in every mode
  Block actions;
  Block limit_actions;     // may be empty where
  bool has_limit = false;  // the text says `then`
  Span span;
};

/// `initially` (once, at the start), `at TIME` (once), `every DT from FIRST`; without FIRST it is one DT after the
/// start.
struct Scheduled {
  /// The kinds of scheduled events.
  enum class Kind { initially, at, every };
  Kind kind;
  std::string name;              // "at 3", "every 0.5"
  std::optional<Setting> time;   // TIME or DT; none for `initially`
  std::optional<Setting> first;  // FIRST
  Block actions;
  Span span;
};

/// All events in the order of the text: events at the same time fire in this order.
struct EventOrder {
  bool scheduled;  // index into Model::schedule, else into Model::events
  std::size_t index;
};

// ---- the experiment -------------------------------------------------------------------------------------------------

/// At which times rows are written.
struct OutputPlan {
  /// Regular times, times with equal ratios, or the ends of steps.
  enum class Kind { every, logarithmic, steps };
  Kind kind;
  std::optional<Setting> interval;  // every
  int per_decade = 0;               // logarithmic
  std::optional<Setting> first;     // logarithmic: T0
};

/// `run ...`; what the text does not say is not set, and the command line overrides each item.
struct RunSettings {
  std::optional<Setting> from, to, step;
  std::optional<OutputPlan> output;
  std::optional<std::string> method;  // one of the catalogue's names
  std::optional<double> rtol;
  std::vector<double> atol;  // empty, one, or one per state
  std::optional<Setting> max_step;
  std::optional<std::size_t> max_steps;
  bool realtime = false;
  Span span;
};

/// One curve or axis: the text as written and its value.
struct Series {
  std::string label;  // as written: "h", "energy" for the sum of all energies
  NodeId node;
  std::string unit;
};
/// A `plot` statement.
struct Plot {
  std::vector<Series> curves;
  Series against;  // t where the text does not say
  Span span;
};

/// The shapes of a drawing.
enum class Shape { floor, ball, spring, rod, rope, arrow, trail, box, text };

/// One argument of a drawing: a point has two or three numbers, the height of a floor one, a text none.
struct DrawArgument {
  std::vector<NodeId> numbers;
  std::string text;
};
/// `ball (0, h) radius 0.3 color "red"`; `drag` stands without a value.
struct DrawAttribute {
  std::string name;
  DrawArgument value;
};
/// One shape of a drawing, with its numbers and attributes.
struct DrawItem {
  Shape shape;
  std::vector<DrawArgument> arguments;
  std::vector<DrawAttribute> attributes;
  Span span;
};

/// Whether the mouse may move it: `ball (x, y) drag`.
[[nodiscard]] bool is_dragged(const DrawItem& item);

/// When a check reads the motion. Events count from 1 among those whose name begins with `event`.
struct Moment {
  /// The end of the run, a time, or an event.
  enum class Kind { end, time, event };
  Kind kind = Kind::end;
  std::optional<Setting> time;
  std::size_t number = 0;
  std::string event;   // empty: any
  bool after = false;  // the state after the event's actions
};

/// `h(1)` inside a larger expression: the value of `of` at `when` goes to `variable` before the expression is
/// evaluated.
struct Sample {
  std::uint32_t variable;
  NodeId of;
  Setting when;
};

/// What a check reads.
enum class Measure {
  value,         // of `node` at `moment`
  always,        // of `node` at every accepted step, output and event
  energy_drift,  // max |E(t) - E(t0)| over the run, relative to |E(t0)| where that is not 0
  event_time,    // of the event of `moment`
  event_count,   // of the events of `moment`
  end_time
};
/// How a check compares.
enum class Relation { equal, less, less_equal, greater, greater_equal };

/// `check MEASURE = value within tolerance`, `check MEASURE < value`.
struct Check {
  std::string text;
  Measure measure;
  NodeId node;  // of `value` and `always`
  Moment moment;
  std::vector<Sample> samples;  // what `node` and `value` need first
  Relation relation;
  NodeId value;
  NodeId tolerance;  // not valid where the comparison is exact
  std::string unit;  // of both sides
  Span span;
};

// ---- what is checked but solved elsewhere ---------------------------------------------------------------------------

/// `x(7) = 4` where not all conditions are at one time, `x(0) = x(10)`.
struct BoundaryCondition {
  std::size_t state;
  Setting time;
  NodeId value;                 // of parameters and samples
  std::vector<Sample> samples;  // states at times, that `value` needs first
  Span span;
};
/// An initial guess for a state of a boundary-value problem.
struct Guess {
  std::size_t state;
  NodeId node;  // may use t
  Span span;
};
/// An unknown constant or the unknown of an algebraic equation.
struct Unknown {
  std::string name;
  std::uint32_t variable;
  NodeId guess;
  std::string unit;
  Span span;
};
/// An equation without derivatives.
struct AlgebraicEquation {
  NodeId residual;  // = 0
  std::size_t mode;
  Span span;
};

/// What stands before the highest derivatives of equations that were solved for them, `m*x'' + ... = 0`: row by row.
struct MassMatrix {
  std::vector<NodeId> coefficients;
  std::vector<std::string> names;  // "x''"
  std::size_t mode;
  Span span;
};

/// `table NAME from "file.csv"`: the nodes of `interp(NAME, x)` carry its index.
struct TableFile {
  std::string name, file;
  std::optional<Table> points;  // there in every checked model
  Span span;
};

/// `world { ... }`: world.hpp.
struct WorldDescription;
/// `sweep { ... }`: sweep.hpp.
struct SweepPlan;

/// The text of the model and the name it came by.
struct Text {
  std::string path, content;
};

/// A checked model. It is plain data, and copies are independent of each other but for the world's description, which
/// they share.
struct Model {
  std::string name;     // of `model NAME`, else of the file
  std::string heading;  // the comment at the top of the text
  Text text;
  Graph graph;
  Layout layout;
  bool has_units = false;
  std::string time_unit;  // empty without units

  std::vector<TableFile> tables;
  std::vector<Parameter> parameters;         // in the order of the text
  std::vector<std::size_t> parameter_order;  // in which their expressions can be evaluated
  std::vector<Input> inputs;
  std::vector<State> states;
  std::vector<Mode> modes;
  std::size_t start_mode = 0;

  /// For methods of x'' = a(t, x): each pair's velocity is the derivative of its position, in matching units.
  std::vector<PositionVelocity> pairs;
  bool all_paired = false;                          // every state is in one pair
  bool accelerations_depend_on_velocities = false;  // then such methods lose their order: a warning

  std::vector<Quantity> lets, outputs, energies;
  NodeId total_energy;               // the sum of `energies` and of the world's; not valid without any
  std::string total_energy_unit;     // empty without units
  std::vector<NodeId> energy_terms;  // of that sum: `energies`, then the kinetic and the potential one of the world
  std::vector<When> events;
  std::vector<Scheduled> schedule;
  std::vector<EventOrder> event_order;

  RunSettings run;
  std::vector<Plot> plots;
  std::vector<DrawItem> drawing;
  std::vector<Check> checks;

  std::vector<BoundaryCondition> boundary;
  std::vector<Guess> guesses;
  std::vector<Unknown> unknowns;
  std::vector<AlgebraicEquation> algebraic;  // of every mode
  std::vector<MassMatrix> masses;            // of every mode, those that are no numbers

  std::shared_ptr<const WorldDescription> world;  // null where the model has no bodies

  std::shared_ptr<const SweepPlan> sweep;  // null where the model has none

  std::shared_ptr<NativeCompiler> native;  // compiles the tapes that run often; null: none is compiled

  /// Whether conditions are at several times.
  [[nodiscard]] bool needs_boundary_solver() const { return !boundary.empty(); }
  /// Whether there are algebraic equations.
  [[nodiscard]] bool needs_dae_solver() const { return !algebraic.empty(); }
  /// Whether there are bodies.
  [[nodiscard]] bool has_world() const { return world != nullptr; }
};

/// A state whose derivative is zero in every mode: only events change it.
[[nodiscard]] bool stands_still(const Model& model, std::size_t state);

/// By name, `npos` where there is none: "h'" for states, "k" or "m[3]" for parameters.
inline constexpr std::size_t npos = static_cast<std::size_t>(-1);
/// The index of a state, by its column.
[[nodiscard]] std::size_t find_state(const Model& model, std::string_view column);
/// The state of that column; where there is none, the states of the family of that name: "u'" for all u[i]'.
[[nodiscard]] std::vector<std::size_t> states_named(const Model& model, std::string_view name);
/// The index of a parameter.
[[nodiscard]] std::size_t find_parameter(const Model& model, std::string_view name);
/// The index of an input.
[[nodiscard]] std::size_t find_input(const Model& model, std::string_view name);
/// The index of a mode.
[[nodiscard]] std::size_t find_mode(const Model& model, std::string_view name);

/// Values of parameters by name, and of inputs without points, that stand for those in the text. Unknown names are left
/// aside: see `find_parameter`.
using Overrides = std::map<std::string, double, std::less<>>;

/// A whole register file for the moment the run begins: t, initial states, parameters (those not overridden follow
/// from their expressions), inputs, guesses of unknowns; samples are 0. `from` replaces the text's start time.
[[nodiscard]] std::vector<double> start_values(const Model& model, const Overrides& overrides = {},
                                               std::optional<double> from = std::nullopt);

/// The value of an expression of the model for a register file as above.
[[nodiscard]] double evaluate(const Model& model, NodeId node, std::span<const double> variables);
[[nodiscard]] std::vector<double> evaluate(const Model& model, std::span<const NodeId> nodes,
                                           std::span<const double> variables);

/// The column, parameter or input that lies at this place of the flat space: for printing expressions.
[[nodiscard]] std::string variable_name(const Model& model, std::uint32_t variable);

}  // namespace continuo::model
