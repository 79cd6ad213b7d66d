// First contacts of moving bodies: closed forms, no contact before the first one, and no wall that is passed.
#include <cmath>

#include <gmock/gmock.h>

#include "random_shapes.hpp"
#include <continuo/shapes/cast.hpp>

namespace continuo::shapes_test {
namespace {

template <int Dim>
double distance_at(const MovingBody<double, Dim>& a, const MovingBody<double, Dim>& b, double time) {
  const auto closest = closest_points(a.shape->core, b.shape->core, relative(a.at(time), b.at(time)));
  return closest.distance - a.shape->rounding - b.shape->rounding;
}

// A ball of radius r meets another one where |x + v t| = r_a + r_b.
TEST(FirstContact, OfBallsIsTheRootOfAQuadratic) {
  const auto ball = *convex_body<double>(Polytope<double, 3>{.corners = {{}}}, 0.5);
  const MovingBody<double, 3> still{.shape = &ball},
      moving{&ball, {{-10, 0.6, 0}}, upright<double, 3>(), {{4, 0, 0}}, {}};
  const auto contact = first_contact(moving, still, 10.0, 1e-10);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, (10 - 0.8) / 4, 1e-9);  // then they are 0.8 apart along x, and 1 in all
  EXPECT_NEAR(contact->normal[0], 0.8, 1e-9);
  EXPECT_FALSE(first_contact(moving, still, 2.0, 1e-10));
  EXPECT_FALSE(first_contact({&ball, {{-10, 1.1, 0}}, upright<double, 3>(), {{4, 0, 0}}, {}}, still, 10.0, 1e-10));
}

// A rod that turns about its centre, at 1 over a floor, strikes it where sin(angle) = 1 / 2.
TEST(FirstContact, OfATurningRodIsAtItsAngle) {
  const auto rod = *convex_body<double>(Polytope<double, 2>{.corners = {{{-2, 0}}, {{2, 0}}}}, 1e-3);
  const auto floor = *convex_body<double>(*box<2>({{100, 1}}), 0);
  const auto contact = first_contact<double, 2>({&rod, {{0, 1.001}}, {{0}}, {{0, 0}}, {{-0.7}}},
                                                {.shape = &floor, .position = {{0, -0.5}}}, 10.0, 1e-9);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, std::asin(0.5) / 0.7, 1e-8);
}

template <int Dim>
void is_no_later_than_any_contact() {
  std::mt19937 engine(7);
  int met = 0, passed = 0;
  for (int k = 0; k < 200; ++k) {
    SCOPED_TRACE(k);
    const auto shape_a = random_body<Dim>(engine), shape_b = random_body<Dim>(engine);
    const auto spin = [&] { return random_point<(Dim == 2 ? 1 : 3)>(engine) * 5; };
    const auto away = random_direction<Dim>(engine) * 5;
    const MovingBody<double, Dim> a{&shape_a, {}, upright<double, Dim>(), {}, spin()};
    const MovingBody<double, Dim> b{&shape_b, away, upright<double, Dim>(), random_point<Dim>(engine) * 3 - away,
                                    spin()};
    const double tolerance = 1e-4;
    const auto contact = first_contact(a, b, 2.0, tolerance);
    contact ? ++met : ++passed;
    const double end = contact ? contact->time : 2.0;
    for (int i = 0; i < 300; ++i) EXPECT_GT(distance_at(a, b, end * i / 300), 0.85 * tolerance);
    if (!contact) continue;
    EXPECT_LE(distance_at(a, b, end), tolerance);
    EXPECT_GT(distance_at(a, b, end), 0.85 * tolerance);
  }
  EXPECT_GT(met, 20);
  EXPECT_GT(passed, 20);
}
TEST(FirstContact, IsNoLaterThanAnyContact) {
  is_no_later_than_any_contact<2>(), is_no_later_than_any_contact<3>();
}

// Balls, rods and boxes at up to 1 km/s, turning at up to 1000 rad/s, against a wall of 1 cm.
TEST(FirstContact, LetsNothingThroughAThinWall) {
  std::mt19937 engine(8);
  const auto wall = *convex_body<double>(*box<3>({{0.01, 50, 50}}), 0);
  for (int k = 0; k < 200; ++k) {
    const auto bullet = random_body<3>(engine);
    const MovingBody<double, 3> flight{&bullet,
                                       {{-5, 0, 0}},
                                       random_direction<4>(engine),
                                       {{500 + 500 * std::abs(random_point<1>(engine)[0]), 0, 0}},
                                       random_point<3>(engine) * 1000};
    const auto contact = first_contact(flight, {.shape = &wall}, 1.0 / 60, 1e-4);
    ASSERT_TRUE(contact) << k;
    EXPECT_LT(flight.at(contact->time).centre[0], 0);
    EXPECT_NEAR(contact->point[0], -0.005, 2e-4);
  }
}

}  // namespace
}  // namespace continuo::shapes_test
