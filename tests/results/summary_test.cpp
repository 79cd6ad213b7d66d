#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "example.hpp"
#include <continuo/results/summary.hpp>

namespace continuo::results {
namespace {

using ::testing::HasSubstr;

TEST(Summary, SaysHowItEndedWhereAndWhatItCost) {
  EXPECT_EQ(summary(falling_ball().model, falling_ball().run),
            "Ball: reached end at t = 1 s\n"
            "  h  = 0 m\n"
            "  h' = 1 m/s\n"
            "events  h falls through 0: at t = 1 s\n"
            "energy  2 J at first, 0.5 J at last; largest drift 0.75, relative\n"
            "checks  1 of 1 hold\n"
            "cost    3 steps, 1 rejected, 48 evaluations, 250 ms by dop853, tol 1e-10\n");
}

TEST(Summary, ManyStatesAndEventsStayAScreenful) {
  auto [model, run] = falling_ball();
  run.motion.states = 100;
  run.motion.columns = {{"t", "s"}};
  for (int i = 1; i <= 100; ++i) run.motion.columns.push_back({"u[" + std::to_string(i) + "]", "K"});
  run.motion.values.assign(101, 0);
  run.events.assign(1000, {"tick", "", 1, {}, {}});
  const std::string text = summary(model, run);
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 24);
  EXPECT_THAT(text, HasSubstr("and 85 more states (-o FILE writes them all)"));
  EXPECT_THAT(text, HasSubstr("tick: 1000 times"));
}

}  // namespace
}  // namespace continuo::results
