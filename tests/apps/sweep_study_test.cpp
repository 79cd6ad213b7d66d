// continuo sweep: the same bytes for any number of threads, in parts, and after the program was killed; bad sweeps end
// with a message and lose nothing.
#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"

namespace continuo::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* swept_swing =
    "model Swing\n"
    "param k = 4 [N/m] in 0..100, c = 0.1 [N*s/m], m = 1 [kg]\n"
    "x'' = -(k*x + c*x')/m\n"
    "x(0) = 1 [m]; x'(0) = 0 [m/s]\n"
    "when x falls through 0 [m] { mark \"down\" }\n"
    "run 0..5 [s]\n"
    "sweep {\n"
    "  k uniform(1, 9) [N/m]\n"
    "  c normal(0.5, 0.1) [N*s/m]\n"
    "  runs 300 sobol seed 7\n"
    "  keep x at end, max(abs(x)) as peak, time of event 1 as down, x at 0..5 by 1\n"
    "}\n";

TEST(SweepStudy, HasTheSameBytesHoweverItIsMade) {
  const Shell shell;
  shell.write("swing.sim", swept_swing);
  ASSERT_EQ(shell.run("sweep swing.sim -o one.csv --threads 1").exit, 0);
  const std::string whole = shell.read("one.csv");
  EXPECT_EQ(lines_of(whole).size(), 302U);
  EXPECT_EQ(lines_of(whole)[1],
            "run,k,c,outcome,ended,x at end,peak,down,x at 0..5 by 1 t=0,x at 0..5 by 1 t=1,x at 0..5 by 1 t=2,x at "
            "0..5 by 1 t=3,x at 0..5 by 1 t=4,x at 0..5 by 1 t=5");
  EXPECT_FALSE(shell.has("one.csv.sweep"));
  ASSERT_EQ(shell.run("sweep swing.sim -o two.csv --threads 2").exit, 0);
  EXPECT_TRUE(shell.read("two.csv") == whole);
  EXPECT_TRUE(shell.run("sweep swing.sim -o - --threads 3").out == whole);
  for (const char* part : {"3/3", "1/3", "2/3"}) {
    EXPECT_EQ(shell.run(fmt::format("sweep swing.sim -o parts.csv --part {}", part)).exit, 0);
    EXPECT_FALSE(shell.has("parts.csv"));
  }
  ASSERT_EQ(shell.run("sweep swing.sim -o parts.csv --merge").exit, 0);
  EXPECT_TRUE(shell.read("parts.csv") == whole);
}

TEST(SweepStudy, GoesOnAfterItWasKilled) {
  const Shell shell;
  shell.write("swing.sim", swept_swing);
  ASSERT_EQ(shell.run("sweep swing.sim -o one.nc").exit, 0);
  const std::string whole = shell.read("one.nc");
  // Killed once some chunks are there; then interrupted; then to the end.
  const std::string kill =
      "'" CONTINUO_COMMAND
      "' sweep swing.sim -o k.nc --runs '300000 sobol seed 7' & run=$!; for i in $(seq 600); do [ "
      "$(ls k.nc.sweep 2> .none | wc -l) -gt 5 ] && break; sleep 0.05; done; kill -9 $run; wait $run";
  EXPECT_NE(shell.call(kill).exit, 0);
  EXPECT_FALSE(shell.has("k.nc"));
  const Result refused = shell.run("sweep swing.sim -o k.nc --runs '300000 sobol seed 7'");
  EXPECT_EQ(refused.exit, 1);
  EXPECT_THAT(refused.err, HasSubstr("--resume"));
  const Result other = shell.run("sweep swing.sim -o k.nc --resume");
  EXPECT_EQ(other.exit, 1);
  EXPECT_THAT(other.err, HasSubstr("another sweep"));
  // Chunks of a small sweep, one cut short, one lost.
  ASSERT_EQ(shell.run("sweep swing.sim -o s.nc --part 1/2").exit, 0);
  ASSERT_EQ(shell.call("truncate -s 100 s.nc.sweep/0000003.chunk; rm s.nc.sweep/0000004.chunk").exit, 0);
  const Result resumed = shell.run("sweep swing.sim -o s.nc --resume");
  EXPECT_EQ(resumed.exit, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("1 of the chunks"));
  EXPECT_TRUE(shell.read("s.nc") == whole);
  EXPECT_FALSE(shell.has("s.nc.sweep"));
}

