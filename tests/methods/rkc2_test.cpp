// Runge-Kutta-Chebyshev: its order, the extent of its stability region, the heat equation without a linear system.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "stiff_promises.hpp"
#include <continuo/methods/explicit_rk/rkc2.hpp>

namespace continuo::rkc2_test {
namespace {

using testing::AnySystem, testing::Two;

/// R(-z): one step of x' = -z x from 1 with h = 1.
double growth(std::size_t stages, double z) {
  const auto f = [z](double, const std::array<double, 1>& x) { return std::array{-z * x[0]}; };
  std::array<double, 1> x{1}, x_new{};
  auto work = Rkc2::workspace(x);
  evaluate(f, 0.0, x, work.start);
  Rkc2::advance(f, 0.0, x, 1.0, stages, work, x_new);
  return x_new[0];
}

// Sommeijer, Shampine & Verwer: 2/3 (s^2 - 1) (1 - 2/15 eps) with the damping eps = 2/13, 0.653 (s^2 - 1); more for few
// stages. Within, the polynomial is damped; beyond, it leaves 1 like a Chebyshev polynomial.
TEST(Rkc2, IsStableAsFarAsTheTheorySaysAndNoFurther) {
  for (const std::size_t s : {2U, 3U, 5U, 10U, 20U, 50U, 200U}) {
    const double square = static_cast<double>(s * s - 1);
    EXPECT_GT(0.68 * square, Rkc2::reach<double>(s));
    EXPECT_LT(0.64 * square, Rkc2::reach<double>(s));
    for (int i = 1; i <= 1000; ++i) {
      EXPECT_LT(std::abs(growth(s, Rkc2::reach<double>(s) * i / 1000)), 1) << s << ' ' << i;
    }
    if (s >= 10) {
      EXPECT_GT(std::abs(growth(s, 0.66 * square)), 1) << s;
    }
    EXPECT_LE(Rkc2::stages_for(Rkc2::reach<double>(s) * 0.999, std::size_t{1000}), s);
  }
}

// exp(-z) = 1 - z + z^2/2 - O(z^3), for every number of stages: halving z divides the error by 8 (between 7 and 9).
TEST(Rkc2, IsOfOrderTwoForEveryNumberOfStages) {
  for (const std::size_t s : {2U, 3U, 4U, 7U, 15U, 40U}) {
    const auto error = [s](double z) { return std::abs(growth(s, z) - std::exp(-z)); };
    EXPECT_NEAR(error(0.02) / error(0.01), 8, 1) << s;
  }
}

// The same with t in f and a nonlinear f: x' = 2 t x^2 from 1 at 0 is 1 / (1 - t^2).
TEST(Rkc2, StagesLieAtTheirTimes) {
  const AnySystem<Two> f{
      .f = [](double t, const Two& x, Two& out) { out = {2 * t * x[0] * x[0], 2 * t * x[1] * x[1]}; }};
  const auto error = [&](double h) {
    const auto solution = solve(f, Two{1, 1}, {0.0, 0.5}, Rkc2{}, {.step = h});
    return std::abs(solution.final_state()[0] - 1 / 0.75);
  };
  EXPECT_NEAR(error(0.01) / error(0.005), 4, 0.2);
}

TEST(Rkc2, DenseOutputIsOfOrderTwoToo) {
  const AnySystem<Two> f{.f = [](double, const Two& x, Two& out) { out = {x[1], -x[0]}; }};
  const auto error = [&](double h) {
    Integrator integrator(f, Two{0, 1}, {0.0, 1.0}, Rkc2{}, {.step = h});
    double worst = 0;
    std::array<double, 2> x{};
    while (integrator.advance()) {
      for (const double theta : {0.25, 0.5, 0.75}) {
        integrator.interpolant()(theta, x);
        worst = std::max(worst, std::abs(x[0] - std::sin(integrator.step_begin() + theta * integrator.step_size())));
      }
    }
    return worst;
  };
  EXPECT_NEAR(error(0.02) / error(0.01), 4, 0.3);
}

/// The heat equation between two ends at 0. The mode sin(k pi x) of the discrete equation decays with
/// 4/dx^2 sin^2(k pi dx / 2), the spectral radius is below 4/dx^2.
struct Heat {
  std::size_t nodes;

