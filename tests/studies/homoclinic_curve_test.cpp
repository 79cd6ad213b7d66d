// Curves of homoclinic orbits: of a system in which one is known in closed form, with flips of both kinds, in random
// other coordinates. B. Sandstede, "Constructing dynamical systems having homoclinic bifurcation points of codimension
// two", J. Dyn. Diff. Eq. 9 (1997) 269-288.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "coordinate_change.hpp"
#include <continuo/studies/orbit_collocation.hpp>
#include <continuo/studies/orbit_curve.hpp>

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

/// The orbit at rest nearly, once round. With y = x sigma, x = 1 - sigma^2: sigma' = -(1 - sigma^2) (a sigma + b) / 2.
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

// Along a the eigenvalues are a + 1, a - 1 and -2: the saddle is neutral at 0, and none any more at 1.
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
    ASSERT_GT(curve.points.size(), 4u) << seed << curve.message;
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

// AUTO's demo san: for a = 0.25 the stable manifold comes back turned at alpha = 1.23086.
TEST(HomoclinicCurve, InclinationFlip) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const double shift = 1.1;
    const Sandstede s{.a = 0.25};
    const auto system = change.system(
        [&](const auto& y, const auto& m) { return flow_of(s, y, 0 * m[0] + s.a, shift + m[0], 0 * m[0], m[1]); });
    const auto curve = curve_from(change, system, s, {1 - shift, 0}, 0.8);
    ASSERT_GT(curve.points.size(), 4u) << seed << curve.message;
    for (const OrbitCurvePoint& point : curve.points)
      EXPECT_NEAR(change.constants(point.constants)[1], 0, 1e-7) << seed;
    ASSERT_EQ(kinds_of(curve), std::vector{OrbitDegeneracy::inclination_flip_stable}) << seed;
    EXPECT_NEAR(shift + change.constants(curve.marks[0].at.constants)[0], 1.23086, 2e-5) << seed;
    for (const OrbitCurveEnd& end : curve.ends) EXPECT_EQ(end.ending, OrbitCurveEnding::bound) << end.reason;
  }
}

// c = -2 is nearer to zero than a - b = -2.5: an orbit in the plane z = 0, as there is at mu = 0, does not come along
// the leading direction.
TEST(HomoclinicCurve, OrbitFlip) {
  for (unsigned seed = 1; seed <= members; ++seed) {
    const CoordinateChange<3> change(seed);
    const Sandstede s{.a = 0.5, .b = 3, .alpha = 1, .beta = 0};
    const auto system = change.system(
        [&](const auto& y, const auto& m) { return flow_of(s, y, 0 * m[0] + s.a, 0 * m[0] + s.alpha, m[0], m[1]); });
    const auto curve = curve_from(change, system, s, {0.02, 0.005}, 0.4);
    ASSERT_GT(curve.points.size(), 4u) << seed << curve.message;
    ASSERT_EQ(kinds_of(curve), std::vector{OrbitDegeneracy::orbit_flip_stable}) << seed;
    const auto m = change.constants(curve.marks[0].at.constants);
    EXPECT_NEAR(m[0], 0, 1e-5) << seed;
    EXPECT_NEAR(m[1], 0, 1e-5) << seed;
  }
}

}  // namespace
}  // namespace continuo::studies::homoclinic_curve_test
