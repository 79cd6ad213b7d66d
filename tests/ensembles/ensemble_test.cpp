// Ensembles against closed forms, and what happens to runs that fail, to callbacks and to wrong input.
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/ensembles/ensemble.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>

namespace continuo::ensembles_test {
namespace {

using One = std::array<double, 1>;
using Two = std::array<double, 2>;

// x' = r x (1 - x); its flow brings neighbours together for x > 1/2, and parts them by e^(r t) at most before that.
const auto logistic = [](const auto&, const auto& x, auto& dxdt, const auto& p) { dxdt[0] = p[0] * x[0] * (1 - x[0]); };
double logistic_at(double t, double x0, double r) {
  return 1 / (1 + (1 / x0 - 1) * std::exp(-r * t));
}

TEST(Ensemble, MeetsTheClosedFormWhateverTheNumberOfRuns) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{50}}) {
    const auto rate = [](std::size_t run) { return 0.5 + 0.01 * static_cast<double>(run); };
    const auto result =
        ensemble(logistic, starts(count, [&](std::size_t run) { return RunStart{One{0.1}, One{rate(run)}}; }), {0, 3},
                 Dop853{}, {.rtol = 1e-11, .atol = 1e-13, .save_at = {1, 2}});
    ASSERT_EQ(result.runs.size(), count);
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(result.failures(), 0U);
    for (std::size_t run = 0; run < count; ++run) {
      EXPECT_EQ(result.runs[run].run, run);
      EXPECT_EQ(result.runs[run].outcome.t, 3);
      EXPECT_NEAR(result.runs[run].x[0], logistic_at(3, 0.1, rate(run)), 1e-9);
      ASSERT_EQ(result.runs[run].rows.size(), 2U);
      EXPECT_NEAR(result.runs[run].rows[1][0], logistic_at(2, 0.1, rate(run)), 1e-9);
    }
  }
}

TEST(Ensemble, TakesStartsWithoutParametersAndFunctionsThatReturn) {
  const auto decay = [](const auto&, const auto& x) { return std::array{-x[0]}; };
  const auto result = ensemble<4>(decay, std::vector<One>{{1}, {2}, {3}}, {0, 1}, Tsitouras5{}, {.rtol = 1e-9});
  for (std::size_t run = 0; run < 3; ++run)
    EXPECT_NEAR(result.runs[run].x[0], static_cast<double>(run + 1) * std::exp(-1), 1e-7);
}

// p: gravity, restitution, bounces so far.
using Ball = RunStart<Two, std::array<double, 3>>;
const auto ball = [](const auto&, const auto& x, auto& dxdt, const auto& p) {
  dxdt[0] = x[1];
  dxdt[1] = -p[0];
};
const auto floor_of_ball = falls(
    "floor", [](const auto&, const auto& x) { return x[0]; },
    [](auto& now, auto& p) {
      now.x[0] = 0;
      now.x[1] = -p[1] * now.before[1];
      p[2] += 1;
      now.stop = p[2] == 5;
    });

TEST(Ensemble, BallsLandAtTheTimesOfTheClosedForm) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> height(0.1, 20), gravity(1, 20), restitution(0.3, 0.95);
  std::vector<Ball> list(100);
  for (Ball& one : list) one = {{height(generator), 0}, {gravity(generator), restitution(generator), 0}};
  const auto result = ensemble<8>(ball, list, {0, 1000}, Tsitouras5{}, {}, floor_of_ball);
  for (std::size_t run = 0; run < list.size(); ++run) {
    const auto& [h, g, e] = std::tuple{list[run].x[0], list[run].p[0], list[run].p[1]};
    double t = std::sqrt(2 * h / g), flight = 2 * t;
    ASSERT_EQ(result.runs[run].events.size(), 5U);
    for (const auto& landing : result.runs[run].events) {
      EXPECT_NEAR(landing.t, t, 1e-10);
      flight *= e;
      t += flight;
    }
    EXPECT_EQ(result.runs[run].outcome.ending, Ending::stopped_by_event);
    EXPECT_EQ(result.runs[run].outcome.event, "floor");
    EXPECT_EQ(result.runs[run].p[2], 5);
  }
}

TEST(Ensemble, ARunThatFailsIsAResultAndTheOthersGoOn) {
  // x' = x^2 from 1 / p grows without bound at t = p.
  const auto square = [](const auto&, const auto& x, auto& dxdt) { dxdt[0] = x[0] * x[0]; };
  const auto result =
      ensemble<4>(square, starts(20, [](std::size_t run) { return One{1 / (0.155 + 0.1 * static_cast<double>(run))}; }),
                  {0, 1}, Dop853{}, {.rtol = 1e-10, .threads = 2});
  for (std::size_t run = 0; run < 20; ++run) {
    const double end = 0.155 + 0.1 * static_cast<double>(run);
    if (end < 1) {
      EXPECT_FALSE(result.runs[run].outcome);
      EXPECT_NEAR(result.runs[run].outcome.t, end, 1e-6);
      EXPECT_FALSE(describe(result.runs[run].outcome).empty());
    } else {
      EXPECT_NEAR(result.runs[run].x[0] * (end - 1), 1, 1e-7);
    }
  }
  EXPECT_EQ(result.failures(), 9U);
}

