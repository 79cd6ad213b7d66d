// The properties of each kind of run, and the methods that can be named for it.
#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/methods.hpp>

namespace continuo::runs::kind_test {
namespace {

using testing::Contains;
using testing::Field;
using testing::Not;

model::Model model_of(const std::string& text) {
  model::Loaded loaded = model::load(model::Source("test.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return std::move(*loaded.model);
}

const std::string decay = "x' = -x\nx(0) = 1\nrun 0..2\n";
const std::string pendulum = "x'' = -sin(x)\nx(0) = 1; x'(0) = 0\nrun 0..2\n";
const std::string algebraic = "unknown y = 1\nx' = -y\n0 = y - x\nx(0) = 1\nrun 0..2\n";
const std::string both_ends = "x'' = -x\nx(0) = 0; x(1) = 1\nrun 0..1\n";
const std::string ball =
    "world {\n  gravity (0, -9.81)\n  material restitution 1\n  wall floor (0, 1) at 0\n"
    "  body b at (0, 2) radius 0.1 mass 1\n}\nrun 0..1 output 0.1\n";

TEST(Kind, OfEquationsIsIntegratedFromTheStart) {
  const Kind kind = kind_of(model_of(decay));
  EXPECT_EQ(kind.solver, Solver::integration);
  EXPECT_TRUE(kind.has_start && kind.has_exact_derivatives && kind.has_absolute_tolerances);
  EXPECT_TRUE(kind.has_rows_at_any_time);
  EXPECT_TRUE(kind.can_be_recorded);
  EXPECT_EQ(kind.cost, "evaluations");
  EXPECT_FALSE(no_study_of_equations(model_of(decay)));
}

TEST(Kind, OfConditionsAtBothEndsHasNoStart) {
  const Kind kind = kind_of(model_of(both_ends));
  EXPECT_EQ(kind.solver, Solver::collocation);
  EXPECT_FALSE(kind.has_start || kind.can_be_recorded);
  EXPECT_TRUE(kind.has_exact_derivatives);
}

TEST(Kind, OfBodiesHasDifferencesAndCountsCollisions) {
  const model::Model model = model_of(ball);
  const Kind kind = kind_of(model);
  EXPECT_EQ(kind.solver, Solver::world);
  EXPECT_TRUE(kind.has_start && kind.can_be_recorded);
  EXPECT_FALSE(kind.has_exact_derivatives || kind.has_absolute_tolerances || kind.has_rows_at_any_time);
  EXPECT_EQ(kind.cost, "collisions");
  ASSERT_TRUE(no_study_of_equations(model));
  EXPECT_EQ(no_study_of_equations(model)->code, "E323");
}

auto is_called(const std::string& name) {
  return Field(&Method::name, name);
}

TEST(Methods, AreThoseThatFitTheEquations) {
  const auto of_decay = methods_for(model_of(decay)), of_pendulum = methods_for(model_of(pendulum)),
             of_algebraic = methods_for(model_of(algebraic));
  EXPECT_THAT(of_decay, Contains(is_called("dop853")));
  EXPECT_THAT(of_decay, Not(Contains(is_called("velocity_verlet"))));
  EXPECT_THAT(of_pendulum, Contains(is_called("velocity_verlet")));
  EXPECT_THAT(of_algebraic, Contains(is_called("radau")));
  EXPECT_THAT(of_algebraic, Not(Contains(is_called("dop853"))));
}

TEST(Methods, OfBodiesChooseStepsOrTakeThem) {
  const model::Model model = model_of(ball);
  for (const Method& method : methods_for(model)) {
    const bool expected = method.name == "exact" || method.name == "dop853";
    EXPECT_EQ(method.chooses_steps, expected) << method.name;
    EXPECT_EQ(has_no_step(kind_of(model), method.name), expected) << method.name;
  }
  EXPECT_THAT(method_names(kind_of(model)), Contains("fast"));
  EXPECT_THAT(method_names(Kind{}), Not(Contains("fast")));
  EXPECT_FALSE(has_no_step(Kind{}, "dop853"));
}

TEST(Methods, KeepTheOrderOfTheirSteps) {
  EXPECT_EQ(order_of_fixed_steps(model_of(decay), "rk4"), 4);
  EXPECT_EQ(order_of_fixed_steps(model_of(decay), "fast"), 0);
  EXPECT_EQ(order_of_fixed_steps(model_of(ball), "fast"), 1);  // semi-implicit Euler, unless the world names another
}

TEST(Methods, AreComparedWithTheBest) {
  EXPECT_EQ(reference_method(model_of(decay), false), "verner9");
  EXPECT_EQ(reference_method(model_of(decay), true), "radau");
  EXPECT_EQ(reference_method(model_of(algebraic), false), "radau");
  EXPECT_EQ(reference_method(model_of(ball), true), "exact");
}

}  // namespace
}  // namespace continuo::runs::kind_test
