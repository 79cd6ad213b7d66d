#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/studies/periodic_orbit.hpp>

namespace continuo::studies::periodic_orbit_test {
namespace {

ParametricSystem van_der_pol(double mu) {
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = x[1];
    out[1] = p[0] * (1 - x[0] * x[0]) * x[1] - x[0];
  };
  return parametric_system(2, f, {mu});
}

/// r' = r (1 - r^2), angle' = 3: the unit circle, period 2 pi / 3, multiplier exp(-2 T).
TEST(PeriodicOrbit, TheCircleIsFound) {
  const auto f = [](double, Values x, Values, std::span<double> out) {
    const double r = 1 - x[0] * x[0] - x[1] * x[1];
    out[0] = x[0] * r - 3 * x[1];
    out[1] = x[1] * r + 3 * x[0];
  };
  const auto found = find_periodic_orbit(parametric_system(2, f), {0.1, 0}, {.settle = 20, .duration = 50});
  ASSERT_TRUE(found.outcome) << describe(found.outcome);
  const double period = 2 * std::numbers::pi / 3;
  EXPECT_NEAR(found.period, period, 1e-9);
  ASSERT_EQ(found.multipliers.size(), 2u);
  EXPECT_NEAR(found.multipliers[0].real(), 1, 1e-6);
  EXPECT_NEAR(found.multipliers[1].real(), std::exp(-2 * period), 1e-6);
  EXPECT_TRUE(found.stable);
}

/// Periods to ten digits: C. M. Andersen, J. F. Geer, SIAM J. Appl. Math. 42 (1982) for mu = 1; the section of an
/// integration with a tolerance of 1e-12 as the second, independent way.
TEST(PeriodicOrbit, VanDerPol) {
  for (const double mu : {1.0, 10.0}) {
    const auto found = find_periodic_orbit(van_der_pol(mu), {2, 0}, {.settle = 60, .duration = 60});
    ASSERT_TRUE(found.outcome) << describe(found.outcome);
    const auto section = poincare_section(van_der_pol(mu), {2, 0}, 0, {.settle = 100, .duration = 60, .rtol = 1e-12});
    ASSERT_GE(section.points.size(), 2u);
    const auto& points = section.points;
    EXPECT_NEAR(found.period, points.back().t - points[points.size() - 2].t, 1e-8 * found.period);
    if (mu == 1) {
      EXPECT_NEAR(found.period, 6.6632868593, 1e-9);
    }
    // The product of the multipliers is exp of the integral of the divergence, far below 1.
    EXPECT_TRUE(found.stable);
    EXPECT_NEAR(found.multipliers[0].real(), 1, 1e-5);
  }
}

// An orbit with jumps a million times shorter than its period is found from any start of the search, to eight digits of
// the period by a section at another place with another tolerance. The attraction is so strong that perturbations
// vanish.
TEST(PeriodicOrbit, ARelaxationOscillation) {
  const auto section =
      poincare_section(van_der_pol(1000), {2, 0}, 0, {.level = 1.5, .settle = 3000, .duration = 4000, .rtol = 1e-11});
  ASSERT_GE(section.points.size(), 2u);
  const double period = section.points.back().t - section.points[section.points.size() - 2].t;
  EXPECT_NEAR(period, 1614.4011258, 1e-8 * period);
  for (const double duration : {4000.0, 5000.0}) {
    const auto found = find_periodic_orbit(van_der_pol(1000), {2, 0}, {.settle = 3000, .duration = duration});
    ASSERT_TRUE(found.outcome) << describe(found.outcome);
    EXPECT_NEAR(found.period, period, 1e-8 * period);
    ASSERT_EQ(found.multipliers.size(), 2u);
    EXPECT_EQ(found.multipliers[0].real(), 1);
    EXPECT_LT(std::abs(found.multipliers[1]), 1e-4);
    EXPECT_TRUE(found.stable);
    EXPECT_NEAR(found.orbit(0)[0], found.orbit(1)[0], 1e-7);
  }
}

// All orbits of a pendulum are periodic, and none is isolated.
TEST(PeriodicOrbit, AFamilyIsNoOrbit) {
  const auto pendulum = [](double, Values x, Values, std::span<double> out) {
    out[0] = x[1], out[1] = -std::sin(x[0]);
  };
  const auto found = find_periodic_orbit(parametric_system(2, pendulum), {1, 0}, {.settle = 10, .duration = 50});
  EXPECT_FALSE(found.outcome);
}

TEST(PeriodicOrbit, WhatHasNone) {
  const auto sink = [](double, Values x, Values, std::span<double> out) { out[0] = -x[0]; };
  const auto rest = find_periodic_orbit(parametric_system(1, sink), {1});
  EXPECT_FALSE(rest.outcome);
  EXPECT_NE(rest.outcome.hint.find("equilibrium"), std::string::npos) << rest.outcome.hint;
  const auto forced = [](double t, Values x, Values, std::span<double> out) { out[0] = std::cos(t) - x[0]; };
  EXPECT_NE(find_periodic_orbit(parametric_system(1, forced), {1}).outcome.hint.find("time"), std::string::npos);
}

}  // namespace
}  // namespace continuo::studies::periodic_orbit_test
