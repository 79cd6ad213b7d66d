// The times of collisions on parabolas, against closed forms.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <continuo/bodies/contacts/collision_time.hpp>

namespace continuo::collision_time_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// A body thrown straight up at v from a contact returns after 2 v / g. It crosses an ulp of the distance, of which
// rounding makes a few, in ulp / v. Where that is longer than the flight, the test only demands that it returns within
// twice the time.
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
// A body that falls beside a ball, from the height of its centre, does not return.
TEST(CollisionTime, LeavesForGoodWherePathsPart) {
  const double wait =
      time_to_touch(Vector<double, 2>{{1, 0}}, Vector<double, 2>{{1e-9, 0}}, Vector<double, 2>{{0, -9.81}}, 1.0, 0.5);
  EXPECT_EQ(wait, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace continuo::collision_time_test
