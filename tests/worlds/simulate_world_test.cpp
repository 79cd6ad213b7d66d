// Worlds in the language: runs, events, equations coupled to the bodies.
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <thread>

#include <gmock/gmock.h>
#include <tests/worlds/scene.hpp>

namespace continuo::worlds::simulate_world_test {
namespace {

TEST(SimulateWorld, JudgesItsChecks) {
  const model::Run run = run_of(R"(
world {
  gravity (0, -9.81) [m/s^2]
  wall ground (0, 1) at 0
  material restitution 1 friction 0
  body ball at (0, 10) [m] velocity (36, 0) [km/h] radius 50 [cm] mass 500 [g]
}
output height = ball.y - ball.radius
run 0..5 [s]
check ball.x(2) = 20 [m] within 1e-9
check ball.x' at end = 10 [m/s] within 1e-12
check ball.mass at end = 500 [g] within 0
check time of event 1 of "ball meets ground" = sqrt(2*9.5/9.81) [s] within 1e-12
check count of "ball meets ground" = 2
check count of events = 0
check always height > -1e-12 [m]
check energy drift < 1e-13
check energy at end = 1/2*0.5*10^2 + 0.5*9.81*10 [J] within 1e-9
)");
  EXPECT_EQ(failed_checks(run), "");
  EXPECT_EQ(run.checks.size(), 9u);
}

TEST(SimulateWorld, FindsEventsToNeighbouringTimes) {
  const model::Run run = run_of(R"(
world { gravity (0, -10); body ball at (0, 5) velocity (0, 3) }
when ball.y' falls through 0 { mark "apex" }
when ball.y falls through 2.5 { ball.y' := 0 }
when ball.y falls through -10 { stop "deep" }
run 0..100
)");
  ASSERT_EQ(run.events.size(), 3u);
  EXPECT_EQ(run.events[0].mark, "apex");
  EXPECT_NEAR(run.events[0].t, 0.3, 1e-14);
  const double second = 0.3 + std::sqrt(2 * (5.45 - 2.5) / 10);  // from the apex at 5 + 9/20
  EXPECT_NEAR(run.events[1].t, second, 1e-13);
  EXPECT_EQ(run.events[1].after[3], 0);
  EXPECT_NEAR(run.events[2].t, second + std::sqrt(2 * 12.5 / 10), 1e-13);
  EXPECT_EQ(run.outcome.ending, Ending::stopped_by_event);
  EXPECT_EQ(run.stop_text, "deep");
  EXPECT_LE(last(run, "ball.y"), -10);
}

TEST(SimulateWorld, FiresWhatActionsCarryOverInTheNextRound) {
  const model::Run run = run_of(R"(
world { body ball at (0, 0) }
F' = 0;  n' = 0;  k' = 0
F(0) = 0;  n(0) = 0;  k(0) = 0
initially { ball.x' := 1 }
when F rises through 0.5 { n := n + 1 }
when n > 1.5 { k := 10*n; ball.x' := 0 }
at 1 { F := 1 }
at 2 { F := 0 }
at 2.5 { F := 1 }
run 0..3
check n at end = 2 within 0
check k at end = 20 within 0
check ball.x at end = 2.5 within 1e-14
)");
  EXPECT_EQ(failed_checks(run), "");
  EXPECT_EQ(run.events.size(), 7u);
}

TEST(SimulateWorld, NamesEventsThatSetEachOtherOffWithoutEnd) {
  const auto program = program_of(R"(
world { body ball at (0, 0) }
F' = 0
F(0) = 0
when F rises through 0.5 { F := 0 }
when F falls through 0.5 { F := 1 }
at 1 { F := 1 }
run 0..3
)");
  const model::Simulated simulated = simulate_world(program, {});
  ASSERT_EQ(simulated.diagnostics.size(), 1u);
  EXPECT_NE(simulated.diagnostics[0].message.find("set each other off without end"), std::string::npos)
      << simulated.diagnostics[0].message;
}

TEST(SimulateWorld, HitsScheduledTimesExactly) {
  const model::Run run = run_of(R"(
world { body ball at (0, 0) }
initially { ball.x' := 1 }
every 0.5 { ball.x' := ball.x' + 1 }
at 1.25 { mark "quarter" }
run 0..2
check ball.x at end = 0.5*(1 + 2 + 3 + 4) within 1e-14
)");
  EXPECT_EQ(failed_checks(run), "");
  EXPECT_EQ(run.events.size(), 6u);  // initially, at 0.5, 1, 1.25, 1.5, 2
}

/// x'' = -k (x - y), y' = x - y: with x as the coordinate of a ball, and as equations alone.
TEST(SimulateWorld, MovesEquationsAndBodiesAsOneSystemInTheExactMode) {
  const char* text = R"(
param k = 4
world { body ball at (1, 0) mass 2 }
force on ball = (-2*k*(ball.x - y), 0)
y' = ball.x - y
y(0) = 0
u'' = -k*(u - w)
w' = u - w
u(0) = 1; u'(0) = 0; w(0) = 0
run 0..10
check ball.x - u at end = 0 within 1e-8
check y - w at end = 0 within 1e-8
)";
  EXPECT_EQ(failed_checks(run_of(text)), "");
}

/// Half a step, a step, half a step: of order 2 by the central difference, of order 1 by Euler's methods.
TEST(SimulateWorld, SplitsEquationsAndBodiesToTheOrderThatItPromises) {
  const std::string text = R"(
world { body ball at (1, 0) mass 1 }
force on ball = (-4*(ball.x - y) + sin(t), 0)
y' = ball.x - 2*y + cos(t)
y(0) = 0
run 0..2
)";
  const model::Run exact = run_of(text, {.rtol = 1e-13});
  const auto error = [&](const char* method, double step) {
    const model::Run run = run_of(text, {.method = method, .step = step});
    return std::hypot(last(run, "ball.x") - last(exact, "ball.x"), last(run, "y") - last(exact, "y"));
  };
  // Each halving divides the error by 2^order, up to the next term of the series: by less than a tenth here.
  EXPECT_NEAR(std::log2(error("central_difference", 0.02) / error("central_difference", 0.01)), 2, 0.1);
  EXPECT_NEAR(std::log2(error("semi_implicit_euler", 0.02) / error("semi_implicit_euler", 0.01)), 1, 0.1);
  EXPECT_NEAR(std::log2(error("implicit_euler", 0.02) / error("implicit_euler", 0.01)), 1, 0.1);
}

TEST(SimulateWorld, FollowsPathsByTheClassicalMethodToo) {
  const std::string text = R"(
world { body ball at (1, 0) mass 1; spring ball to (0, 0) stiffness 4 length 0 }
run 0..2
)";
  const auto error = [&](double step) {
    return std::abs(last(run_of(text, {.method = "rk4", .step = step}), "ball.x") - std::cos(4.0));
  };
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), 4, 0.2);  // order 4; cos(omega t), omega = 2
}

TEST(SimulateWorld, EstimatesItsErrorByAStricterRun) {
  struct Case {
    double omega;
    model::Experiment experiment;
  };
  // The exact path restarts at each row, every 0.05: only a fast oscillation has steps limited by the tolerance.
  for (const auto& [omega, experiment] :
       {Case{100, {.rtol = 1e-6, .estimate_error = true}},
        Case{2, {.method = "central_difference", .step = 0.01, .estimate_error = true}}}) {
    const model::Run run = run_of("world { body ball at (1, 0) mass 1; spring ball to (0, 0) length 0 stiffness " +
                                      std::to_string(omega * omega) + " }\nrun 0..10",
                                  experiment);
    ASSERT_TRUE(run.error);
    ASSERT_EQ(run.error->message, "");
    const double error = std::abs(last(run, "ball.x") - std::cos(10 * omega));
    // Compared with a run of a hundredth of the tolerance, the estimate is the error to some per cent; compared with
    // half the step, 3/4 of it.
    EXPECT_GT(run.error->at_end[0], error / 2);
    EXPECT_LT(run.error->at_end[0], error * 1.1);
    EXPECT_EQ(run.error->largest.size(), run.motion.states);
  }
}

TEST(SimulateWorld, ReadsInputsFromFiles) {
  const std::string path = testing::TempDir() + "push.csv";
  std::ofstream(path) << "t,F\n0,0\n1,2\n1.5,2\n";
  for (const char* between : {"linear", "step"}) {
    const bool linear = std::string_view(between) == "linear";
    const model::Run run = run_of("world { body ball at (0, 0) mass 1 }\ninput F = 0 from \"" + path + "\" " + between +
                                  "\nforce on ball = (F, 0)\nrun 0..1.5");
    // F = 2 t up to 1 and 2 from there, or 2 from 1 on.
    EXPECT_NEAR(last(run, "ball.x'"), linear ? 2 : 1, 1e-8) << between;
    EXPECT_NEAR(last(run, "ball.x"), linear ? 1.0 / 3 + 0.5 + 0.25 : 0.25, 1e-8) << between;
  }
}

TEST(SimulateWorld, PushesFamilies) {
  const model::Run run = run_of(R"(
world { bodies ball grid 3 from (0, 0) spacing (5, 0) mass 2 }
for i in 1..3 { force on ball[i] = (0, 2*i) }
force on ball[3] = (0, -6)
run 0..1
)");
  for (const int i : {1, 2})
    EXPECT_NEAR(last(run, "ball[" + std::to_string(i) + "].y"), i / 2.0, 1e-9);  // a t^2 / 2, a = i
  EXPECT_NEAR(last(run, "ball[3].y"), 0, 1e-12);                                 // two forces add up to none
}

TEST(SimulateWorld, MakesPatterns) {
  const model::Run run = run_of(R"(
param N = 3
world {
  bodies grain grid N x 2 from (1, 10) spacing (2, 3) radius 0.5 velocity (1, 0)
  bodies tower stack 4 from (-5, 0.5) radius 0.25
  bodies gas random 20 in (20, 20) to (30, 30) radius 0.5 speed 3 seed 7
  for i in 1..N { body ball[i] at (100 + i, 0) radius 0.1*i }
}
run 0..1
check grain[2].x(0) = 3 within 0
check grain[4].x(0) = 1 within 0
check grain[4].y(0) = 13 within 0
check grain[6].x at end = 6 within 1e-12
check tower[4].y(0) = 2 within 1e-15
check gas[20].x'^2 + gas[20].y'^2 at 0 = 9 within 1e-12
check ball[3].x at end = 103 within 0
check ball[3].radius at end = 0.3 within 1e-15
)");
  EXPECT_EQ(failed_checks(run), "");
}

TEST(SimulateWorld, PlacesBodiesAtRandomApartAndInTheBox) {
  const auto run = started(R"(
world { dimension 3; bodies gas random 300 in (0, 0, 0) to (10, 10, 10) radius 0.5 seed 3 }
)");
  for (std::size_t i = 0; i < 300; ++i) {
    const Point a = run->position(i);
    for (const double component : a) EXPECT_TRUE(component >= 0.5 && component <= 9.5);
    for (std::size_t j = 0; j < i; ++j) {
      const Point b = run->position(j);
      EXPECT_GT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 1);
    }
  }
}

