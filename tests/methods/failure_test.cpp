// Failures in a step of an implicit method, for every family: the run continues if it can, else ends with the outcome
// of that name, a hint, and everything that was computed before.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "any_motion.hpp"
#include <continuo/methods/all.hpp>
#include <continuo/methods/multistep/bdf_krylov.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::failure_test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using X = std::array<double, 2>;
using Rows = std::array<double, 4>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Any right-hand side with any Jacobian, so that each method is compiled once.
struct Anything {
  std::function<X(double, const X&)> f;
  std::function<Rows(double, const X&)> slopes;
  X masses{1, 1};

  void operator()(double t, const X& x, X& dxdt) const { dxdt = f(t, x); }
  void jacobian(double t, const X& x, std::span<double> rows) const { std::ranges::copy(slopes(t, x), rows.begin()); }
  double mass(std::size_t i) const { return masses[i]; }
};

/// A method with what its failures depend on: the tests are compiled once for all methods.
struct Solver {
  std::string_view name;
  int order;
  bool adaptive, without_matrix, rings;
  AnyMethod<Anything, X> method;
};
template <class M>
Solver solver() {
  return {.name = M::name,
          .order = M::order,
          .adaptive = M::error_order > 0,
          .without_matrix = std::same_as<M, BdfKrylov>,
          // Stable for every stiff equation, but fast components are not damped.
          .rings = std::same_as<M, Gauss4>,
          .method = any_method<M, Anything, X>()};
}
void PrintTo(const Solver& one, std::ostream* out) {
  *out << one.name;
}

class Failure : public ::testing::TestWithParam<Solver> {
 protected:
  static constexpr double step = 1e-3;  // of methods without adaptive steps
  const bool adaptive = GetParam().adaptive, without_matrix = GetParam().without_matrix, rings = GetParam().rings;

  // A method of order 1 takes 1 / rtol steps, so its tolerance is lower here.
  const double rtol = GetParam().order == 1 ? 1e-3 : 1e-6;

  /// The error of each step is at most the tolerance, and these equations amplify no error, so errors add up. Error
  /// estimates are inexact by some factor: these tests allow 30 tolerances everywhere. With a fixed step: h/2, as for
  /// Euler.
  double allowed(const Solution<X>& solution) const {
    return adaptive ? rtol * std::max(30.0, static_cast<double>(solution.statistics.steps)) : step / 2;
  }

  Solution<X> run(const Anything& system, const X& start, double end, std::size_t max_steps = 20000) const {
    if (GetParam().order == 1) max_steps = 1'000'000;
    Options<X> options{.rtol = rtol, .atol = rtol * 1e-3, .max_steps = max_steps};
    if (!adaptive) options.step = step;
    const Solution<X> solution = solve(system, start, {0.0, end}, GetParam().method, options);
    // Every step is saved, and no state is NaN or infinite.
    EXPECT_EQ(solution.t.size(), solution.statistics.steps + 1);
    EXPECT_EQ(solution.t.back(), solution.outcome.t);
    for (const X& x : solution.x) EXPECT_TRUE(std::isfinite(x[0]) && std::isfinite(x[1]));
    EXPECT_TRUE(solution.outcome || !solution.outcome.hint.empty()) << describe(solution.outcome);
    return solution;
  }
};

template <class List>
struct TypesOf;
template <class... M>
struct TypesOf<std::tuple<M...>> {
  using type = ::testing::Types<M...>;
};
// Of the pairs, those for any system.
template <class... M>
constexpr auto for_any_system(std::tuple<M...>) {
  return std::tuple_cat(std::conditional_t<M::second_order, std::tuple<>, std::tuple<M>>{}...);
}
using Solving =
    decltype(std::tuple_cat(std::tuple<ImplicitEuler, Trapezoidal, ImplicitMidpoint, Bdf2, TrBdf2, KenCarp4, Kvaerno5,
                                       Rosenbrock23, Rodas4, Rodas5P, Gauss4, Radau5, Radau, Bdf, BdfKrylov, Seulex>{},
                            for_any_system(AutomaticMethods{})));
struct NameOfMethod {
  template <class M>
  static std::string GetName(int) {
    return std::string(M::name);
  }
};
std::vector<Solver> solvers() {
  std::vector<Solver> all;
  for_each_method<Solving>([&]<class M>() { all.push_back(solver<M>()); });
  return all;
}
INSTANTIATE_TEST_SUITE_P(Each, Failure, ::testing::ValuesIn(solvers()),
                         [](const auto& test) { return std::string(test.param.name); });

