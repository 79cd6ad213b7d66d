// Conditions at several times: x' = f(t, x, p) on an interval, with as many conditions as there are components of x and
// unknown constants p, each on x at one or several times.
//
//   // x'' = 2, x(1) = 3, x(7) = 4
//   const auto parabola = [](double, const std::vector<double>& x, std::vector<double>& dxdt) { dxdt = {x[1], 2}; };
//   const auto ends = [](Values x, Values, std::span<double> g) { g[0] = x[0] - 3, g[1] = x[2] - 4; };
//   const auto solution = solve_boundary_values({parametric_system(2, parabola), {1, 7}, ends});
//   if (solution.outcome) fmt::print("{}\n", solution(4)[0]);
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/solve/outcome.hpp>
#include <continuo/status/status.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::boundary {

/// A boundary-value problem: a system, and as many conditions as it has components and unknown constants.
struct BoundaryValueProblem {
  ParametricSystem system{};    // its constants p, of which there are m, are unknown
  std::vector<double> times{};  // at which conditions read x, ascending; the first and the last bound the interval
  /// residuals = g(x, p), n + m of them: x at the first time, at the second, ...
  std::function<void(Values x, Values p, std::span<double> residuals)> conditions{};
  /// Where g may depend on x and p (columns: x at the first time, ..., then p); empty: anywhere.
  std::vector<MatrixPlace> condition_places{};
};

/// Invalid input where no method can solve the problem, as it is incomplete or contradicts itself.
[[nodiscard]] Status validate(const BoundaryValueProblem& problem);

/// How exactly a problem is solved, and how much may be spent on it.
struct BoundaryValueOptions {
  /// Of |x' - f| / (1 + |f|), root mean square over each interval of the mesh; and of the estimated error of each
  /// component, relative to its greatest value. Where the former takes more than some thousand intervals (it may be
  /// all rounding), the latter will do.
  double tolerance = 1e-6;
  bool check_error = true;  // false: the residual alone, for a step on the way to somewhere else
  std::size_t most_intervals = 50'000;
  std::size_t most_iterations = 40;  // of Newton on one mesh
  std::size_t most_refinements = 5;  // of a mesh on which Newton's iteration found nothing
  std::vector<double> mesh{};        // to begin with; empty: even
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(std::size_t intervals, double residual)> progress{};  // after each mesh
};

/// Where the search begins: x(t), zero where there is none; the constants begin as the system has them.
using BoundaryValueGuess = std::function<void(double t, std::span<double> x)>;

/// Why there is no solution; `undetermined`: to the digits of a double the conditions leave many, or none.
enum class BoundaryValueFailure { none, not_found, undetermined, rounding, too_fine, not_finite, other };

/// A piecewise polynomial of degree 4 with continuous derivative.
struct BoundaryValueSolution {
  Outcome<double> outcome;  // `nonlinear_solve_failed`: no solution near the guess was found; its hint may hold a doubt
  BoundaryValueFailure failure = BoundaryValueFailure::none;
  std::size_t size = 0;
  std::vector<double> mesh;    // its points
  std::vector<double> points;  // x at the collocation points, those of the mesh among them
  std::vector<double> slopes;  // f there
  std::vector<double> parameters;
  double residual = 0;                     // the greatest of an interval, see BoundaryValueOptions::tolerance
  std::vector<double> error;               // estimated, the greatest of each component; empty: unknown
  double condition = 0;                    // estimated: the error relative to that of each equation; 0: unknown
  std::size_t meshes = 0, iterations = 0;  // how many meshes, and iterations of Newton on all of them
  std::size_t evaluations = 0;             // of f

  /// x(t), `size` numbers; t in the interval.
  void at(double t, std::span<double> x) const;
  /// dx/dt at t, of the polynomial.
  void slope_at(double t, std::span<double> dxdt) const;
  /// x(t) as a new vector.
  [[nodiscard]] std::vector<double> operator()(double t) const;
};

/// Solves the problem by collocation on a mesh that is refined until residual and error are below the tolerance. Where
/// Newton's iteration finds nothing near the guess, or a limit is reached, the outcome says so; nothing throws.
[[nodiscard]] BoundaryValueSolution solve_boundary_values(const BoundaryValueProblem& problem,
                                                          const BoundaryValueGuess& guess = {},
                                                          const BoundaryValueOptions& options = {});

}  // namespace continuo::boundary