TEST(SimulateWorld, HangsSpringsBetweenNeighbours) {
  const auto of = [](const char* springs) {
    return started(std::string("world { dimension 3; bodies net grid 4 x 1 x 3 from (0, 0, 0) spacing (1, 1, 1) radius "
                               "0.1\n springs of net stiffness 1 ") +
                   springs + "\n fix net[1] }")
        ->springs()
        .size();
  };
  EXPECT_EQ(of(""), 3u * 3 + 4 * 2);                      // along x, along z
  EXPECT_EQ(of("diagonal"), 3u * 3 + 4 * 2 + 2 * 3 * 2);  // and two across each cell
}

TEST(SimulateWorld, KeepsWhatWasComputedWhenItIsInterrupted) {
  const std::atomic<bool> interrupt = true;
  const auto program = program_of("world { body ball at (0, 0) velocity (1, 0) }\nrun 0..1");
  const model::Simulated simulated = simulate_world(program, {.interrupt = &interrupt});
  ASSERT_TRUE(simulated.run);
  EXPECT_EQ(simulated.run->outcome.ending, Ending::interrupted);
  EXPECT_EQ(simulated.run->motion.rows(), 1u);
  ASSERT_EQ(simulated.diagnostics.size(), 1u);
  EXPECT_EQ(simulated.diagnostics[0].code, "E307");
}

