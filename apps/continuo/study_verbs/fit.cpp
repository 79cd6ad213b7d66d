// continuo fit FILE DATA.csv --param k,c: the parameters that measurements speak for, and how surely.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/studies/fit_request.hpp>
#include <apps/continuo/studies/fit_results.hpp>
#include <apps/continuo/studies/influences.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/modules.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/plots.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/studies/fit.hpp>

namespace continuo::app {
namespace {

using results::short_number;

/// Runs less exact than the search would be noise to it, and none is more exact than its rounding: asked for, they are
/// refused.
bool strict_enough(const model::Experiment& experiment) {
  std::vector<double> asked;
  if (experiment.rtol) asked.push_back(*experiment.rtol);
  for (const auto& [state, rtol] : experiment.rtol_of) asked.push_back(rtol);
  for (const double rtol : asked) {
    if (rtol < studies::least_rtol_of_fit) {
      say(fmt::format("--tol {}: rounding leaves no run of a fit less than {}", short_number(rtol),
                      short_number(studies::least_rtol_of_fit)));
      return false;
    }
    if (rtol <= studies::greatest_rtol_of_fit) continue;
    say(fmt::format("--tol {}: the runs of a fit need {} or less, beyond it they are noise to the search",
                    short_number(rtol), short_number(studies::greatest_rtol_of_fit)));
    return false;
  }
  return true;
}

ExitCode fit(const FitOptions& options) {
  std::vector<std::string> inputs = options.data;
  inputs.push_back(options.experiment.file);
  if (!drawable(options.plot) || !loadable(least_squares_module) || !reads_standard_input_once(inputs)) return usage;
  Prepared prepared = prepare(options.experiment, Worlds::welcome);
  if (prepared.exit != done) return prepared.exit;
  if (!strict_enough(prepared.experiment)) return usage;
  say_step_has_no_part(prepared);
  auto request = fit_request(options, prepared);
  if (!request) return usage;
  request->options.interrupt = prepared.experiment.interrupt;
  studies::Fit found;
  std::vector<studies::Profile> profiles;
  {
    Progress progress;
    // How long one search takes nobody knows; of many, those that are done say it.
    if (options.starts.value_or(1) > 1) {
      if (const auto show_part = progress.parts())
        request->options.progress = [show_part, starts = static_cast<double>(*options.starts)](
                                        std::size_t start, double) { show_part(static_cast<double>(start) / starts); };
    } else if (const auto show_number = progress.number("residual")) {
      request->options.progress = [show_number](std::size_t, double cost) { show_number(std::sqrt(2 * cost)); };
    }
    // A run that is cut off says nothing of its parameters: the search stops between runs.
    request->experiment.interrupt = nullptr;
    found = studies::fit(*request);
    if (options.profile && found.found() && !found.least.interrupted) profiles = studies::profiles_of(*request, found);
  }
  show(found.diagnostics, prepared.loaded.source);
  if (!found.found()) {
    say(found.status.message);
    if (found.status.ending == Ending::interrupted) return interrupted;
    return found.diagnostics.empty() ? numerical_failure : wrong_model;
  }
  if (options.json) {
    answer("continuo.fit/1", fit_json(*request, found, profiles));
  } else {
    print(fit_text(*request, found, profiles));
  }
  if (!options.plot.empty() && !written(results::draw(fit_figure(*request, found, profiles), options.plot)))
    return usage;
  if (found.least.interrupted) return interrupted;
  return found.doubts_of(studies::FitDoubt::Kind::not_converged) ? numerical_failure : done;
}

}  // namespace

void add_fit(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo fit spring.sim measured.csv --param k,c                the columns are t and names of states\n"
      "  continuo fit spring.sim measured.csv --param k,c --initial x --loss huber --plot fit.svg\n"
      "  continuo fit spring.sim a.csv b.csv --param k --in b.csv:m=2 --column \"pos=x\" --sigma pos=0.01\n"
      "  continuo fit decay.sim counts.csv --param a --log a --error n=poisson --profile --json\n";
  Verb* verb = add_verb(app, listed("fit"), examples, {wrong_model, numerical_failure, interrupted});
  verb->json_examples = {
      "continuo run models/mass_spring_damper.sim -o measured.csv && continuo fit models/mass_spring_damper.sim "
      "measured.csv --param k,c --profile --json"};
  auto options = std::make_shared<FitOptions>();
  add_model(*verb, options->experiment);
  refuse_option(*verb, "--until", "a fit's runs end with each data file's last time");
  refuse_option(*verb, "--output", "a fit's runs have their rows at the times of the data");
  refuse_methods(*verb);
  reads_file(
      *verb,
      verb->add_option("data", options->data, "CSV files: t, and columns named like states or outputs")->required());
  const auto list = [&](const char* name, std::vector<std::string>& target, const char* text, const char* type) {
    verb->add_option(name, target, text)->delimiter(',')->allow_extra_args(false)->type_name(type);
  };
  list("--param", options->parameters, "Unknown parameters, within the ranges declared in the model", "NAMES");
  list("--initial", options->initial, "States with unknown initial values", "STATES");
  list("--bounds", options->bounds, "Other ranges: k=1..20, x(0)=0..", "NAME=LOW..HIGH");
  list("--column", options->columns, "Which quantity a column is; - for none", "COLUMN=QUANTITY");
  list("--sigma", options->deviations,
       "The deviation of a column's measurements: 0.01, 5%, 0.01+5%, or the column that has them; else estimated",
       "COLUMN=DEVIATION");
  list("--error", options->errors, "How deviations go: constant, proportional, both, poisson or lognormal",
       "COLUMN=MODEL");
  verb->add_flag("--one-deviation", options->one_deviation,
                 "Columns of one quantity share their deviation in all files");
  list("--log", options->logarithmic, "Unknowns to be searched in their logarithm", "NAMES");
  verb->add_option("--prior", options->priors, "Prior knowledge: k=normal(4, 0.5), k=lognormal(4, 0.2)")
      ->allow_extra_args(false)
      ->type_name("NAME=PRIOR");
  list("--in", options->settings, "A parameter's value in one data file", "FILE:NAME=VALUE");
  verb->add_option("--loss", options->loss, "Loss function: squares, or against outliers huber, soft_l1, cauchy, tukey")
      ->type_name("NAME");
  verb->add_option("--likelihood", options->likelihood,
                   "Likelihood for unknown deviations: restricted, or plain, which is biased")
      ->type_name("NAME");
  verb->add_option("--starts", options->starts,
                   "Number of starting points of the search (default: one, and ten others in case of doubt)")
      ->check(count_from(1))
      ->type_name("N");
  verb->add_option("--iterations", options->iterations, "The limit of each search (500)")
      ->check(count_from(1))
      ->type_name("N");
  verb->add_flag("--profile", options->profile, "Also computes intervals from the profile likelihood");
  verb->add_flag("--json", options->json, "The result with its residuals as one JSON object");
  add_tolerances(*verb, options->experiment);
  writes_file(*verb, verb->add_option("--plot", options->plot,
                                      "Measurements, fit, prediction band and residuals, .svg or .png"));
  verb->callback([&exit, options] { exit = fit(*options); });
}

}  // namespace continuo::app
