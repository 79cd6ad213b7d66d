// continuo/language/syntax/ast_expression.hpp
// The expressions of the syntax tree; ast.hpp holds what they stand in.
#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <continuo/language/syntax/value_ptr.hpp>
#include <continuo/language/text/source.hpp>

namespace continuo::model::ast {

struct Expression;

// ---------------------------------------------------------------------------------------------------------------
// Small parts

struct Identifier {
  std::string text;
  Span span;
};

/// `[m/s^2]`: the text between the brackets, without them. The span is with them.
struct Unit {
  std::string text;
  Span span;
};

/// A name where it is used or defined: `h`, `h''`, `u[i-1]'`, `a[i, j]`; of a body also `ball.x`, `grain[3].y'`.
struct Name {
  std::string text;
  int primes = 0;
  std::vector<Expression> indices;
  Span span;           // with primes, indices and member
  std::string member;  // what stands after the point; empty for none
};

// ---------------------------------------------------------------------------------------------------------------
// Expressions

struct Number {
  double value = 0;
};

/// `"..."`, its escapes resolved; only where a grammar rule asks for a text (labels and colours of drawings).
struct Text {
  std::string value;
};

enum class UnaryOperator { negate, logical_not };
enum class BinaryOperator {
  add,
  subtract,
  multiply,
  divide,
  power,
  less,
  less_equal,
  greater,
  greater_equal,
  equal,      // ==
  not_equal,  // !=
  logical_and,
  logical_or,
};

struct Unary {
  UnaryOperator op{};
  ValuePtr<Expression> operand;
};

struct Binary {
  BinaryOperator op{};
  ValuePtr<Expression> left;
  ValuePtr<Expression> right;
};

/// `sin(x)`, `interp(table, x)`; also a state at a time as in `check h'(1) = ...`, hence the primes and indices.
struct Call {
  Name callee;
  std::vector<Expression> arguments;
};

/// `if condition then a else b`.
struct Conditional {
  ValuePtr<Expression> condition;
  ValuePtr<Expression> when_true;
  ValuePtr<Expression> when_false;
};

/// `value [unit]`: a number with its unit, or a unit stated for a value made otherwise, as in `sqrt(2) [m]`.
/// Numbers alone that end with one unit have it as a whole: `1/2 [m]` is half a metre, the unit is outermost here.
struct Quantity {
  ValuePtr<Expression> value;
  Unit unit;
};

/// `first..last`; `run 0..60 [s]` has its unit for both ends.
struct Range {
  ValuePtr<Expression> first;
  ValuePtr<Expression> last;
  std::optional<Unit> unit;
  Span span;  // without the unit
};

/// `sum(j in 1..N where j != i: body)`.
struct Sum {
  Identifier index;
  Range range;
  std::optional<ValuePtr<Expression>> condition;
  ValuePtr<Expression> body;
};

/// `(a, b, c)`: values of an indexed parameter, tolerances, a point of a drawing. Nowhere inside another expression.
struct List {
  std::vector<Expression> items;
};

/// Stands where an expression could not be read; the parser has reported it. Treat it as fitting everywhere.
struct Missing {};

struct Expression {
  using Node = std::variant<Missing, Number, Text, Name, Unary, Binary, Call, Conditional, Quantity, Sum, List>;
  Node node;
  Span span;
};

}  // namespace continuo::model::ast
