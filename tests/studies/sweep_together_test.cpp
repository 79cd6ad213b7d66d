// Runs of a sweep that go together against the same runs one by one, bit by bit: random systems by every method that
// can, whatever their number, neighbours and order, those that fail among them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/studies/sweep_comparison.hpp>
#include <tests/symbolic/native_referee.hpp>

#include <continuo/language/load.hpp>
#include <continuo/simulation/native.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::studies::sweep_together_test {
namespace {

std::vector<SweepOutcome> together(const PreparedSweep& sweep, const std::vector<std::uint64_t>& runs) {
  std::vector<SweepOutcome> outcomes;
  sweep.run_each(runs, [&](SweepOutcome outcome) {
    outcomes.push_back(std::move(outcome));
    return true;
  });
  return outcomes;
}

std::vector<std::uint64_t> all_runs(const PreparedSweep& sweep) {
  std::vector<std::uint64_t> runs(sweep.runs());
  std::iota(runs.begin(), runs.end(), std::uint64_t{0});
  return runs;
}

void expect_the_runs_one_by_one(const PreparedSweep& sweep, const std::vector<std::uint64_t>& runs) {
  const std::vector<SweepOutcome> outcomes = together(sweep, runs);
  ASSERT_EQ(outcomes.size(), runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    SCOPED_TRACE(fmt::format("run {}", runs[i]));
    expect_same_outcome(outcomes[i], sweep.run(runs[i]));
  }
}

constexpr const char* readings =
    "keep x1 at end, c*x1 + a at 1.25, x1 at 4, x1 at 0, time of end, count of events,\n"
    "    max(x1), min(x1*b), mean(x1), x1 at 0..4 by 0.4";
/// Nobody looks at a step.
constexpr const char* readings_at_end = "keep x1 at end, c*x1 + a at end, time of end";

/// A system of one to five states, with terms of every kind; some of its runs end before their time.
std::string random_model(std::mt19937& random, const std::string& how, const std::string& keep = readings) {
  std::uniform_real_distribution<double> any(-1, 1);
  const auto n = static_cast<int>(1 + random() % 5);
  const auto x = [&] { return fmt::format("x{}", 1 + random() % static_cast<unsigned>(n)); };
  const auto term = [&]() -> std::string {
    switch (random() % 9) {
      case 0:
        return fmt::format("a*{}*{}", x(), x());
      case 1:
        return fmt::format("sin({} + b)", x());
      case 2:
        return fmt::format("{}/(1 + {}^2)", x(), x());
      case 3:
        return fmt::format("exp(-{}^2)", x());
      case 4:
        return fmt::format("b*{}", x());
      case 5:
        return fmt::format("c*cos(2*t)*{}", x());
      case 6:
        return fmt::format("{}*{}*{}", any(random), x(), x());
      case 7:
        return fmt::format("sqrt(1 + {}^2)*tanh({})", x(), x());
      default:
        return fmt::format("atan2({}, 2 + {}^2)", x(), x());
    }
  };
  std::string text = "param a = 0.5\nparam b = 1\nparam c = a + b/3\n";
  for (int i = 1; i <= n; ++i) {
    text += fmt::format("x{}' = -0.3*x{}", i, i);
    for (unsigned k = 0; k < 1 + random() % 3; ++k) text += " + " + term();
    text += fmt::format("\nx{}(0) = {}{}\n", i, any(random), i == 1 ? " + 0.1*b" : "");
  }
  return text + "run 0..4 " + how +
         "\nsweep { a uniform(-1, 1.5); b normal(1, 0.5); x1(0) in (0.1, -0.5, 1, 2)\n  runs 27 sobol seed 3\n  " +
         keep + " }\n";
}

TEST(SweepTogether, RandomSystemsHaveTheBitsOfTheirRunsOneByOne) {
  const std::vector<std::string> ways = {
      "method dop853 tol 1e-8",  "method tsitouras5 tol 1e-6",          "method verner9 tol 1e-11, abs 1e-11",
      "method verner7 tol 1e-7", "method dormand_prince5 tol 1e-3",     "method bogacki_shampine3 tol 1e-4",
      "method rk4 step 0.01",    "method dop853 tol 1e-5 max step 0.1", "method tsitouras5 step 0.03",
      "method rodas5p tol 1e-7", "method rodas5p tol 1e-4, abs 1e-9",   "method rodas5p step 0.05"};
  for (unsigned seed = 0; seed < 24; ++seed) {
    std::mt19937 random(seed);
    const std::string text = random_model(random, ways[seed % ways.size()]);
    SCOPED_TRACE(text);
    const PreparedSweep sweep = prepared_sweep(text);
    EXPECT_TRUE(sweep.goes_together());
    expect_the_runs_one_by_one(sweep, all_runs(sweep));
  }
}

TEST(SweepTogether, RunsWithoutANamedMethodHaveTheBitsOfTheRunsOneByOne) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    std::mt19937 random(seed);
    const PreparedSweep sweep = prepared_sweep(random_model(random, seed % 2 == 0 ? "tol 1e-6" : "tol 1e-9"));
    expect_the_runs_one_by_one(sweep, all_runs(sweep));
  }
}

