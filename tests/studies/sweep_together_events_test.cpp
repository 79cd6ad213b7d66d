// Runs of models with events that go together against the same runs one by one, bit by bit: random models with modes,
// schedules, counters, chains of events and events that accumulate, by every method that can.
#include <cstdint>
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

namespace continuo::studies::sweep_together_events_test {
namespace {

/// All runs of `sweep` against those of `alone`, one by one. The events that have happened, in all.
double expect_the_runs_one_by_one(const PreparedSweep& sweep, const PreparedSweep& alone, std::size_t count_is_kept) {
  std::vector<std::uint64_t> runs(sweep.runs());
  std::iota(runs.begin(), runs.end(), std::uint64_t{0});
  double events = 0;
  std::size_t next = 0;
  sweep.run_each(runs, [&](const SweepOutcome& outcome) {
    SCOPED_TRACE(fmt::format("run {}", next));
    const SweepOutcome expected = alone.run(runs[next++]);
    expect_same_outcome(outcome, expected);
    if (expected.kept[count_is_kept] > 0) events += expected.kept[count_is_kept];
    return true;
  });
  EXPECT_EQ(next, runs.size());
  return events;
}

/// Writes models at random.
class Writer {
 public:
  explicit Writer(unsigned seed) : random_(seed), states_(1 + below(4)), modes_(1 + below(3)) {}

  std::string model(const std::string& how) {
    std::string text = "param a = 0.5\nparam b = 1\n";
    for (unsigned i = 1; i <= states_; ++i) {
      const std::string rest = fmt::format(" - 0.2*x{} + {}\n", i, term());
      if (i == 1 && modes_ > 1) {
        for (unsigned m = 1; m <= modes_; ++m)
          text += fmt::format("mode m{} {{ x1' = {} - 0.2*x1 + {} }}\n", m, term(), term());
      } else {
        text += fmt::format("x{}' = {}{}", i, term(), rest);
      }
      text += fmt::format("x{}(0) = {:.3f}{}\n", i, number(-1, 1), i == 1 ? " + 0.1*b" : "");
    }
    text += "n' = 0\nn(0) = 0\n";
    for (unsigned k = 0; k < 1 + below(4); ++k) text += event();
    return text + "run 0..4 " + how +
           "\nsweep { a uniform(-1, 1.5); b normal(1, 0.5); x1(0) in (0.1, -0.5, 1, 0)\n  runs 21 sobol seed 3\n"
           "  keep count of events, x1 at end, x1 after event 2, x1 before event 1, time of event 3, n at end, x1 at "
           "1,\n"
           "    x1 + a*n at 1.25, time of end" +
           (below(3) == 0 ? ", max(x1), mean(n), x1 at 0..4 by 0.5 }\n" : " }\n");
  }

 private:
  unsigned below(unsigned count) { return static_cast<unsigned>(random_() % count); }
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  std::string x() { return fmt::format("x{}", 1 + below(states_)); }

  std::string term() {
    switch (below(7)) {
      case 0:
        return fmt::format("a*{}", x());
      case 1:
        return fmt::format("2*sin({} + b)", x());
      case 2:
        return fmt::format("3*cos({:.2f}*t + {})", number(1, 6), x());
      case 3:
        return fmt::format("{:.3f}", number(-2, 2));
      case 4:
        return fmt::format("{}/(1 + {}^2)", x(), x());
      case 5:
        return fmt::format("-4*{}", x());
      default:
        return fmt::format("b*{}", x());
    }
  }
  std::string guard() {
    static const std::vector<std::string> directions = {"falls", "rises", "crosses"};
    switch (below(6)) {
      case 0:
        return fmt::format("{} > {:.2f}", x(), number(-0.5, 0.8));
      case 1:
        return fmt::format("{} < a*{} and t > {:.2f}", x(), x(), number(0, 1));
      case 2:
        return fmt::format("{} + {:.2f}*sin(3*t) {} through 0", x(), number(0, 1), directions[below(3)]);
      case 3:
        return fmt::format("n > {}", 1 + below(3));
      case 4:
        return fmt::format("{} {} through {}", x(), directions[below(3)], x());
      default:
        return fmt::format("{} {} through {:.2f}", x(), directions[below(3)], number(-0.6, 0.6));
    }
  }
  std::string action() {
    switch (below(9)) {
      case 0:
        return fmt::format("{} := -0.8*{}", x(), x());
      case 1:
        return fmt::format("{} := {:.2f}", x(), number(-1, 1));
      case 2:
        return "mark \"here\"";
      case 3:
        return fmt::format("stop after {}", 2 + below(4));
      case 4:
        return fmt::format("if {} > 0 {{ x1 := x1 - 0.3 }} else {{ n := n + 2 }}", x());
      case 5:
      case 6:
        if (modes_ > 1) return fmt::format("go m{}", 1 + below(modes_));
        [[fallthrough]];
      default:
        return "n := n + 1";
    }
  }
  std::string event() {
    std::string what;
    switch (below(8)) {
      case 0:
        what = fmt::format("at {:.2f}", number(0, 4));
        break;
      case 1:
        what = fmt::format("every {:.2f}", number(0.3, 1.5));
        break;
      case 2:
        what = "initially";
        break;
      default:
        what = "when " + guard();
        if (modes_ > 1 && below(2) == 0) what += fmt::format(" in m{}", 1 + below(modes_));
    }
    std::string text = what + " { " + action();
    if (below(3) == 0) text += fmt::format("; stop after {}", 2 + below(5));
    text += " }";
    if (what.starts_with("when") && below(4) == 0) text += " then { n := n + 10 }";
    return text + "\n";
  }

