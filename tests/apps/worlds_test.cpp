// The verbs of the command, run on a world of bodies.
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"

namespace continuo::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr const char* bounce =
    "model Bounce\n"
    "param g = 10\n"
    "world {\n"
    "  gravity (0, -g)\n"
    "  wall floor (0, 1) at 0\n"
    "  material restitution 1 friction 0\n"
    "  body ball at (0, 5.5) mass 2\n"
    "}\n"
    "output height = ball.y - ball.radius\n"
    "run 0..4 output 1\n"
    "check height at 2 = 5 within 1e-12\n"
    "check count of \"ball meets floor\" = 2\n";

TEST(Worlds, RunLikeEquations) {
  const Shell shell;
  shell.write("bounce.sim", bounce);
  const Result result = shell.run("run bounce.sim -o rows.csv --events events.csv --plot rows.svg");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("events  ball meets floor: 2 times, from t = 1 to 3\n"));
  EXPECT_THAT(result.out, HasSubstr("checks  all 2 passed\n"));
  EXPECT_THAT(result.out, HasSubstr("cost    2 collisions, "));
  const auto rows = lines_of(shell.read("rows.csv"));
  ASSERT_EQ(rows.size(), 7u);  // the manifest, the names, t = 0, 1, ..., 4
  EXPECT_THAT(rows[1], StartsWith("t,ball.x,ball.x',ball.y,ball.y',ball.angle,ball.angle',world.kinetic,"));
  EXPECT_THAT(rows[1], HasSubstr(",world.collisions,height"));
  const auto events = lines_of(shell.read("events.csv"));
  ASSERT_EQ(events.size(), 4u);
  EXPECT_EQ(events[1], "event,t,impulse");
  EXPECT_EQ(events[2], "ball meets floor,1,40");  // 2 kg turned from -10 to 10 m/s
  EXPECT_TRUE(shell.has("rows.svg"));
}

TEST(Worlds, FollowTheOptionsOfTheCommandLine) {
  const Shell shell;
  shell.write("bounce.sim", bounce);
  const auto at_end = [&](const std::string& options) {
    const Result result = shell.run("run bounce.sim --json " + options);
    EXPECT_EQ(result.exit, 0) << result.err;
    return json::parse(result.out)["state"];
  };
  EXPECT_NEAR(at_end("")["ball.y"].get<double>(), 5.5, 1e-12);
  EXPECT_EQ(at_end("--set g=0")["ball.y"].get<double>(), 5.5);
  EXPECT_EQ(at_end("--until 0.5")["ball.y"].get<double>(), 4.25);
  EXPECT_NEAR(at_end("--method fast --step 0.01")["ball.y"].get<double>(), 5.5, 1e-6);
}

TEST(Worlds, GoToNetCdf) {
  const Shell shell;
  shell.write("bounce.sim", bounce);
  const Result result = shell.run("run bounce.sim -o rows.nc");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(shell.read("rows.nc").substr(0, 3), "CDF");
  EXPECT_TRUE(shell.has("rows.nc.manifest.json"));
}

TEST(Worlds, AreComparedByTheirMotions) {
  const Shell shell;
  shell.write("spring.sim",
              "world { body ball at (1, 0) mass 1\n spring ball to (0, 0) stiffness 4 length 0 }\nrun 0..2\n");
  const Result result =
      shell.run("compare spring.sim --methods exact,central_difference,explicit_euler,rk4 --step 0.02,0.01");
  EXPECT_EQ(result.exit, 0) << result.err;
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 9u) << result.out;  // heading, exact once, the others twice, the note on the errors
  EXPECT_THAT(lines[0], HasSubstr("collisions"));
  const auto largest = [&](std::size_t line) {
    std::istringstream words(lines[line].substr(36));
    double final_error = 0, error = 0;
    words >> final_error >> error;
    return error;
  };
  EXPECT_LT(largest(1), 1e-8);
  EXPECT_NEAR(largest(2) / largest(3), 4, 0.2) << result.out;   // order 2
  EXPECT_NEAR(largest(4) / largest(5), 2, 0.2) << result.out;   // order 1
  EXPECT_NEAR(largest(6) / largest(7), 16, 1.6) << result.out;  // order 4
}

