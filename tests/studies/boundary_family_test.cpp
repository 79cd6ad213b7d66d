#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/studies/boundary/boundary_family.hpp>

namespace {

using namespace continuo::studies;
using continuo::parametric_system;
using continuo::Values;
using continuo::boundary::BoundaryValueGuess;
using continuo::boundary::BoundaryValueProblem;

constexpr double pi = std::numbers::pi;

/// x'' = f(x, p) on 0..1 with x or x' zero at both ends.
template <class F>
BoundaryValueProblem two_ends(F f, double p, bool slopes = false) {
  return {parametric_system(2,
                            [f](double, Values x, Values c, std::span<double> dxdt) {
                              dxdt[0] = x[1];
                              dxdt[1] = f(x[0], c[0]);
                            },
                            {p}),
          {0, 1},
          [slopes](Values x, Values, std::span<double> g) {
            g[0] = x[slopes ? 1 : 0];
            g[1] = x[slopes ? 3 : 2];
          }};
}
const BoundaryValueGuess nought = [](double, std::span<double> x) { std::ranges::fill(x, 0.0); };

std::vector<double> marks_of(const Family& family, FamilyEvent kind) {
  std::vector<double> values;
  for (const FamilyMark& mark : family.marks)
    if (mark.kind == kind) values.push_back(mark.at.constant);
  std::ranges::sort(values);
  return values;
}

// u = -2 log(cosh((x - 1/2) theta/2) / cosh(theta/4)), p = theta^2 / (2 cosh(theta/4)^2): the greatest u is
// 2 log cosh(theta/4), and dp/dtheta = 0 where theta/4 tanh(theta/4) = 1.
TEST(BoundaryFamily, FollowsBratuRoundItsFold) {
  const auto problem = two_ends([](double x, double p) { return -p * std::exp(x); }, 1);
  const auto families = follow_families(problem, {nought}, {.low = 0.1, .high = 4, .tolerance = 1e-8});
  ASSERT_EQ(families.size(), 1u);
  EXPECT_TRUE(families[0].status) << families[0].status.message;
  double quarter = 1, above = 1.4;
  for (int k = 0; k < 60; ++k) {
    const double middle = (quarter + above) / 2;
    (middle * std::tanh(middle) < 1 ? quarter : above) = middle;
  }
  const auto folds = marks_of(families[0], FamilyEvent::fold);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_NEAR(folds[0], 8 * std::pow(quarter / std::cosh(quarter), 2), 1e-9);
  EXPECT_TRUE(marks_of(families[0], FamilyEvent::branch_point).empty());
  EXPECT_TRUE(families[0].doubtful.empty());
  for (const FamilyPoint& point : families[0].points) {
    const double top = point.solution(0.5)[0], q = std::acosh(std::exp(top / 2));
    EXPECT_NEAR(point.constant, 8 * std::pow(q / std::cosh(q), 2), 1e-6) << "where x reaches " << top;
  }
  EXPECT_NEAR(families[0].points.front().constant + families[0].points.back().constant, 0.2, 1e-9);
}

// A rod that buckles under a load P: straight until n^2 pi^2, then P = (2 n K(sin(a/2)))^2 with the angle a at its end.
TEST(BoundaryFamily, BendsTheElastica) {
  const auto problem = two_ends([](double x, double p) { return -p * std::sin(x); }, 5, true);
  const auto families = follow_families(problem, {nought}, {.low = 5, .high = 100});
  ASSERT_EQ(families.size(), 4u);
  const auto loads = marks_of(families[0], FamilyEvent::branch_point);
  ASSERT_EQ(loads.size(), 3u);
  EXPECT_TRUE(families[0].doubtful.empty());
  for (std::size_t n = 1; n <= 3; ++n) {
    const double load = std::pow(double(n) * pi, 2);
    EXPECT_NEAR(loads[n - 1], load, 1e-7 * load);
    const Family& bent = families[n];
    EXPECT_EQ(bent.crossed, 0u);
    EXPECT_TRUE(bent.status) << bent.status.message;
    EXPECT_NEAR(bent.points.front().constant + bent.points.back().constant, 200, 1e-6);
    double least = 0, most = 0;
    for (const FamilyPoint& point : bent.points) {
      const double turned = point.solution(0.0)[0];
      least = std::min(least, turned), most = std::max(most, turned);
      const double k = std::comp_ellint_1(std::sin(std::abs(turned) / 2));
      EXPECT_NEAR(point.constant, std::pow(2 * double(n) * k, 2), 1e-5 * load) << "turned by " << turned;
    }
    EXPECT_NEAR(least, -most, 1e-5);  // to both sides
    EXPECT_GT(most, 0.5);
  }
}

// x'' = -p x + x^2 crosses x = 0 without turning round: the family is there on both sides of pi^2.
TEST(BoundaryFamily, PassesATranscriticalCrossing) {
  const auto problem = two_ends([](double x, double p) { return -p * x + x * x; }, 5);
  const auto families = follow_families(problem, {nought}, {.low = 5, .high = 20});
  ASSERT_EQ(families.size(), 2u);
  const auto crossings = marks_of(families[0], FamilyEvent::branch_point);
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_NEAR(crossings[0], pi * pi, 1e-7);
  const auto [low, high] = std::ranges::minmax(families[1].points, {}, &FamilyPoint::constant);
  EXPECT_NEAR(low.constant, 5, 1e-9);
  EXPECT_NEAR(high.constant, 20, 1e-9);
  EXPECT_TRUE(families[1].marks.empty());
}

// x = constant on the circle x^2 + (p - 1/2)^2 = r^2: two folds, and the family closes.
TEST(BoundaryFamily, ClosesAnIsland) {
  const BoundaryValueProblem circle{
      parametric_system(1, [](double, Values, Values, std::span<double> dxdt) { dxdt[0] = 0; }, {0.5}),
      {0, 1},
      [](Values x, Values p, std::span<double> g) { g[0] = x[0] * x[0] + (p[0] - 0.5) * (p[0] - 0.5) - 0.04; }};
  const auto families =
      follow_families(circle, {[](double, std::span<double> x) { x[0] = 0.2; }}, {.low = 0, .high = 1});
  ASSERT_EQ(families.size(), 1u);
  EXPECT_TRUE(families[0].status) << families[0].status.message;
  for (const double fold : marks_of(families[0], FamilyEvent::fold)) EXPECT_NEAR(std::abs(fold - 0.5), 0.2, 1e-9);
  EXPECT_GE(marks_of(families[0], FamilyEvent::fold).size(), 2u);
}

// x'' = -p x - c x^3, x(0) = 0, x'(1) = -b x(1): families leave x = 0 where sqrt(p) cos sqrt(p) = -b sin sqrt(p).
TEST(BoundaryFamily, FindsRandomEigenvalues) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int member = 0; member < 6; ++member) {
    const double b = 3 * any(random) + 1.5, c = any(random);
    BoundaryValueProblem problem = two_ends([c](double x, double p) { return -p * x - c * x * x * x; }, 1);
    problem.conditions = [b](Values x, Values, std::span<double> g) {
      g[0] = x[0];
      g[1] = x[3] + b * x[2];
    };
    const auto families =
        follow_families(problem, {nought}, {.low = 1, .high = 150, .largest_step = 0.03, .most_families = 1});
    std::vector<double> expected;
    const auto left = [b](double s) { return s * std::cos(s) + b * std::sin(s); };
    for (double s = 1; s < std::sqrt(150); s += 1e-3) {
      double low = s, high = std::min(s + 1e-3, std::sqrt(150));
      if (left(low) * left(high) > 0) continue;
      for (int k = 0; k < 60; ++k) (left(low) * left((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
      expected.push_back(low * low);
    }
    const auto found = marks_of(families.at(0), FamilyEvent::branch_point);
    ASSERT_EQ(found.size(), expected.size()) << "b = " << b;
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-6 * expected[k]);
  }
}

TEST(BoundaryFamily, SaysWhereAGuessLeadsNowhere) {
  const auto problem = two_ends([](double x, double p) { return -p * std::exp(x); }, 5);  // beyond the fold
  const auto families = follow_families(problem, {nought}, {.low = 4.5, .high = 6});
  ASSERT_EQ(families.size(), 1u);
  EXPECT_TRUE(families[0].points.empty());
  EXPECT_FALSE(families[0].status.message.empty());
}

}  // namespace
