// Gragg, Bulirsch and Stoer's method: accuracy at the ends of steps and between them, cost, events, failures. Its table
// is tested in extrapolation_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <bench/problems/arenstorf.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/problems/lorenz.hpp>
#include <bench/problems/pleiades.hpp>
#include <bench/solver.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "any_system.hpp"
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/extrapolation/odex.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::odex_test {
namespace {

using testing::any_system, testing::AnySystem, testing::Two;
using Four = std::array<double, 4>;
using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;

/// The greatest error over one orbit of Kepler's, dense output included, in units of the tolerance.
template <class M>
double error_in_tolerances(double tolerance, double end) {
  const auto solution = solve(any_system<Four>(bench::Kepler{}), bench::Kepler::start(), {0.0, end}, M{},
                              {.rtol = tolerance, .atol = tolerance, .save = Save<Four>::every(0.03)});
  EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  double worst = 0;
  for (std::size_t n = 0; n < solution.t.size(); ++n) {
    const auto exact = bench::Kepler::exact(solution.t[n]);
    for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, std::abs(solution.x[n][i] - exact[i]) / tolerance);
  }
  return worst;
}

TEST(Odex, MeetsItsToleranceBetweenTheStepsToo) {
  for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13})
    EXPECT_LT(error_in_tolerances<Odex>(tolerance, 6), 30) << tolerance;
}

// Backwards from the end of the orbit to its beginning.
TEST(Odex, GoesBackwards) {
  const auto start = bench::Kepler::exact(6.0);
  const auto solution =
      solve(any_system<Four>(bench::Kepler{}), start, {6.0, 0.0}, Odex{}, {.rtol = 1e-10, .atol = 1e-10});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(solution.final_state()[i], bench::Kepler::start()[i], 30e-10) << i;
}

/// The greatest error at the end, of a run with rtol = atol = tolerance.
template <class M, class Problem>
double end_error(double tolerance) {
  using X = std::array<double, Problem::size>;
  const auto solution = solve(any_system<X>(Problem{}), Problem::start(), {0.0, Problem::duration}, M{},
                              {.rtol = tolerance, .atol = tolerance, .save = Save<X>::only_end()});
  EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  return bench::end_error<Problem>(solution.final_state());
}

// These problems amplify the errors of their steps, so that the error at the end is no multiple of the tolerance that
// is known beforehand. It is compared with that of a method whose steps meet the same tolerance.
template <class Problem>
void expect_errors_as_of_runge_kutta() {
  for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
    EXPECT_LT((end_error<Odex, Problem>(tolerance)), 30 * (end_error<Dop853, Problem>(tolerance)))
        << Problem::name << ' ' << tolerance;
  }
}

TEST(Odex, IsAsAccurateAsARungeKuttaMethodWhereErrorsGrow) {
  expect_errors_as_of_runge_kutta<bench::Arenstorf>();
  expect_errors_as_of_runge_kutta<bench::Pleiades>();
  expect_errors_as_of_runge_kutta<bench::Lorenz>();
}

// In 113 bits its order is worth more than anything else. The soliton x = 1 / cosh(t), x'' = x - 2 x^3.
TEST(Odex, NeedsAFractionOfTheEvaluationsOfOrderEightInManyDigits) {
  using X = std::array<Quad, 2>;
  const auto soliton = [](const Quad&, const X& x, X& dxdt) { dxdt = {x[1], Quad(x[0] - 2 * x[0] * x[0] * x[0])}; };
  const auto evaluations = [&](auto method) {
    const Quad tolerance("1e-24");
    const auto solution = solve(soliton, X{Quad(1), Quad(0)}, Interval<Quad>{Quad(0), Quad(3)}, method,
                                {.rtol = tolerance, .atol = tolerance, .save = Save<X>::only_end()});
    EXPECT_TRUE(solution.outcome) << method.name;
    EXPECT_LT(abs(solution.final_state()[0] - 1 / cosh(Quad(3))), 30 * tolerance) << method.name;
    return solution.statistics.evaluations;
  };
  EXPECT_LT(3 * evaluations(Odex{}), evaluations(Dop853{}));
}

TEST(Odex, OrderAndStepFollowTheSolution) {
  using bench::Arenstorf;
  Integrator integrator(any_system<Four>(Arenstorf{}), Arenstorf::start(), {0.0, Arenstorf::duration}, Odex{},
                        {.rtol = 1e-12, .atol = 1e-12});
  double shortest = 1, longest = 0;
  while (integrator.advance()) {
    if (integrator.statistics().steps < 10) continue;
    shortest = std::min(shortest, integrator.step_size());
    longest = std::max(longest, integrator.step_size());
  }
  ASSERT_TRUE(integrator.outcome()) << describe(integrator.outcome());
  EXPECT_GT(longest / shortest, 50);
}

// A step costs 7 evaluations with two rows and 154 with nine.
TEST(Odex, AStrictToleranceTakesMoreRows) {
  const auto per_step = [](double tolerance) {
    const auto solution = solve(any_system<Four>(bench::Kepler{}), bench::Kepler::start(), {0.0, 60.0}, Odex{},
                                {.rtol = tolerance, .atol = tolerance});
    return static_cast<double>(solution.statistics.evaluations) / static_cast<double>(solution.statistics.steps);
  };
  EXPECT_GT(per_step(1e-13), 1.5 * per_step(1e-3));
}

