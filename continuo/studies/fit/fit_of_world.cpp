// Tests what jumps at impacts, and judges slopes of a world by increments as wide as intervals.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <continuo/numerics/central_difference.hpp>
#include <continuo/studies/fit/fit_of_world.hpp>
#include <continuo/studies/fit/fit_statistics.hpp>
#include <continuo/studies/sensitivity/world_sensitivity.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies::detail {

bool jumps_at_impacts(const model::Model& model, const std::vector<std::uint32_t>& variables) {
  const std::size_t first = model.layout.states;
  return std::ranges::any_of(variables, [&](std::uint32_t variable) {
    return variable >= first && variable < first + model.states.size() && jumps_at_impacts(model, variable - first);
  });
}

namespace {

/// Of residuals in units of their deviations, whatever these residuals are: the end of a search decides that where
/// there is no noise.
std::vector<double> deviations_of(const LeastSquaresResult& result) {
  VarianceComponents noise{.rows = std::vector<VarianceRow>(result.residuals.size()),
                           .components = {{.variance = 1, .known = true}}};
  const Uncertainty sure = uncertainty_of(noise, result.residuals, result.rows, result, Loss::squares, result.p, 1e-8);
  std::vector<double> deviations;
  for (std::size_t u = 0; u < result.p.size(); ++u)
    deviations.push_back(std::sqrt(sure.covariance[u * (result.p.size() + 1)]));
  return deviations;
}

}  // namespace

Status judge_slopes(LeastSquares& least, const LeastSquaresOptions& options, const std::vector<std::string>& names,
                    const std::function<void(std::vector<double>)>& set_increments, LeastSquaresResult& result) {
  constexpr double most_change = 1.5;
  const std::vector<double> deviations = deviations_of(result);
  std::vector<double> increments;
  for (std::size_t u = 0; u < result.p.size(); ++u) {
    // Never as narrow as they were: where these were too wide already, in chaos, any other width shows it.
    const double size = std::abs(result.p[u]), deviation = deviations[u];
    const double least_width = 3 * central_increment(result.p[u], size > 0 ? size : 1.0);
    const bool is_wide = std::isfinite(deviation) && deviation > least_width;
    increments.push_back(!is_wide ? least_width : size > 0 ? std::min(deviation, size / 4) : deviation);
  }
  set_increments(increments);
  least.start = result.p;
  LeastSquaresOptions once = options;
  once.starts = 1;
  LeastSquaresResult wide = least_squares(least, once);
  if (!wide.found && wide.interrupted) return {};
  if (!wide.found)
    return {.ending = Ending::cannot_continue,
            .message = "the world cannot be run all over the width of the intervals"};
  const std::vector<double> of_wide = deviations_of(wide);
  for (std::size_t u = 0; u < result.p.size(); ++u) {
    const double before = deviations[u], after = of_wide[u];
    if (!std::isfinite(before) || result.at_bound[u] != 0) continue;
    if (after <= most_change * before && before <= most_change * after) continue;
    return {
        .ending = Ending::cannot_continue,
        .message = fmt::format(
            "the motion is no smooth function of {}: over the width of its interval it changes at another rate than at "
            "{:g}, so that no interval is honest; a stretch of the data with fewer impacts may have one",
            names[u], result.p[u])};
  }
  wide.best_start = result.best_start, wide.starts_done = result.starts_done;
  wide.starts_agreeing = result.starts_agreeing;
  wide.iterations += result.iterations, wide.evaluations += result.evaluations;
  result = std::move(wide);
  return {};
}

}  // namespace continuo::studies::detail
