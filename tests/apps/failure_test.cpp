// A run that fails names its failure, exits with 3, and writes the rows computed before it.
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"

namespace continuo::app {
namespace {

using nlohmann::json;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A method of each implicit family; the last name is empty: the method chosen for the model.
constexpr const char* methods[] = {"--method rodas5p", "--method kvaerno5", "--method radau", "--method bdf", ""};

double last_time(const std::string& csv) {
  std::istringstream in(csv);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty()) last = line;
  return std::stod(last);
}

/// Runs the model by each method; passes the message to `judge`, with the time of the last row.
template <class Judge>
void by_each_method(const std::string& model, Judge&& judge) {
  const Shell shell;
  shell.write("model.sim", model);
  for (const char* method : methods) {
    SCOPED_TRACE(method);
    const Result result = shell.run(std::string("run model.sim -o out.csv ") + method);
    EXPECT_EQ(result.exit, 3);
    EXPECT_THAT(result.err, HasSubstr("= help: "));
    const json object = json::parse(shell.run(std::string("run model.sim --json ") + method).out);
    EXPECT_FALSE(object["failure"]["hint"].get<std::string>().empty());
    EXPECT_THAT(shell.read("out.csv"), Not(AnyOf(HasSubstr("nan"), HasSubstr("inf"))));
    judge(result.err, last_time(shell.read("out.csv")));
  }
}

TEST(FailedRun, WhereTheSolutionOfAnEquationEndsItIsSaid) {
  by_each_method("unknown z = 1\nx' = z\n0 = z^2 + t - 1\nx(0) = 0\nrun 0..2 output 0.1\n",
                 [](const std::string& said, double last) {
                   // Newton's iteration fails first, or the error estimate.
                   EXPECT_THAT(said, AnyOf(HasSubstr("error[E305]"), HasSubstr("error[E302]")));
                   EXPECT_THAT(said, HasSubstr("the solution may be singular"));
                   EXPECT_NEAR(last, 1, 1e-3);
                 });
}

TEST(FailedRun, EquationsWithoutASolutionAtTheStartAreNamed) {
  by_each_method("unknown z = 3\nx' = -z\n0 = z^2 + x\nx(0) = 1\nrun 0..1 output 0.1\n",
                 [](const std::string& said, double last) {
                   EXPECT_THAT(said, HasSubstr("error[E305]"));
                   EXPECT_THAT(said, HasSubstr("`z` is the worst"));
                   EXPECT_THAT(said, HasSubstr("no values of the unknowns satisfy the algebraic equations"));
                   EXPECT_EQ(last, 0);
                 });
}

TEST(FailedRun, EquationsThatDoNotDetermineTheirUnknownAreNamed) {
  by_each_method("param k = 0\nunknown z = 3\nx' = -z\n0 = k*z - x + 1\nx(0) = 1\nrun 0..1 output 0.1\n",
                 [](const std::string& said, double) {
                   EXPECT_THAT(said, HasSubstr("error[E305]"));
                   EXPECT_THAT(said, HasSubstr("do not determine their unknowns"));
                 });
}

// sqrt(x) of a falling x: beyond x = 0 it has no value.
TEST(FailedRun, NoNumberIsNamedWithItsState) {
  by_each_method("y' = -y\nx' = -1 - sqrt(x)\ny(0) = 1; x(0) = 1\nrun 0..2 output 0.1\n",
                 [](const std::string& said, double last) {
                   EXPECT_THAT(said, HasSubstr("error[E301]"));
                   // With s = sqrt(x): s' = -(1 + s)/(2 s), so t = 2 (1 - log 2) where x = 0.
                   EXPECT_NEAR(last, 2 * (1 - 0.6931471805599453), 1e-3);
                 });
}

TEST(FailedRun, ABlowUpIsSaidWhereItIs) {
  by_each_method("x' = x^2\nx(0) = 1\nrun 0..2 output 0.1\n", [](const std::string& said, double last) {
    EXPECT_THAT(said, AnyOf(HasSubstr("error[E301]"), HasSubstr("error[E302]"), HasSubstr("error[E305]")));
    EXPECT_THAT(said, AnyOf(HasSubstr("singular"), HasSubstr("without bound")));
    EXPECT_NEAR(last, 1, 1e-3);
  });
}

TEST(FailedRun, AJumpIsNone) {
  const Shell shell;
  shell.write("jump.sim", "x' = if t < 0.4321 then -1000*(x - 1) else -1000*(x + 1)\nx(0) = 1\nrun 0..1\n");
  for (const char* method : methods) {
    const json result = json::parse(shell.run(std::string("run jump.sim --json ") + method).out);
    EXPECT_EQ(result["outcome"], "reached end") << method;
    EXPECT_NEAR(result["state"]["x"], -1, 30e-6) << method;  // exp(-500) of the distance remains
  }
}

}  // namespace
}  // namespace continuo::app
