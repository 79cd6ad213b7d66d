// Events that other systems are known to miss, to find twice or to hang on; each test cites the complaint.
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/all.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::event_torture_test {
namespace {

using X1 = std::array<double, 1>;
using X2 = std::array<double, 2>;

template <class X>
std::vector<double> times(const Solution<X>& solution) {
  std::vector<double> t;
  for (const auto& record : solution.events) t.push_back(record.t);
  return t;
}

/// Any system, of one type, so that the driver is compiled once for a method.
template <class X>
using Slope = std::function<X(double, const X&)>;
const Slope<X1> clock_system = [](double, const X1&) { return X1{1}; };

// scipy#9228, open since 2018: y' = 3t^2 + 12t - 4 from y(-8) = -120 has its roots at -6, -2, 2.
TEST(Events, ThreeRootsOfACubicInOneStepAreAllFound) {
  const Slope<X1> f = [](double t, const X1&) { return X1{3 * t * t + 12 * t - 4}; };
  const auto root = crosses<X1>("root", [](double, const X1& y) { return y[0]; });
  const auto solution = solve(f, X1{-120}, {-8, 10}, Dop853{}, {.first_step = 18, .events = {root}});
  ASSERT_EQ(times(solution).size(), 3U);
  EXPECT_NEAR(solution.events[0].t, -6, 1e-13);
  EXPECT_NEAR(solution.events[1].t, -2, 1e-13);
  EXPECT_NEAR(solution.events[2].t, 2, 1e-13);
}

TEST(Events, TwoRootsAMillionthApartInOneStepAreBothFound) {
  const auto pair = crosses<X1>("pair", [](double t, const X1&) { return (t - 0.5) * (t - 0.500001); });
  const auto solution = solve(clock_system, X1{0}, {0, 1}, Tsitouras5{}, {.first_step = 1, .events = {pair}});
  ASSERT_EQ(times(solution).size(), 2U);
  EXPECT_NEAR(solution.events[0].t, 0.5, 1e-9);  // the slope there is 1e-6: g rounds at 1e-16
  EXPECT_NEAR(solution.events[1].t, 0.500001, 1e-9);
}

TEST(Events, BothDirectionsInOneStepGoToTheirOwnEvents) {
  const auto g = [](double t, const X1&) { return (t - 0.3) * (t - 0.6); };
  const auto solution = solve(clock_system, X1{0}, {0, 1}, Tsitouras5{},
                              {.first_step = 1, .events = {rises<X1>("up", g), falls<X1>("down", g)}});
  ASSERT_EQ(solution.events.size(), 2U);
  EXPECT_EQ(solution.events[0].event, 1U);
  EXPECT_NEAR(solution.events[0].t, 0.3, 1e-15);
  EXPECT_EQ(solution.events[1].event, 0U);
  EXPECT_NEAR(solution.events[1].t, 0.6, 1e-15);
}

// DifferentialEquations.jl#551: after the event the condition must be true.
TEST(Events, TheRootIsReportedOnItsFarSide) {
  for (const double level : {0.1, 0.2, 0.3, 1.0 / 3, 0.7}) {
    const Slope<X1> f = [](double, const X1& x) { return X1{-x[0]}; };
    const auto below = falls<X1>("below", [level](double, const X1& x) { return x[0] - level; });
    const auto solution = solve(f, X1{1}, {0, 5}, Dop853{}, {.rtol = 1e-12, .atol = 1e-14, .events = {below}});
    ASSERT_EQ(solution.events.size(), 1U);
    EXPECT_LT(solution.events[0].before[0], level);
    EXPECT_NEAR(solution.events[0].t, -std::log(level), 1e-10);
  }
}

// DiffEqBase.jl#889, DifferentialEquations.jl#516: two events at one instant, both seen, no loop.
TEST(Events, SimultaneousEventsActInOrderEachOnWhatTheOneBeforeHasLeft) {
  const Slope<X2> still = [](double, const X2&) { return X2{1, 1}; };
  const auto reach = [](double, const X2& x) { return x[0] - 0.5; };
  const auto swap_first = rises<X2>("first", reach, [](EventAction<X2>& now) { now.x[0] = now.before[1] + 10; });
  const auto swap_second = rises<X2>("second", reach, [](EventAction<X2>& now) { now.x[1] = now.before[0] + 20; });
  const auto solution = solve(still, X2{0, 1}, {0, 1}, Tsitouras5{}, {.events = {swap_first, swap_second}});
  ASSERT_EQ(solution.events.size(), 2U);
  EXPECT_EQ(solution.events[0].t, solution.events[1].t);
  EXPECT_NEAR(solution.events[1].after[0], 11.5, 1e-12);
  EXPECT_NEAR(solution.events[1].after[1], 31.5, 1e-12);
}

TEST(Events, TwoIdenticalEventsAreEachReportedOnce) {
  const auto g = [](double t, const X1&) { return t - 0.5; };
  const auto solution =
      solve(clock_system, X1{0}, {0, 1}, Tsitouras5{}, {.events = {crosses<X1>("a", g), crosses<X1>("b", g)}});
  EXPECT_EQ(solution.events.size(), 2U);
}

// Rule 4: true at t0 is no event (`at` t0 is); it fires when it becomes true again.
TEST(Events, AConditionTrueAtTheStartFiresOnlyWhenItBecomesTrueAgain) {
  const Slope<X1> f = [](double t, const X1&) { return X1{std::cos(t)}; };
  const auto below = falls<X1>("below", [](double, const X1& x) { return x[0] - 0.5; });
  const auto solution = solve(f, X1{0}, {0, 6}, Dop853{}, {.rtol = 1e-12, .events = {below}});
  ASSERT_EQ(solution.events.size(), 1U);
  EXPECT_NEAR(solution.events[0].t, M_PI - std::asin(0.5), 1e-10);
}

TEST(Events, AScheduledEventAtTheStartFires) {
  const auto set = at<X1>("set", {0, 0.5}, [](EventAction<X1>& now) { now.x[0] += 10; });
  const auto solution = solve(clock_system, X1{0}, {0, 1}, Tsitouras5{}, {.events = {set}});
  EXPECT_EQ(times(solution), (std::vector<double>{0, 0.5}));
  EXPECT_NEAR(solution.final_state()[0], 21, 1e-13);  // some fifty steps, each with a rounding of 21
}

// DiffEqBase.jl#634: g exactly zero at the start is no event until it has left.
TEST(Events, ZeroAtTheStartIsNoEvent) {
  const Slope<X1> f = [](double t, const X1&) { return X1{std::cos(t)}; };
  const auto zero = crosses<X1>("zero", [](double, const X1& x) { return x[0]; });
  const auto solution = solve(f, X1{0}, {0, 7}, Dop853{}, {.rtol = 1e-12, .events = {zero}});
  ASSERT_EQ(solution.events.size(), 2U);
  EXPECT_NEAR(solution.events[0].t, M_PI, 1e-10);
  EXPECT_NEAR(solution.events[1].t, 2 * M_PI, 1e-10);
}

// DifferentialEquations.jl#258, DiffEqBase.jl#266: roots that lie exactly on step ends.
TEST(Events, RootsOnStepEndsAreFoundOnce) {
  const auto pair = crosses<X1>("pair", [](double t, const X1&) { return (t - 0.5) * (t - 0.625); });
  const auto solution = solve(clock_system, X1{0}, {0, 1}, Rk4{}, {.step = 0.125, .events = {pair}});
  EXPECT_EQ(solution.events.size(), 2U);
  const auto first = rises<X1>("first", [](double, const X1& x) { return x[0] - 0.001; });
  const auto second = rises<X1>("second", [](double, const X1& x) { return x[0] - 0.002; });
  const auto tiny = solve(clock_system, X1{0}, {0, 0.01}, Tsitouras5{}, {.max_step = 1e-6, .events = {first, second}});
  EXPECT_EQ(tiny.events.size(), 2U);
  const auto tenth = crosses<X1>("pair", [](double t, const X1&) { return (t - 0.5) * (t - 0.6); });
  EXPECT_EQ(solve(clock_system, X1{0}, {0, 1}, Rk4{}, {.step = 0.1, .events = {tenth}}).events.size(), 2U);
}

// llnl/sundials#881: g identically zero after its root.
TEST(Events, IdenticallyZeroAfterTheEventIsQuiet) {
  bool stopped = false;
  const Slope<X1> f = [&stopped](double, const X1&) { return X1{stopped ? 0.0 : -1.0}; };
  const auto floor = falls<X1>(
      "floor", [](double, const X1& x) { return x[0]; },
      [&stopped](EventAction<X1>& now) {
        stopped = true;
        now.x[0] = 0;
        now.restart = true;
      });
  const auto solution = solve(f, X1{1}, {0, 10}, Tsitouras5{}, {.events = {floor}});
  EXPECT_EQ(solution.outcome.ending, Ending::reached_end);
  EXPECT_EQ(solution.events.size(), 1U);
  EXPECT_EQ(solution.final_state()[0], 0);
}

TEST(Events, AnEventMayFireAnother) {
  const auto half =
      rises<X2>("half", [](double, const X2& x) { return x[0] - 0.5; }, [](EventAction<X2>& now) { now.x[1] = 3; });
  const auto high =
      rises<X2>("high", [](double, const X2& x) { return x[1] - 2; }, [](EventAction<X2>& now) { now.x[0] = 0.75; });
  const Slope<X2> f = [](double, const X2&) { return X2{1, 0}; };
  const auto solution = solve(f, X2{0, 0}, {0, 1}, Tsitouras5{}, {.events = {high, half}});
  ASSERT_EQ(solution.events.size(), 2U);
  EXPECT_EQ(solution.events[0].event, 1U);
  EXPECT_EQ(solution.events[1].event, 0U);
  EXPECT_EQ(solution.events[0].t, solution.events[1].t);
  EXPECT_NEAR(solution.final_state()[0], 1.25, 1e-12);
}

TEST(Events, EventsThatFireEachOtherForEverEndWithAName) {
  const auto up = rises<X2>(
      "up", [](double, const X2& x) { return x[0] - 0.5; }, [](EventAction<X2>& now) { now.x = {now.before[0], 1}; });
  const auto ping =
      rises<X2>("ping", [](double, const X2& x) { return x[1]; }, [](EventAction<X2>& now) { now.x[1] = -1; });
  const auto pong =
      falls<X2>("pong", [](double, const X2& x) { return x[1]; }, [](EventAction<X2>& now) { now.x[1] = 1; });
  const Slope<X2> f = [](double, const X2&) { return X2{1, 0}; };
  const auto solution = solve(f, X2{0, -1}, {0, 1}, Tsitouras5{}, {.events = {up, ping, pong}});
  EXPECT_EQ(solution.outcome.ending, Ending::events_accumulate);
  EXPECT_FALSE(solution.outcome.event.empty());
  EXPECT_NEAR(solution.outcome.t, 0.5, 1e-12);
}

// scipy#17066, #10319: the event falls on an output time. That time has one state, the one after the event, so that the
// states are those of the times asked for; the event has both sides of the jump.
TEST(Events, AnEventAtAnOutputTimeKeepsTheStateAfterItOnce) {
  const auto jump = at<X1>("jump", {0.5}, [](EventAction<X1>& now) { now.x[0] = 10; });
  const auto solution =
      solve(clock_system, X1{0}, {0, 1}, Tsitouras5{}, {.events = {jump}, .save = Save<X1>::every(0.25)});
  EXPECT_EQ(solution.t, (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(solution.x[2][0], 10);
  ASSERT_EQ(solution.events.size(), 1U);
  EXPECT_NEAR(solution.events[0].before[0], 0.5, 1e-15);
  EXPECT_EQ(solution.events[0].after[0], 10);
}

// scipy#14176: terminal after n.
TEST(Events, StopsAfterTheNthTime) {
  const Slope<X1> f = [](double t, const X1&) { return X1{std::cos(t)}; };
  auto zero = crosses<X1>("zero", [](double, const X1& x) { return x[0]; });
  zero.stop_after = 3;
  const auto solution = solve(f, X1{0}, {0, 100}, Dop853{}, {.rtol = 1e-12, .events = {zero}});
  EXPECT_EQ(solution.outcome.ending, Ending::stopped_by_event);
  EXPECT_EQ(solution.outcome.event, "zero");
  EXPECT_EQ(solution.events.size(), 3U);
  EXPECT_NEAR(solution.outcome.t, 3 * M_PI, 1e-9);
}

// scipy#18039, DifferentialEquations.jl#167: a pulse narrower than a step, at a declared time.
TEST(Events, APulseAtADeclaredTimeIsNotSteppedOver) {
  double force = 0;
  const Slope<X1> f = [&force](double, const X1&) { return X1{force}; };
  const auto on = at<X1>("on", {500}, [&force](EventAction<X1>& now) { force = 1000, now.restart = true; });
  const auto off = at<X1>("off", {500.001}, [&force](EventAction<X1>& now) { force = 0, now.restart = true; });
  const auto solution = solve(f, X1{0}, {0, 1000}, Tsitouras5{}, {.events = {on, off}});
  EXPECT_NEAR(solution.final_state()[0], 1, 1e-9);  // 1000 * (500.001 - 500), the difference rounded at 500 * 2^-53
}

// OpenModelica#9711: x' = x > 0.5 ? -1 : 1 slides along 0.5.
TEST(Events, ChatteringIsDetectedAndNamed) {
  double direction = 1;
  const Slope<X1> f = [&direction](double, const X1&) { return X1{direction}; };
  const auto g = [](double, const X1& x) { return x[0] - 0.5; };
  const auto above = rises<X1>("above", g, [&direction](EventAction<X1>& now) { direction = -1, now.restart = true; });
  const auto below = falls<X1>("below", g, [&direction](EventAction<X1>& now) { direction = 1, now.restart = true; });
  const auto solution = solve(f, X1{0}, {0, 10}, Tsitouras5{}, {.events = {above, below}});
  EXPECT_EQ(solution.outcome.ending, Ending::events_accumulate);
  EXPECT_NEAR(solution.outcome.limit_time, 0.5, 1e-9);
  EXPECT_NEAR(solution.final_state()[0], 0.5, 1e-9);
}

// diffrax#464: an event seen only on a rejected step must not fire. A first step of 100 swings far below zero.
TEST(Events, AnEventOnARejectedStepDoesNotFire) {
  const Slope<X1> f = [](double, const X1& x) { return X1{-x[0]}; };
  const auto below = falls<X1>("below", [](double, const X1& x) { return x[0]; });
  const auto solution = solve(f, X1{1}, {0, 20}, Tsitouras5{}, {.first_step = 10, .events = {below}});
  EXPECT_GT(solution.statistics.rejected, 0U);
  EXPECT_TRUE(solution.events.empty());
}

// A particle that crosses a boundary while it slows down fires once; one that is reflected fires each time.
TEST(Events, PassingThroughIsNotTurningBack) {
  const Slope<X2> f = [](double, const X2& x) { return X2{x[1], 0}; };
  const auto border = rises<X2>(
      "border", [](double, const X2& x) { return x[0] - 1; },
      [](EventAction<X2>& now) { now.x[1] = now.before[1] / 2; });
  const auto solution = solve(f, X2{0, 1}, {0, 5}, Tsitouras5{}, {.events = {border}});
  EXPECT_EQ(solution.outcome.ending, Ending::reached_end);
  EXPECT_EQ(solution.events.size(), 1U);
  EXPECT_NEAR(solution.final_state()[0], 3, 1e-12);
}

TEST(Events, AGuardWithJumpsIsLocatedToo) {
  const auto late = rises<X1>("late", [](double t, const X1&) { return t > 0.7 ? 1.0 : -1.0; });
  const auto solution = solve(clock_system, X1{0}, {0, 1}, Tsitouras5{}, {.events = {late}});
  ASSERT_EQ(solution.events.size(), 1U);
  EXPECT_NEAR(solution.events[0].t, 0.7, 1e-15);
  EXPECT_GT(solution.events[0].t, 0.7);
}

TEST(Events, RunBackwardsTheyAreFoundInReverseOrder) {
  const Slope<X1> f = [](double t, const X1&) { return X1{std::cos(t)}; };
  const auto zero = crosses<X1>("zero", [](double, const X1& x) { return x[0]; });
  const auto solution = solve(f, X1{std::sin(7.0)}, {7, 0.5}, Dop853{}, {.rtol = 1e-12, .events = {zero}});
  ASSERT_EQ(solution.events.size(), 2U);
  EXPECT_NEAR(solution.events[0].t, 2 * M_PI, 1e-9);
  EXPECT_NEAR(solution.events[1].t, M_PI, 1e-9);
}

TEST(Events, EveryFiresAtItsMultiplesWithoutDrift) {
  int count = 0;
  const auto tick = every<X1>("tick", 0.1, 0, [&count](EventAction<X1>&) { ++count; });
  const auto solution = solve(clock_system, X1{0}, {0, 1000}, Tsitouras5{}, {.events = {tick}});
  EXPECT_EQ(count, 10001);
  EXPECT_EQ(solution.events[9998].t, 999.8);  // the decimal, not 9998 times the double nearest to 0.1
}

// An action that carries a guard across zero is a crossing, however far, and as often as it happens.
TEST(Events, AJumpAcrossZeroFiresEachTime) {
  const Slope<X2> still = [](double, const X2&) { return X2{0, 0}; };
  const auto square = every<X2>("square", 1, 1, [](EventAction<X2>& now) { now.x[0] = 1 - now.before[0]; });
  const auto count =
      rises<X2>("count", [](double, const X2& x) { return x[0] - 0.5; }, [](EventAction<X2>& now) { now.x[1] += 1; });
  const auto solution = solve(still, X2{0, 0}, {0, 10.5}, Tsitouras5{}, {.events = {square, count}});
  EXPECT_EQ(solution.outcome.ending, Ending::reached_end);
  EXPECT_EQ(solution.final_state()[1], 5);
}

// A hundred different events at one instant are no accumulation.
TEST(Events, ManyAtOneInstantAllAct) {
  std::vector<Event<X1>> events;
  for (int i = 0; i < 150; ++i)
    events.push_back(
        rises<X1>("one", [](double t, const X1&) { return t - 0.5; }, [](EventAction<X1>& now) { now.x[0] += 1; }));
  const Slope<X1> still = [](double, const X1&) { return X1{0}; };
  const auto solution = solve(still, X1{0}, {0, 1}, Tsitouras5{}, {.events = events});
  EXPECT_EQ(solution.outcome.ending, Ending::reached_end);
  EXPECT_EQ(solution.final_state()[0], 150);
}

// A ball without restitution on a moving table, concave and convex: it never passes, the run names the event.
TEST(Events, ABallWithoutRestitutionDoesNotPassATable) {
  const Slope<X2> f = [](double, const X2& x) { return X2{x[1], -9.81}; };
  const auto table = [](double t) { return 0.1 * std::sin(10 * t); };
  const auto hit = falls<X2>(
      "table", [=](double t, const X2& x) { return x[0] - table(t); },
      [=](EventAction<X2>& now) { now.x = {table(now.t), std::cos(10 * now.t)}; });
  const auto solution = solve(f, X2{1, 0}, {0, 3}, Dop853{}, {.rtol = 1e-10, .events = {hit}});
  for (std::size_t i = 0; i < solution.t.size(); ++i) EXPECT_GT(solution.x[i][0] - table(solution.t[i]), -1e-9);
  if (solution.outcome.ending != Ending::reached_end) {
    EXPECT_EQ(solution.outcome.ending, Ending::events_accumulate);
    EXPECT_EQ(solution.outcome.event, "table");
  }
}

// The action of the event for its limit is performed there, and the run continues.
TEST(Events, AccumulationGoesOnWhereTheEventSaysHow) {
  bool rests = false;
  const Slope<X2> f = [&rests](double, const X2& x) { return rests ? X2{0, 0} : X2{x[1], -10}; };
  auto floor = falls<X2>(
      "floor", [](double, const X2& x) { return x[0]; }, [](EventAction<X2>& now) { now.x[1] = -0.5 * now.before[1]; });
  floor.at_limit = [&rests](EventAction<X2>& now) {
    rests = now.restart = true;
    now.x = {0, 0};
  };
  const auto solution = solve(f, X2{5, 0}, {0, 10}, Dop853{}, {.rtol = 1e-10, .events = {floor}});
  EXPECT_EQ(solution.outcome.ending, Ending::reached_end);
  EXPECT_EQ(solution.final_state(), (X2{0, 0}));
  EXPECT_NEAR(solution.events.back().t, 3, 1e-7);  // 1 + 2 (1/2 + 1/4 + ...), less the rest at the limit
}

// A hundred flights of one step each are not a state that remains at zero.
TEST(Events, AHundredBouncesOfOneStepEachAreAllSeen) {
  const Slope<X2> f = [](double, const X2& x) { return X2{x[1], -10}; };
  const auto floor = falls<X2>(
      "floor", [](double, const X2& x) { return x[0]; }, [](EventAction<X2>& now) { now.x[1] = -now.before[1]; });
  const auto solution = solve(f, X2{5, 0}, {0, 200}, Dop853{}, {.first_step = 100, .events = {floor}});
  EXPECT_EQ(solution.outcome.ending, Ending::reached_end);
  EXPECT_EQ(solution.events.size(), 100U);  // at 1, 3, 5, ..., 199
}

TEST(Events, APeriodBelowTheSpacingOfNumbersIsRefused) {
  const auto tick = every<X1>("tick", 1e-17, -1, [](EventAction<X1>&) {});
  const auto solution = solve(clock_system, X1{0}, {0, 1}, Tsitouras5{}, {.events = {tick}});
  EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
  EXPECT_NE(solution.outcome.hint.find("tick"), std::string::npos);
}

}  // namespace
}  // namespace continuo::event_torture_test
