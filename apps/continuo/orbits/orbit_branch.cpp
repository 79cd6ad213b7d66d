// Branches of closed orbits over a parameter: followed, printed and drawn.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <apps/continuo/orbits/degenerate_curves.hpp>
#include <apps/continuo/orbits/orbit_branch.hpp>
#include <apps/continuo/orbits/orbit_curves.hpp>
#include <apps/continuo/orbits/steady_branches.hpp>
#include <apps/continuo/studies/branch_curves.hpp>
#include <apps/continuo/studies/orbit_text.hpp>
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
#include <continuo/studies/continuation.hpp>
#include <continuo/studies/hybrid_continuation.hpp>
#include <continuo/studies/orbit_continuation.hpp>

namespace continuo::app {
namespace {

using studies::OrbitBranch;

constexpr double search_share = 0.2;  // of the time, to find the orbit to begin with

std::string multipliers_text(const studies::OrbitPoint& point) {
  std::string text;
  for (const auto& value : point.multipliers) {
    if (value.imag() < 0) continue;  // its conjugate was there
    text += (text.empty() ? " " : ", ") + eigenvalue_text(value.real(), value.imag());
  }
  return text;
}

std::string table_of(const OrbitBranch& branch, const model::Model& model, const NamedRange& range) {
  const std::string& name = range.name;
  std::string text;
  // What the place is exact to leaves of a zero.
  const auto shown = [&](double value) { return std::abs(value) < 1e-8 * (range.high - range.low) ? 0 : value; };
  const auto end = [&](const char* word, const studies::OrbitBranchEnd& where) {
    return fmt::format("   {} at {} = {:.10g}: {}\n", word, name, shown(where.constant), where.reason);
  };
  text += fmt::format("{} orbits, period {:.10g} to {:.10g}{}\n", branch.points.size(), branch.points.front().period,
                      branch.points.back().period, advance_text(model, branch.points.back().advance));
  text += end("begins", branch.ends[0]);
  for (const studies::OrbitMark& mark : branch.marks) {
    text += fmt::format("   {} = {:.10g}: {}, period {:.10g}", name, shown(mark.at.constant), to_string(mark.kind),
                        mark.at.period);
    if (mark.kind == studies::OrbitBifurcation::torus)
      text += fmt::format(", {} turns a period", results::short_number(mark.rotation));
    text += ", multipliers" + multipliers_text(mark.at) + "\n";
  }
  return text + end("ends", branch.ends[1]);
}

std::string csv_of(const std::vector<OrbitBranch>& branches, const Studied& studied, const std::string& name) {
  const model::Model& model = studied.prepared.program->model;
  std::string csv = "branch,";
  results::append_field(csv, name);
  std::size_t multipliers = 0;
  for (const OrbitBranch& branch : branches)
    for (const studies::OrbitPoint& point : branch.points)
      multipliers = std::max(multipliers, point.multipliers.size());
  csv += ",period,stable" + orbit_columns(model, multipliers);
  const auto field = [&](double value) {
    csv += ',';
    results::append_number(csv, value);
  };
  for (std::size_t b = 0; b < branches.size(); ++b) {
    for (const studies::OrbitPoint& point : branches[b].points) {
      csv += fmt::format("{}", b + 1);
      field(point.constant);
      field(point.period);
      csv += point.stable ? ",1" : ",0";
      for (std::size_t i = 0; i < point.low.size(); ++i) field(point.low[i]), field(point.high[i]);
      for (const auto& value : point.multipliers) field(value.real()), field(value.imag());
      csv += '\n';
    }
  }
  return csv;
}

/// The greatest and the least value of one state, and the period, over the parameter.
results::Figure figure_of(const std::vector<OrbitBranch>& branches, const model::Model& model, std::size_t component,
                          const std::string& name) {
  const std::string& column = model.states[component].column;
  results::Panel extent{.x_label = name, .y_label = column + ", least and greatest", .curves = {}};
  results::Panel period{.x_label = name, .y_label = "period", .curves = {}};
  for (const OrbitBranch& branch : branches) {
    std::vector<double> constants, low, high, periods;
    std::vector<bool> stable;
    for (const studies::OrbitPoint& point : branch.points) {
      constants.push_back(point.constant);
      low.push_back(point.low[component]);
      high.push_back(point.high[component]);
      periods.push_back(point.period);
      stable.push_back(point.stable);
    }
    add_branch(extent, constants, high, stable);
    add_branch(extent, constants, low, stable);
    add_branch(period, constants, periods, stable);
  }
  results::Figure figure{.title = model.name, .panels = {std::move(extent)}};
  // Where all periods are the same to what is known of them there is nothing to see.
  double least = std::numeric_limits<double>::infinity(), greatest = 0;
  for (const OrbitBranch& branch : branches)
    for (const studies::OrbitPoint& point : branch.points) {
      least = std::min(least, point.period);
      greatest = std::max(greatest, point.period);
    }
  if (greatest - least > 1e-6 * greatest) figure.panels.push_back(std::move(period));
  return figure;
}

/// Where equilibria within the range begin to oscillate, each once.
std::vector<studies::HopfPoint> hopf_points(const Studied& studied, const NamedRange& range) {
  std::vector<studies::HopfPoint> found;
  studies::EquilibriumBox box{.low = {}, .high = {}, .interrupt = &interrupt_flag()};
  if (!set_box(studied, {}, box)) return found;
  const double now = studied.system.constants[0];
  const auto equilibria = now >= range.low && now <= range.high
                              ? studies::find_equilibria(studied.system, box).equilibria
                              : std::vector<studies::Equilibrium>();
  for (const studies::BranchOfDiagram& of : diagram_of(studied, equilibria, range, box).branches) {
    for (const studies::BifurcationPoint& point : of.branch.bifurcations) {
      if (point.kind != studies::Bifurcation::hopf) continue;
      const auto known = [&](const studies::HopfPoint& other) {
        double apart = std::abs(other.constant - point.at.constant) / (range.high - range.low);
        for (std::size_t i = 0; i < other.x.size(); ++i)
          apart = std::max(apart, std::abs(other.x[i] - point.at.x[i]) / std::max(1.0, std::abs(other.x[i])));
        return apart < 1e-5;
      };
      if (std::ranges::any_of(found, known)) continue;
      auto hopf = studies::find_hopf_point(studied.system, {.value = point.at.constant,
                                                            .low = range.low,
                                                            .high = range.high,
                                                            .x = point.at.x,
                                                            .angular_frequency = 2 * M_PI * point.frequency});
      if (hopf) found.push_back(std::move(*hopf));
    }
  }
  return found;
}

/// Whether an end of a branch is this orbit: of the same place and period there.
bool ends_at(const OrbitBranch& branch, const studies::OrbitPoint& orbit, const NamedRange& range) {
  constexpr double same = 1e-5;
  for (std::size_t side = 0; side < 2; ++side) {
    const studies::OrbitPoint& last = side == 0 ? branch.points.front() : branch.points.back();
    if (std::abs(last.constant - orbit.constant) > same * (range.high - range.low)) continue;
    if (std::abs(last.period - orbit.period) > same * orbit.period) continue;
    const auto alike = [](const std::vector<double>& a, const std::vector<double>& b) {
      for (std::size_t i = 0; i < a.size(); ++i)
        if (std::abs(a[i] - b[i]) > 1e-3 * std::max({std::abs(a[i]), std::abs(b[i]), 1e-3})) return false;
      return true;
    };
    if (alike(last.low, orbit.low) && alike(last.high, orbit.high)) return true;
  }
  return false;
}

/// Orbits through events, or of what depends on the time: how to go on from an orbit and from a mark.
struct HybridBranches {
  const Studied& studied;
  const OrbitBranchOptions& options;
  studies::HybridOrbitOptions search;

