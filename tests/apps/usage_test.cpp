// Wrong command lines, help, and the verbs that compute nothing.
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"
#include <continuo/solve/catalogue.hpp>

namespace continuo::app {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Usage, HelpBeginsWithExamples) {
  const Shell shell;
  EXPECT_THAT(shell.run("--help").out, StartsWith("Examples:\n  continuo run"));
  for (const std::string verb : {"run", "check", "info", "verify", "compare", "converge", "stability", "sense", "fit",
                                 "methods", "explain", "new"}) {
    const Result help = shell.run(verb + " --help");
    EXPECT_EQ(help.exit, 0) << verb;
    EXPECT_THAT(help.out, StartsWith("Examples:\n  continuo ")) << verb;
    EXPECT_THAT(help.err, IsEmpty()) << verb;
  }
}

TEST(Usage, HelpOfAVerbIsAVerbToo) {
  const Shell shell;
  EXPECT_EQ(shell.run("help").out, shell.run("--help").out);
  EXPECT_EQ(shell.run("help run").out, shell.run("run --help").out);
  const Result wrong = shell.run("help rnu");
  EXPECT_EQ(wrong.exit, 1);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean `run`?"));
}

TEST(Usage, ThePageOfAVerbIsMadeOfItsDeclarations) {
  const Shell shell;
  const std::string pages = shell.run("help --markdown").out;
  EXPECT_THAT(pages, StartsWith("# The command continuo\n"));
  EXPECT_THAT(pages, HasSubstr("| [continuo orbit](verb_orbit.md) | "));
  EXPECT_THAT(pages, HasSubstr("| 130 | "));
  const std::string run = shell.run("help run --markdown").out;
  EXPECT_THAT(run, StartsWith("# continuo run\n"));
  EXPECT_THAT(run, HasSubstr("\ncontinuo run file [OPTIONS]\n"));
  EXPECT_THAT(run, HasSubstr("| `--step` | `H` | Fixed step size. Not together with `--atol`, `--max-step`, "));
  EXPECT_THAT(run, HasSubstr("| `-o`, `--out` | `FILE` | "));
  EXPECT_THAT(run, HasSubstr("| 4 | "));
  EXPECT_THAT(run, HasSubstr("<!-- json: continuo run models/"));
  // Options that only explain why there is no such option are on no page.
  const std::string fit = shell.run("help fit --markdown").out;
  EXPECT_THAT(fit, Not(HasSubstr("`--until`")));
  EXPECT_THAT(fit, HasSubstr("| `--param` | `NAMES` | "));
  EXPECT_THAT(shell.run("help methods --markdown").out, Not(HasSubstr("| 3 | ")));
}

TEST(Usage, NothingAskedShowsTheHelpAndFails) {
  const Result result = Shell().run("");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.out, HasSubstr("verify"));
}

TEST(Usage, TheVersionIsOneLine) {
  EXPECT_THAT(Shell().run("--version").out, StartsWith("continuo 0."));
}

TEST(Usage, AWrongVerbIsToldTheNearest) {
  const Result result = Shell().run("verfy x.sim");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("did you mean `verify`?"));
  EXPECT_THAT(result.out, IsEmpty());
}

TEST(Usage, HelpForAWrongVerbTellsTheNearestOrWhereAllAre) {
  const Shell shell;
  const Result near = shell.run("help verfy");
  EXPECT_EQ(near.exit, 1);
  EXPECT_THAT(near.err, HasSubstr("did you mean `verify`?"));
  const Result far = shell.run("help nope");
  EXPECT_EQ(far.exit, 1);
  EXPECT_THAT(far.err, HasSubstr("there is no verb `nope` (continuo help lists the verbs)"));
}

TEST(Usage, AWrongOptionIsToldTheNearest) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const Result result = shell.run("run spring.sim --metod rk4");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("did you mean `--method`?"));
}

TEST(Usage, StudiesOfMethodsNameWhatIsWrong) {
  const Shell shell;
  shell.write("spring.sim", spring);
  EXPECT_THAT(shell.run("stability rk5").err, HasSubstr("did you mean `rk4`?"));
  EXPECT_THAT(shell.run("converge spring.sim --methods rk5").err, HasSubstr("did you mean `rk4`?"));
  EXPECT_THAT(shell.run("converge spring.sim").err, HasSubstr("--methods"));
  EXPECT_THAT(shell.run("converge --derivative 'sin(y)'").err, HasSubstr("there is no `y`"));
  EXPECT_THAT(shell.run("converge --derivative 'sqrt(x)' --at 0").err, HasSubstr("no derivatives at x = 0"));
  EXPECT_EQ(shell.run("converge spring.sim --methods rk4 --plot orders.gif").exit, 1);
  EXPECT_EQ(shell.run("stability rk4 --model nothing.sim").exit, 1);
}

