// The default experiment, checks, plots and drawings.
#include "check_helpers.hpp"

namespace continuo::model {
namespace {

const std::string decaying = "param k = 2\nx' = -k*x\nx(0) = 1\n";

TEST(CheckRun, WhatIsNotSaidIsNotSet) {
  const Model model = good(decaying + "run 0..3\n");
  EXPECT_EQ(model.run.to->value, 3);
  EXPECT_FALSE(model.run.output || model.run.method || model.run.step || model.run.rtol);
  EXPECT_TRUE(model.run.atol.empty());
  EXPECT_FALSE(good(decaying).run.from);
}

TEST(CheckRun, EveryPartIsKept) {
  const Model model = good(decaying + "run 1 - 1..2*k output 0.02 method euler step 0.1 realtime\n");
  EXPECT_EQ(model.run.to->value, 4);
  EXPECT_EQ(model.run.method, "explicit_euler");
  EXPECT_EQ(model.run.step->value, 0.1);
  EXPECT_EQ(model.run.output->interval->value, 0.02);
  EXPECT_TRUE(model.run.realtime);
  const Model adaptive = good(decaying + "run 0..1 output log 10 per decade from 1e-3 tol 1e-8, abs 1e-10\n");
  EXPECT_EQ(adaptive.run.rtol, 1e-8);
  EXPECT_EQ(adaptive.run.atol, std::vector<double>{1e-10});
  EXPECT_EQ(adaptive.run.output->per_decade, 10);
}

TEST(CheckRun, StepsMayBeLimited) {
  const Model model = good("param d = 0.5\n" + decaying + "run 0..1 max step d/5, max steps 4*25 tol 1e-8\n");
  EXPECT_EQ(model.run.max_step->value, 0.1);
  EXPECT_EQ(model.run.max_steps, 100U);
  EXPECT_EQ(model.run.rtol, 1e-8);
  EXPECT_EQ(good("x' = 1 [m/s]\nx(0) = 0 [m]\nrun 0..1 [min] max step 6 [s]\n").run.max_step->value, 0.1);
  for (const auto* wrong : {"max step 0", "max step -1 tol 1e-3", "max steps 0", "step 0.1 max step 0.2"})
    EXPECT_EQ(said(decaying + "run 0..1 " + wrong + "\n", "E261").line, 4) << wrong;
  EXPECT_EQ(place(said(decaying + "run 0..1 max steps 2.5\n", "E219")), "4:20");
  EXPECT_EQ(place(said("x' = 1 [m/s]\nx(0) = 0 [m]\nrun 0..1 [s] max step 6 [m]\n", "E201")), "3:23");
  EXPECT_EQ(place(said("x'' = -x\nx(0) = 0; x(1) = 1\nrun 0..1 max step 0.1\n", "E264")), "3:19");
  EXPECT_EQ(place(said(decaying + "run 0..1 max stop 1\n", "E110")), "4:14");
  EXPECT_EQ(place(said(decaying + "run 0..1 max step 1 max step 1\n", "E124")), "4:25");
}

TEST(CheckRun, TimesAreInTheUnitOfTheRun) {
  const Model model = good("x' = 1 [m/s]\nx(0) = 0 [m]\nat 30 [s] { mark \"half\" }\nrun 0..1 [min] output 6 [s]\n");
  EXPECT_EQ(model.run.output->interval->value, 0.1);
  EXPECT_EQ(model.schedule[0].time->value, 0.5);
  EXPECT_EQ(rate(model, "x"), 60);
}

TEST(CheckRun, WrongSettingsAreRefused) {
  EXPECT_EQ(place(said(decaying + "run 3..1\n", "E261")), "4:5");
  EXPECT_EQ(place(said(decaying + "run 0..1 tol -1\n", "E261")), "4:14");
  EXPECT_EQ(place(said(decaying + "run 0..x\n", "E222")), "4:8");
  EXPECT_EQ(place(said(decaying + "run 0..1 tol 1e-6, abs (1e-6, 1e-7)\n", "E263")).substr(0, 2), "4:");
  const Said method = said(decaying + "run 0..1 method dop835\n", "E260");
  EXPECT_EQ(place(method), "4:17");
  EXPECT_EQ(method.help, "did you mean `dop853`?");
  EXPECT_EQ(place(said(decaying + "run 0..1\nrun 0..2\n", "E262")), "5:1");
}

TEST(CheckRun, ChecksReadTheMotion) {
  const Model model = good(decaying +
                           "run 0..3\ncheck x(1) = exp(-2) within 1e-9\ncheck x + x(2) at end = 1 within 9\n"
                           "check always x > 0\ncheck time of end = 3 within 0\n");
  ASSERT_EQ(model.checks.size(), 4U);
  EXPECT_EQ(model.checks[0].measure, Measure::value);
  EXPECT_EQ(model.checks[0].moment.time->value, 1);
  ASSERT_EQ(model.checks[1].samples.size(), 1U);
  EXPECT_EQ(model.checks[1].samples[0].when.value, 2);
  EXPECT_GE(model.checks[1].samples[0].variable, model.layout.samples);
  EXPECT_EQ(model.layout.size, model.layout.samples + 1);
  EXPECT_EQ(model.checks[2].relation, Relation::greater);
  EXPECT_EQ(model.checks[3].measure, Measure::end_time);
}

/// x'' = -x is -1 at the start, on either side of a value at a time, and as such a value.
TEST(CheckRun, ChecksReadHighestDerivatives) {
  const std::string oscillator = "x'' = -x\nx(0) = 1; x'(0) = 0\nrun 0..2\n";
  for (const char* check : {"check x'' + x(1) = 1 within 9\n", "check x(1) + x'' = 1 within 9\n"}) {
    const Model model = good(oscillator + check);
    ASSERT_EQ(model.checks.size(), 1U);
    EXPECT_EQ(evaluate(model, model.checks[0].node, start_values(model)), -1) << check;
  }
  const Model model = good(oscillator + "check 2*x''(1) = 1 within 9\n");
  ASSERT_EQ(model.checks[0].samples.size(), 1U);
  EXPECT_EQ(evaluate(model, model.checks[0].samples[0].of, start_values(model)), -1);
}

TEST(CheckRun, ChecksOfWhatIsNotThereAreRefused) {
  EXPECT_EQ(place(said(decaying + "run 0..3\ncheck x(4) = 1 within 1\n", "E281")), "5:9");
  EXPECT_EQ(place(said(decaying + "run 0..3\ncheck energy drift < 1\n", "E281")), "5:7");
  EXPECT_EQ(said(decaying + "run 0..3\ncheck count of \"bounce\" = 1\n", "E281").help, "the model has no events");
}

TEST(CheckRun, PlotsAndDrawingsAreKept) {
  const Model model = good(decaying +
                           "energy all = x\nrun 0..3\nplot x, energy against t\nplot x'\n"
                           "draw { floor 0; ball (0, x) radius 0.3 color \"red\"; for i in 1..3 { ball (i, x) } }\n");
  ASSERT_EQ(model.plots.size(), 2U);
  EXPECT_EQ(model.plots[0].curves[1].label, "energy");
  EXPECT_EQ(model.plots[1].against.label, "t");
  ASSERT_EQ(model.drawing.size(), 5U);
  EXPECT_EQ(model.drawing[1].arguments[0].numbers.size(), 2U);
  EXPECT_EQ(model.drawing[1].attributes[1].value.text, "red");
  EXPECT_EQ(model.graph.value(model.drawing[4].arguments[0].numbers[0]), 3);
}

// A drawing has one unit, that of its first point.
TEST(CheckRun, WhatIsDrawnIsConverted) {
  const Model model = good(
      "param r = 28 [mm]\nx' = 1 [m/s]\nx(0) = 2 [m]\nrun 0..1 [s]\n"
      "draw { ball (x, 30 [cm]) radius r; ball (x, 0) radius 3 }\n");
  const auto variables = start_values(model);
  EXPECT_DOUBLE_EQ(evaluate(model, model.drawing[0].arguments[0].numbers[0], variables), 2);
  EXPECT_DOUBLE_EQ(evaluate(model, model.drawing[0].arguments[0].numbers[1], variables), 0.3);
  EXPECT_DOUBLE_EQ(evaluate(model, model.drawing[0].attributes[0].value.numbers[0], variables), 0.028);
  EXPECT_DOUBLE_EQ(evaluate(model, model.drawing[1].attributes[0].value.numbers[0], variables), 3);
}

TEST(CheckRun, WhatTheMouseMayMoveDependsOnStates) {
  const Model model = good(decaying + "run 0..3\ndraw { ball (0, sin(x)) drag; box (x, 1) }\n");
  EXPECT_TRUE(is_dragged(model.drawing[0]));
  EXPECT_FALSE(is_dragged(model.drawing[1]));
  said(decaying + "param k = 1\nrun 0..3\ndraw { ball (k, t) drag }\n", "E265");
}

TEST(CheckRun, AValueOutsideItsRangeIsAWarning) {
  const Loaded loaded = load_text("param k = 5 in 0..3\nx' = k\nx(0) = 0\n");
  EXPECT_TRUE(loaded);
  ASSERT_EQ(loaded.diagnostics.size(), 1U);
  EXPECT_EQ(loaded.diagnostics[0].code, "E290");
}

}  // namespace
}  // namespace continuo::model
