// Curves of folds and Hopf points in two constants: normal forms whose curves are known, in random other coordinates.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "coordinate_change.hpp"
#include <continuo/studies/bifurcation_curve.hpp>
#include <continuo/studies/equilibrium.hpp>

namespace continuo::studies::bifurcation_curve_test {
namespace {

constexpr unsigned members = 6;  // of each kind; a hundred and more have been run
constexpr double pi = std::numbers::pi;

template <std::size_t N>
std::vector<double> at(const CoordinateChange<N>& change, const std::array<double, N>& y) {
  const auto x = change.place(y);
  return {x.begin(), x.end()};
}
template <std::size_t N>
std::array<double, N> state(const CoordinateChange<N>& change, const CurvePoint& point) {
  std::array<double, N> x{};
  std::copy(point.x.begin(), point.x.end(), x.begin());
  return change.back(x);
}
/// All within half of this of the origin of the normal form.
template <std::size_t N>
CurveOptions box(const CoordinateChange<N>& change, double size) {
  const auto centre = change.outside({0, 0});
  return {.low = {centre[0] - size / 2, centre[1] - size / 2}, .high = {centre[0] + size / 2, centre[1] + size / 2}};
}
void expect_at_origin(const std::array<double, 2>& m, double slack, unsigned seed) {
  EXPECT_NEAR(m[0], 0, slack) << seed;
  EXPECT_NEAR(m[1], 0, slack) << seed;
}

// y0' = m0 + m1 y0 + c y0^3: the folds are at m1 = -3 c y0^2, m0 = 2 c y0^3. In units of the eigenvector y0 |A e0| the
// cubic coefficient is c / |A e0|^2.
TEST(BifurcationCurve, TwoFoldsThatMeetInACuspAreOneCurve) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const double c = seed % 2 ? -0.7 - 0.05 * (seed % 17) : 0.9;
    const auto system = change.system([c](const auto& y, const auto& m) {
      return std::remove_cvref_t<decltype(y)>{m[0] + m[1] * y[0] + c * y[0] * y[0] * y[0], y[0] * y[0] - 1.3 * y[1],
                                              -2.0 * y[2] + y[0] * y[1]};
    });
    std::vector<CurveStart> starts;
    for (const double y : {0.3, -0.3})
      starts.push_back({Bifurcation::fold, change.outside({2 * c * y * y * y, -3 * c * y * y}),
                        at<3>(change, {y, y * y / 1.3, y * y * y / 2.6}), 0});
    const auto diagram = bifurcation_curves(system, starts, box(change, 1));
    ASSERT_EQ(diagram.size(), 1u) << seed;
    EXPECT_EQ(diagram[0].starts.size(), 2u) << seed;
    const BifurcationCurve& curve = diagram[0].curve;
    for (const CurvePoint& point : curve.points) {
      const auto m = change.constants(point.constants);
      const double y = state<3>(change, point)[0];
      EXPECT_NEAR(m[1], -3 * c * y * y, 1e-9) << seed;
      EXPECT_NEAR(m[0], 2 * c * y * y * y, 1e-9) << seed;
    }
    for (const CurveEnd& end : curve.ends) EXPECT_EQ(end.ending, CurveEnding::bound) << end.reason;
    ASSERT_EQ(curve.marks.size(), 1u) << seed;
    EXPECT_EQ(curve.marks[0].kind, Degeneracy::cusp);
    expect_at_origin(change.constants(curve.marks[0].at.constants), 1e-9, seed);
    ASSERT_EQ(curve.marks[0].numbers.size(), 1u);
    EXPECT_NEAR(curve.marks[0].numbers[0].value, c / std::pow(change.length(0), 2), 1e-5) << seed;
  }
}

