// Curves of bifurcations of closed orbits in two parameters: followed, printed and drawn.
#include <algorithm>
#include <cmath>

#include <apps/continuo/orbits/orbit_curves.hpp>
#include <apps/continuo/studies/branch_curves.hpp>
#include <apps/continuo/studies/orbit_text.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

using studies::DegenerateOrbit;
using studies::OrbitCurve;
using studies::OrbitCurvePoint;
using OrbitCurves = std::vector<studies::OrbitCurveOfDiagram>;

constexpr std::size_t most_orbit_curves = 12;

std::string orbit_place(const OrbitCurvePoint& point, const NamedPlane& plane) {
  const auto shown = [](double value, const NamedRange& range) {
    return std::abs(value) < 1e-8 * (range.high - range.low) ? 0 : value;
  };
  return fmt::format("{} = {:.8g}, {} = {:.8g}", plane.first.name, shown(point.constants[0], plane.first),
                     plane.second.name, shown(point.constants[1], plane.second));
}

nlohmann::json json_of(const OrbitCurvePoint& point, const OrbitCurve& curve) {
  nlohmann::json entry{
      {"at", {point.constants[0], point.constants[1]}}, {"x", point.x}, {"min", point.low}, {"max", point.high}};
  if (is_homoclinic(curve.kind)) {
    entry["interval"] = point.period;
    entry["eigenvalues"] = app::json_of(point.eigenvalues);
    entry["truncation"] = point.truncation;
    return entry;
  }
  entry["period"] = point.period;
  entry["multipliers"] = app::json_of(point.multipliers);
  if (curve.kind == studies::OrbitBifurcation::torus) entry["rotation"] = point.rotation;
  return entry;
}

/// The points of a curve and between them those that are more.
std::vector<std::pair<const OrbitCurvePoint*, const DegenerateOrbit*>> orbits_of(const OrbitCurve& curve) {
  std::vector<std::pair<const OrbitCurvePoint*, const DegenerateOrbit*>> points;
  auto mark = curve.marks.begin();
  for (std::size_t i = 0; i <= curve.points.size(); ++i) {
    for (; mark != curve.marks.end() && mark->next == i; ++mark) points.emplace_back(&mark->at, &*mark);
    if (i < curve.points.size()) points.emplace_back(&curve.points[i], nullptr);
  }
  return points;
}

const char* color_of(studies::OrbitBifurcation kind) {
  using enum studies::OrbitBifurcation;
  if (kind == torus) return "#cc79a7";
  if (kind == period_doubling) return "#e69f00";
  if (kind == central_homoclinic) return "#009e73";
  return kind == fold ? "#444444" : "#56b4e9";
}

}  // namespace

OrbitCurves curves_of(const Studied& studied, const std::vector<studies::OrbitBranch>& branches,
                      const NamedPlane& plane, const BranchSteps& steps) {
  // Homoclinic ends first: there may be any number of folds and period doublings on the way to one.
  std::vector<studies::OrbitMark> starts;
  for (const studies::OrbitBranch& branch : branches)
    for (const studies::OrbitBranchEnd& end : branch.ends)
      if (end.last) starts.push_back(*end.last);
  for (const studies::OrbitBranch& branch : branches)
    starts.insert(starts.end(), branch.marks.begin(), branch.marks.end());
  Progress progress;
  studies::OrbitCurveOptions options{.low = {plane.first.low, plane.second.low},
                                     .high = {plane.first.high, plane.second.high},
                                     .interrupt = &interrupt_flag(),
                                     .progress = progress.parts()};
  steps.set(options);
  return studies::orbit_curves(studied.system, starts, options, most_orbit_curves);
}

