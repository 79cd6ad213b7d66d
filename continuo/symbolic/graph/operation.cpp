// continuo/symbolic/graph/operation.cpp
// The value of each operation for numbers.
#include <algorithm>
#include <limits>

#include <continuo/symbolic/graph/operation.hpp>

namespace continuo::model {

double compute(Op op, double a, double b, double c) {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    case Op::power:
      return std::pow(a, b);
    case Op::minimum:
      return b < a ? b : a;
    case Op::maximum:
      return a < b ? b : a;
    case Op::hypotenuse:
      return std::sqrt(a * a + b * b);
    case Op::arc_tangent2:
      return std::atan2(a, b);
    case Op::modulo:
      return a - b * std::floor(a / b);
    case Op::less:
      return a < b ? 1 : 0;
    case Op::less_equal:
      return a <= b ? 1 : 0;
    case Op::equal:
      return a == b ? 1 : 0;
    case Op::not_equal:
      return a != b ? 1 : 0;
    case Op::logical_and:
      return a != 0 && b != 0 ? 1 : 0;
    case Op::logical_or:
      return a != 0 || b != 0 ? 1 : 0;
    case Op::negate:
      return -a;
    case Op::sine:
      return std::sin(a);
    case Op::cosine:
      return std::cos(a);
    case Op::tangent:
      return std::tan(a);
    case Op::arc_sine:
      return std::asin(a);
    case Op::arc_cosine:
      return std::acos(a);
    case Op::arc_tangent:
      return std::atan(a);
    case Op::hyperbolic_sine:
      return std::sinh(a);
    case Op::hyperbolic_cosine:
      return std::cosh(a);
    case Op::hyperbolic_tangent:
      return std::tanh(a);
    case Op::exponential:
      return std::exp(a);
    case Op::logarithm:
      return std::log(a);
    case Op::logarithm10:
      return std::log10(a);
    case Op::square_root:
      return std::sqrt(a);
    case Op::absolute:
      return std::abs(a);
    case Op::sign:
      return a > 0 ? 1 : (a < 0 ? -1 : a);
    case Op::floor:
      return std::floor(a);
    case Op::ceiling:
      return std::ceil(a);
    case Op::logical_not:
      return a == 0 ? 1 : 0;
    case Op::smooth:
      return a;
    case Op::select:
      return a != 0 ? b : c;
    case Op::constant:
    case Op::variable:
    case Op::interpolate:
    case Op::interpolate_slope:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace continuo::model