// y0' = y1, y1' = m0 + m1 y0 + a y0^2 + b y0 y1: folds at m0 = m1^2 / 4a, Hopf points at m0 = 0, y0 = 0 for m1 < 0 with
// omega^2 = -m1; for m1 > 0 a neutral saddle is there. In units of the eigenvector, a and b are divided by |A e0|. l1
// has the sign of a b (Kuznetsov, 8.4).
TEST(BifurcationCurve, HopfPointsEndAtABogdanovTakensPoint) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const double a = seed % 3 ? 1.1 : -0.8, b = seed % 2 ? 0.9 : -1.2;
    const auto system = change.system([=](const auto& y, const auto& m) {
      return std::remove_cvref_t<decltype(y)>{y[1], m[0] + m[1] * y[0] + a * y[0] * y[0] + b * y[0] * y[1],
                                              -2.0 * y[2] + y[0] * y[1]};
    });
    const double m1 = 0.2;
    const CurveStart fold{Bifurcation::fold, change.outside({m1 * m1 / (4 * a), m1}),
                          at<3>(change, {-m1 / (2 * a), 0, 0}), 0};
    const CurveStart hopf{Bifurcation::hopf, change.outside({0, -m1}), at<3>(change, {0, 0, 0}),
                          std::sqrt(m1) / (2 * pi)};
    // From either of them the other is found.
    for (const CurveStart& start : {fold, hopf}) {
      const auto diagram = bifurcation_curves(system, {start}, box(change, 1));
      ASSERT_EQ(diagram.size(), 2u) << seed;
      EXPECT_EQ(diagram[1].from, 0u);
      for (const CurveOfDiagram& of : diagram) {
        for (const CurvePoint& point : of.curve.points) {
          const auto m = change.constants(point.constants);
          if (of.curve.kind == Bifurcation::fold) {
            EXPECT_NEAR(m[0], m[1] * m[1] / (4 * a), 1e-9) << seed;
            continue;
          }
          EXPECT_NEAR(m[0], 0, 1e-9) << seed;
          EXPECT_LT(m[1], 1e-9) << seed;
          EXPECT_NEAR(std::pow(2 * pi * point.frequency, 2), -m[1], 1e-8) << seed;
          if (m[1] < -1e-3) {
            ASSERT_TRUE(point.coefficient) << seed << m[1];
            EXPECT_GT(*point.coefficient * a * b, 0) << seed;
          }
        }
        ASSERT_EQ(of.curve.marks.size(), 1u) << seed << to_string(of.curve.kind);
        const DegeneratePoint& mark = of.curve.marks[0];
        EXPECT_EQ(mark.kind, Degeneracy::bogdanov_takens);
        expect_at_origin(change.constants(mark.at.constants), 1e-8, seed);
        ASSERT_EQ(mark.numbers.size(), 2u);
        const double sign = mark.numbers[0].value * a > 0 ? 1 : -1;  // the eigenvector may point either way
        EXPECT_NEAR(mark.numbers[0].value, sign * a / change.length(0), 1e-5) << seed;
        EXPECT_NEAR(mark.numbers[1].value, sign * b / change.length(0), 1e-5) << seed;
        if (of.curve.kind == Bifurcation::hopf) {
          EXPECT_EQ(std::ranges::count(of.curve.ends, CurveEnding::bogdanov_takens, &CurveEnd::ending), 1) << seed;
        }
      }
    }
  }
}

// z' = (m0 + i w) z + m1 z |z|^2 - z |z|^4: Hopf points at m0 = 0, l1 = 2 m1 / (w |A q|^2) is zero at m1 = 0.
TEST(BifurcationCurve, TheFirstLyapunovCoefficientVanishesAtAGeneralisedHopfPoint) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const double w = 0.7 + 0.1 * (seed % 20);
    const auto system = change.system([w](const auto& y, const auto& m) {
      const auto square = y[0] * y[0] + y[1] * y[1];
      const auto grow = m[0] + m[1] * square - square * square, turn = w + 0.3 * square;
      return std::remove_cvref_t<decltype(y)>{grow * y[0] - turn * y[1], grow * y[1] + turn * y[0],
                                              -1.2 * y[2] + y[0] * y[1]};
    });
    const CurveStart start{Bifurcation::hopf, change.outside({0, 0.2}), at<3>(change, {0, 0, 0}), w / (2 * pi)};
    const auto curve = follow_bifurcation(system, start, box(change, 1));
    const double unit = (std::pow(change.length(0), 2) + std::pow(change.length(1), 2)) / 2;
    for (const CurvePoint& point : curve.points) {
      const auto m = change.constants(point.constants);
      EXPECT_NEAR(m[0], 0, 1e-9) << seed;
      ASSERT_TRUE(point.coefficient);
      EXPECT_NEAR(*point.coefficient, 2 * m[1] / (w * unit), 1e-5) << seed;
    }
    ASSERT_EQ(curve.marks.size(), 1u) << seed;
    EXPECT_EQ(curve.marks[0].kind, Degeneracy::generalized_hopf);
    // Differences leave 1e-6 of the coefficient.
    expect_at_origin(change.constants(curve.marks[0].at.constants), 1e-5, seed);
  }
}

