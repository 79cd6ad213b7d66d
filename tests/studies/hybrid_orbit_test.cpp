// Closed orbits and multipliers through events, jumps of the equations and time-dependent forces, against closed forms;
// models without an orbit are refused by name.
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/simulation/simulate.hpp>
#include <continuo/studies/hybrid_orbit.hpp>
#include <continuo/studies/support/forcing_period.hpp>

namespace continuo::studies {
namespace {

using Neighbours = HybridOrbit::Neighbours;

HybridOrbit orbit_of(const std::string& text, HybridOrbitOptions options = {.settle = 60, .duration = 40}) {
  const auto program = program_of(text);
  const Forcing forcing = forcing_of(*program);
  EXPECT_TRUE(forcing.status) << forcing.status.message;
  if (!options.forcing) options.forcing = forcing.period;
  return find_hybrid_orbit(program, {}, options);
}

void expect_orbit(const HybridOrbit& found, double period, const std::vector<double>& multipliers,
                  double accuracy = 1e-7) {
  ASSERT_TRUE(found.outcome) << found.outcome.hint;
  EXPECT_NEAR(found.period, period, 1e-9 * period);
  ASSERT_EQ(found.multipliers.size(), multipliers.size());
  for (std::size_t i = 0; i < multipliers.size(); ++i) {
    EXPECT_NEAR(found.multipliers[i].real(), multipliers[i], accuracy);
    EXPECT_NEAR(found.multipliers[i].imag(), 0, accuracy);
  }
}

// v' = I - v from 0 to 1: ln(I/(I - 1)), and its derivative by I is 1/I - 1/(I - 1).
TEST(HybridOrbit, OfAnIntegrateAndFireNeuronHasItsPeriod) {
  const auto program = program_of("param I = 2\nv' = I - v\nv(0) = 0\nwhen v rises through 1 { v := 0 }\nrun 0..50\n");
  const HybridOrbit found = find_hybrid_orbit(program, {}, {.settle = 20, .duration = 20, .parameters = {0}});
  expect_orbit(found, std::numbers::ln2, {1});
  ASSERT_EQ(found.period_by.size(), 1u);
  EXPECT_NEAR(found.period_by[0], -0.5, 1e-8);
}

// Each bounce returns the speed e v + k: v = k/(1 - e) on the orbit, and differences of speeds are multiplied by e.
TEST(HybridOrbit, OfABallThatIsKickedHasTheMultiplierE) {
  const HybridOrbit found =
      orbit_of("h' = v\nv' = -9.81\nh(0) = 1\nv(0) = 0\nwhen h falls through 0 { v := -0.7*v + 2 }\nrun 0..60\n");
  expect_orbit(found, 2 * (2 / 0.3) / 9.81, {1, 0.7});
  EXPECT_EQ(found.neighbours, Neighbours::come_nearer);
  EXPECT_NEAR(found.high[0], std::pow(2 / 0.3, 2) / (2 * 9.81), 1e-8);
  ASSERT_EQ(found.events.size(), 1u);
  EXPECT_EQ(found.events[0].name, "h falls through 0");
}

// T. McGeer, "Passive dynamic walking", Int. J. Robotics Res. 9 (1990): a step multiplies the speed by cos(2 alpha),
// and differences of its square by cos^2(2 alpha).
TEST(HybridOrbit, OfTheRimlessWheelHasItsMultiplier) {
  const HybridOrbit found = orbit_of(
      "param alpha = 0.3, gamma = 0.1\na' = w\nw' = sin(a)\na(0) = -0.2\nw(0) = 0.5\n"
      "when a rises through gamma + alpha { a := gamma - alpha; w := w*cos(2*alpha) }\nrun 0..200\n",
      {.settle = 100, .duration = 40});
  ASSERT_TRUE(found.outcome) << found.outcome.hint;
  const double kept = std::pow(std::cos(0.6), 2);
  // w^2/2 + cos(a) between steps: w+^2 = kept (w+^2 + 2 (cos(-0.2) - cos(0.4))).
  const double begin = std::sqrt(kept * 2 * (std::cos(0.2) - std::cos(0.4)) / (1 - kept));
  expect_orbit(found, found.period, {1, kept});
  EXPECT_NEAR(found.low[0], -0.2, 1e-12);
  const auto step = std::ranges::find_if(found.x, [&](const auto& x) { return x[0] == found.low[0]; });
  ASSERT_NE(step, found.x.end());
  EXPECT_NEAR((*step)[1], begin, 1e-9);
}

// 293 to 295 towards 323, back towards 283, with a time constant of 2 h.
TEST(HybridOrbit, OfTheThermostatGoesThroughItsModes) {
  const HybridOrbit found = find_hybrid_orbit(gallery("thermostat"), {}, {.settle = 12, .duration = 12});
  expect_orbit(found, 2 * (std::log(12.0 / 10) + std::log(30.0 / 28)), {1});
  EXPECT_EQ(found.events.size(), 2u);
}

// Between the jumps of the sign, x = +-1 are circled in half turns of w = sqrt(1 - 0.01): the distance d before becomes
// (d + 2) q - ... with q = exp(-0.1 pi/w), so d = (1 + q)/(1 - q) and neighbours come nearer by q^2 a turn.
TEST(HybridOrbit, OfARelayOscillatorPassesJumpsOfTheEquations) {
  const HybridOrbit found =
      orbit_of("x' = v\nv' = -x - 0.2*v + (if v > 0 then 1 else -1)\nx(0) = 1\nv(0) = 0\nrun 0..60\n");
  const double w = std::sqrt(0.99), q = std::exp(-0.1 * std::numbers::pi / w);
  expect_orbit(found, 2 * std::numbers::pi / w, {1, q * q});
  EXPECT_NEAR(found.high[0], (1 + q) / (1 - q), 1e-8);
}

// The counter m repeats after three turns, the counter n never does, but no equation depends on n; y is halved every
// third second.
TEST(HybridOrbit, CountersThatComeBackMakeItLonger) {
  const HybridOrbit found = orbit_of(
      "x' = 1\nn' = 0\nm' = 0\ny' = 1 - 0.3*y\nx(0) = 0\nn(0) = 0\nm(0) = 0\ny(0) = 1\n"
      "when x > 1 { x := 0; n := n + 1; if m == 2 { m := 0; y := 0.5*y } else { m := m + 1 } }\nrun 0..60\n");
  expect_orbit(found, 3, {1, 0.5 * std::exp(-0.9)});
  ASSERT_EQ(found.aside.size(), 1u);
  EXPECT_EQ(found.aside[0], 1u);
}

// A block dragged by a belt (stick and slip): while it sticks the motion slides along v = 1, so that perturbations
// vanish.
TEST(HybridOrbit, OfABlockThatSticksHasAMultiplierOfZero) {
  const HybridOrbit found = orbit_of(
      "x' = v\nv' = -x + (if v < 1 then 1/(1 + abs(v - 1)) else -1/(1 + abs(v - 1)))\nx(0) = 0\nv(0) = 0.5\n"
      "run 0..60\n");
  ASSERT_TRUE(found.outcome) << found.outcome.hint;
  ASSERT_EQ(found.multipliers.size(), 2u);
  EXPECT_NEAR(std::abs(found.multipliers[0] - 1.0), 0, 1e-12);
  EXPECT_NEAR(std::abs(found.multipliers[1]), 0, 1e-7);
  EXPECT_NEAR(found.high[1], 1, 1e-9);
}

// Without loss there is an orbit for each energy.
TEST(HybridOrbit, OfABallWithoutLossIsOneOfAFamily) {
  const HybridOrbit found =
      orbit_of("h'' = -9.81\nh(0) = 1\nh'(0) = 0\nwhen h falls through 0 { h' := -h' }\nrun 0..20\n");
  expect_orbit(found, 2 * std::sqrt(2 / 9.81), {1, 1});
  EXPECT_TRUE(found.family);
  EXPECT_EQ(found.neighbours, Neighbours::undecided);
}

// E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", eq. II.0.1: the period is
// 17.0652165601579625... Since the energy in the rotating frame is conserved, there is a second multiplier of 1; the
// other two are each other's inverse.
TEST(HybridOrbit, OfArenstorfsShipHasItsPairs) {
  const HybridOrbit found = find_hybrid_orbit(gallery("arenstorf"), {}, {.settle = 0, .duration = 20});
  ASSERT_TRUE(found.outcome) << found.outcome.hint;
  EXPECT_TRUE(found.family);
  EXPECT_NEAR(found.period, 17.0652165601579625, 1e-3);  // that of a neighbour in the family
  ASSERT_EQ(found.multipliers.size(), 4u);
  EXPECT_EQ(found.multipliers[1], 1.0);
  EXPECT_EQ(found.multipliers[2], 1.0);
  EXPECT_NEAR(std::abs(found.multipliers[0] * found.multipliers[3]), 1, 1e-3);
}

// x'' + 2 c x' + x = cos(W t): multipliers exp((-c +- i sqrt(1 - c^2)) T), amplitude 1/|1 - W^2 + 2 i c W|.
TEST(HybridOrbit, OfAForcedOscillatorHasThatOfTheForce) {
  const HybridOrbit found =
      orbit_of("x'' = -x - 0.2*x' + cos(1.3*t)\nx(0) = 0\nx'(0) = 0\nrun 0..200\n", {.settle = 200, .duration = 50});
  ASSERT_TRUE(found.outcome) << found.outcome.hint;
  const double period = 2 * std::numbers::pi / 1.3;
  EXPECT_NEAR(found.period, period, 1e-13);
  EXPECT_EQ(found.turns, 1u);
  const auto expected = std::exp(std::complex(-0.1, std::sqrt(0.99)) * period);
  ASSERT_EQ(found.multipliers.size(), 2u);
  EXPECT_NEAR(found.multipliers[0].real(), expected.real(), 1e-9);
  EXPECT_NEAR(std::abs(found.multipliers[0].imag()), std::abs(expected.imag()), 1e-9);
  EXPECT_NEAR(found.high[0], 1 / std::hypot(1 - 1.69, 0.26), 1e-6);
}

// The cycle of two of r y (1 - y) has the multiplier 4 + 2 r - r^2.
TEST(HybridOrbit, OfTheLogisticMapIsItsCycleOfTwo) {
  const std::string text = "param r = 3.2\ny' = 0\ny(0) = 0.3\nevery 1 { y := r*y*(1 - y) }\nrun 0..100\n";
  const HybridOrbit found = orbit_of(text, {.settle = 100, .duration = 50});
  expect_orbit(found, 2, {4 + 2 * 3.2 - 3.2 * 3.2});
  EXPECT_EQ(found.turns, 2u);
  // The fixed point 1 - 1/r repels, with 2 - r: it is found where one turn is asked for.
  const HybridOrbit once = orbit_of(text, {.settle = 0, .duration = 50, .turns = 1});
  expect_orbit(once, 1, {2 - 3.2});
  EXPECT_TRUE(once.found_nearby);
  EXPECT_EQ(once.neighbours, Neighbours::go_away);
}

// Meissner's equation, x'' = -k(t) x with k = 2 and 0.5 in turns of 1: the trace of the product of both halves.
TEST(HybridOrbit, OfMeissnersEquationAtRestHasItsMultipliers) {
  const HybridOrbit found = orbit_of("x'' = -(if mod(t, 2) < 1 then 2 else 0.5)*x\nx(0) = 0\nx'(0) = 0\nrun 0..20\n",
                                     {.settle = 10, .duration = 20});
  ASSERT_TRUE(found.outcome) << found.outcome.hint;
  EXPECT_EQ(found.period, 2);
  const double a = std::sqrt(2), b = std::sqrt(0.5);
  const double half = std::cos(a) * std::cos(b) - (a / b + b / a) / 2 * std::sin(a) * std::sin(b);
  ASSERT_EQ(found.multipliers.size(), 2u);
  ASSERT_LT(std::abs(half), 1);
  EXPECT_NEAR(found.multipliers[0].real(), half, 1e-9);
  EXPECT_NEAR(std::abs(found.multipliers[0]), 1, 1e-9);
}

// The two clocks reach 1 at the same time, and the order of their actions on z matters.
TEST(HybridOrbit, OfTwoEventsAtOnceIsRefused) {
  const HybridOrbit found = orbit_of(
      "x' = 1\ny' = 1\nz' = 0\nx(0) = 0\ny(0) = 0\nz(0) = 1\nwhen x rises through 1 { x := 0; z := 0.5*z }\n"
      "when y rises through 1 { y := 0; z := z + 1 }\nrun 0..20\n");
  if (found.outcome) {
    ADD_FAILURE() << found.multipliers[0] << found.multipliers[1];
  } else {
    EXPECT_NE(found.outcome.hint.find("happen at once"), std::string::npos) << found.outcome.hint;
  }
}

// A discontinuity on the surface of another: at each whole period `mod` jumps, and so does the comparison with it.
TEST(SwitchedMotion, OfASquareWaveHasItsMean) {
  const model::Simulated simulated =
      model::simulate(program_of("x' = if mod(t, 2) < 0.7 then 1 else -0.25\nx(0) = 0\nrun 0..10\n"), {.rtol = 1e-10});
  ASSERT_TRUE(simulated.run);
  EXPECT_NEAR(simulated.run->final_state()[0], 5 * (0.7 - 0.25 * 1.3), 1e-8);
}

// x = cos(t) touches the event's surface at 1 without crossing it.
TEST(HybridOrbit, ThatOnlyTouchesAnEventIsRefused) {
  const HybridOrbit found = orbit_of(
      "param mu = 1\nx' = -y + mu*x*(1 - x^2 - y^2)\ny' = x + mu*y*(1 - x^2 - y^2)\nx(0) = 0.5\ny(0) = 0\n"
      "when x > 1 { x := 0.8 }\nrun 0..60\n");
  EXPECT_FALSE(found.outcome);
  EXPECT_NE(found.outcome.hint, "");
}

TEST(HybridOrbit, OfARunThatAnEventEndsIsRefusedByItsName) {
  const HybridOrbit found = orbit_of("x' = 1\nx(0) = 0\nwhen x > 9 { stop \"far\" }\nrun 0..20\n");
  EXPECT_FALSE(found.outcome);
  EXPECT_NE(found.outcome.hint.find("ends the run"), std::string::npos) << found.outcome.hint;
}

TEST(HybridOrbit, ThroughALimitOfEventsIsRefusedByTheirName) {
  const std::string ball = "h'' = -9.81\nh(0) = 1\nh'(0) = 0\nwhen h falls through 0 { h' := -0.5*h' }";
  const HybridOrbit thrown_again = orbit_of(ball + " then { h := 1; h' := 0 }\nrun 0..60\n");
  EXPECT_FALSE(thrown_again.outcome);
  EXPECT_NE(thrown_again.outcome.hint.find("`h falls through 0` close in on a limit"), std::string::npos)
      << thrown_again.outcome.hint;
  const HybridOrbit ends = orbit_of(ball + "\nrun 0..60\n");
  EXPECT_FALSE(ends.outcome);
  EXPECT_NE(ends.outcome.hint.find("accumulate"), std::string::npos) << ends.outcome.hint;
}

TEST(ForcingPeriod, IsFoundInTheText) {
  const auto period = [](const std::string& equation) {
    const auto program = program_of("param W = 2, D = 3\nx' = " + equation + "\nx(0) = 0\nrun 0..9\n");
    return forcing_of(*program);
  };
  EXPECT_FALSE(period("1 - x").period);
  EXPECT_NEAR(*period("cos(W*t + x)").period, std::numbers::pi, 1e-15);
  EXPECT_NEAR(*period("cos(W*t) + sin(3*t)").period, 2 * std::numbers::pi, 1e-14);
  EXPECT_EQ(*period("mod(t, D) - x").period, 3);
  EXPECT_EQ(*period("floor(t/D) - t/D").period, 3);
  EXPECT_EQ(*period("if mod(t, 0.5) < 0.1 then mod(t - 1, 0.75) else 0").period, 1.5);
  EXPECT_FALSE(period("cos(t) + cos(sqrt(2)*t)").status);
  EXPECT_FALSE(period("t - x").status);
  EXPECT_FALSE(period("cos(x*t)").status);
  EXPECT_FALSE(period("cos(t^2)").status);
  EXPECT_FALSE(period("if t > 5 then 1 else 0").status);
  EXPECT_EQ(
      *forcing_of(*program_of("x' = -x\nx(0) = 0\nevery 0.5 { x := x + 1 }\nevery 0.3 { mark \"m\" }\nrun 0..9\n"))
           .period,
      0.5);
}

}  // namespace
}  // namespace continuo::studies
