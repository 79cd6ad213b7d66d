// Curves of homoclinic orbits: of a system with one known in closed form, with flips of both kinds, in random other
// coordinates. B. Sandstede, "Constructing dynamical systems having homoclinic bifurcation points of codimension two",
// J. Dyn. Diff. Eq. 9 (1997) 269-288.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "coordinate_change.hpp"
#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>

namespace continuo::studies::homoclinic_curve_test {
namespace {

constexpr unsigned members = 2;  // of each kind

/// Where mu = nu = 0 there is the homoclinic orbit y^2 = x^2 (1 - x), z = 0 of the origin, whose eigenvalues are a + b,
/// a - b and c.
struct Sandstede {
  double a = 0, b = 1, c = -2, alpha = 0, beta = 1, gamma = 0;
};
template <class Y, class T>
Y flow_of(const Sandstede& s, const Y& v, const T& a, const T& alpha, const T& mu, const T& nu) {
  const auto &x = v[0], &y = v[1], &z = v[2];
  const auto turned = nu - alpha * z;
  return Y{a * x + s.b * y - a * x * x + turned * x * (2.0 - 3.0 * x),
           s.b * x + a * y - 1.5 * s.b * x * x - 1.5 * a * x * y - turned * 2.0 * y,
           s.c * z + mu * x + s.gamma * x * z + alpha * s.beta * (x * x * (1.0 - x) - y * y)};
}

/// One turn of the orbit, which is nearly at rest at its ends. With y = x sigma, x = 1 - sigma^2: sigma' = -(1 -
/// sigma^2) (a sigma + b) / 2.
OrbitMark mark_of(const CoordinateChange<3>& change, const Sandstede& s, double first_constant, double duration) {
  constexpr std::size_t intervals = 60, degree = detail::OrbitCollocation::degree, steps = 20;
  OrbitMark mark{.kind = OrbitBifurcation::homoclinic, .at = {}};
  for (std::size_t k = 0; k <= intervals; ++k) mark.mesh.push_back(static_cast<double>(k) / intervals);
  const auto slope = [&](double sigma) { return -(1 - sigma * sigma) * (s.a * sigma + s.b) / 2; };
  const auto after = [&](double sigma, double time) {  // by the classical method
    const double h = time / steps;
    for (std::size_t k = 0; k < steps; ++k) {
      const double k1 = slope(sigma), k2 = slope(sigma + h / 2 * k1), k3 = slope(sigma + h / 2 * k2),
                   k4 = slope(sigma + h * k3);
      sigma += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return sigma;
  };
  // From the middle, sigma = 0, to both ends; it leaves at the rate a + b and comes back at b - a.
  const double middle = duration * (s.b - s.a) / (2 * s.b);
  for (std::size_t k = 0; k < intervals * degree; ++k) {
    const double t =
        (static_cast<double>(k / degree) + detail::OrbitCollocation::table().nodes[k % degree]) / intervals * duration;
    double sigma = 0;
    for (int part = 0; part < 20; ++part) sigma = after(sigma, (t - middle) / 20);
    const double x = 1 - sigma * sigma;
    const auto place = change.place(std::array<double, 3>{x, x * sigma, 0});
    mark.unknowns.insert(mark.unknowns.end(), place.begin(), place.end());
  }
  mark.at.period = duration;
  mark.at.constant = first_constant;
  mark.unknowns.push_back(duration);
  mark.unknowns.push_back(first_constant);
  return mark;
}

OrbitCurve curve_from(const CoordinateChange<3>& change, ParametricSystem system, const Sandstede& s,
                      const std::array<double, 2>& m, double size) {
  const auto constants = change.outside(m), centre = change.outside({0, 0});
  system.constants = {constants[0], constants[1]};
  return follow_orbit_bifurcation(
      system, mark_of(change, s, constants[0], 22),
      {.low = {centre[0] - size / 2, centre[1] - size / 2}, .high = {centre[0] + size / 2, centre[1] + size / 2}});
}
std::vector<OrbitDegeneracy> kinds_of(const OrbitCurve& curve) {
  std::vector<OrbitDegeneracy> kinds;
  for (const DegenerateOrbit& mark : curve.marks) kinds.push_back(mark.kind);
  return kinds;
}

// The eigenvalues are a + 1, a - 1 and -2: the saddle is neutral at a = 0, and no longer a saddle at a = 1.
TEST(HomoclinicCurve, NeutralSaddleAndItsEnd) {
  for (unsigned seed = 1; seed < members; ++seed) {  // towards the end the orbit comes ever more slowly
    const CoordinateChange<3> change(seed);
    const double shift = 0.4;
    const Sandstede s{.alpha = 0.5};
    const auto system = change.system(
        [&](const auto& y, const auto& m) { return flow_of(s, y, shift + m[0], 0 * m[0] + s.alpha, 0 * m[0], m[1]); });
    auto at_start = s;
    at_start.a = 0.2;
    const auto curve = curve_from(change, system, at_start, {0.2 - shift, 0}, 1.9);
    ASSERT_GT(curve.points.size(), 4u) << seed << curve.status.message;
    for (const OrbitCurvePoint& point : curve.points) {
      EXPECT_NEAR(change.constants(point.constants)[1], 0, 1e-7) << seed;
      EXPECT_LT(point.truncation, 1e-7) << seed;
    }
    std::size_t neutral = 0, ends = 0;
    for (const DegenerateOrbit& mark : curve.marks) {
      const double a = shift + change.constants(mark.at.constants)[0];
      if (mark.kind == OrbitDegeneracy::neutral_saddle) {
        ++neutral;
        EXPECT_NEAR(a, 0, 1e-6) << seed;
      } else if (mark.kind == OrbitDegeneracy::saddle_node) {
        ++ends;
        EXPECT_NEAR(a, 1, 1e-6) << seed;
      }
    }
    EXPECT_EQ(neutral, 1u) << seed;
    EXPECT_EQ(ends, 1u) << seed << curve.ends[0].reason << curve.ends[1].reason;
    EXPECT_EQ(std::ranges::count(curve.ends, OrbitCurveEnding::no_saddle, &OrbitCurveEnd::ending), 1) << seed;
  }
}

// AUTO's demo san: for a = 0.25 an inclination flip of the stable manifold is at alpha = 1.23086.
TEST(HomoclinicCurve, InclinationFlip) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const double shift = 1.1;
    const Sandstede s{.a = 0.25};
    const auto system = change.system(
        [&](const auto& y, const auto& m) { return flow_of(s, y, 0 * m[0] + s.a, shift + m[0], 0 * m[0], m[1]); });
    const auto curve = curve_from(change, system, s, {1 - shift, 0}, 0.8);
    ASSERT_GT(curve.points.size(), 4u) << seed << curve.status.message;
    for (const OrbitCurvePoint& point : curve.points)
      EXPECT_NEAR(change.constants(point.constants)[1], 0, 1e-7) << seed;
    ASSERT_EQ(kinds_of(curve), std::vector{OrbitDegeneracy::inclination_flip_stable}) << seed;
    EXPECT_NEAR(shift + change.constants(curve.marks[0].at.constants)[0], 1.23086, 2e-5) << seed;
    for (const OrbitCurveEnd& end : curve.ends) EXPECT_EQ(end.ending, OrbitCurveEnding::bound) << end.reason;
  }
}

// c = -2 is nearer to zero than a - b = -2.5: an orbit in the plane z = 0, which exists at mu = 0, does not return
// along the leading direction.
TEST(HomoclinicCurve, OrbitFlip) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const Sandstede s{.a = 0.5, .b = 3, .alpha = 1, .beta = 0};
    const auto system = change.system(
        [&](const auto& y, const auto& m) { return flow_of(s, y, 0 * m[0] + s.a, 0 * m[0] + s.alpha, m[0], m[1]); });
    const auto curve = curve_from(change, system, s, {0.02, 0.005}, 0.4);
    ASSERT_GT(curve.points.size(), 4u) << seed << curve.status.message;
    ASSERT_EQ(kinds_of(curve), std::vector{OrbitDegeneracy::orbit_flip_stable}) << seed;
    const auto m = change.constants(curve.marks[0].at.constants);
    EXPECT_NEAR(m[0], 0, 1e-5) << seed;
    EXPECT_NEAR(m[1], 0, 1e-5) << seed;
  }
}