// z' = (m0 + i w) z - z |z|^2, y' = m1 - y^2: Hopf points at m0 = 0, y^2 = m1, folds at m1 = 0; both at the origin. l1
// has the sign of -1 on both sides, since z does not depend on y.
TEST(BifurcationCurve, FoldsAndHopfPointsTouchAtAZeroHopfPoint) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const double w = 0.7 + 0.1 * (seed % 20);
    const auto system = change.system([w](const auto& y, const auto& m) {
      const auto grow = m[0] - y[0] * y[0] - y[1] * y[1];
      return std::remove_cvref_t<decltype(y)>{grow * y[0] - w * y[1], grow * y[1] + w * y[0], m[1] - y[2] * y[2]};
    });
    const CurveStart start{Bifurcation::hopf, change.outside({0, 0.09}), at<3>(change, {0, 0, 0.3}), w / (2 * pi)};
    const auto diagram = bifurcation_curves(system, {start}, box(change, 1));
    ASSERT_EQ(diagram.size(), 2u) << seed;
    for (const CurveOfDiagram& of : diagram) {
      const bool hopf = of.curve.kind == Bifurcation::hopf;
      for (const CurvePoint& point : of.curve.points) {
        const auto m = change.constants(point.constants);
        const double y = state<3>(change, point)[2];
        EXPECT_NEAR(m[1], y * y, 1e-9) << seed;
        EXPECT_NEAR(hopf ? m[0] : y, 0, 1e-7) << seed;
        EXPECT_NEAR(point.frequency, hopf ? w / (2 * pi) : 0, 1e-9);
      }
      ASSERT_EQ(of.curve.marks.size(), 1u) << seed;
      EXPECT_EQ(of.curve.marks[0].kind, Degeneracy::zero_hopf);
      expect_at_origin(change.constants(of.curve.marks[0].at.constants), 1e-7, seed);
      EXPECT_NEAR(of.curve.marks[0].other_frequency, hopf ? 0 : w / (2 * pi), 1e-7);
    }
  }
}

// z1' = (m0 + i w1) z1 - z1 |z1|^2, z2' = (m1 + i w2) z2 - z2 (|z2|^2 + |z1|^2): Hopf points at m0 = 0 and at m1 = 0.
TEST(BifurcationCurve, TwoCurvesOfHopfPointsCrossAtADoubleHopfPoint) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<4> change(seed);
    const double w1 = 1, w2 = 1.9;
    const auto system = change.system([=](const auto& y, const auto& m) {
      const auto s1 = y[0] * y[0] + y[1] * y[1], s2 = y[2] * y[2] + y[3] * y[3];
      const auto g1 = m[0] - s1, g2 = m[1] - s2 - s1;
      return std::remove_cvref_t<decltype(y)>{g1 * y[0] - w1 * y[1], g1 * y[1] + w1 * y[0], g2 * y[2] - w2 * y[3],
                                              g2 * y[3] + w2 * y[2]};
    });
    const CurveStart start{Bifurcation::hopf, change.outside({0, 0.2}), at<4>(change, {0, 0, 0, 0}), w1 / (2 * pi)};
    const auto diagram = bifurcation_curves(system, {start}, box(change, 1));
    ASSERT_EQ(diagram.size(), 2u) << seed;
    for (std::size_t k = 0; k < 2; ++k) {
      const BifurcationCurve& curve = diagram[k].curve;
      for (const CurvePoint& point : curve.points) {
        EXPECT_NEAR(change.constants(point.constants)[k], 0, 1e-9) << seed;
        EXPECT_NEAR(2 * pi * point.frequency, k == 0 ? w1 : w2, 1e-9) << seed;
      }
      ASSERT_EQ(curve.marks.size(), 1u) << seed;
      EXPECT_EQ(curve.marks[0].kind, Degeneracy::double_hopf);
      EXPECT_NEAR(2 * pi * curve.marks[0].other_frequency, k == 0 ? w2 : w1, 1e-6);
      expect_at_origin(change.constants(curve.marks[0].at.constants), 1e-7, seed);
      for (const CurveEnd& end : curve.ends) EXPECT_EQ(end.ending, CurveEnding::bound) << end.reason;
    }
  }
}

