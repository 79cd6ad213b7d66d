#include <algorithm>
#include <cmath>
#include <cstddef>

#include <continuo/results/plots.hpp>

namespace continuo::results {
namespace {

constexpr std::size_t most_default_curves = 8;

std::vector<double> column_of(const Table& table, std::size_t column) {
  std::vector<double> values(table.rows());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = table.at(i, column);
  return values;
}

double extent(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax_element(values);
  return values.empty() ? 0 : *high - *low;
}

/// Both axes measure the same thing over comparable ranges: an orbit should look like one.
bool deserves_equal_scale(const PlotRequest& plot, const Panel& panel) {
  if (plot.against_time || plot.curves.front().unit != plot.against.unit) return false;
  const double ratio = extent(panel.curves.front().y) / extent(plot.x);
  return ratio > 0.25 && ratio < 4;
}

std::vector<double> event_times(const Record& record) {
  std::vector<double> times;
  for (const EventRow& event : record.events) {
    if (times.empty() || times.back() != event.t) times.push_back(event.t);
  }
  return times;
}

/// "h, h' [m]", or only the unit where the names would not fit.
std::string y_label(const Panel& panel, const std::string& unit) {
  std::string names;
  for (const Curve& curve : panel.curves) names += (names.empty() ? "" : ", ") + curve.label;
  if (names.size() > 24) names.clear();
  return unit.empty() ? names : names.empty() ? "[" + unit + "]" : names + " [" + unit + "]";
}

void append_panels(const PlotRequest& plot, const std::vector<double>& marks, std::vector<Panel>& panels) {
  std::vector<std::string> units;
  for (const Column& curve : plot.curves) {
    if (std::ranges::find(units, curve.unit) == units.end()) units.push_back(curve.unit);
  }
  for (const std::string& unit : units) {
    Panel panel{.x_label = label_of(plot.against), .y_label = {}, .curves = {}};
    for (std::size_t i = 0; i < plot.curves.size(); ++i) {
      if (plot.curves[i].unit == unit) panel.curves.push_back({plot.curves[i].name, plot.x, plot.y[i]});
    }
    panel.y_label = y_label(panel, unit);
    if (plot.against_time) panel.marks = marks;
    panel.equal_scale = deserves_equal_scale(plot, panel);
    panels.push_back(std::move(panel));
  }
}

Panel drift_panel(const Record& record, const std::vector<double>& energies, const std::vector<double>& marks) {
  const double first = energies.front();
  const bool relative = first != 0;
  std::vector<double> drift(energies.size());
  std::ranges::transform(energies, drift.begin(),
                         [&](double e) { return (e - first) / (relative ? std::abs(first) : 1); });
  const std::string unit = record.energy && !record.energy->unit.empty() ? " [" + record.energy->unit + "]" : "";
  return {.x_label = label_of(record.motion.columns.front()),
          .y_label = relative ? "energy drift, relative" : "energy drift" + unit,
          .curves = {{relative ? "(E(t) - E(0)) / |E(0)|" : "E(t) - E(0)", column_of(record.motion, 0), drift}},
          .marks = marks};
}

}  // namespace

std::string label_of(const Column& column) {
  return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]";
}

std::vector<PlotRequest> default_plots(const Record& record) {
  PlotRequest plot{.against = record.motion.columns.front(), .x = column_of(record.motion, 0), .curves = {}, .y = {}};
  for (std::size_t i = 0; i < std::min(record.states, most_default_curves); ++i) {
    plot.curves.push_back(record.motion.columns[1 + i]);
    plot.y.push_back(column_of(record.motion, 1 + i));
  }
  return {plot};
}

Figure figure_of(const Record& record, const std::vector<PlotRequest>& plots, const std::vector<double>& energies) {
  Figure figure{.title = record.setup.model, .panels = {}};
  const auto marks = event_times(record);
  for (const PlotRequest& plot : plots) append_panels(plot, marks, figure.panels);
  if (!energies.empty()) figure.panels.push_back(drift_panel(record, energies, marks));
  return figure;
}

}  // namespace continuo::results
