// Unknowns p with the least sum of squares (or of a loss that forgives outliers) of residuals r(p), by Ceres:
//
//   const auto result = least_squares({.start = {1, 1}, .residuals = 20, .evaluate = line});
//   if (result.found) fmt::print("{} +- {}\n", result.p[0], result.deviation(0));
#pragma once
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace continuo::studies {

struct LeastSquares {
  std::vector<double> start{};
  std::vector<double> low{}, high{};  // infinite for none; empty: none at all
  std::size_t residuals = 0;
  /// r(p), and dr/dp row by row unless `rows` is empty. False: there are none at this p, which then is avoided.
  std::function<bool(std::span<const double> p, std::span<double> r, std::span<double> rows)> evaluate{};
};

/// rho(r^2/a^2) in place of r^2/a^2, the further from squares the less an outlier counts. `a` is the multiple of the
/// residuals' robust deviation at which 95 % of the efficiency is kept on normal noise: P. W. Holland, R. E. Welsch,
/// "Robust regression using iteratively reweighted least-squares", Comm. Statist. A6 (1977).
enum class Loss { squares, huber, soft_l1, cauchy, tukey };
inline constexpr std::string_view loss_names[] = {"squares", "huber", "soft_l1", "cauchy", "tukey"};

struct LeastSquaresOptions {
  Loss loss = Loss::squares;
  /// Searches from this many places: the start, then others within the bounds, or from a tenth to ten times the start.
  std::size_t starts = 1;
  std::uint64_t seed = 1;
  /// The deviation of each residual is one, known beforehand; else it is estimated from the residuals.
  bool known_deviation = false;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(std::size_t start, double cost)> progress{};  // after each iteration
};

struct LeastSquaresResult {
  bool found = false, interrupted = false;
  std::string message;  // why nothing was found
  std::vector<double> p;
  std::vector<double> residuals;
  std::vector<double> weights;     // by which the loss counts each of them
  double cost = 0;                 // half the sum of weighted squares
  double residual_deviation = 0;   // 1 where it was known
  std::size_t degrees = 0;         // of freedom
  std::vector<double> covariance;  // of p, row by row; infinite where the data say nothing; 0 at a bound
  std::vector<char> at_bound;
  std::size_t iterations = 0, evaluations = 0, starts_done = 0, starts_agreeing = 0;

  double deviation(std::size_t i) const { return std::sqrt(covariance[i * p.size() + i]); }
};

LeastSquaresResult least_squares(const LeastSquares& problem, const LeastSquaresOptions& options = {});

}  // namespace continuo::studies
