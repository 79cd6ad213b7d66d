// Questions without an answer: every verb that studies a model is given each bad question and must refuse it with its
// reason.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shell.hpp"

namespace continuo::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Every verb that studies a model, with options by which it would succeed.
const std::vector<std::string> studies{
    "run MODEL",
    "compare MODEL --methods rk4 --step 0.1",
    "converge MODEL --methods rk4 --most-steps 64",
    "stability rk4 --model MODEL",
    "steady MODEL",
    "linearize MODEL",
    "phase MODEL",
    "orbit MODEL --section x=0",
    "sense MODEL --param k",
    "fit MODEL data.csv --param k",
};

std::string asked(std::string study, const std::string& model, const std::string& more = "") {
  study.replace(study.find("MODEL"), 5, model);
  return study + " " + more;
}

/// A folder with a good model and its data, for which the tests substitute bad ones.
struct Folder : Shell {
  Folder() {
    write("good.sim", "param k = 4 in 0..9\nx'' = -k*x\nx(0) = 1; x'(0) = 0\nrun 0..2 output 0.5\n");
    write("data.csv", "t,x\n0.5,0.54\n1,-0.42\n1.5,-0.99\n");
  }
};

TEST(BadStudies, TheQuestionsBelowHaveAnAnswerForAGoodModel) {
  const Folder folder;
  for (const std::string& study : studies) {
    const Result result = folder.run(asked(study, "good.sim"));
    EXPECT_EQ(result.exit, 0) << study << "\n" << result.err;
  }
}

TEST(BadStudies, AnUnknownParameterIsToldTheNearest) {
  const Folder folder;
  folder.write("named.sim", "param k = 4, stiffness = 4\nx'' = -stiffness*x\nx(0) = 1; x'(0) = 0\nrun 0..2\n");
  for (const std::string& study : studies) {
    const Result result = folder.run(asked(study, "named.sim", "--set stifness=5"));
    EXPECT_EQ(result.exit, 1) << study;
    EXPECT_THAT(result.err, HasSubstr("`stiffness`")) << study;
  }
}

TEST(BadStudies, AModelWithAMistakeIsNamedWithItsLine) {
  const Folder folder;
  folder.write("bad.sim", "param k = 4\nx'' = -k*y\nx(0) = 1; x'(0) = 0\nrun 0..2\n");
  for (const std::string& study : studies) {
    const Result result = folder.run(asked(study, "bad.sim"));
    EXPECT_EQ(result.exit, 2) << study;
    EXPECT_THAT(result.err, HasSubstr("bad.sim:2:")) << study;
  }
}

TEST(BadStudies, AMissingModelIsNamed) {
  const Folder folder;
  for (const std::string& study : studies) {
    const Result result = folder.run(asked(study, "missing.sim"));
    EXPECT_EQ(result.exit, 1) << study;
    EXPECT_THAT(result.err, HasSubstr("missing.sim")) << study;
  }
}

TEST(BadStudies, AFileThatCannotBeWrittenIsNamed) {
  const Folder folder;
  const std::vector<std::string> with_plot{studies[0],   studies[1], studies[2], studies[3],
                                           studies[6],   studies[8], studies[9], "steady MODEL --along k=1..5",
                                           "orbit MODEL"};
  for (const std::string& study : with_plot) {
    const Result nowhere = folder.run(asked(study, "good.sim", "--plot /no/such/folder/x.svg"));
    EXPECT_EQ(nowhere.exit, 1) << study;
    EXPECT_THAT(nowhere.err, HasSubstr("cannot write /no/such/folder/x.svg")) << study;
    EXPECT_EQ(nowhere.out, "") << study << " began before it looked";
    const Result ending = folder.run(asked(study, "good.sim", "--plot x.bmp"));
    EXPECT_EQ(ending.exit, 1) << study;
    EXPECT_THAT(ending.err, HasSubstr("cannot plot to x.bmp")) << study;
  }
  for (const std::string& study : {studies[0], studies[7], studies[8], std::string("report MODEL")}) {
    const Result nowhere = folder.run(asked(study, "good.sim", "-o /no/such/folder/x"));
    EXPECT_EQ(nowhere.exit, 1) << study;
    EXPECT_THAT(nowhere.err, HasSubstr("cannot write /no/such/folder/x")) << study;
    EXPECT_EQ(nowhere.out, "") << study << " began before it looked";
  }
}

