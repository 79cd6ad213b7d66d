// Every method's measured order: halving h divides the error by 2^order. Three problems with closed forms, all of the
// form q'' = a(t, q, v) so that every method can take them, in long double (order 9 in 113 bits), so that high orders
// have room before round-off: the last pair of errors above some hundred units of it is used.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "any_motion.hpp"
#include <continuo/methods/all.hpp>

namespace continuo::order_test {
namespace {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;

template <class Real>
struct Problem {
  std::string name;
  Real (*acceleration)(Real t, Real q, Real v);
  std::array<Real, 2> (*exact)(Real t);

  testing::AnyMotion<Real> system() const { return {acceleration}; }
};

const int end = 2;  // all of them run from 0 to here

template <class Real>
std::vector<Problem<Real>> problems() {
  using X = std::array<Real, 2>;
  using std::cos, std::cosh, std::exp, std::sin, std::tanh;
  return {{"q'' = q - 2 q^3", [](Real, Real q, Real) -> Real { return q - 2 * q * q * q; },
           [](Real t) { return X{1 / cosh(t), -tanh(t) / cosh(t)}; }},
          {"q'' = t - q", [](Real t, Real q, Real) -> Real { return t - q; },
           [](Real t) { return X{t + sin(t), 1 + cos(t)}; }},
          {"q'' = -2 q - 2 v", [](Real, Real q, Real v) -> Real { return -2 * q - 2 * v; },
           [](Real t) { return X{exp(-t) * cos(t), -exp(-t) * (cos(t) + sin(t))}; }}};
}

template <class X>
Scalar<X> distance(const X& a, const X& b) {
  using std::abs;
  return std::max<Scalar<X>>(abs(a[0] - b[0]), abs(a[1] - b[1]));
}

/// The largest error of n equal steps.
template <class M, class Real>
Real error_after(int n, const Problem<Real>& problem) {
  auto system = problem.system();
  auto x = problem.exact(0), x_new = x;
  auto work = M::workspace(x);
  const Real h = Real(end) / n;
  Real worst = 0;
  for (int i = 0; i < n; ++i) {
    M::step(system, Real(h * i), x, h, i == 0, work, x_new);
    M::accept(work);
    x = x_new;
    worst = std::max<Real>(worst, distance(x, problem.exact(h * (i + 1))));
  }
  return worst;
}

/// The largest error of the interpolant of one step of size 1 / n from the exact state at t = 1/4.
template <class M, class Real>
Real dense_error(int n, const Problem<Real>& problem) {
  auto system = problem.system();
  const Real t = 0.25, h = Real(1) / n;
  const auto x = problem.exact(t);
  auto x_new = x, value = x;
  auto work = M::workspace(x);
  Interpolant<std::array<Real, 2>, M::dense_degree> interpolant(x);
  M::step(system, t, x, h, true, work, x_new);
  M::interpolate(system, t, x, h, x_new, work, interpolant);
  Real worst = 0;
  for (Real theta = 0.0625; theta < 1; theta += 0.0625) {
    interpolant(theta, value);
    worst = std::max<Real>(worst, distance(value, problem.exact(t + theta * h)));
  }
  return worst;
}

/// log2(error(n) / error(2 n)) for the largest n, from `first` on by doubling, whose error is not round-off yet.
template <class Real>
double measured_order(int first, int last, const std::function<Real(int)>& error) {
  Real coarse = error(first);
  double order = 0;
  for (int n = 2 * first; n <= last; n *= 2) {
    const Real fine = error(n);
    if (fine < 300 * std::numeric_limits<Real>::epsilon()) break;
    order = std::log2(static_cast<double>(Real(coarse / fine)));
    coarse = fine;
  }
  return order;
}

template <class M>
class OrderOf : public ::testing::Test {};
template <class M>
using RealFor = std::conditional_t<(M::order > 8), Quad, long double>;
struct NameOfMethod {
  template <class M>
  static std::string GetName(int) {
    return std::string(M::name);
  }
};
template <class>
struct Types;
template <class... M>
struct Types<std::tuple<M...>> {
  using type = ::testing::Types<M...>;
};
TYPED_TEST_SUITE(OrderOf, Types<ExplicitMethods>::type, NameOfMethod);

TYPED_TEST(OrderOf, IsTheNominalOneOnThreeProblems) {
  using Real = RealFor<TypeParam>;
  for (const auto& problem : problems<Real>()) {
    const auto error = [&](int n) { return error_after<TypeParam>(n, problem); };
    EXPECT_NEAR(measured_order<Real>(6, 1000, error), TypeParam::order, 0.15) << problem.name;
  }
}

TYPED_TEST(OrderOf, TheInterpolantHasTheStatedOneInsideAStep) {
  // One step from an exact state: the error of an interpolant of order p is h^(p+1).
  using Real = RealFor<TypeParam>;
  double lowest = 100;
  for (const auto& problem : problems<Real>()) {
    const auto error = [&](int n) { return dense_error<TypeParam>(n, problem); };
    const double order = measured_order<Real>(2, 256, error);
    EXPECT_GT(order, TypeParam::dense_order + 1 - 0.15) << problem.name;
    lowest = std::min(lowest, order);
  }
  EXPECT_LT(lowest, TypeParam::dense_order + 1 + 0.5) << "the interpolant is better than stated";
}

}  // namespace
}  // namespace continuo::order_test
