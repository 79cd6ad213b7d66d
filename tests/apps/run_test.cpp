// The output and the files of `run`, `compare` and `verify`.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"

namespace continuo::app {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

TEST(Run, TheSummarySaysHowItEndedAndWhatItCost) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const Result result = shell.run("run spring.sim");
  EXPECT_EQ(result.exit, 0);
  EXPECT_THAT(result.err, IsEmpty());
  EXPECT_THAT(result.out, StartsWith("Spring: reached end at t = 2\n"));
  for (const char* part : {"x' =", "events", "energy", "cost"}) EXPECT_THAT(result.out, HasSubstr(part));
}

TEST(Run, RowsGoToAFileWithTheirManifestBeside) {
  const Shell shell;
  shell.write("spring.sim", spring);
  ASSERT_EQ(shell.run("run spring.sim -o out.csv --events events.csv").exit, 0);
  const auto rows = lines_of(shell.read("out.csv"));
  const json manifest = json::parse(shell.read("out.csv.manifest.json"));
  EXPECT_EQ(rows[0], "# manifest " + manifest["hash"].get<std::string>());
  EXPECT_THAT(rows[1], StartsWith("t,x,x'"));
  EXPECT_THAT(rows[2], StartsWith("0,1,0"));
  EXPECT_EQ(manifest["parameters"]["k"], 4.0);
  EXPECT_EQ(manifest["model"]["text"], spring);
  const auto events = lines_of(shell.read("events.csv"));
  EXPECT_EQ(events[0], rows[0]);
  EXPECT_EQ(events[1], "event,t,before x,before x',after x,after x'");
  ASSERT_THAT(events, SizeIs(3));  // cos(2 t) falls through 0 at t = pi/4 alone before t = 2
}

TEST(Run, StandardOutputCarriesDataAlone) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const Result result = shell.run("run spring.sim -o -");
  EXPECT_EQ(result.exit, 0);
  EXPECT_THAT(lines_of(result.out)[1], StartsWith("t,x,x'"));
  EXPECT_THAT(result.out, Not(HasSubstr("reached end")));
}

TEST(Run, JsonIsOneObjectWithTheClosedFormInIt) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const json result = json::parse(shell.run("run spring.sim --json").out);
  EXPECT_EQ(result["outcome"], "reached end");
  EXPECT_EQ(result["t"], 2.0);
  EXPECT_NEAR(result["state"]["x"], std::cos(4.0), 1e-8);  // x = cos(sqrt(k) t), tolerance 1e-10 over 2 units
  EXPECT_NEAR(result["state"]["x'"], -2 * std::sin(4.0), 2e-8);
  ASSERT_THAT(result["events"], SizeIs(1));
  EXPECT_NEAR(result["events"][0]["t"], std::numbers::pi / 4, 1e-9);
  EXPECT_LT(result["energy"]["drift"], 1e-8);
  EXPECT_GT(result["statistics"]["evaluations"], 0);
}

TEST(Run, OptionsOverrideTheModelItemByItem) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const json result = json::parse(shell.run("run spring.sim --json --set k=1 --until 3 --method rk4 --step 0.001").out);
  EXPECT_NEAR(result["state"]["x"], std::cos(3.0), 1e-12);
  EXPECT_EQ(result["statistics"]["rejected"], 0);
  ASSERT_EQ(shell.run("run spring.sim --output 0.25 -o out.csv").exit, 0);
  EXPECT_GE(lines_of(shell.read("out.csv")).size(), 2u + 9u);
}

TEST(Run, StepsMayBeLimited) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const auto steps = [](const Result& result) { return json::parse(result.out)["statistics"]["steps"].get<double>(); };
  EXPECT_GE(steps(shell.run("run spring.sim --json --max-step 1/128 --until 2")), 256);
  EXPECT_THAT(shell.run("run spring.sim --max-step 0.25").out, HasSubstr(", max step 0.25\n"));
  const Result few = shell.run("run spring.sim --max-steps 5");
  EXPECT_NE(few.exit, 0);
  EXPECT_THAT(few.err, HasSubstr("error[E303]"));
  for (const char* wrong : {"--max-step 0", "--max-step=-1", "--max-step x", "--max-steps 0", "--max-steps 2.5",
                            "--max-step 0.1 --step 0.1"})
    EXPECT_EQ(shell.run(std::string("run spring.sim ") + wrong).exit, 1) << wrong;
}

// Two decays, in m and in um: both end at exp(-1) of where they began.
constexpr const char* two_sizes =
    "model TwoSizes\nparam k = 1 [1/s]\nlarge' = -k*large\nsmall' = -k*small\n"
    "large(0) = 1 [m]; small(0) = 1 [um]\nrun 0..1 [s] output 0.5 method dormand_prince5 tol 1e-6\n";

