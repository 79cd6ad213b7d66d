// Pictures of many runs.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include <continuo/results/sweep_figures.hpp>

namespace continuo::results {
namespace {

constexpr std::size_t most_cells = 240;    // along one side: three pixels each
constexpr std::size_t most_dots = 20'000;  // more are one grey area, in a file of megabytes

std::string percent(double part) {
  return fmt::format("{:.4g} %", 100 * part);
}

/// Closed paths between two rows of quantiles, one for each stretch of times at which both have values.
void append_bands(std::vector<Curve>& curves, const FanChart& fan, std::size_t low, std::size_t high, Curve look) {
  const auto& below = fan.quantiles[low];
  const auto& above = fan.quantiles[high];
  for (std::size_t i = 0; i < fan.x.size(); ++i) {
    std::size_t end = i;
    while (end < fan.x.size() && std::isfinite(below[end]) && std::isfinite(above[end])) ++end;
    if (end == i) continue;
    Curve band = look;
    for (std::size_t k = i; k < end; ++k) band.x.push_back(fan.x[k]), band.y.push_back(below[k]);
    for (std::size_t k = end; k > i; --k) band.x.push_back(fan.x[k - 1]), band.y.push_back(above[k - 1]);
    curves.push_back(std::move(band));
    look.label.clear();
    i = end;
  }
}

/// Halfway between neighbours, and as far beyond the ends.
std::vector<double> edges_of(const std::vector<double>& places, bool is_logarithmic) {
  const auto scaled = [&](double v) { return is_logarithmic ? std::log(v) : v; };
  const auto original = [&](double v) { return is_logarithmic ? std::exp(v) : v; };
  if (places.size() == 1) {
    const double half = is_logarithmic ? 0.1 : std::max(0.1 * std::abs(places[0]), 1e-300);
    return {original(scaled(places[0]) - half), original(scaled(places[0]) + half)};
  }
  std::vector<double> edges;
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
    edges.push_back(scaled(places[i]) / 2 + scaled(places[i + 1]) / 2);
  edges.insert(edges.begin(), 2 * scaled(places.front()) - edges.front());
  edges.push_back(2 * scaled(places.back()) - edges.back());
  for (double& edge : edges) edge = original(edge);
  return edges;
}

/// Numbers of the rows or columns that are drawn, evenly chosen where there are too many.
std::vector<std::size_t> drawn_numbers(std::size_t count) {
  const std::size_t drawn = std::min(count, most_cells);
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < drawn; ++i) numbers.push_back((2 * i + 1) * count / (2 * drawn));
  return numbers;
}

std::vector<double> chosen(const std::vector<double>& values, const std::vector<std::size_t>& numbers) {
  std::vector<double> result;
  for (const std::size_t i : numbers) result.push_back(values[i]);
  return result;
}

}  // namespace

Panel fan_panel(const FanChart& fan) {
  Panel panel{.x_label = fan.x_label, .y_label = fan.label, .curves = {}};
  const std::size_t count = fan.parts.size();
  for (std::size_t i = 0; i < count / 2; ++i) {  // side by side, so that each is as strong as in the legend
    const std::size_t last = count - 1 - i;
    Curve look{.label = fmt::format("{} to {}", percent(fan.parts[i]), percent(fan.parts[last])),
               .x = {},
               .y = {},
               .style = Curve::Style::area,
               .number = 0};
    look.fill = 0.5 * static_cast<double>(i + 1) / static_cast<double>(count / 2);
    if (last - i <= 2) {
      append_bands(panel.curves, fan, i, last, look);
    } else {
      append_bands(panel.curves, fan, i, i + 1, look);
      look.label.clear();
      append_bands(panel.curves, fan, last - 1, last, look);
    }
  }
  if (count % 2 == 1) {
    const double middle = fan.parts[count / 2];
    panel.curves.push_back(
        {.label = middle == 0.5 ? "median" : percent(middle), .x = fan.x, .y = fan.quantiles[count / 2], .number = 0});
  }
  panel.tall = true;
  return panel;
}

Panel heat_panel(const HeatMap& map) {
  const auto columns = drawn_numbers(map.x.size()), rows = drawn_numbers(map.y.size());
  Panel panel{.x_label = map.x_label, .y_label = map.y_label, .curves = {}};
  panel.cells = {.x_edges = edges_of(chosen(map.x, columns), map.logarithmic_x),
                 .y_edges = edges_of(chosen(map.y, rows), map.logarithmic_y),
                 .values = {},
                 .label = map.label};
  for (const std::size_t row : rows)
    for (const std::size_t column : columns) panel.cells.values.push_back(map.values[row * map.x.size() + column]);
  panel.logarithmic_x = map.logarithmic_x, panel.logarithmic_y = map.logarithmic_y;
  panel.tall = true;
  return panel;
}

Panel scatter_panel(std::string x_label, std::string y_label, std::vector<double> x, std::vector<double> y) {
  if (x.size() > most_dots) {  // every so many runs: which have nothing in common
    const std::size_t step = x.size() / most_dots + 1;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < x.size(); i += step, ++kept) x[kept] = x[i], y[kept] = y[i];
    x.resize(kept), y.resize(kept);
  }
  Panel panel{.x_label = std::move(x_label), .y_label = std::move(y_label), .curves = {}};
  panel.curves.push_back({.label = "", .x = std::move(x), .y = std::move(y), .style = Curve::Style::dots});
  panel.tall = true;
  return panel;
}

Panel bar_panel(std::string y_label, std::vector<std::string> names, const std::vector<BarGroup>& groups) {
  Panel panel{.x_label = "", .y_label = std::move(y_label), .curves = {}};
  const double width = 0.8 / static_cast<double>(std::max<std::size_t>(groups.size(), 1));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    Curve curve{.label = groups[g].label, .x = {}, .y = {}, .style = Curve::Style::bars};
    curve.bar_width = 0.92 * width;
    const double middle = (static_cast<double>(g) + 0.5) * width - 0.4;
    for (std::size_t i = 0; i < groups[g].bars.size(); ++i) {
      curve.x.push_back(static_cast<double>(i) + middle);
      curve.y.push_back(groups[g].bars[i].value);
      curve.intervals.push_back(groups[g].bars[i].interval);
    }
    panel.curves.push_back(std::move(curve));
  }
  panel.x_names = std::move(names);
  panel.zero_lines = true;
  panel.tall = true;
  return panel;
}

}  // namespace continuo::results
