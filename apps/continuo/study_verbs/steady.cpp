// continuo steady FILE: the equilibria of a model, their stability, and their dependence on a parameter.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/orbits/steady_branches.hpp>
#include <apps/continuo/orbits/steady_curves.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/output_file.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::app {
namespace {

struct SteadyOptions {
  ExperimentOptions experiment;
  std::string mode, along, plot, out, of;
  std::vector<std::string> and_along;  // once, or it is refused
  BranchSteps steps;
  bool json = false;
  std::vector<std::string> box;
  std::size_t starts = 200;
};

constexpr std::size_t most_shown = 20;  // places; --along follows them all

std::string table_of(const studies::Equilibria& found, const Studied& studied) {
  const model::Model& model = studied.prepared.program->model;
  std::string text;
  const std::size_t shown = std::min(found.equilibria.size(), most_shown);
  for (std::size_t k = 0; k < shown; ++k) {
    const studies::Equilibrium& e = found.equilibria[k];
    const auto jump =
        studies::jump_at(*studied.prepared.program, studied.mode, e.x, studied.prepared.experiment.parameters);
    text += jump ? fmt::format("{}  undecided: the equations jump here, with `{}`\n", k + 1, *jump)
                 : fmt::format("{}  {}{}\n", k + 1, to_string(e.stability), e.isolated ? "" : ", not isolated");
    for (std::size_t i = 0; i < e.x.size(); ++i) {
      const std::string& unit = model.states[i].unit;
      // What rounding leaves of a zero.
      const double value = std::abs(e.x[i]) < 1e-13 ? 0 : e.x[i];
      text += fmt::format("   {} = {}{}\n", model.states[i].column, results::short_number(value),
                          unit.empty() || unit == "1" ? "" : " " + unit);
    }
    text += events_text(studied, e.x);
    if (!e.undetermined.equations.empty()) {
      text += fmt::format("   {}\n", describe_undetermined(studied, e.undetermined));
      continue;
    }
    if (jump) continue;
    text += "   eigenvalues";
    for (std::size_t i = 0; i < e.eigenvalues.size(); ++i) {
      if (e.eigenvalues[i].imag() < 0) continue;
      text +=
          fmt::format("{} {}", i == 0 ? "" : ",", eigenvalue_text(e.eigenvalues[i].real(), e.eigenvalues[i].imag()));
    }
    text += "\n";
  }
  if (shown < found.equilibria.size())
    text += fmt::format("and {} more: perhaps a curve of equilibria\n", found.equilibria.size() - shown);
  text += fmt::format("{} of {} searches converged, to {} equilibri{}", found.arrived, found.searches,
                      found.equilibria.size(), found.equilibria.size() == 1 ? "um" : "a");
  if (found.outside > 0) text += fmt::format("; {} outside of the region of the search (--box)", found.outside);
  return text + "\n";
}

nlohmann::json json_of(const studies::Equilibria& found, const Studied& studied) {
  auto places = nlohmann::json::array();
  for (const studies::Equilibrium& e : found.equilibria) {
    const auto jump =
        studies::jump_at(*studied.prepared.program, studied.mode, e.x, studied.prepared.experiment.parameters);
    nlohmann::json place{{"x", e.x}, {"isolated", e.isolated}};
    place["stability"] = jump || !e.undetermined.equations.empty() ? "undecided" : to_string(e.stability);
    if (!jump) place["eigenvalues"] = app::json_of(e.eigenvalues);
    add_events(place, studied, e.x);
    places.push_back(std::move(place));
  }
  auto states = nlohmann::json::array();
  for (const model::State& state : studied.prepared.program->model.states) states.push_back(state.column);
  nlohmann::json json{
      {"states", states}, {"equilibria", places}, {"searches", found.searches}, {"arrived", found.arrived}};
  add_conserved(json, studied);
  return json;
}

/// The folds and Hopf points of the branches, which have been shown, in both parameters.
ExitCode follow_curves(const Studied& studied, const studies::Equilibria& found, const SteadyDiagram& diagram,
                       const NamedPlane& plane, const SteadyOptions& options) {
  const model::Model& model = studied.prepared.program->model;
  const auto curves = curves_of(studied, diagram, plane, options.steps);
  if (options.json) {
    nlohmann::json json = json_of(found, studied);
    json.update(json_of(diagram, model, plane.first));
    json.update(json_of(curves, plane));
    answer("continuo.steady/1", json);
  } else {
    print(text_of(curves, plane));
  }
  if (!options.out.empty() && !written(results::write_file(options.out, csv_of(curves, model, plane)))) return usage;
  if (!options.plot.empty() && !draw(curves, model, plane, options.plot)) return usage;
  return interrupt_flag() ? interrupted : done;
}

/// How they move. What was found at the parameter's present value has been shown.
ExitCode follow(const Studied& studied, const studies::Equilibria& found, const NamedRange& range,
                const std::optional<NamedRange>& second, const studies::EquilibriumBox& box, std::size_t component,
                const SteadyOptions& options) {
  const model::Model& model = studied.prepared.program->model;
  const SteadyDiagram diagram = diagram_of(studied, found.equilibria, range, box, options.steps);
  if (second) {
    if (!options.json) print(text_of(diagram, model, range, found.equilibria.size()));
    return follow_curves(studied, found, diagram, {range, *second}, options);
  }
  if (options.json) {
    nlohmann::json json = json_of(found, studied);
    json.update(json_of(diagram, model, range));
    answer("continuo.steady/1", json);
  } else {
    print(text_of(diagram, model, range, found.equilibria.size()));
  }
  if (!options.out.empty() && !written(results::write_file(options.out, csv_of(diagram, model, range)))) return usage;
  if (!options.plot.empty() && !draw(diagram, model, range, component, options.plot)) return usage;
  return interrupt_flag() ? interrupted : done;
}

ExitCode steady(const SteadyOptions& options) {
  if (!drawable(options.plot) || !are_in_order(options.steps)) return usage;
  if (!options.plot.empty() && options.along.empty()) {
    say("--plot draws the equilibria over a parameter: give --along NAME=LOW..HIGH");
    return usage;
  }
  std::optional<NamedRange> range, second;
  std::vector<std::string> constants;
  if (!options.along.empty()) {
    range = parse_range(options.along);
    if (!range) return usage;
    constants.push_back(range->name);
  }
  if (options.and_along.size() > 1) {
    say("--and is given twice: folds and Hopf points are followed in two parameters (three are for homoclinic orbits: "
        "continuo orbit)");
    return usage;
  }
  if (!options.and_along.empty()) {
    second = parse_second(options.and_along[0], *range);
    if (!second) return usage;
    constants.push_back(second->name);
  }
  Studied studied = study(options.experiment, options.mode, constants, Equations::algebraic_too);
  if (studied.prepared.exit != done) return studied.prepared.exit;
  if (!stands_still_in_time(studied, "equilibria are searched for")) return wrong_model;
  hold_conserved(studied);
  if (second && !is_plane(studied, {*range, *second})) return usage;
  studies::EquilibriumBox box{.low = {}, .high = {}, .starts = options.starts, .interrupt = &interrupt_flag()};
  std::optional<std::size_t> component = 0;
  if (!options.of.empty()) component = state_named(studied.prepared.program->model, options.of);
  if (!component || !set_box(studied, options.box, box)) return usage;
  const studies::Equilibria found = [&] {
    Progress progress;
    box.progress = progress.parts();
    return studies::find_equilibria(studied.system, box);
  }();
  if (found.equilibria.empty()) {
    if (interrupt_flag()) return interrupted;
    say(
        fmt::format("{}: no equilibrium was found from {} starts; the smallest residual is {}, of `{}` ({}). "
                    "--box NAME=LOW..HIGH searches elsewhere",
                    place_text(studied.prepared, studied.prepared.program->model.states[found.nearest.worst].span),
                    found.searches, results::short_number(found.nearest.residual),
                    studied.system.name(found.nearest.worst), to_string(found.nearest.ending)));
    return numerical_failure;
  }
  if (!options.json) print(table_of(found, studied) + conserved_text(studied));
  if (range && !interrupt_flag()) return follow(studied, found, *range, second, box, *component, options);
  if (options.json) answer("continuo.steady/1", json_of(found, studied));
  return interrupt_flag() ? interrupted : done;
}

}  // namespace

