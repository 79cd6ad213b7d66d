// Several runs at once by --set and --initial: each has the bits of the run that its settings alone give. And where a
// run begins, by --initial and --initial-from.
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"

namespace continuo::app {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

/// The rows of a table without its first line and its heading.
std::vector<std::string> rows_of(const std::string& csv) {
  std::vector<std::string> rows = lines_of(csv);
  rows.erase(rows.begin(), rows.begin() + std::min<std::ptrdiff_t>(2, std::ssize(rows)));
  return rows;
}

TEST(Sweep, HasTheRowsOfSingleRuns) {
  const Shell shell;
  shell.write("spring.sim", spring);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0.1, 9);
  for (int tries = 0; tries < 3; ++tries) {
    const std::vector<double> ks{any(random), any(random), any(random)}, xs{any(random), any(random)};
    const std::string method = tries == 0 ? "" : tries == 1 ? " --method bdf" : " --method rk4 --step 0.01";
    const Result all =
        shell.run(fmt::format("run spring.sim --set k={},{},{} --initial x={},{} -o all.csv --events e.csv{}", ks[0],
                              ks[1], ks[2], xs[0], xs[1], method));
    ASSERT_EQ(all.exit, 0) << all.err;
    EXPECT_EQ(lines_of(shell.read("all.csv"))[1], "k,x(0),t,x,x',all");
    std::vector<std::string> rows, events;
    for (const double k : ks) {
      for (const double x : xs) {
        ASSERT_EQ(shell
                      .run(fmt::format("run spring.sim --set k={} --initial x={} -o one.csv --events one_e.csv{}", k, x,
                                       method))
                      .exit,
                  0);
        for (const std::string& row : rows_of(shell.read("one.csv")))
          rows.push_back(fmt::format("{},{},{}", k, x, row));
      }
    }
    EXPECT_EQ(rows_of(shell.read("all.csv")), rows);
    EXPECT_THAT(lines_of(all.out), SizeIs(7));
  }
}

TEST(Sweep, DoesNotDependOnTheNumberOfCores) {
  const Shell shell;
  shell.write("spring.sim", spring);
  ASSERT_EQ(shell.run("run spring.sim --set k=1..9/40 -o many.csv").exit, 0);
  ASSERT_EQ(shell.run("run spring.sim --set k=1..9/40 -o one.csv", "taskset -c 0").exit, 0);
  EXPECT_EQ(rows_of(shell.read("many.csv")), rows_of(shell.read("one.csv")));
  EXPECT_EQ(lines_of(shell.read("many.csv"))[1], lines_of(shell.read("one.csv"))[1]);
}

