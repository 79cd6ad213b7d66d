// Curves of folds, period doublings and tori of orbits in two constants: circular orbits with neighbours as in the
// normal forms, in random other coordinates.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "coordinate_change.hpp"
#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>

namespace continuo::studies::orbit_curve_test {
namespace {

constexpr unsigned members = 2;  // of each kind; a hundred have been run
constexpr double pi = std::numbers::pi, turn_rate = 3;

// A circle of radius 1 in the plane of y0, y1, with a constant angular velocity; u = (radius - 1, y2) is the deviation
// of a motion from it, with u' = flow(u, cosine, sine of the angle).
template <class Flow>
auto round_a_circle(Flow flow) {
  return [flow](const auto& y, const auto& m) {
    using Y = std::remove_cvref_t<decltype(y)>;
    using std::sqrt;
    const auto r = sqrt(y[0] * y[0] + y[1] * y[1]);
    const auto cosine = y[0] / r, sine = y[1] / r;
    using T = std::remove_cvref_t<decltype(r)>;
    const std::array<T, 2> u{r - 1.0, y[2]};
    const auto du = flow(u, m, cosine, sine);
    return Y{du[0] * cosine - turn_rate * y[1], du[0] * sine + turn_rate * y[0], du[1]};
  };
}

/// The circle of this radius and height as a mark of a branch, from which a curve begins.
OrbitMark mark_of(const CoordinateChange<3>& change, OrbitBifurcation kind, const std::array<double, 2>& constants,
                  double radius, double height, double rotation = 0) {
  OrbitMark mark{.kind = kind, .at = {}, .rotation = rotation};
  constexpr std::size_t intervals = 10, degree = detail::OrbitCollocation::degree;
  for (std::size_t k = 0; k <= intervals; ++k) mark.mesh.push_back(static_cast<double>(k) / intervals);
  for (std::size_t k = 0; k < intervals * degree; ++k) {
    const double s =
        (static_cast<double>(k / degree) + detail::OrbitCollocation::table().nodes[k % degree]) / intervals;
    const auto x =
        change.place(std::array<double, 3>{radius * std::cos(2 * pi * s), radius * std::sin(2 * pi * s), height});
    mark.unknowns.insert(mark.unknowns.end(), x.begin(), x.end());
  }
  mark.at.period = 2 * pi / turn_rate;
  mark.at.constant = constants[0];
  mark.unknowns.push_back(mark.at.period);
  mark.unknowns.push_back(constants[0]);
  return mark;
}
OrbitCurve curve_from(const CoordinateChange<3>& change, ParametricSystem system, const OrbitMark& mark,
                      const std::array<double, 2>& constants, double size) {
  system.constants = {constants[0], constants[1]};
  const auto centre = change.outside({0, 0});
  return follow_orbit_bifurcation(
      system, mark,
      {.low = {centre[0] - size / 2, centre[1] - size / 2}, .high = {centre[0] + size / 2, centre[1] + size / 2}});
}
std::vector<OrbitDegeneracy> kinds_of(const OrbitCurve& curve) {
  std::vector<OrbitDegeneracy> kinds;
  for (const DegenerateOrbit& mark : curve.marks) kinds.push_back(mark.kind);
  return kinds;
}

void expect_at_origin(const std::array<double, 2>& m, unsigned seed) {
  EXPECT_NEAR(m[0], 0, 1e-5) << seed;
  EXPECT_NEAR(m[1], 0, 1e-5) << seed;
}

// u0' = m0 + m1 u0 + c u0^3: folds of circles at m1 = -3 c u0^2, m0 = 2 c u0^3.
TEST(OrbitCurve, FoldsOfOrbitsMeetInACusp) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const double c = seed % 2 ? -0.8 : 0.7, u = 0.2;
    const auto system = change.system(round_a_circle([c](const auto& v, const auto& m, const auto&, const auto&) {
      return std::remove_cvref_t<decltype(v)>{m[0] + m[1] * v[0] + c * v[0] * v[0] * v[0], -1.1 * v[1]};
    }));
    const auto constants = change.outside({2 * c * u * u * u, -3 * c * u * u});
    const auto curve =
        curve_from(change, system, mark_of(change, OrbitBifurcation::fold, constants, 1 + u, 0), constants, 0.3);
    ASSERT_GT(curve.points.size(), 4u) << seed << curve.status.message;
    for (const OrbitCurvePoint& point : curve.points) {
      const auto m = change.constants(point.constants);
      EXPECT_NEAR(4 * std::pow(m[1], 3), -27 * c * m[0] * m[0], 1e-7) << seed;
      EXPECT_NEAR(point.period, 2 * pi / turn_rate, 1e-7) << seed;
    }
    EXPECT_EQ(kinds_of(curve), std::vector{OrbitDegeneracy::cusp}) << seed;
    for (const OrbitCurveEnd& end : curve.ends) EXPECT_EQ(end.ending, OrbitCurveEnding::bound) << end.reason;
    for (const DegenerateOrbit& mark : curve.marks) expect_at_origin(change.constants(mark.at.constants), seed);
  }
}

