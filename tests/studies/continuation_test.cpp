#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/continuation.hpp>

namespace continuo::studies::continuation_test {
namespace {

TEST(Continuation, LorenzFromTheSide) {  // Hopf at rho = 24.7368..., and where it began, at 1, the pitchfork
  const double beta = 8.0 / 3, side = std::sqrt(beta * 13);
  const auto branch = continue_equilibrium(lorenz(14), {side, side, 13}, {.constant = 1, .low = 0.5, .high = 30});
  std::vector<double> hopf, crossing;
  for (const auto& point : branch.bifurcations) {
    if (point.kind == Bifurcation::hopf) hopf.push_back(point.at.constant);
    if (point.kind == Bifurcation::crossing) crossing.push_back(point.at.constant);
  }
  // The branch goes through the pitchfork to the other side and has a Hopf point there too.
  ASSERT_GE(hopf.size(), 1u);
  for (const double rho : hopf) EXPECT_NEAR(rho, 10 * (10 + beta + 3) / (10 - beta - 1), 1e-6);
  for (const auto& point : branch.bifurcations) {
    if (point.kind != Bifurcation::hopf) continue;
    const double rho = point.at.constant;  // frequency^2 = beta (sigma + rho)
    EXPECT_NEAR(point.frequency, std::sqrt(beta * (10 + rho)) / (2 * std::numbers::pi), 1e-6);
  }
  ASSERT_GE(crossing.size(), 1u);
  EXPECT_NEAR(crossing.front(), 1, 1e-6);
}

TEST(Continuation, LorenzFromTheOrigin) {
  const auto branch = continue_equilibrium(lorenz(0.5), {0, 0, 0}, {.constant = 1, .low = 0, .high = 3});
  EXPECT_TRUE(branch.complete) << branch.message;
  ASSERT_EQ(branch.bifurcations.size(), 1u);
  EXPECT_EQ(branch.bifurcations[0].kind, Bifurcation::crossing);
  EXPECT_NEAR(branch.bifurcations[0].at.constant, 1, 1e-6);
  for (const auto& point : branch.points)
    EXPECT_EQ(point.stability, point.constant < 1 ? Stability::asymptotically_stable : Stability::saddle);
}

TEST(Continuation, AFoldIsRounded) {  // 0 = p - x^2: both branches, the fold at the origin
  const auto f = [](double, Values x, Values p, std::span<double> out) { out[0] = p[0] - x[0] * x[0]; };
  const auto branch = continue_equilibrium(parametric_system(1, f, {1.0}), {1}, {.low = -1, .high = 4});
  EXPECT_TRUE(branch.complete) << branch.message;
  ASSERT_EQ(branch.bifurcations.size(), 1u);
  EXPECT_EQ(branch.bifurcations[0].kind, Bifurcation::fold);
  EXPECT_NEAR(branch.bifurcations[0].at.constant, 0, 1e-9);
  double low = 0, high = 0;
  for (const auto& point : branch.points) {
    EXPECT_NEAR(point.x[0] * point.x[0], point.constant, 1e-10);
    low = std::min(low, point.x[0]);
    high = std::max(high, point.x[0]);
  }
  EXPECT_LE(low, -1.9);  // x = -2 is where it leaves the range
  EXPECT_GE(high, 1.9);
}

TEST(Continuation, WithoutAStartItSaysSo) {
  const auto f = [](double, Values x, Values p, std::span<double> out) { out[0] = p[0] + x[0] * x[0]; };
  const auto branch = continue_equilibrium(parametric_system(1, f, {1.0}), {1}, {.low = 0, .high = 4});
  EXPECT_TRUE(branch.points.empty());
  EXPECT_FALSE(branch.message.empty());
}

}  // namespace
}  // namespace continuo::studies::continuation_test
