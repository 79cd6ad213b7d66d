// Random linear systems, whose solutions are closed forms, by every method that controls its error. An error estimate
// that vanishes where f is linear passes every test with a nonlinear system.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::model {
namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;  // by rows

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

/// A rotation by random angles about the three axes.
Matrix random_rotation(std::mt19937& random) {
  Matrix q{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double angle = uniform(random, 0, 6.28), c = std::cos(angle), s = std::sin(angle);
    for (Vector& row : q) {
      const double a = row[(axis + 1) % 3], b = row[(axis + 2) % 3];
      row[(axis + 1) % 3] = c * a - s * b;
      row[(axis + 2) % 3] = s * a + c * b;
    }
  }
  return q;
}

Vector product(const Matrix& a, const Vector& x) {
  Vector y{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) y[i] += a[i][j] * x[j];
  return y;
}
Matrix transposed(const Matrix& a) {
  Matrix b{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) b[j][i] = a[i][j];
  return b;
}
/// q d q^T.
Matrix in_coordinates(const Matrix& q, const Matrix& d) {
  Matrix a{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = 0; l < 3; ++l) a[i][j] += q[i][k] * d[k][l] * q[j][l];
  return a;
}

std::string row_times_state(const Vector& row) {
  return fmt::format("({:.17g})*x + ({:.17g})*y + ({:.17g})*z", row[0], row[1], row[2]);
}

struct Problem {
  std::string text;
  Vector end{};  // x, y, z at t = 3
};

/// x'' = -K x from rest, K with eigenvalues w^2: in its coordinates each component is cos(w t).
Problem oscillators(std::mt19937& random) {
  const Matrix q = random_rotation(random);
  const Vector start{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
  Matrix d{};
  Vector modes = product(transposed(q), start);
  for (std::size_t i = 0; i < 3; ++i) {
    const double frequency = uniform(random, 0.2, 4);
    d[i][i] = -frequency * frequency;
    modes[i] *= std::cos(3 * frequency);
  }
  const Matrix a = in_coordinates(q, d);
  return {
      fmt::format("x'' = {}\ny'' = {}\nz'' = {}\nx(0) = {:.17g}; y(0) = {:.17g}; z(0) = {:.17g}\n"
                  "x'(0) = 0; y'(0) = 0; z'(0) = 0\nrun 0..3\n",
                  row_times_state(a[0]), row_times_state(a[1]), row_times_state(a[2]), start[0], start[1], start[2]),
      product(q, modes)};
}

/// x' = A x with an eigenvalue r and a pair a + w i, a - w i: exp(r t), and exp(a t) times a rotation by w t.
Problem decays(std::mt19937& random, double fastest) {
  const Matrix q = random_rotation(random);
  const Vector start{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
  const double r = -std::pow(10.0, uniform(random, -1, std::log10(fastest)));
  const double a = uniform(random, -1, 0.2), w = uniform(random, 0, 4);
  const Vector m = product(transposed(q), start);
  const double c = std::cos(3 * w), s = std::sin(3 * w), growth = std::exp(3 * a);
  const Matrix matrix = in_coordinates(q, Matrix{{{r, 0, 0}, {0, a, -w}, {0, w, a}}});
  return {fmt::format("x' = {}\ny' = {}\nz' = {}\nx(0) = {:.17g}; y(0) = {:.17g}; z(0) = {:.17g}\nrun 0..3\n",
                      row_times_state(matrix[0]), row_times_state(matrix[1]), row_times_state(matrix[2]), start[0],
                      start[1], start[2]),
          product(q, Vector{m[0] * std::exp(3 * r), growth * (c * m[1] - s * m[2]), growth * (s * m[1] + c * m[2])})};
}

void expect_solved(const Problem& problem, const MethodInfo& method, double tolerance) {
  const Loaded loaded = load(Source("linear.sim", problem.text));
  ASSERT_TRUE(loaded) << loaded.text();
  const Experiment experiment{
      .method = std::string(method.name), .rtol = tolerance, .atol = {tolerance}, .keep_rows = false};
  const Simulated simulated = simulate(*loaded.model, experiment);
  ASSERT_TRUE(simulated.run) << render(simulated.diagnostics, loaded.source);
  ASSERT_EQ(simulated.run->outcome.ending, Ending::reached_end) << method.name << ": " << simulated.run->outcome.hint;
  double error = 0;
  const auto& states = loaded.model->states;
  for (std::size_t i = 0; i < states.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (states[i].column == std::array<std::string, 3>{"x", "y", "z"}[k])
        error = std::max(error, std::abs(simulated.run->final_state()[i] - problem.end[k]));
  EXPECT_LT(error, 30 * tolerance) << method.name << " at " << tolerance << '\n' << problem.text;
}

void expect_solved_to_all_tolerances(const Problem& problem, const MethodInfo& method) {
  for (const double tolerance : {1e-3, 1e-5, 1e-8})
    if (tolerance >= (method.order < 2 ? 1e-3 : method.order < 3 ? 1e-5 : 0)) expect_solved(problem, method, tolerance);
}

TEST(LinearSystems, OfOscillatorsAreSolvedToTheTolerance) {
  for (const MethodInfo& method : method_catalogue()) {
    if (method.error_order == 0) continue;
    std::mt19937 random(1);
    for (int i = 0; i < 10; ++i) expect_solved_to_all_tolerances(oscillators(random), method);
  }
}

TEST(LinearSystems, ThatDecayAreSolvedToTheTolerance) {
  for (const MethodInfo& method : method_catalogue()) {
    if (method.error_order == 0 || method.second_order) continue;
    std::mt19937 random(2);
    for (int i = 0; i < 10; ++i) expect_solved_to_all_tolerances(decays(random, method.implicit ? 1e5 : 20), method);
  }
}

}  // namespace
}  // namespace continuo::model
