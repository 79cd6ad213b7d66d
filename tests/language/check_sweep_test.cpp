// What a sweep varies, how many runs it has and what it keeps; and that what cannot be meant is said at its place.
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "check_helpers.hpp"
#include <continuo/language/sweep.hpp>

namespace continuo::model {
namespace {

const std::string model_to_sweep =
    "param k = 4 [N/m], c = 0.5 [N*s/m], m = 1 [kg]\ninput u = 0 [N]\nx'' = (u - k*x - c*x')/m\n"
    "x(0) = 1 [m]\nx'(0) = 0 [m/s]\nwhen x falls through 0 [m] { mark \"down\" }\nrun 0..10 [s]\n";

SweepPlan plan_of(const std::string& block) {
  const Model model = good(model_to_sweep + "sweep {\n" + block + "\n}\n");
  return model.sweep ? *model.sweep : SweepPlan{};
}
std::vector<double> points(const SweepAxis& axis) {
  const auto* points = std::get_if<SweepPoints>(&axis.values);
  return points ? points->values : std::vector<double>{};
}
Said said_of(const std::string& block, std::string_view code) {
  return said(model_to_sweep + "sweep {\n" + block + "\n}\n", code);
}

TEST(CheckSweep, AModelWithoutOneHasNone) {
  EXPECT_EQ(good(model_to_sweep).sweep, nullptr);
}

TEST(CheckSweep, TheWordsMayBeNamesElsewhere) {
  const Model model = good(
      "param sweep = 2, keep = 3, runs = 4, count = 5\nx' = -sweep*x + keep + runs\nx(0) = count\nrun 0..1\n"
      "sweep {\n  keep from 1 to 2 count 2\n  runs in (1, 2, 3)\n  sweep uniform(1, 2)\n  runs 7\n  keep x at "
      "end\n}\n");
  ASSERT_TRUE(model.sweep);
  EXPECT_EQ(model.sweep->axes.size(), 3U);
  EXPECT_EQ(model.sweep->runs, 7U);
}

TEST(CheckSweep, GridsAreInTheUnitOfWhatIsVaried) {
  const SweepPlan plan =
      plan_of("k from 1 to 2 [N/cm] count 3\nx(0) in (10, 20) [cm]; m from 1 to 100 [kg] count 3 log");
  ASSERT_EQ(plan.axes.size(), 3U);
  EXPECT_EQ(points(plan.axes[0]), (std::vector<double>{100, 150, 200}));
  EXPECT_EQ(plan.axes[0].unit, "N/m");
  EXPECT_EQ(points(plan.axes[1]), (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(plan.axes[1].column(), "x(0)");
  EXPECT_EQ(points(plan.axes[2]), (std::vector<double>{1, 10, 100}));
  EXPECT_EQ(plan.runs, 18U);
  EXPECT_EQ(plan.sampling, SweepSampling::grid);
  // Values in units of their own, and of the model's parameters.
  EXPECT_EQ(points(plan_of("k from 1 [N/cm] to 200 [N/m] count 2").axes[0]), (std::vector<double>{100, 200}));
  EXPECT_EQ(points(plan_of("k in (k/2, 2*k)").axes[0]), (std::vector<double>{2, 8}));
  EXPECT_EQ(points(plan_of("k in 7").axes[0]), (std::vector<double>{7}));
  EXPECT_EQ(points(plan_of("k from 1 to 1 count 1").axes[0]), (std::vector<double>{1}));
}

TEST(CheckSweep, DistributionsHaveTheirNumbersInThatUnit) {
  const SweepPlan plan = plan_of(
      "c normal(50, 10) [N*s/km]\nk lognormal(2 [N/cm], 5 [%])\nm triangular(1, 2, 3)\nu uniform(-1, 1) [kN]\n"
      "runs 10000 latin_hypercube seed 7");
  const auto numbers = [&](std::size_t axis) { return std::get<SweepDistribution>(plan.axes.at(axis).values).numbers; };
  EXPECT_NEAR(numbers(0).at(0), 0.05, 1e-15);
  EXPECT_NEAR(numbers(0).at(1), 0.01, 1e-15);
  EXPECT_NEAR(numbers(1).at(0), 200, 1e-12);
  EXPECT_NEAR(numbers(1).at(1), 0.05, 1e-15);
  EXPECT_EQ(numbers(2), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(numbers(3), (std::vector<double>{-1000, 1000}));
  EXPECT_EQ(plan.axes[3].kind, SweepAxis::Kind::input);
  EXPECT_EQ(plan.runs, 10'000U);
  EXPECT_EQ(plan.sampling, SweepSampling::latin_hypercube);
  EXPECT_EQ(plan.seed, 7U);
}

TEST(CheckSweep, WhatIsKeptHasItsNameAndUnit) {
  const SweepPlan plan = plan_of(
      "k from 1 to 2 count 2\nkeep x at end, max(abs(x)) as peak, time of event 1 as landing,\n  x at 0..10 by 0.1\n"
      "keep min(x'), mean(x^2) as power, count of events, max(x, 0 [m]) at 3 as bounded, x' after event 2");
  const std::vector<std::pair<std::string, std::string>> wanted = {
      {"x at end", "m"}, {"peak", "m"},           {"landing", "s"}, {"x at 0..10 by 0.1", "m"}, {"min(x')", "m/s"},
      {"power", "m^2"},  {"count of events", ""}, {"bounded", "m"}, {"x' after event 2", "m/s"}};
  ASSERT_EQ(plan.keeps.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(plan.keeps[i].name, wanted[i].first);
    EXPECT_EQ(plan.keeps[i].unit, wanted[i].second) << wanted[i].first;
  }
  EXPECT_EQ(plan.keeps[1].kind, SweepKeep::Kind::maximum);
  EXPECT_EQ(plan.keeps[3].kind, SweepKeep::Kind::series);
  EXPECT_EQ(plan.keeps[3].times.count, 101U);
  EXPECT_EQ(plan.keeps[7].kind, SweepKeep::Kind::reading);
}

TEST(CheckSweep, WithoutAWordEveryStateIsKeptAtTheEnd) {
  const SweepPlan plan = plan_of("k from 1 to 2 count 2");
  ASSERT_EQ(plan.keeps.size(), 2U);
  EXPECT_EQ(plan.keeps[1].name, "x' at end");
  EXPECT_EQ(plan.keeps[1].unit, "m/s");
}

TEST(CheckSweep, BodiesAreVariedWhereTheyBegin) {
  const Model model = good(
      "world {\n  dimension 2\n  gravity (0, -9.81) [m/s^2]\n  body ball at (0, 10) [m] radius 0.5 [m] mass 1 [kg]\n"
      "  wall floor (0, 1) at 0 [m]\n}\nrun 0..3 [s]\nsweep {\n  ball.y(0) from 5 to 10 [m] count 3\n"
      "  keep time of event 1 of \"ball meets floor\" as landing, min(ball.y)\n}\n");
  ASSERT_TRUE(model.sweep);
  EXPECT_EQ(model.sweep->axes.at(0).column(), "ball.y(0)");
  EXPECT_EQ(model.sweep->axes.at(0).unit, "m");
}

TEST(CheckSweep, SamplesComeFromAColumn) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(::testing::TempDir()) / ("continuo-samples-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "samples.csv") << "k [N/cm],c\n1,0.5\n2,0.6\n3,0.7\n";
  std::ofstream(folder / "one.csv") << "3\n4\n";
  std::ofstream(folder / "short.csv") << "m,c\n1,x\n";
  const auto read = [&](const std::string& block) {
    return load(Source((folder / "model.sim").string(), model_to_sweep + "sweep {\n" + block + "\n}\n"));
  };
  const Loaded both = read("k from \"samples.csv\"\nc from \"samples.csv\"; m from \"one.csv\"");
  ASSERT_TRUE(both) << both.text();
  EXPECT_EQ(points(both.model->sweep->axes[0]), (std::vector<double>{100, 200, 300}));
  EXPECT_EQ(both.model->sweep->runs, 6U);  // the rows of a file stay together
  EXPECT_EQ(read("m from \"samples.csv\"").diagnostics.at(0).code, "E272");
  EXPECT_EQ(read("c from \"short.csv\"").diagnostics.at(0).code, "E272");
  EXPECT_EQ(read("m from \"none.csv\"").diagnostics.at(0).code, "E270");
  fs::remove_all(folder);
}

TEST(CheckSweep, MistakesAreSaidAtTheirPlace) {
  EXPECT_EQ(place(said_of("kk from 1 to 2 count 3", "E210")), "9:1");
  EXPECT_EQ(place(said_of("x from 1 to 2 count 3", "E283")), "9:1");
  EXPECT_EQ(said_of("x from 1 to 2 count 3", "E283").help, "where it begins can: write x(0)");
  EXPECT_EQ(place(said_of("x(1) from 1 to 2 count 3", "E283")), "9:1");
  EXPECT_EQ(place(said_of("k(0) from 1 to 2 count 3", "E283")), "9:1");
  EXPECT_EQ(place(said_of("k in (1, 2); k normal(1, 2)", "E283")), "9:14");
  EXPECT_EQ(place(said_of("k from 1 to 2 count 0", "E284")), "9:21");
  EXPECT_EQ(place(said_of("k from 1 to 2 count 2.5", "E284")), "9:21");
  EXPECT_EQ(place(said_of("k from 1 to 1 count 3", "E284")), "9:8");
  EXPECT_EQ(place(said_of("k from 0 to 1 count 3 log", "E284")), "9:8");
  EXPECT_EQ(place(said_of("k from 1 to 2 [s] count 3", "E201")), "9:15");
  EXPECT_EQ(place(said_of("k normal(1, -0.1); runs 5", "E284")), "9:3");
  EXPECT_EQ(place(said_of("k normal(1); runs 5", "E284")), "9:3");
  EXPECT_EQ(place(said_of("k uniform(2, 1); runs 5", "E284")), "9:3");
  EXPECT_EQ(place(said_of("k triangular(2, 1, 3); runs 5", "E284")), "9:3");
  EXPECT_EQ(place(said_of("k lognormal(-1, 1); runs 5", "E284")), "9:3");
  EXPECT_EQ(place(said_of("k normal(1, 0.1)", "E285")), "9:1");
  EXPECT_EQ(place(said_of("k normal(1, 0.1); runs 1e15", "E285")), "9:24");
  EXPECT_EQ(place(said_of("k normal(1, 0.1); runs 0", "E285")), "9:24");
  EXPECT_EQ(place(said_of("k normal(1, 0.1); runs 10 sobol seed -1", "E285")), "9:38");
  EXPECT_EQ(place(said_of("k from 1 to 2 count 100000; c from 1 to 2 count 100000", "E285")), "8:1");
  EXPECT_EQ(place(said_of("keep max(x), max(x)", "E286")), "9:14");
  EXPECT_EQ(place(said_of("keep x at end as outcome", "E286")), "9:6");
  EXPECT_EQ(place(said_of("keep always x", "E286")), "9:6");
  EXPECT_EQ(place(said_of("keep x at 5..0 by 1", "E286")).substr(0, 2), "9:");
  EXPECT_EQ(place(said_of("keep x at 0..20 by 1", "E281")), "9:14");
  EXPECT_EQ(place(said_of("keep time of event 1 of \"nothing\"", "E281")).substr(0, 2), "9:");
  EXPECT_EQ(said_of("k nornal(1, 2)", "E125").help, "did you mean `normal`?");
  EXPECT_EQ(said_of("k normal(1, 2); runs 10 sobl", "E125").help, "did you mean `sobol`?");
  EXPECT_EQ(place(said_of("k from 1 to 2", "E110")), "9:14");
  EXPECT_EQ(place(said_of("k from 1 count 2", "E110")), "9:10");
  EXPECT_EQ(place(said_of("runs 5; runs 6", "E262")), "9:9");
  EXPECT_EQ(place(said(model_to_sweep + "sweep { k in 1 }\nsweep { k in 2 }\n", "E262")), "9:1");
  EXPECT_EQ(place(said(model_to_sweep + "for i in 1..2 { sweep { k in 1 } }\n", "E123")), "8:17");
}

}  // namespace
}  // namespace continuo::model
