// Traced numbers: values are those of the plain computation, and derivatives are exact.
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/sensitivities/traced.hpp>

namespace continuo::traced_test {
namespace {

/// Every operation and function, at arguments where all are smooth.
template <class Real>
Real everything(const Real& x, const Real& y) {
  using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cbrt, std::cos, std::cosh, std::exp, std::expm1,
      std::fabs, std::hypot, std::log, std::log10, std::log1p, std::max, std::min, std::pow, std::sin, std::sinh,
      std::sqrt, std::tan, std::tanh;
  Real sum = sin(x) * cos(y) + tan(x) / y - exp(x * y) + log(y);
  sum += sqrt(y) + cbrt(x) - log10(y) * log1p(x) + expm1(x);
  sum -= asin(x) + acos(x) * atan(y) + sinh(x) * cosh(y) + tanh(x);
  sum *= 2.0 + atan2(x, y) + hypot(x, y) + abs(x) + fabs(-y);
  sum /= 1 + pow(y, 3) + pow(y, x) + pow(2.0, x) + max(x, y) * min(x, y);
  return -sum + +x;
}

// The derivative by x of an analytic function is Im f(x + ih) / h as long as h is small: but abs, max and atan2 are not
// analytic as functions of a complex number. So the referee is a central difference of order 4 in long double: h = 1e-4
// leaves h^4 / 30 times the fifth derivative, some 1e-14, and eps / h = 1e-15 by rounding.
TEST(Traced, DerivativesOfEveryFunctionAreExact) {
  const double x = 0.3, y = 1.7;
  Trace<double> trace;
  const Traced<double> a = trace.variable(x), b = trace.variable(y), result = everything(a, b);
  EXPECT_NEAR(result.value(), everything(x, y), 1e-14 * std::abs(result.value()));
  const auto difference = [](auto&& g) {
    const long double h = 1e-4L;
    return static_cast<double>((8 * (g(h) - g(-h)) - (g(2 * h) - g(-2 * h))) / (12 * h));
  };
  const std::span<const double> slopes = trace.slopes_of(result);
  ASSERT_EQ(slopes.size(), 2U);
  using Long = long double;
  EXPECT_NEAR(slopes[0], difference([&](Long h) { return everything<Long>(x + h, y); }), 1e-11);
  EXPECT_NEAR(slopes[1], difference([&](Long h) { return everything<Long>(x, y + h); }), 1e-11);
}

TEST(Traced, SeveralResultsAreWeightedInOneSweep) {
  Trace<double> trace;
  const Traced<double> a = trace.variable(2), b = trace.variable(3);
  const std::array results{a * b, a / b, Traced<double>(5.0)};
  const std::array weights{10.0, 9.0, 100.0};
  const std::span<const double> slopes = trace.slopes_of(std::span<const Traced<double>>(results), weights);
  EXPECT_DOUBLE_EQ(slopes[0], 10.0 * 3 + 9.0 / 3);
  EXPECT_DOUBLE_EQ(slopes[1], 10.0 * 2 - 9.0 * 2 / 9);
}

TEST(Traced, ConstantsLeaveNoOperationsAndHaveNoDerivative) {
  Trace<double> trace;
  const Traced<double> a = trace.variable(2), constant = Traced<double>(3) * 4.0;
  EXPECT_TRUE(constant.is_constant());
  EXPECT_EQ(constant.value(), 12);
  EXPECT_EQ(trace.slopes_of(constant)[0], 0);
  EXPECT_TRUE(constant > a);
  // An infinite slope that nobody asks for is not multiplied by zero.
  const Traced<double> root = sqrt(a - 2.0);
  EXPECT_EQ(trace.slopes_of(a + 0.0 * 0.0 + constant)[0], 1);
  EXPECT_TRUE(std::isinf(trace.slopes_of(root)[0]));
}

TEST(Traced, PowersOfZeroHaveTheSlopesOfProducts) {
  Trace<double> trace;
  const Traced<double> zero = trace.variable(0);
  EXPECT_EQ(trace.slopes_of(pow(zero, 0))[0], 0);
  EXPECT_EQ(trace.slopes_of(pow(zero, 1))[0], 1);
  EXPECT_EQ(trace.slopes_of(pow(zero, 2))[0], 0);
}

}  // namespace
}  // namespace continuo::traced_test
