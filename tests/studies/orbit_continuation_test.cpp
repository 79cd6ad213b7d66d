// Branches of closed orbits against normal forms, whose orbits, periods and multipliers are known, and against
// published values.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/studies/orbit_continuation.hpp>

namespace continuo::studies::orbit_continuation_test {
namespace {

constexpr double pi = std::numbers::pi;

/// r' = r g(r^2, mu), angle' = omega(r^2): circles with g = 0.
template <class Growth, class Speed>
ParametricSystem rotating(double mu, Growth g, Speed omega) {
  const auto f = [=](double, Values x, Values p, std::span<double> out) {
    const double square = x[0] * x[0] + x[1] * x[1], grow = g(square, p[0]), turn = omega(square);
    out[0] = grow * x[0] - turn * x[1];
    out[1] = grow * x[1] + turn * x[0];
  };
  return parametric_system(2, f, {mu});
}
double radius(const OrbitPoint& point) {
  return std::hypot(point.x[0], point.x[1]);
}

std::vector<OrbitMark> of_kind(const OrbitBranch& branch, OrbitBifurcation kind) {
  std::vector<OrbitMark> found;
  std::ranges::copy_if(branch.marks, std::back_inserter(found), [&](const auto& mark) { return mark.kind == kind; });
  return found;
}

// r' = r (mu - r^2), angle' = 2 + r^2: r = sqrt(mu), T = 2 pi / (2 + mu), multiplier exp(-2 mu T), born at mu = 0.
TEST(OrbitContinuation, HopfNormalForm) {
  const auto system =
      rotating(1, [](double square, double mu) { return mu - square; }, [](double square) { return 2 + square; });
  const auto start = find_periodic_orbit(system, {0.3, 0}, {.settle = 20, .duration = 20});
  ASSERT_TRUE(start.outcome);
  const auto branch = continue_orbit(system, start, {.low = -1, .high = 3});
  ASSERT_TRUE(branch.status) << branch.status.message;
  EXPECT_EQ(branch.ends[0].ending, OrbitEnding::hopf);
  EXPECT_NEAR(branch.ends[0].constant, 0, 1e-10);
  EXPECT_EQ(branch.ends[1].ending, OrbitEnding::bound);
  EXPECT_EQ(branch.points.back().constant, 3);
  EXPECT_TRUE(branch.marks.empty());
  EXPECT_GE(branch.points.size(), 20u);
  for (std::size_t k = 1; k < branch.points.size(); ++k) {
    const OrbitPoint& point = branch.points[k];
    const double mu = point.constant, period = 2 * pi / (2 + mu);
    // The error inside of the intervals is below 1e-7, at their ends far below; near the Hopf point an error of r is
    // that of mu - r^2 divided by 2 r.
    EXPECT_NEAR(radius(point), std::sqrt(mu), 1e-8 + 1e-9 / std::sqrt(mu));
    EXPECT_NEAR(point.period, period, 1e-8 * period);
    ASSERT_EQ(point.multipliers.size(), 1u);
    EXPECT_NEAR(point.multipliers[0].real(), std::exp(-2 * mu * period), 1e-7);
    EXPECT_TRUE(point.stable);
    EXPECT_NEAR(point.high[0], std::sqrt(mu), 1e-7);
    EXPECT_NEAR(point.low[1], -std::sqrt(mu), 1e-7);
  }
}

// Bautin: r' = r (mu + r^2 - r^4): two circles between the fold at mu = -1/4, r^2 = 1/2, and the Hopf point at 0.
TEST(OrbitContinuation, AFoldIsRounded) {
  const auto bautin = [](double mu) {
    return rotating(
        mu, [](double square, double p) { return p + square - square * square; }, [](double) { return 1.5; });
  };
  const auto start = find_periodic_orbit(bautin(0.5), {1, 0}, {.settle = 20, .duration = 20});
  ASSERT_TRUE(start.outcome);
  const auto branch = continue_orbit(bautin(0.5), start, {.low = -1, .high = 1});
  EXPECT_EQ(branch.ends[0].ending, OrbitEnding::hopf);
  EXPECT_NEAR(branch.ends[0].constant, 0, 1e-10);
  EXPECT_EQ(branch.ends[1].ending, OrbitEnding::bound);
  ASSERT_EQ(branch.marks.size(), 1u);
  EXPECT_EQ(branch.marks[0].kind, OrbitBifurcation::fold);
  EXPECT_NEAR(branch.marks[0].at.constant, -0.25, 1e-8);
  EXPECT_NEAR(branch.marks[0].at.multipliers[0].real(), 1, 1e-6);
  EXPECT_NEAR(std::pow(radius(branch.marks[0].at), 2), 0.5, 1e-6);
  for (std::size_t k = 1; k < branch.points.size(); ++k) {
    const OrbitPoint& point = branch.points[k];
    const double square = std::pow(radius(point), 2);
    EXPECT_NEAR(point.constant, square * square - square, 1e-7);
    // d(r g)/dr = 2 r^2 (1 - 2 r^2)
    EXPECT_NEAR(point.multipliers[0].real(), std::exp(2 * square * (1 - 2 * square) * 2 * pi / 1.5), 1e-6);
    EXPECT_EQ(point.stable, square > 0.5) << square;
  }
  // From the other end, where the orbits cannot be found by running: they repel.
  const HopfPoint hopf = *find_hopf_point(bautin(0.1), {.value = 0.1, .low = -1, .high = 1, .x = {0.01, 0}});
  EXPECT_NEAR(hopf.angular_frequency, 1.5, 1e-8);
  const auto other = continue_orbit(bautin(0.1), hopf, {.low = -1, .high = 1});
  EXPECT_EQ(other.ends[0].ending, OrbitEnding::hopf);
  EXPECT_EQ(other.ends[1].ending, OrbitEnding::bound);
  ASSERT_EQ(other.marks.size(), 1u);
  EXPECT_NEAR(other.marks[0].at.constant, -0.25, 1e-8);
}

// C. M. Andersen, J. F. Geer, SIAM J. Appl. Math. 42 (1982); mu = 10 by tests/studies/periodic_orbit_test.
TEST(OrbitContinuation, PeriodsOfVanDerPol) {
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = x[1];
    out[1] = p[0] * (1 - x[0] * x[0]) * x[1] - x[0];
  };
  const auto system = parametric_system(2, f, {2});
  const auto start = find_periodic_orbit(system, {2, 0}, {.settle = 50, .duration = 50});
  const auto branch = continue_orbit(system, start, {.low = 1, .high = 10});
  ASSERT_TRUE(branch.status) << branch.status.message;
  EXPECT_TRUE(branch.marks.empty());
  EXPECT_EQ(branch.points.front().constant, 1);
  EXPECT_NEAR(branch.points.front().period, 6.6632868593, 1e-8);
  EXPECT_EQ(branch.points.back().constant, 10);
  EXPECT_NEAR(branch.points.back().period, 19.07836957, 1e-7);
  for (const OrbitPoint& point : branch.points) EXPECT_TRUE(point.stable);
}

ParametricSystem lorenz(double rho) {
  const auto f = [](double, Values x, Values p, std::span<double> dxdt) {
    dxdt[0] = p[0] * (x[1] - x[0]);
    dxdt[1] = x[0] * (p[1] - x[2]) - x[1];
    dxdt[2] = x[0] * x[1] - p[2] * x[2];
  };
  return parametric_system(3, f, {10, rho, 8.0 / 3});
}

// The orbits that are born at the subcritical Hopf point, sigma (sigma + beta + 3) / (sigma - beta - 1), all repel;
// they end in the homoclinic orbit of the origin, at 13.926557407 (C. Sparrow, "The Lorenz Equations", 1982: 13.926).
TEST(OrbitContinuation, LorenzFromTheHopfPointToTheHomoclinicOrbit) {
  const double side = std::sqrt(8.0 / 3 * 23);
  const auto hopf = find_hopf_point(
      lorenz(24), {.constant = 1, .value = 24, .low = 0, .high = 30, .x = {side, side, 23}, .angular_frequency = 9});
  ASSERT_TRUE(hopf);
  EXPECT_NEAR(hopf->constant, 470.0 / 19, 1e-8);
  const auto branch = continue_orbit(lorenz(24), *hopf, {.constant = 1, .low = 10, .high = 30});
  ASSERT_TRUE(branch.status) << branch.status.message;
  EXPECT_EQ(branch.ends[1].ending, OrbitEnding::homoclinic) << branch.ends[1].reason;
  EXPECT_NEAR(branch.ends[1].constant, 13.926557407, 1e-6);
  EXPECT_TRUE(branch.marks.empty());
  for (std::size_t k = 1; k < branch.points.size(); ++k) EXPECT_FALSE(branch.points[k].stable);

  // And back from the middle.
  const auto middle = std::ranges::find_if(branch.points, [](const auto& point) { return point.constant < 20; });
  const auto back = continue_orbit(lorenz(24), *middle, {.constant = 1, .low = 15, .high = 30});
  ASSERT_TRUE(back.status) << back.status.message;
  EXPECT_EQ(back.ends[0].ending, OrbitEnding::bound);
  EXPECT_EQ(back.points.front().constant, 15);
  EXPECT_EQ(back.ends[1].ending, OrbitEnding::hopf);
  EXPECT_NEAR(back.ends[1].constant, 470.0 / 19, 1e-8);
}

// A canard: the orbit of x' = (y - x^3/3 + x) / eps, y' = a - x explodes within exp(-1/eps) of a = 1 - eps/8 - 3
// eps^2/32 - 173 eps^3/1024 - O(eps^4) (A. K. Zvonkin, M. A. Shubin, "Non-standard analysis and singular perturbations
// of ordinary differential equations", Russ. Math. Surv. 39 (1984)), from a small one to the relaxation oscillation.
// All orbits are stable: in the plane a multiplier is exp of the integral of the divergence, never below 0.
TEST(OrbitContinuation, CanardsAreFollowed) {
  const double eps = 0.02;
  const auto f = [=](double, Values x, Values p, std::span<double> out) {
    out[0] = (x[1] - x[0] * x[0] * x[0] / 3 + x[0]) / eps;
    out[1] = p[0] - x[0];
  };
  const auto system = parametric_system(2, f, {0.99});
  const auto hopf = find_hopf_point(
      system, {.value = 0.99, .low = 0.9, .high = 1.1, .x = {1, -2.0 / 3}, .angular_frequency = 1 / std::sqrt(eps)});
  ASSERT_TRUE(hopf);
  const auto branch = continue_orbit(system, *hopf, {.low = 0.9, .high = 1.1});
  EXPECT_EQ(branch.ends[1].ending, OrbitEnding::bound) << branch.ends[1].reason;
  EXPECT_TRUE(branch.marks.empty());
  const double canard = 1 - eps / 8 - 3 * eps * eps / 32 - 173 * eps * eps * eps / 1024;
  double least = 1;
  for (std::size_t k = 1; k < branch.points.size(); ++k) {
    const OrbitPoint& point = branch.points[k];
    EXPECT_TRUE(point.stable);
    EXPECT_GE(point.multipliers[0].real(), 0);
    EXPECT_GE(point.high[0], branch.points[k - 1].high[0] - 1e-3);  // encloses the orbit before, until they jump
    EXPECT_LE(point.low[0], branch.points[k - 1].low[0] + 1e-3);
    least = std::min(least, point.multipliers[0].real());
  }
  // The orbit with the longest period follows the repelling branch to its end.
  const OrbitPoint& longest = *std::ranges::max_element(branch.points, {}, &OrbitPoint::period);
  EXPECT_NEAR(longest.constant, canard, 10 * std::pow(eps, 4));
  EXPECT_GT(longest.period, 1.3 * branch.points.back().period);
  EXPECT_LT(least, 1e-60);
}

/// y' = g(y) in other coordinates: x = A y with two terms of second order added, whose inverse is equally simple. g has
/// a circle of radius sqrt(mu), with fast decaying and fast growing directions: multipliers exp(-2 mu T), exp(-20 T),
/// exp(8 T), of sizes from 1e-55 to 1e22.
ParametricSystem disguised_circle(double mu, double seed) {
  const auto f = [=](double, Values x, Values p, std::span<double> out) {
    std::array<double, 16> a{};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        a[i * 4 + j] = (i == j ? 1 : 0) + 0.3 * std::sin(seed * static_cast<double>(1 + i * 4 + j));
    const double shear = std::cos(seed), other = std::sin(3 * seed);
    // The inverse: first of the shears, then of the matrix, by elimination without pivots, since it is near the
    // identity.
    std::array<double, 4> z{x[0], x[1], x[2] - shear * x[0] * x[0], x[3] - other * x[0] * x[1]}, y(z);
    auto m = a;
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t i = k + 1; i < 4; ++i) {
        const double factor = m[i * 4 + k] / m[k * 4 + k];
        for (std::size_t j = k; j < 4; ++j) m[i * 4 + j] -= factor * m[k * 4 + j];
        y[i] -= factor * y[k];
      }
    for (std::size_t i = 4; i-- > 0;) {
      for (std::size_t j = i + 1; j < 4; ++j) y[i] -= m[i * 4 + j] * y[j];
      y[i] /= m[i * 4 + i];
    }
    const double grow = p[0] - y[0] * y[0] - y[1] * y[1];
    const std::array<double, 4> g{grow * y[0] - y[1], grow * y[1] + y[0], -20 * y[2], 8 * y[3]};
    for (std::size_t i = 0; i < 4; ++i) {
      out[i] = 0;
      for (std::size_t j = 0; j < 4; ++j) out[i] += a[i * 4 + j] * g[j];
    }
    out[2] += 2 * shear * x[0] * out[0];
    out[3] += other * (x[0] * out[1] + x[1] * out[0]);
  };
  return parametric_system(4, f, {mu});
}
TEST(OrbitContinuation, MultipliersOfAllSizesKeepTheirDigits) {
  for (const double seed : {0.7, 1.9}) {
    const auto system = disguised_circle(0.1, seed);
    const auto hopf = find_hopf_point(system, {.value = 0.1, .low = -1, .high = 1, .x = {0, 0, 0, 0}});
    ASSERT_TRUE(hopf);
    const auto branch = continue_orbit(system, *hopf, {.low = -1, .high = 1, .most_points = 12});
    EXPECT_EQ(branch.points.size(), 12u) << branch.ends[1].reason;
    EXPECT_TRUE(branch.marks.empty());
    const double turn = 2 * pi;
    for (std::size_t k = 1; k < branch.points.size(); ++k) {
      const OrbitPoint& point = branch.points[k];
      EXPECT_NEAR(point.period, turn, 1e-8);
      ASSERT_EQ(point.multipliers.size(), 3u);
      // df/dx is by differences, along an orbit whose error is below 1e-7.
      const std::array<double, 3> exponents{8 * turn, -2 * point.constant * turn, -20 * turn};
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(std::log(point.multipliers[i].real()), exponents[i], 1e-6 + 1e-7 * std::abs(exponents[i]));
      }
    }
  }
}

