// Every way in which a run can end, with the results computed before its end.
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <continuo/methods/all.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::outcome_test {
namespace {

using X = std::array<double, 1>;
/// Any system, of one type, so that the driver is compiled once for a method.
using Slope = std::function<X(double, const X&)>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Outcome, BlowUpEndsNearTheSingularityWithTheComponentNamed) {
  const Slope f = [](double, const X& x) { return X{x[0] * x[0]}; };  // x = 1/(1 - t)
  const auto solution = solve(f, X{1}, {0, 2}, Tsitouras5{});
  EXPECT_TRUE(solution.outcome.ending == Ending::step_too_small || solution.outcome.ending == Ending::not_finite);
  EXPECT_NEAR(solution.outcome.t, 1, 1e-3);
  EXPECT_FALSE(solution.outcome.hint.empty());
  EXPECT_GT(solution.final_state()[0], 100);
  EXPECT_LT(solution.final_state()[0], std::numeric_limits<double>::infinity());
}

// odeint-v2#79, scipy#11239: NaN is never success and never a hang.
TEST(Outcome, NotFiniteIsNeverAccepted) {
  const Slope f = [](double t, const X&) { return X{t > 0.5 ? nan : 1.0}; };
  const auto solution = solve(f, X{0}, {0, 1}, Tsitouras5{});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite);
  EXPECT_EQ(solution.outcome.component, "x[0]");
  EXPECT_NEAR(solution.outcome.t, 0.5, 1e-6);
  for (const X& x : solution.x) EXPECT_TRUE(std::isfinite(x[0]));
}

TEST(Outcome, AnInfiniteStageIsRejectedAndTheStepShrunk) {
  const Slope f = [](double, const X& x) {
    return X{x[0] > 0.999 ? std::numeric_limits<double>::infinity() : 1 - x[0]};
  };
  const auto solution = solve(f, X{0}, {0, 5}, Tsitouras5{}, {.first_step = 5});
  EXPECT_EQ(solution.outcome.ending, Ending::reached_end);
  EXPECT_NEAR(solution.final_state()[0], 1 - std::exp(-5), 1e-5);
}

TEST(Outcome, FixedStepsEndAtTheFirstOverflow) {
  const Slope f = [](double, const X& x) { return X{x[0] * x[0]}; };
  const auto solution = solve(f, X{1}, {0, 10}, Rk4{}, {.step = 0.1});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite);
  EXPECT_TRUE(std::isfinite(solution.final_state()[0]));
}

TEST(Outcome, InputThatIsNotFiniteIsRefused) {
  const Slope f = [](double, const X& x) { return x; };
  EXPECT_EQ(solve(f, X{nan}, {0, 1}, Tsitouras5{}).outcome.ending, Ending::invalid_input);
  EXPECT_EQ(solve(f, X{1}, {0, nan}, Tsitouras5{}).outcome.ending, Ending::invalid_input);
  EXPECT_EQ(solve(f, X{1}, {0, 1}, Rk4{}).outcome.ending, Ending::invalid_input);
  EXPECT_EQ(solve(f, X{1}, {0, 1}, Tsitouras5{}, {.rtol = -1}).outcome.ending, Ending::invalid_input);
  EXPECT_EQ(solve(f, X{1}, {0, 1}, Tsitouras5{}, {.rtol_each = {1e-3, 1e-3}}).outcome.ending, Ending::invalid_input);
}

TEST(Outcome, FThatIsNotFiniteAtTheStartSaysSo) {
  const Slope f = [](double, const X& x) { return X{std::log(-x[0])}; };
  const auto solution = solve(f, X{1}, {0, 1}, Tsitouras5{});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite);
  EXPECT_EQ(solution.outcome.t, 0);
}

TEST(Outcome, TheStepLimitHolds) {
  const Slope f = [](double t, const X&) { return X{std::cos(t)}; };
  const auto solution = solve(f, X{0}, {0, 1e6}, Tsitouras5{}, {.max_steps = 100});
  EXPECT_EQ(solution.outcome.ending, Ending::too_many_steps);
  EXPECT_EQ(solution.statistics.steps + solution.statistics.rejected, 100U);
  EXPECT_EQ(solution.t.size(), solution.statistics.steps + 1);
}

// x' = 1/(|t - 2| + 1e-9) takes its steps near 2.
TEST(Outcome, TooManyStepsSayWhereTheyWent) {
  const Slope f = [](double t, const X&) { return X{1 / (std::abs(t - 2) + 1e-9)}; };
  const auto solution = solve(f, X{0}, {0, 10}, Tsitouras5{}, {.rtol = 1e-12, .atol = 1e-12, .max_steps = 2000});
  ASSERT_EQ(solution.outcome.ending, Ending::too_many_steps);
  const std::string& hint = solution.outcome.hint;
  const std::size_t at = hint.find("half of the steps lie between t = ");
  ASSERT_NE(at, std::string::npos) << hint;
  EXPECT_NEAR(std::stod(hint.substr(hint.find("t = ") + 4)), 2, 0.2) << hint;
  EXPECT_NE(hint.find("raise max_steps"), std::string::npos) << hint;
}

TEST(Outcome, AnInterruptKeepsWhatWasComputed) {
  std::atomic<bool> interrupt = false;
  const Slope f = [&interrupt](double t, const X&) {
    if (t > 3) interrupt = true;
    return X{std::cos(t)};
  };
  const auto solution = solve(f, X{0}, {0, 1e9}, Tsitouras5{}, {.interrupt = &interrupt});
  EXPECT_EQ(solution.outcome.ending, Ending::interrupted);
  EXPECT_GT(solution.outcome.t, 2);
  EXPECT_LT(solution.outcome.t, 10);
  EXPECT_EQ(solution.t.back(), solution.outcome.t);
}

// OrdinaryDiffEq.jl#2229: endless rejections. A right-hand side of noise cannot be integrated; it must say so.
TEST(Outcome, NoiseEndsInsteadOfLoopingForEver) {
  unsigned state = 1;
  auto f = [&state](double, const X&) {
    state = state * 1664525U + 1013904223U;
    return X{static_cast<double>(state) / 1e6};
  };
  const auto solution = solve(std::ref(f), X{0}, {0, 1}, Dop853{}, {.rtol = 1e-12, .atol = 1e-14, .max_steps = 100000});
  EXPECT_FALSE(solution.outcome);
}

// DifferentialEquations.jl#924: a tiny last step before the end is not an underflow.
TEST(Outcome, AnIntervalOfNoLengthAndACrumbAreFine) {
  const Slope f = [](double, const X& x) { return x; };
  EXPECT_EQ(solve(f, X{1}, {1, 1}, Tsitouras5{}).outcome.ending, Ending::reached_end);
  const auto crumb = solve(f, X{1}, {1, std::nextafter(1.0, 2.0)}, Tsitouras5{});
  EXPECT_EQ(crumb.outcome.ending, Ending::reached_end);
  EXPECT_EQ(crumb.outcome.t, std::nextafter(1.0, 2.0));
}

TEST(Outcome, DescribesItselfInOneSentence) {
  const Outcome<double> outcome{.ending = Ending::step_too_small,
                                .t = 1,
                                .h = 1e-16,
                                .error = 3,
                                .component = "h'",
                                .hint = "loosen the tolerance"};
  EXPECT_EQ(describe(outcome),
            "step too small at t = 1, h = 1e-16, error 3 tolerances, worst in h'; loosen the tolerance");
}

}  // namespace
}  // namespace continuo::outcome_test
