// Fits the order to a list of errors, and finds where rounding takes over.
#include <algorithm>
#include <cmath>

#include <continuo/studies/accuracy/observed_order.hpp>

namespace continuo::studies {

namespace {

struct Line {
  double slope, constant, standard_error;
};

Line line_through(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, rest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mean_x += x[i] / n, mean_y += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  const double slope = xy / xx, constant = mean_y - slope * mean_x;
  for (std::size_t i = 0; i < x.size(); ++i) rest += std::pow(y[i] - constant - slope * x[i], 2);
  return {slope, std::exp(constant), std::sqrt(rest / (n - 2) / xx)};
}

/// Two smaller steps that do worse than the best are no accident; nor are the last four together without any slope.
bool ends_flat(std::span<const double> steps, std::span<const double> errors, std::span<const std::size_t> valid,
               std::size_t best) {
  if (std::ranges::count_if(valid, [&](std::size_t i) { return i > best; }) >= 2) return true;
  if (valid.size() < 2 * least_points) return false;
  std::vector<double> x, y;
  for (const std::size_t i : valid.last(least_points))
    x.push_back(std::log(steps[i])), y.push_back(std::log(errors[i]));
  return line_through(x, y).slope < 0.5;
}

/// Rounding scatters: of errors on its floor one is the least by chance. What gains less than this factor gains
/// nothing.
constexpr double worth = 2;
/// Errors this many times the least one of all are hardly touched by the rounding that sets it.
constexpr double clear_of_floor = 50;

}  // namespace

ErrorCurve read_errors(std::span<const double> steps, std::span<const double> errors, double least, double greatest) {
  ErrorCurve curve;
  std::vector<std::size_t> valid;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (std::isfinite(errors[i]) && errors[i] > 0) valid.push_back(i);
  if (valid.empty()) return curve;
  const std::size_t best = *std::ranges::min_element(valid, {}, [&](std::size_t i) { return errors[i]; });
  curve.best_step =
      steps[*std::ranges::find_if(valid, [&](std::size_t i) { return errors[i] <= worth * errors[best]; })];
  curve.least_error = errors[best];
  curve.floor_reached = ends_flat(steps, errors, valid, best);

  std::vector<double> x, y;
  std::vector<std::size_t> index;
  for (const std::size_t i : valid) {
    if (!(errors[i] <= greatest)) {
      x.clear(), y.clear(), index.clear();  // an error that small before was chance
      continue;
    }
    if (!(errors[i] > least) || (curve.floor_reached && !(errors[i] > clear_of_floor * curve.least_error))) break;
    x.push_back(std::log(steps[i]));
    y.push_back(std::log(errors[i]));
    index.push_back(i);
  }
  struct Run {
    Line line;
    std::size_t first, last;
  };
  std::vector<Run> runs;
  for (std::size_t from = 0; from < x.size(); ++from)
    for (std::size_t count = least_points; from + count <= x.size(); ++count)
      runs.push_back(
          {line_through(std::span(x).subspan(from, count), std::span(y).subspan(from, count)), from, from + count - 1});
  if (runs.empty()) return curve;
  const auto error_of = [](const Run& run) { return run.line.standard_error; };
  const double good = std::max(good_fit, error_of(*std::ranges::min_element(runs, {}, error_of)));
  const Run* chosen = nullptr;
  for (const Run& run : runs) {
    if (!(error_of(run) <= good)) continue;
    if (chosen == nullptr || run.last > chosen->last || (run.last == chosen->last && error_of(run) < error_of(*chosen)))
      chosen = &run;
  }
  if (chosen == nullptr) return curve;
  curve.found = true;
  curve.order = chosen->line.slope;
  curve.constant = chosen->line.constant;
  curve.standard_error = chosen->line.standard_error;
  curve.first = index[chosen->first];
  curve.last = index[chosen->last];
  return curve;
}

Balance balance(double constant, double order, double rounding, double power) {
  // order constant h^(order - 1) = power rounding h^(-power - 1)
  const double step = std::pow(power * rounding / (order * constant), 1 / (order + power));
  return {step, constant * std::pow(step, order) + rounding * std::pow(step, -power)};
}

}  // namespace continuo::studies
