// Branches of equilibria over a parameter: followed, printed and drawn.
#include <algorithm>
#include <cmath>

#include <apps/continuo/orbits/bifurcation_text.hpp>
#include <apps/continuo/orbits/steady_branches.hpp>
#include <apps/continuo/studies/branch_curves.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

using studies::Branch;

constexpr std::size_t values_elsewhere = 4, starts_elsewhere = 60;

/// What the place is exact to leaves of a zero.
double shown(double value, const NamedRange& range) {
  return std::abs(value) < 1e-11 * (range.high - range.low) ? 0 : value;
}

std::string text_of(const studies::BifurcationPoint& point, const NamedRange& range, std::string_view state) {
  std::string line =
      fmt::format("   {} = {:.10g}{}: {}", range.name, shown(point.at.constant, range), state, to_string(point.kind));
  if (point.kind == studies::Bifurcation::hopf) {
    line += fmt::format(", frequency {}", results::short_number(point.frequency));
    if (point.coefficient)
      line += fmt::format(", {} (first Lyapunov coefficient {})",
                          *point.coefficient < 0   ? "supercritical"
                          : *point.coefficient > 0 ? "subcritical"
                                                   : "degenerate",
                          results::short_number(*point.coefficient));
  }
  if (point.kind == studies::Bifurcation::fold && point.coefficient)
    line += fmt::format(", coefficient {}", results::short_number(*point.coefficient));
  return line + "\n";
}

/// The points of a branch and between them those where its stability changes.
std::vector<const studies::BranchPoint*> all_points(const Branch& branch) {
  std::vector<const studies::BranchPoint*> points;
  auto bifurcation = branch.bifurcations.begin();
  for (std::size_t i = 0; i <= branch.points.size(); ++i) {
    for (; bifurcation != branch.bifurcations.end() && bifurcation->next == i; ++bifurcation)
      points.push_back(&bifurcation->at);
    if (i < branch.points.size()) points.push_back(&branch.points[i]);
  }
  return points;
}

nlohmann::json json_of(const studies::BranchPoint& point) {
  return {{"at", point.constant},
          {"x", point.x},
          {"stability", to_string(point.stability)},
          {"eigenvalues", app::json_of(point.eigenvalues)}};
}

}  // namespace

void add_curves(const studies::Branch& branch, std::size_t component, results::Panel& panel) {
  std::vector<double> constants, values;
  std::vector<bool> stable;
  const auto points = all_points(branch);
  for (const studies::BranchPoint* point : points) {
    constants.push_back(point->constant);
    values.push_back(point->x[component]);
    stable.push_back(point->stability == studies::Stability::asymptotically_stable);
  }
  for (std::size_t i = points.size(); i-- > 1;)  // where it changes it is neither: the piece behind begins there
    if (points[i - 1]->stability == studies::Stability::undecided) stable[i - 1] = stable[i];
  add_branch(panel, constants, values, stable);
  for (const studies::BifurcationPoint& point : branch.bifurcations)
    add_bifurcation(panel, std::string(to_string(point.kind)), point.at.constant, point.at.x[component]);
}

nlohmann::json json_of(const std::vector<std::complex<double>>& values) {
  auto list = nlohmann::json::array();
  for (const auto& value : values) list.push_back({value.real(), value.imag()});
  return list;
}

SteadyDiagram diagram_of(const Studied& studied, const std::vector<studies::Equilibrium>& known,
                         const NamedRange& range, const studies::EquilibriumBox& box, const BranchSteps& steps) {
  SteadyDiagram diagram;
  const double now = studied.system.constants[0];
  for (const studies::Equilibrium& e : known)
    if (now >= range.low && now <= range.high) diagram.starts.push_back({now, e.x});
  Progress progress;
  studies::EquilibriumBox elsewhere(box);
  elsewhere.starts = std::min(box.starts, starts_elsewhere);
  elsewhere.progress = {};
  for (std::size_t k = 0; k < values_elsewhere && !interrupt_flag(); ++k) {
    ParametricSystem there(studied.system);
    there.constants[0] = range.low + (range.high - range.low) * (static_cast<double>(k) + 0.5) / values_elsewhere;
    for (studies::Equilibrium& e : studies::find_equilibria(there, elsewhere).equilibria)
      if (e.isolated) diagram.starts.push_back({there.constants[0], std::move(e.x)});
  }
  studies::ContinuationOptions options{
      .low = range.low, .high = range.high, .interrupt = &interrupt_flag(), .progress = progress.parts()};
  steps.set(options);
  diagram.branches = studies::continue_equilibria(studied.system, diagram.starts, options);
  return diagram;
}