TEST(Usage, AWrongMethodOrParameterIsToldTheNearest) {
  const Shell shell;
  shell.write("spring.sim", "model Spring\nparam stiffness = 4\nx' = -stiffness*x\nx(0) = 1\nrun 0..1\n");
  const Result method = shell.run("run spring.sim --method dop85");
  EXPECT_EQ(method.exit, 1);
  EXPECT_THAT(method.err, HasSubstr("`dop853`"));
  // Its place is the option: the model is not to blame.
  EXPECT_THAT(method.err, HasSubstr("--> --method:1:1\n  1 | dop85\n    | ^^^^^"));
  EXPECT_THAT(method.err, Not(HasSubstr("spring.sim")));
  const auto messages = nlohmann::json::parse(shell.run("run spring.sim --method dop85 --json").out)["messages"];
  EXPECT_EQ(messages.at(0).at("code"), "E330");
  EXPECT_EQ(messages.at(0).at("file"), "--method");
  const Result parameter = shell.run("run spring.sim --set stifness=5");
  EXPECT_EQ(parameter.exit, 1);
  EXPECT_THAT(parameter.err, HasSubstr("`stiffness`"));
}

TEST(Usage, NumbersThatAreNoneAreRefused) {
  const Shell shell;
  shell.write("spring.sim", spring);
  for (const char* wrong : {"--tol fast", "--step", "--until x", "--set k", "--set k=", "--tol 1e-6 --step 0.1",
                            "--set k=1 --set k=2", "--tol 1e-6 --tol 1e-8"}) {
    const Result result = shell.run(std::string("run spring.sim ") + wrong);
    EXPECT_EQ(result.exit, 1) << wrong;
    EXPECT_THAT(result.err, Not(IsEmpty())) << wrong;
    EXPECT_THAT(result.out, IsEmpty()) << wrong;
  }
}

TEST(Usage, AFileThatIsNotThereIsToldTheNearest) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const Result result = shell.run("run sprong.sim");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("cannot read sprong.sim: No such file or directory; did you mean `spring.sim`?"));
  EXPECT_EQ(shell.run("run .").exit, 1);
  EXPECT_EQ(shell.run("check .").exit, 0);
}

TEST(Usage, MessagesHaveNoColoursOutsideATerminal) {
  const Shell shell;
  shell.write("wrong.sim", "model Wrong\nx' = -y\nx(0) = 1\nrun 0..1\n");
  EXPECT_THAT(shell.run("run wrong.sim").err, Not(HasSubstr("\033")));
}

TEST(Check, AWrongModelIsShownWithItsPlace) {
  const Shell shell;
  shell.write("wrong.sim", "model Wrong\nx' = -y\nx(0) = 1\nrun 0..1\n");
  const Result result = shell.run("check wrong.sim");
  EXPECT_EQ(result.exit, 2);
  EXPECT_THAT(result.err, HasSubstr("wrong.sim:2:7"));
  EXPECT_EQ(shell.run("run wrong.sim").exit, 2);
  EXPECT_EQ(shell.run("verify wrong.sim").exit, 2);
  EXPECT_THAT(shell.run("check wrong.sim --json").out, HasSubstr("\"line\":"));
}

TEST(Check, DerivativesAreComparedWithDifferencesAlongARun) {
  const Shell shell;
  const Result result = shell.run("check " + gallery("robertson") + " --jacobian");
  EXPECT_EQ(result.exit, 0);
  EXPECT_THAT(result.out, HasSubstr("df/dx   3 x 3, pattern of 8"));
  EXPECT_THAT(result.out, HasSubstr("right   by differences at "));
  EXPECT_THAT(result.out, Not(HasSubstr("wrong")));
  shell.write("kink.sim", "x' = v\nv' = -abs(v)\nx(0) = 1; v(0) = 0\nrun 0..1\n");
  EXPECT_THAT(shell.run("check kink.sim --jacobian").out, HasSubstr("kink    d(v')/d(v) at t = 0: 1 below, -1 above"));
  const auto object = nlohmann::json::parse(shell.run("check kink.sim --jacobian --json").out);
  EXPECT_TRUE(object["messages"].empty());
  EXPECT_EQ(object["files"][0]["jacobian"]["kinks"][0]["entry"], "d(v')/d(v)");
  EXPECT_TRUE(object["files"][0]["jacobian"]["agrees"]);
}