  std::mt19937 random_;
  unsigned states_, modes_;
};

/// Random models of these seeds, each by one of the ways, have the bits of their runs one by one, and more events
/// together than this.
void expect_random_models_one_by_one(const std::vector<std::string>& ways, unsigned from, unsigned to, double least) {
  double events = 0;
  for (unsigned seed = from; seed < to; ++seed) {
    const std::string text = Writer(seed).model(ways[seed % ways.size()]);
    SCOPED_TRACE(text);
    const PreparedSweep sweep = prepared_sweep(text);
    EXPECT_TRUE(sweep.goes_together());
    events += expect_the_runs_one_by_one(sweep, sweep, 0);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(events, least);
}

TEST(SweepTogetherWithEvents, RandomModelsHaveTheBitsOfTheirRunsOneByOne) {
  const std::vector<std::string> ways = {"method dop853 tol 1e-8",
                                         "method tsitouras5 tol 1e-6",
                                         "method verner9 tol 1e-11",
                                         "tol 1e-6",
                                         "method verner7 tol 1e-7",
                                         "method dormand_prince5 tol 1e-3",
                                         "method bogacki_shampine3 tol 1e-4",
                                         "method rk4 step 0.01",
                                         "tol 1e-9",
                                         "method tsitouras5 step 0.03"};
  expect_random_models_one_by_one(ways, 0, 40, 1000);
}

/// The steps of the stiff method end at events: each is taken again, alone, with the matrix that the lane has.
TEST(SweepTogetherWithEvents, RandomModelsHaveTheSameBitsByTheStiffMethod) {
  const std::vector<std::string> ways = {"method rodas5p tol 1e-4", "method rodas5p tol 1e-7",
                                         "method rodas5p step 0.03"};
  expect_random_models_one_by_one(ways, 100, 112, 250);
}

/// From slow to very stiff, with modes of which one is stiff, a slope that is infinite at an event, df/dt, and steps
/// that are rejected before the motion begins anew.
TEST(SweepTogetherWithEvents, StiffModelsHaveTheBitsOfTheRunsOneByOne) {
  const std::string keep = "  keep count of events, x at end, y at 0.7, time of event 2 }\n";
  for (const std::string& text :
       {"param k = 1\nx' = y\ny' = k*(1 - x^2)*y - x\nn' = 0\nx(0) = 2\ny(0) = 0\nn(0) = 0\n"
        "when x falls through 1 { x := 0.9 }\nwhen y crosses 0.5 { n := n + 1 }\n"
        "when x < -1.5 and n > 4 { if n > 9 { y := -y } }\nrun 0..30 method rodas5p tol 1e-6\n"
        "sweep { k in (0.1, 1, 5, 20, 100, 1000, 0.3, 2, 7, 300)\n" +
            keep,
        "param k = 1\nmode slow { x' = -x + 0.1*y }\nmode fast { x' = k*(cos(t) - x) + sin(x*y) }\n"
        "y' = sin(5*t) - 0.1*y*x\nx(0) = 1\ny(0) = k/1e4\nwhen x < 0.5 in slow { go fast }\n"
        "when x < -0.5 in fast { x := 1; go slow }\nevery 0.9 { y := y + 0.5 }\n"
        "run 0..12 method rodas5p tol 1e-5\nsweep { k in (1, 10, 100, 1000, 1e4, 1e5, 3, 30, 300)\n" +
            keep,
        "param k = 1\nx' = y - k*sqrt(x)\ny' = 100*k*(1.2 + cos(3*t) - y)\nx(0) = 0\ny(0) = 1\n"
        "when y crosses 1.2 { x := 0 }\nrun 0..4 method rodas5p tol 1e-5\n"
        "sweep { k in (0.1, 1, 10, 100, 1000, 3, 0.3, 7)\n" +
            keep}) {
    SCOPED_TRACE(text);
    const PreparedSweep sweep = prepared_sweep(text);
    EXPECT_TRUE(sweep.goes_together());
    EXPECT_GT(expect_the_runs_one_by_one(sweep, sweep, 0), 20);
  }
}

/// Machine code takes whole steps where all lanes are in one mode, and evaluates each mode where they are not. The runs
/// one by one are made without any.
TEST(SweepTogetherWithEvents, MachineCodeHasTheBitsOfTheRunsOneByOne) {
  const model::TestFolder folder;
  const auto native =
      std::make_shared<model::NativeCompiler>(model::NativeOptions{model::NativeUse::always, folder.path / "cache"});
  for (const auto& [seed, how] : {std::pair(2U, "method dop853 tol 1e-8"), std::pair(5U, "method tsitouras5 tol 1e-6"),
                                  std::pair(6U, "method dop853 tol 1e-8"), std::pair(11U, "method rodas5p tol 1e-6")}) {
    const std::string text = Writer(seed).model(how);
    SCOPED_TRACE(text);
    expect_the_runs_one_by_one(prepared_sweep(text, {}, native), prepared_sweep(text), 0);
  }
  EXPECT_EQ(native->report().trouble, "");
  EXPECT_GE(native->report().compiled, 4U);
}

/// Steps that the method computes for lanes in several modes are in machine code for a run alone: none is fused.
TEST(SweepTogetherWithEvents, FusedRunsHaveTheBitsOfTheFusedRunsOneByOne) {
  if (!model::has_fused_operations()) GTEST_SKIP() << model::why_not(model::NativeUse::fused);
  const model::TestFolder folder;
  const auto native =
      std::make_shared<model::NativeCompiler>(model::NativeOptions{model::NativeUse::fused, folder.path / "cache"});
  for (const unsigned seed : {6U, 7U}) {
    const std::string text = Writer(seed).model(seed % 2 == 0 ? "method tsitouras5 tol 1e-6" : "tol 1e-6");
    SCOPED_TRACE(text);
    const PreparedSweep fused = prepared_sweep(text, {}, native);
    expect_the_runs_one_by_one(fused, fused, 0);
  }
  EXPECT_EQ(native->report().trouble, "");
}

/// The pair of methods ends steps at events, learns from them, and goes over to its stiff method in some runs.
TEST(SweepTogetherWithEvents, RunsThatBecomeStiffEndAsTheyDoAlone) {
  for (const char* tolerance : {"tol 1e-4", "tol 1e-8"}) {
    const PreparedSweep sweep =
        prepared_sweep(fmt::format("param k = 1\nx' = y\ny' = k*(1 - x^2)*y - x\nn' = 0\nx(0) = 2\ny(0) = 0\nn(0) = 0\n"
                                   "when x falls through 1 {{ x := 0.9 }}\nwhen y crosses 0.5 {{ n := n + 1 }}\n"
                                   "when x < -1.5 and n > 4 {{ if n > 9 {{ y := -y }} }}\n"
                                   "run 0..20 {}\nsweep {{ k in (0.1, 1, 5, 20, 100, 3, 0.3, 2, 7)\n"
                                   "  keep count of events, x at end, y at 7, time of event 3 }}\n",
                                   tolerance));
    EXPECT_TRUE(sweep.goes_together());
    EXPECT_GT(expect_the_runs_one_by_one(sweep, sweep, 0), 50);
  }
}

/// A relief valve (C. Hos, A. Champneys, Physica D 241 (2012)) whose body strikes its seat, balls that come to rest,
/// and runs without an end of their own beside such as stop soon.
TEST(SweepTogetherWithEvents, ImpactsHaveTheBitsOfTheRunsOneByOne) {
  const PreparedSweep valves = prepared_sweep(
      "param q = 1\nx' = v\nv' = -1.25*v - (x + 10) + p\np' = 20*(q - x*sqrt(p))\nx(0) = 0.2\nv(0) = 0\n"
      "p(0) = 10.2\nwhen x falls through 0 { x := 0; v := -0.8*v }\nrun 0..5 method dop853 tol 1e-8\n"
      "sweep { q from 1 to 10 count 40\n  keep count of events, x at end, max(x) }\n");
  EXPECT_GT(expect_the_runs_one_by_one(valves, valves, 0), 40);
  const PreparedSweep balls = prepared_sweep(
      "param g = 9.8\nparam e = 0.9\nmode flight { h'' = -g }\nmode rest { h'' = 0 }\nh(0) = 1\nh'(0) = 0\n"
      "when h falls through 0 in flight { h := 0\n if -e*h' > 0.05 { h' := -e*h' } else { h' := 0; go rest } }\n"
      "run 0..9 method tsitouras5 tol 1e-9\nsweep { e from 0.1 to 0.95 count 9; g in (1.6, 9.8)\n"
      "  keep count of events, h at 2, h at end, time of event 2 }\n");
  EXPECT_GT(expect_the_runs_one_by_one(balls, balls, 0), 100);
}

/// Jumps of the equations and inputs that step are for the single run.
TEST(SweepTogetherWithEvents, ModelsWithJumpsAreMadeOneByOne) {
  EXPECT_FALSE(
      prepared_sweep("param a = 1\nx' = -sign(x - a*t)\nx(0) = 1\nrun 0..1 method dop853\nsweep { a in (1, 2) }\n")
          .goes_together());
}

}  // namespace
}  // namespace continuo::studies::sweep_together_events_test
