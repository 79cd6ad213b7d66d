// An explicit method on a stiff system reports the stiffness; on other systems it does not.
#include <array>
#include <cmath>

#include <bench/problems/hires.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom8.hpp>
#include <continuo/methods/support/stiffness_watch.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo::stiffness_test {
namespace {

TEST(Stiffness, TheWatchFindsTheDominantEigenvalue) {
  // Eigenvalues -1 and -1000: the iteration gains a factor of 1000 each time.
  const auto f = [](double, const std::array<double, 2>& x) { return std::array{-x[0], 999 * x[0] - 1000 * x[1]}; };
  const std::array<double, 2> x{1, 0.5};
  StiffnessWatch<std::array<double, 2>> watch(x);
  for (int i = 0; i < 5; ++i) watch.probe(f, 0.0, x, f(0, x), {1e-6, 1e-9});
  EXPECT_NEAR(watch.radius(), 1000, 1);
  EXPECT_NEAR(watch.real_part(), -1000, 1);
  EXPECT_TRUE(watch.bounds(0.0033));
  EXPECT_FALSE(watch.bounds(0.0005));
}

// Positions and velocities are measured in different units: the Rayleigh quotient of df/dx itself is anything from -w^2
// to w^2 here, that of its square is -w^2.
TEST(Stiffness, TheWatchTellsAnOscillationFromADecay) {
  const std::array<double, 2> x{1, 0.5};
  const auto watched = [&x](const auto& f) {
    StiffnessWatch<std::array<double, 2>> watch(x);
    for (int i = 0; i < 4; ++i) watch.probe(f, 0.0, x, f(0, x), {1e-6, 1e-6});
    return watch;
  };
  const auto oscillation =
      watched([](double, const std::array<double, 2>& y) { return std::array{y[1], -1e8 * y[0]}; });
  EXPECT_TRUE(oscillation.oscillates());
  EXPECT_NEAR(oscillation.radius(), 1e4, 1);
  EXPECT_FALSE(oscillation.bounds(1e-3));
  const auto decay =
      watched([](double, const std::array<double, 2>& y) { return std::array{-y[0], 999 * y[0] - 1000 * y[1]}; });
  EXPECT_FALSE(decay.oscillates());
  EXPECT_TRUE(decay.bounds(1e-2));
}

TEST(Stiffness, AnExplicitMethodThatRunsOutOfStepsNamesTheCause) {
  const auto solution = solve(bench::VanDerPolScaled<>{}, bench::VanDerPolScaled<>::start(), {0.0, 2.0}, Tsitouras5{},
                              {.rtol = 1e-4, .atol = 1e-4, .max_steps = 20'000});
  EXPECT_EQ(solution.outcome.ending, Ending::too_many_steps);
  EXPECT_NE(solution.outcome.hint.find("stiff"), std::string::npos) << solution.outcome.hint;
  EXPECT_NE(solution.outcome.hint.find("rodas5p"), std::string::npos);
}

// Steps of some 1e-3 for a run to 1e11: 1e14 of them, of which 1e7 are allowed.
TEST(Stiffness, AnEndlessRunIsNotGoneOnWith) {
  const auto solution = solve(bench::Robertson<>{}, bench::Robertson<>::start(), {0.0, 1e11}, Dop853{}, {.rtol = 1e-4});
  EXPECT_EQ(solution.outcome.ending, Ending::too_many_steps);
  EXPECT_LT(solution.statistics.steps, 1'000'000U);
  EXPECT_NE(solution.outcome.hint.find("stiff"), std::string::npos) << solution.outcome.hint;
  EXPECT_NE(solution.outcome.hint.find("1e1"), std::string::npos) << solution.outcome.hint;
}

// An event without effect on the state cannot end the stiffness; one with an effect could.
TEST(Stiffness, AnEndlessRunGoesOnWhereAnEventCouldChangeIt) {
  using X = std::array<double, 3>;
  const auto steps = [](Action<X> action) {
    Options<X> options{.rtol = 1e-4, .max_steps = 100'000};
    options.events = {rises<X>("late", [](double, const X& x) { return x[2] - 0.9; }, std::move(action))};
    return solve(bench::Robertson<>{}, bench::Robertson<>::start(), {0.0, 1e11}, Dop853{}, options).statistics.steps;
  };
  EXPECT_LT(steps({}), 50'000U);
  EXPECT_GT(steps([](EventAction<X>& now) { now.stop = true; }), 90'000U);
}

// The eigenvalue -1e5 / (1 + t)^2: at first, at the pace of h = 6 / 1e5, 1e5 / 6 * 2000 steps would be needed, three
// hundred times the limit. In all it is the integral of lambda / 6 to 3, some 1e5 / 6.
TEST(Stiffness, ARunThatGetsFasterIsNotGivenUp) {
  const auto f = [](double t, const std::array<double, 1>& x) {
    return std::array{-1e5 / ((1 + t) * (1 + t)) * (x[0] - std::cos(t))};
  };
  const auto solution =
      solve(f, std::array{1.0}, {0.0, 2000.0}, Dop853{}, {.rtol = 1e-3, .atol = 1e-3, .max_steps = 100'000});
  EXPECT_TRUE(solution.outcome) << solution.outcome.hint;
  EXPECT_GT(solution.statistics.steps, 10'000U);
}

// The same where only a change at a known time makes it faster.
TEST(Stiffness, ARunIsNotGivenUpBeforeAScheduledEvent) {
  double lambda = 1e5;
  const auto f = [&lambda](double, const std::array<double, 1>& x) { return std::array{lambda * (1 - x[0])}; };
  using X = std::array<double, 1>;
  Options<X> options{.rtol = 1e-3, .atol = 1e-3, .max_steps = 20'000};
  options.events = {at<X>("calm", {0.3}, [&lambda](EventAction<X>& now) {
    lambda = 1;
    now.restart = true;
  })};
  EXPECT_TRUE(solve(f, std::array{0.0}, {0.0, 1e4}, Dop853{}, options).outcome);
}

// x'' = -1e8 (x - cos t), on the solution that follows cos t: the eigenvalues lie on the imaginary axis.
TEST(Stiffness, AStiffSpringIsFoundByMethodsForAccelerations) {
  const auto spring =
      second_order([](double t, const std::array<double, 1>& q) { return std::array{-1e8 * (q[0] - std::cos(t))}; });
  const std::array start{1 / (1 - 1e-8), 0.0};
  const auto solution = solve(spring, start, {0.0, 3.0}, DormandPrinceNystrom8{}, {.rtol = 1e-4, .atol = 1e-4});
  ASSERT_TRUE(solution.outcome);
  EXPECT_GT(solution.statistics.steps, 3'000U);
  EXPECT_NE(solution.outcome.hint.find("stiff"), std::string::npos);
}

TEST(Stiffness, AMotionOfPlanetsIsNot) {
  const auto solution =
      solve(bench::Kepler{}, bench::Kepler::start(), {0.0, 1e4}, DormandPrinceNystrom8{}, {.rtol = 1e-8});
  ASSERT_TRUE(solution.outcome);
  EXPECT_GT(solution.statistics.steps, 2000U);
  EXPECT_EQ(solution.outcome.hint, "");
}

TEST(Stiffness, ARunThatArrivesAllTheSameSaysWhatItCost) {
  const auto solution = solve(bench::Hires<>{}, bench::Hires<>::start(), {0.0, 321.8122}, Dop853{}, {.rtol = 1e-4});
  ASSERT_TRUE(solution.outcome);
  EXPECT_NE(solution.outcome.hint.find("stiff"), std::string::npos);
}

TEST(Stiffness, AnOscillationIsNotStiff) {
  // Some thousand steps of h |lambda| near 1, but along the imaginary axis.
  const auto f = [](double, const std::array<double, 2>& x) { return std::array{x[1], -x[0]}; };
  for (const double rtol : {1e-3, 1e-8}) {
    const auto solution = solve(f, std::array{1.0, 0.0}, {0.0, 20000.0}, Tsitouras5{}, {.rtol = rtol});
    ASSERT_TRUE(solution.outcome);
    EXPECT_GT(solution.statistics.steps, 2000U);
    EXPECT_EQ(solution.outcome.hint, "");
  }
}

}  // namespace
}  // namespace continuo::stiffness_test