TEST(Check, DerivativesOfAModelWithoutARunAreNotCompared) {
  const Shell shell;
  shell.write("short.sim", "x' = -x\nx(0) = 1\n");
  const Result result = shell.run("check short.sim --jacobian");
  EXPECT_EQ(result.exit, 3);
  EXPECT_THAT(result.err, HasSubstr("E333"));
}

TEST(Info, NamesStatesParametersAndEvents) {
  const Shell shell;
  const Result result = shell.run("info " + gallery("bouncing_ball"));
  EXPECT_EQ(result.exit, 0);
  for (const char* part : {"h'", "v_rest", "m/s^2", "flight", "h falls through 0", "kinetic", "dop853"}) {
    EXPECT_THAT(result.out, HasSubstr(part));
  }
}

TEST(Methods, EveryMethodHasItsSource) {
  const std::string table = Shell().run("methods").out;
  std::istringstream lines(table);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_GT(line.size(), 60u) << line;
  EXPECT_EQ(count, 1 + method_catalogue().size());  // the heading, and one each
}

TEST(Methods, SayWhyOneIsChosen) {
  const Shell shell;
  EXPECT_THAT(shell.run("methods --why " + gallery("pendulum_dae")).out, HasSubstr("rodas5p; the model names it"));
  EXPECT_THAT(shell.run("methods --why " + gallery("lorenz")).out, HasSubstr(": "));
  EXPECT_THAT(shell.run("methods --why " + gallery("spring_plane")).out, HasSubstr("dprkn12_radau; x'' = a(t, x)"));
  EXPECT_EQ(shell.run("methods --why nowhere.sim").exit, 1);
}

TEST(Explain, SaysMoreAboutACodeAndListsThem) {
  const Shell shell;
  EXPECT_THAT(shell.run("explain E201").out, StartsWith("E201: "));
  EXPECT_THAT(shell.run("explain e310").out, StartsWith("E310: "));
  EXPECT_EQ(shell.run("explain E999").exit, 1);
  EXPECT_THAT(shell.run("explain").out, HasSubstr("E310"));
}

TEST(New, TheStarterRunsAndIsNeverOverwritten) {
  const Shell shell;
  EXPECT_EQ(shell.run("new my-spring").exit, 0);
  EXPECT_THAT(shell.read("my-spring.sim"), HasSubstr("model MySpring\n"));
  EXPECT_EQ(shell.run("run my-spring.sim").exit, 0);
  EXPECT_EQ(shell.run("verify my-spring.sim").exit, 0);
  shell.write("my-spring.sim", "mine");
  EXPECT_EQ(shell.run("new my-spring").exit, 1);
  EXPECT_EQ(shell.read("my-spring.sim"), "mine");
}

TEST(New, EachTemplateIsInOrderPassesItsChecksAndHasADrawing) {
  const Shell shell;
  for (const std::string name : {"spring", "ball", "pendulum", "world"}) {
    EXPECT_EQ(shell.run("new own_" + name + " --template " + name).exit, 0) << name;
    EXPECT_THAT(shell.read("own_" + name + ".sim"), HasSubstr("\ndraw { ")) << name;
    const auto checked = shell.run("check own_" + name + ".sim");
    EXPECT_EQ(checked.exit, 0) << checked.err;
    EXPECT_THAT(checked.err, Not(HasSubstr("warning"))) << name;
    EXPECT_EQ(shell.run("verify own_" + name + ".sim").exit, 0) << name;
  }
  const auto wrong = shell.run("new other --template pendulm");
  EXPECT_EQ(wrong.exit, 1);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean `pendulum`"));
}

TEST(View, AModelThatIsNotThereIsLookedForInTheGallery) {
  const Shell shell;
  const auto result = shell.run("view bouncing_bal.sim --no-open");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("bouncing_ball.sim"));
  EXPECT_EQ(shell.run("view --export out.html").exit, 1);
}

}  // namespace
}  // namespace continuo::app