/// The plane of Sandstede's system with alpha = 0, whose orbit is known, drives two more components: the homoclinic
/// orbit exists at nu = 0, and the eigenvalues are a + b, a - b and those of (c 1; q c), c +- root q. `reversed`
/// reverses time, which exchanges stable and unstable.
struct Driven {
  double a = 0, c = 0, q = 0;
  bool reversed = false;
};
template <class Y, class T>
Y flow_of(const Driven& s, const Y& v, const T& c, const T& q, const T& nu) {
  const auto &x = v[0], &y = v[1], &z = v[2], &w = v[3];
  const double sign = s.reversed ? -1 : 1;
  return Y{sign * (s.a * x + y - s.a * x * x + nu * x * (2.0 - 3.0 * x)),
           sign * (x + s.a * y - 1.5 * x * x - 1.5 * s.a * x * y - nu * 2.0 * y), sign * (c * z + w + 0.7 * x),
           sign * (q * z + c * w + 0.4 * x * x)};
}

/// (sigma, z, w) along the orbit, x = 1 - sigma^2 as above; z and w die away forwards, wherever they begin.
std::vector<std::array<double, 3>> driven_orbit(const Driven& s, double duration, std::size_t steps) {
  const auto slope = [&](const std::array<double, 3>& v) {
    const double x = 1 - v[0] * v[0];
    return std::array<double, 3>{-x * (s.a * v[0] + 1) / 2, s.c * v[1] + v[2] + 0.7 * x,
                                 s.q * v[1] + s.c * v[2] + 0.4 * x * x};
  };
  const auto after = [&](const std::array<double, 3>& v, double h) {  // by the classical method
    const auto moved = [&](const std::array<double, 3>& k, double by) {
      return std::array<double, 3>{v[0] + by * k[0], v[1] + by * k[1], v[2] + by * k[2]};
    };
    const auto k1 = slope(v), k2 = slope(moved(k1, h / 2)), k3 = slope(moved(k2, h / 2)), k4 = slope(moved(k3, h));
    auto result = v;
    for (std::size_t i = 0; i < 3; ++i) result[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    return result;
  };
  // From the middle, sigma = 0, back to the beginning; it leaves at the rate 1 + a and comes back at 1 - a.
  const double middle = duration * (1 - s.a) / 2, h = duration / static_cast<double>(steps);
  std::array<double, 3> at{0, 0, 0};
  for (double t = 0; t < middle; t += h) at = {after(at, -h)[0], 0, 0};
  std::vector<std::array<double, 3>> orbit{at};
  while (orbit.size() <= steps) orbit.push_back(after(orbit.back(), h));
  return orbit;
}

OrbitMark mark_of(const CoordinateChange<4>& change, const Driven& s, double first_constant, double duration) {
  constexpr std::size_t intervals = 60, degree = detail::OrbitCollocation::degree, steps = 12000;
  OrbitMark mark{.kind = OrbitBifurcation::homoclinic, .at = {}};
  for (std::size_t k = 0; k <= intervals; ++k) mark.mesh.push_back(static_cast<double>(k) / intervals);
  const auto orbit = driven_orbit(s, duration, steps);
  for (std::size_t k = 0; k < intervals * degree; ++k) {
    const double part =
        (static_cast<double>(k / degree) + detail::OrbitCollocation::table().nodes[k % degree]) / intervals;
    const auto& [sigma, z, w] =
        orbit[static_cast<std::size_t>(std::lround((s.reversed ? 1 - part : part) * static_cast<double>(steps)))];
    const double x = 1 - sigma * sigma;
    const auto place = change.place(std::array<double, 4>{x, x * sigma, z, w});
    mark.unknowns.insert(mark.unknowns.end(), place.begin(), place.end());
  }
  mark.at.period = duration;
  mark.at.constant = first_constant;
  mark.unknowns.push_back(duration);
  mark.unknowns.push_back(first_constant);
  return mark;
}

/// The curve where nu = 0, on which the other constant is c less `shift`, or q.
OrbitCurve driven_curve(const CoordinateChange<4>& change, const Driven& s, bool moves_q, double begin, double size) {
  auto system = change.system([&](const auto& y, const auto& m) {
    return moves_q ? flow_of(s, y, 0 * m[0] + s.c, m[0], m[1]) : flow_of(s, y, s.c + m[0], 0 * m[0] + s.q, m[1]);
  });
  const auto constants = change.outside({begin, 0}), centre = change.outside({0, 0});
  system.constants = {constants[0], constants[1]};
  Driven at = s;
  (moves_q ? at.q : at.c) += begin;
  return follow_orbit_bifurcation(
      system, mark_of(change, at, constants[0], 24),
      {.low = {centre[0] - size / 2, centre[1] - size / 2}, .high = {centre[0] + size / 2, centre[1] + size / 2}});
}

void expect_one_mark(const CoordinateChange<4>& change, const OrbitCurve& curve, OrbitDegeneracy kind) {
  ASSERT_GT(curve.points.size(), 4u) << curve.status.message;
  for (const OrbitCurvePoint& point : curve.points) EXPECT_NEAR(change.constants(point.constants)[1], 0, 1e-7);
  ASSERT_EQ(std::ranges::count(curve.marks, kind, &DegenerateOrbit::kind), 1) << curve.marks.size();
  const auto mark = std::ranges::find(curve.marks, kind, &DegenerateOrbit::kind);
  EXPECT_NEAR(change.constants(mark->at.constants)[0], 0, 1e-6);
}

// The eigenvalues -0.4 +- root q lead on the stable side, before -1, and are one where q = 0.
TEST(HomoclinicCurve, DoubleLeadingEigenvalues) {
  for (unsigned seed = 1; seed <= members; ++seed)
    for (const bool reversed : {false, true}) {
      SCOPED_TRACE(seed);
      const CoordinateChange<4> change(seed);
      const auto curve = driven_curve(change, {.c = -0.4, .q = 0, .reversed = reversed}, true, 0.03, 0.08);
      expect_one_mark(change, curve,
                      reversed ? OrbitDegeneracy::double_leading_unstable : OrbitDegeneracy::double_leading_stable);
    }
}

// Of -0.8 and the pair c +- 0.5 i the real one leads where c < -0.8, and the pair where it is greater.
TEST(HomoclinicCurve, TripleLeadingEigenvalues) {
  for (unsigned seed = 1; seed <= members; ++seed)
    for (const bool reversed : {false, true}) {
      SCOPED_TRACE(seed);
      const CoordinateChange<4> change(seed);
      const auto curve =
          driven_curve(change, {.a = 0.2, .c = -0.8, .q = -0.25, .reversed = reversed}, false, 0.06, 0.3);
      expect_one_mark(change, curve,
                      reversed ? OrbitDegeneracy::triple_leading_unstable : OrbitDegeneracy::triple_leading_stable);
    }
}

/// phi'' = I - sin phi - friction phi', from one saddle over the top to the next: (phi, phi') at equidistant times, on
/// the unstable manifold of the first (`there`) and on the stable one of the second (`back`), and their distance.
struct Turn {
  std::vector<std::array<double, 2>> there{}, back{};
  double apart = 0;
};
Turn turn_of(double friction, double drive, double h) {
  const double saddle = std::numbers::pi - std::asin(drive), top = saddle + std::numbers::pi;
  const double slope = std::cos(std::asin(drive));  // of -sin phi at the saddle
  const auto flow = [&](const std::array<double, 2>& v) {
    return std::array<double, 2>{v[1], drive - std::sin(v[0]) - friction * v[1]};
  };
  const auto after = [&](const std::array<double, 2>& v, double time) {
    const auto moved = [&](const std::array<double, 2>& k, double by) {
      return std::array<double, 2>{v[0] + by * k[0], v[1] + by * k[1]};
    };
    const auto k1 = flow(v), k2 = flow(moved(k1, time / 2)), k3 = flow(moved(k2, time / 2)), k4 = flow(moved(k3, time));
    return std::array<double, 2>{v[0] + time / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0]),
                                 v[1] + time / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])};
  };
  constexpr double near = 1e-6;
  const double root = std::sqrt(friction * friction / 4 + slope);
  const auto side = [&](std::array<double, 2> v, double time, bool forwards) {
    std::vector<std::array<double, 2>> places{v};
    while (forwards == (places.back()[0] < top) && places.back()[1] > 0) places.push_back(after(places.back(), time));
    return places;
  };
  Turn turn{.there = side({saddle + near, near * (root - friction / 2)}, h, true),
            .back = side({saddle + 2 * std::numbers::pi - near, near * (root + friction / 2)}, -h, false)};
  // Both at the top, by the last step, a part of it found by Newton's method.
  const auto at_top = [&](const std::vector<std::array<double, 2>>& places) {
    auto v = places.back();
    for (int k = 0; k < 6; ++k) v = after(v, (top - v[0]) / v[1]);
    return v[1];
  };
  const bool comes_over = turn.there.back()[0] >= top;
  turn.apart = comes_over ? at_top(turn.there) - at_top(turn.back) : -1;
  return turn;
}
double drive_of(double friction) {
  double low = 0, high = std::min(1.9 * friction, 0.99);
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (turn_of(friction, middle, 0.01).apart < 0 ? low : high) = middle;
  }
  return low;
}

