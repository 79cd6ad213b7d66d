// Orders from primes, equations solved for the highest derivative, their number.
#include "check_helpers.hpp"

namespace continuo::model {
namespace {

TEST(CheckEquations, TheOrderIsReadFromThePrimes) {
  const Model model = good("x''' = -x\nx(0) = 1; x'(0) = 2; x''(0) = 3\ny' = x\ny(0) = 4\nrun 0..1\n");
  std::vector<std::string> columns;
  for (const State& state : model.states) columns.push_back(state.column);
  EXPECT_EQ(columns, (std::vector<std::string>{"x", "x'", "x''", "y"}));
  EXPECT_EQ(rate(model, "x"), 2);
  EXPECT_EQ(rate(model, "x'"), 3);
  EXPECT_EQ(rate(model, "x''"), -1);
}

TEST(CheckEquations, AFirstOrderEquationIsSolved) {
  EXPECT_EQ(rate(good("x' + 34*x = 32\nx(0) = 0.5\nrun 0..1\n"), "x"), 32 - 34 * 0.5);
}

TEST(CheckEquations, AThirdOrderEquationWithItsTermsInAnyOrderIsSolved) {
  const Model model = good("x' + 32*x'' + x''' = 0\nx(0) = 0; x'(0) = 1; x''(0) = 2\nrun 0..1\n");
  EXPECT_EQ(rate(model, "x''"), -65);
}

TEST(CheckEquations, CoefficientsMayDependOnTheState) {
  const Model model = good("(1 + x^2)*x'' + x*x'^2 = -x\nx(0) = 2; x'(0) = 3\nrun 0..1\n");
  EXPECT_DOUBLE_EQ(rate(model, "x'"), (-2 - 2.0 * 9) / 5);
}

TEST(CheckEquations, CoupledAccelerationsAreSolvedTogether) {
  // 2a + b = 5, a + 3b = 10: a = 1, b = 3
  const Model model = good("2*x'' + y'' = 5\nx'' + 3*y'' = 10\nx(0) = 0; x'(0) = 0; y(0) = 0; y'(0) = 0\nrun 0..1\n");
  EXPECT_DOUBLE_EQ(rate(model, "x'"), 1);
  EXPECT_DOUBLE_EQ(rate(model, "y'"), 3);
}

TEST(CheckEquations, OneHighestDerivativeMayStandInAnothersEquation) {
  const Model model = good("y' = 2*x'' + 1\nx'' = -x\nx(0) = 3; x'(0) = 0; y(0) = 0\nrun 0..1\n");
  EXPECT_EQ(rate(model, "y"), -5);
}

TEST(CheckEquations, LetsMayHoldTheHighestDerivative) {
  const Model model = good("param m = 2\nlet a = x''\nm*x'' = 6\nx(0) = 0; x'(0) = 0\nrun 0..1\noutput force = m*a\n");
  EXPECT_EQ(value_of(model, "force"), 6);
}

TEST(CheckEquations, ANonlinearHighestDerivativeIsRefused) {
  const Said message = said("x'^2 = 1 - x\nx(0) = 0\nrun 0..1\n", "E232");
  EXPECT_EQ(place(message), "1:1");
  EXPECT_EQ(message.help, "solve for it by hand and write x' = ...");
}

TEST(CheckEquations, TwoEquationsForOneDerivativeAreOneTooMany) {
  const Said message = said("x' = 1\nx' = 2\nx(0) = 0\nrun 0..1\n", "E231");
  EXPECT_EQ(place(message), "2:1");
  EXPECT_EQ(message.message, "`x'` has one equation too many");
}

TEST(CheckEquations, AnAlgebraicOneThatIsWrongIsNotOneTooMany) {
  EXPECT_EQ(count_said("unknown v = 1\nx' = -v\n0 = v - q\nx(0) = 1\nrun 0..1\n"), 1U);
  EXPECT_EQ(count_said("unknown v = 1 [V]\nx' = -x\n0 = v - 3 [A]\nx(0) = 1\nrun 0..1\n"), 1U);
}

TEST(CheckEquations, AMissingEquationIsNamed) {
  EXPECT_EQ(place(said("x' = v'\nx(0) = 0; v(0) = 0\nrun 0..1\n", "E230")), "1:1");
  const Said lonely = said("speed' = 1\nspeed(0) = 0\nsped(0) = 1\nrun 0..1\n", "E230");
  EXPECT_EQ(place(lonely), "3:1");
  EXPECT_EQ(lonely.help, "did you mean `speed`?");
}

TEST(CheckEquations, AnEquationThatDeterminesNothingIsRefused) {
  EXPECT_EQ(place(said("x' = 1\nx(0) = 0\n2*x = 3\nrun 0..1\n", "E233")), "3:1");
  EXPECT_EQ(place(said("x' - x' = 1\nx(0) = 0\nrun 0..1\n", "E233")), "1:1");
}

TEST(CheckEquations, EveryModeHasItsRightHandSide) {
  const Model model =
      good("x' = v\nmode up { v' = 1 }\nmode down { v' + 2 = 0 }\nstart in down\nx(0) = 0; v(0) = 5\nrun 0..1\n");
  ASSERT_EQ(model.modes.size(), 2U);
  EXPECT_EQ(model.start_mode, 1U);
  EXPECT_EQ(rate(model, "x", {}, 1), 5);
  EXPECT_EQ(rate(model, "v", {}, 0), 1);
  EXPECT_EQ(rate(model, "v", {}, 1), -2);
}

TEST(CheckEquations, ModesDefineTheSameStates) {
  const std::string start = "h(0) = 1; h'(0) = 0\nrun 0..1\n";
  EXPECT_EQ(place(said("mode flight { h'' = -9.8 }\nmode rest { h' = 0 }\n" + start, "E234")), "2:13");
  EXPECT_EQ(place(said("mode flight { h'' = -9.8 }\nmode rest { let a = 1 }\n" + start, "E234")), "2:6");
}

TEST(CheckEquations, LetsOfAModeStayInIt) {
  const Model model = good("mode a { let f = 1\nx' = f }\nmode b { let f = 2\nx' = f }\nx(0) = 0\nrun 0..1\n");
  EXPECT_EQ(rate(model, "x", {}, 0), 1);
  EXPECT_EQ(rate(model, "x", {}, 1), 2);
}

TEST(CheckEquations, AlgebraicEquationsNeedAsManyUnknowns) {
  const Model model = good("unknown z = 1\nx' = -z\n0 = z^2 - x\nx(0) = 4\nrun 0..1\n");
  EXPECT_TRUE(model.needs_dae_solver());
  ASSERT_EQ(model.algebraic.size(), 1U);
  // z starts at its guess: 0 - (1 - 4)
  EXPECT_DOUBLE_EQ(evaluate(model, model.algebraic[0].residual, start_values(model)), 3);
  EXPECT_EQ(place(said("unknown z = 1\nx' = -z\nx(0) = 4\nrun 0..1\n", "E235")), "1:1");
}

TEST(CheckEquations, PairsOfPositionAndVelocityAreFound) {
  const Model plain = good("x'' = -x\nx(0) = 1; x'(0) = 0\nrun 0..1 method velocity_verlet step 0.1\n");
  EXPECT_TRUE(plain.all_paired);
  EXPECT_FALSE(plain.accelerations_depend_on_velocities);
  const Model written_out = good("x' = v\nv' = -x - v\nx(0) = 1; v(0) = 0\nrun 0..1\n");
  ASSERT_EQ(written_out.pairs.size(), 1U);
  EXPECT_EQ(written_out.pairs[0].velocity, 1U);
  EXPECT_TRUE(written_out.accelerations_depend_on_velocities);
}

TEST(CheckEquations, LeapfrogMethodsAskForWhatTheyNeed) {
  EXPECT_EQ(place(said("x' = -x\nx(0) = 1\nrun 0..1 method velocity_verlet step 0.1\n", "E264")), "3:17");
  const Loaded warned = load_text("x'' = -x - x'\nx(0) = 1; x'(0) = 0\nrun 0..1 method velocity_verlet step 0.1\n");
  EXPECT_TRUE(warned);
  ASSERT_EQ(warned.diagnostics.size(), 1U);
  EXPECT_EQ(warned.diagnostics[0].code, "E292");
}

TEST(CheckEquations, AModelWithoutMotionIsRefused) {
  EXPECT_EQ(said("param k = 3\nrun 0..1\n", "E280").line, 1);
}

}  // namespace
}  // namespace continuo::model