  double dx() const { return 1.0 / static_cast<double>(nodes + 1); }
  void operator()(double, const std::vector<double>& u, std::vector<double>& dudt) const {
    for (std::size_t i = 0; i < nodes; ++i) {
      const double left = i > 0 ? u[i - 1] : 0, right = i + 1 < nodes ? u[i + 1] : 0;
      dudt[i] = (left - 2 * u[i] + right) / (dx() * dx());
    }
  }
  /// Modes 1 and 5.
  std::vector<double> exact(double t) const {
    std::vector<double> u(nodes, 0);
    for (const int k : {1, 5}) {
      const double rate = 4 / (dx() * dx()) * std::pow(std::sin(k * M_PI * dx() / 2), 2);
      for (std::size_t i = 0; i < nodes; ++i)
        u[i] += std::exp(-rate * t) * std::sin(k * M_PI * dx() * static_cast<double>(i + 1));
    }
    return u;
  }
};

TEST(Rkc2, SolvesTheHeatEquationToItsTolerance) {
  const Heat heat{200};
  for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
    const auto solution = solve(testing::any_system<std::vector<double>>(heat), heat.exact(0), {0.0, 0.3}, Rkc2{},
                                {.rtol = tolerance, .atol = tolerance});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    const auto exact = heat.exact(0.3);
    for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(solution.final_state()[i], exact[i], 30 * tolerance);
    // An explicit method of two stages needs 0.3 * 4 * 201^2 / 2 = 24241 steps of two evaluations for its stability
    // alone. At the strictest tolerance here accuracy determines the number of steps, in proportion to 1 /
    // sqrt(tolerance).
    EXPECT_LT(solution.statistics.evaluations, tolerance < 1e-6 ? 2 * 24241U : 7000U);
  }
}

TEST(Rkc2, EstimatesTheSpectralRadiusFromAboveAndTakesAGivenOne) {
  const Heat heat{50};
  auto x = heat.exact(0), fx = x;
  SpectralRadius<std::vector<double>> spectrum(x);
  heat(0, x, fx);
  int evaluations = 0;
  const double greatest = 4 / (heat.dx() * heat.dx()) * std::pow(std::cos(M_PI * heat.dx() / 2), 2);
  const double radius = spectrum.estimate(heat, 0.0, x, fx, evaluations);
  EXPECT_GT(radius, greatest);
  EXPECT_LT(radius, 1.21 * greatest);  // the margin

  struct Given : Heat {
    double spectral_radius(double, const std::vector<double>&) const { return 4 / (dx() * dx()); }
  };
  const auto with = solve(Given{heat}, heat.exact(0), {0.0, 0.3}, Rkc2{}, {.rtol = 1e-5, .atol = 1e-5});
  const auto without = solve(testing::any_system<std::vector<double>>(heat), heat.exact(0), {0.0, 0.3}, Rkc2{},
                             {.rtol = 1e-5, .atol = 1e-5});
  ASSERT_TRUE(with.outcome);
  EXPECT_LT(with.statistics.evaluations, without.statistics.evaluations);
}

TEST(Rkc2, ACopyGoesOnToTheSameBits) {
  const Heat heat{40};
  promises::expect_copy_goes_on_to_the_same_bits<Rkc2>(testing::any_system<std::vector<double>>(heat), heat.exact(0),
                                                       0.3);
}

TEST(Rkc2, WhatIsNotFiniteEndsByName) {
  promises::expect_not_finite_ends_by_name<Rkc2>();
}

}  // namespace
}  // namespace continuo::rkc2_test
