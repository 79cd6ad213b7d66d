// continuo converge FILE --methods ...: error against step, observed orders, the floor of rounding; with --derivative
// the same of the difference schemes for a derivative.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/studies/converge_text.hpp>
#include <apps/continuo/studies/differences.hpp>
#include <apps/continuo/studies/study_json.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/studies/converge.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::app {
namespace {

struct ConvergeOptions {
  ExperimentOptions experiment;
  std::vector<std::string> methods;
  std::vector<double> tolerances;
  std::size_t most_steps = 65536;
  bool in_float = false, in_long_double = false, all_points = false, json = false;
  std::string derivative, plot;
  double at = 0;
};

ExitCode draw(const results::Figure& figure, const std::string& path, ExitCode exit) {
  if (path.empty() || written(results::draw(figure, path))) return exit;
  return exit == done ? usage : exit;
}

/// Bodies are moved in steps, in double; what they are compared with has none.
bool fits_a_world(const ConvergeOptions& options) {
  if (options.tolerances.empty() && !options.in_float && !options.in_long_double) return true;
  say("a world of bodies converges by its steps and in double: without --tol, --float and --long");
  return false;
}

ExitCode converge(const ConvergeOptions& options) {
  if (!drawable(options.plot)) return usage;
  if (!options.derivative.empty()) {
    if (!options.experiment.file.empty() || !options.methods.empty()) {
      say("--derivative is of a function of x: leave out the model and --methods");
      return usage;
    }
    const auto study = study_differences(options.derivative, options.at);
    if (!study) return usage;
    if (options.json) {
      answer("continuo.differences/1", differences_json(*study, options.derivative, options.at));
    } else {
      print(differences_text(*study, options.in_float));
    }
    return draw(differences_figure(*study, options.in_float, options.derivative), options.plot, done);
  }
  if (options.experiment.file.empty() || options.methods.empty()) {
    say("converge takes a model and --methods, or --derivative with an expression in x");
    return usage;
  }
  Prepared prepared = prepare(options.experiment, Worlds::welcome);
  if (prepared.exit != done) return prepared.exit;
  const runs::Kind kind = runs::kind_of(prepared.program->model);
  if (!known_methods(options.methods, kind)) return usage;
  if (kind.solver == runs::Solver::world && !fits_a_world(options)) return usage;
  if (has_no_start(prepared)) return wrong_model;
  Progress progress;
  const auto study = studies::converge(prepared.program, prepared.experiment,
                                       {.methods = options.methods,
                                        .most_steps = options.most_steps,
                                        .tolerances = options.tolerances,
                                        .in_float = options.in_float,
                                        .in_long_double = options.in_long_double,
                                        .interrupt = &interrupt_flag(),
                                        .progress = progress.parts()});
  if (!study) {
    if (interrupt_flag().load()) return interrupted;
    say(study.status().message);
    return numerical_failure;
  }
  if (options.json) {
    answer("continuo.converge/1", convergence_json(*study));
  } else {
    print(convergence_text(*study, prepared.program->model, options.in_float, options.in_long_double,
                           options.all_points));
  }
  const bool nothing =
      std::ranges::all_of(study->methods, [](const studies::MethodConvergence& method) { return !method.status; });
  const ExitCode exit = study->interrupted ? interrupted : nothing ? usage : done;
  return draw(convergence_figure(*study, prepared.program->model.name), options.plot, exit);
}

}  // namespace

void add_converge(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo converge models/mass_spring_damper.sim --methods euler,heun,rk4 --plot orders.svg\n"
      "  continuo converge models/kepler.sim --methods rk4,yoshida6 --float      also with seven digits\n"
      "  continuo converge models/kepler.sim --methods adams --tol 1e-3,1e-5,1e-7\n"
      "  continuo converge models/chain.sim --methods fast,rk4 --until 2         bodies, against their exact motion\n"
      "  continuo converge --derivative \"sin(x)\" --at 1            difference schemes for f' and f''\n";
  Verb* verb = add_verb(app, listed("converge"), examples, {wrong_model, numerical_failure, interrupted});
  verb->json_examples = {"continuo converge models/mass_spring_damper.sim --methods rk4 --most-steps 256 --json"};
  auto options = std::make_shared<ConvergeOptions>();
  add_experiment(*verb, options->experiment);
  verb->get_option("file")->required(false);
  verb->add_option("--methods", options->methods, "Methods, separated by commas")->delimiter(',')->type_name("NAMES");
  verb->add_option("--most-steps", options->most_steps, "Number of steps of the finest run (65536)")
      ->check(count_from(64, 100'000'000))
      ->type_name("N");
  auto* tolerances =
      verb->add_option("--tol", options->tolerances,
                       "Measures the error against these tolerances instead of steps, separated by commas")
          ->delimiter(',')
          ->check(number_above(0))
          ->type_name("RTOL,...");
  verb->add_flag("--float", options->in_float, "Also in single precision (24 bits), side by side")
      ->excludes(tolerances);
  verb->add_flag("--long", options->in_long_double, "Also in extended precision (64 bits)")->excludes(tolerances);
  verb->add_flag("--points", options->all_points, "Prints every step size and its errors");
  verb->add_flag("--json", options->json, "Every step, its errors and the orders as one JSON object");
  auto* derivative = verb->add_option("--derivative", options->derivative,
                                      "Without a model: difference quotients of this function of x")
                         ->type_name("EXPRESSION");
  verb->add_option("--at", options->at, "The value of x for --derivative (0)")->needs(derivative)->type_name("X");
  writes_file(*verb, verb->add_option("--plot", options->plot, "Writes a plot, .svg or .png"));
  verb->callback([&exit, options] { exit = converge(*options); });
}

}  // namespace continuo::app
