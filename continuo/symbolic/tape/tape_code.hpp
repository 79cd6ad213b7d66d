// continuo/symbolic/tape/tape_code.hpp
// What a tape is made of: instructions on numbered registers, and what each computes. Internal to the tape.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <continuo/numerics/taylor.hpp>

namespace continuo::model::tape {

enum class Code : std::uint16_t {
  add,                      // a + b
  subtract,                 // a - b
  multiply,                 // a*b
  divide,                   // a/b
  multiply_add,             // a*b + c
  multiply_subtract,        // a*b - c
  subtract_product,         // c - a*b
  negated_product,          // -(a*b)
  negated_sum,              // -(a + b)
  negated_multiply_add,     // -(a*b + c)
  negated_sum_of_products,  // -(a*b + c*d)
  sum_of_products,          // a*b + c*d
  difference_of_products,   // a*b - c*d
  sum_times,                // (a + b)*c
  difference_times,         // (a - b)*c
  multiply_twice,           // a*b*c
  sum_less_product,         // c + d - a*b
  less_product_plus,        // c - a*b + d
  negate,
  square_root,
  sine,
  cosine,
  // from here on less frequent
  select_less,        // a < b ? c : d
  select_less_equal,  // a <= b ? c : d
  select,             // a != 0 ? b : c
  minimum,
  maximum,
  absolute,
  exponential,
  power,
  hypotenuse,
  arc_tangent2,
  modulo,
  less,
  less_equal,
  equal,
  not_equal,
  logical_and,
  logical_or,
  logical_not,
  tangent,
  arc_sine,
  arc_cosine,
  arc_tangent,
  hyperbolic_sine,
  hyperbolic_cosine,
  hyperbolic_tangent,
  logarithm,
  logarithm10,
  sign,
  floor,
  ceiling,
  // the end of what `operate` computes
  interpolate,        // table b at a
  interpolate_slope,  // its slope
  batch,              // batches[a]: one operation on many registers
  stop,
};
inline constexpr std::size_t operations = static_cast<std::size_t>(Code::interpolate);

inline constexpr std::size_t frequent = static_cast<std::size_t>(Code::select_less);

/// Where the evaluation goes for a code: a place of its own for the frequent ones, one for all others, three at last.
[[nodiscard]] constexpr std::uint16_t entry(Code code) {
  const auto c = static_cast<std::size_t>(code);
  return static_cast<std::uint16_t>(c < operations ? (c < frequent ? c : frequent) : c - operations + frequent + 1);
}

/// registers[result] = code(registers[a], ...): as many as the code reads.
struct Instruction {
  std::uint16_t entry;
  Code code;
  std::uint32_t result, a, b, c, d;

