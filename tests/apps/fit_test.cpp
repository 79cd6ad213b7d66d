// The verbs sense and fit: their output, their files, and their messages on wrong data.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"

namespace continuo::app {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* decay =
    "param a = 1 in 0..5, N = 2\nx' = -a*x\nx(0) = 1\noutput twice = N*x\nrun 0..2 output 1\n";

TEST(Sense, WritesStatesAndTheirDerivatives) {
  Shell shell;
  shell.write("decay.sim", decay);
  const Result result = shell.run("sense decay.sim --param a --initial x -o s.csv --tol 1e-10");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("d x / d a"));
  EXPECT_THAT(result.out, HasSubstr("d x / d x(0)"));
  EXPECT_THAT(shell.read("s.csv"), StartsWith("t,x,d x / d a,d x / d x(0)\n0,1,0,1\n1,0.36787944"));
}

TEST(Sense, SaysWhichNameIsWrong) {
  Shell shell;
  shell.write("decay.sim", decay);
  EXPECT_THAT(shell.run("sense decay.sim").err, HasSubstr("name parameters by --param"));
  const Result wrong = shell.run("sense decay.sim --param b");
  EXPECT_EQ(wrong.exit, 1);
  EXPECT_THAT(wrong.err, HasSubstr("there is no parameter `b`"));
  EXPECT_THAT(shell.run("sense decay.sim --initial y").err, HasSubstr("there is no state `y`"));
  EXPECT_THAT(shell.run("sense decay.sim --param a -o /no/such/folder/s.csv").err, HasSubstr("cannot write"));
  shell.write("boundary.sim", "param a = 1\nx'' = a\nx(0) = 0\nx(1) = 1\nrun 0..1\n");
  const Result boundary = shell.run("sense boundary.sim --initial \"x'\"");
  EXPECT_EQ(boundary.exit, 2);
  EXPECT_THAT(boundary.err, AllOf(HasSubstr("boundary.sim:3"), HasSubstr("no initial value of its own")));
}

// x = a t^2/2 + (1 - a/2) t: at t = 0.5 it is 0.5 - a/8, and its derivative by a is -1/8.
TEST(Sense, SolvesConditionsAtSeveralTimes) {
  Shell shell;
  shell.write("boundary.sim", "param a = 1\nx'' = a\nx(0) = 0\nx(1) = 1\nrun 0..1 output 0.5\n");
  const Result result = shell.run("sense boundary.sim --param a -o -");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("-0.125"));
  const Result shortened = shell.run("sense boundary.sim --param a --until 0.5");
  EXPECT_EQ(shortened.exit, 1);
  EXPECT_THAT(shortened.err, AllOf(HasSubstr("error[E245]"), HasSubstr("boundary.sim:4")));
}

TEST(Fit, FindsAParameterOfConditionsAtSeveralTimes) {  // a = 3 in the same
  Shell shell;
  shell.write("boundary.sim", "param a = 1\nx'' = a\nx(0) = 0\nx(1) = 1\nrun 0..1 tol 1e-10\n");
  shell.write("points.csv", "t,x\n0.25,-0.03125\n0.5,0.125\n0.75,0.46875\n");
  const Result result = shell.run("fit boundary.sim points.csv --param a");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(result.out, ContainsRegex("a +3 .* 3 .. 3\n"));
  shell.write("late.csv", "t,x\n0.25,-0.03125\n0.5,0.125\n1.5,0.46875\n");
  const Result late = shell.run("fit boundary.sim late.csv --param a");
  EXPECT_NE(late.exit, 0);
  EXPECT_THAT(late.err, HasSubstr("late.csv:4: the time 1.5 is behind the model's end at 1"));
}

TEST(Fit, FindsAParameterFromTwoFiles) {  // x = exp(-0.5 t), and the double of it
  Shell shell;
  shell.write("decay.sim", decay);
  shell.write("a.csv", "t,x\n0,1\n1,0.60653\n2,\n");
  shell.write("b.csv", "time;both\n1;1.81959\n2;1.10364\n");
  const Result result =
      shell.run("fit decay.sim a.csv b.csv --param a --column both=twice --in b.csv:N=3 --plot fit.svg --starts 3");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("a                       0.5 "));
  EXPECT_THAT(result.out, HasSubstr("4 values"));
  EXPECT_TRUE(shell.has("fit.svg"));
}