TEST(Odex, EventsAreFoundBetweenSteps) {
  // x = cos(t): a zero falls at pi / 2 + 2 pi n.
  Options<Two> options{.rtol = 1e-11, .atol = 1e-11};
  options.events = {falls<Two>("zero", [](double, const Two& x) { return x[0]; })};
  const AnySystem<Two> spring{.f = [](double, const Two& x, Two& dxdt) { dxdt = {x[1], -x[0]}; }};
  const auto solution = solve(spring, Two{1, 0}, {0.0, 60.0}, Odex{}, options);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  ASSERT_EQ(solution.events.size(), 10U);
  for (std::size_t n = 0; n < 10; ++n)
    EXPECT_NEAR(solution.events[n].t, M_PI / 2 + 2 * M_PI * static_cast<double>(n),
                30e-11 * static_cast<double>(n + 1));
}

// The evaluation at the end of a step for its dense output is the first of the next step.
TEST(Odex, DenseOutputCostsOneEvaluation) {
  const auto evaluations = [](Save<Four> save) {
    return solve(any_system<Four>(bench::Kepler{}), bench::Kepler::start(), {0.0, 60.0}, Odex{},
                 {.rtol = 1e-9, .atol = 1e-9, .save = std::move(save)})
        .statistics.evaluations;
  };
  EXPECT_LE(evaluations(Save<Four>::every(0.01)), evaluations(Save<Four>::only_end()) + 1);
}

TEST(Odex, AJumpForgetsTheSteps) {
  // An elastic ball: v^2/2 + 9.81 y is constant through twenty jumps of the velocity.
  const AnySystem<Two> ball{.f = [](double, const Two& x, Two& dxdt) { dxdt = {x[1], -9.81}; }};
  Options<Two> options{.rtol = 1e-9, .atol = 1e-9};
  options.events = {falls<Two>(
      "floor", [](double, const Two& x) { return x[0]; }, [](EventAction<Two>& event) { event.x[1] = -event.x[1]; })};
  const auto solution = solve(ball, Two{1, 0}, {0.0, 18.5}, Odex{}, options);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_EQ(solution.events.size(), 20U);
  const Two end = solution.final_state();
  EXPECT_NEAR(end[1] * end[1] / 2 + 9.81 * end[0], 9.81, 30e-9 * 9.81 * 20);
}

TEST(Odex, ACopyGoesOnToTheSameBits) {
  Integrator original(any_system<Four>(bench::Kepler{}), bench::Kepler::start(), {0.0, 60.0}, Odex{}, {.rtol = 1e-9});
  for (int i = 0; i < 20; ++i) original.advance();
  Integrator copy = original;
  while (original.advance()) {
  }
  while (copy.advance()) {
  }
  EXPECT_EQ(original.statistics().steps, copy.statistics().steps);
  EXPECT_GT(original.statistics().steps, 40U);
  EXPECT_EQ(original.x(), copy.x());
}

TEST(Odex, AStiffSystemIsSolvedByShortSteps) {
  // The table diverges where stability ends; x' = -1000 (x - cos t) from the slow solution.
  const AnySystem<Two> stiff{.f = [](double t, const Two& x, Two& dxdt) {
    for (std::size_t i = 0; i < 2; ++i) dxdt[i] = -1000 * (x[i] - std::cos(t)) - std::sin(t);
  }};
  const auto solution = solve(stiff, Two{1, 2}, {0.0, 3.0}, Odex{}, {.rtol = 1e-7, .atol = 1e-7});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(solution.final_state()[i], std::cos(3.0), 30e-7);
}

TEST(Odex, AnFThatIsNotANumberEndsTheRunByName) {
  const AnySystem<Two> broken{.f = [](double t, const Two& x, Two& dxdt) {
    dxdt = {t < 1 ? -x[0] : std::numeric_limits<double>::quiet_NaN(), -x[1]};
  }};
  const auto solution = solve(broken, Two{1, 1}, {0.0, 2.0}, Odex{}, {.rtol = 1e-6, .atol = 1e-6});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite) << describe(solution.outcome);
  EXPECT_NEAR(solution.outcome.t, 1, 1e-9);
  EXPECT_NEAR(solution.final_state()[1], std::exp(-solution.outcome.t), 30e-6);
}

TEST(Odex, AJumpOfFIsPassed) {
  const AnySystem<Two> jump{.f = [](double t, const Two& x, Two& dxdt) { dxdt = {t < 0.4321 ? 1.0 : -1.0, -x[1]}; }};
  const auto solution = solve(jump, Two{0, 1}, {0.0, 1.0}, Odex{}, {.rtol = 1e-8, .atol = 1e-8});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution.final_state()[0], 2 * 0.4321 - 1, 30e-8);
  EXPECT_NEAR(solution.final_state()[1], std::exp(-1.0), 30e-8);
}

// x' = 0: all errors are 0. And a state without components.
TEST(Odex, NothingToDoIsDone) {
  const AnySystem<Two> still{.f = [](double, const Two&, Two& dxdt) { dxdt = {0, 0}; }};
  const auto solution = solve(still, Two{1, 2}, {0.0, 100.0}, Odex{}, {.rtol = 1e-8, .atol = 1e-8});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_EQ(solution.final_state(), (Two{1, 2}));
  EXPECT_LT(solution.statistics.steps, 30U);
}

}  // namespace
}  // namespace continuo::odex_test