// C. Roessler's system with a = b = 0.2: the first period doubling of its cascade is near c = 2.83. Two tolerances
// agree, and beyond it motions tend to the orbit of twice the period.
TEST(OrbitContinuation, RoesslerDoublesItsPeriod) {
  const auto roessler = [](double c) {
    const auto f = [](double, Values x, Values p, std::span<double> out) {
      out[0] = -x[1] - x[2];
      out[1] = x[0] + 0.2 * x[1];
      out[2] = 0.2 + x[2] * (x[0] - p[0]);
    };
    return parametric_system(3, f, {c});
  };
  const auto start = find_periodic_orbit(roessler(2.5), {1, 1, 0}, {.settle = 500, .duration = 100});
  ASSERT_TRUE(start.outcome) << describe(start.outcome);
  std::vector<double> doubling;
  for (const double rtol : {1e-8, 1e-11}) {
    const auto branch = continue_orbit(roessler(2.5), start, {.low = 2.3, .high = 3.2, .rtol = rtol});
    const auto found = of_kind(branch, OrbitBifurcation::period_doubling);
    ASSERT_EQ(found.size(), 1u);
    doubling.push_back(found[0].at.constant);
    EXPECT_NEAR(found[0].at.multipliers[0].real(), -1, 1e-6);
    for (const OrbitPoint& point : branch.points) EXPECT_EQ(point.stable, point.constant < doubling.back());
  }
  EXPECT_NEAR(doubling[0], doubling[1], 1e-6);
  EXPECT_NEAR(doubling[1], 2.832, 1e-3);
  const auto before = find_periodic_orbit(roessler(doubling[1] - 0.02), {1, 1, 0}, {.settle = 2000, .duration = 100});
  const auto after = find_periodic_orbit(roessler(doubling[1] + 0.02), {1, 1, 0}, {.settle = 2000, .duration = 100});
  EXPECT_NEAR(after.period / before.period, 2, 0.02);
}

