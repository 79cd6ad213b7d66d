// Radau IIA of orders 5, 9, 13 and of variable order: order, precision, promises on the stiff problems.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <bench/problems/hires.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/pollution.hpp>
#include <bench/problems/prothero_robinson.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "stiff_promises.hpp"
#include <continuo/methods/radau.hpp>

namespace continuo {
namespace {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;

/// x' = x (1 - x), x(0) = 1/2: x = 1 / (1 + exp(-t)).
template <class Real>
struct Logistic {
  using X = std::array<Real, 1>;
  static Real exact(const Real& t) {
    using std::exp;
    return 1 / (1 + exp(-t));
  }
  void operator()(const Real&, const X& x, X& out) const { out[0] = x[0] * (1 - x[0]); }
};

template <class M, class Real, class System>
Real error_of_fixed_steps(const System& system, const Real& start, const Real& exact, const Real& end, const Real& h) {
  using std::abs;
  const Real tight = 50 * std::numeric_limits<Real>::epsilon();
  Options<std::array<Real, 1>> options{.rtol = tight, .atol = tight, .step = h};
  const auto solution = solve(system, std::array<Real, 1>{start}, Interval<Real>{0, end}, M{}, options);
  EXPECT_TRUE(solution.outcome);
  return abs(solution.final_state()[0] - exact);
}

/// log2 of the ratio of the errors at two steps, h and h/2.
template <class M>
double order_of(int steps) {
  const Quad end = 4, exact = Logistic<Quad>::exact(end), half = Quad(1) / 2;
  const Quad coarse = error_of_fixed_steps<M, Quad>(Logistic<Quad>{}, half, exact, end, end / steps);
  const Quad fine = error_of_fixed_steps<M, Quad>(Logistic<Quad>{}, half, exact, end, end / (2 * steps));
  return static_cast<double>(log(coarse / fine) / log(Quad(2)));
}

// A tenth of an order: the next term of the error is some h smaller.
TEST(Radau, OrdersAre5And9And13) {
  EXPECT_NEAR(order_of<Radau5>(32), 5, 0.15);
  EXPECT_NEAR(order_of<Radau9>(16), 9, 0.3);
  EXPECT_NEAR(order_of<Radau13>(16), 13, 0.3);
}

// Where lambda h is far beyond 1, the error is that of the collocation polynomial's slope at the end, of order s, over
// lambda (Hairer & Wanner II, IV.15): 3, 5 and 7.
template <class M>
double stiff_order_of(int steps) {
  using Real = long double;
  const bench::ProtheroRobinson<Real> problem{.lambda = -1e6L};
  const auto error = [&](int n) {
    return error_of_fixed_steps<M, Real>(problem, problem.start()[0], problem.exact(8)[0], 8, 8.0L / n);
  };
  return static_cast<double>(std::log2(error(steps) / error(2 * steps)));
}

TEST(Radau, OrdersOnProtheroRobinsonAreThoseOfTheStages) {
  EXPECT_NEAR(stiff_order_of<Radau5>(80), 3, 0.1);
  EXPECT_NEAR(stiff_order_of<Radau9>(40), 5, 0.2);
  EXPECT_NEAR(stiff_order_of<Radau13>(20), 7, 0.3);
}

/// The greatest error of the dense output of one step of h from the exact state.
template <class M>
long double error_of_dense_output(long double h) {
  using Real = long double;
  const Real tight = 1e-15L;
  Integrator integrator(Logistic<Real>{}, std::array<Real, 1>{0.5L}, Interval<Real>{0, h}, M{},
                        {.rtol = tight, .atol = tight, .step = h});
  while (integrator.advance()) {
  }
  EXPECT_TRUE(integrator.outcome());
  Real worst = 0;
  std::array<Real, 1> x{};
  for (int i = 0; i <= 20; ++i) {
    integrator.interpolant()(Real(i) / 20, x);
    worst = std::max(worst, std::abs(x[0] - Logistic<Real>::exact(h * Real(i) / 20)));
  }
  return worst;
}
template <class M>
double dense_order_of(long double h) {
  return static_cast<double>(std::log2(error_of_dense_output<M>(h) / error_of_dense_output<M>(h / 2))) - 1;
}

// The logistic function is odd about the start: polynomials of even degree are as good as those of the next.
TEST(Radau, DenseOutputIsOfTheOrderOfTheStages) {
  EXPECT_GT(dense_order_of<Radau5>(0.25L), Radau5::dense_order - 0.1);
  EXPECT_GT(dense_order_of<Radau9>(0.25L), Radau9::dense_order - 0.1);
  EXPECT_GT(dense_order_of<Radau13>(0.5L), Radau13::dense_order - 0.1);
}

// In so short an interval that the error of the method is far below rounding: C h^5 end with C of the order of 1e-4.
template <class M, class Real>
void expect_full_precision(const Real& end, int steps) {
  const Real error =
      error_of_fixed_steps<M, Real>(Logistic<Real>{}, Real(1) / 2, Logistic<Real>::exact(end), end, Real(end / steps));
  // The equations of each step are solved to 10 epsilon.
  EXPECT_LT(error, 10 * steps * std::numeric_limits<Real>::epsilon()) << M::name;
}

TEST(Radau, EveryMethodReachesThePrecisionOfItsScalar) {
  expect_full_precision<Radau5, long double>(0.0625L, 128);
  expect_full_precision<Radau9, long double>(1, 16);
  expect_full_precision<Radau13, long double>(1, 8);
  expect_full_precision<Radau5, Quad>(Quad(1) / 4096, 64);
  expect_full_precision<Radau9, Quad>(Quad(1) / 2, 256);
  expect_full_precision<Radau13, Quad>(Quad(1), 128);
}

TEST(Radau, VariableOrderReaches113Bits) {
  const Quad tolerance = 1e-26;
  const auto solution = solve(Logistic<Quad>{}, std::array<Quad, 1>{Quad(1) / 2}, Interval<Quad>{0, 4}, Radau{},
                              {.rtol = tolerance, .atol = tolerance});
  ASSERT_TRUE(solution.outcome);
  EXPECT_LT(abs(solution.final_state()[0] - Logistic<Quad>::exact(4)), 30 * tolerance);
}

// The bound of the suite: within a factor of 30 of the tolerance, over the whole range of tolerances.
template <class M>
void expect_tolerance_is_met() {
  for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
    EXPECT_LT(promises::error_in_tolerances<M>(bench::Robertson<>{}, rtol, rtol * 1e-8), 30) << rtol;
    EXPECT_LT(promises::error_in_tolerances<M>(bench::Hires<>{}, rtol, rtol * 1e-4), 30) << rtol;
    EXPECT_LT(promises::error_in_tolerances<M>(bench::Oregonator<>{}, rtol, rtol * 1e-6), 30) << rtol;
    EXPECT_LT(promises::error_in_tolerances<M>(bench::Pollution<>{}, rtol, rtol * 1e-6), 30) << rtol;
    EXPECT_LT(promises::error_in_tolerances<M>(bench::VanDerPolScaled<>{}, rtol, rtol), 30) << rtol;
  }
}
TEST(Radau, Radau5MeetsItsToleranceOnStiffProblems) {
  expect_tolerance_is_met<Radau5>();
}
TEST(Radau, VariableOrderMeetsItsToleranceOnStiffProblems) {
  expect_tolerance_is_met<Radau>();
}

TEST(Radau, VariableOrderNeedsFarFewerStepsAtTightTolerances) {
  const auto steps = []<class M>(M method, double rtol) {
    return solve(bench::Robertson<>{}, bench::Robertson<>::start(), {0.0, 1e11}, method,
                 {.rtol = rtol, .atol = 1e-8 * rtol})
        .statistics.steps;
  };
  EXPECT_LT(8 * steps(Radau{}, 1e-11), steps(Radau5{}, 1e-11));
}

TEST(Radau, KeepsTheSumOfRobertsonsAmounts) {
  // A linear invariant: each step keeps it to rounding, some hundred steps of 2e-16 each.
  const auto solution =
      solve(bench::Robertson<>{}, bench::Robertson<>::start(), {0.0, 1e11}, Radau{}, {.rtol = 1e-6, .atol = 1e-12});
  const auto& x = solution.final_state();
  EXPECT_NEAR(x[0] + x[1] + x[2], 1, 1e-13);
}

TEST(Radau, DenseOutputMeetsTheTolerance) {
  const bench::ProtheroRobinson<> problem;
  const auto exact = [](double t) { return bench::ProtheroRobinson<>::exact(t)[0]; };
  for (const double tolerance : {1e-4, 1e-7, 1e-9}) {
    EXPECT_LT(promises::dense_error_in_tolerances<Radau5>(problem, 10, tolerance, exact), 30) << tolerance;
    EXPECT_LT(promises::dense_error_in_tolerances<Radau>(problem, 10, tolerance, exact), 30) << tolerance;
  }
}

TEST(Radau, SolvesAlgebraicEquations) {
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    EXPECT_LT(promises::error_of_algebraic_decay<Radau5>(tolerance), 30);
    EXPECT_LT(promises::error_of_algebraic_decay<Radau>(tolerance), 30);
  }
}