std::string text_of(const OrbitCurves& curves, const NamedPlane& plane) {
  if (curves.empty())
    return fmt::format(
        "\nno fold, period doubling, torus or homoclinic orbit was found along {}, so none is followed in "
        "{}\n",
        plane.first.name, plane.second.name);
  std::string text;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const OrbitCurve& curve = curves[k].curve;
    const bool homoclinic = is_homoclinic(curve.kind);
    text += fmt::format(
        "\ncurve {} of {}: ", k + 1,
        curve.kind == studies::OrbitBifurcation::torus ? "tori" : fmt::format("{}s", to_string(curve.kind)));
    if (curve.points.empty()) {
      text += curve.status.message + "\n";
      continue;
    }
    text += fmt::format("{} orbits\n", curve.points.size());
    const bool closed = curve.ends[0].ending == studies::OrbitCurveEnding::closed;
    text += closed ? fmt::format("   closed, through {}\n", orbit_place(curve.points.front(), plane))
                   : fmt::format("   from {}: {}\n", orbit_place(curve.points.front(), plane), curve.ends[0].reason);
    for (const DegenerateOrbit& mark : curve.marks)
      text += fmt::format("   {}: {}{}\n", orbit_place(mark.at, plane), to_string(mark.kind),
                          homoclinic ? "" : fmt::format(", period {:.8g}", mark.at.period));
    if (!closed) text += fmt::format("   to {}: {}\n", orbit_place(curve.points.back(), plane), curve.ends[1].reason);
  }
  return text;
}

nlohmann::json json_of(const OrbitCurves& curves, const NamedPlane& plane) {
  auto list = nlohmann::json::array();
  for (const auto& [curve, starts] : curves) {
    nlohmann::json entry{{"kind", to_string(curve.kind)},
                         {"points", nlohmann::json::array()},
                         {"degenerate", nlohmann::json::array()},
                         {"ends", nlohmann::json::array()}};
    if (!curve.status) entry["message"] = curve.status.message;
    for (const OrbitCurvePoint& point : curve.points) entry["points"].push_back(json_of(point, curve));
    for (const DegenerateOrbit& mark : curve.marks) {
      nlohmann::json at = json_of(mark.at, curve);
      at["kind"] = to_string(mark.kind);
      entry["degenerate"].push_back(std::move(at));
    }
    if (!curve.points.empty())
      for (std::size_t side = 0; side < 2; ++side) {
        const OrbitCurvePoint& last = side == 0 ? curve.points.front() : curve.points.back();
        entry["ends"].push_back({{"at", {last.constants[0], last.constants[1]}}, {"reason", curve.ends[side].reason}});
      }
    list.push_back(std::move(entry));
  }
  return {{"parameters", {plane.first.name, plane.second.name}}, {"curves", list}};
}

std::string csv_of(const OrbitCurves& curves, const model::Model& model, const NamedPlane& plane) {
  std::string csv = "curve,kind,";
  results::append_field(csv, plane.first.name);
  csv += ',';
  results::append_field(csv, plane.second.name);
  csv += ",period,rotation" + orbit_columns(model, model.states.size() - 1);
  const auto field = [&](double value) {
    csv += ',';
    results::append_number(csv, value);
  };
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const OrbitCurve& curve = curves[k].curve;
    for (const auto& [point, mark] : orbits_of(curve)) {
      csv += fmt::format("{},{}", k + 1, mark ? to_string(mark->kind) : to_string(curve.kind));
      for (const double value : point->constants) field(value);
      if (is_homoclinic(curve.kind))
        csv += ",,";
      else
        field(point->period), field(point->rotation);
      for (std::size_t i = 0; i < point->low.size(); ++i) field(point->low[i]), field(point->high[i]);
      for (const auto& value : point->multipliers) field(value.real()), field(value.imag());
      for (std::size_t j = point->multipliers.size() + 1; j < model.states.size(); ++j) csv += ",,";
      csv += '\n';
    }
  }
  return csv;
}

bool draw(const OrbitCurves& curves, const model::Model& model, const NamedPlane& plane, const std::string& file) {
  results::Panel panel{.x_label = plane.first.name, .y_label = plane.second.name, .curves = {}};
  for (const auto& of : curves) {
    const std::string label(to_string(of.curve.kind));
    const bool named =
        std::ranges::any_of(panel.curves, [&](const results::Curve& other) { return other.label == label; });
    results::Curve line{.label = named ? "" : label, .x = {}, .y = {}, .color = color_of(of.curve.kind)};
    for (const auto& [point, mark] : orbits_of(of.curve)) {
      line.x.push_back(point->constants[0]);
      line.y.push_back(point->constants[1]);
    }
    if (!line.x.empty()) panel.curves.push_back(std::move(line));
  }
  for (const auto& of : curves)
    for (const DegenerateOrbit& mark : of.curve.marks)
      add_bifurcation(panel, std::string(to_string(mark.kind)), mark.at.constants[0], mark.at.constants[1]);
  return written(results::draw({.title = model.name, .panels = {std::move(panel)}}, file));
}

}  // namespace continuo::app
