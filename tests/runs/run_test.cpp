// One function runs any model, with results bitwise equal to those of the module that can run it.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/worlds/simulate_world.hpp>

namespace continuo::runs::run_test {
namespace {

std::shared_ptr<const model::ModelProgram> program_of(const std::string& text) {
  const model::Loaded loaded = model::load(model::Source("test.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return model::compile(*loaded.model);
}

const std::string decay = "param k = 0.5\nx' = -k*x\nx(0) = 1\nrun 0..2 output 0.1\n";
const std::string both_ends = "param p = 1\nx'' = -p*exp(x)\nx(0) = 0; x(1) = 0\nrun 0..1 output 0.1\n";
const std::string ball =
    "world {\n  gravity (0, -9.81)\n  material restitution 1\n  wall floor (0, 1) at 0\n"
    "  body b at (0, 2) radius 0.1 mass 1\n}\nrun 0..1 output 0.1\n";

void expect_same(const model::Simulated& a, const model::Simulated& b) {
  ASSERT_TRUE(a.run && b.run);
  ASSERT_EQ(a.run->motion.rows(), b.run->motion.rows());
  for (std::size_t row = 0; row < a.run->motion.rows(); ++row)
    EXPECT_TRUE(std::ranges::equal(a.run->motion.row(row), b.run->motion.row(row))) << row;
}

TEST(Run, OfEquationsIsTheIntegration) {
  const auto program = program_of(decay);
  expect_same(run(program, {.rtol = 1e-8}), model::simulate(program, {.rtol = 1e-8}));
}

TEST(Run, OfConditionsAtBothEndsIsTheCollocation) {
  const auto program = program_of(both_ends);
  expect_same(run(program), boundary::simulate_boundary(program));
  const auto second = run(program, {}, {.boundary = {.solution = 2}});
  ASSERT_FALSE(second.run);
  EXPECT_EQ(second.diagnostics.front().code, "E322");
}

TEST(Run, OfBodiesIsTheirWorld) {
  const auto program = program_of(ball);
  expect_same(run(program), worlds::simulate_world(program));
}

TEST(Run, FromTheStartOnlyRefusesConditionsAtBothEnds) {
  const auto refused = run(program_of(both_ends), {}, {.from_start = true});
  ASSERT_FALSE(refused.run);
  EXPECT_EQ(refused.diagnostics.front().code, "E321");
  EXPECT_TRUE(run(program_of(decay), {}, {.from_start = true}).run);
  EXPECT_TRUE(run(program_of(ball), {}, {.from_start = true}).run);
}

TEST(Run, IsPlannedWhereItHasAStart) {
  std::vector<model::Diagnostic> problems;
  EXPECT_TRUE(plan_from_start(*program_of(decay), {}, problems));
  EXPECT_TRUE(plan_from_start(*program_of(ball), {}, problems));
  EXPECT_TRUE(problems.empty());
  EXPECT_FALSE(plan_from_start(*program_of(both_ends), {}, problems));
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems.front().code, "E321");
}

TEST(Run, IsPlannedByTheModuleThatRunsIt) {
  struct Case {
    std::string text, method;
    double rtol;
  };
  for (const Case& one : {Case{decay, "dop853", 1e-10}, Case{ball, "exact", 1e-10}, Case{both_ends, "dop853", 1e-10}}) {
    const auto program = program_of(one.text);
    std::vector<model::Diagnostic> problems;
    const model::Experiment experiment =
        one.method == "exact" ? model::Experiment{} : model::Experiment{.method = one.method, .rtol = 1e-10};
    const auto planned = runs::plan(program->model, experiment, problems);
    ASSERT_TRUE(planned) << one.text;
    EXPECT_EQ(planned->method, one.method);
    EXPECT_EQ(planned->rtol, one.rtol);
    EXPECT_EQ(planned->variables.size(), program->model.layout.size);
  }
}

TEST(Run, IsNotPlannedWithLimitsOfStepsWhereThereAreNone) {
  for (const std::string& text : {ball, both_ends}) {
    std::vector<model::Diagnostic> problems;
    EXPECT_FALSE(runs::plan(program_of(text)->model, {.max_steps = 5}, problems));
    ASSERT_FALSE(problems.empty());
    EXPECT_EQ(problems.front().code, "E333");
  }
}

TEST(Run, OfOtherThanEquationsIsNotPlannedAsAnIntegration) {
  std::vector<model::Diagnostic> problems;
  EXPECT_FALSE(model::plan(program_of(ball)->model, {}, problems));
  EXPECT_FALSE(model::plan(program_of(both_ends)->model, {}, problems));
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].code, "E323");
  EXPECT_EQ(problems[1].code, "E321");
}

TEST(Run, CostsWhatItsKindCounts) {
  const auto equations = program_of(decay), bodies = program_of(ball);
  const auto integrated = run(equations), moved = run(bodies);
  ASSERT_TRUE(integrated.run && moved.run);
  EXPECT_EQ(cost_of(equations->model, *integrated.run), static_cast<double>(integrated.run->statistics.evaluations));
  EXPECT_EQ(cost_of(bodies->model, *moved.run), 1);  // from 1.9 m it falls for 0.62 s, and rises for as long
}

}  // namespace
}  // namespace continuo::runs::run_test
