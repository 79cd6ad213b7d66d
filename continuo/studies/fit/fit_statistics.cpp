// Statistics of the residuals of a fit, and the doubts that follow from them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include <continuo/studies/fit/chi_squared.hpp>
#include <continuo/studies/fit/fit_statistics.hpp>
#include <continuo/studies/fit/variance_ratios.hpp>

namespace continuo::studies::detail {

namespace {

constexpr double nothing_left = 1e-6;  // of degrees of freedom

/// How likely so few runs of one sign are by chance: A. Wald, J. Wolfowitz, "On a test whether two samples are from the
/// same population", Ann. Math. Stat. 11 (1940). 1 where there are too few residuals to tell.
double signs_by_chance(const std::vector<double>& residuals) {
  double plus = 0, minus = 0, runs = 0, last = 0;
  for (const double r : residuals) {
    if (r == 0) continue;
    (r > 0 ? plus : minus) += 1;
    if (last == 0 || (r > 0) != (last > 0)) runs += 1;
    last = r;
  }
  const double n = plus + minus;
  constexpr double fewest = 8;  // of each sign: below it the normal distribution is no good
  if (plus < fewest || minus < fewest) return 1;
  const double mean = 2 * plus * minus / n + 1, variance = (mean - 1) * (mean - 2) / (n - 1);
  return std::erfc((mean - 0.5 - runs) / std::sqrt(2 * variance)) / 2;
}

bool all_given(const FitColumn& column) {
  if (column.deviations_in || column.error == ErrorModel::poisson) return true;
  if (column.error == ErrorModel::proportional) return column.relative.has_value();
  if (column.error == ErrorModel::both) return column.relative && column.deviation;
  return column.deviation.has_value();
}

std::size_t count_free(const Fit& fit) {
  return static_cast<std::size_t>(std::ranges::count(fit.least.at_bound, 0)) - fit.sure.directions.size();
}

/// With zeros for the unknowns that are not free.
std::vector<double> among_all(const std::vector<double>& of_free, const std::vector<std::size_t>& free,
                              std::size_t all) {
  std::vector<double> result(all * all, 0);
  for (std::size_t a = 0; a < free.size(); ++a)
    for (std::size_t b = 0; b < free.size(); ++b) result[free[a] * all + free[b]] = of_free[a * free.size() + b];
  return result;
}

GivenRatios among_all(const GivenRatios& of_free, const std::vector<std::size_t>& free, std::size_t all) {
  GivenRatios result = of_free;
  result.shift.assign(all, 0);
  for (std::size_t a = 0; a < free.size(); ++a) result.shift[free[a]] = of_free.shift[a];
  result.covariance = among_all(of_free.covariance, free, all);
  for (std::vector<double>& part : result.parts) part = among_all(part, free, all);
  return result;
}

}  // namespace

Uncertainty uncertainty_of(const VarianceComponents& noise, std::span<const double> residuals,
                           std::span<const double> rows, const LeastSquaresResult& least, Loss loss,
                           std::span<const double> sizes, double accuracy, Likelihood likelihood) {
  const std::size_t m = least.p.size(), n = noise.rows.size();
  std::vector<std::size_t> free;
  std::vector<double> sizes_of_free, columns;
  for (std::size_t u = 0; u < m; ++u)
    if (least.at_bound[u] == 0) free.push_back(u), sizes_of_free.push_back(sizes[u]);
  for (std::size_t r = 0; r < n; ++r)
    for (const std::size_t u : free) columns.push_back(rows[r * m + u]);
  Uncertainty of_free = uncertainty(noise, residuals, columns, loss, sizes_of_free, accuracy);
  if (loss == Loss::squares && likelihood == Likelihood::restricted)
    widen_by_ratios(of_free, noise, residuals, columns, sizes_of_free, accuracy);
  Uncertainty result = of_free;
  result.covariance.assign(m * m, 0);
  result.determined_covariance.assign(m * m, 0);
  result.degrees.assign(m, std::numeric_limits<double>::infinity());
  result.factors.assign(m, interval_factor(std::numeric_limits<double>::infinity()));
  result.undetermined.assign(m, 0);
  for (std::vector<double>& direction : result.directions) direction.assign(m, 0);
  for (GivenRatios& given : result.ratios.given) given = among_all(given, free, m);
  for (std::size_t a = 0; a < free.size(); ++a) {
    result.degrees[free[a]] = of_free.degrees[a];
    result.factors[free[a]] = of_free.factors[a];
    result.undetermined[free[a]] = of_free.undetermined[a];
    for (std::size_t d = 0; d < result.directions.size(); ++d) result.directions[d][free[a]] = of_free.directions[d][a];
    for (std::size_t b = 0; b < free.size(); ++b) {
      result.covariance[free[a] * m + free[b]] = of_free.covariance[a * free.size() + b];
      result.determined_covariance[free[a] * m + free[b]] = of_free.determined_covariance[a * free.size() + b];
    }
  }
  return result;
}

std::vector<FitColumnResult> column_results(const FitRequest& request, const FitProblem& problem, const Fit& fit) {
  std::vector<FitColumnResult> results;
  for (std::size_t d = 0; d < request.data.size(); ++d)
    for (std::size_t c = 0; c < request.data[d].columns.size(); ++c)
      results.push_back({.data = d, .column = c, .given = all_given(request.data[d].columns[c])});
  const std::vector<double> off = problem.raw(fit.least.residuals, 1);
  for (std::size_t i = 0; i < problem.measured().size(); ++i) {
    const Measured& m = problem.measured()[i];
    FitColumnResult& column = results[m.group];
    const double u = fit.least.residuals[i];
    column.values += 1;
    column.chi_squared += u * u;
    column.sum_of_squares += off[i] * off[i];
    column.times.push_back(request.data[m.part].measurements.times.empty() ? 0
                                                                           : problem.parts()[m.part].times()[m.row]);
    column.measured.push_back(m.value);
    column.fitted.push_back(problem.fitted(i, off[i]));
    column.deviations.push_back(std::sqrt(problem.noise().variance(i)));
    column.residuals.push_back(off[i]);
    column.weights.push_back(weight_of(request.options.loss, u));
  }
  for (std::size_t g = 0; g < results.size(); ++g) {
    FitColumnResult& column = results[g];
    const FitColumn& asked = problem.column_of(g);
    column.degrees = fit.sure.group_degrees[g];
    column.ratio = column.degrees > nothing_left ? fit.sure.group_ratio[g] : std::nan("");
    const bool relative = asked.error == ErrorModel::proportional || asked.error == ErrorModel::both;
    if (asked.error != ErrorModel::proportional)
      column.residual_deviation = column.ratio * problem.constant_deviation(g);
    if (relative) column.residual_deviation_relative = column.ratio * problem.relative_deviation(g);
    column.p = column.given && column.degrees > nothing_left ? chi_squared_tail(column.chi_squared, column.degrees) : 1;
    double size = 0;
    for (const double value : column.measured) size += value * value;
    // Below it residuals are the runs' own errors.
    constexpr double digits = 1e-6;
    if (column.sum_of_squares > digits * digits * size) column.signs_p = signs_by_chance(column.residuals);
  }
  return results;
}

namespace {

bool is_known(const VarianceComponents& noise, std::size_t row) {
  for (const VarianceRow::Share& share : noise.rows[row].shares)
    if (share.factor != 0 && !noise.components[share.component].known) return false;
  return noise.variance(row) > 0;
}

}  // namespace

FitStatistics statistics_of(const FitRequest& request, const FitProblem& problem, const Fit& fit) {
  FitStatistics result{.values = problem.measured().size(), .free_unknowns = count_free(fit)};
  std::set<std::string> quantities;
  double squares = 0, chi_squared = 0;
  bool given = true;
  for (const FitColumnResult& column : fit.columns) {
    const FitColumn& asked = request.data[column.data].columns[column.column];
    quantities.insert(asked.quantity + (asked.error == ErrorModel::lognormal ? "'s logarithm" : ""));
    squares += column.sum_of_squares, chi_squared += column.chi_squared;
    given = given && column.given;
    result.degrees += column.degrees;
  }
  for (const VarianceComponent& component : problem.noise().components)
    result.estimated_variances += component.known ? 0 : 1;
  if (quantities.size() == 1) result.sum_of_squares = squares;
  if (given && request.options.loss == Loss::squares && result.degrees > nothing_left) {
    result.chi_squared = chi_squared;
    result.chi_squared_p = chi_squared_tail(chi_squared, result.degrees);
  }
  if (request.options.loss != Loss::squares || !(result.degrees > nothing_left)) return result;
  VarianceComponents noise = problem.noise();
  const std::vector<double> off = problem.raw(fit.least.residuals, 1),
                            rows = problem.raw(fit.least.rows, fit.least.p.size());
  estimate_variances(noise, off, rows, Loss::squares, Likelihood::plain);
  double sum = 0, counted = 0;
  for (std::size_t i = 0; i < problem.measured().size(); ++i) {
    // A measurement without noise contains no information on the size of the noise; if that is known, it is a
    // measurement like any other.
    if (!noise.rows[i].counts && !is_known(noise, i)) continue;
    counted += 1;
    const double variance = noise.variance(i);
    sum += std::log(2 * std::numbers::pi * variance) + off[i] * off[i] / variance;
    // The density of the value itself, where its logarithm is normal.
    if (problem.column_of(problem.measured()[i].group).error == ErrorModel::lognormal)
      sum += 2 * std::log(std::abs(problem.measured()[i].value));
  }
  if (!std::isfinite(sum)) return result;
  const double k = static_cast<double>(result.free_unknowns + result.estimated_variances);
  const double n = counted;
  result.log_likelihood = -sum / 2;
  result.aic = sum + 2 * k;
  result.bic = sum + k * std::log(n);
  if (n > k + 1) result.aicc = *result.aic + 2 * k * (k + 1) / (n - k - 1);
  return result;
}

double badness(const FitProblem& problem, const LeastSquaresResult& least) {
  double sum = 2 * least.cost;
  for (std::size_t r = 0; r < problem.noise().rows.size(); ++r) sum += std::log(problem.noise().variance(r));
  return sum;
}

std::vector<FitDoubt> doubts_of(const FitRequest& request, const Fit& fit) {
  using Kind = FitDoubt::Kind;
  std::vector<FitDoubt> doubts;
  const model::Model& model = request.program->model;
  if (!fit.least.converged)
    doubts.push_back(
        {Kind::not_converged, fmt::format("the search ended at its limit of {} iterations, not at a minimum",
                                          request.options.most_iterations)});
  for (std::size_t u = 0; u < fit.least.p.size(); ++u)
    if (fit.least.at_bound[u] != 0)
      doubts.push_back(
          {Kind::at_bound, fmt::format("{} is at a bound of its range: the least there is within it, not a "
                                       "minimum; the intervals of the others hold for it as it is",
                                       name_of(model, request.unknowns[u].influence))});
  if (!fit.sure.directions.empty())
    doubts.push_back({Kind::undetermined, fit.sure.directions.size() == 1
                                              ? "a move of the unknowns changes nothing that was measured"
                                              : fmt::format("{} moves of the unknowns change nothing that was measured",
                                                            fit.sure.directions.size())});
  // A true model is rejected once in a million.
  constexpr double by_chance = 1e-6;
  for (const FitColumnResult& column : fit.columns) {
    const std::string name = fmt::format("{}: {}", request.data[column.data].measurements.file,
                                         request.data[column.data].columns[column.column].quantity);
    if (column.given && request.options.loss == Loss::squares && column.p < by_chance)
      doubts.push_back(
          {Kind::residuals_too_large,
           fmt::format("{}: the residual deviation is {:.3g} times the given one: this is a local minimum, "
                       "the model is wrong, or the deviations are larger",
                       name, column.ratio)});
    // Degrees of freedom. With 3 and 5 of them some 90 to 93 of 100 intervals hold the truth, with 8 some 94: only
    // restricted likelihood of squares is integrated over what is not known of their ratio.
    constexpr double enough_for_two = 8;
    const FitColumn& asked = request.data[column.data].columns[column.column];
    const bool integrated = request.options.loss == Loss::squares && request.likelihood == Likelihood::restricted;
    if (asked.error == ErrorModel::both && !column.given && !integrated && column.degrees < enough_for_two)
      doubts.push_back(
          {Kind::weights, fmt::format("{} has too few values to tell a constant error from one in proportion: "
                                      "intervals are too narrow, some 90 of 100 hold the truth instead of 95",
                                      name)});
    if (asked.error == ErrorModel::both && !column.given && fit.sure.ratios_failed)
      doubts.push_back(
          {Kind::weights, fmt::format("{}: intervals take the ratio of its constant error to the one in proportion for "
                                      "known, as too few likely ratios were found to integrate over, and are too "
                                      "narrow; give one of the two (--sigma) or ask for one kind (--error)",
                                      name)});
    if (column.signs_p < by_chance)
      doubts.push_back({Kind::signs, fmt::format("{} is above and below the model for longer than noise would be "
                                                 "(p = {:.1g}): a local minimum or a wrong model, and no interval is "
                                                 "to be trusted",
                                                 name, column.signs_p)});
  }
  return doubts;
}

}  // namespace continuo::studies::detail
