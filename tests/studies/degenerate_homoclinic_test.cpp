// Degenerate homoclinic orbits in three constants: of Sandstede's system, in which they lie on surfaces known in closed
// form, in random other coordinates of the states and of the constants. B. Sandstede, "Constructing dynamical systems
// having homoclinic bifurcation points of codimension two", J. Dyn. Diff. Eq. 9 (1997) 269-288.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "coordinate_change.hpp"
#include <continuo/studies/degenerate_homoclinic.hpp>
#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>

namespace continuo::studies::degenerate_homoclinic_test {
namespace {

using Triple = std::array<double, 3>;

/// In numbers of any type, for the derivatives. Where mu = nu = 0 there is the orbit y^2 = x^2 (1 - x), z = 0 of the
/// origin, whose eigenvalues are a + b, a - b and c.
struct Flow {
  double a, b, c, alpha, beta, mu, nu;
  template <class Y>
  Y operator()(const Y& v) const {
    const auto &x = v[0], &y = v[1], &z = v[2];
    const auto turned = nu - alpha * z;
    return Y{a * x + b * y - a * x * x + turned * x * (2.0 - 3.0 * x),
             b * x + a * y - 1.5 * b * x * x - 1.5 * a * x * y - turned * 2.0 * y,
             c * z + mu * x + alpha * beta * (x * x * (1.0 - x) - y * y)};
  }
};

/// Constants are those of the plane's change, mixed with the third one, which is its own.
struct Space {
  explicit Space(unsigned seed) : change(seed) {}
  CoordinateChange<3> change;
  Triple inside(const Triple& p) const {
    const auto m = change.constants({p[0], p[1]});
    return {m[0] + 0.2 * p[2], m[1] - 0.3 * p[2], p[2]};
  }
  Triple outside(const Triple& m) const {
    const auto p = change.outside({m[0] - 0.2 * m[2], m[1] + 0.3 * m[2]});
    return {p[0], p[1], m[2]};
  }
  /// `flow(m)`: a Flow.
  template <class F>
  ParametricSystem system(F flow) const {
    auto result = parametric_system(3, [*this, flow](double, Values x, Values p, std::span<double> out) {
      const auto y = change.back(Triple{x[0], x[1], x[2]});
      const auto f = change.forth(y, flow(inside({p[0], p[1], p[2]}))(y));
      std::ranges::copy(f, out.begin());
    });
    result.jacobian = [*this, flow](double, Values x, Values p, std::span<double> rows) {
      using Complex = std::complex<double>;
      for (std::size_t j = 0; j < 3; ++j) {
        std::array<Complex, 3> moved{x[0], x[1], x[2]};
        moved[j] += Complex(0, 1e-40);
        const auto y = change.back(moved);
        const auto f = change.forth(y, flow(inside({p[0], p[1], p[2]}))(y));
        for (std::size_t i = 0; i < 3; ++i) rows[i * 3 + j] = f[i].imag() / 1e-40;
      }
    };
    return result;
  }
};

/// One turn of the orbit, which is nearly at rest at its ends. With y = x sigma, x = 1 - sigma^2: sigma' = -(1 -
/// sigma^2) (a sigma + b) / 2.
OrbitMark start_of(const Space& space, const Flow& flow, double first_constant, double duration) {
  constexpr std::size_t intervals = 60, degree = detail::OrbitCollocation::degree;
  OrbitMark mark{.kind = OrbitBifurcation::homoclinic, .at = {}};
  for (std::size_t k = 0; k <= intervals; ++k) mark.mesh.push_back(static_cast<double>(k) / intervals);
  const auto slope = [&](double sigma) { return -(1 - sigma * sigma) * (flow.a * sigma + flow.b) / 2; };
  const double middle = duration * (flow.b - flow.a) / (2 * flow.b);
  for (std::size_t k = 0; k < intervals * degree; ++k) {
    const double t =
        (static_cast<double>(k / degree) + detail::OrbitCollocation::table().nodes[k % degree]) / intervals * duration;
    double sigma = 0;
    constexpr int steps = 400;
    for (int part = 0; part < steps; ++part) {  // by the classical method
      const double h = (t - middle) / steps, k1 = slope(sigma), k2 = slope(sigma + h / 2 * k1),
                   k3 = slope(sigma + h / 2 * k2), k4 = slope(sigma + h * k3);
      sigma += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    const double x = 1 - sigma * sigma;
    const auto place = space.change.place(Triple{x, x * sigma, 0});
    mark.unknowns.insert(mark.unknowns.end(), place.begin(), place.end());
  }
  mark.at.period = duration;
  mark.at.constant = first_constant;
  mark.unknowns.push_back(duration);
  mark.unknowns.push_back(first_constant);
  return mark;
}

/// The marks on the curve in the first two constants through m, continued in three constants. `longer` scales the first
/// steps of all curves.
template <class F>
std::vector<DegenerateHomoclinicCurve> curves_from(const Space& space, F flow, const Triple& m, double size,
                                                   const std::array<double, 2>& third, double longer = 1) {
  auto system = space.system(flow);
  const Triple p = space.outside(m);
  system.constants = {p[0], p[1], p[2]};
  const OrbitCurveOptions plane{.low = {p[0] - size, p[1] - size},
                                .high = {p[0] + size, p[1] + size},
                                .first_step = 0.01 * longer,
                                .largest_step = 0.05 * longer};
  const auto curve = follow_orbit_bifurcation(system, start_of(space, flow(m), p[0], 22), plane);
  EXPECT_GT(curve.points.size(), 4u) << curve.status.message;
  const DegenerateHomoclinicOptions options{.low = {plane.low[0], plane.low[1], third[0]},
                                            .high = {plane.high[0], plane.high[1], third[1]},
                                            .first_step = 0.05 * longer,
                                            .largest_step = 0.4};
  return degenerate_homoclinic_curves(system, {{curve, {0}}}, options);
}
const DegenerateHomoclinicCurve* curve_of(const std::vector<DegenerateHomoclinicCurve>& curves, OrbitDegeneracy kind) {
  const auto found = std::ranges::find(curves, kind, &DegenerateHomoclinicCurve::kind);
  return found == curves.end() ? nullptr : &*found;
}

// The eigenvalues are a + b, a - b and -2: the saddle is neutral where a = 0, a saddle-node where a = b or a = -b.
TEST(DegenerateHomoclinic, NeutralSaddlesAndSaddleNodes) {
  const Space space(2);
  const auto flow = [](const Triple& m) {
    return Flow{.a = 0.6 + m[0], .b = 1 + 0.5 * m[2], .c = -2, .alpha = 0.5, .beta = 1, .mu = 0, .nu = m[1]};
  };
  const auto curves = curves_from(space, flow, {-0.3, 0, 0}, 1.5, {-0.1, 0.1}, 3);
  ASSERT_EQ(curves.size(), 3u);
  std::size_t neutral = 0, nodes = 0;
  for (const auto& curve : curves) {
    ASSERT_GT(curve.points.size(), 4u) << curve.status.message;
    (curve.kind == OrbitDegeneracy::neutral_saddle ? neutral : nodes) += 1;
    for (const auto& point : curve.points) {
      const auto m = space.inside(point.constants);
      const double a = 0.6 + m[0], b = 1 + 0.5 * m[2];
      EXPECT_NEAR(m[1], 0, 1e-6);
      EXPECT_NEAR(std::abs(a), curve.kind == OrbitDegeneracy::saddle_node ? b : 0, 1e-6);
    }
    for (const OrbitCurveEnd& end : curve.ends) EXPECT_EQ(end.ending, OrbitCurveEnding::bound) << end.reason;
  }
  EXPECT_EQ(neutral, 1u);
  EXPECT_EQ(nodes, 2u);
}

// AUTO's demo san: for a = 0.25, b = 1, c = -2 an inclination flip of the stable manifold is at alpha = 1.23086; with
// all rates k times as large, at k times that.
TEST(DegenerateHomoclinic, InclinationFlips) {
  const Space space(1);
  const auto flow = [](const Triple& m) {
    const double k = 1 + 0.5 * m[2];
    return Flow{.a = 0.25 * k, .b = k, .c = -2 * k, .alpha = 1.1 + m[0], .beta = 1, .mu = 0, .nu = m[1]};
  };
  const auto curves = curves_from(space, flow, {-0.1, 0, 0}, 0.8, {-0.3, 0.3});
  ASSERT_EQ(curves.size(), 2u);  // and at another one, with no published value
  std::size_t printed = 0;
  for (const auto& curve : curves) {
    EXPECT_EQ(curve.kind, OrbitDegeneracy::inclination_flip_stable);
    ASSERT_GT(curve.points.size(), 4u) << curve.status.message;
    const auto part = [&](const DegenerateHomoclinicPoint& point) {
      const auto m = space.inside(point.constants);
      EXPECT_NEAR(m[1], 0, 1e-6);
      return (1.1 + m[0]) / (1 + 0.5 * m[2]);
    };
    const double first = part(curve.points.front());
    for (const auto& point : curve.points) EXPECT_NEAR(part(point), first, 1e-7);
    if (std::abs(first - 1.23086) < 2e-5) ++printed;
    EXPECT_TRUE(curve.marks.empty());
    for (const OrbitCurveEnd& end : curve.ends) EXPECT_EQ(end.ending, OrbitCurveEnding::bound) << end.reason;
  }
  EXPECT_EQ(printed, 1u);
}

// c = -2 is nearer to zero than a - b: an orbit in the plane z = 0, which exists at mu = 0, does not return along the
// leading direction.
TEST(DegenerateHomoclinic, OrbitFlips) {
  const Space space(1);
  const auto flow = [](const Triple& m) {
    return Flow{.a = 0.5 + 0.3 * m[2], .b = 3, .c = -2, .alpha = 1, .beta = 0, .mu = m[0], .nu = m[1]};
  };
  const auto curves = curves_from(space, flow, {0.02, 0.005, 0}, 0.3, {-0.4, 0.4});
  const auto* flips = curve_of(curves, OrbitDegeneracy::orbit_flip_stable);
  ASSERT_TRUE(flips);
  ASSERT_GT(flips->points.size(), 4u) << flips->status.message;
  for (const auto& point : flips->points) {
    const auto m = space.inside(point.constants);
    EXPECT_NEAR(m[0], 0, 1e-5);
    EXPECT_NEAR(m[1], 0, 1e-5);
  }
  for (const OrbitCurveEnd& end : flips->ends) EXPECT_EQ(end.ending, OrbitCurveEnding::bound) << end.reason;
}

TEST(DegenerateHomoclinic, OnlyWhatIsMarkedOnCurvesOfHomoclinicOrbits) {
  const auto system = parametric_system(1, [](double, Values x, Values, std::span<double> out) { out[0] = x[0]; });
  EXPECT_NE(follow_degenerate_homoclinic(system, {.kind = OrbitDegeneracy::cusp, .at = {}}, {}).status.message, "");
}

}  // namespace
}  // namespace continuo::studies::degenerate_homoclinic_test
