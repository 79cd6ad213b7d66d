// Orbits that return up to whole turns of angles: rotations, with periods and multipliers in closed form.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/studies/orbit_continuation.hpp>
#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/periodic_orbit.hpp>

namespace continuo::studies::rotation_test {
namespace {

constexpr double turn = 2 * std::numbers::pi;

// theta' = w + sin(theta) has the period 2 pi / sqrt(w^2 - 1); z follows it, and differences of z decay by exp(-T).
ParametricSystem rotor(double w) {
  const auto f = [](double, Values x, Values p, std::span<double> dxdt) {
    dxdt[0] = p[0] + std::sin(x[0]);
    dxdt[1] = -x[1] + std::cos(x[0]);
  };
  return parametric_system(2, f, {w});
}
double period_of(double w) {
  return turn / std::sqrt(w * w - 1);
}

TEST(Rotation, IsFoundThoughItNeverComesBack) {
  for (const double w : {1.2, 2.0, -1.5}) {
    const auto found = find_periodic_orbit(rotor(w), {0.3, 0}, {.settle = 50, .duration = 100});
    ASSERT_TRUE(found.outcome) << describe(found.outcome);
    EXPECT_NEAR(found.period, period_of(w), 1e-8) << w;
    ASSERT_EQ(found.advance.size(), 2u);
    EXPECT_DOUBLE_EQ(found.advance[0], w > 0 ? turn : -turn);
    EXPECT_EQ(found.advance[1], 0);
    EXPECT_NEAR(found.multipliers[1].real(), std::exp(-period_of(w)), 1e-7);
    EXPECT_TRUE(found.stable);
    EXPECT_LT(std::abs(found.orbit(0)[0]), turn);  // not where the run was by then
  }
}

// Two rotors coupled by a spring cannot turn independently: f is the same only when both have turned. Their difference
// decays by exp(-2 k T).
TEST(Rotation, OfTwoThatAreCoupledIsOneOfBoth) {
  constexpr double w = 1.3, k = 0.2;
  const auto f = [](double, Values x, Values, std::span<double> dxdt) {
    dxdt[0] = w + std::sin(x[0]) + k * (x[1] - x[0]);
    dxdt[1] = w + std::sin(x[1]) + k * (x[0] - x[1]);
  };
  const auto found = find_periodic_orbit(parametric_system(2, f), {0, 0.5}, {.settle = 100, .duration = 60});
  ASSERT_TRUE(found.outcome) << describe(found.outcome);
  EXPECT_NEAR(found.period, period_of(w), 1e-8);
  EXPECT_EQ(found.advance, std::vector<double>({turn, turn}));
  EXPECT_NEAR(found.multipliers[1].real(), std::exp(-2 * k * found.period), 1e-7);
}

// If f differs after a turn, there is no periodic motion.
TEST(Rotation, NeedsEquationsThatRepeatThemselves) {
  const auto f = [](double, Values x, Values, std::span<double> dxdt) {
    dxdt[0] = 1.5 + std::sin(1.1 * x[0]);
    dxdt[1] = -x[1] + std::cos(std::numbers::sqrt2 * x[0]);
  };
  const auto found = find_periodic_orbit(parametric_system(2, f), {0, 0}, {.settle = 20, .duration = 100});
  EXPECT_FALSE(found.outcome);
}

TEST(Rotation, IsFollowedAsItSlowsDown) {
  const auto start = find_periodic_orbit(rotor(1.5), {0.3, 0}, {.settle = 50, .duration = 100});
  const auto branch = continue_orbit(rotor(1.5), start, {.low = 1.05, .high = 3});
  ASSERT_TRUE(branch.status) << branch.status.message;
  for (const OrbitBranchEnd& end : branch.ends) EXPECT_EQ(end.ending, OrbitEnding::bound) << end.reason;
  ASSERT_GT(branch.points.size(), 10u);
  for (const OrbitPoint& point : branch.points) {
    EXPECT_NEAR(point.period, period_of(point.constant), 1e-7 * point.period);
    EXPECT_EQ(point.advance, std::vector<double>({turn, 0}));
  }
}

// A Moebius band round the circle of theta' = 1 + 0.3 cos(theta): the transverse vector, xi, has turned by half when
// theta has turned once, so that the multipliers are -exp(T (p - q^2)) and -exp(-T). With xi_0' = (p - q^2) xi_0 -
// xi_0^3 an orbit of two turns and amplitude sqrt(p - q^2) is born at p = q^2.
TEST(Rotation, DoublesItsPeriodToTwoTurns) {
  const auto f = [](double, Values x, Values p, std::span<double> dxdt) {
    const double c = std::cos(x[0] / 2), s = std::sin(x[0] / 2);
    const double a = c * x[1] + s * x[2], b = -s * x[1] + c * x[2];
    const double da = (p[0] - p[1] * p[1]) * a - a * a * a, db = -b;
    dxdt[0] = 1 + 0.3 * std::cos(x[0]);
    dxdt[1] = c * da - s * db - x[2] * dxdt[0] / 2;
    dxdt[2] = s * da + c * db + x[1] * dxdt[0] / 2;
  };
  const double q = 0.3, period = turn / std::sqrt(1 - 0.09);
  const auto system = parametric_system(3, f, {-0.2, q});
  const auto start = find_periodic_orbit(system, {0, 0.1, 0.1}, {.settle = 200, .duration = 60});
  ASSERT_TRUE(start.outcome) << describe(start.outcome);
  EXPECT_NEAR(start.period, period, 1e-8);
  const auto branch = continue_orbit(system, start, {.constant = 0, .low = -0.3, .high = 0.5});
  ASSERT_TRUE(branch.status) << branch.status.message;
  ASSERT_EQ(branch.marks.size(), 1u);
  const OrbitMark& doubling = branch.marks[0];
  EXPECT_EQ(doubling.kind, OrbitBifurcation::period_doubling);
  EXPECT_NEAR(doubling.at.constant, q * q, 1e-8);

  const auto doubled = continue_orbit(system, doubling, {.constant = 0, .low = -0.3, .high = 0.5});
  ASSERT_TRUE(doubled.status) << doubled.status.message;
  ASSERT_GT(doubled.points.size(), 5u);
  EXPECT_EQ(doubled.ends[1].ending, OrbitEnding::bound) << doubled.ends[1].reason;
  for (const OrbitPoint& point : doubled.points) {
    EXPECT_NEAR(point.period, 2 * period, 1e-7);
    EXPECT_EQ(point.advance, std::vector<double>({2 * turn, 0, 0}));
    const double amplitude = std::sqrt(std::max(point.constant - q * q, 0.0));
    if (amplitude < 0.05) continue;
    EXPECT_NEAR(point.high[1], amplitude, 1e-6) << point.constant;
  }

  const auto curve =
      follow_orbit_bifurcation(system, doubling, {.constants = {0, 1}, .low = {-0.1, -0.5}, .high = {0.2, 0.5}});
  ASSERT_EQ(curve.status.message, "");
  ASSERT_GT(curve.points.size(), 10u);
  for (const OrbitCurvePoint& point : curve.points)
    EXPECT_NEAR(point.constants[0], point.constants[1] * point.constants[1], 1e-8);
}

}  // namespace
}  // namespace continuo::studies::rotation_test