/// A reaction, slopes that are infinite at the start (in x, in t), an input that follows a table, runs that fail, and
/// more states than lanes take for a stiff method.
TEST(SweepTogether, StiffRunsHaveTheBitsOfTheRunsOneByOne) {
  const model::TestFolder folder;
  const std::string table = (folder.path / "u.csv").string();
  std::ofstream(table) << "t,u\n0,1\n0.5,-2\n1.25,3\n2,0\n";
  const std::vector<std::string> texts = {
      "param k = 1\nparam c = 1e4\nx' = c*y*z - 0.04*k*x\nz' = 3e7*y^2\ny' = 0.04*k*x - c*y*z - 3e7*y^2\n"
      "x(0) = 1\ny(0) = 0\nz(0) = 0\nrun 0..1e5 method rodas5p tol 1e-5, abs 1e-9\n"
      "sweep { k in (0.5, 1, 2, 3); c in (1e4, 3e4, 5e3)\n  keep x at end, max(y), z at 7 }\n",
      "param k = 1\nx' = y - k*sqrt(x)\ny' = 100*k*(cos(t) - y)\nx(0) = 0\ny(0) = 0\nrun 0..2 method rodas5p\n"
      "sweep { k in (0.1, 1, 10, 100, 1000, 3e4, 3, 0, 7)\n  keep x at end, mean(y), x at 0.5 }\n",
      "param k = 1\nx' = k*(sqrt(t) - x)\ny' = -k*y\nx(0) = 1\ny(0) = k\nrun 0..2 method rodas5p tol 1e-5\n"
      "sweep { k in (0, 1, 10, 100, 1000, 3e4, 3, 7, 1e7)\n  keep x at end, max(x), y at end }\n",
      "param k = 1\nx' = k*x^2 - 500*y\ny' = x - 1000*k*y\nx(0) = 1\ny(0) = 0\nrun 0..2 method rodas5p max steps 200\n"
      "sweep { k from 0 to 3 count 20\n  keep x at end, y at end }\n",
      "param k = 1\ninput u = 0 from \"" + table +
          "\"\nx' = k*(u - x)\ny' = x - y\nx(0) = 1\ny(0) = k\nrun 0..2 method rodas5p tol 1e-5\n"
          "sweep { k in (0, 1, 10, 100, 1000, 3e4, 3, 7, 1e7)\n  keep x at end, max(x), y at end }\n",
      "param k = 1\nfor i in 1..30 { u[i](0) = i/30 }\nfor i in 2..29 { u[i]' = k*(u[i-1] - 2*u[i] + u[i+1]) }\n"
      "u[1]' = -u[1]\nu[30]' = sin(u[29])\nrun 0..1 method rodas5p tol 1e-5\n"
      "sweep { k in (1, 100, 1e4)\n  keep u[3] at end }\n"};
  for (const std::string& text : texts) {
    SCOPED_TRACE(text);
    const PreparedSweep sweep = prepared_sweep(text);
    expect_the_runs_one_by_one(sweep, all_runs(sweep));
  }
}

