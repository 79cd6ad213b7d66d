// The patterns and the functions of C for each operation of a tape.
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include <continuo/symbolic/native/c_operations.hpp>

namespace continuo::model {

namespace {

using tape::Code;

/// The expression of one operation; each operand is a name, a number or stands in brackets.
std::string_view pattern_of(Code code) {
  switch (code) {
    case Code::add:
      return "{0} + {1}";
    case Code::subtract:
      return "{0} - {1}";
    case Code::multiply:
      return "{0}*{1}";
    case Code::divide:
      return "{0}/{1}";
    case Code::multiply_add:
      return "{0}*{1} + {2}";
    case Code::multiply_subtract:
      return "{0}*{1} - {2}";
    case Code::subtract_product:
      return "{2} - {0}*{1}";
    case Code::negated_product:
      return "-({0}*{1})";
    case Code::negated_sum:
      return "-({0} + {1})";
    case Code::negated_multiply_add:
      return "-({0}*{1} + {2})";
    case Code::negated_sum_of_products:
      return "-({0}*{1} + {2}*{3})";
    case Code::sum_of_products:
      return "{0}*{1} + {2}*{3}";
    case Code::difference_of_products:
      return "{0}*{1} - {2}*{3}";
    case Code::sum_times:
      return "({0} + {1})*{2}";
    case Code::difference_times:
      return "({0} - {1})*{2}";
    case Code::multiply_twice:
      return "{0}*{1}*{2}";
    case Code::sum_less_product:
      return "{2} + {3} - {0}*{1}";
    case Code::less_product_plus:
      return "{2} - {0}*{1} + {3}";
    case Code::negate:
      return "-{0}";
    case Code::select_less:
      return "{0} < {1} ? {2} : {3}";
    case Code::select_less_equal:
      return "{0} <= {1} ? {2} : {3}";
    case Code::select:
      return "{0} != 0.0 ? {1} : {2}";
    case Code::less:
      return "{0} < {1} ? 1.0 : 0.0";
    case Code::less_equal:
      return "{0} <= {1} ? 1.0 : 0.0";
    case Code::equal:
      return "{0} == {1} ? 1.0 : 0.0";
    case Code::not_equal:
      return "{0} != {1} ? 1.0 : 0.0";
    case Code::logical_and:
      return "{0} != 0.0 && {1} != 0.0 ? 1.0 : 0.0";
    case Code::logical_or:
      return "{0} != 0.0 || {1} != 0.0 ? 1.0 : 0.0";
    case Code::logical_not:
      return "{0} == 0.0 ? 1.0 : 0.0";
    default:
      return {};
  }
}

/// {0} is the function of a fused operation. Of two products the second one is rounded.
std::string_view fused_pattern_of(Code code) {
  switch (code) {
    case Code::multiply_add:
      return "{0}({1}, {2}, {3})";
    case Code::multiply_subtract:
      return "{0}({1}, {2}, -{3})";
    case Code::subtract_product:
      return "{0}(-{1}, {2}, {3})";
    case Code::negated_multiply_add:
      return "-{0}({1}, {2}, {3})";
    case Code::sum_of_products:
      return "{0}({1}, {2}, {3}*{4})";
    case Code::difference_of_products:
      return "{0}({1}, {2}, -({3}*{4}))";
    case Code::negated_sum_of_products:
      return "-{0}({1}, {2}, {3}*{4})";
    case Code::sum_less_product:
      return "{0}(-{1}, {2}, {3} + {4})";
    case Code::less_product_plus:
      return "{0}(-{1}, {2}, {3}) + {4}";
    default:
      return {};
  }
}

std::string_view function_of(Code code) {
  switch (code) {
    case Code::square_root:
      return "sqrt";
    case Code::sine:
      return "sin";
    case Code::cosine:
      return "cos";
    case Code::minimum:
      return "minimum";
    case Code::maximum:
      return "maximum";
    case Code::absolute:
      return "fabs";
    case Code::exponential:
      return "exp";
    case Code::power:
      return "pow";
    case Code::hypotenuse:
      return "hypotenuse";
    case Code::arc_tangent2:
      return "atan2";
    case Code::modulo:
      return "modulo";
    case Code::tangent:
      return "tan";
    case Code::arc_sine:
      return "asin";
    case Code::arc_cosine:
      return "acos";
    case Code::arc_tangent:
      return "atan";
    case Code::hyperbolic_sine:
      return "sinh";
    case Code::hyperbolic_cosine:
      return "cosh";
    case Code::hyperbolic_tangent:
      return "tanh";
    case Code::logarithm:
      return "log";
    case Code::logarithm10:
      return "log10";
    case Code::sign:
      return "sign_of";
    case Code::floor:
      return "floor";
    case Code::ceiling:
      return "ceil";
    default:
      return {};
  }
}

/// Of the operations that C has for numbers and not for lanes.
std::string_view choice_of_lanes(Code code) {
  switch (code) {
    case Code::select_less:
      return "select_less";
    case Code::select_less_equal:
      return "select_less_equal";
    case Code::select:
      return "select_nonzero";
    case Code::less:
      return "is_less";
    case Code::less_equal:
      return "is_less_equal";
    case Code::equal:
      return "is_equal";
    case Code::not_equal:
      return "is_not_equal";
    case Code::logical_and:
      return "are_both";
    case Code::logical_or:
      return "is_either";
    case Code::logical_not:
      return "is_not";
    default:
      return {};
  }
}

[[nodiscard]] bool is_primary(std::string_view text) {
  if (text.empty() || text.front() == '-') return false;
  int depth = 0;
  for (const char c : text) {
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') --depth;
    if (depth == 0 && (c == ' ' || c == '*' || c == '/')) return false;
  }
  return true;
}

std::string bracketed(const std::string& text) {
  return is_primary(text) ? text : "(" + text + ")";
}

}  // namespace

std::string number_text(double value) {
  if (std::isnan(value)) return "NAN";
  if (std::isinf(value)) return value > 0 ? "INFINITY" : "(-INFINITY)";
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return std::signbit(value) ? "(" + text + ")" : text;
}

std::string operation_text(Code code, std::array<std::string, 4> operand, bool in_lanes) {
  const std::string_view choice = in_lanes ? choice_of_lanes(code) : std::string_view();
  if (const std::string_view pattern = pattern_of(code); !pattern.empty() && choice.empty()) {
    for (std::size_t k = 0; k < tape::operands(code); ++k) operand[k] = bracketed(operand[k]);
    return fmt::format(fmt::runtime(pattern), operand[0], operand[1], operand[2], operand[3]);
  }
  std::string arguments = operand[0];
  for (std::size_t k = 1; k < tape::operands(code); ++k) arguments += ", " + operand[k];
  if (!choice.empty()) return fmt::format("{}({})", choice, arguments);
  return fmt::format("{}{}({})", in_lanes ? "each_" : "", function_of(code), arguments);
}

std::string fused_text(std::string_view a, std::string_view b, std::string_view c, bool in_lanes) {
  return fmt::format("{}({}, {}, {})", in_lanes ? "each_fused" : "fused", a, b, c);
}

std::string fused_operation_text(Code code, std::array<std::string, 4> operand, bool in_lanes) {
  const std::string_view pattern = fused_pattern_of(code);
  if (pattern.empty()) return {};
  for (std::size_t k = 0; k < tape::operands(code); ++k) operand[k] = bracketed(operand[k]);
  return fmt::format(fmt::runtime(pattern), in_lanes ? "each_fused" : "fused", operand[0], operand[1], operand[2],
                     operand[3]);
}

std::string table_text(Code code, std::uint32_t table, std::string_view x, bool in_lanes) {
  return fmt::format("{}{}{}({})", in_lanes ? "each_" : "", code == Code::interpolate ? "table_" : "slope_of_table_",
                     table, x);
}

}  // namespace continuo::model
