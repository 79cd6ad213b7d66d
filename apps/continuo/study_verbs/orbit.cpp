// continuo orbit FILE: a closed orbit with its period and multipliers, a Poincare section, Lyapunov exponents.
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/orbits/degenerate_curves.hpp>
#include <apps/continuo/orbits/hybrid_orbit.hpp>
#include <apps/continuo/orbits/long_motion.hpp>
#include <apps/continuo/orbits/orbit_branch.hpp>
#include <apps/continuo/orbits/orbit_figure.hpp>
#include <apps/continuo/orbits/steady_branches.hpp>
#include <apps/continuo/orbits/steady_curves.hpp>
#include <apps/continuo/studies/orbit_text.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/studies/periodic_orbit.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::app {
namespace {

struct OrbitOptions {
  ExperimentOptions experiment;
  std::string mode, section, along, of, out, plot;
  std::vector<std::string> and_along;  // once or twice
  std::optional<double> settle;
  double duration = 0, tolerance = 1e-9;
  std::optional<double> forcing;
  std::size_t turns = 0;
  bool lyapunov = false, from_hopf = false, json = false;
  bool patient = false;  // no time was named: longer ones may be tried
  std::size_t others = 3;
  BranchSteps steps;
};

/// Whether the equations of one mode are not all that moves the model. Who names a mode means its equations alone.
bool needs_all(const Studied& studied, const OrbitOptions& options) {
  return options.mode.empty() && studies::unseen_of(*studied.prepared.program, studied.mode).has_value();
}

/// Whether something depends on the time, or is said to.
bool is_forced(const Studied& studied, const OrbitOptions& options) {
  if (options.forcing || options.turns > 0) return true;
  return options.mode.empty() && studies::depends_on_time(*studied.prepared.program, studied.mode).has_value();
}

results::Figure figure_of(const model::Model& model, const studies::PeriodicOrbit& found) {
  std::vector<double> times;
  std::vector<std::vector<double>> states;
  for (const double s : found.orbit.mesh) {
    times.push_back(s * found.period);
    states.push_back(found.orbit(s));
  }
  return orbit_figure(model, times, states);
}

studies::PeriodicOrbitOptions search_of(const OrbitOptions& options) {
  return {.settle = *options.settle,
          .duration = options.duration,
          .tolerance = options.tolerance,
          .rtol = std::max(options.tolerance, 1e-12),
          .interrupt = &interrupt_flag()};
}

HybridOrbitRequest shooting_of(const OrbitOptions& options) {
  return {.settle = *options.settle,
          .duration = options.duration,
          .tolerance = options.tolerance,
          .patient = options.patient,
          .forcing = options.forcing,
          .turns = options.turns,
          .json = options.json,
          .plot = options.plot};
}

ExitCode show_orbit(const Studied& studied, const OrbitOptions& options) {
  const model::Model& model = studied.prepared.program->model;
  const auto found = [&] {
    Progress progress;
    studies::PeriodicOrbitOptions search = search_of(options);
    search.progress = progress.parts();
    return find_orbit(studied, search, options.patient);
  }();
  // One of many, where something is conserved, or one that a motion does not stay on.
  const bool begins_on_it = options.settle == 0;
  if (!found.outcome && (!found.wanders || begins_on_it) && !interrupt_flag())
    return show_hybrid_orbit(studied, shooting_of(options));
  if (!found.outcome) return failed_exit(found.outcome);
  const auto extents = studies::extents_of(studied.system, found);
  if (options.json) {
    auto states = nlohmann::json::array();
    for (const model::State& state : model.states) states.push_back(state.column);
    nlohmann::json json{{"states", states},       {"period", found.period},
                        {"x", found.orbit(0)},    {"min", extents.low},
                        {"max", extents.high},    {"multipliers", app::json_of(found.multipliers)},
                        {"stable", found.stable}, {"advance", found.advance}};
    add_conserved(json, studied);
    answer("continuo.orbit/1", json);
  }
  const std::string text = fmt::format("period {}{}, {}\n", with_time_unit(found.period, model),
                                       advance_text(model, found.advance), found.stable ? "stable" : "unstable") +
                           multipliers_text(found.multipliers) + extents_text(model, extents.low, extents.high) +
                           conserved_text(studied);
  if (!options.json) print(text);
  if (options.plot.empty()) return done;
  if (!written(results::draw(figure_of(model, found), options.plot))) return usage;
  return done;
}

/// Nothing is drawn or written of some of what may be asked for: said, not passed over.
bool has_its_outputs(const OrbitOptions& options) {
  const bool section = !options.section.empty();
  if (!options.plot.empty() && options.lyapunov) {
    say("--plot draws the orbit, --along or --section; there is no plot of --lyapunov");
    return false;
  }
  if (options.out.empty() || section || !options.along.empty()) return true;
  say("-o writes the table of --section or of --along; give one of them");
  return false;
}

/// What moves, and the names of these parameters in this order.
struct OrbitRanges {
  std::optional<NamedRange> first{}, second{}, third{};
  std::vector<std::string> names{};
};
/// Says what is wrong.
std::optional<OrbitRanges> ranges_of(const OrbitOptions& options) {
  OrbitRanges ranges;
  if (options.and_along.size() > 2) {
    say(fmt::format("--and is given {} times, but curves have at most three parameters: that of --along and two",
                    options.and_along.size()));
    return std::nullopt;
  }
  const auto take = [&](std::optional<NamedRange>& range, std::optional<NamedRange> parsed) {
    range = std::move(parsed);
    if (range) ranges.names.push_back(range->name);
    return range.has_value();
  };
  if (options.along.empty()) return ranges;
  if (!take(ranges.first, parse_range(options.along))) return std::nullopt;
  if (options.and_along.empty()) return ranges;
  if (!take(ranges.second, parse_second(options.and_along[0], *ranges.first))) return std::nullopt;
  if (options.and_along.size() < 2) return ranges;
  if (!take(ranges.third, parse_third(options.and_along[1], {*ranges.first, *ranges.second}))) return std::nullopt;
  return ranges;
}

ExitCode orbit(OrbitOptions options) {
  if (!drawable(options.plot) || !are_in_order(options.steps) || !has_its_outputs(options)) return usage;
  const auto ranges = ranges_of(options);
  if (!ranges) return usage;
  const auto& [range, second, third, constants] = *ranges;
  Studied studied = study(options.experiment, options.mode, constants);
  if (studied.prepared.exit != done) return studied.prepared.exit;
  const double run = run_length(studied.prepared.program->model);
  options.patient = !options.settle && !(options.duration > 0);
  if (!options.settle) options.settle = run;
  if (!(options.duration > 0)) options.duration = options.lyapunov ? 20 * run : run;
  const bool closed = !options.lyapunov && options.section.empty();
  const bool hybrid = closed && (needs_all(studied, options) || is_forced(studied, options));
  if (closed && !hybrid) hold_conserved(studied);
  if (hybrid && !range) return show_hybrid_orbit(studied, shooting_of(options));
  if (hybrid && (options.from_hopf || second)) {
    say(fmt::format(
        "{} follows orbits of autonomous equations without events, and this model has events or depends on time",
        second ? "--and" : "--from-hopf"));
    return wrong_model;
  }
  if (closed && !hybrid &&
      !can_be_studied_alone(studied, options.mode, range ? "orbits are followed" : "an orbit is solved for"))
    return wrong_model;
  if (range)
    return show_orbit_branches(studied, {.range = *range,
                                         .second = second,
                                         .third = third,
                                         .search = search_of(options),
                                         .hybrid = hybrid ? std::optional(shooting_of(options)) : std::nullopt,
                                         .patient = options.patient,
                                         .from_hopf = options.from_hopf,
                                         .json = options.json,
                                         .others = options.others,
                                         .steps = options.steps,
                                         .of = options.of,
                                         .out = options.out,
                                         .plot = options.plot});
  if (closed) return show_orbit(studied, options);
  const LongMotion motion{.settle = *options.settle,
                          .duration = options.duration,
                          .tolerance = options.tolerance,
                          .whole = needs_all(studied, options),
                          .json = options.json,
                          .out = options.out,
                          .plot = options.plot};
  return options.lyapunov ? show_exponents(studied, motion) : show_section(studied, options.section, motion);
}

}  // namespace