std::string text_of(const SteadyDiagram& diagram, const model::Model& model, const NamedRange& range,
                    std::size_t known) {
  std::string text;
  for (std::size_t k = 0; k < diagram.branches.size(); ++k) {
    const auto& [branch, starts, crossed] = diagram.branches[k];
    std::vector<std::size_t> places;
    for (const std::size_t start : starts)
      if (start < known) places.push_back(start + 1);
    std::string whence;
    if (!places.empty()) {
      whence = fmt::format(", from {}", fmt::join(places, " and "));
    } else if (crossed) {
      whence = fmt::format(", across branch {}", *crossed + 1);
    } else {
      whence = fmt::format(", found at {} = {:.10g}", range.name, diagram.starts[starts.front()].constant);
    }
    text += fmt::format("\nbranch {}{}: {} points{}\n", k + 1, whence, branch.points.size(),
                        branch.status ? "" : fmt::format("; {}", branch.status.message));
    for (const studies::BifurcationPoint& point : branch.bifurcations)
      text += text_of(point, range, state_text(diagram.branches, point, model));
  }
  return text;
}

nlohmann::json json_of(const SteadyDiagram& diagram, const model::Model& model, const NamedRange& range) {
  auto branches = nlohmann::json::array();
  for (const auto& [branch, starts, crossed] : diagram.branches) {
    nlohmann::json entry{{"points", nlohmann::json::array()},
                         {"bifurcations", nlohmann::json::array()},
                         {"complete", static_cast<bool>(branch.status)},
                         {"message", branch.status.message}};
    if (crossed) entry["across"] = *crossed + 1;
    for (const studies::BranchPoint& point : branch.points) entry["points"].push_back(json_of(point));
    for (const studies::BifurcationPoint& point : branch.bifurcations) {
      nlohmann::json at = json_of(point.at);
      at["kind"] = to_string(point.kind);
      if (point.kind == studies::Bifurcation::hopf) at["frequency"] = point.frequency;
      if (point.coefficient)
        at[point.kind == studies::Bifurcation::hopf ? "first_lyapunov_coefficient" : "coefficient"] =
            *point.coefficient;
      entry["bifurcations"].push_back(std::move(at));
    }
    branches.push_back(std::move(entry));
  }
  auto states = nlohmann::json::array();
  for (const model::State& state : model.states) states.push_back(state.column);
  return {{"parameter", range.name}, {"states", states}, {"branches", branches}};
}

std::string csv_of(const SteadyDiagram& diagram, const model::Model& model, const NamedRange& range) {
  std::string csv = "branch,kind,";
  results::append_field(csv, range.name);
  csv += ",stable";
  for (const model::State& state : model.states) {
    csv += ',';
    results::append_field(csv, state.column);
  }
  std::size_t most = 0;
  for (const auto& of : diagram.branches)
    for (const auto& point : of.branch.points) most = std::max(most, point.eigenvalues.size());
  for (std::size_t k = 1; k <= most; ++k) csv += fmt::format(",eigenvalue {0} re,eigenvalue {0} im", k);
  csv += "\n";
  const auto field = [&](double value) {
    csv += ',';
    results::append_number(csv, value);
  };
  for (std::size_t b = 0; b < diagram.branches.size(); ++b) {
    const Branch& branch = diagram.branches[b].branch;
    for (const studies::BranchPoint* point : all_points(branch)) {
      const auto special =
          std::ranges::find_if(branch.bifurcations, [&](const auto& bifurcation) { return &bifurcation.at == point; });
      csv += fmt::format("{},{}", b + 1, special == branch.bifurcations.end() ? "" : to_string(special->kind));
      field(point->constant);
      csv += point->stability == studies::Stability::asymptotically_stable ? ",1" : ",0";
      for (const double x : point->x) field(x);
      for (const auto& value : point->eigenvalues) field(value.real()), field(value.imag());
      for (std::size_t k = point->eigenvalues.size(); k < most; ++k) csv += ",,";
      csv += '\n';
    }
  }
  return csv;
}

bool draw(const SteadyDiagram& diagram, const model::Model& model, const NamedRange& range, std::size_t component,
          const std::string& file) {
  results::Panel panel{.x_label = range.name, .y_label = model.states[component].column, .curves = {}};
  for (const auto& of : diagram.branches) add_curves(of.branch, component, panel);
  return written(results::draw({.title = model.name, .panels = {std::move(panel)}}, file));
}

}  // namespace continuo::app
