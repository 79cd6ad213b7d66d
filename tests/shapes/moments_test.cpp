// Volume, centre and inertia of rounded hulls: closed forms, integrals over random points, and how they change with the
// frame.
#include <array>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "random_shapes.hpp"
#include <continuo/shapes/closest_points.hpp>
#include <continuo/shapes/moments.hpp>

namespace continuo::shapes_test {
namespace {

constexpr double pi = std::numbers::pi;

template <int Dim>
void expect_near(const Moments<Dim>& a, const Moments<Dim>& b, double tolerance) {
  EXPECT_NEAR(a.volume, b.volume, tolerance);
  for (std::size_t i = 0; i < Dim; ++i) {
    EXPECT_NEAR(a.first[i], b.first[i], tolerance);
    for (std::size_t j = 0; j < Dim; ++j) EXPECT_NEAR(a.second[i][j], b.second[i][j], tolerance) << i << ' ' << j;
  }
}

// The body moved by `pose`: int y = V c + R m, int y y^T = V c c^T + c (R m)^T + (R m) c^T + R S R^T.
template <int Dim>
Moments<Dim> placed(const Moments<Dim>& at, const Pose<double, Dim>& pose) {
  const Vector<double, Dim> c = pose.centre, m = pose.axes * at.first;
  return {at.volume, c * at.volume + m,
          outer(c, c) * at.volume + outer(c, m) + outer(m, c) + pose.axes * at.second * transposed(pose.axes)};
}
template <int Dim>
void move_with_the_frame() {
  std::mt19937 engine(3);
  for (int k = 0; k < 60; ++k) {
    Polytope<double, Dim> core = random_core<Dim>(engine);
    const double rounding = core.faces.empty() || k % 3 > 0 ? 0.3 : 0;
    const Moments<Dim> here = moments_of(core, rounding);
    const Pose<double, Dim> pose{random_point<Dim>(engine), random_rotation<Dim>(engine)};
    for (auto& corner : core.corners) corner = pose.place(corner);
    for (auto& face : core.faces) face.normal = pose.axes * face.normal, face.offset += dot(face.normal, pose.centre);
    expect_near(moments_of(core, rounding), placed(here, pose), 1e-12);
  }
}
TEST(Moments, MoveWithTheFrame) {
  move_with_the_frame<2>(), move_with_the_frame<3>();
}

// Over n points at random in a box of volume B, the integral of g differs by B s(g) / sqrt(n) in the mean, where s(g),
// the deviation of g within the box, is below 3 here: five times that is exceeded once in a million.
template <int Dim>
void are_integrals(double rounding) {
  std::mt19937 engine(4);
  const int points = 20000;
  const double half = 1.5, box_volume = std::pow(2 * half, Dim);
  for (int k = 0; k < 4; ++k) {
    const Polytope<double, Dim> core = k == 0 ? Polytope<double, Dim>{.corners = {{}, random_point<Dim>(engine)}}
                                              : random_hull<Dim>(engine, Dim + 1 + static_cast<std::size_t>(k));
    Moments<Dim> sum;
    for (int i = 0; i < points; ++i) {
      const Pose<double, Dim> point{random_point<Dim>(engine) * half};
      if (closest_points(core, Polytope<double, Dim>{.corners = {{}}}, point).distance > rounding) continue;
      sum.volume += 1, sum.first += point.centre, sum.second += outer(point.centre, point.centre);
    }
    sum.volume *= box_volume / points, sum.first *= box_volume / points, sum.second *= box_volume / points;
    expect_near(moments_of(core, rounding), sum, 5 * 0.5 * box_volume / std::sqrt(points));
  }
}
TEST(Moments, AreIntegralsOverTheBody) {
  are_integrals<2>(0.3), are_integrals<3>(0.3);
}

TEST(Moments, OfBallCapsuleAndRoundedBoxAreKnown) {
  const double r = 0.3, a = 2, b = 4, c = 1;
  const Moments<3> ball = moments_of(Polytope<double, 3>{.corners = {{}}}, r);
  EXPECT_NEAR(ball.volume, 4 * pi / 3 * r * r * r, 1e-15);
  EXPECT_NEAR(ball.second[1][1], ball.volume * r * r / 5, 1e-16);
  const Moments<2> disc = moments_of(Polytope<double, 2>{.corners = {{}}}, r);
  EXPECT_NEAR(disc.second[0][0] + disc.second[1][1], disc.volume * r * r / 2, 1e-15);

  const double rod = pi * r * r * a;
  const Moments<3> capsule = moments_of(Polytope<double, 3>{.corners = {{{0, 0, -a / 2}}, {{0, 0, a / 2}}}}, r);
  EXPECT_NEAR(capsule.volume, rod + ball.volume, 1e-15);
  EXPECT_NEAR(capsule.second[0][0], rod * r * r / 4 + ball.volume * r * r / 5, 1e-15);
  // Two half balls, whose centres of mass lie 3/8 r beyond the ends.
  EXPECT_NEAR(capsule.second[2][2], rod * a * a / 12 + ball.volume * (r * r / 5 + a * a / 4 + 2 * a / 2 * 3 * r / 8),
              1e-14);

  // Steiner's formula.
  const Moments<3> crate = moments_of(*box<3>({{a, b, c}}), r);
  EXPECT_NEAR(crate.volume, a * b * c + 2 * (a * b + b * c + c * a) * r + (a + b + c) * pi * r * r + ball.volume,
              1e-13);
  const Moments<2> plate = moments_of(*box<2>({{a, b}}), r);
  EXPECT_NEAR(plate.volume, a * b + 2 * (a + b) * r + pi * r * r, 1e-14);
}

TEST(Convex, HasItsOriginAtItsCentreOfMass) {
  std::mt19937 engine(5);
  for (int k = 0; k < 20; ++k) {
    const Convex<double, 3> body = random_body<3>(engine);
    const Moments<3> moments = moments_of(body.core, body.rounding);
    EXPECT_LT(length(moments.first), 1e-12);
    EXPECT_NEAR(moments.volume, body.volume, 1e-12);
    EXPECT_NEAR((moments.second[1][1] + moments.second[2][2]) / body.volume, body.inertia[0][0], 1e-12);
    EXPECT_NEAR(-moments.second[0][1] / body.volume, body.inertia[0][1], 1e-12);
    for (const auto& corner : body.core.corners) EXPECT_LE(length(corner) + body.rounding, body.reach * (1 + 1e-14));
  }
  EXPECT_NEAR((convex_body<double>(*box<2>({{3, 4}}), 0)->inertia[0][0]), 25.0 / 12, 1e-14);
}

TEST(Convex, RefusesWhatHasNoVolume) {
  const auto message = [](const Polytope<double, 2>& core, double rounding) {
    return convex_body<float>(core, rounding).status().message;
  };
  EXPECT_THAT(message(*box<2>({{1, 1}}), -1), testing::HasSubstr("must be 0 or greater"));
  EXPECT_THAT(message({.corners = {{}, {{1, 0}}}}, 0), testing::HasSubstr("needs a radius"));
  EXPECT_THAT(message(*box<2>({{1e-200, 1e-200}}), 0), testing::HasSubstr("no volume"));
}

}  // namespace
}  // namespace continuo::shapes_test
