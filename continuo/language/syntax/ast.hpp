// continuo/language/syntax/ast.hpp
// The syntax tree of a .sim model: plain values that say what was written and where, nothing about what it means.
// The grammar is docs/grammar.md.
//
//   for (const ast::Statement& statement : model.statements)
//     if (const auto* equation = std::get_if<ast::Equation>(&statement.node)) ...
#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <continuo/language/syntax/ast_expression.hpp>
#include <continuo/language/syntax/ast_measure.hpp>
#include <continuo/language/syntax/ast_sweep.hpp>
#include <continuo/language/syntax/ast_world.hpp>
#include <continuo/solve/direction.hpp>

namespace continuo::model::ast {

// ---------------------------------------------------------------------------------------------------------------
// Actions of events

struct Action;

/// `h' := -e*h'`.
struct Assignment {
  Name target;
  Expression value;
};

/// `if c { ... } else { ... }`; `else if` is an If as the only action of `otherwise`.
struct If {
  Expression condition;
  std::vector<Action> then;
  std::vector<Action> otherwise;
};

/// `go rest`.
struct Go {
  Identifier mode;
};

/// `mark "apex"`.
struct Mark {
  std::string text;
};

/// `stop`, `stop "landed"`, `stop after 5`: the run ends the fifth time this action is reached.
struct Stop {
  std::string text;                 // may be empty
  std::optional<Expression> after;  // a constant whole number, 1 where absent
};

/// `for i in 1..N { v[i] := 0 }` in an event.
struct ActionFamily {
  Identifier index;
  Range range;
  std::vector<Action> body;
};

struct Action {
  std::variant<Assignment, If, Go, Mark, Stop, ActionFamily> node;
  Span span;
};

// ---------------------------------------------------------------------------------------------------------------
// Statements

/// One `NAME = value [unit] in a..b` of a param, let, output, energy or input. `param m[i] = 2*i` in a family has an
/// index in its name; `param m[1..7] = (3, 3, ...)` has `elements`, and a List as its value.
struct Definition {
  Name name;
  std::optional<Range> elements;
  Expression value;
  std::optional<Range> range;
  Span span;
};

struct Parameters {
  std::vector<Definition> items;
};
struct Lets {
  std::vector<Definition> items;
};
struct Outputs {
  std::vector<Definition> items;
};
struct Energies {
  std::vector<Definition> items;
};

enum class Interpolation { linear, step };

/// `input u = 0 [N] in -5..5 key "w"`, `input u = 0 [N] from "force.csv" step`.
struct Input {
  Definition definition;
  std::optional<std::string> key;
  std::optional<std::string> file;
  Span file_span;
  Interpolation interpolation = Interpolation::linear;
};

/// `table drag from "drag.csv"`.
struct Table {
  Identifier name;
  std::string file;
  Span file_span;
};

/// `left = right`: `x'' = -k/m*x`, and as general as `x' + 34*x = 32` or `0 = x^2 + y^2 - 1`.
struct Equation {
  Expression left;
  Expression right;
};

/// `unknown z = 1 [m]`: an algebraic variable and the guess of its value.
struct Unknown {
  Name name;
  Expression guess;
};

/// `h(0) = 10 [m]`, `u[i]'(0) = 0`; at another time than the run's start it is a boundary condition.
struct Condition {
  Name name;
  Expression time;
  Expression value;
};

/// `guess x = 3*t`: a trajectory to start a boundary-value problem from.
struct Guess {
  Name name;
  Expression value;
};

struct Statement;

/// `for i in 1..N { ... }`.
struct Family {
  Identifier index;
  Range range;
  std::vector<Statement> body;
};

/// `mode flight { equations }`; the body holds equations, lets and families of these.
struct Mode {
  Identifier name;
  std::vector<Statement> body;
};

/// `start in flight`.
struct Start {
  Identifier mode;
};

/// `when h falls through 0 in flight { ... }`, or `when h < 0 { ... }`: without direction and level, `subject` is a
/// condition and the event is that it becomes true. `then { ... }` after it, or `then go rest`: what is done at the
/// limit that its times close in on.
struct When {
  Expression subject;
  std::optional<Direction> direction;
  std::optional<Expression> level;  // there iff direction is
  std::optional<Identifier> mode;
  std::vector<Action> actions;
  std::optional<std::vector<Action>> limit_actions;
  Span head;  // from `when` to before the brace
};

/// `at 3 [s] { ... }`.
struct At {
  Expression time;
  std::vector<Action> actions;
  Span head;
};

/// `every 0.1 [s] { ... }`, `every 24 [h] from 8 [h] { ... }`.
struct Every {
  Expression period;
  std::optional<Expression> from;
  std::vector<Action> actions;
  Span head;
};

/// `initially { ... }`.
struct Initially {
  std::vector<Action> actions;
};

/// `output 0.02`, `output log 10 per decade from 1e-3`, `output steps`.
struct OutputEvery {
  Expression interval;
};
struct OutputLogarithmic {
  Expression per_decade;
  Expression from;
};
struct OutputSteps {};
using OutputTimes = std::variant<OutputEvery, OutputLogarithmic, OutputSteps>;

/// `run 0..60 [s] output 0.02 method dop853 tol 1e-10, abs 1e-12 max step 0.1 max steps 10000 realtime`; every part but
/// the interval may be absent.
struct Run {
  std::optional<Range> interval;  // absent only after an error
  std::optional<OutputTimes> output;
  std::optional<Identifier> method;
  std::optional<Expression> step;
  std::optional<Expression> relative_tolerance;
  std::vector<Expression> absolute_tolerance;  // empty, one for all states, or one per state
  std::optional<Expression> max_step;
  std::optional<Expression> max_steps;
  bool realtime = false;
};

/// `plot h, energy against t`.
struct Plot {
  std::vector<Expression> curves;
  std::optional<Expression> against;
};

struct DrawItem;

enum class ShapeKind { floor, ball, spring, rod, rope, arrow, trail, box, text };

/// `radius 0.3`, `color "red"`, `size (4, 1.4)`: an expression, a Text for color and label, a point for a box's size.
struct Attribute {
  Identifier name;
  Expression value;
};

/// `ball (0, h) radius 0.3`. Arguments are points (a List of two or three), a number for a floor, a Text for a text.
struct Shape {
  ShapeKind kind{};
  std::vector<Expression> arguments;
  std::vector<Attribute> attributes;
};

/// `for i in 1..N { ball (x[i], y[i]) radius r[i] }` in a drawing.
struct DrawFamily {
  Identifier index;
  Range range;
  std::vector<DrawItem> body;
};

struct DrawItem {
  std::variant<Shape, DrawFamily> node;
  Span span;
};

struct Draw {
  std::vector<DrawItem> items;
};

enum class Relation { equal, less, less_equal, greater, greater_equal };

/// `check MEASURE = value within tolerance`, `check MEASURE < value`.
struct Check {
  Measure measure;
  Relation relation = Relation::equal;
  Expression value;
  std::optional<Expression> tolerance;  // there iff the relation is `equal`, but for counts, which are exact
  Span measure_span;
};

struct Statement {
  using Node =
      std::variant<Parameters, Lets, Outputs, Energies, Input, Table, Equation, Unknown, Condition, Guess, Family, Mode,
                   Start, When, At, Every, Initially, Run, Plot, Draw, Check, Sweep, World, Force>;
  Node node;
  Span span;
};

struct Model {
  std::string heading;  // the comment block at the top, its `# ` taken off; empty where there is none
  std::optional<Identifier> name;
  std::vector<Statement> statements;  // as written
};

}  // namespace continuo::model::ast
