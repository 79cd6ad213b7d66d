// Unknowns p with the least sum of squares (or of a loss that forgives outliers) of residuals r(p), by Ceres:
//
//   const auto result = least_squares({.start = {1, 1}, .residuals = 20, .evaluate = line});
//   if (result.found && result.converged) fmt::print("{}\n", result.p[0]);
//
// How sure the unknowns are is a question to variance_components.hpp.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <continuo/status/status.hpp>
#include <continuo/studies/fit/robust_loss.hpp>

namespace continuo::studies {

/// A least-squares problem.
struct LeastSquares {
  std::vector<double> start{};
  std::vector<double> low{}, high{};  // infinite for none; empty: none at all
  std::size_t residuals = 0;
  /// r(p), and dr/dp row by row unless `rows` is empty. False: there are none at this p, which then is avoided.
  std::function<bool(std::span<const double> p, std::span<double> r, std::span<double> rows)> evaluate{};
};

/// Where the search begins, and how far it goes.
struct LeastSquaresOptions {
  Loss loss = Loss::squares;  // of residuals whose deviation is 1
  /// Searches from this many places: the start, then others by a Latin hypercube within the bounds, or from a tenth to
  /// ten times the start. Where a bound is a hundred times the other or more, places are even in the logarithm.
  std::size_t starts = 1;
  std::uint64_t seed = 1;
  std::size_t most_iterations = 500;  // of each search
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(std::size_t start, double cost)> progress{};  // after each iteration
};

/// The result of a search.
struct LeastSquaresResult {
  bool found = false, interrupted = false;
  bool converged = false;  // else the search ended at its limit of iterations
  Status status{};         // a failure where nothing was found
  std::vector<double> p;
  std::vector<double> residuals, rows;  // r and dr/dp at p
  double cost = 0;                      // half the sum of the losses
  std::vector<char> at_bound;
  std::size_t best_start = 0;  // which of the starts led there: 0 is the given one
  std::size_t iterations = 0, evaluations = 0, starts_done = 0, starts_agreeing = 0;
};

/// Searches for the least sum from each start, and returns the best result.
[[nodiscard]] LeastSquaresResult least_squares(const LeastSquares& problem, const LeastSquaresOptions& options = {});

}  // namespace continuo::studies