// y0' = m0^2 + m1^2 - r^2 + y0^2: folds on the circle of radius r, and nowhere else.
TEST(BifurcationCurve, AClosedCurveEndsWhereItBegan) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<2> change(seed);
    const double r = 0.05 + 0.05 * (seed % 7);
    const auto system = change.system([r](const auto& y, const auto& m) {
      return std::remove_cvref_t<decltype(y)>{m[0] * m[0] + m[1] * m[1] - r * r + y[0] * y[0], -y[1]};
    });
    const auto curve = follow_bifurcation(system, {Bifurcation::fold, change.outside({r, 0}), at<2>(change, {0, 0}), 0},
                                          box(change, 3));
    ASSERT_FALSE(curve.points.empty()) << curve.status.message;
    EXPECT_EQ(curve.ends[0].ending, CurveEnding::closed) << curve.ends[0].reason;
    EXPECT_TRUE(curve.marks.empty()) << seed;
    double turned = 0;
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
      const auto m = change.constants(curve.points[k].constants);
      EXPECT_NEAR(std::hypot(m[0], m[1]), r, 1e-9) << seed;
      if (k == 0) continue;
      const auto before = change.constants(curve.points[k - 1].constants);
      turned += std::asin((before[0] * m[1] - before[1] * m[0]) / (r * r));
    }
    EXPECT_NEAR(std::abs(turned), 2 * pi, 1e-6) << seed;
  }
}

TEST(BifurcationCurve, ANeutralSaddleIsNoHopfPoint) {  // eigenvalues 1 and -1 where p = 0
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = (1 + p[0]) * x[0] + p[1] * x[1] * x[1];
    out[1] = -x[1];
  };
  const auto curve = follow_bifurcation(parametric_system(2, f, {0, 0}), {Bifurcation::hopf, {0, 0}, {0, 0}, 0.2},
                                        {.low = {-1, -1}, .high = {1, 1}});
  EXPECT_TRUE(curve.points.empty());
  EXPECT_FALSE(curve.status.message.empty());
}

// The Brusselator: x' = a - (b + 1) x + x^2 y, y' = b x - x^2 y rests at (a, b / a), with Hopf points at b = 1 + a^2,
// omega = a, and l1 below zero everywhere.
TEST(BifurcationCurve, TheBrusselatorOscillatesFromAParabolaOn) {
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    const double made = x[0] * x[0] * x[1];
    out[0] = p[0] - (p[1] + 1) * x[0] + made;
    out[1] = p[1] * x[0] - made;
  };
  const auto curve =
      follow_bifurcation(parametric_system(2, f, {1, 2}), {Bifurcation::hopf, {1, 2}, {1, 2}, 1 / (2 * pi)},
                         {.low = {0.2, 0}, .high = {3, 10}});
  for (const CurvePoint& point : curve.points) {
    const auto [a, b] = point.constants;
    EXPECT_NEAR(b, 1 + a * a, 1e-7);
    EXPECT_NEAR(2 * pi * point.frequency, a, 1e-7);
    ASSERT_TRUE(point.coefficient);
    EXPECT_LT(*point.coefficient, 0);
  }
  EXPECT_TRUE(curve.marks.empty());
  for (const CurveEnd& end : curve.ends) EXPECT_EQ(end.ending, CurveEnding::bound);
  EXPECT_NEAR(std::min(curve.points.front().constants[0], curve.points.back().constants[0]), 0.2, 1e-9);
}

// x' = x1, 0 = ... : with an algebraic equation, x0' = m0 + m1 x0 - u, 0 = u - x0^3.
TEST(BifurcationCurve, AlgebraicEquationsAreTakenAlong) {
  auto system = parametric_system(2,
                                  [](double, Values x, Values p, std::span<double> out) {
                                    out[0] = p[0] + p[1] * x[0] - x[1];
                                    out[1] = x[1] - x[0] * x[0] * x[0];
                                  },
                                  {0, 0});
  system.algebraic = 1;
  const double y = 0.3;
  const auto curve = follow_bifurcation(system, {Bifurcation::fold, {-2 * y * y * y, 3 * y * y}, {y, y * y * y}, 0},
                                        {.low = {-1, -1}, .high = {1, 1}});
  ASSERT_EQ(curve.marks.size(), 1u) << curve.status.message;
  EXPECT_EQ(curve.marks[0].kind, Degeneracy::cusp);
  EXPECT_NEAR(curve.marks[0].at.constants[0], 0, 1e-8);
  for (const CurvePoint& point : curve.points)
    EXPECT_NEAR(4 * std::pow(point.constants[1], 3), 27 * std::pow(point.constants[0], 2), 1e-8);
}

}  // namespace
}  // namespace continuo::studies::bifurcation_curve_test
