// The error estimates of boundary-value problems, against closed forms: random linear problems, nearly singular ones,
// and right-hand sides with jumps or without a value.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "two_ends.hpp"
#include <continuo/boundary/boundary_value.hpp>

namespace continuo::boundary::boundary_accuracy_test {
namespace {

using X = std::vector<double>;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// x' = A x + sin(w t) u with A = V diag(rates) V^-1: growing components are 1 at the end, decaying ones at the start,
/// so that x is of size 1. The forcing adds sin(w t) a + cos(w t) b with w a = A b, -w b = A a + u.
struct Linear {
  Matrix A, V;
  Vector rates, amplitudes, u, a, b;
  double w = 3;

  explicit Linear(std::mt19937& random, Eigen::Index n) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto numbers = [&](Eigen::Index rows, Eigen::Index columns) {
      return Matrix(Matrix::NullaryExpr(rows, columns, [&] { return unit(random); }));
    };
    V = numbers(n, n) + 1.5 * Matrix::Identity(n, n);
    rates = Vector(n);
    for (Eigen::Index i = 0; i < n; ++i) rates[i] = (i % 2 == 0 ? 1 : -1) * std::pow(10.0, 1 + unit(random));
    A = V * rates.asDiagonal() * V.inverse();
    amplitudes = numbers(n, 1), u = numbers(n, 1);
    Matrix both(2 * n, 2 * n);
    both << w * Matrix::Identity(n, n), -A, A, w * Matrix::Identity(n, n);
    Vector right(2 * n);
    right << Vector::Zero(n), -u;
    const Vector solved = both.fullPivLu().solve(right);
    a = solved.head(n), b = solved.tail(n);
  }

  Vector at(double t) const {
    Vector modes(rates.size());
    for (Eigen::Index i = 0; i < modes.size(); ++i)
      modes[i] = amplitudes[i] * std::exp(rates[i] * (rates[i] > 0 ? t - 1 : t));
    return V * modes + std::sin(w * t) * a + std::cos(w * t) * b;
  }

