// Branches of closed orbits through events, maps and time-dependent forces: their folds, period doublings and ends,
// against closed forms.
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/hybrid_continuation.hpp>
#include <continuo/studies/support/forcing_period.hpp>

namespace continuo::studies::hybrid_continuation_test {
namespace {

constexpr double pi = std::numbers::pi;

struct Followed {
  std::shared_ptr<const model::ModelProgram> program;
  HybridContinuationOptions options;
  OrbitBranch branch;

  OrbitBranch from(const OrbitMark& mark) const { return continue_hybrid_orbit(program, {}, mark, options); }
  std::vector<OrbitMark> of_kind(OrbitBifurcation kind) const { return marks_of(branch, kind); }
  static std::vector<OrbitMark> marks_of(const OrbitBranch& branch, OrbitBifurcation kind) {
    std::vector<OrbitMark> found;
    std::ranges::copy_if(branch.marks, std::back_inserter(found), [&](const auto& mark) { return mark.kind == kind; });
    return found;
  }
};

/// Along the first parameter of the text.
Followed along(const std::string& text, double low, double high,
               HybridOrbitOptions search = {.settle = 100, .duration = 40}) {
  Followed followed{.program = program_of(text), .options = {}, .branch = {}};
  search.forcing = forcing_of(*followed.program).period;
  const HybridOrbit start = find_hybrid_orbit(followed.program, {}, search);
  EXPECT_TRUE(start.outcome) << start.outcome.hint;
  followed.options.low = low;
  followed.options.high = high;
  followed.options.forcing = search.forcing;
  followed.branch = continue_hybrid_orbit(followed.program, {}, start, followed.options);
  EXPECT_TRUE(followed.branch.status) << followed.branch.status.message;
  return followed;
}

std::string map_text(const std::string& parameter, const std::string& image, const std::string& start) {
  return "param " + parameter + "\ny' = 0\ny(0) = " + start + "\nevery 1 { y := " + image + " }\nrun 0..100\n";
}

// The fixed point 1 - 1/r with its multiplier 2 - r doubles at 3, the cycle of two (4 + 2 r - r^2) at 1 + sqrt(6), and
// so on: 3.5440903596, 3.5644072661 (M. J. Feigenbaum, J. Stat. Phys. 19 (1978) 25-52).
TEST(HybridContinuation, TheLogisticMapDoublesItsPeriod) {
  const Followed followed = along(map_text("r = 2.8", "r*y*(1 - y)", "0.3"), 2, 3.58);
  for (const OrbitPoint& point : followed.branch.points) {
    EXPECT_NEAR(point.x[0], 1 - 1 / point.constant, 1e-9);
    ASSERT_EQ(point.multipliers.size(), 1u);
    EXPECT_NEAR(point.multipliers[0].real(), 2 - point.constant, 1e-9);
    EXPECT_NEAR(point.period, 1, 1e-14);
  }
  OrbitBranch branch = followed.branch;
  double period = 1;
  for (const double r : {3.0, 1 + std::sqrt(6), 3.5440903596, 3.5644072661}) {
    EXPECT_EQ(branch.ends[1].ending, OrbitEnding::bound) << branch.ends[1].reason;
    const auto doublings = Followed::marks_of(branch, OrbitBifurcation::period_doubling);
    ASSERT_EQ(doublings.size(), 1u) << r;
    EXPECT_NEAR(doublings[0].at.constant, r, 1e-9);
    EXPECT_NEAR(doublings[0].at.period, period, 1e-12);
    branch = followed.from(doublings[0]);
    ASSERT_TRUE(branch.status) << branch.status.message;
    period *= 2;
    for (const OrbitPoint& point : branch.points) {
      EXPECT_NEAR(point.period, period, 1e-12);
      if (period != 2) continue;
      EXPECT_NEAR(point.multipliers[0].real(), 4 + 2 * point.constant - std::pow(point.constant, 2), 1e-8);
    }
  }
}

// y = +-sqrt(p): both meet at 0, where the multiplier 1 - 2 y is 1; the upper one doubles at p = 1.
TEST(HybridContinuation, AFoldOfAMapIsRounded) {
  const Followed followed = along(map_text("p = 0.5", "y + p - y^2", "0.6"), -0.5, 1.5);
  const auto folds = followed.of_kind(OrbitBifurcation::fold),
             doublings = followed.of_kind(OrbitBifurcation::period_doubling);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_NEAR(folds[0].at.constant, 0, 1e-10);
  ASSERT_EQ(doublings.size(), 1u);
  EXPECT_NEAR(doublings[0].at.constant, 1, 1e-9);
  for (const OrbitPoint& point : followed.branch.points) EXPECT_NEAR(point.x[0] * point.x[0], point.constant, 1e-9);
  EXPECT_EQ(followed.branch.ends[0].ending, OrbitEnding::bound);
  EXPECT_EQ(followed.branch.ends[1].ending, OrbitEnding::bound);
}

// y = 0 with its multiplier r, and y^2 = r - 1 with 3 - 2 r, which doubles at 2.
TEST(HybridContinuation, BranchesOfAMapCross) {
  const Followed followed = along(map_text("r = 0.6", "r*y - y^3", "0"), 0.5, 2.5);
  const auto crossings = followed.of_kind(OrbitBifurcation::crossing);
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_NEAR(crossings[0].at.constant, 1, 1e-9);
  const OrbitBranch other = followed.from(crossings[0]);
  ASSERT_TRUE(other.status) << other.status.message;
  EXPECT_LT(other.points.front().x[0] * other.points.back().x[0], 0);
  for (const OrbitPoint& point : other.points) EXPECT_NEAR(std::pow(point.x[0], 2), point.constant - 1, 1e-8);
  const auto doublings = Followed::marks_of(other, OrbitBifurcation::period_doubling);
  ASSERT_EQ(doublings.size(), 2u);
  for (const OrbitMark& mark : doublings) EXPECT_NEAR(mark.at.constant, 2, 1e-9);
}

// Of the delayed logistic map multipliers solve l^2 - l + a - 1 = 0: at a = 2 they are exp(+-i pi/3).
TEST(HybridContinuation, ATorusIsBornWithItsRotation) {
  const Followed followed =
      along("param a = 1.8\ny' = 0\nz' = 0\ny(0) = 0.4\nz(0) = 0.4\nevery 1 { y := a*y*(1 - z); z := y }\nrun 0..100\n",
            1.5, 2.4);
  const auto tori = followed.of_kind(OrbitBifurcation::torus);
  ASSERT_EQ(tori.size(), 1u);
  EXPECT_NEAR(tori[0].at.constant, 2, 1e-9);
  EXPECT_NEAR(tori[0].rotation, 1.0 / 6, 1e-9);
}

// x'' + 0.2 x' + x = cos(W t): amplitude 1/|1 - W^2 + 0.2 i W|, multipliers exp((-0.1 +- i sqrt(0.99)) 2 pi/W).
TEST(HybridContinuation, AForcesPeriodMovesWithIts) {
  const Followed followed =
      along("param W = 1.3\nx'' = -x - 0.2*x' + cos(W*t)\nx(0) = 0\nx'(0) = 0\nrun 0..200\n", 0.7, 2);
  EXPECT_TRUE(followed.branch.marks.empty());
  EXPECT_NEAR(followed.branch.points.front().constant + followed.branch.points.back().constant, 2.7, 1e-12);
  for (const OrbitPoint& point : followed.branch.points) {
    const double w = point.constant;
    EXPECT_NEAR(point.period, 2 * pi / w, 1e-12);
    EXPECT_NEAR(point.high[0], 1 / std::hypot(1 - w * w, 0.2 * w), 1e-5);  // of a parabola through three points
    const auto expected = std::exp(std::complex(-0.1, std::sqrt(0.99)) * point.period);
    ASSERT_EQ(point.multipliers.size(), 2u);
    EXPECT_NEAR(point.multipliers[0].real(), expected.real(), 1e-9);
    EXPECT_NEAR(std::abs(point.multipliers[0].imag()), std::abs(expected.imag()), 1e-9);
  }
}

// The same mass between no walls until its amplitude F/|1 - W^2 + 0.2 i W| reaches one at 1.
TEST(HybridContinuation, TouchingAWallEndsTheBranchByName) {
  const Followed followed = along(
      "param F = 0.3\nx' = v\nv' = -x - 0.2*v + F*cos(1.3*t)\nx(0) = 0\nv(0) = 0\n"
      "when x rises through 1 { v := -0.8*v }\nrun 0..200\n",
      0.1, 2);
  const OrbitBranchEnd& end = followed.branch.ends[1];
  EXPECT_EQ(end.ending, OrbitEnding::grazing) << end.reason;
  EXPECT_NEAR(end.constant, std::hypot(0.69, 0.26), 1e-5);
  EXPECT_NE(end.reason.find("`x rises through 1`"), std::string::npos) << end.reason;
}

// A ball on a table A sin(W t), thrown once a period T: it meets the table at a phase with A W cos = g T/2 (1 - r)/(1 +
// r), so that these orbits begin at a fold where cos = 1; the determinant of its return is r^2, the trace 1 + r^2 - (1
// + r)^2 A W^2 sin/g, and the period doubles where 1 + trace + r^2 = 0.
TEST(HybridContinuation, OfABallOnAShakingTable) {
  const Followed followed = along(
      "param A = 0.2\nlet W = 2*pi\nlet r = 0.8\nh' = v\nv' = -9.81\nh(0) = 0.05\nv(0) = 4.95\n"
      "when h - A*sin(W*t) falls through 0 { v := -r*v + (1 + r)*A*W*cos(W*t) }\nrun 0..100\n",
      0.05, 0.5, {.settle = 200, .duration = 40});
  const double r = 0.8, g = 9.81, w = 2 * pi, along_table = pi * g * (1 - r) / (1 + r);
  const auto folds = followed.of_kind(OrbitBifurcation::fold),
             doublings = followed.of_kind(OrbitBifurcation::period_doubling);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_NEAR(folds[0].at.constant, along_table / (w * w), 1e-9);
  ASSERT_EQ(doublings.size(), 1u);
  EXPECT_NEAR(doublings[0].at.constant, std::hypot(2 * g * (1 + r * r) / std::pow(1 + r, 2), along_table) / (w * w),
              1e-8);
  for (const OrbitPoint& point : followed.branch.points) {
    ASSERT_EQ(point.multipliers.size(), 2u);
    EXPECT_NEAR((point.multipliers[0] * point.multipliers[1]).real(), r * r, 1e-7);
  }
}

// At each step of a rimless wheel the speed is multiplied by cos(2 alpha), at any slope: w^2 before the step is 4
// sin(gamma) sin(alpha)/(1 - cos(2 alpha)^2). There is no forcing, so its period is an unknown.
TEST(HybridContinuation, OfARimlessWheel) {
  const Followed followed = along(
      "param gamma = 0.1\nlet alpha = 0.3\na' = w\nw' = sin(a)\na(0) = -0.2; w(0) = 0.5\n"
      "when a rises through gamma + alpha { a := gamma - alpha; w := w*cos(2*alpha) }\nrun 0..100\n",
      0.09, 0.2);
  const double c = std::cos(0.6);
  for (const OrbitPoint& point : followed.branch.points) {
    const double w = std::sqrt(4 * std::sin(point.constant) * std::sin(0.3) / (1 - c * c));
    EXPECT_NEAR(point.high[1], w, 1e-8);
    EXPECT_NEAR(point.high[0], point.constant + 0.3, 1e-9);
    ASSERT_EQ(point.multipliers.size(), 1u);
    EXPECT_NEAR(point.multipliers[0].real(), c * c, 1e-8);
  }
  EXPECT_EQ(followed.branch.ends[0].ending, OrbitEnding::bound) << followed.branch.ends[0].reason;
  EXPECT_EQ(followed.branch.ends[1].ending, OrbitEnding::bound) << followed.branch.ends[1].reason;
}

// Duffing's oscillator in one of its two wells: the branch bends towards lower forces, with two folds, and its period
// doubles repeatedly. The distances between doublings decrease by a factor of 4.669 in the limit (M. J. Feigenbaum, J.
// Stat. Phys. 19 (1978) 25-52).
TEST(HybridContinuation, DuffingsPeriodDoublesAsFeigenbaumSays) {
  Followed followed = along("param F = 0.2\nx'' = -0.2*x' + x - x^3 + F*cos(t)\nx(0) = 1\nx'(0) = 0\nrun 0..300\n", 0.1,
                            0.4, {.settle = 300, .duration = 300});
  EXPECT_EQ(followed.of_kind(OrbitBifurcation::fold).size(), 2u);
  followed.options.low = 0.15;  // the cascade lies close together
  followed.options.high = 0.1584;
  std::vector<double> forces;
  OrbitBranch branch = followed.branch;
  for (int k = 0; k < 4; ++k) {
    const auto doublings = Followed::marks_of(branch, OrbitBifurcation::period_doubling);
    ASSERT_FALSE(doublings.empty()) << k;
    forces.push_back(doublings.front().at.constant);
    EXPECT_NEAR(doublings.front().at.period, 2 * pi * std::pow(2, k), 1e-9);
    branch = followed.from(doublings.front());
    ASSERT_TRUE(branch.status) << branch.status.message << k;
  }
  // By Liouville the product of the multipliers is exp(-0.2 T).
  for (const OrbitPoint& point : branch.points)
    EXPECT_NEAR((point.multipliers[0] * point.multipliers[1]).real(), std::exp(-0.2 * 32 * pi), 1e-8);
  EXPECT_NEAR((forces[2] - forces[1]) / (forces[3] - forces[2]), 4.669, 0.05);
}

// So slow that it hardly comes over the top: w^2 = 2 (1 - cos(gamma - alpha)) after the step.
TEST(HybridContinuation, NearARestThePeriodGrowsWithoutBound) {
  const Followed followed = along(
      "param gamma = 0.1\nlet alpha = 0.3\na' = w\nw' = sin(a)\na(0) = -0.2; w(0) = 0.5\n"
      "when a rises through gamma + alpha { a := gamma - alpha; w := w*cos(2*alpha) }\nrun 0..100\n",
      0.01, 0.12);
  const OrbitBranchEnd& end = followed.branch.ends[0];
  EXPECT_EQ(end.ending, OrbitEnding::homoclinic) << end.reason;
  const double c2 = std::pow(std::cos(0.6), 2), gamma = end.constant;
  EXPECT_NEAR(c2 * 4 * std::sin(gamma) * std::sin(0.3) / (1 - c2), 2 * (1 - std::cos(gamma - 0.3)), 1e-5);
  EXPECT_TRUE(followed.branch.marks.empty());
}

TEST(HybridContinuation, OfAFamilyIsRefused) {
  const auto program =
      program_of("param g = 9.81\nh'' = -g\nh(0) = 1\nh'(0) = 0\nwhen h falls through 0 { h' := -h' }\nrun 0..20\n");
  const HybridOrbit start = find_hybrid_orbit(program, {}, {.settle = 10, .duration = 20});
  ASSERT_TRUE(start.outcome);
  HybridContinuationOptions options;
  options.low = 5;
  options.high = 15;
  EXPECT_NE(continue_hybrid_orbit(program, {}, start, options).status.message.find("conserved"), std::string::npos);
}

}  // namespace
}  // namespace continuo::studies::hybrid_continuation_test
