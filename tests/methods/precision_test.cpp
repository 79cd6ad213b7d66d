// In long double and in 113 bits every explicit method and every Radau method is as exact as those: at steps so small
// that the errors are far below what a double can hold, halving the step still divides them by 2^order, until the
// errors are below 1e-25. A coefficient with an error in its twentieth digit would end that.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "any_motion.hpp"
#include <continuo/methods/all.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::precision_test {
namespace {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;

/// q'' = q - 2 q^3, q = 1 / cosh(t): every method can take it.
template <class Real>
struct Soliton {
  using X = std::array<Real, 2>;
  static X exact(const Real& t) {
    using std::cosh, std::tanh;
    return {Real(1 / cosh(t)), Real(-tanh(t) / cosh(t))};
  }
  static testing::AnyMotion<Real> system() {
    return {.acceleration = [](Real, Real q, Real) -> Real { return q - 2 * q * q * q; }, .reads_velocity = false};
  }
};

/// The error of one step from the exact state at t = 1/4: of order h^(p + 1). Infinite where its equations are not
/// solved: the step was too long for so exact a solution.
template <class M, class Real>
Real error_of_step(const Real& h) {
  using std::abs;
  auto system = Soliton<Real>::system();
  const Real t(0.25);
  const auto x = Soliton<Real>::exact(t);
  auto x_new = x;
  auto work = M::workspace(x);
  if constexpr (requires { M::set_tolerance(work, Tolerance<Real>{}); }) {
    const Real tolerance = 10 * std::numeric_limits<Real>::epsilon();
    M::set_tolerance(work, Tolerance<Real>{tolerance, tolerance});
  }
  M::step(system, t, x, h, true, work, x_new);
  if (detail::status_of<M>(work) != StepStatus::done) return std::numeric_limits<Real>::infinity();
  const auto exact = Soliton<Real>::exact(Real(t + h));
  return std::max<Real>(abs(x_new[0] - exact[0]), abs(x_new[1] - exact[1]));
}

/// Halves the step until the error is below `least`, and expects the order of the last halving: that of the method or
/// one more, where its leading term is small here. The error before is some 2^(p + 1) times as large, so `least` leaves
/// room above rounding.
template <class M, class Real>
void expect_order_down_to(const Real& least) {
  using std::log2;
  Real h(0.5), before = error_of_step<M, Real>(h), now = before;
  for (int halvings = 0; !(now < least) && halvings < 60; ++halvings) {
    before = now;
    h /= 2;
    now = error_of_step<M, Real>(h);
  }
  EXPECT_LT(now, least) << M::name;
  const double order = static_cast<double>(log2(Real(before / now))) - 1;
  EXPECT_GT(order, M::order - 0.25) << M::name;
  EXPECT_LT(order, M::order + 1.25) << M::name;
}

// 1e-25 is 5e8 roundings of 113 bits: of an order of 12, 2^13 is still above rounding after the last halving. Doubles
// end at 1e-16, and coefficients with the digits of a double at about that too.
TEST(Precision, OneHundredAndThirteenBitsAreUsedByEveryExplicitMethod) {
  const auto check = []<class M>() { expect_order_down_to<M, Quad>(Quad("1e-25")); };
  for_each_method<ExplicitMethods>(check);
  for_each_method<AccelerationMethods>(check);
  check.operator()<Rkc2>();
}

// 2e-17 is below the rounding of a double of this size, and 200 roundings of a long double of 64 bits.
TEST(Precision, LongDoubleIsUsedByEveryExplicitMethod) {
  if (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "long double is double here";
  const auto check = []<class M>() {
    if constexpr (M::order <= 6) {
      expect_order_down_to<M, long double>(2e-17L);
    } else {
      // The next halving is below rounding: the error alone tells.
      EXPECT_LT((error_of_step<M, long double>(1.0L / 128)), 2e-18L) << M::name;
    }
  };
  for_each_method<ExplicitMethods>(check);
  for_each_method<AccelerationMethods>(check);
  check.operator()<Rkc2>();
}

TEST(Precision, RadauUsesThemToo) {
  for_each_method<std::tuple<Radau5, Radau9, Radau13>>([]<class M>() {
    expect_order_down_to<M, Quad>(Quad("1e-25"));
    if constexpr (std::numeric_limits<long double>::digits >= 64) {
      EXPECT_LT((error_of_step<M, long double>(1.0L / 1024)), 1e-18L) << M::name;
    }
  });
}

/// Through the driver: the greatest error at t = 1 in units of the tolerance.
template <class M, class Real>
Real error_of_run(const Real& tolerance) {
  using std::abs;
  const auto solution =
      solve(Soliton<Real>::system(), Soliton<Real>::exact(Real(0)), Interval<Real>{Real(0), Real(1)}, M{},
            {.rtol = tolerance, .atol = tolerance, .save = {.kind = Save<std::array<Real, 2>>::Kind::end}});
  EXPECT_TRUE(succeeded(solution.outcome.ending)) << M::name;
  const auto exact = Soliton<Real>::exact(Real(1));
  return std::max<Real>(abs(solution.final_state()[0] - exact[0]), abs(solution.final_state()[1] - exact[1])) /
         tolerance;
}

// 30 tolerances are what these tests allow everywhere.
TEST(Precision, ToleranceBelowThoseOfADoubleIsMet) {
  EXPECT_LT((error_of_run<Dop853, Quad>(Quad("1e-24"))), 30);
  EXPECT_LT((error_of_run<Verner9, Quad>(Quad("1e-26"))), 30);
  EXPECT_LT((error_of_run<DormandPrinceNystrom12, Quad>(Quad("1e-28"))), 30);
  EXPECT_LT((error_of_run<Radau, Quad>(Quad("1e-26"))), 30);
  EXPECT_LT((error_of_run<Adams, Quad>(Quad("1e-26"))), 30);
  EXPECT_LT((error_of_run<Odex, Quad>(Quad("1e-26"))), 30);
  EXPECT_LT((error_of_run<Seulex, Quad>(Quad("1e-20"))), 30);
}

// The orders of Adams' methods cannot be followed in one step, which needs others before it: tests/methods/
// stiff_order_test.cpp follows them from 2 to 13 in 113 bits. Through the driver, 3e-17 is below the rounding of a
// double.
TEST(Precision, AdamsUsesLongDouble) {
  if (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "long double is double here";
  EXPECT_LT((error_of_run<Adams, long double>(1e-18L)), 30);
}

}  // namespace
}  // namespace continuo::precision_test