void add_steady(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo steady models/lorenz.sim                              all equilibria and their stability\n"
      "  continuo steady models/lorenz.sim --along rho=0..30            their dependence on rho, with bifurcations\n"
      "  continuo steady models/lorenz.sim --along rho=0..30 --plot branches.svg -o branches.csv\n"
      "  continuo steady models/lorenz.sim --along rho=0..30 --and sigma=5..20   bifurcation curves in two parameters\n"
      "  continuo steady models/pendulum.sim --box theta=-7..7          restricts the search\n";
  Verb* verb = add_verb(app, listed("steady"), examples, {wrong_model, numerical_failure, interrupted});
  verb->json_examples = {"continuo steady models/lorenz.sim --json",
                         "continuo steady models/lorenz.sim --along rho=0..30 --json"};
  auto options = std::make_shared<SteadyOptions>();
  add_model(*verb, options->experiment);
  verb->add_option("--mode", options->mode, "The mode whose equations are used")->type_name("NAME");
  verb->add_option("--box", options->box, "Region of the search, for single states")
      ->delimiter(',')
      ->type_name("NAME=LOW..HIGH");
  verb->add_option("--starts", options->starts, "Number of starting points of the search (200)")
      ->check(count_from(0))
      ->type_name("N");
  auto* along =
      verb->add_option("--along", options->along, "Follows each equilibrium along a parameter, with crossing branches")
          ->type_name("NAME=LOW..HIGH");
  verb->add_option("--and", options->and_along, "Follows the folds and Hopf points while this parameter varies too")
      ->type_name("NAME=LOW..HIGH")
      ->allow_extra_args(false)
      ->needs(along);
  add_branch_steps(*verb, options->steps, along);
  verb->add_option("--of", options->of, "The state to plot over the parameter")->type_name("STATE")->needs(along);
  verb->add_flag("--json", options->json, "Prints all results as one JSON object");
  writes_file(
      *verb,
      verb->add_option("-o,--out", options->out, "Writes the table of --along, or of --and, as CSV")->needs(along),
      {".csv"});
  writes_file(*verb, verb->add_option("--plot", options->plot, "Plots --along, or --and, .svg or .png"));
  verb->callback([&exit, options] { exit = steady(*options); });
}

}  // namespace continuo::app
