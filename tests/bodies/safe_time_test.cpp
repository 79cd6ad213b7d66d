// Steps towards a meeting of two parts of bodies cannot pass it, and the normal of a separation separates.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_rigid/safe_time.hpp>
#include <continuo/shapes/solid.hpp>
#include <continuo/status/require.hpp>

namespace continuo::safe_time_test {
namespace {

/// A box, a capsule, or the hull of random points, in any orientation, with any velocity and spin.
template <int Dim>
class RandomParts {
 public:
  using V = Vector<double, Dim>;
  explicit RandomParts(unsigned seed) : engine_(seed) {}

  [[nodiscard]] double number(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  template <class Vector>
  [[nodiscard]] Vector vector(double most) {
    Vector made;
    for (double& part : made.components) part = number(-most, most);
    return made;
  }
  [[nodiscard]] Solid<double, Dim> solid() {
    const auto kind = engine_() % 3;
    if (kind == 0) {
      Box<double, Dim> box;
      for (double& side : box.size.components) side = number(0.2, 1.5);
      return require(continuo::solid(Shape<double, Dim>{box}));
    }
    if (kind == 1)
      return require(continuo::solid(Shape<double, Dim>{Capsule<double>{number(0.2, 1), number(0.01, 0.4)}}));
    Hull<double, Dim> hull;
    for (int k = 0; k < 12; ++k) hull.points.push_back(vector<V>(0.7));
    return require(continuo::solid(Shape<double, Dim>{hull}));
  }
  [[nodiscard]] ExactBody<double, Dim> body() {
    ExactBody<double, Dim> made{.x = vector<V>(1), .v = vector<V>(3)};
    made.orientation = turned(made.orientation, vector<Spin<double, Dim>>(3), 1.0);
    made.spin = vector<Spin<double, Dim>>(engine_() % 2 == 0 ? 2 : 20);
    made.axes = rotation(made.orientation);
    return made;
  }

 private:
  std::mt19937 engine_;
};

/// The body after a time, with a constant acceleration and spin.
template <int Dim>
ExactBody<double, Dim> after(ExactBody<double, Dim> body, const Vector<double, Dim>& pull, double t) {
  body.x += body.v * t + pull * (t * t / 2);
  body.v += pull * t;
  body.orientation = turned(body.orientation, body.spin, t);
  body.axes = rotation(body.orientation);
  return body;
}
/// The distance of all corners of b from all of a along a normal, less the roundings.
template <int Dim>
double distance_along(const Vector<double, Dim>& normal, const ExactPart<double, Dim>& a,
                      const ExactBody<double, Dim>& body_a, const ExactPart<double, Dim>& b,
                      const ExactBody<double, Dim>& body_b) {
  double of_a = -1e300, of_b = 1e300;
  for (const auto& corner : a.convex->core.corners)
    of_a = std::max(of_a, dot(normal, a.pose(body_a).place(corner) - body_a.x));
  for (const auto& corner : b.convex->core.corners)
    of_b = std::min(of_b, dot(normal, b.pose(body_b).place(corner) - body_a.x));
  return of_b - of_a - a.rounding() - b.rounding();
}

template <int Dim>
void expect_steps_do_not_pass(unsigned seed) {
  RandomParts<Dim> random(seed);
  int met = 0;
  for (int pair = 0; pair < 400; ++pair) {
    SCOPED_TRACE("pair " + std::to_string(pair) + " in " + std::to_string(Dim));
    const Solid<double, Dim> solid_a = random.solid(), solid_b = random.solid();
    const ExactPart<double, Dim> a{.convex = &solid_a.parts[0].convex}, b{.convex = &solid_b.parts[0].convex};
    ExactBody<double, Dim> body_a = random.body(), body_b = random.body();
    // Towards each other, from a gap of any size: at those near 1e-7 closest points have the worst normals.
    body_b.x = body_a.x;
    auto apart = separation_of(a, body_a, b, body_b);
    for (int round = 0; round < 60 && std::abs(apart.gap) > 1e-13; ++round) {
      body_b.x -= apart.normal * apart.gap;
      apart = separation_of(a, body_a, b, body_b);
    }
    body_b.x += apart.normal * std::pow(10, random.number(-11, 0));
    body_b.v -= apart.normal * random.number(0, 6);
    const auto pull_a = random.template vector<Vector<double, Dim>>(5), pull_b = pull_a * random.number(-1, 1);
    MutualMotion<double, Dim> motion{.steady = pull_b - pull_a};
    motion.most = squared(body_a.spin) * a.convex->reach + squared(body_b.spin) * b.convex->reach;
    double t = 0, gap = 1;
    int round = 0;
    for (; round < 200 && t < 0.5; ++round) {
      const auto now_a = after(body_a, pull_a, t), now_b = after(body_b, pull_b, t);
      apart = separation_of(a, now_a, b, now_b);
      gap = apart.gap;
      ASSERT_NEAR(distance_along(apart.normal, a, now_a, b, now_b), gap, 1e-14) << gap;
      ASSERT_GT(gap, -1e-14);
      if (gap < 1e-14) break;
      const double safe = safe_time(a, now_a, b, now_b, apart.normal, 0.0, motion, 0.5 - t + 1e-3);
      ASSERT_GT(safe, 0);
      for (const double part : {0.2, 0.5, 0.8})
        EXPECT_GT(
            separation_of(a, after(body_a, pull_a, t + part * safe), b, after(body_b, pull_b, t + part * safe)).gap,
            -1e-14);
      if (safe <= 4e-16 * t) break;
      t += safe;
    }
    EXPECT_LT(round, 200) << t << ' ' << gap;
    met += gap < 1e-12 ? 1 : 0;
  }
  EXPECT_GT(met, 100);
}
TEST(SafeTime, StepsDoNotPassAMeeting) {
  expect_steps_do_not_pass<2>(1);
  expect_steps_do_not_pass<3>(2);
}

}  // namespace
}  // namespace continuo::safe_time_test
