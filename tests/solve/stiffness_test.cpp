// An explicit method on a stiff system says so; on others it does not.
#include <array>
#include <cmath>

#include <bench/problems/hires.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include <continuo/methods/dop853.hpp>
#include <continuo/methods/stiffness_watch.hpp>
#include <continuo/methods/tsitouras5.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo {
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

TEST(Stiffness, AnExplicitMethodThatRunsOutOfStepsNamesTheCause) {
  const auto solution = solve(bench::VanDerPolScaled<>{}, bench::VanDerPolScaled<>::start(), {0.0, 2.0}, Tsitouras5{},
                              {.rtol = 1e-4, .atol = 1e-4, .max_steps = 20'000});
  EXPECT_EQ(solution.outcome.ending, Ending::too_many_steps);
  EXPECT_NE(solution.outcome.hint.find("stiff"), std::string::npos) << solution.outcome.hint;
  EXPECT_NE(solution.outcome.hint.find("rodas5p"), std::string::npos);
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
}  // namespace continuo
