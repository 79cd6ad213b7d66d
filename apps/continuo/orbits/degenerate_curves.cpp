// Curves of degenerate homoclinic orbits in three parameters: followed, printed and drawn.
#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <apps/continuo/orbits/degenerate_curves.hpp>
#include <apps/continuo/studies/branch_curves.hpp>
#include <apps/continuo/studies/orbit_text.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/output_file.hpp>

namespace continuo::app {
namespace {

using studies::DegenerateHomoclinicCurve;
using studies::DegenerateHomoclinicPoint;
using studies::MarkedHomoclinic;
using SpaceCurves = std::vector<DegenerateHomoclinicCurve>;

std::string space_place(const DegenerateHomoclinicPoint& point, const NamedSpace& space) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    const double value = point.constants[k];
    const bool nothing = std::abs(value) < 1e-8 * (space[k].high - space[k].low);  // what is left of a zero
    text += fmt::format("{}{} = {:.8g}", k > 0 ? ", " : "", space[k].name, nothing ? 0 : value);
  }
  return text;
}

nlohmann::json json_of(const DegenerateHomoclinicPoint& point) {
  return {{"at", {point.constants[0], point.constants[1], point.constants[2]}},
          {"x", point.orbit.x},
          {"min", point.orbit.low},
          {"max", point.orbit.high},
          {"interval", point.orbit.period},
          {"eigenvalues", app::json_of(point.orbit.eigenvalues)},
          {"truncation", point.orbit.truncation}};
}

/// The points of a curve and between them those that are more.
std::vector<std::pair<const DegenerateHomoclinicPoint*, const MarkedHomoclinic*>> places_of(
    const DegenerateHomoclinicCurve& curve) {
  std::vector<std::pair<const DegenerateHomoclinicPoint*, const MarkedHomoclinic*>> points;
  auto mark = curve.marks.begin();
  for (std::size_t i = 0; i <= curve.points.size(); ++i) {
    for (; mark != curve.marks.end() && mark->next == i; ++mark) points.emplace_back(&mark->at, &*mark);
    if (i < curve.points.size()) points.emplace_back(&curve.points[i], nullptr);
  }
  return points;
}

/// One parameter over the first one.
results::Panel panel_of(const SpaceCurves& curves, const NamedSpace& space, std::size_t upwards) {
  results::Panel panel{.x_label = space[0].name, .y_label = space[upwards].name, .curves = {}};
  for (const DegenerateHomoclinicCurve& curve : curves) {
    const std::string label(to_string(curve.kind));
    const bool named =
        std::ranges::any_of(panel.curves, [&](const results::Curve& other) { return other.label == label; });
    results::Curve line{.label = named ? "" : label, .x = {}, .y = {}};
    for (const auto& [point, mark] : places_of(curve)) {
      line.x.push_back(point->constants[0]);
      line.y.push_back(point->constants[upwards]);
    }
    if (!line.x.empty()) panel.curves.push_back(std::move(line));
  }
  for (const DegenerateHomoclinicCurve& curve : curves)
    for (const MarkedHomoclinic& mark : curve.marks)
      add_bifurcation(panel, std::string(to_string(mark.kind)) + " on it", mark.at.constants[0],
                      mark.at.constants[upwards]);
  return panel;
}

}  // namespace

std::optional<NamedRange> parse_third(const std::string& text, const NamedPlane& plane) {
  auto third = parse_range(text);
  if (!third || (third->name != plane.first.name && third->name != plane.second.name)) return third;
  say(fmt::format("{} is already used: three different parameters are needed", third->name));
  return std::nullopt;
}

bool is_space(const Studied& studied, const NamedSpace& space) {
  const auto& [name, low, high] = space[2];
  const double now = studied.system.constants[2];
  if (now >= low && now <= high) return true;
  say(
      fmt::format("{0} is {1:.10g}, outside of {2:.10g}..{3:.10g}, and curves in two parameters are followed with that "
                  "value first: --set {0}=VALUE gives it another",
                  name, now, low, high));
  return false;
}

