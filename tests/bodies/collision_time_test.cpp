// The times of collisions on parabolas, against closed forms.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <continuo/bodies/contacts/collision_time.hpp>

namespace continuo::collision_time_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Thrown straight up at v from what it touches, it is back after 2 v / g. An ulp of the distance, of which rounding
// makes a few, is passed in ulp / v; where that is longer than the flight, only that it comes back at all can be asked,
// and that it takes no more than twice the time.
TEST(CollisionTime, ComesBackFromAFlightOfAnyLength) {
  constexpr double g = 9.81;
  for (const double inside : {0.0, epsilon / 2})
    for (double v = 1e-13; v < 2; v *= 10) {
      const double flight = 2 * v / g;
      const double wait = time_to_touch(Vector<double, 3>{{0, 0, 1 - inside}}, Vector<double, 3>{{0, 0, v}},
                                        Vector<double, 3>{{0, 0, -g}}, 1.0, 0.5);
      EXPECT_NEAR(wait, flight, std::min(flight, 8 * epsilon / v) + 8 * epsilon * flight) << v;
    }
}
// Beside a ball, at the height of its centre: whatever falls does not come back.
TEST(CollisionTime, LeavesForGoodWherePathsPart) {
  const double wait =
      time_to_touch(Vector<double, 2>{{1, 0}}, Vector<double, 2>{{1e-9, 0}}, Vector<double, 2>{{0, -9.81}}, 1.0, 0.5);
  EXPECT_EQ(wait, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace continuo::collision_time_test
