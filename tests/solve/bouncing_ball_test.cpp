// The bouncing ball against its closed form: h0 = 10, g, e: t_1 = sqrt(2 h0/g), t_(n+1) = t_n + 2 e^n sqrt(2 h0/g).
#include <cmath>

#include <gtest/gtest.h>

#include <continuo/methods/all.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bouncing_ball_test {
namespace {

using X = std::array<double, 2>;

struct Ball {
  double g;
  void operator()(double, const X& x, X& dxdt) const { dxdt = {x[1], -g}; }
};

Event<X> floor_event(double e) {
  return falls<X>(
      "floor", [](double, const X& x) { return x[0]; }, [e](EventAction<X>& now) { now.x = {0, -e * now.before[1]}; });
}

double impact(int n, double h0, double g, double e) {  // n = 1, 2, ...
  const double first = std::sqrt(2 * h0 / g);
  double t = first;
  for (int k = 1; k < n; ++k) t += 2 * std::pow(e, k) * first;
  return t;
}

double lowest(const Solution<X>& solution) {
  double least = 0;
  for (const X& x : solution.x) least = std::min(least, x[0]);
  return least;
}

TEST(BouncingBall, ImpactsMatchTheClosedForm) {
  const auto solution =
      solve(Ball{9.81}, X{1, 0}, {0, 2.5}, Dop853{}, {.rtol = 1e-10, .atol = 1e-12, .events = {floor_event(0.7)}});
  ASSERT_EQ(solution.outcome.ending, Ending::reached_end);
  ASSERT_GE(solution.events.size(), 10U);
  EXPECT_NEAR(solution.events[0].t, 0.451523640986, 1e-12);
  EXPECT_NEAR(solution.events[1].t, 1.083656738366, 1e-12);
  EXPECT_NEAR(solution.events[2].t, 1.526149906532, 1e-12);
  // Forty rounded sums of numbers near 2.5, each good to half a unit in the last place.
  for (std::size_t n = 0; n < solution.events.size(); ++n)
    EXPECT_NEAR(solution.events[n].t, impact(static_cast<int>(n) + 1, 1, 9.81, 0.7), 1e-13);
  EXPECT_GE(lowest(solution), -1e-12);
}

// An observer that reads the dense output after a step gets that of the step, also where it ended with an impact, or
// with a scheduled kick without a guard.
TEST(BouncingBall, TheDenseOutputOfAStepOutlivesTheEventAtItsEnd) {
  for (const bool kicked : {false, true}) {
    Options<X> options{.rtol = 1e-10, .atol = 1e-12};
    options.events = {kicked ? at<X>("kick", {0.4}, [](EventAction<X>& now) { now.x = {now.before[0], 3}; })
                             : floor_event(0.7)};
    Integrator integrator(Ball{9.81}, X{1, 0}, {0, 1}, Dop853{}, options);
    const double end = kicked ? 0.4 : std::sqrt(2 / 9.81);
    for (double begin = 0; begin < end - 1e-9; begin = integrator.t()) {
      ASSERT_TRUE(integrator.advance());
      for (const double part : {0.0, 0.25, 0.5, 0.75}) {
        const double t = begin + part * (integrator.t() - begin);
        X x{};
        integrator.at(t, x);
        EXPECT_NEAR(x[0], 1 - 9.81 / 2 * t * t, 1e-10) << kicked << " at " << t;  // the tolerance
      }
    }
  }
}

TEST(BouncingBall, AccumulatingBouncesAreNamedWithTheirLimit) {
  const auto solution =
      solve(Ball{9.81}, X{1, 0}, {0, 10}, Dop853{}, {.rtol = 1e-10, .atol = 1e-12, .events = {floor_event(0.7)}});
  EXPECT_EQ(solution.outcome.ending, Ending::events_accumulate);
  EXPECT_EQ(solution.outcome.event, "floor");
  EXPECT_NEAR(solution.outcome.limit_time, std::sqrt(2 / 9.81) * 1.7 / 0.3, 1e-11);
  EXPECT_GE(lowest(solution), -1e-12);
}

TEST(BouncingBall, WithoutLossNoBounceIsMissedAndEnergyStays) {
  const auto solution =
      solve(Ball{9.81}, X{1, 0}, {0, 1000}, Dop853{}, {.rtol = 1e-10, .atol = 1e-12, .events = {floor_event(1)}});
  ASSERT_EQ(solution.outcome.ending, Ending::reached_end);
  const double first = std::sqrt(2 / 9.81);
  EXPECT_EQ(solution.events.size(), static_cast<std::size_t>((1000 / first + 1) / 2));
  // Rounding alone: some 1108 impacts, each good to an ulp of h and h'.
  for (const X& x : solution.x) EXPECT_NEAR((x[1] * x[1] / 2 + 9.81 * x[0]) / 9.81, 1, 2e-12);
  EXPECT_GE(lowest(solution), -1e-12);
}

// DifferentialEquations.jl#138, #696: the ball must not fall through the floor, not even with tiny steps.
TEST(BouncingBall, NeverFallsThroughTheFloorWithTinySteps) {
  const auto solution = solve(Ball{9.81}, X{50, 0}, {0, 50}, Tsitouras5{},
                              {.max_step = 1e-4, .events = {floor_event(0.5)}, .save = Save<X>::every_step()});
  EXPECT_EQ(solution.outcome.ending, Ending::events_accumulate);
  EXPECT_NEAR(solution.outcome.limit_time, std::sqrt(100 / 9.81) * 3, 1e-9);
  EXPECT_GE(lowest(solution), -1e-12);
}

// The action does not set the ball back onto the floor, and with e = 0 it never returns.
TEST(BouncingBall, AnActionThatOnlyTurnsTheVelocityIsEnough) {
  for (const double e : {0.9, 0.5, 0.0}) {
    const Event<X> floor = falls<X>(
        "floor", [](double, const X& x) { return x[0]; }, [e](EventAction<X>& now) { now.x[1] = -e * now.before[1]; });
    const auto solution = solve(Ball{9.81}, X{10, 0}, {0, 100}, Tsitouras5{}, {.events = {floor}});
    EXPECT_EQ(solution.outcome.ending, Ending::events_accumulate) << e;
    EXPECT_GE(lowest(solution), -1e-12) << e;
  }
}

TEST(BouncingBall, DroppedFromRestOnTheFloorItStays) {
  const auto solution = solve(Ball{9.81}, X{1, 0}, {0, 10}, Dop853{}, {.events = {floor_event(0)}});
  EXPECT_EQ(solution.outcome.ending, Ending::events_accumulate);
  EXPECT_GE(lowest(solution), -1e-12);
}

// Every method, adaptive or with a fixed step, finds the impacts; those exact for parabolas find them exactly.
TEST(BouncingBall, EveryMethodBounces) {
  for_each_method<ExplicitMethods>([]<class M>() {
    if constexpr (!M::second_order) {
      const auto solution = solve(Ball{9.81}, X{10, 0}, {0, 8}, M{}, {.step = 0.01, .events = {floor_event(0.8)}});
      EXPECT_EQ(solution.outcome.ending, Ending::reached_end) << M::name;
      EXPECT_NEAR(solution.events.at(0).t, impact(1, 10, 9.81, 0.8), M::order < 2 ? 0.02 : 1e-12) << M::name;
      EXPECT_GE(lowest(solution), -1e-12) << M::name;
    }
  });
}

TEST(BouncingBall, BackwardsInTimeItClimbsBack) {
  const auto down = solve(Ball{9.81}, X{1, 0}, {0, 0.4}, Dop853{});
  const auto up = solve(Ball{9.81}, down.final_state(), {0.4, 0}, Dop853{});
  EXPECT_NEAR(up.final_state()[0], 1, 1e-14);
  EXPECT_NEAR(up.final_state()[1], 0, 1e-14);
}

}  // namespace
}  // namespace continuo::bouncing_ball_test