  ParametricSystem system() const {
    return parametric_system(static_cast<std::size_t>(A.rows()),
                             [*this](double t, Values x, Values, std::span<double> dxdt) {
                               const Eigen::Map<const Vector> state(x.data(), A.rows());
                               Eigen::Map<Vector>(dxdt.data(), A.rows()) = A * state + std::sin(w * t) * u;
                             });
  }
};

/// The greatest error of each component at points on and between the mesh, compared with the solution's own estimate.
void expect_the_error_is_what_it_says(const Linear& linear, const BoundaryValueSolution& solution, double tolerance) {
  const std::size_t n = solution.size;
  X greatest(n), size(n);
  for (std::size_t k = 0; k + 1 < solution.mesh.size(); ++k) {
    for (const double theta : {0.0, 0.13, 0.5, 0.8}) {
      const double t = solution.mesh[k] + theta * (solution.mesh[k + 1] - solution.mesh[k]);
      const Vector truth = linear.at(t);
      const X x = solution(t);
      for (std::size_t i = 0; i < n; ++i) {
        const double exact = truth[static_cast<Eigen::Index>(i)];
        greatest[i] = std::max(greatest[i], std::abs(x[i] - exact));
        size[i] = std::max(size[i], std::abs(exact));
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    // The estimate is of first order and at the collocation points: between them the error may be half as large again.
    // The closed form itself has the error of rounding times the condition of V.
    EXPECT_LE(greatest[i], 2 * solution.error[i] + 1e-13 * size[i]);
    EXPECT_LE(solution.error[i], tolerance * size[i] * (1 + 1e-6));
  }
}

/// As many conditions at each end as there are components that decay from there.
TEST(BoundaryAccuracy, OfRandomLinearProblemsWithSeparatedConditions) {
  std::mt19937 random(20260101);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int sample = 0; sample < 20; ++sample) {
    const Eigen::Index n = 2 + sample % 4;
    const Linear linear(random, n);
    Matrix rows = Matrix::NullaryExpr(n, n, [&] { return unit(random); });
    // Rows that determine the component of their end: those of V^-1, perturbed.
    rows = linear.V.inverse() + 0.2 * rows;
    const Vector first = linear.at(0), last = linear.at(1);
    const auto conditions = [=](Values x, Values, std::span<double> g) {
      const Eigen::Map<const Vector> at_first(x.data(), n), at_last(x.data() + n, n);
      for (Eigen::Index i = 0; i < n; ++i)
        g[static_cast<std::size_t>(i)] =
            i % 2 == 0 ? rows.row(i).dot(at_last - last) : rows.row(i).dot(at_first - first);
    };
    for (const double tolerance : {1e-4, 1e-8}) {
      const auto solution = solve_boundary_values({linear.system(), {0, 1}, conditions}, {}, {.tolerance = tolerance});
      ASSERT_TRUE(solution.outcome) << sample << ": " << describe(solution.outcome);
      expect_the_error_is_what_it_says(linear, solution, tolerance);
    }
  }
}

/// B0 x(0) + B1 x(1) = c with random matrices, which may be ill-conditioned: then a refusal by name is allowed.
TEST(BoundaryAccuracy, OfRandomLinearProblemsWithConditionsThatJoinTheEnds) {
  std::mt19937 random(20260102);
  std::uniform_real_distribution<double> unit(-1, 1);
  int solved = 0;
  for (int sample = 0; sample < 30; ++sample) {
    const Eigen::Index n = 2 + sample % 3;
    const Linear linear(random, n);
    const Matrix B0 = Matrix::NullaryExpr(n, n, [&] { return unit(random); });
    const Matrix B1 = Matrix::NullaryExpr(n, n, [&] { return unit(random); });
    const Vector first = linear.at(0), last = linear.at(1);
    const auto conditions = [=](Values x, Values, std::span<double> g) {
      Eigen::Map<Vector>(g.data(), n) = B0 * (Eigen::Map<const Vector>(x.data(), n) - first) +
                                        B1 * (Eigen::Map<const Vector>(x.data() + n, n) - last);
    };
    const double tolerance = 1e-7;
    const auto solution = solve_boundary_values({linear.system(), {0, 1}, conditions}, {}, {.tolerance = tolerance});
    if (!solution.outcome) {
      EXPECT_NE(solution.failure, BoundaryValueFailure::not_found) << describe(solution.outcome);
      continue;
    }
    ++solved;
    expect_the_error_is_what_it_says(linear, solution, tolerance);
  }
  EXPECT_GE(solved, 28);
}

/// y'' = -w^2 y, y(0) = 0, y(1) = 1: sin(w t) / sin(w), whose size goes as 1/(w - pi). Solved to the tolerance, or
/// refused.
TEST(BoundaryAccuracy, NearASingularProblemItIsKeptOrRefused) {
  for (const double distance : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
    const double w = std::numbers::pi * (1 + distance);
    const auto f = [w](double, const X& x, X& dxdt) { dxdt = {x[1], -w * w * x[0]}; };
    for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
      const auto solution =
          solve_boundary_values({parametric_system(2, f), {0, 1}, ends(0, 1)}, {}, {.tolerance = tolerance});
      EXPECT_TRUE(solution.outcome || distance < 1e-3) << describe(solution.outcome);
      if (!solution.outcome) continue;
      // sin(w) of the rounded w is known to 1e-16/distance of itself.
      const double truth = std::sin(w / 2) / std::sin(w);
      EXPECT_NEAR(solution(0.5)[0] / truth, 1, tolerance + 1e-15 / distance) << distance << " " << tolerance;
    }
  }
}

TEST(BoundaryAccuracy, WhatIsNotDeterminedIsRefusedByName) {
  const auto oscillator = [](double, const X& x, X& dxdt) { dxdt = {x[1], -x[0]}; };
  for (const double end : {0.0, 1.0}) {  // c sin t for each c; none
    const auto none = solve_boundary_values({parametric_system(2, oscillator), {0, std::numbers::pi}, ends(0, end)});
    EXPECT_EQ(none.failure, BoundaryValueFailure::undetermined) << end << describe(none.outcome);
    EXPECT_NE(none.outcome.hint.find("multiple of another motion"), std::string::npos) << none.outcome.hint;
  }
  // eps y'' = t y' - y (problem 35 of Cash and Mazzia): any multiple of t can be added but for exp(-1/(2 eps)).
  for (const double epsilon : {1e-2, 1e-3}) {
    const auto f = [epsilon](double t, const X& x, X& dxdt) { dxdt = {x[1], (t * x[1] - x[0]) / epsilon}; };
    for (const double tolerance : {1e-3, 1e-6}) {
      const auto none =
          solve_boundary_values({parametric_system(2, f), {-1, 1}, ends(1, 2)}, {}, {.tolerance = tolerance});
      EXPECT_FALSE(none.outcome) << epsilon << " " << tolerance;
    }
  }
}

TEST(BoundaryAccuracy, NoughtIsDoubtedWhereOtherMotionsMayBe) {
  const auto column = [](double, const X& x, X& dxdt) { dxdt = {x[1], -20 * std::sin(x[0])}; };  // Euler's, buckled
  const auto straight = solve_boundary_values({parametric_system(2, column), {0, 1}, ends(0, 0)});
  ASSERT_TRUE(straight.outcome);
  EXPECT_NE(straight.outcome.hint.find("another `guess`"), std::string::npos) << straight.outcome.hint;
  const auto linear = [](double, const X& x, X& dxdt) { dxdt = {x[1], 20 * x[0]}; };  // nought alone
  EXPECT_TRUE(solve_boundary_values({parametric_system(2, linear), {0, 1}, ends(0, 0)}).outcome.hint.empty());
}

/// y'' = 1 before 0.3, -4 after, y(0) = y(1) = 0: y'(0) = 0.98 - 0.255, y'(1) = y'(0) + 0.3 - 2.8.
TEST(BoundaryAccuracy, WhereFJumpsThereComesAPointOfTheMesh) {
  const auto f = [](double t, const X& x, X& dxdt) { dxdt = {x[1], t < 0.3 ? 1.0 : -4.0}; };
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    const auto solution =
        solve_boundary_values({parametric_system(2, f), {0, 1}, ends(0, 0)}, {}, {.tolerance = tolerance});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    EXPECT_NEAR(solution(0)[1], 0.725, 2 * tolerance);
    EXPECT_NEAR(solution(1)[1], -1.775, 2 * tolerance);
    EXPECT_LT(solution.mesh.size(), 4000u);
  }
  // A kink where the state passes: y'' = |y|, y(-1) = -1, y(1) = 1.
  const auto kink = [](double, const X& x, X& dxdt) { dxdt = {x[1], std::abs(x[0])}; };
  const auto solution =
      solve_boundary_values({parametric_system(2, kink), {-1, 1}, ends(-1, 1)}, {}, {.tolerance = 1e-9});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_LT(solution.mesh.size(), 1000u);
  // Left of its zero z y = c sin(t - z), right of it c sinh(t - z), with c sin(1 + z) = 1 = c sinh(1 - z).
  double low = -1, high = 1;
  for (int i = 0; i < 100; ++i) {
    const double z = (low + high) / 2;
    (std::sin(1 + z) < std::sinh(1 - z) ? low : high) = z;
  }
  EXPECT_NEAR(solution(low)[0], 0, 4e-9);
  EXPECT_NEAR(solution(low)[1], 1 / std::sin(1 + low), 4e-9);
}

