// continuo/results/sweep_figures.hpp
// Pictures of many runs: quantiles over time, a plane of two parameters, outcomes over a parameter, bars of indices.
//
//   const FanChart fan{.x_label = "t [s]", .label = "x [m]", .x = times, .parts = {0.05, 0.5, 0.95}, .quantiles =
//   rows}; if (const Status status = draw({.title = "Spring", .panels = {fan_panel(fan)}}, "fan.svg"); !status) ...
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include <continuo/results/figure.hpp>

namespace continuo::results {

/// Quantiles of an outcome at each of many times.
struct FanChart {
  std::string x_label, label;                  // "t [s]", "x [m]"
  std::vector<double> x;                       // times
  std::vector<double> parts;                   // rising, as many below 0.5 as above: 0.05, 0.25, 0.5, 0.75, 0.95
  std::vector<std::vector<double>> quantiles;  // one row over all times for each part; NaN where there are none
};
/// A band between each part and its counterpart, and the median.
[[nodiscard]] Panel fan_panel(const FanChart& fan);

/// An outcome over the grid of two parameters.
struct HeatMap {
  std::string x_label, y_label, label;
  std::vector<double> x, y;                           // of the grid, rising
  std::vector<double> values;                         // row by row: at y[0] those at all x; NaN where there is none
  bool logarithmic_x = false, logarithmic_y = false;  // as the grid is spaced
};
/// Each value has a cell that reaches halfway to its neighbours. A grid finer than the picture is thinned.
[[nodiscard]] Panel heat_panel(const HeatMap& map);

/// The outcomes of runs over the values of one parameter.
[[nodiscard]] Panel scatter_panel(std::string x_label, std::string y_label, std::vector<double> x,
                                  std::vector<double> y);

/// A number with its interval.
struct Bar {
  double value = 0;
  Range interval{0, 0};  // NaN where there is none
};
/// Bars that belong together: "first order", one for each name of the panel.
struct BarGroup {
  std::string label;
  std::vector<Bar> bars;
};
/// For each name a bar of each group, side by side.
[[nodiscard]] Panel bar_panel(std::string y_label, std::vector<std::string> names, const std::vector<BarGroup>& groups);

}  // namespace continuo::results
