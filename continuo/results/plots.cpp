// Makes panels of a model's plots, with marks of events and the drift of the energy.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/world.hpp>
#include <continuo/results/bodies_panel.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::results {
namespace {

// Between its steps a method is often less accurate than at their ends, by some tens of tolerances.
constexpr double least_tolerances_of_drift = 10 * least_tolerances_of_axis;
constexpr std::size_t most_marked_places = 60;  // of a profile: more would be a band

std::vector<double> column_of(const model::Motion& motion, std::size_t column) {
  std::vector<double> values(motion.rows());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = motion.row(i)[column];
  return values;
}

double extent(const std::vector<double>& values) {
  double low = INFINITY, high = -INFINITY;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  return low <= high ? high - low : 0;
}

/// A plot with the lines of its curves, wherever they come from.
struct DrawnPlot {
  model::Column against;
  bool against_time = true, logarithmic_x = false, logarithmic_y = false;
  std::vector<model::Column> columns;
  std::vector<MotionCurve> curves;  // one per column
};

/// Both axes measure the same thing over comparable ranges: an orbit should look like one.
bool deserves_equal_scale(const DrawnPlot& plot, const Panel& panel) {
  if (plot.against_time || plot.logarithmic_x || plot.logarithmic_y) return false;
  if (plot.columns.empty() || plot.columns.front().unit != plot.against.unit) return false;
  const double ratio = extent(panel.curves.front().y) / extent(panel.curves.front().x);
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

/// Curves of one unit share a panel. A quantity has the colour of its place in the first plot that shows it, which is
/// the colour that it has on the page.
void append_panels(const DrawnPlot& plot, const std::vector<double>& marks, std::map<std::string, std::size_t>& colors,
                   std::vector<Panel>& panels) {
  std::vector<std::string> units;
  for (const model::Column& column : plot.columns) {
    if (std::ranges::find(units, column.unit) == units.end()) units.push_back(column.unit);
  }
  for (const std::string& unit : units) {
    Panel panel{.x_label = label_of(plot.against), .y_label = {}, .curves = {}};
    std::vector<Curve> jumps;
    for (std::size_t i = 0; i < plot.columns.size(); ++i) {
      if (plot.columns[i].unit != unit) continue;
      const MotionCurve& curve = plot.curves[i];
      const std::size_t color = colors.emplace(plot.columns[i].name, i).first->second;
      panel.curves.push_back({.label = plot.columns[i].name, .x = curve.path.x, .y = curve.path.y, .number = color});
      if (!curve.jumps.x.empty())
        jumps.push_back(
            {.label = "", .x = curve.jumps.x, .y = curve.jumps.y, .style = Curve::Style::dotted_line, .number = color});
      if (!plot.against_time && !plot.logarithmic_x)
        panel.least_width = std::max(panel.least_width, least_tolerances_of_axis * curve.tolerance_x);
      if (!plot.logarithmic_y)
        panel.least_height = std::max(panel.least_height, least_tolerances_of_axis * curve.tolerance_y);
    }
    panel.y_label = y_label(panel, unit);
    if (plot.against_time) panel.marks = marks;
    panel.logarithmic_x = plot.logarithmic_x;
    panel.logarithmic_y = plot.logarithmic_y;
    panel.tall = !plot.against_time;
    panel.equal_scale = deserves_equal_scale(plot, panel);
    std::ranges::move(jumps, std::back_inserter(panel.curves));
    panels.push_back(std::move(panel));
  }
}

/// Values of a family over its numbers or places, a curve for each time.
Panel profile_panel(const PlotRequest& request, const std::vector<Profile>& profiles, const model::Column& time) {
  const bool has_places = !request.places.empty();
  Panel panel{.x_label = has_places ? label_of({request.plot.against.label, request.places.front().unit}) : "index",
              .y_label = label_of({request.profile_label, request.plot.curves.front().unit}),
              .curves = {},
              .logarithmic_x = request.logarithmic_x,
              .logarithmic_y = request.logarithmic_y};
  for (const Profile& profile : profiles) {
    const std::string when = fmt::format("{} = {:.6g}", time.name, profile.t);
    panel.curves.push_back(
        {.label = is_number(time.unit) ? when : when + " " + time.unit,
         .x = profile.x,
         .y = profile.y,
         .style = profile.x.size() > most_marked_places ? Curve::Style::line : Curve::Style::line_with_points});
  }
  return panel;
}

Panel drift_panel(const model::Run& run, const MotionCurve& energy, const std::vector<double>& marks,
                  const model::Column& time) {
  const double first = energy.path.y.front();
  const bool relative = run.energy && run.energy->relative;
  const double whole = relative ? std::abs(first) : 1;
  std::vector<double> drift(energy.path.y.size());
  std::ranges::transform(energy.path.y, drift.begin(), [&](double e) { return (e - first) / whole; });
  const std::string unit = run.energy && !run.energy->unit.empty() ? " [" + run.energy->unit + "]" : "";
  return {.x_label = label_of(time),
          .y_label = relative ? "energy drift, relative" : "energy drift" + unit,
          .curves = {{relative ? "(E(t) - E(0)) / |E(0)|" : "E(t) - E(0)", energy.path.x, drift}},
          .marks = marks,
          .logarithmic_x = has_logarithmic_time(run),
          .least_height = least_tolerances_of_drift * energy.tolerance_y / whole};
}

PlotData states_plot(const model::Model& model, const model::Run& run) {
  PlotData plot{.against = run.motion.columns.front(), .x = column_of(run.motion, 0), .curves = {}, .y = {}};
  for (const std::size_t i : states_to_plot(model)) {
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
  std::map<std::string, std::size_t> colors;
  for (const PlotData& plot : plots) {
    DrawnPlot drawn{.against = plot.against,
                    .against_time = plot.against_time,
                    .logarithmic_x = plot.against_time && has_logarithmic_time(run),
                    .columns = plot.curves,
                    .curves = {}};
    for (const std::vector<double>& values : plot.y) drawn.curves.push_back({.path = {plot.x, values}, .jumps = {}});
    append_panels(drawn, marks, colors, figure.panels);
  }
  if (!run.total_energy.empty()) {
    const MotionCurve energy{.path = {column_of(run.motion, 0), run.total_energy}, .jumps = {}};
    figure.panels.push_back(drift_panel(run, energy, marks, run.motion.columns.front()));
  }
  return figure;
}

Figure figure_of(const model::ModelProgram& program, const model::Run& run, MotionCurves& curves) {
  const model::Model& model = program.model;
  if (!curves.has_begun()) curves.take_rows(run);
  Figure figure{.title = model.name, .panels = {}};
  if (!curves.has_begun()) return figure;
  const model::Column time{"t", model.time_unit};
  const auto marks = event_times(run);
  const bool shows_bodies = model.world && !curves.was_asked() && run.motion.rows() > 0;
  const bool shows_states =
      !shows_bodies || std::ranges::count(model.world->bodies, false, &model::BodyDescription::fixed) <= 2;
  if (shows_bodies) figure.panels.push_back(bodies_panel(model, run, &curves));
  std::map<std::string, std::size_t> colors;
  for (std::size_t p = 0; shows_states && p < curves.plots().size(); ++p) {
    const PlotRequest& request = curves.plots()[p];
    if (!request.times.empty()) {
      figure.panels.push_back(profile_panel(request, curves.profiles_of(p), time));
      continue;
    }
    const model::Series& against = request.plot.against;
    const bool against_time = against.label == "t";
    DrawnPlot drawn{.against = {against.label, against.unit},
                    .against_time = against_time,
                    .logarithmic_x = request.logarithmic_x || (against_time && has_logarithmic_time(run)),
                    .logarithmic_y = request.logarithmic_y,
                    .columns = {},
                    .curves = curves.curves_of(p)};
    for (const model::Series& series : request.plot.curves) drawn.columns.push_back({series.label, series.unit});
    append_panels(drawn, marks, colors, figure.panels);
  }
  const auto energy = curves.energy();
  if (energy && !energy->path.y.empty() && curves.shows_drift())
    figure.panels.push_back(drift_panel(run, *energy, marks, time));
  return figure;
}

}  // namespace continuo::results