TEST(BadStudies, ConditionsAtSeveralTimesAreRefusedByWhatFollowsAStart) {
  const Folder folder;
  folder.write("boundary.sim", "param k = 4\nx'' = -k*x\nx(0) = 1\nx(2) = -0.65\nrun 0..2\n");
  for (const std::string& study : studies) {
    const Result result = folder.run(asked(study, "boundary.sim"));
    if (study == studies[0] || study.starts_with("sense") || study.starts_with("fit")) {
      EXPECT_EQ(result.exit, 0) << result.err;
      continue;
    }
    EXPECT_NE(result.exit, 0) << study;
    EXPECT_THAT(result.err, HasSubstr("boundary.sim:3")) << study;
  }
}

TEST(BadStudies, BoundaryValuesThatDetermineNothing) {
  const Folder folder;
  // x'' = -pi^2 x with x(0) = x(1) = 0: every multiple of sin(pi t), so the matrix of the conditions is singular.
  folder.write("singular.sim", "x'' = -pi^2*x\nx(0) = 0\nx(1) = 1\nrun 0..1\n");
  const Result singular = folder.run("run singular.sim");
  EXPECT_EQ(singular.exit, 3);
  EXPECT_THAT(singular.err, AllOf(HasSubstr("error[E322]"), HasSubstr("singular.sim:2:")));
  folder.write("few.sim", "x'' = 2\ny' = x\nx(1) = 3\ny(7) = 4\nrun 1..7\n");
  EXPECT_THAT(folder.run("run few.sim").err, AllOf(HasSubstr("error[E244]"), HasSubstr("few.sim:")));
  folder.write("outside.sim", "x'' = 2\nx(1) = 3\nx(9) = 4\nrun 1..7\n");
  EXPECT_THAT(folder.run("run outside.sim").err, AllOf(HasSubstr("error[E245]"), HasSubstr("outside.sim:3:")));
}

TEST(BadStudies, WhereNothingRestsTheEquationIsNamedWithItsLine) {
  const Folder folder;
  folder.write("fall.sim", "h'' = -9.8\nh(0) = 10\nh'(0) = 0\nrun 0..1\n");
  for (const std::string verb : {"steady", "linearize"}) {
    const Result result = folder.run(verb + " fall.sim");
    EXPECT_EQ(result.exit, 3) << verb;
    EXPECT_THAT(result.err, AllOf(HasSubstr("fall.sim:3: no equilibrium"), HasSubstr("`h'`"))) << verb;
  }
  EXPECT_THAT(folder.run("orbit fall.sim").err, HasSubstr("does not return to an earlier state"));
  EXPECT_EQ(folder.run("orbit fall.sim").exit, 3);
}

// df/dx = -1/(2 sqrt(x)) is infinite at x = 0; d(x^2 + y)/dx = 0 at the only equilibrium of the other model.
TEST(BadStudies, AJacobianThatIsNoneOrSingular) {
  const Folder folder;
  folder.write("kink.sim", "y' = -y\nx' = -sqrt(x)\ny(0) = 1\nx(0) = 0\nrun 0..1\n");
  const Result kink = folder.run("linearize kink.sim --start");
  EXPECT_EQ(kink.exit, 3);
  EXPECT_THAT(kink.err, HasSubstr("kink.sim:4: the equation of `x` has no derivative by `x`"));
  folder.write("line.sim",
               "x' = -x + y\ny' = (x - y)*(1 + x^2)\nx(0) = 1\ny(0) = 0\nrun 0..1\n");  // all x = y are equilibria
  const Result line = folder.run("steady line.sim");
  EXPECT_THAT(line.out, HasSubstr("not isolated")) << line.err;
}

TEST(BadStudies, MethodsAndStepsThatWouldHaveNoPart) {
  const Folder folder;
  for (const std::string& study : {studies[8], studies[9]}) {
    for (const std::string option : {"--method rk4", "--step 0.1"}) {
      const Result result = folder.run(asked(study, "good.sim", option));
      EXPECT_EQ(result.exit, 1) << study << option;
      EXPECT_THAT(result.err, HasSubstr("chooses the method and the steps itself; --tol says how exact")) << study;
    }
  }
  EXPECT_THAT(folder.run(asked(studies[9], "good.sim", "--until 1")).err, HasSubstr("last time"));
  EXPECT_THAT(folder.run(asked(studies[9], "good.sim", "--tol 1e-4")).err, HasSubstr("need 1e-08 or less"));
  folder.write("steps.sim", "param k = 4 in 0..9\nx'' = -k*x\nx(0) = 1; x'(0) = 0\nrun 0..2 method rk4 step 0.1\n");
  for (const std::string& study : {studies[8], studies[9]}) {
    const Result result = folder.run(asked(study, "steps.sim"));
    EXPECT_EQ(result.exit, 0);
    EXPECT_THAT(result.err, HasSubstr("steps.sim:4: a fixed step is not possible here")) << study;
  }
}