TEST(Run, ToleranceOfSingleStates) {
  const Shell shell;
  shell.write("two.sim", two_sizes);
  const auto run = [&](const std::string& options) {
    const Result result = shell.run("run two.sim --estimate-error --json --manifest m.json " + options);
    EXPECT_EQ(result.exit, 0) << result.err;
    return json::parse(result.out);
  };
  const auto manifest = [&] { return json::parse(shell.read("m.json")); };
  const auto steps = [](const json& result) { return result["statistics"]["steps"].get<int>(); };
  const json loose = run("");
  EXPECT_EQ(manifest()["rtol"], 1e-6);
  const json tight = run("--tol 1e-6 --tol small=1e-10");
  EXPECT_EQ(manifest()["rtol"], json({1e-6, 1e-10}));
  EXPECT_EQ(manifest()["atol"], json({1e-9, 1e-13}));  // a thousandth of each
  EXPECT_GT(steps(tight), steps(loose));
  const json absolute = run("--rtol 1e-6 --atol 1e-8 --atol 'small = 1e-9 [mm]'");
  EXPECT_EQ(manifest()["rtol"], 1e-6);
  EXPECT_EQ(manifest()["atol"][0], 1e-8);
  EXPECT_NEAR(manifest()["atol"][1].get<double>(), 1e-6, 1e-20);  // in the state's unit, um
}

TEST(Run, ToleranceOfNamesThatAreNone) {
  const Shell shell;
  shell.write("two.sim", two_sizes);
  const Result wrong = shell.run("run two.sim --atol smal=1e-12");
  EXPECT_EQ(wrong.exit, 1);
  EXPECT_THAT(wrong.err, HasSubstr("error[E344]: the model has no state `smal`"));
  EXPECT_THAT(wrong.err, HasSubstr("did you mean `small`?"));
  EXPECT_THAT(shell.run("run two.sim --tol k=1e-12").err, HasSubstr("its states are large, small"));
  for (const char* option : {"--tol small=0", "--tol=-1", "--atol 'small=1e-9 [s]'", "--tol small=", "--tol =1e-9",
                             "--tol 'small=1e-9 [m]'", "--atol 0", "--atol small=1e-9 --step 0.1"}) {
    const Result result = shell.run(std::string("run two.sim ") + option);
    EXPECT_EQ(result.exit, 1) << option;
    EXPECT_THAT(result.err, Not(IsEmpty())) << option;
    EXPECT_THAT(result.out, IsEmpty()) << option;
  }
}

TEST(Run, ToleranceOfAFamilyAndOfOneOfIt) {
  const Shell shell;
  shell.write("rod.sim", "for i in 1..3 { u[i]' = -u[i];  u[i](0) = 1 }\nv' = -v\nv(0) = 1\nrun 0..1\n");
  ASSERT_EQ(shell.run("run rod.sim --tol u=1e-8 --tol 'u[2]=1e-10' --manifest m.json").exit, 0);
  EXPECT_EQ(json::parse(shell.read("m.json"))["rtol"], json({1e-8, 1e-10, 1e-8, 1e-6}));
}

TEST(Run, TheEstimateStandsBesideTheTolerance) {
  const Shell shell;
  shell.write("two.sim", two_sizes);
  const std::string text = shell.run("run two.sim --tol 1e-4 --atol small=1e-9 --estimate-error").out;
  EXPECT_THAT(text, ContainsRegex("large = 0.3678[0-9]* \\+- [0-9e.-]+ m \\(tolerance 4e-05\\)"));  // 1e-4 exp(-1)
  EXPECT_THAT(text, ContainsRegex("error   at most [0-9e.-]+ u?m in (large|small), [0-9e.-]+ times its tolerance"));
  EXPECT_THAT(shell.run("run two.sim --method rk4 --step 0.1 --estimate-error").out, HasSubstr("by half the step"));
}

TEST(Run, TheSameRunHasTheSameBytes) {
  const Shell shell;
  for (const char* file : {"a.csv", "b.csv"}) {
    ASSERT_EQ(shell.run("run " + gallery("bouncing_ball") + " -o " + file).exit, 0);
  }
  EXPECT_EQ(shell.read("a.csv"), shell.read("b.csv"));
}

TEST(Run, APictureIsDrawnInBothFormats) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
  const Shell shell;
  ASSERT_EQ(shell.run("run " + gallery("bouncing_ball") + " --plot ball.svg").exit, 0);
  ASSERT_EQ(shell.run("run " + gallery("kepler") + " --plot orbit.png").exit, 0);
  EXPECT_THAT(shell.read("ball.svg"), HasSubstr("h [m]"));
  EXPECT_EQ(shell.read("orbit.png").substr(1, 3), "PNG");
}

