// Backward differentiation without a matrix: the same results as with one, and systems whose matrix would not fit into
// memory.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <bench/problems/hires.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include "stiff_promises.hpp"
#include <continuo/methods/multistep/bdf_krylov.hpp>

namespace continuo::bdf_krylov_test {
namespace {

using Values = std::vector<double>;

/// Diffusion on the unit square with zero at its edges.
struct Square {
  std::size_t side;

  double dx() const { return 1.0 / static_cast<double>(side + 1); }
  std::size_t size() const { return side * side; }
  double laplacian(const Values& u, std::size_t field, std::size_t fields, std::size_t i, std::size_t j) const {
    const auto at = [&](std::size_t row, std::size_t column) { return u[(row * side + column) * fields + field]; };
    const double left = j > 0 ? at(i, j - 1) : 0, right = j + 1 < side ? at(i, j + 1) : 0;
    const double below = i > 0 ? at(i - 1, j) : 0, above = i + 1 < side ? at(i + 1, j) : 0;
    return (left + right + below + above - 4 * at(i, j)) / (dx() * dx());
  }
};

/// u' = Laplacian of u. The mode sin(pi x) sin(2 pi y) of the discrete equation decays with the sum of
/// 4/dx^2 sin^2(k pi dx / 2) over k = 1, 2.
struct Heat : Square {
  void operator()(double, const Values& u, Values& dudt) const {
    for (std::size_t i = 0; i < side; ++i)
      for (std::size_t j = 0; j < side; ++j) dudt[i * side + j] = laplacian(u, 0, 1, i, j);
  }
  Values exact(double t) const {
    double rate = 0;
    for (const int k : {1, 2}) rate += 4 / (dx() * dx()) * std::pow(std::sin(k * M_PI * dx() / 2), 2);
    Values u(size());
    for (std::size_t i = 0; i < side; ++i)
      for (std::size_t j = 0; j < side; ++j)
        u[i * side + j] = std::exp(-rate * t) * std::sin(M_PI * dx() * static_cast<double>(j + 1)) *
                          std::sin(2 * M_PI * dx() * static_cast<double>(i + 1));
    return u;
  }
};

// A matrix would have 10^8 entries; the explicit step for stability is dx^2 / 4, some 8000 steps of it.
TEST(BdfKrylov, SolvesTenThousandUnknownsWithoutAMatrix) {
  const Heat heat{{100}};
  const auto solution =
      solve(testing::any_system<Values>(heat), heat.exact(0), {0.0, 0.2}, BdfKrylov{}, {.rtol = 1e-5, .atol = 1e-7});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  const auto exact = heat.exact(0.2);
  for (std::size_t i = 0; i < exact.size(); ++i)
    EXPECT_NEAR(solution.final_state()[i], exact[i], 30 * (1e-7 + 1e-5 * std::abs(exact[i])));
  EXPECT_LT(solution.statistics.evaluations, 4000U);
  EXPECT_EQ(solution.statistics.factorizations, 0U);
}

/// The Brusselator on the square: u' = 1 + u^2 v - 4.4 u + Laplacian / 10, v' = 3.4 u - u^2 v + Laplacian / 10.
struct Brusselator : Square {
  SparsePattern pattern;