// Two rotations: r' = r (1 - r^2) with angular velocity 1, and a spiral u' = (mu - r) u + i omega u that depends on the
// first: the multipliers of the circle r = 1 are exp(-4 pi) and exp(2 pi (mu - 1 +- i omega)).
TEST(OrbitContinuation, ATorusIsBorn) {
  const double omega = 0.3;
  const auto f = [=](double, Values x, Values p, std::span<double> out) {
    const double square = x[0] * x[0] + x[1] * x[1], outer = x[2] * x[2] + x[3] * x[3];
    out[0] = (1 - square) * x[0] - x[1];
    out[1] = (1 - square) * x[1] + x[0];
    out[2] = (p[0] - std::sqrt(square) - outer) * x[2] - omega * x[3];
    out[3] = (p[0] - std::sqrt(square) - outer) * x[3] + omega * x[2];
  };
  const auto system = parametric_system(4, f, {0.5});
  const auto start = find_periodic_orbit(system, {0.5, 0, 0.1, 0}, {.settle = 60, .duration = 60});
  ASSERT_TRUE(start.outcome) << describe(start.outcome);
  const auto branch = continue_orbit(system, start, {.low = 0.4, .high = 1.6});
  ASSERT_EQ(branch.marks.size(), 1u);
  EXPECT_EQ(branch.marks[0].kind, OrbitBifurcation::torus);
  EXPECT_NEAR(branch.marks[0].at.constant, 1, 1e-8);
  EXPECT_NEAR(branch.marks[0].rotation, omega, 1e-7);
  for (const OrbitPoint& point : branch.points) EXPECT_EQ(point.stable, point.constant < 1);
}

