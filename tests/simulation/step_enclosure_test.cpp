// Guards of a model enclosed over the steps of a method: every value of the scalar evaluation lies within.
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/numerics/root_isolation.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/program/step_enclosure.hpp>

namespace continuo::model::step_enclosure_test {
namespace {

const char* const oscillator = R"(
param k = 4, height = 0.3
x'' = -k*x
y' = 1
x(0) = 1; x'(0) = 0; y(0) = 0
when x rises through height { mark "up" }
when x'*y - t*height + sin(3*t) falls through 0 { mark "mixed" }
when abs(y - 2) - 0.001 falls through 0 { mark "near" }
run 0..10
)";

std::shared_ptr<const ModelProgram> program_of(const char* text) {
  Loaded loaded = load(Source("test.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return compile(std::move(*loaded.model));
}

struct OneStep {
  std::shared_ptr<const ModelProgram> program;
  ModelSystem system;
  Interpolant<std::vector<double>, Dop853::dense_degree> output;
  double t, h;

  OneStep(const char* text, double t_, double h_)
      : program(program_of(text)),
        system(program, start_values(program->model)),
        output(std::vector<double>(program->model.states.size())),
        t(t_),
        h(h_) {
    std::vector<double> x(program->model.states.size()), x_new = x;
    const auto variables = start_values(program->model);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = variables[program->model.layout.states + i];
    auto work = Dop853::workspace(x);
    Dop853::step(system, t, x, h, true, work, x_new);
    Dop853::interpolate(system, t, x, h, x_new, work, output);
  }

  Step step() const { return {t, h, output.c}; }
  std::vector<double> guards(double theta) {
    std::vector<double> x(program->model.states.size()), values(program->model.events.size());
    output(theta, x);
    system.guards(t + theta * h, x, values);
    return values;
  }
  StepEnclosure enclosure() const {
    std::vector<NodeId> nodes;
    for (const When& when : program->model.events) nodes.push_back(when.guard);
    return {*program, nodes, start_values(program->model)};
  }
};

TEST(StepEnclosure, HoldsTheGuardsAtEveryInstant) {
  OneStep one(oscillator, 0.25, 0.5);
  StepEnclosure enclosure = one.enclosure();
  for (const double width : {1.0, 0.25, 1e-3, 1e-9, 0.0}) {
    for (double from = 0; from + width <= 1; from += 0.0625) {
      const auto curves = enclosure.over(one.step(), from, from + width);
      const auto values = enclosure.values_over(one.step(), from, from + width);
      for (int k = 0; k <= 4; ++k) {
        const auto guards = one.guards(std::min(from + width * k / 4, from + width));
        for (std::size_t i = 0; i < guards.size(); ++i) {
          EXPECT_TRUE(curves[i].value.holds(guards[i]));
          EXPECT_TRUE(values[i].holds(guards[i]));
        }
      }
    }
  }
}

TEST(StepEnclosure, IsAsTightAsRoundingAtAnInstant) {
  OneStep one(oscillator, 0.25, 0.5);
  StepEnclosure enclosure = one.enclosure();
  for (const Enclosure<double>& value : enclosure.values_over(one.step(), 0.3, 0.3))
    EXPECT_LT(value.hi - value.lo, 1e-13);  // sums of ten terms of order one
}

TEST(StepEnclosure, ReadsOnlyTheStatesOfItsExpressions) {
  OneStep one(oscillator, 0, 0.1);
  const std::vector<NodeId> nodes = {one.program->model.events[2].guard};
  const StepEnclosure enclosure(*one.program, nodes, start_values(one.program->model));
  ASSERT_EQ(enclosure.components().size(), 1u);
  EXPECT_EQ(one.program->model.states[enclosure.components()[0]].column, "y");
}

TEST(StepEnclosure, FollowsParametersThatAreSet) {
  OneStep one(oscillator, 0, 0.5);
  const std::vector<NodeId> nodes = {one.program->model.events[0].guard};
  StepEnclosure enclosure(*one.program, nodes, start_values(one.program->model));
  const double with_slope = enclosure.over(one.step(), 0, 1)[0].value.hi;
  const double alone = enclosure.values_over(one.step(), 0, 1)[0].hi;
  for (const Parameter& parameter : one.program->model.parameters)
    if (parameter.name == "height") enclosure.set(parameter.variable, 1.3);
  EXPECT_NEAR(enclosure.over(one.step(), 0, 1)[0].value.hi, with_slope - 1, 1e-12);
  EXPECT_NEAR(enclosure.values_over(one.step(), 0, 1)[0].hi, alone - 1, 1e-12);
}

// y = t passes 2 - 0.001 and 2 + 0.001 within one step: the guard is below zero for 0.002 of five.
TEST(StepEnclosure, AWindowWithinAStepIsFound) {
  OneStep one(oscillator, 0, 5);
  const std::vector<NodeId> nodes = {one.program->model.events[2].guard};
  StepEnclosure enclosure(*one.program, nodes, start_values(one.program->model));
  std::vector<std::pair<double, double>> found;
  const auto end = isolate_crossings(
      0.0, 1.0, 1, [&](double a, double b) { return enclosure.over(one.step(), a, b)[0]; },
      [&](double a) { return enclosure.values_over(one.step(), a, a)[0]; },
      [&](double a, double b, int, bool) { return found.emplace_back(a, b), false; },
      [](double, double) { return false; });
  EXPECT_TRUE(end.proved);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(found[0].first * 5 <= 1.999 && 1.999 <= found[0].second * 5 + 1e-14);
  EXPECT_TRUE(found[1].first * 5 <= 2.001 && 2.001 <= found[1].second * 5 + 1e-14);
}

}  // namespace
}  // namespace continuo::model::step_enclosure_test
