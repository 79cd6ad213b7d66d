// continuo run --record, replay and resume, as a user calls them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tests/apps/shell.hpp>

namespace continuo::app {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string bouncing =
    "param g = 10\n"
    "world {\n  gravity (0, -g)\n  wall floor (0, 1) at 0\n  material restitution 0.8 friction 0\n"
    "  body ball at (0, 5.5) velocity (1, 0)\n}\n"
    "output height = ball.y - ball.radius\n"
    "run 0..3 output 0.1\n"
    "check count of \"ball meets floor\" = 2\n";

/// Without the first line, which names a manifest with the time that the run took.
std::string rows(const std::string& csv) {
  return csv.substr(csv.find('\n') + 1);
}
std::string summary(const std::string& text) {
  return text.substr(0, text.find("cost"));
}

TEST(Replay, WritesWhatTheRunWrote) {
  const Shell shell;
  shell.write("bounce.sim", bouncing);
  const Result run = shell.run("run bounce.sim --record bounce.run -o a.csv --events ae.csv --plot a.svg --set g=9");
  ASSERT_EQ(run.exit, 0) << run.err;
  shell.write("bounce.sim", "nothing");  // the recording has the model in it
  const Result again = shell.run("replay bounce.run -o b.csv --events be.csv --plot b.svg");
  EXPECT_EQ(again.exit, 0) << again.err;
  EXPECT_EQ(rows(shell.read("b.csv")), rows(shell.read("a.csv")));
  EXPECT_EQ(rows(shell.read("be.csv")), rows(shell.read("ae.csv")));
  // The run draws its motion, the replay the rows that it has.
  EXPECT_THAT(shell.read("b.svg"), HasSubstr("</svg>"));
  EXPECT_EQ(summary(again.out), summary(run.out));
  EXPECT_THAT(again.out, HasSubstr(" to go on from, t = 0 to 3: continuo resume"));
  EXPECT_THAT(shell.run("replay bounce.run --json").out, HasSubstr("\"outcome\": \"reached end\""));
}

TEST(Replay, GoesOnWithWhatWasInterrupted) {
  const Shell shell;
  shell.write("bounce.sim", bouncing);
  shell.write("long.sim",
              "world {\n  gravity (0, -10)\n  wall floor (0, 1) at 0\n  material restitution 1\n"
              "  body ball at (0, 5.5)\n}\nrun 0..1e9 output 1e3\n");
  ASSERT_EQ(shell.run("run bounce.sim --record bounce.run -o a.csv").exit, 0);
  const std::string file = shell.read("bounce.run");
  shell.write("cut.run", file.substr(0, file.size() / 2));
  const Result cut = shell.run("replay cut.run");
  EXPECT_EQ(cut.exit, 130);
  EXPECT_THAT(cut.err, HasSubstr("was cut off after t = 1."));
  const Result on = shell.run("resume cut.run -o b.csv --record whole.run");
  EXPECT_EQ(on.exit, 0) << on.err;
  EXPECT_EQ(rows(shell.read("b.csv")), rows(shell.read("a.csv")));
  EXPECT_EQ(shell.run("replay whole.run").exit, 0);
  EXPECT_EQ(shell.run("resume bounce.run --at 1 --until 5 -o c.csv").exit, 0);
  EXPECT_THAT(shell.read("c.csv"), HasSubstr("\n5,"));
  EXPECT_TRUE(rows(shell.read("c.csv")).starts_with(rows(shell.read("a.csv"))));
  // Ctrl-C, and once more at nearly the same moment: `timeout` sends one to the process and one to its group.
  const Result interrupted = shell.run("run long.sim --record long.run",
                                       "sh -c '\"$@\" & sleep 3; kill -INT $!; sleep 0.02; kill -INT $!; wait $!' sh");
  EXPECT_THAT(interrupted.err, HasSubstr("interrupted"));
  const Result kept = shell.run("replay long.unfinished.run");
  EXPECT_EQ(kept.exit, 130);
  EXPECT_THAT(kept.err, Not(HasSubstr("cut off")));
  EXPECT_THAT(kept.out, HasSubstr("to go on from"));
}

TEST(Replay, GoesOnWithEquations) {
  const Shell shell;
  shell.write(
      "ball.sim",
      "param g = 9.8\nh'' = -g\nh(0) = 1; h'(0) = 0\ninput push = 1 from \"push.csv\" step\nz' = push - z\nz(0) = 0\n"
      "when h falls through 0 { h := 0; h' := -0.9*h'; mark \"bounce\" }\n"
      "energy all = g*h + h'^2/2\ncheck count of events > 2\nrun 0..3 output 0.1\n");
  shell.write("push.csv", "t,push\n0,1\n1.1,2\n2.3,0\n");
  const Result whole = shell.run("run ball.sim -o a.csv --events ae.csv");
  ASSERT_EQ(whole.exit, 0) << whole.err;
  const Result broken = shell.run("run ball.sim --record ball.run --max-steps 25");
  EXPECT_EQ(broken.exit, 3);
  const Result on = shell.run("resume ball.run --max-steps 100000 -o b.csv --events be.csv --record whole.run");
  EXPECT_EQ(on.exit, 0) << on.err;
  EXPECT_EQ(rows(shell.read("b.csv")), rows(shell.read("a.csv")));
  EXPECT_EQ(rows(shell.read("be.csv")), rows(shell.read("ae.csv")));
  const Result again = shell.run("replay whole.run -o c.csv");
  EXPECT_EQ(again.exit, 0) << again.err;
  EXPECT_EQ(rows(shell.read("c.csv")), rows(shell.read("a.csv")));
  // Killed at any place of the file: what is there is a beginning of the run.
  const std::string file = shell.read("whole.run"), table = rows(shell.read("a.csv"));
  for (const double part : {0.5, 0.7, 0.95}) {
    shell.write("cut.run", file.substr(0, static_cast<std::size_t>(part * static_cast<double>(file.size()))));
    EXPECT_EQ(shell.run("replay cut.run -o cut.csv").exit, 130);
    const std::string beginning = rows(shell.read("cut.csv"));
    EXPECT_EQ(beginning, table.substr(0, beginning.size()));
    EXPECT_EQ(shell.run("resume cut.run -o b.csv").exit, 0);
    EXPECT_EQ(rows(shell.read("b.csv")), table);
  }
  // A run that cannot begin leaves a recording of its name as it was.
  EXPECT_EQ(shell.run("run ball.sim --method no_such_method --record ball.run").exit, 1);
  EXPECT_EQ(shell.run("resume ball.run --max-steps 25").exit, 3);
  shell.write("push.csv", "t,push\n0,1\n1.1,3\n2.3,0\n");
  const Result changed = shell.run("resume ball.run");
  EXPECT_EQ(changed.exit, 1);
  EXPECT_THAT(changed.err, HasSubstr("a file that ball.sim reads has changed"));
}

TEST(Replay, GoesOnWithEquationsAfterCtrlC) {
  const Shell shell;
  shell.write("long.sim", "x'' = -x\nx(0) = 1; x'(0) = 0\nrun 0..1e9 output 1e5 method rk4 step 0.01\n");
  shell.write("long.run", "an older one");
  const Result interrupted = shell.run("run long.sim --record long.run", "timeout -s INT 2");
  EXPECT_THAT(interrupted.err, HasSubstr("interrupted"));
  EXPECT_THAT(interrupted.err, HasSubstr("continuo resume long.unfinished.run"));
  EXPECT_EQ(shell.read("long.run"), "an older one");
  const Result kept = shell.run("replay long.unfinished.run");
  EXPECT_EQ(kept.exit, 130);
  EXPECT_THAT(kept.err, Not(HasSubstr("cut off")));
  EXPECT_THAT(kept.out, HasSubstr("to go on from"));
}

TEST(Replay, SaysWhatIsWrong) {
  const Shell shell;
  shell.write("bounce.sim", bouncing);
  shell.write("both_ends.sim", "y'' = -y\ny(0) = 0; y(1) = 1\nrun 0..1\n");
  ASSERT_EQ(shell.run("run bounce.sim --record bounce.run --snapshots 0").exit, 0);
  std::string wrong = shell.read("bounce.run");
  wrong[wrong.size() / 2] ^= 1;
  shell.write("wrong.run", wrong);
  shell.write("short.run", wrong.substr(0, 20));
  shell.write("empty.run", "");
  struct Case {
    const char *line, *says;
  };
  for (const Case& each : {Case{"replay nothing.run", "cannot read nothing.run"},
                           Case{"replay bounce.sim", "this is no recording of a run"},
                           Case{"replay empty.run", "byte 0"}, Case{"replay short.run", "cut off before it began"},
                           Case{"replay wrong.run", "byte "}, Case{"resume bounce.run", "no snapshot to resume from"},
                           Case{"run both_ends.sim --record x.run", "--record: a boundary-value problem"},
                           Case{"run bounce.sim --record -", "--record takes the name of a file"},
                           Case{"run bounce.sim --record no/where.run", "cannot write no/where.run"},
                           Case{"run bounce.sim --record x.csv", "--record writes .run"},
                           Case{"run bounce.sim --manifest x.csv", "--manifest writes .json"},
                           Case{"view bounce.sim --export x.csv", "--export writes .html"},
                           Case{"run bounce.sim --snapshots 3", "--snapshots requires --record"}}) {
    const Result result = shell.run(each.line);
    EXPECT_EQ(result.exit, 1) << each.line;
    EXPECT_THAT(result.err, HasSubstr(each.says)) << each.line;
    EXPECT_EQ(result.out, "") << each.line;
  }
  ASSERT_EQ(shell.run("run bounce.sim --record places.run --snapshots 3").exit, 0);
  EXPECT_THAT(shell.run("resume places.run --at 2 --until 1").err, HasSubstr("resume from is at t = 2"));
  EXPECT_THAT(shell.run("resume places.run --at -1").err, HasSubstr("resume from is at t = 0"));
  EXPECT_THAT(shell.run("resume places.run --record places.run").err, HasSubstr("it is read"));
}

}  // namespace
}  // namespace continuo::app
