// Output files: an input file is never overwritten, a truncated file is always reported. Also options that are counts.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shell.hpp"

namespace continuo::app {
namespace {

using ::testing::HasSubstr;

constexpr const char* plain_decay = "param k = 1\nx' = -k*x\nx(0) = 1\nrun 0..1\n";

TEST(OutputFiles, AreNeverWrittenOverWhatIsRead) {
  const Shell shell;
  shell.write("decay.sim", plain_decay);
  shell.write("force.csv", "t,u\n0,1\n1,2\n");
  shell.write("driven.sim",
              "param k = 1\ntable force from \"force.csv\"\nx' = interp(force, t) - k*x\nx(0) = 0\nrun 0..1\n");
  for (const std::string words :
       {"run decay.sim -o ./decay.sim", "run decay.sim --events decay.sim", "run decay.sim --manifest decay.sim",
        "sense decay.sim --param k -o decay.sim", "steady decay.sim --along k=1..2 -o decay.sim",
        "orbit decay.sim --section x=1 -o decay.sim", "report decay.sim -o decay.sim", "run driven.sim -o force.csv",
        "sense driven.sim --param k -o force.csv", "steady driven.sim --along k=1..2 -o force.csv",
        "orbit driven.sim --section x=1 -o force.csv", "report driven.sim -o force.csv",
        "view decay.sim --export decay.sim", "view driven.sim --export force.csv"}) {
    const Result result = shell.run(words);
    EXPECT_EQ(result.exit, 1) << words;
    EXPECT_THAT(result.err, HasSubstr("it is read as input")) << words;
  }
  EXPECT_EQ(shell.read("decay.sim"), plain_decay);
  EXPECT_EQ(shell.read("force.csv"), "t,u\n0,1\n1,2\n");
  EXPECT_THAT(shell.run("run decay.sim -o x.csv --events ./x.csv").err, HasSubstr("cannot write ./x.csv twice"));
  EXPECT_EQ(shell.run("run decay.sim -o /dev/null --events /dev/null").exit, 0);
}

TEST(OutputFiles, AFullDiskUnderStandardOutputIsTold) {
  const Shell shell;
  shell.write("decay.sim", plain_decay);
  const Result result = shell.call("'" CONTINUO_COMMAND "' run decay.sim >/dev/full");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("standard output could not be written"));
}

// The shell's limit on file sizes simulates a full disk: gnuplot ends without its last lines. The signal of that limit
// is ignored, since a full disk sends none.
TEST(OutputFiles, APictureThatIsCutOffIsTold) {
  const Shell shell;
  shell.write("decay.sim", plain_decay);
  const Result result = shell.call("trap '' XFSZ; ulimit -f 8; '" CONTINUO_COMMAND "' run decay.sim --plot decay.svg");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("the picture is cut off"));
  EXPECT_EQ(shell.run("run decay.sim --plot decay.svg").exit, 0);
  EXPECT_EQ(shell.run("run decay.sim --plot decay.png").exit, 0);
}

TEST(OutputFiles, WhatNobodyWritesIsNotPassedOver) {
  const Shell shell;
  shell.write("decay.sim", plain_decay);
  EXPECT_THAT(shell.run("orbit decay.sim -o x.csv").err, HasSubstr("-o writes the table of --section or of --along"));
  EXPECT_THAT(shell.run("orbit decay.sim --lyapunov --plot x.svg").err, HasSubstr("there is no plot of --lyapunov"));
  EXPECT_THAT(shell.run("converge decay.sim --derivative 'sin(x)'").err, HasSubstr("leave out the model"));
  EXPECT_THAT(shell.run("run decay.sim --solution 2").err, HasSubstr("is for boundary-value problems"));
}

TEST(Options, ThatCountTakeNoNegativeNumberForALargeOne) {
  const Shell shell;
  shell.write("decay.sim", plain_decay);
  shell.write("data.csv", "t,x\n0.5,0.6\n1,0.4\n");
  for (const std::string words :
       {"steady decay.sim --starts -3", "steady decay.sim --starts 99999999999999", "explore decay.sim --starts -1",
        "phase decay.sim --spread -1", "orbit decay.sim --turns -1", "run decay.sim --max-steps -1",
        "fit decay.sim data.csv --param k --starts -3", "fit decay.sim data.csv --param k --iterations 1.5"}) {
    const Result result = shell.run(words, "timeout 20");
    EXPECT_EQ(result.exit, 1) << words;
    EXPECT_THAT(result.err, HasSubstr("is no whole number from")) << words;
  }
  for (const std::string words : {"orbit decay.sim --duration -5", "orbit decay.sim --settle nan",
                                  "explore decay.sim --duration inf", "linearize decay.sim --time nan"})
    EXPECT_THAT(shell.run(words).err, HasSubstr("is no number")) << words;
}

TEST(Options, OfAFitThatContradictEachOtherAreRefused) {
  const Shell shell;
  shell.write("decay.sim", plain_decay);
  shell.write("data.csv", "t,x\n0.5,0.6\n1,0.4\n");
  const auto refusal = [&](const std::string& words) {
    const Result result = shell.run("fit decay.sim data.csv --param k " + words);
    EXPECT_EQ(result.exit, 1) << words;
    return result.err;
  };
  EXPECT_THAT(refusal("--sigma x=x"), HasSubstr("cannot contain its own deviations"));
  EXPECT_THAT(refusal("--column x=-"), HasSubstr("data.csv:1: no column is left"));
  EXPECT_THAT(refusal("--error x=constant --sigma x=5%"), HasSubstr("`constant` was asked for"));
  EXPECT_THAT(shell.run("fit decay.sim . --param k").err, HasSubstr("it is a folder"));
  EXPECT_THAT(refusal("--prior 'k=normal(nan, 1)'"), HasSubstr("is not NAME=normal(MEAN, DEVIATION)"));
  const Result twice = shell.run("fit decay.sim data.csv ./data.csv --param k");
  EXPECT_EQ(twice.exit, 1);
  EXPECT_THAT(twice.err, HasSubstr("./data.csv is given twice"));
}

// gnuplot reports no error on a full disk: /dev/full is its output file here.
TEST(OutputFiles, PicturesThatDoNotFitOnTheDiskAreNoPictures) {
  const Shell shell;
  shell.write("ball.sim", "h'' = -9.81\nh(0) = 1; h'(0) = 0\nrun 0..0.4 output 0.1\n");
  const std::string record = "view ball.sim --record p --until 0.2 --fps 10";
  ASSERT_EQ(shell.run(record).exit, 0);
  const std::string first = shell.read("p/00001.png"), second = shell.read("p/00002.png");
  ASSERT_GT(second.size(), 1000u);
  shell.call("ln -s /dev/full p/00002.png.part");
  const Result full = shell.run(record);
  EXPECT_EQ(full.exit, 1);
  EXPECT_THAT(full.err,
              HasSubstr("cannot write p/00002.png whole: the disk may be full; those up to 00001.png are there"));
  EXPECT_EQ(shell.read("p/00001.png"), first);
  EXPECT_EQ(shell.read("p/00002.png"), second);  // the older picture is not lost
  EXPECT_EQ(shell.call("ls p/*.part").out, "");
}

}  // namespace
}  // namespace continuo::app
