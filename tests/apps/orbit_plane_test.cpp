// `orbit --and`: bifurcations of periodic orbits in the plane of two parameters.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"

namespace continuo::app {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// A fold of circles is at mu = -nu^2 / 4; its curve begins at the generalised Hopf point mu = nu = 0.
TEST(OrbitPlane, FoldsOfOrbitsAsTableAndJson) {
  const Shell shell;
  shell.write("bautin.sim",
              "param mu = 0.5\nparam nu = 1\nlet grow = mu + nu*(x^2 + y^2) - (x^2 + y^2)^2\n"
              "x' = grow*x - 1.5*y\ny' = grow*y + 1.5*x\nx(0) = 1; y(0) = 0\nrun 0..40\n");
  const Result result = shell.run("orbit bautin.sim --along mu=-1..1 --and nu=0.5..1.5 --json -o c.csv --plot c.svg");
  EXPECT_EQ(result.exit, 0) << result.err;
  const auto found = nlohmann::json::parse(result.out);
  ASSERT_EQ(found["curves"].size(), 1u);
  EXPECT_EQ(found["curves"][0]["kind"], "fold");
  EXPECT_TRUE(found["curves"][0]["degenerate"].empty());
  for (const auto& point : found["curves"][0]["points"]) {
    const double mu = point["at"][0], nu = point["at"][1];
    EXPECT_NEAR(mu, -nu * nu / 4, 1e-7);
  }
  EXPECT_THAT(shell.read("c.csv"), StartsWith("curve,kind,mu,nu,period,rotation,x min,x max,y min,y max"));
  EXPECT_THAT(shell.read("c.svg"), HasSubstr("fold"));
  EXPECT_THAT(shell.run("orbit bautin.sim --along mu=-1..1 --and nu=2..3").err, HasSubstr("nu is 1, outside of 2..3"));
  EXPECT_THAT(shell.run("orbit bautin.sim --along mu=-1..1 --and mu=2..3").err,
              HasSubstr("two different parameters are needed"));
}

// y'' = m0 + m1 y + y^2 + y y': of the homoclinic orbits m0 = -6/25 m1^2 in leading order, whose relative error is of
// the order of the root of -m1 (Kuznetsov, 8.4).
TEST(OrbitPlane, HomoclinicOrbitsBeginAtADoubleZero) {
  const Shell shell;
  shell.write("double_zero.sim",
              "param m0 = -0.01\nparam m1 = -0.1\nx' = y\ny' = m0 + m1*x + x^2 + x*y\nx(0) = 0; y(0) = 0.01\n"
              "run 0..100\n");
  const Result result =
      shell.run("orbit double_zero.sim --from-hopf --along m0=-0.1..0.1 --and m1=-0.2..-0.05 --branches 0 --json");
  EXPECT_EQ(result.exit, 0) << result.err;
  const auto found = nlohmann::json::parse(result.out);
  ASSERT_EQ(found["curves"].size(), 1u);
  EXPECT_EQ(found["curves"][0]["kind"], "homoclinic orbit");
  ASSERT_GT(found["curves"][0]["points"].size(), 3u);
  for (const auto& point : found["curves"][0]["points"]) {
    const double m0 = point["at"][0], m1 = point["at"][1];
    EXPECT_NEAR(m0 / (m1 * m1), -6.0 / 25, 0.24 * 0.5 * std::sqrt(-m1));
  }
}

// y^2 = x^2 (1 - x) is a homoclinic orbit for nu = 0 and any a and b; the saddle's eigenvalues are a + b and a - b.
TEST(OrbitSpace, SaddleNodesAndNeutralSaddles) {
  const Shell shell;
  shell.write("loop.sim",
              "param nu = 0.01\nparam a = -0.2\nparam b = 1\nx' = a*x + b*y - a*x^2 + nu*x*(2 - 3*x)\n"
              "y' = b*x + a*y - 1.5*b*x^2 - 1.5*a*x*y - 2*nu*y\nx(0) = 0.7; y(0) = 0\nrun 0..40\n");
  const std::string plane = "orbit loop.sim --from-hopf --along nu=-0.3..0.3 --and a=-0.4..1.2 ";
  const Result result = shell.run(plane + "--and b=0.8..1.1 --json -o c.csv --plot c.svg");
  EXPECT_EQ(result.exit, 0) << result.err;
  const auto found = nlohmann::json::parse(result.out);
  EXPECT_EQ(found["parameters"], nlohmann::json({"nu", "a"}));
  EXPECT_EQ(found["three"]["parameters"], nlohmann::json({"nu", "a", "b"}));
  ASSERT_EQ(found["three"]["curves"].size(), 2u);
  for (const auto& curve : found["three"]["curves"]) {
    ASSERT_GT(curve["points"].size(), 3u);
    for (const auto& point : curve["points"]) {
      const double nu = point["at"][0], a = point["at"][1], b = point["at"][2];
      EXPECT_NEAR(nu, 0, 1e-7);
      EXPECT_NEAR(a, curve["kind"] == "saddle-node" ? b : 0, 1e-7);
    }
    EXPECT_EQ(curve["ends"].size(), 2u);
  }
  EXPECT_THAT(shell.read("c.csv"), StartsWith("curve,kind,nu,a,b,x min,x max,y min,y max"));
  EXPECT_THAT(shell.read("c.svg"), HasSubstr("saddle-node"));
  EXPECT_THAT(shell.run(plane + "--and nu=0..1").err, HasSubstr("nu is already used"));
  EXPECT_THAT(shell.run(plane + "--and b=2..3").err, HasSubstr("b is 1, outside of 2..3"));
  EXPECT_THAT(shell.run(plane + "--and c=2..3").err, HasSubstr("there is no parameter `c`"));
  EXPECT_THAT(shell.run(plane + "--and b=0..2 --and c=2..3").err, HasSubstr("at most three parameters"));
  EXPECT_THAT(shell.run("steady loop.sim --along nu=0..1 --and a=-1..1 --and b=0..2").err,
              HasSubstr("--and is given twice"));
}

}  // namespace
}  // namespace continuo::app
