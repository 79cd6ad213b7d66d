// Units: the unit of each subexpression, conversions, and refusals.
#include <cmath>
#include <numbers>

#include "check_helpers.hpp"

namespace continuo::model {
namespace {

constexpr const char* spring = R"(param k = 4 [N/m], c = 1 [N*s/m], m = 2 [kg], F = 3 [N]
x'' = (F - k*x - c*x)/m
x(0) = 1 [m];  x'(0) = 0 [m/s]
run 0..1 [s]
)";

TEST(CheckUnits, AMismatchSaysWhatEachSideIsAndTriesAPrime) {
  const Said message = said(spring, "E201");
  EXPECT_EQ(place(message), "2:8");
  EXPECT_EQ(message.message, "units do not match");
  EXPECT_EQ(message.label, "`F - k*x` is N, `c*x` is N*s");
  EXPECT_EQ(message.help, "did you mean c*x' ?");
}

TEST(CheckUnits, OneMistakeIsSaidOnce) {
  EXPECT_EQ(count_said(spring), 1U);
}

/// The unit of an output, of quantities with the units written beside them.
std::string unit_of(const std::string& expression) {
  const Model model = good(
      "param m = 2 [kg], v = 3 [m/s], l = 5 [m], tau = 2 [s], km = 1 [km], p = 7, F = 1 [N]\n"
      "x' = v\nx(0) = 0 [m]\noutput q = " +
      expression + "\nrun 0..1 [s]\n");
  return model.outputs.empty() ? "none" : model.outputs[0].unit;
}

TEST(CheckUnits, UnitsOfFormulas) {
  EXPECT_EQ(unit_of("m*v^2/2"), "J");
  EXPECT_EQ(unit_of("l + 3"), "m");
  EXPECT_EQ(unit_of("3 - l"), "m");
  EXPECT_EQ(unit_of("sqrt(l^2 + x^2)"), "m");
  EXPECT_EQ(unit_of("hypot(l, x)"), "m");
  EXPECT_EQ(unit_of("atan2(l, x + 1)"), "1");
  EXPECT_EQ(unit_of("2*3"), "");
  EXPECT_EQ(unit_of("p*l"), "");  // p was declared without unit
  EXPECT_EQ(unit_of("1/tau"), "1/s");
  EXPECT_EQ(unit_of("x'"), "m/s");
  EXPECT_EQ(unit_of("sin(x/l)"), "1");
  EXPECT_EQ(unit_of("l^1.5*l^-0.5"), "m");
  EXPECT_EQ(unit_of("F*tau/m"), "N*s/kg");
  EXPECT_EQ(unit_of("if x > l then x else 0"), "m");
  EXPECT_EQ(unit_of("min(l, km, 3)"), "m");
  EXPECT_EQ(unit_of("exp(-t/tau)*l"), "m");
  EXPECT_EQ(unit_of("(m*v^2) [kJ]"), "kJ");
}

double value_in(const std::string& expression) {
  const Model model = good(
      "param l = 5 [m], d = 2 [km], w = 90 [deg], h = 1 [h]\nx' = 1 [m/s]\nx(0) = 0 [m]\n"
      "output q = " +
      expression + "\nrun 0..1 [s]\n");
  return model.outputs.empty() ? 0 : value_of(model, "q");
}

TEST(CheckUnits, WhatDiffersByAFactorIsConverted) {
  EXPECT_DOUBLE_EQ(value_in("l + d"), 2005);
  EXPECT_DOUBLE_EQ(value_in("d + l"), 2.005);
  EXPECT_DOUBLE_EQ(value_in("h + t"), 1);
  EXPECT_NEAR(value_in("sin(w)"), 1, 1e-15);
  EXPECT_NEAR(value_in("sin(30 [deg])"), 0.5, 1e-15);
  EXPECT_DOUBLE_EQ(value_in("if d > l then 1 else 0"), 1);
  EXPECT_DOUBLE_EQ(value_in("max(l, d)"), 2000);
  EXPECT_DOUBLE_EQ(value_in("(d*l) [m^2]"), 10000);
  EXPECT_DOUBLE_EQ(value_in("sum(i in 1..2: if i == 1 then l else d)"), 2005);
}

TEST(CheckUnits, EquationsInitialValuesAndAssignmentsAreConverted) {
  const Model model = good(R"(param g = 36 [km/h/s]
h'' = -g
h(0) = 2 [km];  h'(0) = 9 [km/h]
when h falls through 100 [m] { h := 50 [m] }
run 0..1 [min]
)");
  EXPECT_EQ(model.states[0].unit, "km");
  EXPECT_EQ(model.states[1].unit, "km/h");
  EXPECT_EQ(model.time_unit, "min");
  // 9 km/h are 0.15 km/min; 36 km/h/s are 2160 km/h/min.
  EXPECT_DOUBLE_EQ(rate(model, "h"), 9.0 / 60);
  EXPECT_DOUBLE_EQ(rate(model, "h'"), -2160);
  EXPECT_DOUBLE_EQ(evaluate(model, model.events[0].guard, start_values(model)), 2 - 0.1);
  const auto& assign = std::get<Assign>(model.events[0].actions[0].what);
  EXPECT_DOUBLE_EQ(evaluate(model, assign.value, start_values(model)), 0.05);
  EXPECT_TRUE(model.pairs.empty());  // h' is not in the unit of dh/dt
}

TEST(CheckUnits, AStateTakesItsUnitFromItsInitialValueOrItsChain) {
  const Model bare = good("x'' = -x/(1 [s^2])\nx(0) = 3 [m];  x'(0) = 0\nrun 0..1 [s]\n");
  EXPECT_EQ(bare.states[1].unit, "m/s");
  const Model chain = good("x'' = -x/(1 [s^2])\nx(0) = 3;  x'(0) = 2 [m/s]\nrun 0..1 [s]\n");
  EXPECT_EQ(chain.states[0].unit, "m");
}

TEST(CheckUnits, AChainWhoseUnitsDisagreeIsRefused) {
  const Said message = said("x'' = 0\nx(0) = 3 [m];  x'(0) = 2 [m]\nrun 0..1 [s]\n", "E201");
  EXPECT_EQ(place(message), "2:16");
  EXPECT_EQ(message.label, "`x` is m, so `x'` is m/s, not m");
}

TEST(CheckUnits, FemtosecondsAndElectronvoltsGoTogether) {
  // A force of 1 eV/pm on 1 u: 1.602176634e-7 N / 1.66053906660e-27 kg = 9.64853e19 m/s^2 = 96.4853 pm/fs^2 (CODATA).
  const Model model = good("param D = 1 [eV/pm], m = 1 [u]\nr'' = D/m\nr(0) = 1 [pm];  r'(0) = 0\nrun 0..1 [fs]\n");
  EXPECT_NEAR(rate(model, "r'"), 96.48533, 1e-4);
}

TEST(CheckUnits, AModelWithoutUnitsHearsNothingOfThem) {
  const Model model = good("param w = 2\nx' = sin(w*t) + exp(x) + t^x\nx(0) = 1\nrun 0..10\n");
  EXPECT_FALSE(model.has_units);
  EXPECT_EQ(model.time_unit, "");
  const Model seconds = good("x' = -x + sin(2*t)\nx(0) = 1\nrun 0..10 [s]\n");
  EXPECT_EQ(seconds.time_unit, "s");
}

TEST(CheckUnits, FunctionsTakePureNumbers) {
  const Said message = said("param F = 1 [m/s]\nx' = F*sin(2*t)\nx(0) = 0 [m]\nrun 0..1 [s]\n", "E202");
  EXPECT_EQ(place(message), "2:12");
  EXPECT_EQ(message.label, "`2*t` is s");
}

TEST(CheckUnits, ExponentsOfQuantitiesAreNumbers) {
  const Said message = said("param l = 1 [m], n = 2\nx' = l^n\nx(0) = 0\nrun 0..1 [s]\n", "E204");
  EXPECT_EQ(place(message), "2:8");
}

TEST(CheckUnits, WrongUnitsAreNamed) {
  EXPECT_EQ(place(said("param g = 9 [meterz]\nx' = g\nx(0) = 0\nrun 0..1\n", "E203")), "1:13");
  EXPECT_EQ(place(said("x' = 1\nx(0) = 0 [m]\nrun 0..1 [kg]\n", "E201")), "3:10");
}

TEST(CheckUnits, DegreesCelsiusDoNotMixWithKelvins) {
  const Said message = said("param T0 = 20 [degC]\nT' = (T0 - T)/(1 [s])\nT(0) = 300 [K]\nrun 0..1 [s]\n", "E201");
  EXPECT_EQ(place(message), "2:7");
  EXPECT_EQ(message.help, "degC and degF count from another zero than K: use K throughout");
  EXPECT_EQ(said("param T0 = 20 [degC]\nT' = (T0 - T)/(1 [s])\nT(0) = 300 [m]\nrun 0..1 [s]\n", "E201").help, "");
}

TEST(CheckUnits, ChecksAndRangesAreHeldToTheirUnits) {
  const std::string model = "param l = 5 [m] in 1..9 [km]\nx' = 1 [m/s]\nx(0) = 0 [m]\nrun 0..10 [s]\n";
  EXPECT_EQ(good(model).parameters[0].range->low, 1000);
  EXPECT_EQ(place(said(model + "check x(1) = 1 [s] within 1e-9\n", "E201")), "5:7");
  EXPECT_EQ(place(said(model + "check time of end = 10 [m] within 1e-9\n", "E201")), "5:7");
}

}  // namespace
}  // namespace continuo::model