TEST(BadStudies, WhatHasNoRunTakesNoTimeToEndIt) {
  const Folder folder;
  for (const std::string& study : {studies[4], studies[5], studies[6], studies[7]}) {
    const Result result = folder.run(asked(study, "good.sim", "--until 3"));
    EXPECT_EQ(result.exit, 1) << study;
    EXPECT_THAT(result.err, HasSubstr("has no option --until")) << study;
  }
}

TEST(BadStudies, TolerancesAreHonoured) {
  const Folder folder;
  const auto steps = [&](const std::string& tolerance) {  // x at the end, to the digits of the tolerance
    return folder.run("sense good.sim --param k -o - --tol " + tolerance).out;
  };
  EXPECT_NE(steps("1e-3"), steps("1e-11"));
}

TEST(BadStudies, AStudyThatReportDoesNotKnow) {
  const Folder folder;
  const Result result = folder.run("report good.sim --with stedy -o page.html");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("did you mean `steady`?"));
}

TEST(BadStudies, ConvergeOfWhatHasNoReference) {
  const Folder folder;
  folder.write("blow.sim", "x' = x^2\nx(0) = 1\nrun 0..2\n");  // 1/(1 - t)
  const Result result = folder.run("converge blow.sim --methods rk4");
  EXPECT_EQ(result.exit, 3);
  EXPECT_THAT(result.err, HasSubstr("there is no reference run"));
}

/// Commands that contradict themselves, each with the message that refuses it.
void expect_refused(const Shell& shell, const std::vector<std::pair<std::string, std::string>>& commands) {
  for (const auto& [command, said] : commands) {
    const Result result = shell.run(command);
    EXPECT_EQ(result.exit, 1) << command << "\n" << result.out;
    EXPECT_THAT(result.err, HasSubstr(said)) << command;
    EXPECT_EQ(result.out, "") << command;
  }
}

TEST(BadStudies, NoRelativeToleranceIsOneOrMore) {
  const Folder folder;
  folder.write("at_both.sim", "param p = 1 in 0..3\nu'' = -p*u\nu(0) = 0; u(1) = 1\nrun 0..1\n");
  const std::string why = "a relative tolerance is a part of the state's size, less than 1";
  expect_refused(folder, {{"run good.sim --tol 2", why},
                          {"run good.sim --tol x=1", why},
                          {"run at_both.sim --family p=0..2 --tol 2", why},
                          {"sense good.sim --param k --tol 2", why},
                          {"orbit good.sim --tol 2", "no number from 1e-14 to less than 1"},
                          {"orbit good.sim --tol 1e-30", "no number from 1e-14 to less than 1"}});
  folder.write("loose.sim", "x' = -x\nx(0) = 1\nrun 0..1 tol 2\n");
  const Result written = folder.run("check loose.sim");
  EXPECT_EQ(written.exit, 2);
  EXPECT_THAT(written.err, HasSubstr(why));
  EXPECT_EQ(folder.run("run good.sim --atol 2").exit, 0);  // in the unit of the state
}

TEST(BadStudies, StepsAlongABranchLieWithinItsRange) {
  const Folder folder;
  folder.write("fold.sim", "param r = 1 in -1..2\nx' = r - x^2\nx(0) = 0.5\nrun 0..10\n");
  for (const std::string& verb : {std::string("steady"), std::string("orbit")}) {
    const std::string along = verb + " fold.sim --along r=-1..2 ";
    expect_refused(folder, {{along + "--ds 2", "--ds is 2: a step is a fraction of the range, at most 1"},
                            {along + "--ds-max 5", "--ds-max is 5: a step is a fraction of the range, at most 1"},
                            {along + "--ds 1e-9", "--ds-min is 1e-07, and --ds is less, 1e-09"},
                            {along + "--ds-max 1e-12", "--ds-min is 1e-07, and --ds-max is less, 1e-12"},
                            {along + "--ds-min 0.5", "--ds-min is 0.5, and --ds-max is less, 0.05"}});
  }
  EXPECT_EQ(folder.run("steady fold.sim --along r=-1..2 --ds 0.2").exit, 0);
}

