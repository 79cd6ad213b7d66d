// Adams-Bashforth-Moulton of variable order and step.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <bench/problems/arenstorf.hpp>
#include <bench/problems/kepler.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "any_system.hpp"
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/multistep/adams.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::adams_test {
namespace {

using testing::any_system, testing::AnySystem;
using Four = std::array<double, 4>;

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;

// With k values of f and the one at the predicted point, a step of order k integrates polynomials of degree k exactly,
// and so does its interpolant. x' = (1 + t)^12, steps of all sizes between 0.05 and 0.15, the order raised in each.
TEST(Adams, AtUnequalStepsPolynomialsUpToTheOrderAreExact) {
  using X = std::array<Quad, 1>;
  const auto f = [](const Quad& t, const X&) { return X{pow(1 + t, 12)}; };
  const auto exact = [](const Quad& t) { return Quad(pow(1 + t, 13) / 13); };
  Quad t(0);
  X x{exact(t)}, x_new = x, between = x;
  auto work = Adams::workspace(x);
  Interpolant<X, Adams::dense_degree> interpolant(x);
  for (int n = 0; n < 20; ++n) {
    const Quad h = Quad(5 + (n * 7) % 11) / 100;
    Adams::step(f, t, x, h, n == 0, work, x_new);
    if (work.order == Adams::greatest_order) {
      const Quad rounding = 1e-29 * x_new[0];
      EXPECT_LT(abs(x_new[0] - x[0] - (exact(t + h) - exact(t))), rounding) << n;
      Adams::interpolate(f, t, x, h, x_new, work, interpolant);
      for (const Quad& theta : {Quad(0.25), Quad(0.5), Quad(1)}) {
        interpolant(theta, between);
        EXPECT_LT(abs(between[0] - x[0] - (exact(t + theta * h) - exact(t))), rounding) << n;
      }
    }
    work.next_order = std::min(work.order + 1, Adams::greatest_order);
    Adams::accept(work);
    x = x_new;
    t += h;
  }
  EXPECT_EQ(work.order, Adams::greatest_order);
}

// E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", table III.1.1.
TEST(Adams, AtEqualStepsTheWeightsAreThoseOfTheTextbook) {
  using X = std::array<double, 1>;
  const auto f = [](double t, const X&) { return X{std::cos(t)}; };
  X x{0}, x_new{};
  auto work = Adams::workspace(x);
  for (int n = 0; n < 7; ++n) {
    Adams::step(f, 0.125 * n, x, 0.125, n == 0, work, x_new);
    work.next_order = work.order + 1;
    Adams::accept(work);
  }
  const std::array<double, 7> gamma{1, 1.0 / 2, 5.0 / 12, 3.0 / 8, 251.0 / 720, 95.0 / 288, 19087.0 / 60480};
  for (std::size_t i = 0; i < gamma.size(); ++i) EXPECT_NEAR(work.g[i], gamma[i], 1e-15);
}

/// The greatest error over the run, dense output included, in units of the tolerance.
template <class M, class Problem>
double error_in_tolerances(double tolerance, double end, std::size_t* evaluations = nullptr) {
  using X = Four;
  const auto solution = solve(any_system<Four>(Problem{}), Problem::start(), {0.0, end}, M{},
                              {.rtol = tolerance, .atol = tolerance, .save = Save<X>::every(0.03)});
  EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  if (evaluations) *evaluations = solution.statistics.evaluations;
  double worst = 0;
  for (std::size_t n = 0; n < solution.t.size(); ++n) {
    const auto exact = Problem::exact(solution.t[n]);
    for (std::size_t i = 0; i < Problem::size; ++i)
      worst = std::max(worst, std::abs(solution.x[n][i] - exact[i]) / tolerance);
  }
  return worst;
}

TEST(Adams, MeetsItsToleranceBetweenTheStepsToo) {
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11})
    EXPECT_LT((error_in_tolerances<Adams, bench::Kepler>(tolerance, 6)), 30) << tolerance;
}

// Two evaluations a step at any order. On ten orbits both errors are that of the period, added up. Ours is smaller at
// the same tolerance: at ten times the other's it is not above.
TEST(Adams, NeedsFewerEvaluationsThanARungeKuttaMethodOfOrderEight) {
  for (const double tolerance : {1e-7, 1e-9}) {
    std::size_t ours = 0, others = 0;
    const double our_error = 10 * error_in_tolerances<Adams, bench::Kepler>(10 * tolerance, 60, &ours);
    const double their_error = error_in_tolerances<Dop853, bench::Kepler>(tolerance, 60, &others);
    EXPECT_LT(our_error, their_error);
    EXPECT_LT(static_cast<double>(ours), 0.75 * static_cast<double>(others));
  }
}

