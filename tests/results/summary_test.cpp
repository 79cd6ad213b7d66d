#include <algorithm>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "example.hpp"
#include <continuo/results/csv_writer.hpp>
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
            "checks  1 passed\n"
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

TEST(Summary, ARunOfAnotherModelSaysWhoseChecksTheseAreAndWhichFail) {
  auto [model, run] = falling_ball();
  EXPECT_THAT(summary(model, run, false),
              HasSubstr("checks  1 passed; they apply to the model as written in its file, and this run differs from "
                        "it\ncost"));
  run.checks.push_back({"check h(1) = 2 within 1e-9", false, 0.5, 2, 1e-9, "m", ""});
  run.checks.push_back({"check h at event 7 of x = 0", false, 0, 0, 1e-9, "m", "there were only 1 such events", false});
  EXPECT_THAT(summary(model, run, false),
              HasSubstr("differs from it\n"
                        "        check h(1) = 2 within 1e-9 does not hold: it is 0.5 m\n"
                        "        check h at event 7 of x = 0 was not evaluated: there were only 1 such events\ncost"));
  EXPECT_THAT(summary(model, run), HasSubstr("checks  1 passed, 1 failed, 1 not evaluated\ncost"));
  run.checks.resize(100, run.checks[1]);
  const std::string text = summary(model, run, false);
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 24);
  EXPECT_THAT(text, HasSubstr("        and 91 more\n"));
}

TEST(Summary, TheErrorIsThatOfTheStateFurthestFromItsTolerance) {
  auto [model, run] = falling_ball();  // |h| <= 1 m, |h'| <= 2 m/s
  run.plan.rtol_each = {1e-10, 1e-4};
  run.plan.atol = {1e-12, 1e-4};
  run.error = model::ErrorEstimate{{2e-10, 3e-6}, {5e-10, 3e-5}, ""};
  const std::string text = summary(model, run);
  EXPECT_THAT(text, HasSubstr("  h  = 0 +- 2e-10 m (tolerance 1e-12)\n"));
  EXPECT_THAT(text, HasSubstr("  h' = 1 +- 3e-06 m/s (tolerance 0.0002)\n"));
  // 5e-10 of 1e-12 + 1e-10 * 1 is more than 3e-5 of 1e-4 + 1e-4 * 2, though the less in numbers.
  EXPECT_THAT(text, HasSubstr("error   at most 5e-10 m in h, 5 times its tolerance"));
  EXPECT_THAT(text, HasSubstr("tol 1e-10..0.0001\n"));
}

TEST(Summary, WhatIsNoNumberHasNoSign) {
  auto [model, run] = falling_ball();
  const double nan = -std::numeric_limits<double>::quiet_NaN();
  run.energy = model::EnergyBalance{2, nan, nan, "J"};
  run.motion.values.back() = nan;
  run.checks = {{"check x(1) = 2 within 1e-9", false, nan, 2, 1e-9, "m", ""}};
  const std::string text = summary(model, run, false);
  EXPECT_THAT(text, HasSubstr("h' = nan m/s"));
  EXPECT_THAT(text, HasSubstr("nan J at last; largest drift nan"));
  EXPECT_THAT(text, HasSubstr("does not hold: its value is not a number\n"));
  EXPECT_EQ(text.find("-nan"), std::string::npos);
  EXPECT_EQ(number(nan), "nan");
}

}  // namespace
}  // namespace continuo::results
