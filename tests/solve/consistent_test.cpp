// Systems with algebraic equations start and continue at consistent values, or the failure names the equation that is
// not satisfied.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/solve/steps/consistent.hpp>

namespace continuo::consistent_test {
namespace {

using X = std::array<double, 2>;

/// x' = -z, 0 = z^3 + z - 2 x: at x = 1, z = 1; at x = 5, z = 2.
struct Cubic {
  void operator()(double, const X& x, X& out) const { out = {-x[1], x[1] * x[1] * x[1] + x[1] - 2 * x[0]}; }
  double mass(std::size_t i) const { return i == 0 ? 1 : 0; }
  std::string_view component_name(std::size_t i) const { return i == 0 ? "x" : "z"; }
};

TEST(Consistency, UnknownsAreFoundFromAPoorGuess) {
  for (const double guess : {0.0, 1.0, 50.0, -50.0}) {
    Integrator integrator(Cubic{}, X{5, guess}, {0.0, 1.0}, Bdf{}, {.rtol = 1e-10, .atol = 1e-10});
    // Newton's last correction must be below a hundredth of the tolerance, and convergence is quadratic.
    EXPECT_NEAR(integrator.x()[1], 2, 1e-11) << guess;
    EXPECT_EQ(integrator.x()[0], 5);
  }
}

// At z = 2 the slope is 13; the residual rounds to units of 10.
TEST(Consistency, ForGuardsUnknownsAreSolvedForToRounding) {
  const Tolerance<double> loose{1e-2, 1e-2};
  Cubic system;
  X x{5, 2.02}, close = x;
  ASSERT_TRUE(make_consistent(system, 0.0, x, loose));
  ASSERT_TRUE(make_consistent(system, 0.0, close, loose, SolvedTo::rounding));
  EXPECT_GT(std::abs(x[1] - 2), 1e-12);  // one or two of Newton's corrections
  EXPECT_LT(std::abs(close[1] - 2), 2e-15);
}

TEST(Consistency, IsKeptAlongTheRunAndAfterAnEvent) {
  Options<X> options{.rtol = 1e-8, .atol = 1e-8};
  options.events.push_back(
      rises<X>("refill", [](double t, const X&) { return t - 0.5; }, [](EventAction<X>& action) { action.x[0] = 5; }));
  const auto solution = solve(Cubic{}, X{1, 1}, {0.0, 1.0}, Bdf{}, options);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  bool refilled = false;
  for (std::size_t i = 0; i < solution.t.size(); ++i) {
    const X& x = solution.x[i];
    EXPECT_NEAR(x[1] * x[1] * x[1] + x[1] - 2 * x[0], 0, 30e-8 * (1 + 3 * x[1] * x[1] + 2 * x[0]));
    refilled = refilled || (x[0] == 5 && std::abs(x[1] - 2) < 1e-7);
  }
  EXPECT_TRUE(refilled);
}

// 0 = p - z - Is (exp(z / 0.05) - 1): a source p = x and a diode. Where p jumps from -3 to 10, z goes from -3 to 0.8,
// and the scale of a correction, 1 + |z|, decreases on the way.
TEST(Consistency, ADiodeIsSwitchedOnFromFarBelow) {
  struct Diode : Cubic {
    static double current(double z) { return 1e-6 * (std::exp(z / 0.05) - 1); }
    void operator()(double, const X& x, X& out) const { out = {0, x[0] - x[1] - current(x[1])}; }
  };
  for (const double from : {-100.0, -3.0, -1.0, 0.0, 5.0}) {
    Options<X> options{.rtol = 1e-8, .atol = 1e-8};
    options.events.push_back(at<X>("jump", {0.5}, [](EventAction<X>& now) { now.x[0] = 10; }));
    const auto solution = solve(Diode{}, X{from, 0}, {0.0, 1.0}, Bdf{}, options);
    ASSERT_TRUE(solution.outcome) << from << ": " << describe(solution.outcome);
    const double z = solution.final_state()[1], slope = 1 + (Diode::current(z) + 1e-6) / 0.05;
    EXPECT_NEAR((10 - z - Diode::current(z)) / slope, 0, 1e-8 * (1 + z)) << from;
  }
}

TEST(Consistency, AContradictionIsNamed) {
  // 0 = z^2 + x has no real solution at x = 1.
  struct None : Cubic {
    void operator()(double, const X& x, X& out) const { out = {-x[1], x[1] * x[1] + x[0]}; }
  };
  const auto solution = solve(None{}, X{1, 3}, {0.0, 1.0}, Bdf{}, {});
  EXPECT_EQ(solution.outcome.ending, Ending::nonlinear_solve_failed);
  EXPECT_EQ(solution.outcome.component, "z");
  EXPECT_NE(solution.outcome.hint.find("no values of the unknowns"), std::string::npos) << solution.outcome.hint;
}

TEST(Consistency, AnUnknownInNoEquationIsNamed) {
  struct Missing : Cubic {
    void operator()(double, const X& x, X& out) const { out = {-x[1], x[0] - 1 + 0 * x[1]}; }
  };
  const auto solution = solve(Missing{}, X{1, 3}, {0.0, 1.0}, Bdf{}, {});
  EXPECT_EQ(solution.outcome.ending, Ending::nonlinear_solve_failed);
  EXPECT_NE(solution.outcome.hint.find("index is above 1"), std::string::npos) << solution.outcome.hint;
}

TEST(Consistency, ExplicitMethodsDeclineAMass) {
  const auto solution = solve(Cubic{}, X{1, 1}, {0.0, 1.0}, Tsitouras5{}, {});
  EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
  EXPECT_NE(solution.outcome.hint.find("implicit"), std::string::npos);
}

}  // namespace
}  // namespace continuo::consistent_test