TEST(Run, WithoutGnuplotTheRowsAreKeptAndTheMessageSaysWhatToInstall) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const Result result = shell.run("run spring.sim -o out.csv --plot out.svg", "PATH=/nowhere");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("gnuplot-nox"));
  EXPECT_THAT(shell.read("out.csv"), HasSubstr("t,x,x'"));
}

TEST(Run, AFolderThatIsNotThereIsToldBeforeTheRunAFullDiskAfterIt) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const Result result = shell.run("run spring.sim -o no/out.csv");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("cannot write no/out.csv: No such file or directory"));
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_EQ(shell.run("run spring.sim --plot out.bmp").exit, 1);
  EXPECT_EQ(shell.run("run spring.sim -o /dev/full --manifest m.json").exit, 1);
}

TEST(Run, ABlowUpKeepsWhatWasComputed) {  // x' = x^2 from 1: x = 1/(1 - t)
  const Shell shell;
  shell.write("blow.sim", "model Blow\nx' = x^2\nx(0) = 1\nrun 0..2 output 0.1\n");
  const Result result = shell.run("run blow.sim -o out.csv");
  EXPECT_EQ(result.exit, 3);
  EXPECT_THAT(result.err, HasSubstr("error[E30"));
  EXPECT_GE(lines_of(shell.read("out.csv")).size(), 2u + 10u);
  const json object = json::parse(shell.run("run blow.sim --json").out);
  EXPECT_NEAR(object["t"], 1.0, 1e-3);
  EXPECT_TRUE(object["failure"].contains("message"));
}

TEST(Run, CtrlCKeepsWhatWasComputed) {
  const Shell shell;
  const Result result = shell.run("run " + gallery("lorenz") + " --until 1e9 --output 1 -o out.csv",
                                  "timeout --foreground --preserve-status --signal INT 1");
  EXPECT_EQ(result.exit, 130);
  EXPECT_GT(lines_of(shell.read("out.unfinished.csv")).size(), 10u);
}

TEST(Run, AFailedCheckIsExitCodeFourForTheModelAsWritten) {
  const Shell shell;
  shell.write("wrong.sim", std::string(spring) + "check x(2) = 0 within 1e-9\n");
  const Result result = shell.run("run wrong.sim");
  EXPECT_EQ(result.exit, 4);
  EXPECT_THAT(result.err, HasSubstr("check x(2) = 0 within 1e-9 does not hold: it is -0.65"));
  const Result other = shell.run("run wrong.sim --set k=5");
  EXPECT_EQ(other.exit, 0);  // checks apply only to the model as written
  EXPECT_THAT(other.out, HasSubstr("1 failed; they apply to the model as written in its file"));
  EXPECT_THAT(other.out, HasSubstr("check x(2) = 0 within 1e-9 does not hold: it is -0.23"));  // cos(2 sqrt(5))
}

TEST(Verify, ListsEveryModelAndWhatDoesNotHold) {
  const Shell shell;
  shell.write("good.sim", std::string(spring) + "check x(2) = cos(4) within 1e-8\n");
  shell.write("wrong.sim", std::string(spring) + "check x(2) = 0 within 1e-9\n");
  EXPECT_EQ(shell.run("verify good.sim").exit, 0);
  const Result result = shell.run("verify .");
  EXPECT_EQ(result.exit, 4);
  EXPECT_THAT(result.out, HasSubstr("1 of 2 models passed, 1 of 2 checks"));
  EXPECT_THAT(result.out, HasSubstr("FAILED"));
  EXPECT_EQ(shell.run("verify nothing.sim").exit, 1);
}

TEST(Compare, EveryPairHasItsLine) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const Result result = shell.run("compare spring.sim --methods euler,rk4,dop853 --step 0.1,0.05");
  EXPECT_EQ(result.exit, 0);
  EXPECT_THAT(lines_of(result.out), SizeIs(1u + 6u + 1u));  // heading, pairs, the note on the errors
  EXPECT_THAT(result.out, HasSubstr("energy drift"));
  EXPECT_EQ(shell.run("compare spring.sim --methods euler,rk5 --step 0.1").exit, 1);
}

TEST(Run, TakesQuotientsForNumbersAsAModelDoes) {
  Shell shell;
  shell.write("fall.sim", "world { body ball at (0, 0); gravity (0, -1) }\nrun 0..1\n");
  const Result result = shell.run("run fall.sim --method fast --step 1/8 --output 1/4 -o a.csv");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("by fast, step 0.125"));
  EXPECT_THAT(shell.read("a.csv"), HasSubstr("\n0.75,"));
  for (const char* wrong : {"1/0", "1/", "/2", "a/2", "1/2/3"})
    EXPECT_THAT(shell.run(std::string("run fall.sim --method fast --step ") + wrong).err, HasSubstr(wrong));
}

}  // namespace
}  // namespace continuo::app
