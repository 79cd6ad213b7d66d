// continuo/symbolic/graph/operation.hpp
// The operations an expression is made of, and what each computes. Truth is 1, falsehood 0.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace continuo::model {

enum class Op : std::uint8_t {
  constant,
  variable,
  // two arguments
  add,
  subtract,
  multiply,
  divide,
  power,
  minimum,
  maximum,
  hypotenuse,
  arc_tangent2,  // atan2(y, x)
  modulo,        // a - b*floor(a/b): has the sign of b
  less,
  less_equal,
  equal,
  not_equal,
  logical_and,
  logical_or,
  // one argument
  negate,
  sine,
  cosine,
  tangent,
  arc_sine,
  arc_cosine,
  arc_tangent,
  hyperbolic_sine,
  hyperbolic_cosine,
  hyperbolic_tangent,
  exponential,
  logarithm,
  logarithm10,
  square_root,
  absolute,
  sign,
  floor,
  ceiling,
  logical_not,
  smooth,  // its argument: what jumps in there needs no search for the instant
  // three arguments
  select,  // select(condition, value if true, value if false)
  // a table and one argument
  interpolate,
  interpolate_slope,  // d interpolate / dx
};

/// The number of arguments that are expressions.
[[nodiscard]] constexpr std::size_t arity(Op op) {
  if (op <= Op::variable) return 0;
  if (op < Op::negate) return 2;
  if (op < Op::select) return 1;
  return op == Op::select ? 3 : 1;
}

[[nodiscard]] constexpr bool is_commutative(Op op) {
  return op == Op::add || op == Op::multiply || op == Op::minimum || op == Op::maximum || op == Op::hypotenuse ||
         op == Op::equal || op == Op::not_equal || op == Op::logical_and || op == Op::logical_or;
}

/// The result is 0 or 1.
[[nodiscard]] constexpr bool is_logical(Op op) {
  return (op >= Op::less && op <= Op::logical_or) || op == Op::logical_not;
}

/// It has a jump somewhere, or a kink, where its arguments have none.
[[nodiscard]] constexpr bool has_corners(Op op) {
  switch (op) {
    case Op::minimum:
    case Op::maximum:
    case Op::arc_tangent2:  // jumps by 2*pi behind the origin
    case Op::modulo:
    case Op::absolute:
    case Op::sign:
    case Op::floor:
    case Op::ceiling:
    case Op::select:
    case Op::interpolate:
    case Op::interpolate_slope:
      return true;
    default:
      return is_logical(op);
  }
}

/// The name in a model: `sin`, `+`, `<=`.
[[nodiscard]] constexpr std::string_view name(Op op) {
  constexpr std::string_view names[] = {
      "constant", "variable", "+",    "-",    "*",      "/",      "^",      "min",         "max",   "hypot", "atan2",
      "mod",      "<",        "<=",   "==",   "!=",     "and",    "or",     "-",           "sin",   "cos",   "tan",
      "asin",     "acos",     "atan", "sinh", "cosh",   "tanh",   "exp",    "log",         "log10", "sqrt",  "abs",
      "sign",     "floor",    "ceil", "not",  "smooth", "select", "interp", "interp_slope"};
  return names[static_cast<std::size_t>(op)];
}

/// What op computes for numbers; constants, variables and tables have nothing to compute and give NaN.
[[nodiscard]] double compute(Op op, double a, double b = 0, double c = 0);

}  // namespace continuo::model
