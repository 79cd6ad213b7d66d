// Families of solutions of a boundary-value problem over a parameter: printed and drawn.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <apps/continuo/options/models.hpp>
#include <apps/continuo/studies/boundary_families.hpp>
#include <apps/continuo/studies/branch_curves.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/results/table_file.hpp>
#include <continuo/studies/boundary_family_of_model.hpp>

namespace continuo::app {
namespace {

using studies::Family;
using studies::FamilyEvent;
using studies::FamilyMark;
using studies::FamilyPoint;
using studies::ModelFamilies;

struct Shown {
  const model::Model& model;
  std::string parameter;
  double low, high;

  /// What a place is exact to leaves of a zero.
  double constant(double value) const { return std::abs(value) < 1e-11 * (high - low) ? 0 : value; }
};

struct Extent {
  double low, high, at_start, at_end;
};
Extent extent_of(const boundary::BoundaryValueSolution& solution, std::size_t component) {
  Extent extent{.low = solution.points[component],
                .high = solution.points[component],
                .at_start = solution.points[component],
                .at_end = solution.points[solution.points.size() - solution.size + component]};
  for (std::size_t i = component; i < solution.points.size(); i += solution.size) {
    extent.low = std::min(extent.low, solution.points[i]);
    extent.high = std::max(extent.high, solution.points[i]);
  }
  return extent;
}

/// The points of a family and between them its marks.
std::vector<std::pair<const FamilyPoint*, const FamilyMark*>> all_points(const Family& family) {
  std::vector<std::pair<const FamilyPoint*, const FamilyMark*>> points;
  auto mark = family.marks.begin();
  for (std::size_t i = 0; i <= family.points.size(); ++i) {
    for (; mark != family.marks.end() && mark->next == i; ++mark) points.emplace_back(&mark->at, &*mark);
    if (i < family.points.size()) points.emplace_back(&family.points[i], nullptr);
  }
  return points;
}

std::string text_of(const ModelFamilies& found, const Shown& shown, std::size_t component) {
  std::string text;
  const std::string& state = shown.model.states[component].column;
  for (std::size_t k = 0; k < found.families.size(); ++k) {
    const Family& family = found.families[k];
    const auto [low, high] = std::ranges::minmax(family.points, {}, &FamilyPoint::constant);
    text += fmt::format("{}family {}{}: {} solutions, {} from {:.6g} to {:.6g}{}\n", k == 0 ? "" : "\n", k + 1,
                        family.crossed ? fmt::format(", across family {}", *family.crossed + 1) : "",
                        family.points.size(), shown.parameter, shown.constant(low.constant),
                        shown.constant(high.constant), family.status ? "" : fmt::format("; {}", family.status.message));
    if (family.crossings_left > 0)
      text += fmt::format("   {} of its crossings not followed, for there are many families: ask for a smaller range\n",
                          family.crossings_left);
    for (const double near : family.doubtful)
      text +=
          fmt::format("   {} = {:.3g} or so: something happens, but its place was not found\n", shown.parameter, near);
    for (const FamilyMark& mark : family.marks)
      text += fmt::format("   {} = {:.10g}: {}, {} reaches {}\n", shown.parameter, shown.constant(mark.at.constant),
                          to_string(mark.kind), state,
                          results::short_number(studies::farthest_from_zero(mark.at.solution, component)));
  }
  return text;
}

nlohmann::json json_of(const FamilyPoint& point, const Shown& shown) {
  nlohmann::json states = nlohmann::json::object();
  for (std::size_t i = 0; i < shown.model.states.size(); ++i) {
    const Extent extent = extent_of(point.solution, i);
    states[shown.model.states[i].column] = {
        {"low", extent.low}, {"high", extent.high}, {"start", extent.at_start}, {"end", extent.at_end}};
  }
  return {{"at", point.constant}, {"states", states}};
}

nlohmann::json json_of(const ModelFamilies& found, const Shown& shown) {
  auto families = nlohmann::json::array();
  for (const Family& family : found.families) {
    nlohmann::json entry{{"points", nlohmann::json::array()},
                         {"marks", nlohmann::json::array()},
                         {"complete", static_cast<bool>(family.status)},
                         {"message", family.status.message},
                         {"doubtful", family.doubtful},
                         {"crossings_left", family.crossings_left}};
    if (family.crossed) entry["across"] = *family.crossed + 1;
    for (const FamilyPoint& point : family.points) entry["points"].push_back(json_of(point, shown));
    for (const FamilyMark& mark : family.marks) {
      nlohmann::json at = json_of(mark.at, shown);
      at["kind"] = to_string(mark.kind);
      entry["marks"].push_back(std::move(at));
    }
    families.push_back(std::move(entry));
  }
  return {{"parameter", shown.parameter}, {"families", families}};
}

std::string csv_of(const ModelFamilies& found, const Shown& shown) {
  std::string csv = "family,kind,";
  results::append_field(csv, shown.parameter);
  for (const model::State& state : shown.model.states)
    for (const char* what : {"low", "high", "start", "end"}) {
      csv += ',';
      results::append_field(csv, fmt::format("{} {}", state.column, what));
    }
  csv += '\n';
  for (std::size_t k = 0; k < found.families.size(); ++k)
    for (const auto& [point, mark] : all_points(found.families[k])) {
      csv += fmt::format("{},{}", k + 1, mark ? to_string(mark->kind) : "");
      const auto field = [&](double value) {
        csv += ',';
        results::append_number(csv, value);
      };
      field(point->constant);
      for (std::size_t i = 0; i < shown.model.states.size(); ++i) {
        const Extent extent = extent_of(point->solution, i);
        for (const double value : {extent.low, extent.high, extent.at_start, extent.at_end}) field(value);
      }
      csv += '\n';
    }
  return csv;
}

bool draw(const ModelFamilies& found, const Shown& shown, std::size_t component, const std::string& file) {
  results::Panel panel{.x_label = shown.parameter,
                       .y_label = fmt::format("{}, farthest from zero", shown.model.states[component].column),
                       .curves = {}};
  for (std::size_t k = 0; k < found.families.size(); ++k) {
    results::Curve curve{.label = found.families.size() > 1 ? fmt::format("family {}", k + 1) : "", .x = {}, .y = {}};
    for (const auto& [point, mark] : all_points(found.families[k])) {
      curve.x.push_back(point->constant);
      curve.y.push_back(studies::farthest_from_zero(point->solution, component));
    }
    panel.curves.push_back(std::move(curve));
  }
  for (const Family& family : found.families)
    for (const FamilyMark& mark : family.marks)
      add_bifurcation(panel, std::string(to_string(mark.kind)), mark.at.constant,
                      studies::farthest_from_zero(mark.at.solution, component));
  return written(results::draw({.title = shown.model.name, .panels = {std::move(panel)}}, file));
}

}  // namespace

ExitCode show_families(const Prepared& prepared, const boundary::BoundaryRequest& request,
                       const boundary::BoundaryRequest::Along& range, const std::string& of,
                       const RunOutputs& outputs) {
  const model::Model& model = prepared.program->model;
  std::optional<std::size_t> component = 0;
  if (!of.empty()) component = state_named(model, of);
  if (!component) return usage;
  if (!(range.from < range.to)) {
    say(fmt::format("--family {}: the range must go from a smaller value to a greater one", range.parameter));
    return usage;
  }
  if (const auto format = results::table_format(outputs.motion);
      !outputs.motion.empty() && format && *format != results::TableFormat::csv) {
    say(fmt::format("cannot write {}: the table of --family is CSV", outputs.motion));
    return usage;
  }
  model::Experiment experiment = prepared.experiment;
  experiment.interrupt = &interrupt_flag();
  const ModelFamilies found = [&] {
    Progress progress;
    return studies::families_of_model(prepared.program, experiment,
                                      {range.parameter, range.from, range.to, request.guess, progress.parts()});
  }();
  show(found.diagnostics, prepared.loaded.source);
  if (found.families.empty()) return interrupt_flag() ? interrupted : numerical_failure;
  const Shown shown{model, range.parameter, range.from, range.to};
  if (outputs.json) answer("continuo.families/1", json_of(found, shown));
  if (outputs.motion == "-")
    print(csv_of(found, shown));
  else if (!outputs.motion.empty() && !written(results::write_file(outputs.motion, csv_of(found, shown))))
    return usage;
  if (!outputs.data_to_standard_output()) print(text_of(found, shown, *component));
  if (!outputs.plot.empty() && !draw(found, shown, *component, outputs.plot)) return usage;
  return interrupt_flag() ? interrupted : done;
}

}  // namespace continuo::app