TEST(Sweep, ReadsListsAndRanges) {
  const Shell shell;
  shell.write("spring.sim",
              "param k = 4 [N/m], m = 1 [kg]\nx'' = -k/m*x\nx(0) = 1 [m]; x'(0) = 0 [m/s]\nrun 0..1 [s]\n");
  const auto values = [&](const std::string& options) {
    const Result result = shell.run("run spring.sim --json " + options);
    std::vector<double> found;
    if (result.exit != 0) return found;
    const json object = json::parse(result.out);
    for (const json& run : object["runs"]) found.push_back(run["at"][object["swept"][0].get<std::string>()]);
    return found;
  };
  EXPECT_THAT(values("--set k=1,2,5"), ElementsAre(1, 2, 5));
  EXPECT_THAT(values("--set k=1..5/5"), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(values("--set k=5..1/3"), ElementsAre(5, 3, 1));
  EXPECT_THAT(values("--set 'k=1,2 [N/cm]'"), ElementsAre(100, 200));
  EXPECT_THAT(values("--set 'k=1 [N/cm],2'"), ElementsAre(100, 2));
  EXPECT_THAT(values("--set 'k=1..2/3 [N/cm]'"), ElementsAre(100, 150, 200));
  EXPECT_THAT(values("--set 'k=sqrt(9),0..1/2'"), ElementsAre(3, 0, 1));
  EXPECT_THAT(values("--initial 'x=1..2/2 [cm]'"), ElementsAre(0.01, 0.02));
  struct Case {
    const char *options, *says;
  };
  for (const Case& each :
       {Case{"--set k=1..5", "`1..5` is no range: write FROM..TO/COUNT"},
        Case{"--set k=1..5/1", "`1` is no count of values"}, Case{"--set k=1..5/2.5", "`2.5` is no count of values"},
        Case{"--set q=1,2", "no parameter `q`"}, Case{"--set k=1,two", "k"},
        Case{"--set k=1,2 --set k=3", "`k` is given twice"}, Case{"--initial y=1,2", "no state `y`"},
        Case{"--set k=1..2/1000 --set m=1..2/1000", "these are 1000000 runs"},
        Case{"--set k=1,2 --record x.run", "--record is for one run"}}) {
    const Result result = shell.run(std::string("run spring.sim ") + each.options);
    EXPECT_EQ(result.exit, 1) << each.options;
    EXPECT_THAT(result.err, HasSubstr(each.says)) << each.options;
  }
}

TEST(Sweep, KeepsTheOthersWhereOneFails) {
  const Shell shell;
  shell.write("grows.sim", "param a = 0\nx' = a*x^2\nx(0) = 1\nrun 0..2 output 0.5\n");
  const Result result = shell.run("run grows.sim --set a=0,1,-1 -o x.csv");
  EXPECT_EQ(result.exit, 3);
  EXPECT_THAT(result.err, HasSubstr("a = 1: "));
  EXPECT_THAT(shell.read("x.csv"), HasSubstr("\n0,2,1\n"));
  EXPECT_THAT(shell.read("x.csv"), HasSubstr("\n-1,2,"));
  const json object = json::parse(shell.run("run grows.sim --set a=0,1,-1 --json").out);
  ASSERT_THAT(object["runs"], SizeIs(3));
  EXPECT_EQ(object["runs"][0]["run"]["outcome"], "reached end");
  EXPECT_NE(object["runs"][1]["run"]["outcome"], "reached end");
  EXPECT_EQ(object["runs"][2]["run"]["outcome"], "reached end");
}

TEST(Sweep, RunsOverTheNumberOfEquations) {
  const Shell shell;
  shell.write("rod.sim", "param N = 3\nfor i in 1..N { u[i]' = -u[i]; u[i](0) = i }\nrun 0..1\n");
  const Result result = shell.run("run rod.sim --set N=2,4 --json");
  ASSERT_EQ(result.exit, 0) << result.err;
  const json object = json::parse(result.out);
  EXPECT_THAT(object["runs"][0]["run"]["state"], SizeIs(2));
  EXPECT_THAT(object["runs"][1]["run"]["state"], SizeIs(4));
  EXPECT_THAT(shell.run("run rod.sim --set N=2,4 -o x.csv").err, HasSubstr("no common table"));
}

TEST(Initial, IsThatOfTheOption) {
  const Shell shell;
  shell.write("spring.sim", spring);
  shell.write("rod.sim", "param N = 3\nfor i in 1..N { u[i]' = -u[i]; u[i](0) = i }\nrun 0..1 output 1\n");
  ASSERT_EQ(shell.run("run spring.sim --initial x=3 --initial \"x'=-1\" -o x.csv").exit, 0);
  EXPECT_THAT(rows_of(shell.read("x.csv"))[0], StartsWith("0,3,-1,"));
  EXPECT_EQ(json::parse(shell.read("x.csv.manifest.json"))["initial"]["x"], 3);
  ASSERT_EQ(shell.run("run rod.sim --initial u=5 --initial 'u[2]=7' -o u.csv").exit, 0);
  EXPECT_THAT(rows_of(shell.read("u.csv"))[0], StartsWith("0,5,7,5"));
  struct Case {
    const char *options, *says;
  };
  for (const Case& each :
       {Case{"--initial y=3", "no state `y`"}, Case{"--initial x", "sets nothing"},
        Case{"--initial x=two", "cannot begin at `two`"}, Case{"--initial x=1 --initial x=2", "given twice"},
        Case{"--initial \"x=3 [kg]\"", "[kg] is no [1]"}}) {
    const Result result = shell.run(std::string("run spring.sim ") + each.options);
    EXPECT_EQ(result.exit, 1) << each.options;
    EXPECT_THAT(result.err, HasSubstr(each.says)) << each.options;
  }
}

TEST(Initial, IsReadFromATable) {
  const Shell shell;
  shell.write("spring.sim", spring);
  ASSERT_EQ(shell.run("run spring.sim -o first.csv").exit, 0);
  const auto last = rows_of(shell.read("first.csv")).back();
  ASSERT_EQ(shell.run("run spring.sim --initial-from first.csv -o on.csv").exit, 0);
  EXPECT_EQ(rows_of(shell.read("on.csv"))[0].substr(1), last.substr(1));  // but for the time
  ASSERT_EQ(shell.run("run spring.sim --initial-from first.csv@0.5 -o on.csv").exit, 0);
  EXPECT_EQ(rows_of(shell.read("on.csv"))[0].substr(1), rows_of(shell.read("first.csv"))[1].substr(3));
  shell.write("part.csv", "t,x,other\n0,2,1\n");
  const Result part = shell.run("run spring.sim --initial-from part.csv -o on.csv");
  EXPECT_EQ(part.exit, 0);
  EXPECT_THAT(part.err, HasSubstr("has no value for x'"));
  EXPECT_THAT(part.err, HasSubstr("no state is called other"));
  EXPECT_THAT(rows_of(shell.read("on.csv"))[0], StartsWith("0,2,0,"));
  EXPECT_THAT(shell.run("run spring.sim --initial-from first.csv@0.6").err,
              HasSubstr("nearest are at t = 0.5 and 0.785"));
  shell.write("no.csv", "t,other\n0,2\n");
  EXPECT_THAT(shell.run("run spring.sim --initial-from no.csv").err, HasSubstr("no column with the name of a state"));
  EXPECT_EQ(shell.run("run spring.sim --initial-from first.csv -o first.csv").exit, 1);
}

// Members end in another order than they stand in the table, and wait for each other where they have many rows.
TEST(Sweep, DrawsEachRunInAColourOfItsOwn) {
  const Shell shell;
  shell.write("decay.sim", "param k = 1\nx' = -k*x\nx(0) = 1\nrun 0..5\nplot x against t\n");
  ASSERT_EQ(shell.run("run decay.sim --set k=1,2,3 --plot decay.svg").exit, 0);
  const std::string picture = shell.read("decay.svg");
  const std::regex stroke(R"(stroke='rgb\( *([0-9]+), *([0-9]+), *([0-9]+)\)')");
  std::set<std::string> colors;  // but for the greys of axes and texts
  for (auto found = std::sregex_iterator(picture.begin(), picture.end(), stroke); found != std::sregex_iterator();
       ++found)
    if ((*found)[1] != (*found)[2] || (*found)[2] != (*found)[3]) colors.insert(found->str());
  EXPECT_THAT(colors, SizeIs(3));
}

TEST(Sweep, PutsLongRunsIntoTheirOrder) {
  const Shell shell;
  shell.write("swing.sim", "param n = 1\nx'' = -x\nx(0) = 1; x'(0) = 0\nrun 0..n output 0.01\n");
  EXPECT_EQ(shell.run("run swing.sim --set n=1,2 --events events.csv").exit, 0);  // without a table
  ASSERT_EQ(shell.run("run swing.sim --set n=1500,1,700,2,900 -o all.csv").exit, 0);
  std::vector<std::string> rows;
  for (const char* n : {"1500", "1", "700", "2", "900"}) {
    ASSERT_EQ(shell.run(fmt::format("run swing.sim --set n={} -o one.csv", n)).exit, 0);
    for (const std::string& row : rows_of(shell.read("one.csv"))) rows.push_back(std::string(n) + ',' + row);
  }
  EXPECT_TRUE(rows_of(shell.read("all.csv")) == rows);
}

TEST(Sweep, KeepsTheRowsUntilCtrlC) {
  const Shell shell;
  shell.write("slow.sim",
              "param k = 1\nx'' = -k*x + 1e-9*sum(i in 1..3000: sin(i*x))\nx(0) = 1; x'(0) = 0\n"
              "run 0..1e7 output 0.01\n");
  shell.write("k.csv", "an older one");
  const Result result = shell.interrupt("run slow.sim --set k=1..9/9 --max-steps 1000000000 -o k.csv --events e.csv",
                                        "k.unfinished.csv", 1000);
  EXPECT_EQ(result.exit, 130) << result.err;
  EXPECT_THAT(result.err, HasSubstr("are in k.unfinished.csv"));
  EXPECT_EQ(shell.read("k.csv"), "an older one");
  EXPECT_GT(rows_of(shell.read("k.unfinished.csv")).size(), 10u);
  EXPECT_TRUE(shell.has("e.unfinished.csv"));
}

// The shell's limit on file sizes stands for a full disk; its signal is ignored, since a full disk sends none.
TEST(Sweep, EndsOnAFullDisk) {
  const Shell shell;
  shell.write("swing.sim", "param k = 1\nx'' = -k*x\nx(0) = 1; x'(0) = 0\nrun 0..400 output 0.01\n");
  shell.write("k.csv", "an older one");
  const Result result = shell.call("trap '' XFSZ; ulimit -f 600; timeout 60 '" CONTINUO_COMMAND
                                   "' run swing.sim --set k=1..9/500 -o k.csv");
  EXPECT_EQ(result.exit, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("cannot write k.csv"));
  EXPECT_EQ(shell.read("k.csv"), "an older one");
  EXPECT_GT(rows_of(shell.read("k.unfinished.csv")).size(), 1000u);
}

}  // namespace
}  // namespace continuo::app