/// A heap in the exact mode consists of very many short flights: one row can take minutes.
TEST(SimulateWorld, IsInterruptedWithinARow) {
  for (const char* mode : {"mode exact", "mode exact\ndrag linear 0.001", "mode fast step 1e-7"}) {
    const auto program =
        program_of(std::string("world { dimension 3; gravity (0, 0, -9.81); wall (0, 0, 1) at 0\n") + mode +
                   "\nbodies grain grid 5 x 5 x 5 from (0, 0, 0.6) spacing (1.01, 1.01, 1.1) jitter "
                   "0.004 }\nrun 0..1000 output 1000");
    std::atomic<bool> interrupt = false;
    std::thread hand([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      interrupt = true;
    });
    const model::Simulated simulated = simulate_world(program, {.interrupt = &interrupt});
    hand.join();
    ASSERT_TRUE(simulated.run) << mode;
    EXPECT_EQ(simulated.run->outcome.ending, Ending::interrupted) << mode;
    EXPECT_GT(simulated.run->final_time(), 0) << mode;
    EXPECT_LT(simulated.run->final_time(), 1000) << mode;
  }
}

TEST(SimulateWorld, SaysWhyItCannotGoOn) {
  const auto program = program_of("world { body ball at (1, 0) }\nforce on ball = (1/(ball.x - 1), 0)\nrun 0..1");
  const model::Simulated simulated = simulate_world(program);
  ASSERT_EQ(simulated.diagnostics.size(), 1u);
  EXPECT_EQ(simulated.diagnostics[0].code, "E324");
}

