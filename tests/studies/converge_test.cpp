// Observed orders of every method, and where rounding ends them.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/solve/catalogue.hpp>
#include <continuo/status/require.hpp>
#include <continuo/studies/converge.hpp>
#include <continuo/studies/difference_schemes.hpp>

namespace continuo::studies::converge_test {
namespace {

/// A planet from its perihelion at (1, 0) with the velocity sqrt(1 + e): its start has no rounding for the values of e
/// below. Its place by Kepler's equation u - e sin u = n t, a = 1/(1 - e), n = a^(-3/2).
ConvergenceProblem planet(double e, double until) {
  const auto f = [](auto, auto x, auto dxdt) {
    using std::sqrt;
    const auto r2 = x[0] * x[0] + x[1] * x[1], r3 = r2 * sqrt(r2);
    dxdt[0] = x[2], dxdt[1] = x[3], dxdt[2] = -x[0] / r3, dxdt[3] = -x[1] / r3;
  };
  auto problem = motion_problem(4, f, {1, 0, 0, std::sqrt(1 + e)}, {0, until});
  problem.exact = [e = static_cast<long double>(e)](long double t) {
    const long double a = 1 / (1 - e), n = 1 / (a * std::sqrt(a)), b = a * std::sqrt(1 - e * e);
    long double u = n * t;
    for (int k = 0; k < 50; ++k) u -= (u - e * std::sin(u) - n * t) / (1 - e * std::cos(u));
    const long double rate = n / (1 - e * std::cos(u));
    return std::vector<long double>{a * (std::cos(u) - e), b * std::sin(u), -a * rate * std::sin(u),
                                    b * rate * std::cos(u)};
  };
  return problem;
}

/// x' = x (1 - x), x(0) = 1/8.
ConvergenceProblem logistic() {
  auto problem = convergence_problem(1, [](auto, auto x, auto dxdt) { dxdt[0] = x[0] * (1 - x[0]); }, {0.125}, {0, 8});
  problem.exact = [](long double t) { return std::vector<long double>{1 / (1 + 7 * std::exp(-t))}; };
  return problem;
}

// With fixed steps the methods of variable order use a constant order: Adams has 3, since its first steps are of order
// 1 (adams.hpp); Radau keeps its initial order, BDF rises to 2.
TEST(Converge, OfMethodsOfVariableOrderTheOneThatFixedStepsKeepIsClaimed) {
  const std::map<std::string_view, int> kept{{"adams", 3}, {"odex", 8}, {"taylor", 8},
                                             {"radau", 5}, {"bdf", 2},  {"seulex", 4}};
  for (const MethodInfo& method : method_catalogue()) {
    const auto found = kept.find(method.name);
    EXPECT_EQ(method.order_of_fixed_steps, found == kept.end() ? method.order : found->second) << method.name;
  }
  const ConvergenceProblem growth = logistic();
  EXPECT_EQ(require(converge(growth, {.methods = {"radau"}, .most_steps = 64})).methods.front().nominal, 5);
  EXPECT_EQ(require(converge(growth, {.methods = {"radau"}, .tolerances = {1e-3, 1e-4}})).methods.front().nominal, 0);
}

TEST(Converge, EveryMethodHasItsOrder) {
  const ConvergenceProblem growth = logistic(), circle = planet(0, 8), ellipse = planet(0.5625, 16);
  for (const MethodInfo& method : method_catalogue()) {
    if (method.needs_series) continue;  // of which a study has none
    // Two methods show their order late, on a problem where errors are still well above rounding then: of verner7 the
    // coefficients of the next terms are the larger ones, of dprkn12 eight steps of the circle leave 1e-9.
    const bool late = method.name == "verner7" || method.name.starts_with("dprkn12");
    const ConvergenceProblem& problem = late ? ellipse : method.second_order ? circle : growth;
    const Convergence result =
        require(converge(problem, {.methods = {std::string(method.name)}, .most_steps = 4096, .in_long_double = true}));
    const ErrorCurve& observed = result.methods.front().in_long_double;
    ASSERT_TRUE(observed.found) << method.name;
    EXPECT_NEAR(observed.order, method.order_of_fixed_steps, 0.15) << method.name;
    EXPECT_EQ(result.methods.front().nominal, method.order_of_fixed_steps) << method.name;
  }
}

TEST(Converge, TheLocalErrorIsOneOrderHigher) {
  for (const char* name : {"explicit_euler", "heun", "rk4", "implicit_euler", "trapezoidal", "velocity_verlet"}) {
    const Convergence result = require(converge(planet(0.5625, 8), {.methods = {name}, .most_steps = 4096}));
    EXPECT_NEAR(result.methods.front().local.order, find_method(name)->order + 1, 0.15) << name;
  }
}

TEST(Converge, ConsistencyAloneIsNoConvergence) {  // of a method of order 1 and a system that it cannot follow
  const auto stiff = convergence_problem(1,
                                         [](auto t, auto x, auto dxdt) {
                                           using std::cos, std::sin;
                                           dxdt[0] = -20000 * (x[0] - cos(t)) - sin(t);
                                         },
                                         {1}, {0, 1});
  const Convergence result = require(converge(stiff, {.methods = {"explicit_euler"}, .most_steps = 4096}));
  const auto& points = result.methods.front().points;
  for (const StepErrors& point : points) {
    EXPECT_LT(point.local, 10 * point.step);  // every single step is good, (20000 h^2/2 would be an upper bound of it)
    EXPECT_FALSE(point.global < 1) << point.step;  // h > 2/20000: the run is not
  }
}

/// Whether the smallest error is where the error of the method and rounding balance. Steps are a factor of sqrt(2)
/// apart: it may be two steps above. Below, steps four times shorter only double the random rounding errors, which
/// counts as no loss. The error is at most that of roundings all in one direction, and at least a quarter of that of
/// random ones: the probability that the worst of eight stations, of which three or more have independent errors, is
/// below a quarter of its deviation is 0.2^3 = 1/125. A method with compensated sums has less rounding than predicted.
void expect_predicted(const ErrorCurve& observed, const FloorPrediction& predicted, bool compensated) {
  EXPECT_LT(observed.least_error, predicted.at_worst.error);
  EXPECT_LT(observed.best_step, predicted.at_worst.step * 2);
  if (compensated) return;
  EXPECT_GT(observed.least_error, predicted.at_random.error / 4);
  EXPECT_GT(observed.best_step, predicted.at_random.step / 4);
}

TEST(Converge, RoundingEndsEveryMethodWhereItShould) {
  const std::set<std::string_view> compensated{"mclachlan_atela4", "yoshida6", "kahan_li8"};
  const ConvergenceProblem ellipse = planet(0.5625, 16);
  for (const MethodInfo& method : method_catalogue()) {
    if (method.needs_series) continue;
    SCOPED_TRACE(method.name);
    const Convergence result = require(converge(ellipse, {.methods = {std::string(method.name)}, .in_float = true}));
    const MethodConvergence& found = result.methods.front();
    ASSERT_TRUE(found.floor && found.floor_in_float);
    // Implicit equations are solved to a tolerance, which may end it before rounding does.
    const bool solved = method.implicit && !method.automatic;
    const auto judge = [&](const ErrorCurve& observed, const FloorPrediction& predicted) {
      const bool less = compensated.contains(method.name);
      if (observed.floor_reached) return expect_predicted(observed, predicted, less);
      EXPECT_TRUE(less || predicted.at_random.step < 16.0 / 65536);  // it lies beyond the shortest step
    };
    if (!solved) judge(found.in_float, *found.floor_in_float);
    if (!solved) judge(found.global, *found.floor);
    if (solved && found.in_float.floor_reached) {
      EXPECT_LT(found.in_float.least_error, found.floor_in_float->at_worst.error);
    }
  }
}

TEST(Converge, DifferencesHaveTheirOrdersAndTheirFloor) {
  const auto study =
      converge_differences([](auto x) { return std::exp(std::sin(x)); }, 1, std::cos(1.0) * std::exp(std::sin(1.0)),
                           (std::cos(1.0) * std::cos(1.0) - std::sin(1.0)) * std::exp(std::sin(1.0)));
  ASSERT_EQ(study.size(), 4u);
  for (const DifferenceErrors& errors : study) {
    EXPECT_NEAR(errors.of_double.order, errors.scheme.order, 0.15) << errors.scheme.name;
    EXPECT_TRUE(errors.of_double.floor_reached) << errors.scheme.name;
    // Steps are powers of 2, and rounding may by chance be less than predicted: then smaller steps are still better.
    EXPECT_GT(errors.of_double.best_step, errors.predicted.step / 8) << errors.scheme.name;
    EXPECT_LT(errors.of_double.best_step, errors.predicted.step * 4) << errors.scheme.name;
    EXPECT_LT(errors.of_double.least_error, 2 * errors.predicted.error) << errors.scheme.name;
    EXPECT_GT(errors.of_float.best_step, errors.predicted_in_float.step / 8) << errors.scheme.name;
    EXPECT_LT(errors.of_float.best_step, errors.predicted_in_float.step * 4) << errors.scheme.name;
  }
}

TEST(Converge, AModelIsStudiedInAllNumbers) {
  const auto program = program_of("x'' = -4*x\nx(0) = 1;  x'(0) = 0\nenergy e = 1/2*x'^2 + 2*x^2\nrun 0..3\n");
  const Convergence result = require(
      converge(program, {},
               {.methods = {"rk4", "velocity_verlet"}, .most_steps = 4096, .in_float = true, .in_long_double = true}));
  const MethodConvergence& rk4 = result.methods[0];
  EXPECT_NEAR(rk4.global.order, 4, 0.05);
  EXPECT_NEAR(rk4.local.order, 5, 0.05);
  EXPECT_NEAR(rk4.energy.order, 5, 0.05);  // |R|^2 = 1 - y^6/72 + ..., in 1/h steps
  EXPECT_NEAR(rk4.in_long_double.order, 4, 0.05);
  EXPECT_TRUE(rk4.in_float.floor_reached);
  EXPECT_NEAR(result.methods[1].energy.order, 2, 0.05);
}

TEST(Converge, EventsLeaveTheGlobalError) {
  const auto program =
      program_of("h'' = -10\nh(0) = 1;  h'(0) = 0\nwhen h falls through 0 { h' := -0.9*h' }\nrun 0..1 output 0.1\n");
  const Convergence result = require(converge(program, {}, {.methods = {"explicit_euler"}, .most_steps = 2048}));
  EXPECT_NEAR(result.methods.front().global.order, 1, 0.15);
  EXPECT_TRUE(std::isnan(result.methods.front().points.front().local));
}

TEST(Converge, TolerancesAreStudiedLikeStepsOfEveryMethodThatHasThem) {
  for (const MethodInfo& method : method_catalogue()) {
    const Convergence result = require(
        converge(planet(0.5625, 8), {.methods = {std::string(method.name)}, .tolerances = {1e-3, 1e-4, 1e-5, 1e-6}}));
    const MethodConvergence& found = result.methods.front();
    const bool has_control = method.error_order > 0 && !method.needs_series;
    EXPECT_EQ(succeeded(found.status.ending), has_control) << method.name;
    if (!found.status) continue;
    ASSERT_EQ(found.points.size(), 4u) << method.name;
    // A tenth of the tolerance: near a tenth of the error, on the whole.
    EXPECT_LT(found.points.back().global, 1e-2 * found.points.front().global) << method.name;
  }
}

TEST(Converge, AnInterruptKeepsWhatIsThere) {
  std::atomic<bool> stop = false;
  const Convergence result =
      require(converge(logistic(), {.methods = {"rk4", "heun"}, .interrupt = &stop, .progress = [&](double part) {
                                      if (part > 0.4) stop = true;
                                    }}));
  EXPECT_TRUE(result.interrupted);
  ASSERT_EQ(result.methods.size(), 1u);
  EXPECT_GT(result.methods.front().points.size(), 5u);
}

}  // namespace
}  // namespace continuo::studies::converge_test