// x' = z, 0 = z^2 + t - 1: z = sqrt(1 - t), and beyond t = 1 there is none.
TEST_P(Failure, NewtonDivergesWhereTheSolutionEnds) {
  const Anything system{[](double t, const X& x) { return X{x[1], x[1] * x[1] + t - 1}; },
                        [](double, const X& x) { return Rows{0, 1, 0, 2 * x[1]}; },
                        {1, 0}};
  const auto solution = run(system, {0, 1}, 2);
  EXPECT_FALSE(solution.outcome);
  if (rings) return;  // its algebraic components are not those of the equations (docs/methods.md)
  const bool newton = solution.outcome.ending == Ending::nonlinear_solve_failed;
  // The error estimate may reject a step before its iteration fails: that of a predictor, that of Rosenbrock's methods,
  // which do not iterate, and any where z is so near 0 that a unit in the last place of t moves it by more than a
  // tolerance.
  EXPECT_TRUE(newton || (adaptive && solution.outcome.ending == Ending::step_too_small)) << describe(solution.outcome);
  EXPECT_THAT(solution.outcome.hint, AnyOf(HasSubstr("Newton's iteration does not converge"), HasSubstr("singular")));
  EXPECT_NEAR(solution.outcome.t, 1, adaptive ? 1e-5 : 2 * step);
  // x = 2/3 (1 - (1 - t)^(3/2)).
  EXPECT_NEAR(solution.final_state()[0], 2.0 / 3.0, allowed(solution));
}

// An algebraic equation that does not contain its unknown.
TEST_P(Failure, ASingularMatrixIsNamedWithItsUnknown) {
  const Anything system{[](double t, const X& x) { return X{-x[0], t - x[0]}; },
                        [](double, const X&) { return Rows{-1, 0, -1, 0}; },
                        {1, 0}};
  const auto solution = run(system, {0, 1}, 1);
  EXPECT_EQ(solution.outcome.ending, Ending::nonlinear_solve_failed) << describe(solution.outcome);
  EXPECT_EQ(solution.outcome.component, "x[1]");
  EXPECT_THAT(solution.outcome.hint, HasSubstr("index"));
}

// 0 = z^2 + x has no real solution at x = 1.
TEST_P(Failure, StartValuesThatCannotBeMadeConsistentAreNamed) {
  const Anything system{[](double, const X& x) { return X{-x[1], x[1] * x[1] + x[0]}; },
                        [](double, const X& x) { return Rows{0, -1, 1, 2 * x[1]}; },
                        {1, 0}};
  const auto solution = run(system, {1, 3}, 1);
  EXPECT_EQ(solution.outcome.ending, Ending::nonlinear_solve_failed) << describe(solution.outcome);
  EXPECT_EQ(solution.outcome.t, 0);
  EXPECT_EQ(solution.outcome.component, "x[1]");
  EXPECT_THAT(solution.outcome.hint, HasSubstr("no values of the unknowns"));
}

TEST_P(Failure, NoNumberInFEndsTheRunWhereItBegins) {
  const Anything system{[](double t, const X& x) { return X{-x[0], t < 1 ? -1000 * x[1] : nan}; },
                        [](double, const X&) { return Rows{-1, 0, 0, -1000}; }};
  const auto solution = run(system, {1, 1}, 2);
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite) << describe(solution.outcome);
  // A method whose last stage lies within its step may end a little beyond.
  EXPECT_NEAR(solution.outcome.t, 1, rings ? 1e-2 : adaptive ? 1e-7 : 2 * step);
  if (rings) return;
  EXPECT_NEAR(solution.final_state()[0], std::exp(-solution.outcome.t), allowed(solution));
}

TEST_P(Failure, NoNumberInTheJacobianEndsByNameOrDoesNotMatter) {
  const Anything system{[](double, const X& x) { return X{-x[0], -1000 * x[1]}; },
                        [](double, const X&) { return Rows{-1, 0, 0, nan}; }};
  const auto solution = run(system, {1, 1}, 2);
  if (without_matrix) {
    EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  } else {
    EXPECT_EQ(solution.outcome.ending, Ending::not_finite) << describe(solution.outcome);
    EXPECT_THAT(solution.outcome.hint, HasSubstr("Jacobian"));
  }
}