TEST(SweepStudy, AnInterruptKeepsWhatIsDone) {
  const Shell shell;
  shell.write("swing.sim", swept_swing);
  const Result result =
      shell.interrupt("sweep swing.sim -o k.csv --runs '300000 sobol seed 7'", "k.csv.sweep/*.chunk", 10);
  EXPECT_EQ(result.exit, 130);
  EXPECT_THAT(result.err, HasSubstr("chunks are in k.csv.sweep; the same command with --resume goes on"));
  EXPECT_FALSE(shell.has("k.csv"));
}

TEST(SweepStudy, ARunOfItIsRepeatedAlone) {
  const Shell shell;
  shell.write("swing.sim", swept_swing);
  ASSERT_EQ(shell.run("sweep swing.sim -o all.csv").exit, 0);
  const std::string row = lines_of(shell.read("all.csv"))[2 + 123];
  const Result one = shell.run("run swing.sim --sweep-run 123 -o one.csv");
  ASSERT_EQ(one.exit, 0) << one.err;
  EXPECT_THAT(one.err, HasSubstr("run 123 of the sweep: k = "));
  std::vector<std::string> cells, last;
  std::istringstream in(row), of_last(lines_of(shell.read("one.csv")).back());
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  for (std::string cell; std::getline(of_last, cell, ',');) last.push_back(cell);
  EXPECT_EQ(cells[0], "123");
  EXPECT_EQ(cells[5], last[1]);  // x at the end, to the last digit
  EXPECT_EQ(shell.run("run swing.sim --sweep-run 300").exit, 1);
  EXPECT_EQ(shell.run("run swing.sim --sweep-run 3 --set k=1,2").exit, 1);
}

TEST(SweepStudy, TheCommandLineReplacesAndExtends) {
  const Shell shell;
  shell.write("swing.sim", swept_swing);
  const Result grid = shell.run(
      "sweep swing.sim --vary 'k from 100 to 400 [N/km] count 4' --vary 'c in (0.1, 0.2)' --runs "
      "all --keep 'max(x) as top' -o -");
  ASSERT_EQ(grid.exit, 0) << grid.err;
  EXPECT_EQ(lines_of(grid.out)[1], "run,k,c,outcome,ended,top");
  EXPECT_EQ(lines_of(grid.out).size(), 10U);
  EXPECT_THAT(lines_of(grid.out)[2], ::testing::StartsWith("0,0.1,0.1,0,5,"));
  const json answer = json::parse(shell.run("sweep swing.sim --vary \"x'(0) in (0, 1)\" --runs 100 --json").out);
  EXPECT_EQ(answer["varied"].size(), 3U);
  EXPECT_EQ(answer["done"], 100);
  EXPECT_EQ(answer["kept"][3]["statistics"].size(), 6U);
}

TEST(SweepStudy, BadSweepsEndWithAMessage) {
  const Shell shell;
  shell.write("swing.sim", swept_swing);
  shell.write("plain.sim", spring);
  const auto said = [&](const std::string& words, int exit) {
    const Result result = shell.run(words);
    EXPECT_EQ(result.exit, exit) << words << "\n" << result.err;
    EXPECT_THAT(result.out, IsEmpty()) << words;
    return result.err;
  };
  EXPECT_THAT(said("sweep plain.sim", 1), HasSubstr("nothing says what is varied"));
  EXPECT_THAT(said("sweep plain.sim --vary 'q from 1 to 2 count 3'", 1), HasSubstr("--vary:1:1"));
  EXPECT_THAT(said("sweep plain.sim --vary 'k from 1 to 2 count 0'", 1), HasSubstr("E284"));
  EXPECT_THAT(said("sweep plain.sim --vary 'k normal(1, -1)' --runs 5", 1), HasSubstr("above 0"));
  EXPECT_THAT(said("sweep plain.sim --vary 'k normal(1, 1)' --runs 1e15", 1), HasSubstr("too many"));
  EXPECT_THAT(said("sweep plain.sim --vary 'k normal(1, 1)'", 1), HasSubstr("runs 1000"));
  EXPECT_THAT(said("sweep plain.sim --vary 'k normal(1, 1) } x = 1 {' --runs 5", 1), Not(IsEmpty()));
  EXPECT_THAT(said("sweep plain.sim --vary 'k in 1' --keep 'max(y)'", 1), HasSubstr("--keep:1:5"));
  EXPECT_THAT(said("sweep swing.sim --resume", 1), HasSubstr("-o FILE"));
  EXPECT_THAT(said("sweep swing.sim -o a.csv --part 4/3", 1), HasSubstr("--part 3/16"));
  EXPECT_THAT(said("sweep swing.sim -o a.csv --merge --part 1/2", 1), HasSubstr("one of the two"));
  EXPECT_THAT(said("sweep swing.sim -o none.csv --merge", 1), HasSubstr("there is no folder"));
  EXPECT_THAT(said("sweep swing.sim -o no/such/folder/a.csv", 1), HasSubstr("cannot write"));
  shell.call("mkdir -p a.csv.sweep; rm -rf a.csv.sweep/*; echo dear > a.csv.sweep/letter");
  EXPECT_THAT(said("sweep swing.sim -o a.csv", 1), HasSubstr("no folder of a sweep"));
  EXPECT_EQ(shell.read("a.csv.sweep/letter"), "dear\n");
}

