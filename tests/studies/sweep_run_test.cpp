// Runs of sweeps against single runs and closed forms: values by the number of the run, what is kept of the motion
// between its rows, runs that fail.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::studies {
namespace {

PreparedSweep prepared(const std::string& text, model::Experiment experiment = {}) {
  model::Loaded loaded = model::load(model::Source("model.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  auto made = PreparedSweep::create(*std::move(loaded.model), std::move(experiment));
  EXPECT_TRUE(made) << describe(made.status());
  return *std::move(made);
}

const std::string oscillator =
    "param k = 4\nparam a = 1\nx'' = -k*x\nx(0) = a\nx'(0) = 0\nrun 0..3 tol 1e-11, abs 1e-13\n";

TEST(SweepRun, AGridIsEveryCombinationTheLastAxisFirst) {
  const PreparedSweep sweep = prepared(oscillator + "sweep { k in (1, 2, 3); x(0) from 1 to 2 count 2 }\n");
  ASSERT_EQ(sweep.runs(), 6U);
  EXPECT_EQ(sweep.values(0), (std::vector<double>{1, 1}));
  EXPECT_EQ(sweep.values(1), (std::vector<double>{1, 2}));
  EXPECT_EQ(sweep.values(5), (std::vector<double>{3, 2}));
}

TEST(SweepRun, HasTheBitsOfTheRunWithItsValues) {
  const std::string text = oscillator +
                           "sweep { k uniform(1, 9); x(0) normal(1, 0.2); runs 40 sobol seed 3\n"
                           "  keep x at end, x' at 1.5, x at 0..3 by 0.5 }\n";
  const PreparedSweep sweep = prepared(text);
  for (const std::uint64_t run : {39U, 0U, 17U}) {
    const std::vector<double> values = sweep.values(run);
    const model::Simulated single = model::simulate(*model::load(model::Source("model.sim", text)).model,
                                                    {.parameters = {{"k", values[0]}}, .initial = {{"x", values[1]}}});
    const SweepOutcome outcome = sweep.run(run);
    EXPECT_EQ(outcome.kept[0], single.run->final_state()[0]);
    EXPECT_EQ(sweep.run(run).kept, outcome.kept);
    const double w = std::sqrt(values[0]);
    EXPECT_NEAR(outcome.kept[1], -values[1] * w * std::sin(1.5 * w), 1e-8);
    for (int i = 0; i <= 6; ++i)
      EXPECT_NEAR(outcome.kept[2 + static_cast<std::size_t>(i)], values[1] * std::cos(0.5 * i * w), 1e-8);
  }
}

/// x = a cos(w t) has its extremes where the motion says, wherever the steps end; random members.
TEST(SweepRun, ExtremesAndMeansAreThoseOfTheMotionNotOfItsRows) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0.3, 20);
  for (int tries = 0; tries < 21; ++tries) {
    const double k = any(random), end = any(random), w = std::sqrt(k);
    const std::array<const char*, 3> methods{"dop853", "tsitouras5", "verner7"};
    const PreparedSweep sweep = prepared(fmt::format(
        "param k = 1\nx'' = -k*x\nx(0) = 1\nx'(0) = 0\nrun 0..{} tol 1e-11, abs 1e-13 method {}\n"
        "sweep {{ k in {}\n keep max(x'), min(x), mean(x), mean(x^2), max(abs(x - 0.5)), max(3*x + x') }}\n",
        end, methods[static_cast<std::size_t>(tries % 3)], k));
    const std::vector<double> kept = sweep.run(0).kept;
    const double phase = w * end, pi = std::acos(-1.0);
    // x' = -w sin(w t) is largest at 3 pi/2, x smallest at pi.
    EXPECT_NEAR(kept[0], phase >= 1.5 * pi ? w : std::max(0.0, -w * std::sin(phase)), 1e-8 * w);
    EXPECT_NEAR(kept[1], phase >= pi ? -1 : std::cos(phase), 1e-8);
    EXPECT_NEAR(kept[2], std::sin(phase) / phase, 1e-8);
    EXPECT_NEAR(kept[3], 0.5 + std::sin(2 * phase) / (4 * phase), 1e-8);
    EXPECT_NEAR(kept[4], phase >= pi ? 1.5 : std::max(0.5, 0.5 - std::cos(phase)), 1e-8);
    // 3 cos(p) - w sin(p) = r cos(p + q).
    const double r = std::hypot(3, w), q = std::atan2(w, 3);
    EXPECT_NEAR(kept[5], phase + q >= 2 * pi ? r : std::max(3.0, r * std::cos(phase + q)), 1e-8 * r);
  }
}

TEST(SweepRun, JumpsOfEventsCountForExtremes) {
  const PreparedSweep sweep = prepared(
      "param v = 1\nh'' = -10\nh(0) = 5\nh'(0) = 0\nwhen h falls through 0 { h' := -v*h' }\nrun 0..1.5\n"
      "sweep { v in (0.5, 0.8)\n keep max(h'), min(h'), time of event 1 as landing, count of events, h' after event 1 "
      "}\n");
  const SweepOutcome outcome = sweep.run(1);
  EXPECT_NEAR(outcome.kept[0], 8, 1e-6);
  EXPECT_NEAR(outcome.kept[1], -10, 1e-6);
  EXPECT_NEAR(outcome.kept[2], 1, 1e-7);
  EXPECT_EQ(outcome.kept[3], 1);
  EXPECT_NEAR(outcome.kept[4], 8, 1e-6);
}

TEST(SweepRun, ARunThatFailsIsAnOutcomeAndSoIsAnEventThatNeverCame) {
  const PreparedSweep sweep = prepared(
      "param a = 1\nx' = x^2\nx(0) = a\nwhen x rises through 1.5 { mark \"half\" }\nrun 0..1\n"
      "sweep { a in (0.2, 0.9, 2)\n keep x at end, max(x), time of event 1 as half }\n");
  const SweepOutcome fine = sweep.run(0), passes = sweep.run(1), fails = sweep.run(2);
  EXPECT_NEAR(fine.kept[0], 0.25, 1e-5);
  EXPECT_TRUE(std::isnan(fine.kept[2]));
  EXPECT_NEAR(passes.kept[2], 1 / 0.9 - 1 / 1.5, 1e-5);
  EXPECT_FALSE(succeeded(fails.ending));
  EXPECT_FALSE(fails.message.empty());
  EXPECT_NEAR(fails.t, 0.5, 1e-3);
  EXPECT_TRUE(std::ranges::all_of(fails.kept, [](double value) { return std::isnan(value); }));
}

TEST(SweepRun, InputsBodiesAndSizesCanBeVaried) {
  const PreparedSweep input = prepared("input u = 1\nx' = u\nx(0) = 0\nrun 0..2\nsweep { u in (3, 4) }\n");
  EXPECT_NEAR(input.run(1).kept[0], 8, 1e-12);
  const PreparedSweep body = prepared(
      "world {\n  dimension 2\n  gravity (0, -10)\n  body ball at (0, 10) radius 1 mass 1\n  wall floor (0, 1) at "
      "0\n}\n"
      "run 0..2\nsweep { ball.y(0) in (6, 13.8)\n  keep time of event 1 of \"ball meets floor\" as landing, "
      "min(ball.y) }\n");
  EXPECT_NEAR(body.run(0).kept[0], 1, 1e-9);
  EXPECT_NEAR(body.run(1).kept[0], 1.6, 1e-9);
  EXPECT_NEAR(body.run(0).kept[1], 1, 1e-6);
  const PreparedSweep size = prepared(
      "param n = 2\nfor i in 1..n { u[i]' = i\n  u[i](0) = 0 }\nrun 0..1\nsweep { n in (2, 5)\n  keep sum(i in 1..n: "
      "u[i]) at end as all }\n");
  EXPECT_TRUE(size.decides_size());
  EXPECT_NEAR(size.run(0).kept[0], 3, 1e-12);
  EXPECT_NEAR(size.run(1).kept[0], 15, 1e-12);
}

/// In the language lognormal has a median and the deviation of the logarithm.
TEST(SweepRun, DistributionsAreThoseOfTheLanguage) {
  const PreparedSweep sweep =
      prepared(oscillator + "sweep { k lognormal(4, 0.25); a normal(2, 0.5); runs 20001 latin_hypercube seed 1 }\n");
  std::vector<double> k, a;
  for (std::uint64_t run = 0; run < sweep.runs(); ++run)
    k.push_back(sweep.values(run)[0]), a.push_back(sweep.values(run)[1]);
  std::ranges::sort(k), std::ranges::sort(a);
  // One value lies in each of 20001 parts: the quantiles are off by less than one part.
  EXPECT_NEAR(k[10000], 4, 4 * 0.25 * 2e-4);
  EXPECT_NEAR(k[static_cast<std::size_t>(0.8413447460685429 * 20001)], 4 * std::exp(0.25), 2e-3);
  EXPECT_NEAR(a[static_cast<std::size_t>(0.8413447460685429 * 20001)], 2.5, 1e-3);
}

}  // namespace
}  // namespace continuo::studies