TEST(Worlds, ConvergeToTheirExactMotion) {
  const Shell shell;
  shell.write(
      "spring.sim",
      "world {\n  gravity (0, -9.81)\n  body ball at (0, 4) velocity (1, 0) mass 1\n"
      "  spring ball to (0, 5) stiffness 40 length 0.5\n  mode fast step 0.01 integrator central_difference\n}\n"
      "run 0..2\n");
  const Result result = shell.run(
      "converge spring.sim --methods fast,semi_implicit_euler,implicit_euler,rk4,exact --most-steps 4096 --plot a.svg");
  EXPECT_EQ(result.exit, 0) << result.err;
  const auto lines = lines_of(result.out);
  ASSERT_GE(lines.size(), 7u) << result.out;
  const std::array orders{2.0, 1.0, 1.0, 4.0};
  for (std::size_t i = 0; i < orders.size(); ++i) {
    std::istringstream words(lines[i + 1]);
    std::string method;
    double claimed = 0, measured = 0;
    words >> method >> claimed >> measured;
    EXPECT_EQ(claimed, orders[i]) << lines[i + 1];
    // Between the two shortest of these steps the next term of the error is at most a hundredth of the first one.
    EXPECT_NEAR(measured, orders[i], 0.05) << lines[i + 1];
  }
  EXPECT_THAT(lines[5], HasSubstr("it has no step to make smaller"));
  EXPECT_THAT(lines[6], StartsWith("errors against the exact motion"));
  EXPECT_THAT(shell.read("a.svg"), HasSubstr("<svg"));
  const Result typo = shell.run("converge spring.sim --methods fats");
  EXPECT_EQ(typo.exit, 1);
  EXPECT_THAT(typo.err, HasSubstr("bodies are not moved by `fats`, did you mean `fast`?"));
  for (const char* line :
       {"converge spring.sim --methods fast --tol 1e-3", "converge spring.sim --methods fast --float"})
    EXPECT_THAT(shell.run(line).err, HasSubstr("converges by its steps and in double")) << line;
}

TEST(Worlds, AreRefusedByStudiesOfEquations) {
  const Shell shell;
  shell.write("bounce.sim", bounce);
  for (const char* line : {"steady bounce.sim", "orbit bounce.sim", "linearize bounce.sim", "phase bounce.sim",
                           "check bounce.sim --jacobian"}) {
    const Result result = shell.run(line);
    EXPECT_NE(result.exit, 0) << line;
    EXPECT_THAT(result.err, HasSubstr("error[E323]")) << line;
  }
}

TEST(Worlds, AreDescribed) {
  const Shell shell;
  shell.write("bounce.sim", bounce);
  EXPECT_THAT(shell.run("check bounce.sim").out,
              StartsWith("bounce.sim: in order; 1 body, 0 states, 1 parameter, 0 events, 2 checks"));
  const std::string info = shell.run("info bounce.sim").out;
  for (const char* part :
       {"World of 2 dimensions, moved exactly", "gravity (0, -10)", "ball at (0, 5.5)", "floor (0, 1)"})
    EXPECT_THAT(info, HasSubstr(part));
}

TEST(Worlds, NameAMethodThatIsNone) {
  const Shell shell;
  shell.write("bounce.sim", bounce);
  const Result unknown = shell.run("run bounce.sim --method fsat");
  EXPECT_EQ(unknown.exit, 1);
  EXPECT_THAT(unknown.err, HasSubstr("error[E334]"));
  EXPECT_THAT(unknown.err, HasSubstr("did you mean `fast`?"));
  EXPECT_THAT(shell.run("run bounce.sim --method fast").err, HasSubstr("error[E331]"));
}

}  // namespace
}  // namespace continuo::app