TEST(SweepStudy, AModelThatFailsInAPartOfTheSpaceIsNoLostStudy) {
  const Shell shell;
  shell.write("blows.sim",
              "param a = 1\nx' = x^2\nx(0) = a\nrun 0..1\nsweep { a from 0.1 to 2 count 20\n keep x at end }\n");
  const Result result = shell.run("sweep blows.sim -o b.csv");
  EXPECT_EQ(result.exit, 3);
  EXPECT_THAT(result.err, HasSubstr("of 20 runs failed:\n  run "));
  const auto rows = lines_of(shell.read("b.csv"));
  ASSERT_EQ(rows.size(), 22U);
  EXPECT_THAT(rows[2], HasSubstr("0,0.1,0,1,0.11111"));
  EXPECT_THAT(rows.back(), HasSubstr(",nan"));
}

// The rights of a folder do not bind root, who becomes nobody for this.
TEST(SweepStudy, AFolderThatIsNotWritableIsRefusedAtOnce) {
  const Shell shell;
  const std::string as_nobody =
      geteuid() == 0 ? "setpriv --reuid 65534 --regid 65534 --clear-groups env HOME=/nonexistent" : "";
  shell.write("swing.sim", swept_swing);
  shell.call("mkdir locked; echo 'an older one' > locked/out.csv; chmod 555 locked; chmod 755 .");
  if (shell.run("check swing.sim", as_nobody).exit != 0) GTEST_SKIP() << "nobody may not run the command here";
  for (const char* arguments : {"-o locked/out.csv", "-o locked/new.nc", "-o locked/out.csv --part 1/3"}) {
    const Result result = shell.run("sweep swing.sim " + std::string(arguments), as_nobody);
    EXPECT_NE(result.exit, 0) << arguments;
    EXPECT_THAT(result.err, HasSubstr("locked")) << arguments;
    EXPECT_THAT(result.err, HasSubstr("Permission denied")) << arguments;
    EXPECT_THAT(result.out, IsEmpty()) << arguments;
  }
  EXPECT_EQ(shell.read("locked/out.csv"), "an older one\n");
  EXPECT_EQ(shell.call("ls -A locked").out, "out.csv\n");
}

TEST(SweepStudy, AFullDiskLosesNothing) {
  const Shell shell;
  if (shell.call("mkdir small && mount -t tmpfs -o size=24k none small").exit != 0) GTEST_SKIP() << "no mount here";
  shell.write("swing.sim", swept_swing);
  const Result full = shell.run("sweep swing.sim -o small/k.csv");
  EXPECT_EQ(full.exit, 1) << full.err;
  EXPECT_THAT(full.err, HasSubstr("No space left"));
  EXPECT_THAT(full.err, HasSubstr("--resume"));
  shell.call("mount -o remount,size=20M small");
  const Result resumed = shell.run("sweep swing.sim -o small/k.csv --resume");
  EXPECT_EQ(resumed.exit, 0) << resumed.err;
  shell.run("sweep swing.sim -o k.csv");
  EXPECT_TRUE(shell.read("small/k.csv") == shell.read("k.csv"));
  shell.call("umount small");
}

}  // namespace
}  // namespace continuo::app