TEST(BadStudies, AnEmptyTextIsNoValueOfAnOption) {
  const Folder folder;
  for (const std::string& asked : {std::string("run good.sim -o ''"), std::string("run good.sim --family ''"),
                                   std::string("steady good.sim --along ''"), std::string("steady good.sim --mode ''"),
                                   std::string("orbit good.sim --along k=1..4 --ds ''"),
                                   std::string("explore good.sim --plot ''"), std::string("sense good.sim --param ''"),
                                   std::string("fit good.sim data.csv --param k --loss ''"), std::string("run ''")}) {
    const Result result = folder.run(asked);
    EXPECT_EQ(result.exit, 1) << asked;
    EXPECT_THAT(result.err, HasSubstr("a value is missing")) << asked;
  }
}

TEST(BadStudies, WhatHasNoPartIsRefusedAndNotPassedOver) {
  const Folder folder;
  folder.write("at_both.sim", "param p = 1 in 0..3\nu'' = -p*u\nu(0) = 0; u(1) = 1\nrun 0..1\n");
  const std::string family = "run at_both.sim --family p=0..2 ";
  expect_refused(
      folder,
      {{family + "--events e.csv", "there is no --events: leave it out"},
       {family + "--manifest m.json", "there is no --manifest: leave it out"},
       {family + "--estimate-error", "there is no --estimate-error: leave it out"},
       {family + "--output 0.1", "there is no --output: leave it out"},
       {"steady good.sim --of x", "--of requires --along"},
       {"steady good.sim --box x=0..1 --box x=0..2", "--box x=0..2: `x` is given twice"},
       {"sense good.sim --param k,k", "`k` is named twice"},
       {"sense good.sim --initial x,x", "`x(0)` is named twice"},
       {"sense good.sim --param k --of equilibrium --until 3", "--of equilibrium takes --param and --json alone"},
       {"sense good.sim --param k --of period --output 1", "--of period takes --param and --json alone"},
       {"orbit good.sim --period 0", "--period: 0 is no number above 0"},
       {"orbit good.sim --period nan", "--period: nan is no number above 0"}});
  folder.write("fold.sim", "param r = 1 in -1..2\nx' = r - x^2\nx(0) = 0.5\nrun 0..10\n");
  expect_refused(folder, {{"steady fold.sim --along r=-1..2 --of nope", "there is no state `nope`"}});
}

TEST(Fit, CtrlCKeepsWhatWasFound) {
  const Folder folder;
  // Two data sets with deviations of their own, many starts, and runs of thousands of oscillations: it takes minutes.
  folder.write("long.sim",
               "param k = 4 in 0..9, c = 0.001 in 0..1\nx'' = -k*x - c*x'\nx(0) = 1; x'(0) = 0\n"
               "output v = x'\nrun 0..2000\n");
  folder.write("a.csv", "t,x,v\n0.5,0.54,-1.7\n1,-0.42,-1.8\n1.5,-0.99,-0.3\n2000,0.1,0.1\n");
  folder.write("b.csv", "t,x\n0.5,0.54\n1,-0.42\n1.5,-0.99\n2000,0.2\n");
  const Result result = folder.run("fit long.sim a.csv b.csv --param k,c --starts 100000",
                                   "timeout --foreground --preserve-status --signal INT 3");
  EXPECT_EQ(result.exit, 130) << result.err;
  // The number of starts completed by then depends on the machine.
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("k "), HasSubstr("c "), HasSubstr("interrupted: the best there was until then")));
}

TEST(Run, OtherRowsAreNoOtherMotion) {
  const Folder folder;
  folder.write("checked.sim", "x' = -x\nx(0) = 1\nrun 0..1 output 0.1 tol 1e-10\ncheck x(0.55) = 1 within 1e-9\n");
  EXPECT_EQ(folder.run("run checked.sim --output 0.3").exit, 4);  // the checks judge it
  EXPECT_EQ(folder.run("run checked.sim --until 2").exit, 0);
}

}  // namespace
}  // namespace continuo::app
