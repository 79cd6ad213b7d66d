// Equilibria, eigenvalues and modes against closed forms.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/equilibrium.hpp>

namespace continuo::studies::equilibrium_test {
namespace {

TEST(Equilibrium, LorenzRestsAtThreePoints) {
  const double rho = 28, beta = 8.0 / 3, side = std::sqrt(beta * (rho - 1));
  const auto found = find_equilibria(lorenz(rho), {.low = {-20, -20, -10}, .high = {20, 20, 40}});
  ASSERT_EQ(found.equilibria.size(), 3u);
  EXPECT_EQ(found.searches, found.arrived);
  for (const double sign : {-1.0, 1.0}) {
    const Equilibrium& e = found.equilibria[sign < 0 ? 0 : 2];
    EXPECT_NEAR(e.x[0], sign * side, 1e-12);
    EXPECT_NEAR(e.x[1], sign * side, 1e-12);
    EXPECT_NEAR(e.x[2], rho - 1, 1e-12);
    EXPECT_EQ(e.stability, Stability::saddle);  // a real eigenvalue on the left, a pair on the right
  }
  const Equilibrium& origin = found.equilibria[1];
  const double root = std::sqrt(81 + 40 * rho);  // (sigma - 1)^2 + 4 sigma rho
  // By central differences: an error of h^2 f'''/6 (0 here) and of rounding, 1e-16 40 / 6e-6.
  EXPECT_NEAR(origin.eigenvalues[0].real(), (-11 + root) / 2, 1e-8);
  EXPECT_NEAR(origin.eigenvalues[1].real(), -beta, 1e-8);
  EXPECT_NEAR(origin.eigenvalues[2].real(), (-11 - root) / 2, 1e-8);
}

TEST(Equilibrium, HopfPointOfLorenzIsWhereThePairCrosses) {  // rho = sigma (sigma + beta + 3) / (sigma - beta - 1)
  const double hopf = 10 * (10 + 8.0 / 3 + 3) / (10 - 8.0 / 3 - 1);
  for (const double rho : {hopf - 0.01, hopf + 0.01}) {
    const double side = std::sqrt(8.0 / 3 * (rho - 1));
    const auto e = describe_equilibrium(lorenz(rho), {side, side, rho - 1}, lorenz(rho).constants);
    EXPECT_EQ(e.stability, rho < hopf ? Stability::asymptotically_stable : Stability::saddle);
  }
}

TEST(Equilibrium, NoneIsSaidWithTheNearestPlace) {  // x' = x^2 + 1
  const auto system =
      parametric_system(1, [](double, Values x, Values, std::span<double> f) { f[0] = x[0] * x[0] + 1; });
  const auto found = find_equilibria(system, {.low = {-5}, .high = {5}, .starts = 20});
  EXPECT_TRUE(found.equilibria.empty());
  EXPECT_EQ(found.arrived, 0u);
  EXPECT_GE(found.nearest.residual, 1);
  EXPECT_LT(found.nearest.residual, 2);
}

TEST(Equilibrium, ADoubleRootIsFoundAndSaidNotToBeIsolated) {  // x' = (x - 1)^2, y' = -y
  const auto f = [](double, Values x, Values, std::span<double> out) {
    out[0] = (x[0] - 1) * (x[0] - 1), out[1] = -x[1];
  };
  const auto search = find_equilibrium(parametric_system(2, f), {3, 2}, {});
  EXPECT_EQ(search.ending, EquilibriumEnding::found);
  EXPECT_NEAR(search.x[0], 1, 1e-6);  // f is below rounding of its parts from here on
  EXPECT_FALSE(describe_equilibrium(parametric_system(2, f), {1, 0}, {}).isolated);
}

TEST(Equilibrium, ASingularJacobianIsNoRest) {  // h' = v, v' = -9.8: free fall
  const auto f = [](double, Values x, Values, std::span<double> out) { out[0] = x[1], out[1] = -9.8; };
  const auto search = find_equilibrium(parametric_system(2, f), {10, 0}, {});
  EXPECT_NE(search.ending, EquilibriumEnding::found);
  EXPECT_EQ(search.worst, 1u);
  EXPECT_EQ(search.residual, 9.8);
}

TEST(Equilibrium, NotFinite) {
  const auto f = [](double, Values x, Values, std::span<double> out) { out[0] = std::log(x[0]); };
  EXPECT_EQ(find_equilibrium(parametric_system(1, f), {-1}, {}).ending, EquilibriumEnding::not_finite);
  const auto search = find_equilibrium(parametric_system(1, f), {5}, {});  // Newton from 5 would leap below 0
  EXPECT_EQ(search.ending, EquilibriumEnding::found);
  EXPECT_NEAR(search.x[0], 1, 1e-15);
}

// x' = z - 2x + p, y' = -y w, 0 = z + x + y, 0 = w - 1 - z^2: written out z = -x - y, w = 1 + (x + y)^2.
TEST(Equilibrium, UnknownsOfAlgebraicEquationsAreTakenOut) {
  const auto dae = [](double, Values x, Values p, std::span<double> f) {
    f[0] = x[2] - 2 * x[0] + p[0];
    f[1] = -x[1] * x[3];
    f[2] = x[2] + x[0] + x[1];
    f[3] = x[3] - 1 - x[2] * x[2];
  };
  const auto ode = [](double, Values x, Values p, std::span<double> f) {
    f[0] = -3 * x[0] - x[1] + p[0];
    f[1] = -x[1] * (1 + (x[0] + x[1]) * (x[0] + x[1]));
  };
  ParametricSystem with = parametric_system(4, dae, {6});
  with.algebraic = 2;
  const ParametricSystem without = parametric_system(2, ode, {6});
  const auto found = find_equilibria(with, {.low = {-5, -5, -5, -5}, .high = {5, 5, 5, 9}, .starts = 20});
  ASSERT_EQ(found.equilibria.size(), 1u);  // x = 2, y = 0
  const Equilibrium& rest = found.equilibria[0];
  EXPECT_NEAR(rest.x[0], 2, 1e-12);
  EXPECT_NEAR(rest.x[3], 5, 1e-12);
  ASSERT_EQ(rest.eigenvalues.size(), 2u);
  EXPECT_NEAR(rest.eigenvalues[0].real(), -3, 1e-8);  // by differences
  EXPECT_NEAR(rest.eigenvalues[1].real(), -5, 1e-8);
  const std::vector<double> x{0.3, -0.7, 0.4, 1.16}, p{6};
  const auto a = linearize(with, x, p), b = linearize(without, std::span(x).first(2), p);
  ASSERT_EQ(a.states, 2u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(a.a[k], b.a[k], 1e-8);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(a.b[k], b.b[k], 1e-8);
  const auto unknowns = find_unknowns(with, {0.3, -0.7, 5, 5}, p);
  EXPECT_EQ(unknowns.ending, EquilibriumEnding::found);
  EXPECT_NEAR(unknowns.x[2], 0.4, 1e-14);
  EXPECT_NEAR(unknowns.x[3], 1.16, 1e-14);
}

TEST(Equilibrium, WhatAlgebraicEquationsLeaveOpenIsNamed) {  // 0 = x - 1 - z^2 at z = 0; the other equation is regular
  const auto f = [](double, Values x, Values, std::span<double> out) {
    out[0] = -x[0] + 1 + x[1];
    out[1] = x[2] - 3;
    out[2] = x[0] - 1 - x[1] * x[1];
  };
  ParametricSystem system = parametric_system(3, f);
  system.algebraic = 2;
  system.names = {"x", "z", "w"};
  // z is the first unknown, its equation the last.
  const auto rest = describe_equilibrium(system, {1, 0, 3}, {});
  EXPECT_EQ(rest.undetermined.unknowns, std::vector<std::size_t>{0});
  EXPECT_EQ(rest.undetermined.equations, std::vector<std::size_t>{1});
  EXPECT_TRUE(rest.eigenvalues.empty());
  EXPECT_EQ(rest.stability, Stability::undecided);
  // The same equation twice, in different units: either may be left out.
  const std::vector<double> square{1, 2, 1e9, 2e9};
  EXPECT_EQ(undetermined_by(square, 2).equations.size(), 1u);
  EXPECT_TRUE(undetermined_by(std::vector<double>{1e-12}, 1).equations.empty());  // a matter of units
}

TEST(Modes, MassSpringDamper) {  // lambda = -c/2m +- i sqrt(k/m - (c/2m)^2)
  const double k = 30, c = 0.8, m = 2;
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = x[1];
    out[1] = (p[2] - p[0] * x[0] - p[1] * x[1]) / 2;
  };
  const auto linear = linearize(parametric_system(2, f), std::vector<double>{0, 0}, std::vector<double>{k, c, 0});
  ASSERT_EQ(linear.inputs, 3u);
  EXPECT_NEAR(linear.b[5], 1 / m, 1e-9);  // d(x'')/d(force)
  const auto modes = modes_of(linear.a, 2);
  ASSERT_EQ(modes.size(), 1u);
  EXPECT_NEAR(modes[0].eigenvalue.real(), -c / (2 * m), 1e-8);
  EXPECT_NEAR(modes[0].frequency, std::sqrt(k / m) / (2 * M_PI), 1e-8);
  EXPECT_NEAR(modes[0].damping, c / (2 * std::sqrt(k * m)), 1e-8);
  EXPECT_NEAR(modes[0].time_constant, 2 * m / c, 1e-6);
}

// x' = s x^n at 0, in random scales: the linear part is zero up to rounding, which must not decide the stability. That
// of x' = s x is decided for any small s.
TEST(Equilibrium, WhatRoundingLeavesOfTheLinearPartDecidesNothing) {
  for (const double s : {-1e3, -1.0, -1e-3, 1e-3, 1.0, 1e3}) {
    for (const int n : {2, 3, 4}) {
      const auto f = [s, n](double, Values x, Values, std::span<double> out) { out[0] = s * std::pow(x[0], n); };
      auto system = parametric_system(1, f);
      system.jacobian = [s, n](double, Values x, Values, std::span<double> rows) {
        rows[0] = s * n * std::pow(x[0], n - 1);
      };
      for (const double x : {0.0, 1e-20, -1e-20, 1e-16, -1e-16}) {
        const auto found = describe_equilibrium(system, {x}, {});
        EXPECT_EQ(found.stability, Stability::undecided) << s << " x^" << n << " at " << x;
        EXPECT_FALSE(found.isolated);
      }
    }
    for (const double small : {1e-12, 1e-30}) {
      const auto line = [s, small](double, Values x, Values, std::span<double> out) { out[0] = s * small * x[0]; };
      auto system = parametric_system(1, line);
      system.jacobian = [s, small](double, Values, Values, std::span<double> rows) { rows[0] = s * small; };
      EXPECT_EQ(describe_equilibrium(system, {0.0}, {}).stability,
                s < 0 ? Stability::asymptotically_stable : Stability::unstable);
    }
  }
}

}  // namespace
}  // namespace continuo::studies::equilibrium_test