TEST(Adams, EvaluatesTwiceAStep) {
  const auto solution =
      solve(any_system<Four>(bench::Kepler{}), bench::Kepler::start(), {0.0, 50.0}, Adams{}, {.rtol = 1e-8});
  // Two more evaluations for the first step. A rejected step repeats its prediction, and at the start of the run also f
  // there.
  EXPECT_LE(solution.statistics.evaluations, 2 * (solution.statistics.steps + solution.statistics.rejected + 1));
}

// The orbit passes the moon twice, with steps a thousand times shorter; it is unstable there.
TEST(Adams, StepsFollowTheSolution) {
  using bench::Arenstorf;
  const auto solution = solve(any_system<Four>(Arenstorf{}), Arenstorf::start(), {0.0, Arenstorf::duration}, Adams{},
                              {.rtol = 1e-12, .atol = 1e-12});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  double shortest = 1, longest = 0;
  for (std::size_t n = 2; n < solution.t.size(); ++n) {
    const double h = solution.t[n] - solution.t[n - 1];
    longest = std::max(longest, h);
    if (n > 20) shortest = std::min(shortest, h);
  }
  EXPECT_GT(longest / shortest, 50);
  EXPECT_NEAR(solution.final_state()[0], Arenstorf::start()[0], 1e-5);
  EXPECT_NEAR(solution.final_state()[1], Arenstorf::start()[1], 1e-5);
}

TEST(Adams, AJumpForgetsThePast) {
  // An elastic ball: v^2/2 + 9.81 y is constant through twenty jumps of the velocity.
  using X = std::array<double, 2>;
  const AnySystem<X> ball{.f = [](double, const X& x, X& dxdt) { dxdt = {x[1], -9.81}; }};
  Options<X> options{.rtol = 1e-9, .atol = 1e-9};
  options.events = {falls<X>(
      "floor", [](double, const X& x) { return x[0]; }, [](EventAction<X>& event) { event.x[1] = -event.x[1]; })};
  const auto solution = solve(ball, X{1, 0}, {0.0, 18.5}, Adams{}, options);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_EQ(solution.events.size(), 20U);  // the first after sqrt(2 / 9.81), then twice that
  const X end = solution.final_state();
  EXPECT_NEAR(end[1] * end[1] / 2 + 9.81 * end[0], 9.81, 30e-9 * 9.81 * 20);
}

TEST(Adams, ACopyGoesOnToTheSameBits) {
  Integrator original(any_system<Four>(bench::Kepler{}), bench::Kepler::start(), {0.0, 20.0}, Adams{}, {.rtol = 1e-9});
  for (int i = 0; i < 100; ++i) original.advance();
  Integrator copy = original;
  while (original.advance()) {
  }
  while (copy.advance()) {
  }
  EXPECT_EQ(original.statistics().steps, copy.statistics().steps);
  EXPECT_EQ(original.x(), copy.x());
}

TEST(Adams, TakesFixedSteps) {
  // Order 4, but the first step has order 2 and its error stays: h^3 / 12 or so.
  using X = testing::Two;
  const AnySystem<X> decay{.f = [](double, const X& x, X& dxdt) { dxdt = {-x[0], -x[1]}; }};
  const auto error = [&](double h) {
    return std::abs(solve(decay, X{1, 1}, {0.0, 1.0}, Adams{}, {.step = h}).final_state()[0] - std::exp(-1.0));
  };
  EXPECT_LT(error(0.01), 1e-6);
  EXPECT_NEAR(std::log2(error(0.01) / error(0.005)), 3, 0.2);
}

TEST(Adams, AnFThatIsNotANumberEndsTheRunByName) {
  using X = testing::Two;
  const AnySystem<X> broken{.f = [](double t, const X& x, X& dxdt) {
    dxdt = {t < 1 ? -x[0] : std::numeric_limits<double>::quiet_NaN(), -x[1]};
  }};
  const auto solution = solve(broken, X{1, 1}, {0.0, 2.0}, Adams{}, {.rtol = 1e-6, .atol = 1e-6});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite) << describe(solution.outcome);
  EXPECT_NEAR(solution.outcome.t, 1, 1e-9);
}

}  // namespace
}  // namespace continuo::adams_test
