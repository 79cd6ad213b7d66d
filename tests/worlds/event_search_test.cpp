// Conditions of events that cross 0 and return between two of the thousand samples of a run.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <tests/worlds/scene.hpp>

namespace continuo::worlds::event_search_test {
namespace {

std::vector<double> times_of(const model::Run& run, const std::string& mark) {
  std::vector<double> times;
  for (const auto& event : run.events)
    if (event.mark == mark) times.push_back(event.t);
  return times;
}

// y = 5 t - 5 t^2 has its maximum of 1.25 at t = 0.5 and is above 1.25 - 1e-8 for 4e-5 on both sides: much less than
// the distance of samples, a hundredth. Both crossings are found, with the error of t due to the rounding of y:
// 1e-16/(10*4e-5).
TEST(Looks, FindATopThatIsShort) {
  const model::Run run = run_of(R"(
world { gravity (0, -10); body ball at (0, 0) velocity (0, 5) }
when ball.y rises through 1.25 - 1e-8 { mark "up" }
when ball.y falls through 1.25 - 1e-8 { mark "down" }
run 0..10
)");
  ASSERT_EQ(run.events.size(), 2u);
  const double half = std::sqrt(1e-8 / 5);
  EXPECT_NEAR(run.events[0].t, 0.5 - half, 1e-11);
  EXPECT_NEAR(run.events[1].t, 0.5 + half, 1e-11);
  EXPECT_EQ(run.events[0].mark, "up");
  EXPECT_EQ(run.events[1].mark, "down");
}

// A ball at 1 m/s between walls 1e-3 apart: each crossing of the middle is found, ten between two of the thousand
// samples.
TEST(Looks, SeeEveryWayBetweenTwoContacts) {
  const model::Run run = run_of(R"(
world {
  wall (1, 0) at -0.5005
  wall (-1, 0) at -0.5005
  material restitution 1 friction 0
  body ball at (0.0002, 0) velocity (1, 0)
}
when ball.x crosses 0 { mark "middle" }
run 0..1 output 0.1
)");
  EXPECT_EQ(times_of(run, "middle").size(), 1000u);  // 0.0008 after the start, then every 0.001
}

// With drag, x = 1 - exp(-t), up to a wall at 0.6 that reflects it with 0.4: it is above 0.6 - 1e-7 for 5e-7. The path
// is computed to 1e-10.
TEST(Looks, SeeWhatABounceTurnsBack) {
  const model::Run run = run_of(R"(
world {
  wall (-1, 0) at -1.1
  material restitution 1 friction 0
  drag linear 1
  body ball at (0, 0) velocity (1, 0) mass 1
}
when ball.x rises through 0.6 - 1e-7 { mark "up" }
when ball.x falls through 0.6 - 1e-7 { mark "down" }
run 0..5
)");
  ASSERT_EQ(times_of(run, "up").size(), 1u);
  ASSERT_EQ(times_of(run, "down").size(), 1u);
  EXPECT_NEAR(times_of(run, "up")[0], -std::log(0.4 + 1e-7), 1e-9);
  EXPECT_NEAR(times_of(run, "down")[0], -std::log(0.4) - std::log(1 - 1e-7 / 0.4), 1e-9);
}

}  // namespace
}  // namespace continuo::worlds::event_search_test