// A pendulum with friction under a constant torque I turns over once from its saddle to the next one, which is the same
// point. For little friction that is at I = 4/pi times the friction (V. K. Melnikov), for more friction where the
// manifolds meet.
TEST(HomoclinicCurve, OfARotation) {
  constexpr double begin = 0.2;
  const double drive = drive_of(begin), h = 0.0005;
  EXPECT_NEAR(drive_of(0.01), 0.04 / std::numbers::pi, 1e-5);
  Turn turn = turn_of(begin, drive, h);
  std::vector<std::array<double, 2>> orbit = turn.there;
  orbit.insert(orbit.end(), turn.back.rbegin() + 1, turn.back.rend());
  // Other coordinates, in which every component increases from turn to turn: u = phi + phi'/2, v = phi' - 0.3 phi.
  auto system = parametric_system(2,
                                  [](double, Values x, Values p, std::span<double> out) {
                                    const double phi = (x[0] - x[1] / 2) / 1.15, speed = x[1] + 0.3 * phi;
                                    const double faster = p[1] - std::sin(phi) - p[0] * speed;
                                    out[0] = speed + faster / 2, out[1] = faster - 0.3 * speed;
                                  },
                                  {begin, drive});
  const double round = 2 * std::numbers::pi;
  constexpr std::size_t intervals = 60, degree = detail::OrbitCollocation::degree;
  OrbitMark mark{.kind = OrbitBifurcation::homoclinic, .at = {}};
  for (std::size_t k = 0; k <= intervals; ++k) mark.mesh.push_back(static_cast<double>(k) / intervals);
  for (std::size_t k = 0; k < intervals * degree; ++k) {
    const double part =
        (static_cast<double>(k / degree) + detail::OrbitCollocation::table().nodes[k % degree]) / intervals;
    const auto& [phi, speed] =
        orbit[static_cast<std::size_t>(std::lround(part * static_cast<double>(orbit.size() - 1)))];
    mark.unknowns.push_back(phi + speed / 2), mark.unknowns.push_back(speed - 0.3 * phi);
  }
  mark.at.period = h * static_cast<double>(orbit.size() - 1);
  mark.at.constant = begin;
  mark.at.advance = {round, -0.3 * round};
  mark.unknowns.push_back(mark.at.period), mark.unknowns.push_back(begin);
  const auto curve = follow_orbit_bifurcation(system, mark, {.low = {0.05, 0}, .high = {0.6, 0.9}});
  ASSERT_GT(curve.points.size(), 4u) << curve.status.message;
  double least = 1, most = 0;
  for (const OrbitCurvePoint& point : curve.points) {
    EXPECT_NEAR(point.constants[1], drive_of(point.constants[0]), 1e-6) << point.constants[0];
    least = std::min(least, point.constants[0]), most = std::max(most, point.constants[0]);
  }
  EXPECT_NEAR(least, 0.05, 1e-6);
  EXPECT_NEAR(most, 0.6, 1e-6);
  for (const OrbitCurveEnd& end : curve.ends) EXPECT_EQ(end.ending, OrbitCurveEnding::bound) << end.reason;
}

}  // namespace
}  // namespace continuo::studies::homoclinic_curve_test