// Round the unit circle a strip is turned by half a turn: across it s' = (g - s^2) s and q' = -q, where (a, b) = s
// e(angle / 2) + q e(angle / 2 + pi / 2). With g = p (1 - p) the circle doubles its period at p = 0 and p = 1, and
// between them the orbit s^2 = g goes round twice in 4 pi, with the multipliers exp(-8 pi g), exp(-4 pi), exp(-8 pi).
TEST(OrbitContinuation, OrbitsOfTwiceThePeriodAreFollowed) {
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    const double r = std::hypot(x[0], x[1]), c = x[0] / r, s = x[1] / r, g = p[0] * (1 - p[0]);
    out[0] = (1 - r * r) * x[0] - x[1];
    out[1] = (1 - r * r) * x[1] + x[0];
    const double along_a = ((1 + c) * x[2] + s * x[3]) / 2, along_b = (s * x[2] + (1 - c) * x[3]) / 2;
    const double square = x[2] * along_a + x[3] * along_b;
    out[2] = -x[3] / 2 + (g - square) * along_a - (x[2] - along_a);
    out[3] = x[2] / 2 + (g - square) * along_b - (x[3] - along_b);
  };
  const auto system = parametric_system(4, f, {-0.5});
  const auto start = find_periodic_orbit(system, {0.9, 0, 0.1, 0}, {.settle = 60, .duration = 60});
  ASSERT_TRUE(start.outcome) << describe(start.outcome);
  const auto branch = continue_orbit(system, start, {.low = -0.5, .high = 1.5});
  const auto marks = of_kind(branch, OrbitBifurcation::period_doubling);
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_NEAR(marks[0].at.constant, 0, 1e-9);
  EXPECT_NEAR(marks[1].at.constant, 1, 1e-9);
  for (const OrbitMark& mark : marks) {
    const auto doubled = continue_orbit(system, mark, {.low = -0.5, .high = 1.5});
    ASSERT_TRUE(doubled.status) << doubled.status.message;
    EXPECT_EQ(doubled.ends[0].ending, OrbitEnding::branching);
    EXPECT_EQ(doubled.ends[1].ending, OrbitEnding::branching) << doubled.ends[1].reason;
    EXPECT_NEAR(doubled.ends[1].constant, 1 - mark.at.constant, 1e-7);
    EXPECT_TRUE(doubled.marks.empty());
    for (std::size_t k = 0; k + 1 < doubled.points.size(); ++k) {
      const OrbitPoint& point = doubled.points[k];
      const double g = point.constant * (1 - point.constant);
      EXPECT_NEAR(point.period, 4 * pi, 1e-7);
      EXPECT_NEAR(point.x[2] * point.x[2] + point.x[3] * point.x[3], g, 1e-7);
      EXPECT_NEAR(point.multipliers[0].real(), std::exp(-8 * pi * g), 1e-5);
    }
  }
}

