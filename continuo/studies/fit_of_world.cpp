#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <continuo/studies/fit_of_world.hpp>
#include <continuo/studies/parametric_system.hpp>
#include <continuo/studies/world_sensitivity.hpp>

namespace continuo::studies::detail {

bool jumps_at_impacts(const model::Model& model, const std::vector<std::uint32_t>& variables) {
  const std::size_t first = model.layout.states;
  return std::ranges::any_of(variables, [&](std::uint32_t variable) {
    return variable >= first && variable < first + model.states.size() && jumps_at_impacts(model, variable - first);
  });
}

std::string judge_slopes(LeastSquares& least, const LeastSquaresOptions& options, const std::vector<std::string>& names,
                         const std::function<void(std::vector<double>)>& set_increments, LeastSquaresResult& result) {
  constexpr double most_change = 1.5;
  std::vector<double> increments;
  for (std::size_t u = 0; u < result.p.size(); ++u) {
    // Never as narrow as they were: where these were too wide already, in chaos, any other width shows it.
    const double size = std::abs(result.p[u]), deviation = result.deviation(u);
    const double least_width = 3 * central_increment(result.p[u], size > 0 ? size : 1);
    const bool is_wide = std::isfinite(deviation) && deviation > least_width;
    increments.push_back(!is_wide ? least_width : size > 0 ? std::min(deviation, size / 4) : deviation);
  }
  set_increments(increments);
  least.start = result.p;
  LeastSquaresOptions once = options;
  once.starts = 1;
  LeastSquaresResult wide = least_squares(least, once);
  if (!wide.found) return wide.interrupted ? "" : "the world cannot be run all over the width of the intervals";
  for (std::size_t u = 0; u < result.p.size(); ++u) {
    // Without what the residuals are, which the end of a search decides where there is no noise.
    const double before = result.deviation(u) * wide.residual_deviation;
    const double after = wide.deviation(u) * result.residual_deviation;
    if (!std::isfinite(before) || result.at_bound[u] != 0) continue;
    if (after <= most_change * before && before <= most_change * after) continue;
    return fmt::format(
        "the motion is no smooth function of {}: over the width of its interval it changes at another rate than at "
        "{:g}, so that no interval is honest; a stretch of the data with fewer impacts may have one",
        names[u], result.p[u]);
  }
  wide.starts_done = result.starts_done, wide.starts_agreeing = result.starts_agreeing;
  wide.iterations += result.iterations, wide.evaluations += result.evaluations;
  result = std::move(wide);
  return {};
}

}  // namespace continuo::studies::detail