// x' = -1000 (x -+ 1): from 1 towards -1 from t = 0.4321 on.
TEST_P(Failure, AJumpOfFIsPassed) {
  const Anything system{[](double t, const X& x) { return X{-x[0], -1000 * (x[1] - (t < 0.4321 ? 1 : -1))}; },
                        [](double, const X&) { return Rows{-1, 0, 0, -1000}; }};
  const auto solution = run(system, {1, 1}, 1);
  EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution.final_state()[0], std::exp(-1.0), allowed(solution));
  if (rings) return;
  EXPECT_NEAR(solution.final_state()[1], -1, 30 * rtol);
}

// A relay that holds x at 0: f has no value there at which the equations of a step have a solution.
TEST_P(Failure, ARelayThatChattersEndsByName) {
  const Anything system{[](double, const X& x) { return X{-x[0], x[1] < 0 ? 1000.0 : -1000.0}; },
                        [](double, const X&) { return Rows{-1, 0, 0, 0}; }};
  const auto solution = run(system, {1, 1}, 1);
  EXPECT_FALSE(solution.outcome);
  EXPECT_THAT(solution.outcome.hint, AnyOf(HasSubstr("jump"), HasSubstr("max_steps")));
  EXPECT_NEAR(solution.final_state()[1], 0, 1);  // it does not fly off
}

// x' = x^2 from 1: x = 1/(1 - t).
TEST_P(Failure, ABlowUpEndsAtItsSingularity) {
  const Anything system{[](double, const X& x) { return X{x[0] * x[0], -1000 * x[1]}; },
                        [](double, const X& x) { return Rows{2 * x[0], 0, 0, -1000}; }};
  const auto solution = run(system, {1, 1}, 2, 1'000'000);
  const Ending ending = solution.outcome.ending;
  EXPECT_TRUE(ending == Ending::step_too_small || ending == Ending::not_finite ||
              ending == Ending::nonlinear_solve_failed)
      << describe(solution.outcome);
  EXPECT_THAT(solution.outcome.hint,
              AnyOf(HasSubstr("singular"), HasSubstr("without bound"), HasSubstr("smaller step")));
  // The computed singularity is that of a solution within the tolerance: a relative error of x is an equal relative
  // error of the distance to the singularity, and errors add up over the steps, of which implicit Euler takes the most.
  EXPECT_NEAR(solution.outcome.t, 1, adaptive ? std::max(1e-3, 30 * rtol) : 5 * step);
  EXPECT_GT(solution.final_state()[0], 100);
}

// The sign of an entry is lost: the iteration converges slowly or for small steps alone, never to something else.
TEST_P(Failure, AWrongJacobianCostsStepsNotAccuracy) {
  const Anything system{[](double, const X& x) { return X{-x[0], -100 * x[1] * x[1] * x[1]}; },
                        [](double, const X& x) { return Rows{-1, 0, 0, 300 * x[1] * x[1]}; }};
  const auto solution = run(system, {1, 1}, 0.5);
  if (!solution.outcome) {
    EXPECT_FALSE(adaptive) << describe(solution.outcome);
    EXPECT_EQ(solution.outcome.ending, Ending::nonlinear_solve_failed);
    return;
  }
  // x = 1/sqrt(1 + 200 t).
  EXPECT_NEAR(solution.final_state()[1], 1 / std::sqrt(101.0), allowed(solution));
}

template <class M>
class StructuralFailure : public ::testing::Test {};
TYPED_TEST_SUITE(StructuralFailure, TypesOf<StructuralMethods>::type, NameOfMethod);

TYPED_TEST(StructuralFailure, NoNumberInFEndsTheRunWhereItBegins) {
  const testing::AnyMotion<double> mass{[](double t, double q, double v) { return t < 1 ? -100 * q - v : nan; }};
  const auto solution = solve(mass, X{1, 0}, {0.0, 2.0}, TypeParam{}, {.step = 1e-3});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite) << describe(solution.outcome);
  EXPECT_NEAR(solution.outcome.t, 1, 2e-3);
  for (const X& x : solution.x) EXPECT_TRUE(std::isfinite(x[0]) && std::isfinite(x[1]));
  EXPECT_FALSE(solution.outcome.hint.empty());
}

TYPED_TEST(StructuralFailure, AJumpOfFIsPassed) {
  const testing::AnyMotion<double> mass{[](double t, double q, double v) { return t < 1 ? -100 * q - v : 10; }};
  const auto solution = solve(mass, X{0, 0}, {0.0, 2.0}, TypeParam{}, {.step = 1e-3});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution.final_state()[0], 5, 1e-2);  // 10 t^2/2 from t = 1, which a step of 0.001 may miss by itself
}

}  // namespace
}  // namespace continuo::failure_test
