// Runs of models: closed forms for motion, events, inputs and checks, and plain messages where a run is impossible.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model {
namespace {

Model model_of(const std::string& text) {
  Loaded loaded = load(Source("test.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return loaded ? std::move(*loaded.model) : Model{};
}

Run run_of(const std::string& text, const Experiment& experiment = {}) {
  Simulated simulated = simulate(model_of(text), experiment);
  EXPECT_TRUE(simulated.run);
  return simulated.run ? std::move(*simulated.run) : Run{};
}

std::string code_of(const std::string& text, const Experiment& experiment = {}) {
  const Simulated simulated = simulate(model_of(text), experiment);
  return simulated.diagnostics.empty() ? "" : simulated.diagnostics.front().code;
}

std::vector<double> times(const Run& run) {
  std::vector<double> all;
  for (const RecordedEvent& event : run.events) all.push_back(event.t);
  return all;
}

const std::string bouncing = R"(
param g = 9.81 [m/s^2], e = 0.7 in 0..1
h'' = -g
h(0) = 1 [m]; h'(0) = 0 [m/s]
when h falls through 0 { h := 0; h' := -e*h' }
energy kinetic = 1/2*h'^2, potential = g*h
run 0..2 [s] method dop853 tol 1e-10
)";

TEST(Simulate, ImpactsOfABouncingBallAreExactToTwelveDigits) {
  const auto run = run_of(bouncing);
  // t_1 = sqrt(2 h0/g), t_(n+1) = t_n + 2 e^n t_1 (elementary mechanics).
  const double first = std::sqrt(2 / 9.81);
  ASSERT_GE(run.events.size(), 3u);
  EXPECT_NEAR(run.events[0].t, first, 1e-12);
  EXPECT_NEAR(run.events[1].t, first * (1 + 2 * 0.7), 1e-12);
  EXPECT_NEAR(run.events[2].t, first * (1 + 2 * 0.7 + 2 * 0.49), 1e-12);
  for (std::size_t i = 0; i < run.motion.rows(); ++i) EXPECT_GE(run.motion.state(i)[0], -1e-12);
  // The event contains the state before and after an impact.
  EXPECT_LT(run.events[0].before[1], 0);
  EXPECT_NEAR(run.events[0].after[1], 0.7 * 9.81 * first, 1e-11);
}

TEST(Simulate, ABallWithoutLossMissesNoBounceInAThousandSeconds) {
  // The action leaves h where the event found it, a rounding of t below the floor: setting it to 0 would lift the ball
  // by that much each time.
  const auto run = run_of(R"(
param g = 9.81
h'' = -g
h(0) = 1; h'(0) = 0
when h falls through 0 { h' := -h' }
energy kinetic = 1/2*h'^2, potential = g*h
run 0..1000 method dop853 tol 1e-10
)");
  // Impacts at (2 n - 1) sqrt(2 h0/g).
  const double first = std::sqrt(2 / 9.81);
  EXPECT_EQ(run.outcome.ending, Ending::reached_end);
  EXPECT_EQ(run.events.size(), static_cast<std::size_t>(std::floor((1000 / first + 1) / 2)));
  EXPECT_LT(run.energy->drift, 1e-10);
}

TEST(Simulate, BouncesThatPileUpAreE310WithTheirLimit) {
  const Simulated simulated = simulate(model_of(bouncing), {.to = 5});
  ASSERT_TRUE(simulated.run);
  ASSERT_FALSE(simulated.diagnostics.empty());
  EXPECT_EQ(simulated.diagnostics[0].code, "E310");
  // sqrt(2 h0/g) (1 + e)/(1 - e)
  EXPECT_NEAR(simulated.run->outcome.limit_time, std::sqrt(2 / 9.81) * 1.7 / 0.3, 1e-6);
  EXPECT_THAT(simulated.diagnostics[0].message, testing::HasSubstr("2.5586"));
  EXPECT_GT(simulated.run->motion.rows(), 10u);
}

TEST(Simulate, ABallWithAModeToRestInRests) {
  const auto run = run_of(R"(
param g = 9.81, e = 0.7
mode flight { h'' = -g }
mode rest { h'' = 0 }
h(0) = 1; h'(0) = 0
when h falls through 0 in flight {
  h := 0
  if -e*h' > 0.001 { h' := -e*h' } else { h' := 0; go rest }
}
run 0..10 method dop853 tol 1e-10
)");
  EXPECT_EQ(run.outcome.ending, Ending::reached_end);
  EXPECT_EQ(run.final_state()[0], 0);
  EXPECT_EQ(run.final_state()[1], 0);
  // The speed after impact n is 0.7^n sqrt(2 g): below 0.001 at the 24th, where the ball rests.
  EXPECT_EQ(run.events.size(), 24u);
}

TEST(Simulate, AThermostatSwitchesWhenItsEquationsSay) {
  const auto run = run_of(R"(
mode heating { T' = (303 - T)/2 }
mode idle { T' = (283 - T)/2 }
start in heating
T(0) = 288
when T rises through 295 in heating { go idle }
when T falls through 293 in idle { go heating }
run 0..6 tol 1e-10
)");
  ASSERT_GE(run.events.size(), 3u);
  EXPECT_NEAR(run.events[0].t, 2 * std::log(15.0 / 8), 1e-9);
  EXPECT_NEAR(run.events[1].t, 2 * (std::log(15.0 / 8) + std::log(1.2)), 1e-9);
  EXPECT_NEAR(run.events[2].t, 2 * (std::log(15.0 / 8) + std::log(1.2) + std::log(1.25)), 1e-9);
}

TEST(Simulate, ScheduledTimesAreHitExactly) {
  const auto run = run_of(R"(
n' = 0
n(0) = 0
a' = 0
a(0) = 1
initially { n := 10 }
at 3 { a := n; n := a }
every 0.5 from 1 { n := n + 1 }
run 0..4
)");
  EXPECT_THAT(times(run), testing::ElementsAre(0, 1, 1.5, 2, 2.5, 3, 3, 3.5, 4));
  // At 3 the two actions read n = 14, a = 1; then the periodic event continues to count from 1.
  EXPECT_EQ(run.final_state()[0], 4);
  EXPECT_EQ(run.final_state()[1], 14);
}

TEST(Simulate, EventsOfOneInstantActInTheOrderOfTheText) {
  // Both guards pass zero at t = 1, where y is 2; the second event copies the value assigned by the first.
  const auto run = run_of(R"(
x' = 1
y' = 2
x(0) = 0; y(0) = 0
when x rises through 1 { x := y }
when y rises through 2 { y := x }
run 0..1.25
)");
  ASSERT_EQ(run.events.size(), 2u);
  EXPECT_NEAR(run.final_state()[0], 2.25, 1e-12);
  EXPECT_NEAR(run.final_state()[1], 2.5, 1e-12);
}

TEST(Simulate, AnEventMayFireAnother) {
  const auto run = run_of(R"(
x' = 1
n' = 0
x(0) = 0; n(0) = 0
when x rises through 1 { n := 5 }
when n rises through 3 { x := 10 }
run 0..2
)");
  ASSERT_EQ(run.events.size(), 2u);
  EXPECT_EQ(run.events[0].t, run.events[1].t);
  EXPECT_NEAR(run.final_state()[0], 11, 1e-12);
}

TEST(Simulate, ModesChangedTogetherWithTheStateTakeEffectAtOnce) {
  const auto run = run_of(R"(
mode up { x' = 1 }
mode down { x' = -1 }
x(0) = 0
when x rises through 1 in up { go down }
when x falls through 0 in down { go up }
run 0..10.5
)");
  ASSERT_EQ(run.events.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(run.events[i].t, static_cast<double>(i + 1), 1e-12);
}

TEST(Simulate, ARelayThatClicksForEverIsNamed) {
  // x' = (x > 0.5 ? -1 : 1) as two modes without a gap between them.
  const std::string relay = R"(
mode on { x' = 1 }
mode off { x' = -1 }
x(0) = 0
when x rises through 0.5 in on { go off }
when x falls through 0.5 in off { go on }
run 0..2
)";
  const Simulated simulated = simulate(model_of(relay));
  ASSERT_TRUE(simulated.run);
  EXPECT_EQ(simulated.run->outcome.ending, Ending::events_accumulate);
  EXPECT_EQ(simulated.diagnostics.front().code, "E310");
  EXPECT_NEAR(simulated.run->outcome.limit_time, 0.5, 1e-9);
}

TEST(Simulate, StopAndMarkAreTold) {
  const auto run = run_of(R"(
x' = 1
x(0) = 0
when x rises through 2 { mark "two" }
when x rises through 3 { stop "three" }
run 0..10
)");
  ASSERT_EQ(run.events.size(), 2u);
  EXPECT_EQ(run.events[0].mark, "two");
  EXPECT_EQ(run.outcome.ending, Ending::stopped_by_event);
  EXPECT_EQ(run.stop_text, "three");
  EXPECT_NEAR(run.final_time(), 3, 1e-12);
}

TEST(Simulate, StopsAfterSoManyTimes) {
  const auto run = run_of("x' = 1\nx(0) = 0\nevery 1 { stop after 4 }\nrun 0..10\n");
  EXPECT_EQ(run.final_time(), 4);
}

TEST(Simulate, StepsOfAnInputAreHitExactly) {
  Model model = model_of("input F = 0\nx' = F\nx(0) = 0\nrun 0..3 tol 1e-10\n");
  ASSERT_EQ(model.inputs.size(), 1u);
  model.inputs[0].points = Table({0, 1, 1.25}, {0, 8, 0}, Table::Between::step);
  const Simulated simulated = simulate(model);
  ASSERT_TRUE(simulated.run);
  // A pulse of 8 for a quarter: 2, with no error but rounding although the pulse is narrower than a step.
  EXPECT_NEAR(simulated.run->final_state()[0], 2, 1e-13);
  EXPECT_TRUE(simulated.run->events.empty());
}

TEST(Simulate, LinesOfAnInputAreFollowed) {
  Model model = model_of("input F = 0\nx' = F\nx(0) = 0\nrun 0..2 tol 1e-10\n");
  model.inputs[0].points = Table({0, 1, 2}, {0, 2, 0}, Table::Between::linear);
  const Simulated simulated = simulate(model);
  ASSERT_TRUE(simulated.run);
  EXPECT_NEAR(simulated.run->final_state()[0], 2, 1e-8);
}

TEST(Simulate, RowsStandAtTheTimesAskedFor) {
  const std::string text = "x' = -x\nx(0) = 1\noutput square = x^2\n";
  const auto every = run_of(text + "run 0..1 output 0.25\n");
  ASSERT_EQ(every.motion.rows(), 5u);
  EXPECT_EQ(every.motion.time(1), 0.25);
  EXPECT_NEAR(every.motion.row(4)[2], std::exp(-2.0), 1e-5);
  const auto logarithmic = run_of(text + "run 0..1 output log 1 per decade from 0.01\n");
  ASSERT_EQ(logarithmic.motion.rows(), 4u);  // 0, 0.01, 0.1, 1
  EXPECT_NEAR(logarithmic.motion.time(2), 0.1, 1e-15);
  EXPECT_GT(OutputTimes(logarithmic.plan)[1'000'000], 1);  // beyond the end of the run, and so no row
  EXPECT_GT(run_of(text + "run 0..1\n").motion.rows(), 4u);
}

TEST(Simulate, EnergyOfAnUndampedSpringDriftsWithinTheTolerance) {
  const auto run = run_of(R"(
param k = 4, m = 1
m*x'' = -k*x
x(0) = 1; x'(0) = 0
energy kinetic = 1/2*m*x'^2, potential = 1/2*k*x^2
run 0..10 tol 1e-9
check x(pi) = 1 within 1e-6
check energy drift < 1e-6
check always x <= 1.000001
check x at end = cos(20) within 1e-6
check x(1) = 3 within 1e-6
)");
  ASSERT_TRUE(run.energy);
  EXPECT_EQ(run.energy->first, 2);
  EXPECT_LT(run.energy->drift, 1e-6);
  ASSERT_EQ(run.checks.size(), 5u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(run.checks[i].passed) << run.checks[i].text << run.checks[i].message;
  EXPECT_FALSE(run.checks[4].passed);
  EXPECT_NEAR(run.checks[4].value, std::cos(2.0), 1e-6);
}

TEST(Simulate, WhatHoldsAlwaysMayBeHeldAgainstTheStart) {
  const auto run = run_of(R"(
input wind = 2
x' = 1; y' = -y
x(0) = 3; y(0) = 5
output total = x + y
run 0..1
initially { y = 4 }
check always x = x(0) + t within 1e-12
check always total(0) = 7 within 1e-12
check always y <= y(0)
check always x(0) = 4 within 1e-12
check always y <= x(0)
)");
  ASSERT_EQ(run.checks.size(), 5u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(run.checks[i].passed) << run.checks[i].text << run.checks[i].message;
  EXPECT_FALSE(run.checks[3].passed);
  EXPECT_FALSE(run.checks[4].passed);  // 4 at the start
}

TEST(Simulate, ParametersOfTheRunReplaceThoseOfTheText) {
  const auto run = run_of("param k = 1\nx' = -k*x\nx(0) = 1\nrun 0..1 tol 1e-10\n", {.parameters = {{"k", 2.0}}});
  EXPECT_NEAR(run.final_state()[0], std::exp(-2.0), 1e-9);
}

TEST(Simulate, EveryMethodOfTheCatalogueRuns) {
  for (const char* method : {"explicit_euler", "euler", "semi_implicit_euler", "symplectic_euler_position_first",
                             "central_difference", "velocity_verlet", "midpoint", "heun", "rk4", "rk38",
                             "bogacki_shampine3", "dormand_prince5", "tsitouras5", "dop853", "verner7", "verner9"}) {
    const auto run = run_of("x'' = -x\nx(0) = 1; x'(0) = 0\nrun 0..1\n", {.method = method, .step = 0.001});
    EXPECT_NEAR(run.final_state()[0], std::cos(1.0), 1e-3) << method;
  }
}

TEST(Simulate, WhatCannotBeRunIsSaid) {
  const std::string decay = "x' = -x\nx(0) = 1\nrun 0..1\n";
  EXPECT_EQ(code_of(decay, {.method = "rk5"}), "E330");
  EXPECT_EQ(code_of(decay, {.method = "rk4"}), "E331");
  EXPECT_EQ(code_of(decay, {.method = "velocity_verlet", .step = 0.1}), "E332");
  EXPECT_EQ(code_of(decay, {.to = -1}), "E333");
  EXPECT_EQ(code_of("x' = -x\nx(0) = 1\n"), "E333");
  EXPECT_EQ(code_of(decay, {.output = -1}), "E333");
  EXPECT_EQ(code_of(decay, {.parameters = {{"k", 1.0}}}), "E340");
  const std::string family = "param N = 3\nfor i in 1..N { u[i]' = -u[i]\nu[i](0) = 1 }\nrun 0..1\n";
  EXPECT_EQ(code_of(family, {.parameters = {{"N", 5.0}}}), "E343");
  EXPECT_EQ(code_of("x'' = -x\nx(0) = 1\nx(1) = 2\nrun 0..1\n"), "E321");
  EXPECT_EQ(code_of("unknown z = 1\nx' = z\n0 = z - x\nx(0) = 1\nrun 0..1\n", {.method = "dop853"}), "E320");
}

TEST(Simulate, FailuresKeepWhatWasComputed) {
  const Simulated simulated = simulate(model_of("x' = x^2\nx(0) = 1\nrun 0..2\n"));
  ASSERT_TRUE(simulated.run);
  EXPECT_FALSE(simulated.passed());
  EXPECT_EQ(simulated.diagnostics.front().code.substr(0, 2), "E3");
  // x = 1/(1 - t): it ends at 1.
  EXPECT_NEAR(simulated.run->final_time(), 1, 1e-3);
  EXPECT_GT(simulated.run->motion.rows(), 5u);
}

TEST(Simulate, SettingsAreReadAsTheLanguageReadsThem) {
  const Model model =
      model_of("param k = 4 [N/m] in 0..100, m = 1 [kg]\nm*x'' = -k*x\nx(0) = 1 [m]; x'(0) = 0 [m/s]\n");
  std::vector<Diagnostic> problems;
  EXPECT_EQ(parse_setting(model, "k=5", problems)->value, 5);
  EXPECT_NEAR(parse_setting(model, "k = 2*pi", problems)->value, 6.283185307179586, 1e-15);
  EXPECT_NEAR(parse_setting(model, "k=0.3 [N/cm]", problems)->value, 30, 1e-13);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(parse_setting(model, "k=500", problems)->value, 500);
  EXPECT_EQ(problems.back().code, "E342");
  EXPECT_FALSE(parse_setting(model, "kk=5", problems));
  EXPECT_EQ(problems.back().code, "E340");
  EXPECT_THAT(problems.back().help, testing::HasSubstr("k"));
  EXPECT_FALSE(parse_setting(model, "k=5 [s]", problems));
  EXPECT_EQ(problems.back().code, "E341");
  EXPECT_FALSE(parse_setting(model, "k", problems));
  EXPECT_FALSE(parse_setting(model, "k=", problems));
}

// The number of members of a family is dimensionless, so a length divided by it is a length, and is converted to
// kilometres: 2 m / 5 in a second.
TEST(Simulate, ALengthDividedByACountIsALength) {
  const Simulated simulated = simulate(
      model_of("param N = 4, L = 2 [m]\nlet dx = L/(N + 1)\nfor i in 1..N { u[i]' = dx/(1 [s])\nu[i](0) = 0 [km] }\n"
               "run 0..1 [s]\n"));
  ASSERT_TRUE(simulated.run);
  EXPECT_NEAR(simulated.run->final_state()[0], 0.0004, 1e-15);
}

TEST(Simulate, TheTrueErrorIsEstimated) {
  // x = exp(-t). The second run's own error is about a hundredth of the first's for an adaptive run; for half the step
  // of a method of order 4 Richardson's factor leaves an error of the next order, h times smaller.
  for (const Experiment& experiment : {Experiment{.rtol = 1e-5, .estimate_error = true},
                                       Experiment{.method = "rk4", .step = 0.1, .estimate_error = true}}) {
    const Simulated simulated = simulate(model_of("x' = -x\nx(0) = 1\nrun 0..1 output 0.1\n"), experiment);
    ASSERT_TRUE(simulated.run && simulated.run->error);
    const ErrorEstimate& estimate = *simulated.run->error;
    const double truth = std::abs(simulated.run->final_state()[0] - std::exp(-1.0));
    EXPECT_GT(truth, 1e-9);
    EXPECT_NEAR(estimate.at_end[0], truth, 0.2 * truth);
    ASSERT_FALSE(estimate.largest.empty());
    EXPECT_GE(estimate.largest[0], estimate.at_end[0]);
  }
}

// The rod of a pendulum as an unknown, index 1: T follows from the second derivative of x^2 + y^2 = L^2. Its tension is
// known in closed form from the energy: T L^2 = v^2 - g y with v^2 = -2 g y, so T = -3 g y / L^2.
TEST(Simulate, AlgebraicEquationsAreSolved) {
  const Simulated simulated = simulate(
      model_of("param g = 9.81\nunknown T = 5\nx'' = -T*x\ny'' = -T*y - g\n0 = x'^2 + y'^2 - T*(x^2 + y^2) - g*y\n"
               "x(0) = 1; x'(0) = 0; y(0) = 0; y'(0) = 0\nrun 0..2 tol 1e-8\n"));
  ASSERT_TRUE(simulated.passed());
  const Motion& motion = simulated.run->motion;
  EXPECT_EQ(motion.columns[5].name, "T");
  EXPECT_NEAR(motion.state(0)[4], 0, 1e-10);  // from the equation, not from the guess of 5
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const auto x = motion.state(row);
    EXPECT_NEAR(x[4], -3 * 9.81 * x[2], 1e-4);  // the circle is only kept by its second derivative: it drifts
  }
}

TEST(Simulate, JacobianIsExact) {
  const auto program = compile(model_of("param m = 3\nx'' = m*(1 - x^2)*x' - x\nx(0) = 2; x'(0) = 1\nrun 0..1\n"));
  static_assert(HasJacobian<ModelSystem, ModelSystem::X>);
  static_assert(HasSparseJacobian<ModelSystem, ModelSystem::X> && HasTimeDerivative<ModelSystem, ModelSystem::X>);
  ModelSystem system(program, start_values(program->model));
  std::vector<double> rows(4);
  system.jacobian(0, {2, 1}, rows);
  // Van der Pol: d/dx = -2 m x x' - 1, d/dx' = m (1 - x^2)
  EXPECT_THAT(rows, testing::ElementsAre(0, 1, -13, -9));
  EXPECT_EQ(system.jacobian_pattern().entries(), 4u);  // three, and the diagonal
}

}  // namespace
}  // namespace continuo::model