  explicit Instruction(Code code_) : entry(tape::entry(code_)), code(code_), result(0), a(0), b(0), c(0), d(0) {}
};

/// Where the operands of a batch lie.
struct Operand {
  enum class Layout : std::uint32_t { one, contiguous, gathered };
  Layout layout = Layout::one;
  std::uint32_t begin = 0;  // a register; for `gathered` the place in the list of registers
};

/// registers[result + k] = code(a_k, b_k, ...) for k in 0..count: equal operations that stand side by side in a model
/// (the points of a grid, the pairs of N bodies) are one instruction, computed by a plain loop.
struct Batch {
  Code code;
  std::uint32_t result, count;
  Operand operand[4] = {};
};

[[nodiscard]] constexpr std::size_t operands(Code code) {
  switch (code) {
    case Code::sum_of_products:
    case Code::difference_of_products:
    case Code::negated_sum_of_products:
    case Code::sum_less_product:
    case Code::less_product_plus:
    case Code::select_less:
    case Code::select_less_equal:
      return 4;
    case Code::multiply_add:
    case Code::multiply_subtract:
    case Code::subtract_product:
    case Code::negated_multiply_add:
    case Code::sum_times:
    case Code::difference_times:
    case Code::multiply_twice:
    case Code::select:
      return 3;
    case Code::add:
    case Code::subtract:
    case Code::multiply:
    case Code::divide:
    case Code::negated_product:
    case Code::negated_sum:
    case Code::minimum:
    case Code::maximum:
    case Code::power:
    case Code::hypotenuse:
    case Code::arc_tangent2:
    case Code::modulo:
    case Code::less:
    case Code::less_equal:
    case Code::equal:
    case Code::not_equal:
    case Code::logical_and:
    case Code::logical_or:
      return 2;
    default:
      return 1;
  }
}

/// a where the condition holds, else b: of numbers by ?:, of lanes by their own `select`.
template <class Condition, class Real>
[[nodiscard]] Real choose(const Condition& condition, const Real& a, const Real& b) {
  if constexpr (std::is_same_v<Condition, bool>) {
    return condition ? a : b;
  } else {
    return select(condition, a, b);
  }
}

/// a - b*floor(a/b). Enclosures bring their own, as the three do not know of each other there.
template <class Real>
[[nodiscard]] Real modulus(const Real& a, const Real& b) {
  using std::floor;
  if constexpr (requires { mod(a, b); }) {
    return mod(a, b);
  } else {
    return a - b * floor(a / b);
  }
}

/// -1, 0 or 1.
template <class Real>
[[nodiscard]] Real signum(const Real& a) {
  if constexpr (requires { sign(a); }) {
    return sign(a);
  } else {
    return choose(a > Real(0), Real(1), Real(choose(a < Real(0), Real(-1), a)));
  }
}

template <Code code, class Real>
[[nodiscard]] Real operate_logic(const Real& a, const Real& b) {
  const Real one(1), zero(0);
  if constexpr (code == Code::less) return choose(a < b, one, zero);
  if constexpr (code == Code::less_equal) return choose(a <= b, one, zero);
  if constexpr (code == Code::equal) return choose(a == b, one, zero);
  if constexpr (code == Code::not_equal) return choose(a != b, one, zero);
  if constexpr (code == Code::logical_not) return choose(a == zero, one, zero);
  if constexpr (code == Code::logical_and) return choose(a == zero, zero, Real(choose(b == zero, zero, one)));
  if constexpr (code == Code::logical_or) return choose(a == zero, Real(choose(b == zero, zero, one)), one);
}

template <Code code, class Real>
[[nodiscard]] Real operate_function(const Real& a, const Real& b) {
  using std::min, std::max, std::abs, std::exp, std::pow, std::atan2, std::tan, std::asin, std::acos, std::atan,
      std::sinh, std::cosh, std::tanh, std::log, std::log10, std::floor, std::ceil, std::sqrt, std::sin, std::cos;
  if constexpr (code == Code::square_root) return sqrt(a);
  if constexpr (code == Code::sine) return sin(a);
  if constexpr (code == Code::cosine) return cos(a);
  if constexpr (code == Code::minimum && is_taylor<Real>) return choose(b < a, b, a);
  if constexpr (code == Code::maximum && is_taylor<Real>) return choose(a < b, b, a);
  if constexpr (code == Code::minimum && !is_taylor<Real>) return min(a, b);
  if constexpr (code == Code::maximum && !is_taylor<Real>) return max(a, b);
  if constexpr (code == Code::absolute) return abs(a);
  if constexpr (code == Code::exponential) return exp(a);
  if constexpr (code == Code::power) return pow(a, b);
  if constexpr (code == Code::hypotenuse && is_taylor<Real>) return hypot(a, b);
  if constexpr (code == Code::hypotenuse && !is_taylor<Real>) return sqrt(a * a + b * b);
  if constexpr (code == Code::arc_tangent2) return atan2(a, b);
  if constexpr (code == Code::modulo) return modulus(a, b);
  if constexpr (code == Code::tangent) return tan(a);
  if constexpr (code == Code::arc_sine) return asin(a);
  if constexpr (code == Code::arc_cosine) return acos(a);
  if constexpr (code == Code::arc_tangent) return atan(a);
  if constexpr (code == Code::hyperbolic_sine) return sinh(a);
  if constexpr (code == Code::hyperbolic_cosine) return cosh(a);
  if constexpr (code == Code::hyperbolic_tangent) return tanh(a);
  if constexpr (code == Code::logarithm) return log(a);
  if constexpr (code == Code::logarithm10) return log10(a);
  if constexpr (code == Code::floor) return floor(a);
  if constexpr (code == Code::ceiling) return ceil(a);
  if constexpr (code == Code::sign) return signum(a);
}

/// The value of one instruction. Operands the code does not read may be anything.
template <Code code, class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real operate(const Real& a, const Real& b, const Real& c, const Real& d) {
  constexpr bool is_logic = code >= Code::less && code <= Code::logical_not;
  if constexpr (code == Code::add)
    return a + b;
  else if constexpr (code == Code::negated_sum)
    return -(a + b);
  else if constexpr (code == Code::negated_multiply_add)
    return -(a * b + c);
  else if constexpr (code == Code::negated_sum_of_products)
    return -(a * b + c * d);
  else if constexpr (code == Code::subtract)
    return a - b;
  else if constexpr (code == Code::multiply)
    return a * b;
  else if constexpr (code == Code::divide)
    return a / b;
  else if constexpr (code == Code::multiply_add)
    return a * b + c;
  else if constexpr (code == Code::multiply_subtract)
    return a * b - c;
  else if constexpr (code == Code::subtract_product)
    return c - a * b;
  else if constexpr (code == Code::negated_product)
    return -(a * b);
  else if constexpr (code == Code::sum_of_products)
    return a * b + c * d;
  else if constexpr (code == Code::difference_of_products)
    return a * b - c * d;
  else if constexpr (code == Code::sum_times)
    return (a + b) * c;
  else if constexpr (code == Code::difference_times)
    return (a - b) * c;
  else if constexpr (code == Code::multiply_twice)
    return a * b * c;
  else if constexpr (code == Code::sum_less_product)
    return c + d - a * b;
  else if constexpr (code == Code::less_product_plus)
    return c - a * b + d;
  else if constexpr (code == Code::negate)
    return -a;
  else if constexpr (code == Code::select_less)
    return choose(a < b, c, d);
  else if constexpr (code == Code::select_less_equal)
    return choose(a <= b, c, d);
  else if constexpr (code == Code::select)
    return choose(a != Real(0), b, c);
  else if constexpr (is_logic)
    return operate_logic<code>(a, b);
  else
    return operate_function<code>(a, b);
}

}  // namespace continuo::model::tape