/// Decays and oscillations from slow to so fast that the stiff method takes over, at once or on the way; and one that
/// turns hundreds of times, of which the pair asks more.
TEST(SweepTogether, RunsThatBecomeStiffEndAsTheyDoAlone) {
  for (const char* tolerance : {"tol 1e-4", "tol 1e-8"}) {
    expect_the_runs_one_by_one(
        prepared_sweep(fmt::format("param k = 1\nx' = y\ny' = k*(1 - x^2)*y - x\nx(0) = 2\ny(0) = 0\n"
                                   "run 0..20 {}\nsweep {{ k in (0.1, 1, 5, 20, 100, 1000, 3, 300)\n"
                                   "  keep x at end, mean(x), x at 7 }}\n",
                                   tolerance)),
        {0, 1, 2, 3, 4, 5, 6, 7});
    expect_the_runs_one_by_one(
        prepared_sweep(
            fmt::format("param w = 1\nparam k = 1\nx' = w*y\ny' = -w*x\nz' = k*(cos(t) - z)\nx(0) = 1\ny(0) = 0\n"
                        "z(0) = 0\nrun 0..30 {}\nsweep {{ w in (0.5, 3, 40); k in (1, 30, 1000, 1e6)\n"
                        "  keep x at end, z at end, max(x) }}\n",
                        tolerance)),
        {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  }
}

/// Machine code takes whole steps. The runs one by one are made without any.
void expect_the_same_by_machine_code(const std::string& text, const model::Experiment& experiment,
                                     const std::shared_ptr<model::NativeCompiler>& native) {
  SCOPED_TRACE(text);
  const PreparedSweep sweep = prepared_sweep(text, experiment), compiled = prepared_sweep(text, experiment, native);
  const std::vector<SweepOutcome> outcomes = together(compiled, all_runs(compiled));
  ASSERT_EQ(outcomes.size(), sweep.runs());
  for (std::uint64_t run = 0; run < sweep.runs(); ++run) expect_same_outcome(outcomes[run], sweep.run(run));
}

TEST(SweepTogether, StepsByMachineCodeHaveTheBitsOfTheRunsOneByOne) {
  const model::TestFolder folder;
  const auto native =
      std::make_shared<model::NativeCompiler>(model::NativeOptions{model::NativeUse::always, folder.path / "cache"});
  const std::vector<std::string> ways = {"method dop853 tol 1e-8",  "method tsitouras5 tol 1e-6",
                                         "method verner7 tol 1e-7", "method bogacki_shampine3 tol 1e-4",
                                         "method rk4 step 0.01",    "method dormand_prince5 step 0.03",
                                         "method rodas5p tol 1e-6"};
  for (unsigned seed = 0; seed < ways.size(); ++seed) {
    std::mt19937 random(seed);
    expect_the_same_by_machine_code(random_model(random, ways[seed]), {}, native);
  }
  // With a tolerance for each state, some runs that fail, and nobody who sees the motion between the steps.
  expect_the_same_by_machine_code(
      "param k = 1\nx' = k*x^2 - y\ny' = x + sin(3*t)\nx(0) = 1\ny(0) = 0\nrun 0..2 method dop853 tol 1e-6\n"
      "sweep { k from 0 to 2 count 20\n  keep x at end, y at end }\n",
      {.rtol_of = {{"y", 1e-9}}, .atol_of = {{"x", 1e-10}}}, native);
  // More states than are written out one by one, in a family, which is a loop.
  expect_the_same_by_machine_code(
      "param k = 1\nfor i in 1..14 { u[i](0) = i/14 }\nfor i in 2..13 { u[i]' = k*(u[i-1] - 2*u[i] + u[i+1]) }\n"
      "u[1]' = -u[1]\nu[14]' = sin(u[13])\nrun 0..1 method tsitouras5 tol 1e-7\n"
      "sweep { k from 0.1 to 2 count 20\n  keep u[3] at end, max(u[7]) }\n",
      {}, native);
  EXPECT_EQ(native->report().trouble, "");
  EXPECT_GE(native->report().compiled, ways.size());
}

/// Machine code takes many steps of two groups of runs at a time where nobody looks at them. Some of the runs reject
/// steps, fail, have steps of a limited length, or too many of them.
TEST(SweepTogether, ManyStepsByMachineCodeHaveTheBitsOfTheRunsOneByOne) {
  const model::TestFolder folder;
  const auto native =
      std::make_shared<model::NativeCompiler>(model::NativeOptions{model::NativeUse::always, folder.path / "cache"});
  const std::vector<std::string> ways = {"method tsitouras5 tol 1e-7", "method dop853 tol 1e-9",
                                         "method bogacki_shampine3 tol 1e-3 max step 0.01"};
  for (unsigned seed = 0; seed < ways.size(); ++seed) {
    std::mt19937 random(seed + 40);
    expect_the_same_by_machine_code(random_model(random, ways[seed], readings_at_end), {}, native);
  }
  expect_the_same_by_machine_code(
      "param a = 0\nparam b = 1\nx' = a*x^2 + 0*sqrt(b - t)\ny' = -300*a*(y - cos(t))\nx(0) = 1\ny(0) = 2\n"
      "run 0..1 method tsitouras5 tol 1e-6 max steps 150\n"
      "sweep { a in (0, 0.5, 0.9, 1, 1.1, 3); b in (2, 0.5, 1, -1, 7, 1.5)\n  keep x at end, y at end }\n",
      {.rtol_of = {{"y", 1e-9}}, .atol_of = {{"x", 1e-10}}}, native);
  EXPECT_EQ(native->report().trouble, "");
}

/// Fused operations: other bits than those of the tape, and the same together and alone.
TEST(SweepTogether, FusedRunsHaveTheBitsOfTheFusedRunsOneByOne) {
  if (!model::has_fused_operations()) GTEST_SKIP() << model::why_not(model::NativeUse::fused);
  const model::TestFolder folder;
  const auto native =
      std::make_shared<model::NativeCompiler>(model::NativeOptions{model::NativeUse::fused, folder.path / "cache"});
  std::vector<std::string> texts;
  const std::vector<std::string> ways = {"method dop853 tol 1e-8", "tol 1e-7", "method rk4 step 0.01"};
  for (unsigned seed = 0; seed < ways.size(); ++seed) {
    std::mt19937 random(seed + 60);
    texts.push_back(random_model(random, ways[seed], seed == 0 ? readings_at_end : readings));
  }
  // More states than are written out one by one, without a family.
  std::string ring = "param k = 1\n";
  for (int i = 1; i <= 10; ++i)
    ring += fmt::format("x{0}' = k*x{1} - {2}*x{0}*x{3}\nx{0}(0) = {0}/10\n", i, i % 10 + 1, 0.1 * i, (i + 3) % 10 + 1);
  texts.push_back(ring + "run 0..2 method tsitouras5 tol 1e-8\nsweep { k from 0.1 to 1 count 20\n  keep x3 at end }\n");
  std::size_t others = 0;
  for (const std::string& text : texts) {
    SCOPED_TRACE(text);
    const PreparedSweep fused = prepared_sweep(text, {}, native), sweep = prepared_sweep(text);
    expect_the_runs_one_by_one(fused, all_runs(fused));
    const SweepOutcome plain = sweep.run(0), other = fused.run(0);
    others += model::bits(plain.kept[0]) != model::bits(other.kept[0]) ? 1 : 0;
    EXPECT_NE(fused.identity(), sweep.identity());
  }
  EXPECT_GT(others, texts.size() / 2);
  EXPECT_EQ(native->report().trouble, "");
}

/// x' = a*x^2 from 1 ends at 1/a, the root of a negative number is none, and steps can be too many.
TEST(SweepTogether, RunsThatFailDisturbNoOther) {
  const PreparedSweep sweep = prepared_sweep(
      "param a = 0\nparam b = 1\nx' = a*x^2 + 0*sqrt(b - t)\nx(0) = 1\nrun 0..1 method dop853 max steps 400\n"
      "sweep { a in (0, 0.5, 0.9, 1, 1.1, 3); b in (2, 0.5, 1, -1, 7)\n  keep x at end, max(x), x at 0.25 }\n");
  const std::vector<SweepOutcome> outcomes = together(sweep, all_runs(sweep));
  std::size_t failures = 0;
  for (const SweepOutcome& outcome : outcomes) failures += succeeded(outcome.ending) ? 0 : 1;
  EXPECT_GT(failures, 8U);
  EXPECT_LT(failures, 24U);
  expect_the_runs_one_by_one(sweep, all_runs(sweep));
}

/// A run that stiffness slows is foreseen to be endless after thousands of steps, and not by its lane.
TEST(SweepTogether, RunsWithTooManyStepsEndAsTheyDoAlone) {
  const PreparedSweep sweep = prepared_sweep(
      "param k = 1\nx' = k*(cos(t) - x)\nx(0) = 2\nrun 0..50 method tsitouras5 tol 1e-4 max steps 3000\n"
      "sweep { k in (1, 10, 100, 300, 1000, 1e4, 1e5, 1e7, 1e9, 3)\n  keep x at end, mean(x) }\n");
  const std::vector<SweepOutcome> outcomes = together(sweep, all_runs(sweep));
  EXPECT_TRUE(succeeded(outcomes[0].ending));
  EXPECT_EQ(outcomes[8].ending, Ending::too_many_steps);
  expect_the_runs_one_by_one(sweep, all_runs(sweep));
}

TEST(SweepTogether, NeitherOrderNorNeighboursNorTheirNumberMatter) {
  std::mt19937 random(7);
  const PreparedSweep sweep = prepared_sweep(random_model(random, "method dop853 tol 1e-7"));
  for (const std::size_t count : {1U, 2U, 3U, 7U, 8U, 9U, 26U}) {
    std::vector<std::uint64_t> runs = all_runs(sweep);
    std::ranges::shuffle(runs, random);
    runs.resize(count);
    expect_the_runs_one_by_one(sweep, runs);
  }
}

TEST(SweepTogether, WhatIsVariedMayChangeTheEndAndTheSteps) {
  for (const char* how :
       {"run 0..T method dop853", "run 0..2 step T/100 method rk4", "run 0..T + 1 max step T/10 method tsitouras5"}) {
    SCOPED_TRACE(how);
    const PreparedSweep sweep = prepared_sweep(fmt::format(
        "param T = 1\nparam k = 1\ninput u = 0\nx'' = -k*x + u\nx(0) = k\nx'(0) = 0\n{}\n"
        "sweep {{ T in (1, 1, 2); k in (1, 4, 9); u in (0, 1)\n  keep x at end, x at T, max(x), time of end }}\n",
        how));
    expect_the_runs_one_by_one(sweep, all_runs(sweep));
  }
}

/// Runs of one plan: what is varied decides other values at the start, or none.
TEST(SweepTogether, StartsFollowWhatIsVaried) {
  for (const char* varied : {"k in (1, 2, 3)", "c in (1, 2, 3)", "u in (0, 1)", "y(0) in (1, 2)",
                             "u in (0, 1); x(0) in (4, 5)", "c in (1, 2); k in (1, 3); y(0) in (0, 1)"}) {
    SCOPED_TRACE(varied);
    const PreparedSweep sweep = prepared_sweep(fmt::format(
        "param k = 1\nparam c = 2*k\nparam d = c + 1\ninput u = 0.5\nx' = -d*x + u\ny' = x - k*y\n"
        "x(0) = c + u\ny(0) = 3\nrun 0..1 method dop853\nsweep {{ {}\n  keep x at end, y at 0, d*x at end }}\n",
        varied));
    expect_the_runs_one_by_one(sweep, all_runs(sweep));
  }
}

TEST(SweepTogether, EndsWhereNoMoreRunsAreWanted) {
  std::mt19937 random(9);
  const PreparedSweep sweep = prepared_sweep(random_model(random, "method tsitouras5"));
  std::vector<SweepOutcome> outcomes;
  sweep.run_each(all_runs(sweep), [&](SweepOutcome outcome) {
    outcomes.push_back(std::move(outcome));
    return outcomes.size() < 5;
  });
  ASSERT_EQ(outcomes.size(), 5U);
  for (std::uint64_t run = 0; run < 5; ++run) expect_same_outcome(outcomes[run], sweep.run(run));
}

/// Models whose runs are made one by one: events, jumps, a method that has no lanes or is chosen.
TEST(SweepTogether, OtherModelsAreRunOneByOne) {
  const std::string end = "sweep { k in (1, 2, 3) }\n";
  for (const std::string& text :
       {"param k = 1\nx' = -k\nx(0) = 1\nwhen x falls through 0 { stop }\nrun 0..9 method dop853\n" + end,
        "param k = 1\nx' = -k*sign(x)\nx(0) = 1\nrun 0..3 method dop853\n" + end,
        "param k = 1\nx' = -k*x\nx(0) = 1\nat 1 { x := k }\nrun 0..3 method dop853\n" + end,
        "param k = 1\nx' = -k*x\nx(0) = 1\nrun 0..3 method radau\n" + end,
        "param k = 1\nx' = -k*x\nx(0) = 1\nrun 0..3\n" + end}) {
    SCOPED_TRACE(text);
    const PreparedSweep sweep = prepared_sweep(text);
    expect_the_runs_one_by_one(sweep, all_runs(sweep));
  }
}

}  // namespace
}  // namespace continuo::studies::sweep_together_test
