// Names, definitions and types.
#include <cmath>

#include "check_helpers.hpp"

namespace continuo::model {
namespace {

const std::string decay = "x' = -x\nx(0) = 1\nrun 0..1\n";

TEST(CheckNames, AnUnknownNameIsCorrected) {
  const Said message = said("param stiffness = 2\nx' = -stifness*x\nx(0) = 1\nrun 0..1\n", "E210");
  EXPECT_EQ(place(message), "2:7");
  EXPECT_EQ(message.message, "there is no `stifness`");
  EXPECT_EQ(message.help, "did you mean `stiffness`?");
}

TEST(CheckNames, ANameIsDefinedOnce) {
  EXPECT_EQ(place(said("param k = 1, k = 2\n" + decay, "E211")), "1:14");
  EXPECT_EQ(place(said("param x = 1\n" + decay, "E213")), "2:1");
  EXPECT_EQ(place(said("mode a { x' = 1 }\nmode a { x' = 2 }\nx(0) = 1\n", "E211")), "2:6");
}

TEST(CheckNames, CirclesAreShown) {
  const Said message = said("let a = b + 1, b = c, c = 2*a\n" + decay, "E212");
  EXPECT_EQ(place(message), "1:29");
  EXPECT_EQ(message.label, "a -> b -> c -> a");
  EXPECT_EQ(place(said("param p = q, q = p\n" + decay, "E212")), "1:18");
}

TEST(CheckNames, ParametersMayDependOnOthersInAnyOrder) {
  const Model model = good("param a = 2*b, b = 3\n" + decay);
  EXPECT_EQ(model.parameters[0].value, 6);
  EXPECT_FALSE(model.parameters[0].independent);
  EXPECT_EQ(start_values(model, {{"b", 5.0}})[model.parameters[0].variable], 10);
}

TEST(CheckNames, NamesWithAMeaningAreNotTaken) {
  EXPECT_EQ(place(said("param t = 1\n" + decay, "E214")), "1:7");
  EXPECT_EQ(place(said("let max = 1\n" + decay, "E214")), "1:5");
}

TEST(CheckNames, FunctionsAndTheirArguments) {
  EXPECT_EQ(place(said("output a = sine(x)\n" + decay, "E215")), "1:12");
  EXPECT_EQ(place(said("output a = sin(x, 1)\n" + decay, "E216")), "1:12");
  EXPECT_EQ(place(said("output a = atan2(x)\n" + decay, "E216")), "1:12");
  EXPECT_EQ(place(said("param k = 2\noutput a = k(x + 1)\n" + decay, "E282")), "2:12");
}

TEST(CheckNames, FunctionsAreWhatTheyAreCalled) {
  const Model model = good(
      "output a = asinh(2), b = acosh(2), c = atanh(0.5), d = log2(8), e = cbrt(-27), f = round(2.5)\n"
      "output g = mod(-1, 3), h = hypot(2, 3, 6), i = max(1, 5, 3), j = pow(2, 10), k = ln(exp(3))\n" +
      decay);
  EXPECT_NEAR(value_of(model, "a"), std::asinh(2), 1e-15);
  EXPECT_NEAR(value_of(model, "b"), std::acosh(2), 1e-15);
  EXPECT_NEAR(value_of(model, "c"), std::atanh(0.5), 1e-15);
  EXPECT_DOUBLE_EQ(value_of(model, "d"), 3);
  EXPECT_DOUBLE_EQ(value_of(model, "e"), -3);
  EXPECT_EQ(value_of(model, "f"), 3);
  EXPECT_EQ(value_of(model, "g"), 2);
  EXPECT_DOUBLE_EQ(value_of(model, "h"), 7);
  EXPECT_EQ(value_of(model, "i"), 5);
  EXPECT_EQ(value_of(model, "j"), 1024);
  EXPECT_DOUBLE_EQ(value_of(model, "k"), 3);
}

TEST(CheckNames, NumbersAndConditionsAreTwoThings) {
  EXPECT_EQ(place(said("output a = (x > 1) + 2\n" + decay, "E217")), "1:12");
  EXPECT_EQ(place(said("output a = if x then 1 else 2\n" + decay, "E217")), "1:15");
  EXPECT_EQ(place(said("output a = x > 1\n" + decay, "E217")), "1:12");
  EXPECT_EQ(place(said("output a = if x and x > 1 then 1 else 2\n" + decay, "E217")), "1:15");
  good("let on = x > 1\noutput a = if not on then 1 else 2\n" + decay);
}

TEST(CheckNames, DerivativesAreThereUpToTheOrder) {
  EXPECT_EQ(value_of(good("output a = x'\n" + decay), "a"), -1);  // from the equation
  EXPECT_EQ(place(said("output a = x''\n" + decay, "E218")), "1:12");
  EXPECT_EQ(place(said("param k = 1\noutput a = k'\n" + decay, "E218")), "2:12");
}

TEST(CheckNames, EnergyIsTheSumOfAllEnergies) {
  const Model model = good("energy kinetic = 2*x, potential = 3\noutput e = energy\n" + decay);
  EXPECT_EQ(value_of(model, "e"), 5);
  EXPECT_EQ(evaluate(model, model.total_energy, start_values(model)), 5);
}

TEST(CheckNames, LongChainsOfDefinitionsAreFollowedInTheOrderOfTheText) {
  std::string text = "let a0 = x\n";
  for (int i = 1; i <= 5000; ++i) text += "let a" + std::to_string(i) + " = a" + std::to_string(i - 1) + " + 1\n";
  EXPECT_EQ(value_of(good(text + "x' = a5000\nx(0) = 1\n"), "a5000"), 5001);
  std::string backwards;
  for (int i = 5000; i > 0; --i) backwards += "let a" + std::to_string(i) + " = a" + std::to_string(i - 1) + " + 1\n";
  EXPECT_EQ(said(backwards + "let a0 = 1\n" + decay, "E221").message, "definitions lean on each other too deeply");
}

TEST(CheckNames, CommentsBesideParametersAreKept) {
  const Model model = good("param k = 2   # stiffness of the spring\n" + decay);
  EXPECT_EQ(model.parameters[0].comment, "stiffness of the spring");
}

TEST(CheckNames, FilesAreLookedFor) {
  EXPECT_EQ(place(said("table drag from \"nowhere.csv\"\n" + decay, "E270")), "1:17");
  EXPECT_EQ(place(said("output a = interp(x, 3)\n" + decay, "E271")), "1:19");
  EXPECT_FALSE(load("nowhere.sim"));
}

TEST(CheckNames, AMistakeInAFamilyIsSaidOnce) {
  EXPECT_EQ(count_said("for i in 1..100 { x[i]' = -kk*x[i]\nx[i](0) = 1 }\nrun 0..1\n"), 1U);
}

std::string places(const std::string& in_world) {
  std::string told;
  for (const Diagnostic& d : load_text("world {\n" + in_world + "\n}\nrun 0..1\n").diagnostics)
    told += d.code + " " + d.message + " " + d.label + "\n";
  return told;
}

/// Positions of bodies are evaluated first for the unit of length, without messages.
TEST(CheckNames, AMistakeInADefinitionIsSaidWhoeverNeedsItFirst) {
  EXPECT_EQ(place(said("let a = 1 + foo\nworld { body ball at (a, 0) }\nrun 0..1\n", "E210")), "1:13");
  EXPECT_EQ(place(said("let a = ball.radius\nworld { body ball at (a, 0) }\nrun 0..1\n", "E224")), "1:9");
}

TEST(CheckNames, BodiesThatBeginWithinEachOtherAreTold) {
  const std::string two = "body a at (0, 1); body b at (0.6, 1.8)";  // 1 apart, of radius 0.5: they touch
  EXPECT_EQ(places(two), "");
  EXPECT_EQ(places("body a at (0, 1); body b at (0.6, 1.7)"), "E295 `b` begins within `a` by 0.078\n");
  EXPECT_EQ(places("body a at (0, 1) fixed; body b at (0.6, 1.7) fixed"), "");
  EXPECT_EQ(places("body a at (0, 1) group g; body b at (0.6, 1.7) group g; ignore g with g"), "");
  EXPECT_EQ(places(two + "; wall floor (0, 2) at 1"), "");  // y >= 0.5: a touches it
  EXPECT_EQ(places(two + "; wall floor (0, 2) at 1.4"), "E295 `a` begins within the wall `floor` by 0.2\n");
  EXPECT_EQ(places(two + "; wall up (0, 1) at 3 thin"), "");
  EXPECT_EQ(places(two + "; wall up (0, 1) at 2 thin"), "E295 `b` begins within the wall `up` by 0.3\n");
  // Rows of three and columns of three, 0.9 apart: 6 pairs each; diagonals are 1.27 apart.
  EXPECT_EQ(places("bodies g grid 3 x 3 from (0, 0) spacing (0.9, 0.9)"),
            "E295 `g[2]` begins within `g[1]` by 0.1, 12 such in all\n");
  EXPECT_EQ(places("dimension 3; bodies g grid 3 x 3 x 3 from (0, 0, 0) spacing (1, 1, 1)"), "");
}

// Ground that is written from right to left is free below: what falls to its back first falls through it.
TEST(CheckNames, BodiesThatBeginWithinOrBehindGroundAreTold) {
  const std::string right = "mode fast step 1/60; gravity (0, -1); wall road chain (0, 0) (4, 0) (6, 1); ",
                    wrong = "mode fast step 1/60; gravity (0, -1); wall road chain (6, 1) (4, 0) (0, 0)";
  const std::string behind = "it begins behind it: what is free is on the left of the way from point to point";
  EXPECT_EQ(places(right + "body a at (1, 0.5)"), "");
  EXPECT_EQ(places(right + "body a at (1, 0.5) box (2, 1)"), "");
  EXPECT_EQ(places(right + "body a at (1, 0.4)"), "E295 `a` begins within `road` by 0.1\n");
  EXPECT_EQ(places(right + "body a at (1, 0.4) fixed"), "");
  EXPECT_EQ(places(right + "body a at (1, -3)"), "");  // below, and falls on
  EXPECT_EQ(places(right + "body a at (5, 0.8) box (1, 1)"),
            "E295 `a` begins within `road` by 0.402\n");  // its corner (5.5, 0.3) is 0.45 below the slope, times cos
  EXPECT_EQ(places(wrong + "; body a at (1, 3)"), "E295 `a` falls through `road` " + behind + "\n");
  EXPECT_EQ(places(wrong + "; body a at (7, 3)"), "");  // beside it
  EXPECT_EQ(places(wrong + " thin; body a at (1, 3)"), "");
  // A room, above it a shelf that is passed from behind, and an obstacle.
  EXPECT_EQ(
      places(
          "mode fast step 1/60; gravity (0, -1); wall room chain (0, 0) (4, 0) (4, 4) (0, 4) closed; body a at (2, 2)"),
      "");
  EXPECT_EQ(places("mode fast step 1/60; gravity (0, -1); wall block chain (0, 4) (4, 4) (4, 0) (0, 0) closed; body a "
                   "at (2, 2)"),
            "E295 `a` falls through `block` " + behind + "\n");
}

}  // namespace
}  // namespace continuo::model