  studies::HybridContinuationOptions with(const studies::OrbitContinuationOptions& continuation) const {
    studies::HybridContinuationOptions all{continuation, search.forcing};
    all.constant = model::find_parameter(studied.prepared.program->model, options.range.name);
    return all;
  }
  OrbitBranch main(const studies::OrbitContinuationOptions& continuation, Progress& progress) const {
    studies::HybridOrbitOptions looking = search;
    looking.progress = progress.parts(0, search_share);
    const studies::HybridOrbit start = find_hybrid_orbit(studied, *options.hybrid, looking);
    OrbitBranch none;
    if (!start.outcome) {
      none.status = {.ending = start.outcome.ending,
                     .message = start.outcome.hint.empty() ? describe(start.outcome) : start.outcome.hint};
      return none;
    }
    return studies::continue_hybrid_orbit(studied.prepared.program, studied.prepared.experiment, start,
                                          with(continuation));
  }
  OrbitBranch beginning_at(const studies::OrbitMark& mark,
                           const studies::OrbitContinuationOptions& continuation) const {
    return studies::continue_hybrid_orbit(studied.prepared.program, studied.prepared.experiment, mark,
                                          with(continuation));
  }
};

/// From the orbit that the motion comes to; from Hopf points where there is none, or the user wants them.
void follow_main(const Studied& studied, const OrbitBranchOptions& options,
                 studies::OrbitContinuationOptions& continuation, Progress& progress,
                 std::vector<OrbitBranch>& branches) {
  if (!options.from_hopf) {
    studies::PeriodicOrbitOptions search = options.search;
    search.progress = progress.parts(0, search_share);
    const auto start = find_orbit(studied, search, options.patient);
    if (start.outcome) {
      branches.push_back(studies::continue_orbit(studied.system, start, continuation));
      return;
    }
    if (interrupt_flag()) return;
    say(fmt::format("no orbit was found from the initial state: {}; trying the Hopf points of equilibria",
                    start.outcome.hint.empty() ? describe(start.outcome) : start.outcome.hint));
  }
  const auto points = hopf_points(studied, options.range);
  for (std::size_t k = 0; k < points.size() && !interrupt_flag(); ++k) {
    studies::OrbitPoint rest;
    rest.constant = points[k].constant;
    rest.period = 2 * M_PI / points[k].angular_frequency;
    rest.low = rest.high = points[k].x;
    if (std::ranges::any_of(branches, [&](const OrbitBranch& branch) {
          return !branch.points.empty() && ends_at(branch, rest, options.range);
        }))
      continue;  // it is the other end of one that is known
    const double share = 1 / static_cast<double>(points.size());
    continuation.progress = progress.parts(share * static_cast<double>(k), share);
    branches.push_back(studies::continue_orbit(studied.system, points[k], continuation));
  }
}

/// Also the branches that begin on those, of twice the period or at a crossing, and on these again.
std::vector<OrbitBranch> follow(const Studied& studied, const OrbitBranchOptions& options,
                                const std::optional<HybridBranches>& hybrid) {
  const NamedRange& range = options.range;
  Progress progress;
  studies::OrbitContinuationOptions continuation{.low = range.low,
                                                 .high = range.high,
                                                 .rtol = std::clamp(options.search.rtol, 1e-12, 1e-6),
                                                 .interrupt = &interrupt_flag(),
                                                 .progress = progress.parts(search_share, 1 - search_share)};
  options.steps.set(continuation);
  std::vector<OrbitBranch> branches;
  if (hybrid) {
    branches.push_back(hybrid->main(continuation, progress));
  } else {
    follow_main(studied, options, continuation, progress, branches);
  }
  const std::size_t most = branches.size() + options.others;
  for (std::size_t k = 0; k < branches.size() && branches.size() < most; ++k) {
    for (const studies::OrbitMark& mark : std::vector(branches[k].marks)) {
      const bool doubling = mark.kind == studies::OrbitBifurcation::period_doubling;
      if ((!doubling && mark.kind != studies::OrbitBifurcation::crossing) || branches.size() >= most) continue;
      if (interrupt_flag()) return branches;
      studies::OrbitPoint first(mark.at);
      if (doubling) {
        first.period *= 2;
        for (double& part : first.advance) part *= 2;
      }
      if (std::ranges::any_of(branches, [&](const OrbitBranch& branch) {
            return !branch.points.empty() && ends_at(branch, first, range);
          }))
        continue;
      OrbitBranch branch = hybrid ? hybrid->beginning_at(mark, continuation)
                                  : studies::continue_orbit(studied.system, mark, continuation);
      if (!branch.status) say(describe(branch.status));
      if (branch.points.size() > 2) branches.push_back(std::move(branch));
    }
  }
  return branches;
}

nlohmann::json json_of(const studies::OrbitPoint& point) {
  return {{"at", point.constant},   {"period", point.period},  {"x", point.x},
          {"min", point.low},       {"max", point.high},       {"multipliers", app::json_of(point.multipliers)},
          {"stable", point.stable}, {"advance", point.advance}};
}
nlohmann::json json_of(const std::vector<OrbitBranch>& branches, const model::Model& model, const NamedRange& range) {
  auto list = nlohmann::json::array();
  for (const OrbitBranch& branch : branches) {
    nlohmann::json entry{{"points", nlohmann::json::array()},
                         {"bifurcations", nlohmann::json::array()},
                         {"ends", nlohmann::json::array()}};
    for (const studies::OrbitPoint& point : branch.points) entry["points"].push_back(json_of(point));
    for (const studies::OrbitMark& mark : branch.marks) {
      nlohmann::json at = json_of(mark.at);
      at["kind"] = to_string(mark.kind);
      if (mark.kind == studies::OrbitBifurcation::torus) at["rotation"] = mark.rotation;
      entry["bifurcations"].push_back(std::move(at));
    }
    for (const studies::OrbitBranchEnd& end : branch.ends)
      entry["ends"].push_back({{"at", end.constant}, {"reason", end.reason}});
    list.push_back(std::move(entry));
  }
  auto states = nlohmann::json::array();
  for (const model::State& state : model.states) states.push_back(state.column);
  return {{"parameter", range.name}, {"states", states}, {"branches", list}};
}

/// What is marked on curves in two parameters, in three: the table and the picture are of this.
ExitCode show_degenerate(const Studied& studied, const std::vector<studies::OrbitCurveOfDiagram>& curves,
                         const OrbitBranchOptions& options, nlohmann::json& document) {
  const model::Model& model = studied.prepared.program->model;
  const NamedSpace space{options.range, *options.second, *options.third};
  const auto degenerate = app::curves_of(studied, curves, space, options.steps);
  if (options.json) {
    document["three"] = app::json_of(degenerate, space);
    answer("continuo.orbit_branches/1", document);
  } else {
    print(app::text_of(degenerate, space));
  }
  if (!options.out.empty()) {
    const std::string csv = app::csv_of(degenerate, model, space);
    if (options.out == "-") {
      print(csv);
    } else if (!written(results::write_file(options.out, csv)))
      return usage;
  }
  if (!options.plot.empty() && !draw(degenerate, model, space, options.plot)) return usage;
  return interrupt_flag() ? interrupted : done;
}

/// The branches, which are shown before, in both parameters.
ExitCode show_curves(const Studied& studied, const std::vector<OrbitBranch>& branches,
                     const OrbitBranchOptions& options) {
  const model::Model& model = studied.prepared.program->model;
  const NamedPlane plane{options.range, *options.second};
  const auto curves = curves_of(studied, branches, plane, options.steps);
  nlohmann::json document;
  if (options.json) {
    document = json_of(branches, model, options.range);
    document.update(app::json_of(curves, plane));
    if (!options.third) answer("continuo.orbit_branches/1", document);
  } else {
    print(text_of(curves, plane));
  }
  if (options.third) return show_degenerate(studied, curves, options, document);
  if (!options.out.empty()) {
    const std::string csv = app::csv_of(curves, model, plane);
    if (options.out == "-") {
      print(csv);
    } else if (!written(results::write_file(options.out, csv)))
      return usage;
  }
  if (!options.plot.empty() && !draw(curves, model, plane, options.plot)) return usage;
  return interrupt_flag() ? interrupted : done;
}

}  // namespace

studies::PeriodicOrbit find_orbit(const Studied& studied, studies::PeriodicOrbitOptions search, bool patient) {
  constexpr double times_longer = 10;
  constexpr int most_tries = 3;
  auto found = studies::find_periodic_orbit(studied.system, studied.start, search);
  for (int k = 1; k < most_tries && patient && !found.outcome && found.wanders && !interrupt_flag(); ++k) {
    search.settle *= times_longer;
    search.duration *= times_longer;
    found = studies::find_periodic_orbit(studied.system, studied.start, search);
  }
  return found;
}

ExitCode show_orbit_branches(const Studied& studied, const OrbitBranchOptions& options) {
  const model::Model& model = studied.prepared.program->model;
  const NamedRange& range = options.range;
  const double now = studied.system.constants[0];
  if (!options.from_hopf && !(now >= range.low && now <= range.high)) {
    say(fmt::format("{} is {:.10g}, outside of {:.10g}..{:.10g}: --set {}=VALUE gives it a value to begin with",
                    range.name, now, range.low, range.high, range.name));
    return usage;
  }
  if (options.second && !is_plane(studied, {range, *options.second}, "orbits")) return usage;
  if (options.third && !is_space(studied, {range, *options.second, *options.third})) return usage;
  std::optional<std::size_t> component = 0;
  if (!options.of.empty()) component = state_named(model, options.of);
  if (!component) return usage;
  std::optional<HybridBranches> hybrid;
  if (options.hybrid) {
    const auto search = search_of(studied, *options.hybrid);
    if (!search) return wrong_model;
    hybrid.emplace(HybridBranches{studied, options, *search});
  }
  std::vector<OrbitBranch> branches = follow(studied, options, hybrid);
  for (const OrbitBranch& branch : branches)
    if (!branch.status) say(describe(branch.status));
  std::erase_if(branches, [](const OrbitBranch& branch) { return branch.points.empty(); });
  if (branches.empty()) {
    if (interrupt_flag()) return interrupted;
    say(fmt::format("no orbit was found to follow along {}={:.10g}..{:.10g}", range.name, range.low, range.high));
    return numerical_failure;
  }
  if (options.json && !options.second) answer("continuo.orbit_branches/1", json_of(branches, model, range));
  for (std::size_t b = 0; b < branches.size() && !options.json; ++b)
    print((branches.size() == 1 ? "" : fmt::format("{}{}: ", b == 0 ? "" : "\n", b + 1)) +
          table_of(branches[b], model, range));
  if (options.second) return show_curves(studied, branches, options);
  if (!options.out.empty()) {
    const std::string csv = csv_of(branches, studied, range.name);
    if (options.out == "-") {
      print(csv);
    } else if (!written(results::write_file(options.out, csv)))
      return usage;
  }
  if (!options.plot.empty()) {
    if (!written(results::draw(figure_of(branches, model, *component, range.name), options.plot))) return usage;
  }
  return interrupt_flag() ? interrupted : done;
}

}  // namespace continuo::app