// u0' = u1, u1' = m0 + m1 u0 + a u0^2 + b u0 u1: folds at 4 a m0 = m1^2; tori at m0 = 0, u = 0, m1 < 0, where a pair
// turns by 2 pi sqrt(-m1) / rate a period; both end or touch at a 1:1 resonance at the origin.
TEST(OrbitCurve, FoldsAndToriTouchAtAOneToOneResonance) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const double a = seed % 2 ? -0.8 : 0.9, b = 0.7;
    const auto system = change.system(round_a_circle([=](const auto& v, const auto& m, const auto&, const auto&) {
      return std::remove_cvref_t<decltype(v)>{v[1], m[0] + m[1] * v[0] + a * v[0] * v[0] + b * v[0] * v[1]};
    }));
    const double m1 = 0.1;
    const auto at_fold = change.outside({m1 * m1 / (4 * a), m1});
    const auto folds =
        curve_from(change, system, mark_of(change, OrbitBifurcation::fold, at_fold, 1 - m1 / (2 * a), 0), at_fold, 0.4);
    ASSERT_GT(folds.points.size(), 4u) << seed << folds.status.message;
    for (const OrbitCurvePoint& point : folds.points) {
      const auto m = change.constants(point.constants);
      EXPECT_NEAR(4 * a * m[0], m[1] * m[1], 1e-7) << seed;
    }
    EXPECT_EQ(kinds_of(folds), std::vector{OrbitDegeneracy::resonance_1}) << seed;
    for (const DegenerateOrbit& mark : folds.marks) expect_at_origin(change.constants(mark.at.constants), seed);
    const auto at_torus = change.outside({0, -m1});
    const auto tori =
        curve_from(change, system, mark_of(change, OrbitBifurcation::torus, at_torus, 1, 0, std::sqrt(m1) / turn_rate),
                   at_torus, 0.4);
    ASSERT_GT(tori.points.size(), 4u) << seed << tori.status.message;
    for (const OrbitCurvePoint& point : tori.points) {
      const auto m = change.constants(point.constants);
      EXPECT_NEAR(m[0], 0, 1e-7) << seed;
      EXPECT_NEAR(std::pow(turn_rate * point.rotation, 2), -m[1], 1e-6) << seed;
    }
    EXPECT_EQ(kinds_of(tori), std::vector{OrbitDegeneracy::resonance_1}) << seed;
    for (const DegenerateOrbit& mark : tori.marks) expect_at_origin(change.constants(mark.at.constants), seed);
    EXPECT_EQ(std::ranges::count(tori.ends, OrbitCurveEnding::resonance, &OrbitCurveEnd::ending), 1) << seed;
  }
}

// The same with axes that make half a turn a period: w' = (0 1; m0 m1) w - |w|^2 w along axes turned by half the angle.
// The multipliers are minus those of the matrix: doublings at m0 = 0, a 1:2 resonance at the origin, tori at m1 = 0, m0
// < 0 with a pair at pi - 2 pi sqrt(-m0) / rate, on the way a quarter and a third of a turn.
auto half_turns() {
  return round_a_circle([](const auto& v, const auto& m, const auto& cosine, const auto& sine) {
    const double half = m[1] / 2, spin = turn_rate / 2 + (m[0] - 1) / 2, stretch = -m[1] / 2, shear = (1 + m[0]) / 2;
    const auto square = v[0] * v[0] + v[1] * v[1];
    const auto along = stretch * cosine - shear * sine, across = stretch * sine + shear * cosine;
    return std::remove_cvref_t<decltype(v)>{(half - square + along) * v[0] + (across - spin) * v[1],
                                            (across + spin) * v[0] + (half - square - along) * v[1]};
  });
}