// Beside the unit circle u' = (p - u^2) u: at p = 0 two more circles branch off, u = +- sqrt(p).
TEST(OrbitContinuation, TheOtherBranchAtACrossingIsFollowed) {
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    const double grow = 1 - x[0] * x[0] - x[1] * x[1];
    out[0] = grow * x[0] - x[1] + 0.1 * x[2] * x[0];
    out[1] = grow * x[1] + x[0] + 0.1 * x[2] * x[1];
    out[2] = (p[0] - x[2] * x[2]) * x[2];
  };
  const auto system = parametric_system(3, f, {-0.5});
  const auto start = find_periodic_orbit(system, {0.9, 0, 0.1}, {.settle = 60, .duration = 60});
  ASSERT_TRUE(start.outcome) << describe(start.outcome);
  const auto branch = continue_orbit(system, start, {.low = -0.5, .high = 1});
  ASSERT_EQ(branch.marks.size(), 1u);
  EXPECT_EQ(branch.marks[0].kind, OrbitBifurcation::crossing);
  EXPECT_NEAR(branch.marks[0].at.constant, 0, 1e-8);
  const auto other = continue_orbit(system, branch.marks[0], {.low = -0.5, .high = 1});
  ASSERT_TRUE(other.status) << other.status.message;
  EXPECT_EQ(other.ends[1].ending, OrbitEnding::bound) << other.ends[1].reason;
  EXPECT_EQ(other.points.back().constant, 1);
  for (const OrbitPoint& point : other.points) {
    EXPECT_NEAR(point.x[2] * point.x[2], point.constant, 1e-7);
    EXPECT_NEAR(std::hypot(point.x[0], point.x[1]), std::sqrt(1 + 0.1 * point.x[2]), 1e-7);
    EXPECT_NEAR(point.period, 2 * pi, 1e-7);
  }
}