TEST(SimulateWorld, IsNotIntegratedLikeEquations) {
  const auto program = program_of("world { body ball at (1, 0) }\nrun 0..1");
  const model::Simulated simulated = model::simulate(program);
  EXPECT_FALSE(simulated.run);
  ASSERT_EQ(simulated.diagnostics.size(), 1u);
  EXPECT_EQ(simulated.diagnostics[0].code, "E323");
}

TEST(SimulateWorld, ChangesTheModeOfItsEquations) {
  const model::Run run = run_of(R"(
world { body ball at (0, 0) velocity (1, 0) }
mode slow { y' = 1 }
mode quick { y' = 10 }
y(0) = 0
when ball.x rises through 2 in slow { go quick }
run 0..3
check y at end = 12 within 1e-9
)");
  EXPECT_EQ(failed_checks(run), "");
}

TEST(SimulateWorld, LetsGroupsPassThroughEachOther) {
  const std::string text = R"(
world {
  body a at (0, 0) velocity (1, 0) group ghosts
  body b at (5, 0) group GROUP
  ignore ghosts with ghosts
}
run 0..10
)";
  std::string through = text, meeting = text;
  through.replace(through.find("GROUP"), 5, "ghosts");
  meeting.replace(meeting.find("group GROUP"), 11, "");
  EXPECT_NEAR(last(run_of(through), "a.x"), 10, 1e-12);
  EXPECT_NEAR(last(run_of(meeting), "b.x'"), 0.5, 1e-12);  // equal masses, restitution 0
}

}  // namespace
}  // namespace continuo::worlds::simulate_world_test