TEST(Ensemble, ASlowRunHasItsOwnLimitOfSteps) {
  const auto oscillator = [](const auto&, const auto& x, auto& dxdt, const auto& p) {
    dxdt[0] = p[0] * x[1];
    dxdt[1] = -p[0] * x[0];
  };
  const auto result =
      ensemble<4>(oscillator, starts(6, [](std::size_t run) { return RunStart{Two{1, 0}, One{run == 2 ? 1e6 : 1.0}}; }),
                  {0, 1}, Tsitouras5{}, {.max_steps = 500});
  for (std::size_t run = 0; run < 6; ++run)
    EXPECT_EQ(result.runs[run].outcome.ending, run == 2 ? Ending::too_many_steps : Ending::reached_end);
  EXPECT_EQ(result.runs[2].steps + result.runs[2].rejected, 500U);
}

TEST(Ensemble, ARunOfNoLengthEndsAtOnce) {
  const auto result = ensemble(logistic, starts(5, [](std::size_t) { return RunStart{One{0.5}, One{1.0}}; }), {2, 2},
                               Dop853{}, {.save_at = {2}});
  for (const auto& run : result.runs) {
    EXPECT_TRUE(run.outcome);
    EXPECT_EQ(run.x[0], 0.5);
    EXPECT_EQ(run.rows.size(), 1U);
  }
}

TEST(Ensemble, ResultsAreDeliveredInOrderAndKeptNowhereElse) {
  // The first run is by far the longest, and there are more others than may wait for it.
  std::size_t next = 0;
  const auto rotation = [](const auto&, const auto& x, auto& dxdt, const auto& p) {
    dxdt[0] = p[0] * x[1];
    dxdt[1] = -p[0] * x[0];
  };
  const auto result = ensemble<2>(
      rotation, starts(6000, [](std::size_t run) { return RunStart{Two{1, 0}, One{run == 0 ? 4e3 : 0.1}}; }), {0, 1},
      Tsitouras5{}, {.rtol = 1e-3, .atol = 1e-3, .threads = 2, .finished = [&](const RunResult<Two, One>& one) {
                       EXPECT_EQ(one.run, next++);
                     }});
  EXPECT_EQ(next, 6000U);
  EXPECT_TRUE(result.runs.empty());
  EXPECT_TRUE(result.complete);
}

TEST(Ensemble, ACallbackAndAnInterruptEndIt) {
  const auto make = starts(5000, [](std::size_t) { return RunStart{One{0.5}, One{1.0}}; });
  std::size_t seen = 0;
  const auto result = ensemble(logistic, make, {0, 1}, Tsitouras5{},
                               {.threads = 2, .finished = [&](const RunResult<One, One>&) { return ++seen < 7; }});
  EXPECT_EQ(seen, 7U);
  EXPECT_FALSE(result.complete);

  const std::atomic<bool> interrupt = true;
  const auto none = ensemble(logistic, make, {0, 1}, Tsitouras5{}, {.threads = 2, .interrupt = &interrupt});
  EXPECT_FALSE(none.complete);
  ASSERT_EQ(none.runs.size(), 5000U);
  EXPECT_EQ(none.failures(), 5000U);
  EXPECT_EQ(none.runs[17].outcome.ending, Ending::interrupted);
}

TEST(Ensemble, AnExceptionOfAFunctionReachesTheCaller) {
  const auto make = starts(1000, [](std::size_t run) {
    if (run == 500) throw std::runtime_error("no start");
    return RunStart{One{0.5}, One{1.0}};
  });
  for (const int threads : {1, 2})
    EXPECT_THROW(static_cast<void>(ensemble(logistic, make, {0, 1}, Tsitouras5{}, {.threads = threads})),
                 std::runtime_error);
}

TEST(Ensemble, WrongInputIsNamed) {
  const auto make = starts(3, [](std::size_t) { return RunStart{One{0.5}, One{1.0}}; });
  const auto hint = [&](const EnsembleOptions<One, One>& options, Interval<double> interval, const auto&... events) {
    const auto result = ensemble(logistic, make, interval, Tsitouras5{}, options, events...);
    EXPECT_EQ(result.failures(), 3U);
    EXPECT_EQ(result.runs[2].outcome.ending, Ending::invalid_input);
    return result.runs[2].outcome.hint;
  };
  EXPECT_NE(hint({.rtol = -1}, {0, 1}).find("rtol"), std::string::npos);
  EXPECT_NE(hint({.save_at = {7}}, {0, 1}).find("lies outside of the run"), std::string::npos);
  EXPECT_NE(hint({.rtol_each = {1, 2}}, {0, 1}).find("one for each"), std::string::npos);
  EXPECT_NE(hint({}, {0, HUGE_VAL}).find("not finite"), std::string::npos);
  EXPECT_NE(hint({}, {0, 1}, every("tick", -1.0, 0.0, [](auto&) {})).find("period"), std::string::npos);

  using Vector = std::vector<double>;
  const std::vector<RunStart<Vector>> sizes{{{1.0}}, {{1.0, 2.0}}, {{3.0}}};
  const auto result =
      ensemble([](const auto&, const auto& x, auto& dxdt) { dxdt[0] = -x[0]; }, sizes, {0, 1}, Tsitouras5{});
  EXPECT_EQ(result.failures(), 1U);
  EXPECT_NE(result.runs[1].outcome.hint.find("another number of components"), std::string::npos);
}

}  // namespace
}  // namespace continuo::ensembles_test
