// Homoclinic orbits of saddle-nodes: of a driven pendulum with friction, phi'' = I - sin phi - alpha phi', wrapped
// round a circle, in random other coordinates, in both directions of time. Its equilibrium is a saddle-node at I = 1.
// For large alpha a rotation approaches it along the centre manifold; below some alpha the homoclinic orbit is that of
// a saddle, at smaller I (M. Levi, F. C. Hoppensteadt, W. L. Miranker, "Dynamics of the Josephson junction", Quart.
// Appl. Math. 36 (1978) 167-198). The referee solves dy/dphi = (I - sin phi) / y - alpha, y = phi', from both ends of
// the orbit to the middle.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "coordinate_change.hpp"
#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>

namespace continuo::studies::central_homoclinic_test {
namespace {

constexpr double pi = std::numbers::pi, round = 2 * pi;
constexpr double radius = 3, usual_friction = 1.2;  // where the constants m are zero, beside I = 1

/// The difference in velocity, half-way round, between the motion that leaves the equilibrium and the one that returns
/// to it.
double mismatch(double drive, double friction) {
  const double k = std::sqrt(std::max(0.0, 1 - drive * drive)), at = std::numbers::pi - std::asin(drive);
  const auto integrated = [&](double s, double y) {  // to s = pi, by the classical method
    const auto slope = [&](double where, double speed) { return (drive - std::sin(at + where)) / speed - friction; };
    constexpr int steps = 20000;
    const double h = (pi - s) / steps;
    for (int n = 0; n < steps; ++n, s += h) {
      if (!(y > 0)) return 0.0;  // the motion stopped earlier
      const double k1 = slope(s, y), k2 = slope(s + h / 2, y + h / 2 * k1), k3 = slope(s + h / 2, y + h / 2 * k2),
                   k4 = slope(s + h, y + h * k3);
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return y;
  };
  // y = a s + b s^2 + c s^3 + d s^4 near the rest: s is k s + I s^2 / 2 - k s^3 / 6 - I s^4 / 24 in I - sin.
  const auto series = [&](double a, double s) {
    const double b = drive / 2 / (3 * a + friction), c = (-k / 6 - 2 * b * b) / (4 * a + friction),
                 d = (-drive / 24 - 5 * b * c) / (5 * a + friction);
    return s * (a + s * (b + s * (c + s * d)));
  };
  const double root = std::sqrt(friction * friction / 4 + k);
  return integrated(0.02, series(-friction / 2 + root, 0.02)) -
         integrated(round - 0.02, series(-friction / 2 - root, -0.02));
}

/// The alpha at which the orbit of the saddle-node is not central.
double least_friction() {
  double low = 1, high = 1.5;
  const double at_low = mismatch(1, low);
  while (high - low > 1e-8) {
    const double middle = (low + high) / 2;
    (mismatch(1, middle) * at_low > 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// phi and phi' wrapped round a circle, r = 3 + phi', and z that grows or decays at a rate of its own.
template <class Y, class T>
Y flow_of(const Y& v, const T& drive, const T& friction, double rate, double direction) {
  using std::sqrt;
  const auto &x = v[0], &y = v[1], &z = v[2];
  const auto r = sqrt(x * x + y * y);
  const auto cosine = x / r, sine = y / r, speed = r - radius;
  const auto faster = drive - sine - friction * speed;
  return Y{direction * (faster * cosine - speed * y), direction * (faster * sine + speed * x), rate * z};
}

/// The rotation at a drive slightly above 1, on a mesh of equal angles.
OrbitMark mark_of(const CoordinateChange<3>& change, double drive, double friction, bool backward,
                  double first_constant) {
  constexpr std::size_t intervals = 80, degree = detail::OrbitCollocation::degree;
  using Pair = std::array<double, 2>;
  const auto moved = [&](Pair v, double time, int steps) {
    const auto slope = [&](const Pair& at) { return Pair{at[1], drive - std::sin(at[0]) - friction * at[1]}; };
    const auto sum = [](const Pair& a, double h, const Pair& b) { return Pair{a[0] + h * b[0], a[1] + h * b[1]}; };
    const double h = time / steps;
    for (int n = 0; n < steps; ++n) {
      const Pair k1 = slope(v), k2 = slope(sum(v, h / 2, k1)), k3 = slope(sum(v, h / 2, k2)), k4 = slope(sum(v, h, k3));
      for (std::size_t i = 0; i < 2; ++i) v[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    return v;
  };
  const auto turn_of = [&](Pair v, std::vector<double>& times) {  // when it passes each of equal angles
    double t = 0;
    const double begin = v[0];
    for (std::size_t k = 1; k <= intervals; ++k) {
      const double goal = begin + round * static_cast<double>(k) / intervals;
      while (v[0] < goal) {
        const double h = std::min(0.01, std::max((goal - v[0]) / v[1] / 1.01, 1e-9));
        v = moved(v, h, 1);
        t += h;
      }
      times.push_back(t);
    }
    v[0] -= round;
    return v;
  };
  std::vector<double> times{0};
  Pair v{pi / 2, 0.01};
  for (int k = 0; k < 3; ++k) times = {0}, v = turn_of(v, times);
  OrbitMark mark{.kind = OrbitBifurcation::homoclinic, .at = {}};
  const double period = times.back();
  std::vector<std::array<double, 3>> nodes;
  for (std::size_t k = 0; k < intervals; ++k) {
    const double width = times[k + 1] - times[k];
    for (std::size_t j = 0; j < degree; ++j) {
      const double from = detail::OrbitCollocation::table().nodes[j];
      nodes.push_back({(radius + v[1]) * std::cos(v[0]), (radius + v[1]) * std::sin(v[0]), 0});
      v = moved(v, (detail::OrbitCollocation::table().nodes[j + 1] - from) * width, 50);
    }
  }
  if (backward) std::ranges::reverse(nodes), std::rotate(nodes.begin(), nodes.end() - 1, nodes.end());
  for (const double t : times) mark.mesh.push_back(backward ? 1 - t / period : t / period);
  std::ranges::sort(mark.mesh);
  for (const auto& node : nodes) {
    const auto place = change.place(node);
    mark.unknowns.insert(mark.unknowns.end(), place.begin(), place.end());
  }
  mark.at.period = period;
  mark.at.constant = first_constant;
  mark.unknowns.push_back(period);
  mark.unknowns.push_back(first_constant);
  return mark;
}

struct Member {
  unsigned seed;
  bool backward, other_goes_away;
};
class CentralHomoclinic : public testing::TestWithParam<Member> {};

// From the rotation of long period at alpha = 1.45: down along I = 1, to the end at the least alpha for that, then the
// orbits of the saddle, which lie at smaller I.
TEST_P(CentralHomoclinic, IsLeftForTheSaddlesWhereTheRefereeSaysSo) {
  const auto& [seed, backward, other_goes_away] = GetParam();
  const double end = least_friction();
  const CoordinateChange<3> change(seed);
  auto system = change.system([&](const auto& y, const auto& m) {
    return flow_of(y, 1.0 + m[0], usual_friction + m[1], GetParam().other_goes_away ? 3 : -3,
                   GetParam().backward ? -1 : 1);
  });
  const std::array<double, 2> at_start{1e-4, 0.25}, centre = change.outside({0, 0});
  const auto constants = change.outside(at_start);
  system.constants = {constants[0], constants[1]};
  const double size = 0.9;
  const auto curves = follow_orbit_bifurcations(
      system, mark_of(change, 1 + at_start[0], usual_friction + at_start[1], backward, constants[0]),
      {.low = {centre[0] - size, centre[1] - size}, .high = {centre[0] + size, centre[1] + size}}, 4);
  ASSERT_EQ(curves.size(), 2u) << curves[0].status.message;
  EXPECT_EQ(curves[0].kind, OrbitBifurcation::central_homoclinic);
  EXPECT_EQ(curves[1].kind, OrbitBifurcation::homoclinic);
  for (const OrbitCurvePoint& point : curves[0].points) {
    EXPECT_NEAR(change.constants(point.constants)[0], 0, 1e-8);
    EXPECT_GT(usual_friction + change.constants(point.constants)[1], end - 1e-6);
    EXPECT_LT(point.truncation, 1e-4);
  }
  ASSERT_EQ(curves[0].marks.size(), 1u) << curves[0].ends[0].reason << curves[0].ends[1].reason;
  EXPECT_EQ(curves[0].marks[0].kind, OrbitDegeneracy::non_central);
  EXPECT_LT(curves[0].marks[0].at.truncation, 1e-7);
  EXPECT_NEAR(usual_friction + change.constants(curves[0].marks[0].at.constants)[1], end, 1e-6);
  ASSERT_GT(curves[1].points.size(), 8u) << curves[1].ends[1].reason;
  for (std::size_t k = 0; k < curves[1].points.size(); k += 8) {
    const auto m = change.constants(curves[1].points[k].constants);
    // The slopes of the mismatch by I and alpha are of the size of 1.
    EXPECT_NEAR(mismatch(std::min(1.0, 1 + m[0]), usual_friction + m[1]), 0, 1e-5) << k;
    EXPECT_LE(m[0], 1e-9);
  }
}
INSTANTIATE_TEST_SUITE_P(BothTimes, CentralHomoclinic,
                         testing::Values(Member{1, false, false}, Member{2, false, true}, Member{3, true, false},
                                         Member{2, true, true}));

}  // namespace
}  // namespace continuo::studies::central_homoclinic_test