TEST(Fit, SaysFileAndLineOfWrongData) {
  Shell shell;
  shell.write("decay.sim", decay);
  shell.write("good.csv", "t,x\n0,1\n1,0.6\n");
  const auto message = [&](const std::string& data, const std::string& more = "--param a") {
    shell.write("d.csv", data);
    const Result result = shell.run("fit decay.sim d.csv " + more);
    EXPECT_NE(result.exit, 0) << data;
    return result.err;
  };
  EXPECT_THAT(message(""), HasSubstr("d.csv:1: the file is empty"));
  EXPECT_THAT(message("t,x\n"), HasSubstr("d.csv:1: no rows"));
  EXPECT_THAT(message("t,x\n0,1\n1,one\n"), HasSubstr("d.csv:3: `one` in column `x` is no number"));
  EXPECT_THAT(message("t,y\n0,1\n"), HasSubstr("d.csv:1: there is no state or output `y`"));
  EXPECT_THAT(message("t,x\n-1,1\n"), HasSubstr("d.csv:2: the time -1 is before the model's start at 0"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param b"), HasSubstr("there is no parameter `b`"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --loss best"), HasSubstr("there is no loss `best`"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --sigma x=-1"), HasSubstr("a deviation is a positive number"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --sigma x=0.1+0%"), HasSubstr("a deviation is a positive number"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --error x=normal"), HasSubstr("there is no error model `normal`"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --error z=poisson"), HasSubstr("there is no column `z`"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --error x=poisson --sigma x=1"), HasSubstr("it is their root"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --error x=proportional --sigma x=0.05"), HasSubstr("5%"));
  EXPECT_THAT(message("t,x,s\n0,1,0\n1,2,1\n", "--param a --sigma x=s"),
              HasSubstr("d.csv:2: the deviation in column `s`"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --log b"), HasSubstr("there is no unknown `b`"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --bounds a=-2..-1 --log a"), HasSubstr("no positive numbers"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --prior 'a=normal(1)'"),
              HasSubstr("is not NAME=normal(MEAN, DEVIATION)"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --prior 'a=lognormal(-1, 1)'"), HasSubstr("lognormal(MEDIAN"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --prior 'b=normal(1, 1)'"), HasSubstr("there is no unknown `b`"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --likelihood full"), HasSubstr("there is no likelihood `full`"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a,a"), HasSubstr("`a` is named twice"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --starts 0"), HasSubstr("no whole number from 1"));
  EXPECT_THAT(message("t,x\n0,1\n1,0\n", "--param a --error x=lognormal"), HasSubstr("d.csv:3: 0 in column `x`"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --bounds a=2"), HasSubstr("`a=2` is not NAME=LOW..HIGH"));
  EXPECT_THAT(message("t,x\n0,1\n", "--param a --column z=x"), HasSubstr("there is no column `z`"));
  EXPECT_THAT(message("t,x\n0,\n", "--param a"), HasSubstr("0 measured values cannot determine 1 unknowns"));
  EXPECT_THAT(shell.run("fit decay.sim none.csv --param a").err, HasSubstr("none.csv:1: the file cannot be read"));
  EXPECT_THAT(shell.run("fit decay.sim good.csv --param a --plot /no/such/x.svg").err, HasSubstr("cannot write"));
}

// x = exp(-t/2 s) in metres, measured in centimetres and milliseconds; the deviation is in the column's unit.
TEST(Fit, BringsHeadingsToTheUnitsOfTheModel) {
  Shell shell;
  shell.write("units.sim", "param a = 1 [1/s] in 0..5\nx' = -a*x\nx(0) = 1 [m]\nrun 0..2 [s]\n");
  shell.write("d.csv", "t [ms],x [cm],s\n0,100,1\n1000,60.653,1\n2000,36.788,1\n");
  const Result found = shell.run("fit units.sim d.csv --param a --sigma x=s --json");
  EXPECT_EQ(found.exit, 0) << found.err;
  const auto result = nlohmann::json::parse(found.out);
  EXPECT_NEAR(result["unknowns"][0]["value"].get<double>(), 0.5, 1e-4);
  // 1/s^2 = sum (t x)^2/0.01^2
  EXPECT_NEAR(result["unknowns"][0]["deviation"].get<double>(), 0.01 / std::hypot(0.60653, 2 * 0.36788), 1e-5);
  EXPECT_NEAR(result["columns"][0]["measured"][1].get<double>(), 0.60653, 1e-12);
  EXPECT_TRUE(result["columns"][0]["deviation_given"].get<bool>());
  shell.write("kg.csv", "t,x [kg]\n0,1\n1,2\n");
  EXPECT_THAT(shell.run("fit units.sim kg.csv --param a").err,
              HasSubstr("kg.csv:1: column `x` is in kg, but the model has it in m"));
  shell.write("no.csv", "t,x [parsnip]\n0,1\n1,2\n");
  EXPECT_THAT(shell.run("fit units.sim no.csv --param a").err, HasSubstr("no.csv:1: column `x`:"));
}

TEST(Fit, SaysAllOfItAsJson) {
  Shell shell;
  shell.write("decay.sim", decay);
  shell.write("d.csv", "t,x\n0,1.01\n0.5,0.77\n1,0.61\n1.5,0.48\n2,0.36\n");
  const Result found =
      shell.run("fit decay.sim d.csv --param a,N --log a --prior 'a=lognormal(0.5, 1)' --profile --json --plot f.png");
  EXPECT_EQ(found.exit, 0) << found.err;
  EXPECT_TRUE(shell.has("f.png"));
  const auto result = nlohmann::json::parse(found.out);
  EXPECT_EQ(result["unknowns"][0]["status"], "determined");
  EXPECT_LT(result["unknowns"][0]["profile"]["interval"][0], result["unknowns"][0]["value"]);
  EXPECT_EQ(result["unknowns"][1]["status"], "undetermined");  // no column reads N
  EXPECT_TRUE(result["unknowns"][1]["deviation"].is_null());
  EXPECT_EQ(result["undetermined"][0]["N"], 1);
  EXPECT_EQ(result["columns"][0]["residuals"].size(), 5);
  EXPECT_TRUE(result["statistics"]["aic"].is_number());
  EXPECT_TRUE(result["statistics"]["chi_squared"].is_null());
  EXPECT_TRUE(result["converged"].get<bool>());
}

TEST(Fit, ALimitOfIterationsIsNoSuccess) {
  Shell shell;
  shell.write("wave.sim", "param w = 5\nx'' = -w^2*x\nx(0) = 1; x'(0) = 0\nrun 0..10\n");
  shell.write("d.csv", "t,x\n1,0.07\n2,-0.99\n3,-0.21\n4,0.96\n5,0.35\n6,-0.91\n");
  const Result stopped = shell.run("fit wave.sim d.csv --param w --iterations 1 --starts 1");
  EXPECT_EQ(stopped.exit, 3);
  EXPECT_THAT(stopped.out, HasSubstr("doubt: the search ended at its limit of 1 iterations, not at a minimum"));
}

TEST(Fit, FitsAWorldOfBodies) {
  Shell shell;
  // Free fall for 0.4 s, by hand: y = 5.5 - g t^2/2 with g = 10; then a bounce at 1 s with restitution 0.5.
  shell.write("ball.sim",
              "param g = 9, e = 0.8 in 0..1\nworld {\n  gravity (0, -g)\n  wall floor (0, 1) at 0\n"
              "  material restitution e friction 0\n  body ball at (0, 5.5) radius 0.5\n}\nrun 0..1\n");
  shell.write("data.csv", "t,ball.y\n0.2,5.3\n0.4,4.7\n0.8,2.3\n1.2,1.3\n1.4,1.7\n1.6,1.7\n");
  const Result found = shell.run("fit ball.sim data.csv --param g,e");
  EXPECT_EQ(found.exit, 0) << found.err;
  EXPECT_THAT(found.out, ContainsRegex("\ng  +10 "));
  EXPECT_THAT(found.out, ContainsRegex("\ne  +0.5 "));
  const Result sense = shell.run("sense ball.sim --param g --set g=10");
  EXPECT_EQ(sense.exit, 0) << sense.err;
  EXPECT_THAT(sense.out, HasSubstr("by differences of runs to both sides"));
  EXPECT_EQ(shell.run("fit ball.sim data.csv --param g --set e=2").exit, 2);
}

}  // namespace
}  // namespace continuo::app