void add_orbit(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo orbit models/van_der_pol_stiff.sim --set mu=10                  period, multipliers, extent\n"
      "  continuo orbit models/van_der_pol_stiff.sim --set mu=1 --along mu=0.1..10 --plot mu.svg  how it changes\n"
      "  continuo orbit models/lorenz.sim --along rho=10..30 --from-hopf          orbits born at a Hopf point\n"
      "  continuo orbit models/thermostat.sim                                     with events, modes, time-dependent "
      "forces\n"
      "  continuo orbit models/lorenz.sim --lyapunov --duration 5000              Lyapunov exponents\n"
      "  continuo orbit models/lorenz.sim --section z=27 --duration 500 -o s.csv  a Poincare section\n";
  Verb* verb = add_verb(app, listed("orbit"), examples, {wrong_model, numerical_failure, interrupted});
  verb->json_examples = {"continuo orbit models/van_der_pol_stiff.sim --set mu=1 --json",
                         "continuo orbit models/van_der_pol_stiff.sim --set mu=1 --along mu=0.5..2 --json",
                         "continuo orbit models/lorenz.sim --lyapunov --duration 100 --json"};
  auto options = std::make_shared<OrbitOptions>();
  add_model(*verb, options->experiment);
  verb->add_option("--mode", options->mode, "The mode whose equations are used")->type_name("NAME");
  verb->add_option("--settle", options->settle,
                   "Time for transients to decay (default: the duration of the model's run)")
      ->check(number_from(0))
      ->type_name("T");
  verb->add_option("--duration", options->duration, "Time for the search (default: the duration of the model's run)")
      ->check(number_above(0))
      ->type_name("T");
  verb->add_option("--tol", options->tolerance, "Tolerance of the orbit")
      ->check(number_between(1e-14, 1))
      ->type_name("TOL");
  verb->add_option("--period", options->forcing, "Period of the forcing, if it cannot be determined from the text")
      ->transform(quotients())
      ->check(number_above(0))
      ->type_name("T");
  verb->add_option("--turns", options->turns,
                   "Period of the orbit as a multiple of that of the forcing (default: detected)")
      ->check(count_from(1))
      ->type_name("N");
  auto* section = verb->add_option("--section", options->section,
                                   "Poincare section: the states at upward crossings of a plane, as CSV")
                      ->type_name("NAME=VALUE");
  auto* lyapunov = verb->add_flag("--lyapunov", options->lyapunov, "Lyapunov exponents")->excludes(section);
  auto* along = verb->add_option("--along", options->along, "Follows the orbit along a parameter")
                    ->type_name("NAME=LOW..HIGH")
                    ->excludes(section)
                    ->excludes(lyapunov);
  verb->add_option(
          "--and", options->and_along,
          "Follows the bifurcations found while this parameter varies too; a second time: degenerate homoclinic orbits")
      ->type_name("NAME=LOW..HIGH")
      ->allow_extra_args(false)
      ->needs(along);
  verb->add_flag("--from-hopf", options->from_hopf, "Starts from the Hopf points of equilibria")->needs(along);
  verb->add_option("--branches", options->others, "Number of bifurcating branches to follow (3)")
      ->check(count_from(0, 1000))
      ->type_name("N")
      ->needs(along);
  add_branch_steps(*verb, options->steps, along);
  verb->add_flag("--json", options->json, "All of it as one JSON object");
  verb->add_option("--of", options->of, "The state to plot over the parameter")->type_name("STATE")->needs(along);
  writes_file(
      *verb,
      verb->add_option("-o,--out", options->out,
                       "Writes the section (default: standard output), or the table of --along or --and, as CSV"),
      {".csv"});
  writes_file(*verb,
              verb->add_option("--plot", options->plot, "Plots the orbit, --along, --and or --section, .svg or .png"));
  verb->callback([&exit, options] { exit = orbit(*options); });
}

}  // namespace continuo::app
