// Statistics of the residuals of a fit: the agreement of each column, chi squared, likelihood, and warnings.
// Internal to fit.
#pragma once
#include <vector>

#include <continuo/studies/fit.hpp>
#include <continuo/studies/fit/fit_problem.hpp>

namespace continuo::studies::detail {

/// How sure the unknowns of a search are that are not at a bound; those that are have no deviation.
[[nodiscard]] Uncertainty uncertainty_of(const VarianceComponents& noise, std::span<const double> residuals,
                                         std::span<const double> rows, const LeastSquaresResult& least, Loss loss,
                                         std::span<const double> sizes, double accuracy,
                                         Likelihood likelihood = Likelihood::restricted);

[[nodiscard]] std::vector<FitColumnResult> column_results(const FitRequest& request, const FitProblem& problem,
                                                          const Fit& fit);

[[nodiscard]] FitStatistics statistics_of(const FitRequest& request, const FitProblem& problem, const Fit& fit);

/// Of an end that looks like one: not converged, at a bound, residuals too large for their deviations, or of one sign
/// for too long.
[[nodiscard]] std::vector<FitDoubt> doubts_of(const FitRequest& request, const Fit& fit);

/// -2 log L of the residuals with their variances, but for a constant; of a robust loss what takes its place.
[[nodiscard]] double badness(const FitProblem& problem, const LeastSquaresResult& least);

}  // namespace continuo::studies::detail
