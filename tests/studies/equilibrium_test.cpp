// Equilibria, eigenvalues and modes against closed forms.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/studies/equilibrium.hpp>

namespace continuo::studies {
namespace {

ParametricSystem lorenz(double rho) {
  const auto f = [](double, Values x, Values p, std::span<double> dxdt) {
    dxdt[0] = p[0] * (x[1] - x[0]);
    dxdt[1] = x[0] * (p[1] - x[2]) - x[1];
    dxdt[2] = x[0] * x[1] - p[2] * x[2];
  };
  return parametric_system(3, f, {10, rho, 8.0 / 3});
}

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

}  // namespace
}  // namespace continuo::studies