TEST(OrbitCurve, DoublingsAndToriMeetAtAOneToTwoResonance) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const auto system = change.system(half_turns());
    const auto at_doubling = change.outside({0, 0.11});
    const auto doublings = curve_from(
        change, system, mark_of(change, OrbitBifurcation::period_doubling, at_doubling, 1, 0), at_doubling, 0.5);
    ASSERT_GT(doublings.points.size(), 4u) << seed << doublings.status.message;
    for (const OrbitCurvePoint& point : doublings.points)
      EXPECT_NEAR(change.constants(point.constants)[0], 0, 1e-8) << seed;
    EXPECT_EQ(kinds_of(doublings), std::vector{OrbitDegeneracy::resonance_2}) << seed;
    for (const DegenerateOrbit& mark : doublings.marks) expect_at_origin(change.constants(mark.at.constants), seed);
    for (const OrbitCurveEnd& end : doublings.ends) EXPECT_EQ(end.ending, OrbitCurveEnding::bound) << end.reason;

    const double m0 = -0.4, rotation = 0.5 - std::sqrt(-m0) / turn_rate;
    const auto at_torus = change.outside({m0, 0});
    const auto tori =
        curve_from(change, system, mark_of(change, OrbitBifurcation::torus, at_torus, 1, 0, rotation), at_torus, 2);
    ASSERT_GT(tori.points.size(), 4u) << seed << tori.status.message;
    for (const OrbitCurvePoint& point : tori.points) {
      const auto m = change.constants(point.constants);
      EXPECT_NEAR(m[1], 0, 1e-7) << seed;
      EXPECT_NEAR(std::pow(turn_rate * (0.5 - point.rotation), 2), -m[0], 1e-6) << seed;
    }
    for (const DegenerateOrbit& mark : tori.marks) {
      const double part = mark.kind == OrbitDegeneracy::resonance_2   ? 0.5
                          : mark.kind == OrbitDegeneracy::resonance_3 ? 1.0 / 3
                          : mark.kind == OrbitDegeneracy::resonance_4 ? 0.25
                                                                      : -1;
      EXPECT_NEAR(mark.at.rotation, part, 1e-6) << seed << to_string(mark.kind);
      if (part == 0.5) expect_at_origin(change.constants(mark.at.constants), seed);
    }
    // Within reach of the ranges are the 1:2 and the 1:3 resonance, (rate / 6)^2 = 0.25, and 1:4 at (rate / 4)^2 =
    // 0.5625.
    EXPECT_TRUE(std::ranges::count(kinds_of(tori), OrbitDegeneracy::resonance_2) == 1) << seed;
    EXPECT_TRUE(std::ranges::count(kinds_of(tori), OrbitDegeneracy::resonance_3) == 1) << seed;
    EXPECT_EQ(std::ranges::count(tori.ends, OrbitCurveEnding::resonance, &OrbitCurveEnd::ending), 1) << seed;
  }
}

// r' = r (m0 + m1 r^2 - r^4): a fold of circles at m0 = -m1^2 / 4, m1 > 0, with r^2 = m1 / 2. It ends at the origin, a
// generalised Hopf point.
TEST(OrbitCurve, FoldsOfOrbitsEndAtAGeneralisedHopfPoint) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const auto system = change.system([](const auto& y, const auto& m) {
      const auto square = y[0] * y[0] + y[1] * y[1];
      const auto grow = m[0] + m[1] * square - square * square;
      return std::remove_cvref_t<decltype(y)>{grow * y[0] - turn_rate * y[1], grow * y[1] + turn_rate * y[0],
                                              -1.3 * y[2]};
    });
    const double m1 = 0.3;
    const auto constants = change.outside({-m1 * m1 / 4, m1});
    const auto curve = curve_from(
        change, system, mark_of(change, OrbitBifurcation::fold, constants, std::sqrt(m1 / 2), 0), constants, 1);
    ASSERT_GT(curve.points.size(), 4u) << seed << curve.status.message;
    for (const OrbitCurvePoint& point : curve.points) {
      const auto m = change.constants(point.constants);
      EXPECT_NEAR(m[0], -m[1] * m[1] / 4, 1e-7) << seed;
      EXPECT_GT(m[1], -1e-5) << seed;
    }
    EXPECT_TRUE(curve.marks.empty()) << seed;
    EXPECT_EQ(std::ranges::count(curve.ends, OrbitCurveEnding::equilibrium, &OrbitCurveEnd::ending), 1)
        << seed << curve.ends[0].reason << curve.ends[1].reason;
  }
}

}  // namespace
}  // namespace continuo::studies::orbit_curve_test
