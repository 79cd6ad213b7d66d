// continuo compare FILE --methods ... --step ...: one table and one picture.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/studies/study_json.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/results/method_colors.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/studies/compare.hpp>

namespace continuo::app {
namespace {

using studies::Comparison;
using studies::Contender;

struct CompareOptions {
  ExperimentOptions experiment;
  std::vector<std::string> methods;
  std::vector<double> steps, tolerances;
  std::string plot;
  bool json = false;
};

std::string control_of(const Contender& contender) {
  if (contender.step) return fmt::format("h = {}", results::short_number(*contender.step));
  return contender.tolerance ? fmt::format("tol = {}", results::short_number(*contender.tolerance)) : "";
}

std::string line_of(const model::Model& model, const Contender& contender) {
  const std::string head = fmt::format("{:<20} {:<14}", contender.method, control_of(contender));
  if (!contender.simulated.run) {
    const auto& problems = contender.simulated.diagnostics;
    return head + " " + (problems.empty() ? "no run" : problems.front().message) + "\n";
  }
  const model::Run& run = *contender.simulated.run;
  const std::string drift = run.energy ? fmt::format("{:.2e}", run.energy->drift) : "-";
  return fmt::format(
      "{} {:>12.2e} {:>12.2e} {:>12} {:>12} {:>10}{}\n", head, contender.final_error, contender.largest_error, drift,
      runs::cost_of(model, run), results::duration(run.statistics.seconds),
      succeeded(run.outcome.ending)
          ? ""
          : fmt::format("  {} at t = {}", to_string(run.outcome.ending), results::short_number(run.final_time())));
}

std::string table_of(const model::Model& model, const Comparison& comparison) {
  const runs::Kind kind = runs::kind_of(model);
  std::string text = fmt::format("{:<20} {:<14} {:>12} {:>12} {:>12} {:>12} {:>10}\n", "method", "", "final error",
                                 "largest", "energy drift", kind.cost, "time");
  for (const Contender& contender : comparison.contenders) text += line_of(model, contender);
  const model::Plan& reference = comparison.reference.run->plan;
  if (kind.solver == runs::Solver::world)
    return text + fmt::format("errors against {}: of places by the farthest, of velocities by the fastest\n",
                              reference.step > 0 ? fmt::format("{} with h = {:.4g}", reference.method, reference.step)
                                                 : fmt::format("exact at tol {}", studies::reference_rtol));
  return text + fmt::format("errors against {} at tol {}, relative to each state's largest value\n",
                            comparison.reference.run->plan.method, studies::reference_rtol);
}

/// The first curve of the model's plot, as every contender sees it, and how the error grows below it.
results::Figure figure_of(const model::ModelProgram& program, const Comparison& comparison) {
  const auto reference = results::plots_of(program, *comparison.reference.run).front();
  results::Panel motion{.x_label = results::label_of(reference.against),
                        .y_label = results::label_of(reference.curves.front()),
                        .curves = {}};
  results::Panel error{.x_label = results::label_of(comparison.reference.run->motion.columns.front()),
                       .y_label = "error",
                       .curves = {},
                       .logarithmic_y = true};
  std::vector<std::string> methods;
  for (const Contender& contender : comparison.contenders) methods.push_back(contender.method);
  const std::vector<std::size_t> colors = results::colors_of_methods(methods);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const Contender& contender = comparison.contenders[i];
    if (!contender.simulated.run) continue;
    const auto plot = results::plots_of(program, *contender.simulated.run).front();
    motion.curves.push_back({.label = contender.label(), .x = plot.x, .y = plot.y.front(), .number = colors[i]});
    error.curves.push_back(
        {.label = contender.label(), .x = contender.times, .y = contender.errors, .number = colors[i]});
  }
  motion.curves.push_back({"reference", reference.x, reference.y.front(), "#000000"});
  return {.title = program.model.name, .panels = {std::move(motion), std::move(error)}};
}

ExitCode exit_of(const Comparison& comparison) {
  for (const Contender& contender : comparison.contenders) {
    if (!contender.simulated.run) return usage;
    if (contender.simulated.run->outcome.ending == Ending::interrupted) return interrupted;
  }
  return done;  // a method that fails is an answer
}

ExitCode compare(const CompareOptions& options) {
  if (!drawable(options.plot)) return usage;
  Prepared prepared = prepare(options.experiment, Worlds::welcome);
  if (prepared.exit != done) return prepared.exit;
  const Comparison comparison = studies::compare(prepared.program, {.methods = options.methods,
                                                                    .steps = options.steps,
                                                                    .tolerances = options.tolerances,
                                                                    .experiment = prepared.experiment});
  const auto& reference = comparison.reference;
  if (!reference.run || !succeeded(reference.run->outcome.ending)) {
    show(reference.diagnostics, prepared.loaded.source);
    if (reference.run && reference.run->outcome.ending == Ending::interrupted) return interrupted;
    say("there is no reference run to compare with");
    return numerical_failure;
  }
  if (options.json) {
    answer("continuo.compare/1", comparison_json(comparison));
  } else {
    print(table_of(prepared.program->model, comparison));
  }
  const ExitCode exit = exit_of(comparison);
  if (!options.plot.empty()) {
    if (!written(results::draw(figure_of(*prepared.program, comparison), options.plot)))
      return exit == done ? usage : exit;
  }
  return exit;
}

}  // namespace

void add_compare(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo compare models/mass_spring.sim --methods euler,semi_implicit_euler,rk4 --step 0.1,0.05\n"
      "  continuo compare models/kepler.sim --methods dop853,tsitouras5 --tol 1e-6,1e-9 --plot methods.svg\n"
      "  continuo compare models/chain.sim --methods exact,central_difference,explicit_euler --step 0.005\n";
  Verb* verb = add_verb(app, listed("compare"), examples, {wrong_model, numerical_failure, interrupted});
  verb->json_examples = {"continuo compare models/mass_spring.sim --methods euler,rk4 --step 0.1 --json"};
  auto options = std::make_shared<CompareOptions>();
  add_experiment(*verb, options->experiment);
  verb->add_option("--methods", options->methods, "Methods, separated by commas")
      ->required()
      ->delimiter(',')
      ->type_name("NAMES");
  auto* steps = verb->add_option("--step", options->steps, "Fixed step sizes, separated by commas")
                    ->delimiter(',')
                    ->type_name("H,...")
                    ->transform(quotients());
  verb->add_option("--tol", options->tolerances, "Tolerances, separated by commas")
      ->delimiter(',')
      ->type_name("RTOL,...")
      ->excludes(steps);
  verb->add_flag("--json", options->json, "Every run and its errors over time as one JSON object");
  writes_file(*verb, verb->add_option("--plot", options->plot, "Writes a plot, .svg or .png"));
  verb->callback([&exit, options] { exit = compare(*options); });
}

}  // namespace continuo::app
