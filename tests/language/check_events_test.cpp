// Events and their actions.
#include "check_helpers.hpp"

namespace continuo::model {
namespace {

const std::string ball = R"(param g = 9.8, e = 0.9
mode flight { h'' = -g }
mode rest   { h'' = 0 }
h(0) = 10; h'(0) = -1
run 0..10
)";

TEST(CheckEvents, ALevelIsAGuard) {
  const Model model = good(ball + "when h falls through 2 in flight { h := 0; h' := -e*h'; go rest }\n");
  ASSERT_EQ(model.events.size(), 1U);
  const When& event = model.events[0];
  EXPECT_EQ(event.name, "h falls through 2 in flight");
  EXPECT_EQ(evaluate(model, event.guard, start_values(model)), 8);
  EXPECT_EQ(event.direction, Direction::falls);
  EXPECT_EQ(event.mode, 0U);
  ASSERT_EQ(event.actions.size(), 3U);
  EXPECT_EQ(std::get<Assign>(event.actions[1].what).state, 1U);
  EXPECT_EQ(std::get<Go>(event.actions[2].what).mode, 1U);
}

TEST(CheckEvents, WhatHappensAtALimitIsCheckedAsActions) {
  const std::string head = ball + "when h falls through 0 in flight { h' := -e*h' } then ";
  const Model model = good(head + "{ h := 0; h' := 0; go rest }\nwhen h > 20 { stop }\n");
  EXPECT_TRUE(model.events[0].has_limit);
  ASSERT_EQ(model.events[0].limit_actions.size(), 3U);
  EXPECT_EQ(std::get<Go>(model.events[0].limit_actions[2].what).mode, 1U);
  EXPECT_FALSE(model.events[1].has_limit);
  EXPECT_TRUE(good(head + "{ }\n").events[0].has_limit);
  EXPECT_EQ(good(head + "go rest\n").events[0].limit_actions.size(), 1U);
  EXPECT_EQ(place(said(head + "{ h := 0; h := 1 }\n", "E251")), "6:65");
  EXPECT_EQ(place(said(head + "go away\n", "E250")), "6:58");
}

TEST(CheckEvents, AConditionRisesThroughZeroWhereItBecomesTrue) {
  const Model model = good(ball + "when h < 3 and not h' > 2 { stop }\n");
  const auto guard_at = [&](double h, double v) {
    auto variables = start_values(model);
    variables[1] = h;
    variables[2] = v;
    return evaluate(model, model.events[0].guard, variables);
  };
  EXPECT_EQ(model.events[0].direction, Direction::rises);
  EXPECT_EQ(guard_at(1, 0), 2);  // min(3 - 1, 2 - 0)
  EXPECT_EQ(guard_at(5, 0), -2);
  EXPECT_EQ(guard_at(1, 4), -2);
}

TEST(CheckEvents, EqualityIsNoEvent) {
  EXPECT_EQ(place(said(ball + "when h == 3 { stop }\n", "E217")), "6:6");
}

TEST(CheckEvents, ScheduledOnesHaveTimes) {
  const Model model = good(ball + "at 3 { mark \"three\" }\nevery 0.5 from 2 { h := 1 }\ninitially { h' := 0 }\n");
  ASSERT_EQ(model.schedule.size(), 3U);
  EXPECT_EQ(model.schedule[0].time->value, 3);
  EXPECT_EQ(model.schedule[1].time->value, 0.5);
  EXPECT_EQ(model.schedule[1].first->value, 2);
  EXPECT_EQ(model.schedule[2].kind, Scheduled::Kind::initially);
  EXPECT_EQ(place(said(ball + "every 0 { h := 1 }\n", "E261")), "6:7");
  EXPECT_EQ(place(said(ball + "at h { h := 1 }\n", "E222")), "6:4");
}

TEST(CheckEvents, OneStateIsAssignedOnceOnEveryPath) {
  const std::string head = ball + "when h falls through 0 {\n";
  EXPECT_EQ(place(said(head + "  h := 0\n  h := 1\n}\n", "E251")), "8:3");
  EXPECT_EQ(place(said(head + "  if h' < 0 { h := 0 }\n  h := 1\n}\n", "E251")), "8:3");
  EXPECT_EQ(place(said(head + "  go rest\n  go flight\n}\n", "E251")), "8:3");
  good(head + "  if h' < 0 { h := 0 } else { h := 1 }\n}\n");
}

TEST(CheckEvents, OnlyStatesAreAssigned) {
  const Said message = said(ball + "when h falls through 0 { e := 0 }\n", "E252");
  EXPECT_EQ(place(message), "6:26");
  EXPECT_EQ(place(said(ball + "when h falls through 0 { h'' := 0 }\n", "E252")), "6:26");
  EXPECT_EQ(place(said(ball + "when h falls through 0 { hh := 0 }\n", "E210")), "6:26");
}

TEST(CheckEvents, ModesAreKnown) {
  EXPECT_EQ(said(ball + "when h falls through 0 { go rst }\n", "E250").help, "did you mean `rest`?");
  EXPECT_EQ(place(said(ball + "when h falls through 0 in fligt { h := 0 }\n", "E250")), "6:27");
  EXPECT_EQ(place(said(ball + "start in nowhere\n", "E250")), "6:10");
}

TEST(CheckEvents, TheOrderOfTheTextIsKept) {
  const Model model = good(ball + "at 3 { mark \"a\" }\nwhen h < 0 { mark \"b\" }\nat 4 { mark \"c\" }\n");
  ASSERT_EQ(model.event_order.size(), 3U);
  EXPECT_TRUE(model.event_order[0].scheduled);
  EXPECT_FALSE(model.event_order[1].scheduled);
  EXPECT_EQ(model.event_order[2].index, 1U);
}

TEST(CheckEvents, AnEventThatCannotHappenIsAWarning) {
  const Loaded loaded = load_text(ball + "when 1 falls through 0 { stop }\n");
  EXPECT_TRUE(loaded);
  ASSERT_EQ(loaded.diagnostics.size(), 1U);
  EXPECT_EQ(loaded.diagnostics[0].code, "E291");
}

}  // namespace
}  // namespace continuo::model
