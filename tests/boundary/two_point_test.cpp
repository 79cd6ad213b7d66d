// Two-point problems in C++: closed forms, real and complex, and the endings.
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/boundary/two_point.hpp>

namespace continuo::boundary::two_point_test {
namespace {

using Values = std::span<const double>;

std::vector<double> even_mesh(double from, double to, std::size_t intervals) {
  std::vector<double> x;
  for (std::size_t i = 0; i <= intervals; ++i)
    x.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(intervals));
  return x;
}

/// y'' = factor y with y(0) = first, y(1) = last.
TwoPointProblem<double> exponentials(double factor, double first, double last) {
  TwoPointProblem<double> problem{.size = 2};
  problem.derivative = [factor](Values x, Values y, Values, std::span<double> f) {
    for (std::size_t q = 0; q < x.size(); ++q) f[q] = y[x.size() + q], f[x.size() + q] = factor * y[q];
  };
  problem.conditions = [first, last](Values a, Values b, Values, std::span<double> g) {
    g[0] = a[0] - first, g[1] = b[0] - last;
  };
  return problem;
}

TEST(TwoPoint, MeetsTheClosedFormWhateverTheTolerance) {
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    const auto found =
        solve_two_point<double>(exponentials(25, 1, 0), even_mesh(0, 1, 4), std::vector<double>(10), {},
                                {.tolerance = tolerance, .condition_tolerance = tolerance, .most_nodes = 10'000});
    ASSERT_EQ(found.ending, TwoPointEnding::solved);
    for (std::size_t k = 0; k < found.x.size(); ++k)
      EXPECT_NEAR(found.y[2 * k], std::sinh(5 * (1 - found.x[k])) / std::sinh(5.0), 10 * tolerance);
    for (const double residual : found.residuals) EXPECT_LE(residual, tolerance);
  }
}

TEST(TwoPoint, TakesDerivativesOnTheLastMeshOnlyWhereItIsNew) {
  auto problem = exponentials(100, 1, 0);
  problem.derivative = [](Values x, Values y, Values, std::span<double> f) {
    for (std::size_t q = 0; q < x.size(); ++q) f[q] = y[x.size() + q], f[x.size() + q] = 100 * std::sinh(y[q]);
  };
  std::vector<std::size_t> points;
  problem.derivative_jacobian = [&points](Values x, Values y, Values, std::span<double> by_y, std::span<double>) {
    const std::size_t count = x.size();
    points.push_back(count);
    for (std::size_t q = 0; q < count; ++q) {
      by_y[q] = by_y[3 * count + q] = 0, by_y[count + q] = 1;
      by_y[2 * count + q] = 100 * std::cosh(y[q]);
    }
  };
  const TwoPointOptions options{.tolerance = 1e-7, .condition_tolerance = 1e-7, .most_nodes = 10'000};
  const auto found = solve_two_point<double>(problem, even_mesh(0, 1, 4), std::vector<double>(10), {}, options);
  ASSERT_EQ(found.ending, TwoPointEnding::solved);
  EXPECT_LE(points.back(), found.x.size());  // of 2 nodes - 1 points
  problem.derivative_jacobian = {};
  const auto by_differences =
      solve_two_point<double>(problem, even_mesh(0, 1, 4), std::vector<double>(10), {}, options);
  ASSERT_EQ(found.x, by_differences.x);
  for (std::size_t e = 0; e < found.y.size(); ++e) EXPECT_NEAR(found.y[e], by_differences.y[e], 1e-6);
}

TEST(TwoPoint, FindsUnknownParameters) {
  TwoPointProblem<double> problem{.size = 2, .parameters = 1};
  problem.derivative = [](Values x, Values y, Values p, std::span<double> f) {
    for (std::size_t q = 0; q < x.size(); ++q) f[q] = y[x.size() + q], f[x.size() + q] = -p[0] * p[0] * y[q];
  };
  problem.conditions = [](Values a, Values b, Values p, std::span<double> g) {
    g[0] = a[0], g[1] = b[0], g[2] = a[1] - p[0];
  };
  const std::vector<double> x = even_mesh(0, 1, 8);
  std::vector<double> y;
  for (const double at : x) y.insert(y.end(), {std::sin(3 * at), 3 * std::cos(3 * at)});
  const auto found = solve_two_point<double>(problem, x, y, {3}, {.tolerance = 1e-8, .most_nodes = 10'000});
  ASSERT_EQ(found.ending, TwoPointEnding::solved);
  EXPECT_NEAR(found.p[0], std::numbers::pi, 1e-8);
}

TEST(TwoPoint, TurnsInTheComplexPlane) {
  using Complex = ComplexNumber<double>;
  TwoPointProblem<Complex> problem{.size = 1};
  problem.derivative = [](std::span<const double>, std::span<const Complex> y, std::span<const Complex>,
                          std::span<Complex> f) {
    for (std::size_t q = 0; q < y.size(); ++q) f[q] = Complex(-1, 2) * y[q];
  };
  problem.conditions = [](std::span<const Complex>, std::span<const Complex> b, std::span<const Complex>,
                          std::span<Complex> g) { g[0] = b[0] - Complex(1, 0); };
  const auto found = solve_two_point<Complex>(problem, even_mesh(0, 1, 3), std::vector<Complex>(4), {},
                                              {.tolerance = 1e-8, .condition_tolerance = 1e-10});
  ASSERT_EQ(found.ending, TwoPointEnding::solved);
  for (std::size_t k = 0; k < found.x.size(); ++k) {
    const double left = 1 - found.x[k];
    EXPECT_NEAR(found.y[k].re, std::exp(left) * std::cos(2 * left), 1e-7);
    EXPECT_NEAR(found.y[k].im, -std::exp(left) * std::sin(2 * left), 1e-7);
  }
}

TEST(TwoPoint, SaysWhyThereIsNoSolution) {
  const auto solve = [](const TwoPointProblem<double>& problem, TwoPointOptions options = {}) {
    return solve_two_point<double>(problem, even_mesh(0, 1, 4), std::vector<double>(10), {}, options);
  };
  EXPECT_EQ(solve(exponentials(1e4, 1, 1), {.tolerance = 1e-10}).ending, TwoPointEnding::too_many_nodes);
  auto twice = exponentials(1, 0, 0);
  twice.conditions = [](Values a, Values, Values, std::span<double> g) { g[0] = a[0], g[1] = a[0] - 1; };
  EXPECT_EQ(solve(twice).ending, TwoPointEnding::singular);
  auto nowhere = exponentials(1, 0, 1);
  nowhere.derivative = [](Values x, Values, Values, std::span<double> f) {
    for (std::size_t q = 0; q < x.size(); ++q) f[q] = 0, f[x.size() + q] = x[q] == 0.5 ? std::nan("") : 0;
  };
  const auto found = solve(nowhere);
  EXPECT_EQ(found.ending, TwoPointEnding::not_finite);
  EXPECT_EQ(found.component, 1U);
  EXPECT_EQ(found.where, 0.5);
}

/// y'' = -pi^2 y + 1 with y(0) = y(1) = 0 is a resonance: the forcing does not vanish against sin(pi x), and there is
/// no solution. Collocation has one, of the size of what it leaves.
TEST(TwoPoint, DoesNotTakeAResonanceForASolution) {
  auto resonance = exponentials(0, 0, 0);
  resonance.derivative = [](Values x, Values y, Values, std::span<double> f) {
    constexpr double pi = std::numbers::pi;
    for (std::size_t q = 0; q < x.size(); ++q) f[q] = y[x.size() + q], f[x.size() + q] = 1 - pi * pi * y[q];
  };
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6}) {
    const auto found = solve_two_point<double>(resonance, even_mesh(0, 1, 4), std::vector<double>(10), {},
                                               {.tolerance = tolerance, .most_nodes = 20'000});
    EXPECT_NE(found.ending, TwoPointEnding::solved) << tolerance;
  }
}

}  // namespace
}  // namespace continuo::boundary::two_point_test
