// `--and`: bifurcations of equilibria in the plane of two parameters.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"

namespace continuo::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A. D. Bazykin's predator and prey. At equilibrium y = (1 - x/100)(1 + alpha x) and delta y = x/(1 + alpha x) - 1.
// Trace and determinant zero are then two equations for x and alpha, whose solutions are used here.
TEST(SteadyPlane, FoldsAndHopfPointsOfBazykin) {
  const Shell shell;
  shell.write("bazykin.sim",
              "param alpha = 0.3\nparam delta = 0.2\nlet eaten = x*y/(1 + alpha*x)\nx' = x - eaten - 0.01*x^2\n"
              "y' = -y + eaten - delta*y^2\nx(0) = 1; y(0) = 1\nrun 0..100\n");
  const Result result =
      shell.run("steady bazykin.sim --along alpha=0..1 --and delta=0..1 --json -o c.csv --plot c.svg");
  EXPECT_EQ(result.exit, 0) << result.err;
  const auto found = nlohmann::json::parse(result.out);
  EXPECT_EQ(found["parameters"], nlohmann::json({"alpha", "delta"}));
  ASSERT_EQ(found["curves"].size(), 3u);
  std::size_t double_zeros = 0, cusps = 0, bautin = 0;
  for (const auto& curve : found["curves"])
    for (const auto& point : curve["degenerate"]) {
      const double alpha = point["at"][0], delta = point["at"][1];
      if (point["kind"] == "Bogdanov-Takens point") {
        ++double_zeros;
        EXPECT_LT(
            std::min(std::hypot(alpha - 0.453624, delta - 0.175128), std::hypot(alpha - 0.860704, delta - 0.00605879)),
            2e-6);
      }
      if (point["kind"] == "cusp") ++cusps;
      if (point["kind"] == "generalised Hopf point") ++bautin;
    }
  EXPECT_EQ(double_zeros, 4u);  // each on a curve of folds and on one of Hopf points
  EXPECT_EQ(cusps, 1u);
  EXPECT_EQ(bautin, 1u);
  EXPECT_THAT(shell.read("c.csv"), StartsWith("curve,kind,alpha,delta,frequency,coefficient,x,y,eigenvalue 1 re"));
  EXPECT_THAT(shell.read("c.svg"), HasSubstr("cusp"));
}

TEST(SteadyPlane, BadQuestionsAreRefused) {
  const Shell shell;
  const std::string lorenz = "steady " + gallery("lorenz");
  EXPECT_THAT(shell.run(lorenz + " --and rho=0..30").err, HasSubstr("--along"));
  EXPECT_THAT(shell.run(lorenz + " --along rho=0..30 --and rho=0..3").err,
              HasSubstr("two different parameters are needed"));
  EXPECT_THAT(shell.run(lorenz + " --along rho=0..30 --and sigm=0..3").err, HasSubstr("did you mean `sigma`?"));
  EXPECT_THAT(shell.run(lorenz + " --along rho=0..30 --and sigma=0..3").err,
              AllOf(HasSubstr("sigma is 10, outside of 0..3"), HasSubstr("--set sigma=VALUE")));
  shell.write("line.sim", "param k = 1\nparam c = 1\nx' = -k*x + c\nx(0) = 1\nrun 0..1\n");
  EXPECT_THAT(shell.run("steady line.sim --along k=0.5..2 --and c=0..2").out,
              HasSubstr("no fold and no Hopf point was found along k"));
}

}  // namespace
}  // namespace continuo::app
