// Observed orders of every method, and where rounding ends them.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/model/load.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/studies/converge.hpp>
#include <continuo/studies/difference_schemes.hpp>

namespace continuo::studies {
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

// With fixed steps the methods of variable order keep one: Adams' starts with order 1, whose first steps leave order 3
// (adams.hpp); Radau's stays at the order it begins with, BDF
// rises to 2.
int order_with_fixed_steps(const MethodInfo& method) {
  static const std::map<std::string_view, int> kept{{"adams", 3}, {"radau", 5}, {"bdf", 2}};
  const auto found = kept.find(method.name);
  return found == kept.end() ? method.order : found->second;
}

TEST(Converge, EveryMethodHasItsOrder) {
  const ConvergenceProblem growth = logistic(), circle = planet(0, 8), ellipse = planet(0.5625, 16);
  for (const MethodInfo& method : method_catalogue()) {
    // Two methods show their order late, on a problem where errors are still well above rounding then: of verner7 the
    // coefficients of the next terms are the larger ones, of dprkn12 eight steps of the circle leave 1e-9.
    const bool late = method.name == "verner7" || method.name.starts_with("dprkn12");
    const ConvergenceProblem& problem = late ? ellipse : method.second_order ? circle : growth;
    const Convergence result =
        converge(problem, {.methods = {std::string(method.name)}, .most_steps = 4096, .in_long_double = true});
    const ErrorCurve& observed = result.methods.front().in_long_double;
    ASSERT_TRUE(observed.found) << method.name;
    EXPECT_NEAR(observed.order, order_with_fixed_steps(method), 0.15) << method.name;
  }
}

TEST(Converge, TheLocalErrorIsOneOrderHigher) {
  for (const char* name : {"explicit_euler", "heun", "rk4", "implicit_euler", "trapezoidal", "velocity_verlet"}) {
    const Convergence result = converge(planet(0.5625, 8), {.methods = {name}, .most_steps = 4096});
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
  const Convergence result = converge(stiff, {.methods = {"explicit_euler"}, .most_steps = 4096});
  ASSERT_EQ(result.problem, "");
  const auto& points = result.methods.front().points;
  for (const StepErrors& point : points) {
    EXPECT_LT(point.local, 10 * point.step);  // every single step is good, (20000 h^2/2 would be an upper bound of it)
    EXPECT_FALSE(point.global < 1) << point.step;  // h > 2/20000: the run is not
  }
}

TEST(Converge, RoundingEndsItWhereItShould) {
  // The least error lies between what steps rounded at random and what steps rounded all one way leave, as far as eight
  // stations tell: two grid steps, sqrt(2) each, to either side; the constant of the slope has its own error.
  for (const char* name : {"rk4", "heun", "bogacki_shampine3", "mclachlan_atela4"}) {
    const Convergence result = converge(planet(0.5625, 8), {.methods = {name}, .in_float = true});
    const MethodConvergence& found = result.methods.front();
    ASSERT_TRUE(found.floor_in_float) << name;
    ASSERT_TRUE(found.in_float.floor_reached) << name;
    EXPECT_GT(found.in_float.best_step, found.floor_in_float->at_random.step / 2) << name;
    EXPECT_LT(found.in_float.best_step, found.floor_in_float->at_worst.step * 2) << name;
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
    // Steps are powers of 2, and rounding is what is predicted or, by chance, less: then smaller steps still gain.
    EXPECT_GT(errors.of_double.best_step, errors.predicted.step / 8) << errors.scheme.name;
    EXPECT_LT(errors.of_double.best_step, errors.predicted.step * 4) << errors.scheme.name;
    EXPECT_LT(errors.of_double.least_error, 2 * errors.predicted.error) << errors.scheme.name;
    EXPECT_GT(errors.of_float.best_step, errors.predicted_in_float.step / 8) << errors.scheme.name;
    EXPECT_LT(errors.of_float.best_step, errors.predicted_in_float.step * 4) << errors.scheme.name;
  }
}

std::shared_ptr<const model::ModelProgram> program_of(const char* text) {
  const model::Loaded loaded = model::load(model::Source("test.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return model::compile(*loaded.model);
}

TEST(Converge, AModelIsStudiedInAllNumbers) {
  const auto program = program_of("x'' = -4*x\nx(0) = 1;  x'(0) = 0\nenergy e = 1/2*x'^2 + 2*x^2\nrun 0..3\n");
  const Convergence result =
      converge(program, {},
               {.methods = {"rk4", "velocity_verlet"}, .most_steps = 4096, .in_float = true, .in_long_double = true});
  ASSERT_EQ(result.problem, "");
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
  const Convergence result = converge(program, {}, {.methods = {"explicit_euler"}, .most_steps = 2048});
  ASSERT_EQ(result.problem, "");
  EXPECT_NEAR(result.methods.front().global.order, 1, 0.15);
  EXPECT_TRUE(std::isnan(result.methods.front().points.front().local));
}

TEST(Converge, TolerancesAreStudiedLikeSteps) {
  const Convergence result = converge(planet(0.5625, 8), {.methods = {"adams", "bdf", "radau", "rk4"},
                                                          .tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}});
  ASSERT_EQ(result.methods.size(), 4u);
  for (int k = 0; k < 3; ++k) {  // a tenth of the tolerance: near a tenth of the error, on the whole
    const auto& points = result.methods[static_cast<std::size_t>(k)].points;
    ASSERT_EQ(points.size(), 6u);
    EXPECT_LT(points.back().global, 1e-3 * points.front().global) << result.methods[static_cast<std::size_t>(k)].method;
  }
  EXPECT_NE(result.methods[3].problem, "");  // no step control
}

TEST(Converge, AnInterruptKeepsWhatIsThere) {
  std::atomic<bool> stop = false;
  const Convergence result =
      converge(logistic(), {.methods = {"rk4", "heun"}, .interrupt = &stop, .progress = [&](double part) {
                              if (part > 0.4) stop = true;
                            }});
  EXPECT_TRUE(result.interrupted);
  ASSERT_EQ(result.methods.size(), 1u);
  EXPECT_GT(result.methods.front().points.size(), 5u);
}

}  // namespace
}  // namespace continuo::studies
