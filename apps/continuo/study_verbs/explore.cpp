// continuo explore FILE: what a model does, on one page.
#include <memory>
#include <string>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/orbits/exploration.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <nlohmann/json.hpp>

namespace continuo::app {
namespace {

struct ExploreOptions {
  ExperimentOptions experiment;
  std::string mode, plot;
  ExplorationLimits limits;
  bool json = false;
};

ExitCode explore_model(const ExploreOptions& options) {
  if (!drawable(options.plot)) return usage;
  Studied studied = study(options.experiment, options.mode, {}, Equations::algebraic_too);
  if (studied.prepared.exit != done) return studied.prepared.exit;
  if (studied.prepared.program->model.states.empty()) {
    say("this model has no states");
    return wrong_model;
  }
  hold_conserved(studied);
  const Exploration found = explore(studied, options.limits);
  if (options.json) {
    answer("continuo.explore/1", exploration_json(studied, found));
  } else {
    print(exploration_text(studied, found));
  }
  const ExitCode exit = found.complete ? done : interrupted;
  if (options.plot.empty() || written(results::draw(exploration_figure(studied, found), options.plot))) return exit;
  return exit == done ? usage : exit;
}

}  // namespace

void add_explore(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo explore models/lorenz.sim                    equilibria, orbit, bifurcations, important parameters, "
      "and open questions\n"
      "  continuo explore models/van_der_pol_stiff.sim --plot page.svg\n"
      "  continuo explore models/mass_spring_damper.sim --json\n";
  Verb* verb = add_verb(app, listed("explore"), examples, {wrong_model, interrupted});
  verb->json_examples = {"continuo explore models/mass_spring_damper.sim --json"};
  auto options = std::make_shared<ExploreOptions>();
  add_model(*verb, options->experiment);
  verb->add_option("--mode", options->mode, "The mode whose equations are used")->type_name("NAME");
  verb->add_option("--starts", options->limits.starts, "Number of starting points of the search for equilibria (200)")
      ->check(count_from(0))
      ->type_name("N");
  verb->add_option("--settle", options->limits.settle,
                   "Time for transients to decay (default: the duration of the run)")
      ->check(number_from(0))
      ->type_name("T");
  verb->add_option("--duration", options->limits.duration,
                   "Longest period to search for (default: the duration of the run)")
      ->check(number_above(0))
      ->type_name("T");
  verb->add_flag("--json", options->json, "All of it as one JSON object");
  writes_file(*verb, verb->add_option("--plot", options->plot, "Writes a plot, .svg or .png"));
  verb->callback([&exit, options] { exit = explore_model(*options); });
}

}  // namespace continuo::app
