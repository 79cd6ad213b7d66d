// Regions of absolute stability against the stability polynomials, the largest stable steps against closed forms and
// runs.
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/simulation/of_model.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/studies/stability.hpp>

namespace continuo::studies::stability_test {
namespace {

// Limits end where a factor exceeds neutral_factor, 1 + 1e-9: beyond the true one by 1e-9 over the slope of |R| there,
// which is at least 1/4 at the crossings below.
constexpr double limit_error = 4e-9;

double real_limit(std::string_view method) {
  return stability_limit(steps_of(method), -1);
}
double imaginary_limit(std::string_view method) {
  return stability_limit(steps_of(method), Complex(0, 1));
}

TEST(Stability, OneStepMethodsMultiplyByTheirPolynomial) {
  const Complex z(-1.2, 0.7);
  EXPECT_NEAR(amplification(steps_of("explicit_euler"), z), std::abs(1.0 + z), 1e-13);
  EXPECT_NEAR(amplification(steps_of("heun"), z), std::abs(1.0 + z + z * z / 2.0), 1e-13);
  EXPECT_NEAR(amplification(steps_of("rk4"), z),
              std::abs(1.0 + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0), 1e-13);
  EXPECT_NEAR(amplification(steps_of("implicit_euler"), z), 1 / std::abs(1.0 - z), 1e-13);
  EXPECT_NEAR(amplification(steps_of("trapezoidal"), z), std::abs((1.0 + z / 2.0) / (1.0 - z / 2.0)), 1e-13);
}

TEST(Stability, AMethodOfTwoStepsHasTheRootsOfItsOwnEquation) {  // (3/2 - z) zeta^2 - 2 zeta + 1/2 = 0
  for (const Complex z : {Complex(-1.2, 0.7), Complex(0.5, 1), Complex(-20, 3)}) {
    const Complex root = std::sqrt(4.0 - 2.0 * (1.5 - z)), below = 2.0 * (1.5 - z);
    EXPECT_NEAR(amplification(steps_of("bdf2"), z),
                std::max(std::abs((2.0 + root) / below), std::abs((2.0 - root) / below)), 1e-9);
  }
}

TEST(Stability, CrossingsOfTheAxesAreTheKnownOnes) {
  EXPECT_NEAR(real_limit("explicit_euler"), 2, limit_error);
  EXPECT_NEAR(real_limit("heun"), 2, limit_error);
  EXPECT_NEAR(real_limit("rk4"), 2.785293563405282, limit_error);  // the real root of 1 + z/2 + z^2/6 + z^3/24
  EXPECT_NEAR(imaginary_limit("rk4"), std::sqrt(8.0), limit_error);
  EXPECT_NEAR(imaginary_limit("bogacki_shampine3"), std::sqrt(3.0), limit_error);
  EXPECT_EQ(imaginary_limit("explicit_euler"), 0);  // |1 + iy| > 1 wherever y is not 0
  EXPECT_EQ(imaginary_limit("heun"), 0);            // |R|^2 = 1 + y^4/4
}

TEST(Stability, OfTheLeapfrogASegment) {
  // In steps of positions h w = 2 (Hairer, Lubich, Wanner, "Geometric Numerical Integration", I.5.1).
  EXPECT_NEAR(imaginary_limit("central_difference"), 2, limit_error);
  EXPECT_NEAR(imaginary_limit("velocity_verlet"), 2, limit_error);
  EXPECT_NEAR(imaginary_limit("semi_implicit_euler"), 2, limit_error);
  // As a two-step scheme, x_(n+1) = x_(n-1) + 2 h f(x_n), its limit is 1: velocities are then between the positions,
  // and two of its steps correspond to one of the others. A method may be any sequence of states: this one is not of
  // the suite.
  const StepSequence leapfrog = [](Complex z, std::size_t steps) {
    std::vector<Complex> y{1, 1.0 + z};
    while (y.size() <= steps) y.push_back(y[y.size() - 2] + 2.0 * z * y.back());
    return y;
  };
  EXPECT_NEAR(stability_limit(leapfrog, Complex(0, 1)), 1, limit_error);
  EXPECT_EQ(stability_limit(leapfrog, -1), 0);
}

TEST(Stability, ImplicitMethodsHaveNoEndOnTheLeft) {
  for (const char* method :
       {"implicit_euler", "trapezoidal", "bdf2", "trbdf2", "radau5", "gauss4", "rodas5p", "newmark"}) {
    EXPECT_TRUE(std::isinf(real_limit(method))) << method;
    for (double angle = 1.6; angle < 3.1; angle += 0.25)
      EXPECT_LE(amplification(steps_of(method), std::polar(7.0, angle)), neutral_factor) << method << " at " << angle;
  }
  const StabilityRegion euler = stability_region(steps_of("implicit_euler"), 80);
  EXPECT_TRUE(euler.outside);
  ASSERT_FALSE(euler.x.empty());
  for (std::size_t i = 0; i < euler.x.size(); ++i) {
    if (std::isnan(euler.x[i])) continue;
    // The circle |1 - z| = 1, from values at the corners of cells 5/79 wide: the error of a line through one, 1/8 of
    // the curvature times the square, and as much from that of ln |R|.
    EXPECT_NEAR(std::hypot(1 - euler.x[i], euler.y[i]), 1, 0.002);
  }
}

TEST(Stability, EveryMethodOfTheSuiteHasAnAnswer) {
  for (const MethodInfo& method : method_catalogue()) {
    if (method.needs_series) continue;  // of which a study has none
    EXPECT_FALSE(std::isnan(imaginary_limit(method.name))) << method.name;
    if (!method.implicit && !method.second_order) {
      EXPECT_GT(real_limit(method.name), 1) << method.name;
    }
  }
}

/// Predicted and observed largest step agree within 1 %: the motion is bounded with 0.99 times the predicted step and
/// grows with 1.01 times. `fixed` are all explicit methods of fixed steps that have a largest step on this model: none
/// is left out.
void expect_confirmed(const std::string& name, const model::Overrides& parameters, const std::set<std::string>& fixed) {
  const auto program = gallery(name);
  const ParametricSystem system = of_model(program, {.parameters = parameters});
  const std::vector<double> start = start_of(program->model, parameters);
  const Spectrum spectrum = spectrum_along(system, {0.0}, {start});
  const Pairing pairing{program->model.pairs, !program->model.accelerations_depend_on_velocities};
  std::set<std::string> confirmed;
  for (const MethodInfo& method : method_catalogue()) {
    if (method.implicit || (method.second_order && pairing.pairs.empty())) continue;
    const StepLimit limit = largest_stable_step(method.name, spectrum);
    if (!(limit.step > 0) || std::isinf(limit.step)) continue;
    const Fate below = fate_of(method.name, system, pairing, 0, start, 0.99 * limit.step, limit.beyond);
    // Some adaptive methods leave |R| = 1 so slowly that a million steps would not tell.
    if (below == Fate::no_run && method.error_order > 0) continue;
    EXPECT_EQ(below, Fate::bounded) << method.name << " below " << limit.step;
    // The number of stages follows the method's own estimate of the spectral radius, which is too large for matrices
    // that are not normal, as that of a damped mass: its steps depend on more than z.
    if (method.name == "rkc2") continue;
    EXPECT_EQ(fate_of(method.name, system, pairing, 0, start, 1.01 * limit.step, limit.beyond), Fate::grows)
        << method.name << " above " << limit.step;
    if (method.error_order == 0) confirmed.insert(std::string(method.name));
  }
  EXPECT_EQ(confirmed, fixed);
}

const std::set<std::string> of_any_system{"explicit_euler", "midpoint", "heun", "rk4", "rk38"};

TEST(Stability, TheLargestStepIsConfirmedForMassSpringDamper) {
  auto methods = of_any_system;
  methods.insert({"semi_implicit_euler", "symplectic_euler_position_first", "central_difference", "velocity_verlet"});
  expect_confirmed("mass_spring_damper", {}, methods);
}
// The compositions are for x'' = a(t, x), without a damper. Then |R| > 1 for every step of the methods of orders 1 and
// 2 for any system: they have no largest step.
TEST(Stability, TheLargestStepIsConfirmedForMassAndSpring) {
  expect_confirmed("mass_spring", {},
                   {"semi_implicit_euler", "symplectic_euler_position_first", "central_difference", "velocity_verlet",
                    "mclachlan_atela4", "yoshida6", "kahan_li8", "rk4", "rk38"});
}
TEST(Stability, TheLargestStepIsConfirmedForRcLadder) {
  expect_confirmed("rc_ladder", {}, of_any_system);
}
TEST(Stability, TheLargestStepIsConfirmedForHeatEquation) {
  expect_confirmed("heat_equation", {}, of_any_system);
}

TEST(Stability, TheLargestStepOfEulerIsThatOfTheClosedForm) {
  const auto limit_of = [](const char* name) {
    const auto program = gallery(name);
    const std::vector<double> start = start_of(program->model);
    return largest_stable_step("explicit_euler", spectrum_along(of_model(program), {0.0}, {start})).step;
  };
  using std::numbers::pi;
  // Eigenvalues -4 D/dx^2 sin(k pi dx/2)^2 and -4/(R C) sin(k pi/(2 N + 2))^2, the fastest with k = N; for a pair
  // -d +- i w explicit Euler needs |1 + h lambda| <= 1: h <= 2 d/|lambda|^2, here d = c/(2 m), |lambda|^2 = k/m.
  EXPECT_NEAR(limit_of("heat_equation"), 2 / (1600 * std::pow(std::sin(19 * pi / 40), 2)), 1e-11);
  EXPECT_NEAR(limit_of("rc_ladder"), 2e-3 / (4 * std::pow(std::sin(8 * pi / 18), 2)), 1e-11);
  // Here |R| grows beyond the limit by 0.045 per unit of h: 1e-9/0.045, on a step of 0.15.
  EXPECT_NEAR(limit_of("mass_spring_damper"), 0.6 / 4, 1e-7);
}

}  // namespace
}  // namespace continuo::studies::stability_test