SpaceCurves curves_of(const Studied& studied, const std::vector<studies::OrbitCurveOfDiagram>& curves,
                      const NamedSpace& space, const BranchSteps& steps) {
  Progress progress;
  studies::DegenerateHomoclinicOptions options{.interrupt = &interrupt_flag(), .progress = progress.parts()};
  for (std::size_t k = 0; k < 3; ++k) {
    options.low[k] = space[k].low;
    options.high[k] = space[k].high;
  }
  steps.set(options);
  return studies::degenerate_homoclinic_curves(studied.system, curves, options);
}

std::string text_of(const SpaceCurves& curves, const NamedSpace& space) {
  if (curves.empty())
    return fmt::format("\nnothing is marked on a curve of homoclinic orbits, so none is followed in {}, {} and {}\n",
                       space[0].name, space[1].name, space[2].name);
  std::string text;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const DegenerateHomoclinicCurve& curve = curves[k];
    text += fmt::format("\ncurve {} in three parameters, {}: ", k + 1, to_string(curve.kind));
    if (curve.points.empty()) {
      text += curve.status.message + "\n";
      continue;
    }
    text += fmt::format("{} homoclinic orbits\n", curve.points.size());
    const bool closed = curve.ends[0].ending == studies::OrbitCurveEnding::closed;
    const std::string first = space_place(curve.points.front(), space);
    text += closed ? fmt::format("   closed, through {}\n", first)
                   : fmt::format("   from {}: {}\n", first, curve.ends[0].reason);
    for (const MarkedHomoclinic& mark : curve.marks)
      text += fmt::format("   {}: {}\n", space_place(mark.at, space), to_string(mark.kind));
    if (!closed) text += fmt::format("   to {}: {}\n", space_place(curve.points.back(), space), curve.ends[1].reason);
  }
  return text;
}

nlohmann::json json_of(const SpaceCurves& curves, const NamedSpace& space) {
  auto list = nlohmann::json::array();
  for (const DegenerateHomoclinicCurve& curve : curves) {
    nlohmann::json entry{{"kind", to_string(curve.kind)},
                         {"points", nlohmann::json::array()},
                         {"degenerate", nlohmann::json::array()},
                         {"ends", nlohmann::json::array()}};
    if (!curve.status) entry["message"] = curve.status.message;
    for (const DegenerateHomoclinicPoint& point : curve.points) entry["points"].push_back(json_of(point));
    for (const MarkedHomoclinic& mark : curve.marks) {
      nlohmann::json at = json_of(mark.at);
      at["kind"] = to_string(mark.kind);
      entry["degenerate"].push_back(std::move(at));
    }
    for (std::size_t side = 0; side < 2 && !curve.points.empty(); ++side) {
      const auto& last = side == 0 ? curve.points.front() : curve.points.back();
      entry["ends"].push_back(
          {{"at", {last.constants[0], last.constants[1], last.constants[2]}}, {"reason", curve.ends[side].reason}});
    }
    list.push_back(std::move(entry));
  }
  return {{"parameters", {space[0].name, space[1].name, space[2].name}}, {"curves", list}};
}

std::string csv_of(const SpaceCurves& curves, const model::Model& model, const NamedSpace& space) {
  std::string csv = "curve,kind";
  for (const NamedRange& range : space) {
    csv += ',';
    results::append_field(csv, range.name);
  }
  csv += orbit_columns(model, 0);
  const auto field = [&](double value) {
    csv += ',';
    results::append_number(csv, value);
  };
  for (std::size_t k = 0; k < curves.size(); ++k)
    for (const auto& [point, mark] : places_of(curves[k])) {
      csv += fmt::format("{},{}", k + 1, to_string(mark ? mark->kind : curves[k].kind));
      for (const double value : point->constants) field(value);
      for (std::size_t i = 0; i < point->orbit.low.size(); ++i) field(point->orbit.low[i]), field(point->orbit.high[i]);
      csv += '\n';
    }
  return csv;
}

bool draw(const SpaceCurves& curves, const model::Model& model, const NamedSpace& space, const std::string& file) {
  return written(
      results::draw({.title = model.name, .panels = {panel_of(curves, space, 1), panel_of(curves, space, 2)}}, file));
}

}  // namespace continuo::app
