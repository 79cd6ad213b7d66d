// Evaluates a fitted model between its measurements, with bands of confidence.
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/studies/fit/fit_problem.hpp>
#include <continuo/studies/fit/variance_ratios.hpp>

namespace continuo::studies {

namespace {

using detail::FitProblem;

/// How far new measurements of one column are from the curve.
class Band {
 public:
  Band(const Fit& fit, const FitProblem& problem, std::size_t group, bool lognormal)
      : fit_(fit), problem_(problem), group_(group), lognormal_(lognormal) {
    degrees_ = degrees_of(fit.sure.degrees, fit.columns[group].degrees);
  }

  /// Half its width where the quantity and its derivatives by the unknowns are these; of lognormal noise that of its
  /// logarithm.
  double half_width(std::span<const double> number) {
    const double plain =
        interval_factor(degrees_) * deviation(number, problem_.noise_variances(), fit_.sure.determined_covariance);
    if (fit_.sure.ratios.empty() || !(plain > 0) || !std::isfinite(plain)) return plain;
    // As the unknowns' intervals: what is not known of the ratios of variances is not known of the band either.
    const MixedRatios& ratios = fit_.sure.ratios;
    const std::size_t source = ratios.source_of[group_];
    if (source == no_source && !fit_.columns[group_].given) return plain;
    std::vector<double> slopes;
    for (const double derivative : number.subspan(1)) slopes.push_back(slope(number) * derivative);
    seen_.clear();
    for (const GivenRatios& given : ratios.given) {
      seen_.push_back(detail::seen_along(given, slopes));
      const double own = std::pow(problem_.deviation_at(group_, number[0], given.variances_of_components), 2);
      seen_.back().variance += own;
      if (source != no_source) seen_.back().parts[source] += own;
    }
    const double half = detail::half_width_of(detail::mixture_of(ratios, seen_), plain);
    return std::isnan(half) ? plain : half;
  }

 private:
  double slope(std::span<const double> number) const { return lognormal_ ? 1 / number[0] : 1; }

  double degrees_of(const std::vector<double>& of_unknowns, double of_column) const {
    if (fit_.columns[group_].given) return std::numeric_limits<double>::infinity();
    for (const double degrees : of_unknowns) of_column = std::min(of_column, degrees);
    return std::max(of_column, 1.0);
  }

  double deviation(std::span<const double> number, std::span<const double> variances,
                   const std::vector<double>& covariance) const {
    const std::size_t m = number.size() - 1;
    double variance = std::pow(problem_.deviation_at(group_, number[0], variances), 2);
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < m; ++j)
        variance += slope(number) * number[1 + i] * covariance[i * m + j] * slope(number) * number[1 + j];
    return std::sqrt(variance);
  }

  const Fit& fit_;
  const FitProblem& problem_;
  std::size_t group_;
  bool lognormal_;
  double degrees_;
  std::vector<detail::Seen> seen_;
};

std::vector<double> times_between(double from, double to, std::size_t points) {
  std::vector<double> times;
  for (std::size_t i = 0; i < points; ++i)
    times.push_back(i + 1 == points ? to
                                    : from + (to - from) * static_cast<double>(i) / static_cast<double>(points - 1));
  return times;
}

}  // namespace

std::vector<FitCurve> curves_of(const FitRequest& request, const Fit& fit, std::size_t points) {
  std::vector<FitCurve> curves;
  const std::size_t m = fit.least.p.size();
  const double from =
      model::start_values(request.program->model, request.experiment.parameters, request.experiment.from)[0];
  FitProblem problem(request);
  problem.take_noise(fit.noise);
  std::size_t group = 0;
  for (std::size_t d = 0; d < request.data.size(); ++d) {
    const auto values = problem.values(d, fit.least.p, times_between(from, problem.parts()[d].times().back(), points));
    const std::size_t columns = request.data[d].columns.size();
    for (std::size_t c = 0; c < columns; ++c, ++group) {
      FitCurve curve{.data = d, .column = c, .t = values.times, .y = {}, .low = {}, .high = {}};
      const bool lognormal = request.data[d].columns[c].error == ErrorModel::lognormal;
      Band band(fit, problem, group, lognormal);
      for (std::size_t row = 0; row < values.times.size(); ++row) {
        const std::span number(&values.numbers[(row * columns + c) * (1 + m)], 1 + m);
        const double width = band.half_width(number), y = number[0];
        curve.y.push_back(y);
        curve.low.push_back(lognormal ? y * std::exp(-width) : y - width);
        curve.high.push_back(lognormal ? y * std::exp(width) : y + width);
      }
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace continuo::studies