TEST(Radau, ACopyGoesOnToTheSameBits) {
  promises::expect_copy_goes_on_to_the_same_bits<Radau>(bench::Hires<>{}, bench::Hires<>::start(), 321.8122);
}

TEST(Radau, FailuresAreNamed) {
  promises::expect_not_finite_ends_by_name<Radau>();
  promises::expect_singular_ends_by_name<Radau>();
}

// x' = J x with run-time size, sparse by its pattern: the heat equation's slowest mode decays by 4/dx^2 sin^2(pi dx/2).
struct Heat {
  static constexpr std::size_t nodes = 33;
  static constexpr double dx = 1.0 / (nodes + 1);
  SparsePattern pattern = [] {
    std::vector<MatrixPlace> places;
    for (std::uint32_t i = 1; i < nodes; ++i) places.insert(places.end(), {{i, i - 1}, {i - 1, i}});
    return SparsePattern(nodes, places);
  }();
  void operator()(double, const std::vector<double>& u, std::vector<double>& dudt) const {
    for (std::size_t i = 0; i < nodes; ++i) {
      const double left = i > 0 ? u[i - 1] : 0, right = i + 1 < nodes ? u[i + 1] : 0;
      dudt[i] = (left - 2 * u[i] + right) / (dx * dx);
    }
  }
  const SparsePattern& jacobian_pattern() const { return pattern; }
};

TEST(Radau, SolvesSparseSystemsOfRunTimeSize) {
  std::vector<double> u(Heat::nodes);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::sin(M_PI * Heat::dx * static_cast<double>(i + 1));
  const auto solution = solve(Heat{}, u, {0.0, 0.2}, Radau{}, {.rtol = 1e-9, .atol = 1e-9});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  const double rate = 4 / (Heat::dx * Heat::dx) * std::pow(std::sin(M_PI * Heat::dx / 2), 2);
  for (std::size_t i = 0; i < u.size(); ++i)
    EXPECT_NEAR(solution.final_state()[i], u[i] * std::exp(-0.2 * rate), 30 * (1e-9 + 1e-9 * u[i]));
  EXPECT_LT(solution.statistics.jacobians, 6U) << "a linear system";
}

}  // namespace
}  // namespace continuo