/// y'' = -2/t y' - y^5, y'(0) = 0, y(1) = sqrt(3)/2: 1/sqrt(1 + t^2/3) (Emden). At 0 there is no value of f.
TEST(BoundaryAccuracy, AnEndWithoutAValueIsLeftOut) {
  const auto emden = [](double t, const X& x, X& dxdt) { dxdt = {x[1], -2 / t * x[1] - std::pow(x[0], 5)}; };
  const auto conditions = [](Values x, Values, std::span<double> g) { g[0] = x[1], g[1] = x[2] - std::sqrt(3) / 2; };
  for (const double tolerance : {1e-4, 1e-8, 1e-11}) {
    const auto solution =
        solve_boundary_values({parametric_system(2, emden), {0, 1}, conditions}, {}, {.tolerance = tolerance});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    for (const double t : {0.0, 0.01, 0.3, 0.9})
      EXPECT_NEAR(solution(t)[0], 1 / std::sqrt(1 + t * t / 3), 2 * tolerance) << t;
  }
  // The same backwards, so that the end is the last.
  const auto mirrored = [](double t, const X& x, X& dxdt) { dxdt = {x[1], 2 / -t * x[1] - std::pow(x[0], 5)}; };
  const auto other_end = [](Values x, Values, std::span<double> g) { g[0] = x[3], g[1] = x[0] - std::sqrt(3) / 2; };
  const auto solution =
      solve_boundary_values({parametric_system(2, mirrored), {-1, 0}, other_end}, {}, {.tolerance = 1e-9});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution(0)[0], 1, 2e-9);
}

/// y'' = 56 y^0.75, y(0) = 0, y(1) = 1: t^8. The formula of the derivative, 0.75 y^0.75 / y, has no value at y = 0.
TEST(BoundaryAccuracy, ADerivativeWithoutAValueIsTakenByDifferences) {
  auto power = parametric_system(2, [](double, Values x, Values, std::span<double> dxdt) {
    dxdt[0] = x[1], dxdt[1] = 56 * std::pow(std::max(x[0], 0.0), 0.75);
  });
  power.jacobian = [](double, Values x, Values, std::span<double> rows) {
    rows[0] = 0, rows[1] = 1, rows[2] = 42 * std::pow(std::max(x[0], 0.0), 0.75) / x[0], rows[3] = 0;
  };
  const auto solution = solve_boundary_values({power, {0, 1}, ends(0, 1)}, {}, {.tolerance = 1e-6});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_NEAR(solution(0.5)[0], std::pow(0.5, 8), 2e-6);
}

}  // namespace
}  // namespace continuo::boundary::boundary_accuracy_test