// x'' = -x - c x': only at c = 0 are there orbits, of any size.
TEST(OrbitContinuation, AFamilyIsSaidToBeOne) {
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = x[1];
    out[1] = -std::sin(x[0]) - p[0] * x[1];
  };
  const auto system = parametric_system(2, f, {0.0});
  const auto hopf = find_hopf_point(system, {.value = 0.1, .low = -1, .high = 1, .x = {0, 0}});
  ASSERT_TRUE(hopf);
  const auto branch = continue_orbit(system, *hopf, {.low = -1, .high = 1});
  EXPECT_EQ(branch.ends[1].ending, OrbitEnding::family) << branch.ends[1].reason;
}

TEST(OrbitContinuation, WhatCannotBeFollowedIsSaid) {
  const auto system = rotating(1, [](double square, double mu) { return mu - square; }, [](double) { return 1.0; });
  const auto start = find_periodic_orbit(system, {0.3, 0}, {.settle = 20, .duration = 20});
  const auto says = [&](const OrbitContinuationOptions& options) {
    const auto branch = continue_orbit(system, start, options);
    EXPECT_TRUE(branch.points.empty());
    return branch.status.message;
  };
  EXPECT_NE(says({.low = 2, .high = 3}).find("outside of 2..3"), std::string::npos);
  EXPECT_NE(says({.constant = 1}).find("no constant number 1"), std::string::npos);
  EXPECT_NE(says({.low = 1, .high = 1}).find("empty"), std::string::npos);
  const auto none = find_periodic_orbit(system, {0, 0}, {.settle = 1, .duration = 1});
  EXPECT_FALSE(bool(continue_orbit(system, none, {}).status));
}

TEST(OrbitContinuation, WhatIsInterruptedKeepsWhatItHas) {
  const auto system = rotating(1, [](double square, double mu) { return mu - square; }, [](double) { return 1.0; });
  const auto start = find_periodic_orbit(system, {0.3, 0}, {.settle = 20, .duration = 20});
  std::atomic<bool> interrupt = false;
  double part = 0;
  const auto stop = [&](double now) {
    EXPECT_GE(now, part);
    part = now;
    interrupt = now > 0.2;
  };
  const auto branch = continue_orbit(system, start, {.low = 0.2, .high = 3, .interrupt = &interrupt, .progress = stop});
  EXPECT_EQ(branch.ends[0].ending, OrbitEnding::interrupted);
  EXPECT_GE(branch.points.size(), 2u);
  EXPECT_LE(part, 0.3);
}

}  // namespace
}  // namespace continuo::studies::orbit_continuation_test