  explicit Brusselator(std::size_t points) : Square{points} {
    std::vector<MatrixPlace> places;
    for (std::uint32_t cell = 0; cell < size(); ++cell) {
      const auto width = static_cast<std::uint32_t>(points);
      for (std::uint32_t k = 0; k < 2; ++k) {
        places.insert(places.end(), {{2 * cell + k, 2 * cell + 1 - k}});
        if (cell % width > 0) places.insert(places.end(), {{2 * cell + k, 2 * (cell - 1) + k}});
        if (cell % width + 1 < width) places.insert(places.end(), {{2 * cell + k, 2 * (cell + 1) + k}});
        if (cell >= width) places.insert(places.end(), {{2 * cell + k, 2 * (cell - width) + k}});
        if (cell + width < size()) places.insert(places.end(), {{2 * cell + k, 2 * (cell + width) + k}});
      }
    }
    pattern = SparsePattern(2 * size(), places);
  }
  const SparsePattern& jacobian_pattern() const { return pattern; }
  void operator()(double, const Values& x, Values& dxdt) const {
    for (std::size_t i = 0; i < side; ++i) {
      for (std::size_t j = 0; j < side; ++j) {
        const std::size_t at = 2 * (i * side + j);
        const double u = x[at], v = x[at + 1], meet = u * u * v;
        dxdt[at] = 1 + meet - 4.4 * u + 0.1 * laplacian(x, 0, 2, i, j);
        dxdt[at + 1] = 3.4 * u - meet + 0.1 * laplacian(x, 1, 2, i, j);
      }
    }
  }
  Values start() const {
    Values x(2 * size());
    for (std::size_t i = 0; i < size(); ++i) x[2 * i] = 1 + 0.1 * static_cast<double>(i % 7), x[2 * i + 1] = 3;
    return x;
  }
};

TEST(BdfKrylov, FindsTheSameAsTheSparseSolver) {
  const Brusselator problem(16);
  for (const double rtol : {1e-4, 1e-8}) {
    const Options<Values> options{.rtol = rtol, .atol = rtol};
    const auto sparse = solve(problem, problem.start(), {0.0, 3.0}, Bdf{}, options);
    const auto krylov = solve(problem, problem.start(), {0.0, 3.0}, BdfKrylov{}, options);
    ASSERT_TRUE(krylov.outcome) << describe(krylov.outcome);
    // Both within 30 tolerances of the truth, as Bdf promises.
    for (std::size_t i = 0; i < sparse.final_state().size(); ++i)
      EXPECT_NEAR(krylov.final_state()[i], sparse.final_state()[i],
                  60 * rtol * (1 + std::abs(sparse.final_state()[i])));
    // Equations solved as well as by a factorization take no more steps than that.
    EXPECT_LT(static_cast<double>(krylov.statistics.steps), 1.2 * static_cast<double>(sparse.statistics.steps));
  }
}

template <class Problem>
double error_in_tolerances(double rtol, double atol) {
  const auto start = Problem::start();
  const auto solution = solve(testing::any_system<Values>(Problem{}), Values(start.begin(), start.end()),
                              {0.0, Problem::duration}, BdfKrylov{}, {.rtol = rtol, .atol = atol});
  return promises::error_in_tolerances<Problem>(solution, rtol, atol);
}

TEST(BdfKrylov, MeetsItsToleranceOnSmallStiffProblems) {
  for (const double rtol : {1e-4, 1e-7, 1e-10}) {
    EXPECT_LT(error_in_tolerances<bench::Hires<>>(rtol, rtol * 1e-4), 30) << rtol;
    EXPECT_LT(error_in_tolerances<bench::VanDerPol<>>(rtol, rtol), 30) << rtol;
  }
}

/// The heat equation on a line, with the action of its Jacobian and an exact solver of c - J (three diagonals).
struct Line {
  std::size_t nodes;
  double c = 0;
  int actions = 0;
  Values slopes;

  double stiffness() const { return std::pow(static_cast<double>(nodes + 1), 2); }
  void operator()(double, const Values& u, Values& dudt) const {
    for (std::size_t i = 0; i < nodes; ++i)
      dudt[i] = stiffness() * ((i > 0 ? u[i - 1] : 0) - 2 * u[i] + (i + 1 < nodes ? u[i + 1] : 0));
  }
  void jacobian_action(double t, const Values&, const Values& v, Values& product) {
    ++actions;
    operator()(t, v, product);
  }
  void set_up_preconditioner(double, const Values&, double number) { c = number; }
  void precondition(Values& r) {  // L. H. Thomas' elimination
    const double diagonal = c + 2 * stiffness();
    slopes.resize(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
      const double pivot = diagonal - (i > 0 ? stiffness() * slopes[i - 1] : 0);
      slopes[i] = stiffness() / pivot;
      r[i] = (r[i] + (i > 0 ? stiffness() * r[i - 1] : 0)) / pivot;
    }
    for (std::size_t i = nodes - 1; i-- > 0;) r[i] += slopes[i] * r[i + 1];
  }
};

TEST(BdfKrylov, UsesTheActionAndThePreconditionerOfTheSystem) {
  Values u(500);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::sin(M_PI * static_cast<double>(i + 1) / 501) + 0.01;
  Integrator integrator(Line{500, 0, 0, {}}, u, {0.0, 0.2}, BdfKrylov{}, {.rtol = 1e-6, .atol = 1e-8});
  while (integrator.advance()) {
  }
  ASSERT_TRUE(integrator.outcome()) << describe(integrator.outcome());
  // With an exact preconditioner GMRES arrives in one product, with the rounding of a thousandth of it in two.
  const auto solutions = static_cast<double>(integrator.statistics().linear_solves);
  EXPECT_GT(integrator.system().actions, 0);
  EXPECT_LE(integrator.system().actions, 2 * solutions);
  EXPECT_GT(integrator.statistics().factorizations, 0U);
}

TEST(BdfKrylov, SolvesAlgebraicEquations) {
  for (const double tolerance : {1e-3, 1e-6})
    EXPECT_LT(promises::error_of_algebraic_decay<BdfKrylov>(tolerance), 30) << tolerance;
}

TEST(BdfKrylov, ACopyGoesOnToTheSameBits) {
  const Brusselator problem(5);
  promises::expect_copy_goes_on_to_the_same_bits<BdfKrylov>(problem, problem.start(), 3);
}

TEST(BdfKrylov, WhatIsNotFiniteEndsByName) {
  promises::expect_not_finite_ends_by_name<BdfKrylov>();
}

}  // namespace
}  // namespace continuo::bdf_krylov_test
