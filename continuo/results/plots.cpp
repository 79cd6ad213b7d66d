// Makes panels of a model's plots, with marks of events and the drift of the energy.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include <continuo/language/world.hpp>
#include <continuo/results/bodies_panel.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::results {
namespace {

constexpr std::size_t most_default_curves = 8;

std::vector<double> column_of(const model::Motion& motion, std::size_t column) {
  std::vector<double> values(motion.rows());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = motion.row(i)[column];
  return values;
}

double extent(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax_element(values);
  return values.empty() ? 0 : *high - *low;
}

/// Both axes measure the same thing over comparable ranges: an orbit should look like one.
bool deserves_equal_scale(const PlotData& plot, const Panel& panel) {
  if (plot.against_time || plot.curves.front().unit != plot.against.unit) return false;
  const double ratio = extent(panel.curves.front().y) / extent(plot.x);
  return ratio > 0.25 && ratio < 4;
}

std::vector<double> event_times(const model::Run& run) {
  std::vector<double> times;
  for (const model::RecordedEvent& event : run.events) {
    if (event.is_contact()) continue;
    if (times.empty() || times.back() != event.t) times.push_back(event.t);
  }
  return times;
}

/// Written beside a number, this unit says nothing.
bool is_number(std::string_view unit) {
  return unit.empty() || unit == "1";
}

/// "h, h' [m]", or only the unit where the names would not fit.
std::string y_label(const Panel& panel, const std::string& unit) {
  std::string names;
  for (const Curve& curve : panel.curves) names += (names.empty() ? "" : ", ") + curve.label;
  if (names.size() > 24) names.clear();
  return is_number(unit) ? names : names.empty() ? "[" + unit + "]" : names + " [" + unit + "]";
}

/// Rows at 1, 10, 100 s ask for an axis that gives each decade the same room.
bool has_logarithmic_time(const model::Run& run) {
  return run.plan.output == model::OutputPlan::Kind::logarithmic;
}

void append_panels(const PlotData& plot, const model::Run& run, const std::vector<double>& marks,
                   std::vector<Panel>& panels) {
  std::vector<std::string> units;
  for (const model::Column& curve : plot.curves) {
    if (std::ranges::find(units, curve.unit) == units.end()) units.push_back(curve.unit);
  }
  for (const std::string& unit : units) {
    Panel panel{.x_label = label_of(plot.against), .y_label = {}, .curves = {}};
    for (std::size_t i = 0; i < plot.curves.size(); ++i) {
      if (plot.curves[i].unit == unit) panel.curves.push_back({plot.curves[i].name, plot.x, plot.y[i]});
    }
    panel.y_label = y_label(panel, unit);
    if (plot.against_time) panel.marks = marks;
    panel.logarithmic_x = plot.against_time && has_logarithmic_time(run);
    panel.equal_scale = deserves_equal_scale(plot, panel);
    panels.push_back(std::move(panel));
  }
}

Panel drift_panel(const model::Run& run, const std::vector<double>& marks) {
  const double first = run.total_energy.front();
  const bool relative = run.energy && run.energy->relative;
  std::vector<double> drift(run.total_energy.size());
  std::ranges::transform(run.total_energy, drift.begin(),
                         [&](double e) { return (e - first) / (relative ? std::abs(first) : 1); });
  const std::string unit = run.energy && !run.energy->unit.empty() ? " [" + run.energy->unit + "]" : "";
  return {.x_label = label_of(run.motion.columns.front()),
          .y_label = relative ? "energy drift, relative" : "energy drift" + unit,
          .curves = {{relative ? "(E(t) - E(0)) / |E(0)|" : "E(t) - E(0)", column_of(run.motion, 0), drift}},
          .marks = marks,
          .logarithmic_x = has_logarithmic_time(run)};
}

bool is_of_fixed_body(const model::Model& model, std::size_t state) {
  if (!model.world || state >= model.world->body_states()) return false;
  return model.world->bodies[state / model::WorldDescription::states_of_body(model.world->dimension)].fixed;
}

PlotData states_plot(const model::Model& model, const model::Run& run) {
  PlotData plot{.against = run.motion.columns.front(), .x = column_of(run.motion, 0), .curves = {}, .y = {}};
  for (std::size_t i = 0; i < run.motion.states && plot.curves.size() < most_default_curves; ++i) {
    if (is_of_fixed_body(model, i)) continue;
    plot.curves.push_back(run.motion.columns[1 + i]);
    plot.y.push_back(column_of(run.motion, 1 + i));
  }
  return plot;
}

}  // namespace

std::string label_of(const model::Column& column) {
  return is_number(column.unit) ? column.name : column.name + " [" + column.unit + "]";
}

std::vector<PlotData> plots_of(const model::ModelProgram& program, const model::Run& run) {
  if (program.model.plots.empty()) return {states_plot(program.model, run)};
  std::vector<PlotData> plots;
  for (const model::Plot& plot : program.model.plots) {
    std::vector<model::NodeId> nodes{plot.against.node};
    for (const model::Series& series : plot.curves) nodes.push_back(series.node);
    auto values = values_along(program, run, nodes);
    PlotData data{
        .against = {plot.against.label, plot.against.unit}, .x = std::move(values.front()), .curves = {}, .y = {}};
    data.against_time = plot.against.label == "t";
    for (std::size_t i = 0; i < plot.curves.size(); ++i) {
      data.curves.push_back({plot.curves[i].label, plot.curves[i].unit});
      data.y.push_back(std::move(values[i + 1]));
    }
    plots.push_back(std::move(data));
  }
  return plots;
}

Figure figure_of(std::string title, const model::Run& run, std::span<const PlotData> plots) {
  Figure figure{.title = std::move(title), .panels = {}};
  const auto marks = event_times(run);
  for (const PlotData& plot : plots) append_panels(plot, run, marks, figure.panels);
  if (!run.total_energy.empty()) figure.panels.push_back(drift_panel(run, marks));
  return figure;
}

Figure figure_of(const model::ModelProgram& program, const model::Run& run) {
  const model::Model& model = program.model;
  if (!model.plots.empty() || !model.world || run.motion.rows() == 0)
    return figure_of(model.name, run, plots_of(program, run));
  const bool shows_states = std::ranges::count(model.world->bodies, false, &model::BodyDescription::fixed) <= 2;
  Figure figure = figure_of(model.name, run, shows_states ? plots_of(program, run) : std::vector<PlotData>{});
  figure.panels.insert(figure.panels.begin(), bodies_panel(model, run));
  return figure;
}

}  // namespace continuo::results
