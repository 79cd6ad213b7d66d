// continuo sense FILE --param k,c: how the motion depends on parameters and initial values.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/studies/influences.hpp>
#include <apps/continuo/studies/sense_of.hpp>
#include <apps/continuo/studies/study_json.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/results/table_file.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/studies/sensitivity.hpp>

namespace continuo::app {
namespace {

using studies::SensitivityRun;

constexpr std::size_t most_curves = 8;

struct SenseOptions {
  ExperimentOptions experiment;
  std::vector<std::string> parameters, initial;
  std::string of = "motion", output, plot;
  bool json = false;
};

model::Column column_of(const model::Model& model, std::size_t state, const studies::Influence& influence) {
  return {fmt::format("d {} / d {}", model.states[state].column, name_of(model, influence)),
          studies::unit_of_ratio(model.states[state].unit, unit_of(model, influence))};
}

double value_of(const model::Model& model, const SensitivityRun& run, const studies::Influence& influence) {
  return run
      .variables[influence.kind == studies::Influence::Kind::parameter ? model.parameters[influence.index].variable
                                                                       : model.states[influence.index].variable];
}

/// The largest |x| of a state's way: what changes of it are relative to where it passes through zero.
std::vector<double> sizes_of(const SensitivityRun& run) {
  std::vector<double> sizes(run.states);
  for (std::size_t r = 0; r < run.rows(); ++r)
    for (std::size_t i = 0; i < run.states; ++i) sizes[i] = std::max(sizes[i], std::abs(run.value(r, i)));
  return sizes;
}

std::string table_of(const model::Model& model, const SensitivityRun& run,
                     const std::vector<studies::Influence>& influences) {
  const std::size_t last = run.rows() - 1;
  const auto sizes = sizes_of(run);
  std::string text = fmt::format("at t = {}{}\n", results::short_number(run.times[last]),
                                 model.time_unit.empty() ? "" : " " + model.time_unit);
  text += fmt::format("{:<26} {:>14} {:<14} {:>12} {:>14}\n", "", "value", "", "p/x dx/dp", "of largest x");
  for (std::size_t k = 0; k < influences.size(); ++k) {
    const double p = value_of(model, run, influences[k]);
    for (std::size_t i = 0; i < run.states; ++i) {
      const double s = run.sensitivity(last, i, k);
      const auto relative = [&](double x) { return x == 0 ? std::string("-") : fmt::format("{:.3g}", p / x * s); };
      const model::Column column = column_of(model, i, influences[k]);
      text += fmt::format("{:<26} {:>14} {:<14} {:>12} {:>14}\n", column.name, results::short_number(s), column.unit,
                          relative(run.value(last, i)), relative(sizes[i]));
    }
  }
  if (!runs::kind_of(model).has_exact_derivatives)
    text += "by differences of runs to both sides of each; nan: bodies meet just then\n";
  if (run.events.empty()) return text;
  const studies::SensitivityEvent& event = run.events.back();
  text += fmt::format("{} events; the last, `{}`, at t = {}", run.events.size(), event.name,
                      results::short_number(event.t));
  for (std::size_t k = 0; k < influences.size(); ++k)
    text += fmt::format(", d t / d {} = {}", name_of(model, influences[k]), results::short_number(event.time_moves[k]));
  return text + "\n";
}

Status write(const model::Model& model, const SensitivityRun& run, const std::vector<studies::Influence>& influences,
             const std::string& path) {
  std::vector<model::Column> columns{{"t", model.time_unit}};
  for (const model::State& state : model.states) columns.push_back({state.column, state.unit});
  for (const studies::Influence& influence : influences)
    for (std::size_t i = 0; i < run.states; ++i) columns.push_back(column_of(model, i, influence));
  // Text has no other place for the units.
  const Result<results::TableFormat> format = results::table_format(path);
  if (format && (*format == results::TableFormat::csv || *format == results::TableFormat::tsv))
    for (model::Column& column : columns) column.name = results::label_of(column);
  results::TableFile table(path, {.columns = std::move(columns)});
  std::vector<double> row;
  for (std::size_t r = 0; r < run.rows() && table.status(); ++r) {
    row.assign(1, run.times[r]);
    row.insert(row.end(), run.row(r).begin(), run.row(r).end());
    table.row(row);
  }
  return table.close();
}

/// A panel for each influence and unit.
results::Figure figure_of(const model::Model& model, const SensitivityRun& run,
                          const std::vector<studies::Influence>& influences) {
  results::Figure figure{.title = model.name, .panels = {}};
  std::vector<double> marks;
  for (const studies::SensitivityEvent& event : run.events) marks.push_back(event.t);
  const std::size_t states = std::min(run.states, most_curves);
  for (std::size_t k = 0; k < influences.size(); ++k) {
    const std::size_t first = figure.panels.size();
    std::vector<std::string> units;
    for (std::size_t i = 0; i < states; ++i) {
      const model::Column column = column_of(model, i, influences[k]);
      const auto panel = static_cast<std::size_t>(std::ranges::find(units, column.unit) - units.begin());
      if (panel == units.size()) {
        units.push_back(column.unit);
        figure.panels.push_back({.x_label = results::label_of({"t", model.time_unit}),
                                 .y_label = results::label_of({"d / d " + name_of(model, influences[k]), column.unit}),
                                 .curves = {},
                                 .marks = marks});
      }
      results::Curve curve{.label = column.name, .x = run.times, .y = {}};
      for (std::size_t r = 0; r < run.rows(); ++r) curve.y.push_back(run.sensitivity(r, i, k));
      figure.panels[first + panel].curves.push_back(std::move(curve));
    }
  }
  return figure;
}

/// Of what a motion comes to, parameters alone can be asked, and there is nothing to draw.
ExitCode sense_of_limit(const SenseOptions& options) {
  if (!options.initial.empty() || !options.output.empty() || !options.plot.empty() || options.experiment.until ||
      options.experiment.output) {
    say(fmt::format("--of {} takes --param and --json alone", options.of));
    return usage;
  }
  return (options.of == "period" ? sense_period : sense_equilibrium)(options.experiment, options.parameters,
                                                                     options.json);
}

ExitCode sense(const SenseOptions& options) {
  if (!drawable(options.plot)) return usage;
  if (options.of == "period" || options.of == "equilibrium") return sense_of_limit(options);
  Prepared prepared = prepare(options.experiment, Worlds::welcome);
  if (prepared.exit != done) return prepared.exit;
  const model::Model& model = prepared.program->model;
  say_step_has_no_part(prepared);
  const auto influences = influences_named(model, options.parameters, options.initial);
  if (!influences) return usage;
  if (const auto refused = studies::no_sensitivity(model, *influences)) {
    show(std::span(&*refused, 1), prepared.loaded.source);
    return wrong_model;
  }
  SensitivityRun run;
  {
    Progress progress;
    prepared.experiment.progress = watcher_of(prepared, progress);
    run = studies::SensitivityStudy(prepared.program, *influences, prepared.experiment.parameters)
              .run({.experiment = prepared.experiment});
  }
  if (!run.diagnostics.empty()) {
    show(run.diagnostics, prepared.loaded.source);
    return usage;
  }
  ExitCode exit = done;
  if (options.json) {
    answer("continuo.sense/1", sensitivity_json(model, run, *influences));
  } else if (options.of == "events") {
    print(events_table(model, run, *influences));
  } else if (run.rows() > 0) {
    print(table_of(model, run, *influences));
  }
  if (!run.good()) {
    exit = run.outcome.ending == Ending::interrupted ? interrupted : numerical_failure;
    say(run.has_no_derivative() ? fmt::format("at t = {}: {}", run.outcome.t, run.status.message) : run.status.message);
  }
  bool fine = options.output.empty() || written(write(model, run, *influences, options.output));
  if (!options.plot.empty()) fine = written(results::draw(figure_of(model, run, *influences), options.plot)) && fine;
  if (!fine && exit == done) exit = usage;
  return exit;
}

}  // namespace

void add_sense(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo sense models/mass_spring_damper.sim --param k,c             how x and x' depend on k and c\n"
      "  continuo sense models/bouncing_ball.sim --param e,g --until 8 --plot ball.svg\n"
      "  continuo sense models/lorenz.sim --initial x --until 5 -o growth.csv\n"
      "  continuo sense models/thermostat.sim --param tau,high --of period      and --of events, --of equilibrium\n";
  Verb* verb = add_verb(app, listed("sense"), examples, {wrong_model, numerical_failure, interrupted});
  verb->json_examples = {"continuo sense models/mass_spring_damper.sim --param k,c --json",
                         "continuo sense models/lorenz.sim --param rho --of equilibrium --json"};
  auto options = std::make_shared<SenseOptions>();
  add_experiment(*verb, options->experiment);
  verb->add_option("--param", options->parameters, "Parameters, separated by commas")
      ->delimiter(',')
      ->type_name("NAMES");
  verb->add_option("--initial", options->initial, "States whose initial values are varied, separated by commas")
      ->delimiter(',')
      ->type_name("STATES");
  verb->add_option("--of", options->of,
                   "The quantity to differentiate: the motion, the times of its events, its period, its equilibrium")
      ->check(CLI::IsMember({"motion", "events", "period", "equilibrium"}))
      ->type_name("WHAT");
  refuse_methods(*verb);
  add_tolerances(*verb, options->experiment);
  writes_table(*verb,
               verb->add_option("-o", options->output,
                                "Writes states and sensitivities, as .csv, .tsv, .json, .nc or .mat; - is standard "
                                "output"));
  verb->add_flag("--json", options->json, "Every row and event as one JSON object");
  writes_file(*verb, verb->add_option("--plot", options->plot, "Writes a plot, .svg or .png"));
  verb->callback([&exit, options] { exit = sense(*options); });
}

}  // namespace continuo::app
