// continuo run FILE: the motion, its events, plots, and what it cost.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <apps/continuo/options/boundary_options.hpp>
#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/runs/run_file.hpp>
#include <apps/continuo/runs/run_results.hpp>
#include <apps/continuo/runs/sweep.hpp>
#include <apps/continuo/runs/sweep_results.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs/run.hpp>
#include <fmt/format.h>

#include <continuo/language/sweep.hpp>
#include <continuo/results/motion_curves.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/watched_run.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::app {
namespace {

struct RunRequest {
  ExperimentOptions experiment;
  RunOutputs outputs;
  bool estimate_error = false;
  BoundaryOptions boundary;
  RecordTo record;
  std::optional<std::uint64_t> sweep_run;
};

/// Where the run is recorded as it goes; null where nobody wants that.
runs::Log* log_of(const RunRequest& request, const Prepared& prepared, RunFile& file) {
  if (!file.is_wanted()) return nullptr;
  model::RunHead head;
  head.file = prepared.loaded.source.name();
  head.text = prepared.loaded.source.text();
  head.decides_size = prepared.decides_size;
  head.as_written = !request.sweep_run && request.experiment.as_written();
  head.experiment = prepared.experiment;
  return file.begin(*prepared.program, std::move(head));
}

/// Families are no run: nothing of it can be written, which is said and not passed over.
bool shows_families(const RunRequest& request) {
  const char* unused = !request.outputs.events.empty()       ? "--events"
                       : !request.outputs.plot_texts.empty() ? "--plot in words"
                       : !request.outputs.manifest.empty()   ? "--manifest"
                       : request.estimate_error              ? "--estimate-error"
                       : request.experiment.output           ? "--output"
                                                             : nullptr;
  if (unused == nullptr) return true;
  say(fmt::format("--family shows solutions over a parameter, of which there is no {}: leave it out", unused));
  return false;
}

/// True, after saying why, where --method names no method. The message stands under the option, not in the model, whose
/// own method may be right. What a world of bodies and a boundary-value problem say of a method is their own.
bool has_no_method(const RunRequest& request, const model::Model& model) {
  const std::optional<std::string>& name = request.experiment.method;
  if (!name || find_method(*name) != nullptr || model.world || !runs::kind_of(model).has_start) return false;
  const std::vector<model::Diagnostic> problems{
      model::no_method(*name, {.begin = 0, .end = static_cast<std::uint32_t>(name->size())})};
  const model::Source option("--method", *name);
  show(problems, option);
  return true;
}

/// The option that goes with one run only; null where none of them is given.
const char* not_of_sweep(const RunRequest& request) {
  if (!request.record.path.empty()) return "--record";
  if (!request.boundary.family.empty()) return "--family";
  if (!request.boundary.guess.empty()) return "--guess";
  if (!request.boundary.as_written()) return "--along and --solution";
  return nullptr;
}

ExitCode sweep(RunRequest& request, const std::vector<SweepText>& texts, Prepared& base) {
  if (moves(request.outputs.plot)) {
    say(fmt::format("{} is a film of one run; for several the name ends in {}", request.outputs.plot,
                    results::picture_endings));
    return usage;
  }
  if (const char* option = not_of_sweep(request)) {
    say(fmt::format("{} is for one run, and {} asks for several", option, texts.front().text));
    return usage;
  }
  const std::optional<Sweep> asked = read_sweep(texts, base);
  if (!asked) return usage;
  request.outputs.no_sketch = true;
  const auto curves = curves_for(request.outputs, base);
  if (!curves) return usage;
  base.experiment.estimate_error = request.estimate_error;
  base.experiment.doubts = true;
  const std::string hash = hash_of_sweep(*asked, base);
  SweepTable table(request.outputs.motion, *asked, hash);
  const std::vector<SweepMember> members = [&] {
    Progress progress;
    return run_sweep(*asked, base, curves->get(), table, progress.parts());
  }();
  return tell_sweep(*asked, members, base, request.outputs, table, hash);
}

/// The run, shown to the curves where there are any. Where they have not seen it, they are made anew, and the picture
/// shows the rows.
model::Simulated run_and_show(const Prepared& prepared, const runs::RunRequest& asked,
                              std::unique_ptr<results::MotionCurves>& curves) {
  if (!curves) return runs::run(prepared.program, prepared.experiment, asked);
  auto anew = std::make_unique<results::MotionCurves>(*curves);
  runs::WatchedRun watched = runs::run(prepared.program, prepared.experiment, asked, *curves);
  if (!watched.is_shown) curves = std::move(anew);
  return std::move(watched.simulated);
}

ExitCode run(RunRequest request, const RunParts& parts) {
  const std::vector<SweepText> swept = take_sweep(request.experiment);
  if (!reads_standard_input_once({request.experiment.file, request.boundary.guess, request.experiment.initial_from}) ||
      !can_be_written(request.outputs) || !can_be_written(request.record))
    return usage;
  Prepared prepared = prepare(request.experiment, Worlds::welcome);
  const model::Source& source = prepared.loaded.source;
  if (prepared.exit == done && !request.record.path.empty() &&
      !runs::kind_of(prepared.program->model).can_be_recorded) {
    say("--record: a boundary-value problem is solved at once, so there is nothing to resume; -o saves its solution");
    return usage;
  }
  if (prepared.exit != done) return prepared.exit;
  if (has_no_method(request, prepared.program->model)) return usage;
  if (request.sweep_run && !swept.empty()) {
    say(fmt::format("--sweep-run is one run, and {} asks for several", swept.front().text));
    return usage;
  }
  if (!swept.empty()) return sweep(request, swept, prepared);
  if (request.sweep_run) {
    if (const ExitCode exit = parts.take_sweep_run(prepared, *request.sweep_run); exit != done) return exit;
  }
  const auto boundary = read_boundary(request.boundary, prepared);
  if (!boundary) return usage;
  if (!request.boundary.family.empty()) {
    if (!shows_families(request)) return usage;
    const auto range = read_family(request.boundary, prepared);
    return range ? parts.show_families(prepared, *boundary, *range, request.boundary.of, request.outputs) : usage;
  }
  const std::string film_path = moves(request.outputs.plot) ? std::exchange(request.outputs.plot, {}) : std::string();
  if (!film_path.empty() && !request.outputs.plot_texts.empty()) {
    say(fmt::format("{} shows the scene of the model; for plots the name ends in {}", film_path,
                    results::picture_endings));
    return usage;
  }
  if (!film_path.empty()) request.outputs.no_sketch = true;
  auto curves = curves_for(request.outputs, prepared);
  if (!curves) return usage;
  RunFile file(request.record);
  MotionTable motion(request.outputs.motion, *prepared.program);
  const model::OnRow on_row =
      motion.rows_of(prepared.experiment, needs_rows(request.outputs) || request.estimate_error);
  const model::Simulated simulated = [&] {
    Progress progress;
    prepared.experiment.progress = watcher_of(prepared, progress);
    prepared.experiment.estimate_error = request.estimate_error;
    prepared.experiment.doubts = true;
    return run_and_show(prepared, {.boundary = *boundary, .log = log_of(request, prepared, file), .on_row = on_row},
                        *curves);
  }();
  if (lacks_fused_code(prepared.program->model)) return usage;
  const bool is_recorded = file.finish(simulated);
  const ExitCode exit = tell(simulated, source, *prepared.program, request.outputs,
                             !request.sweep_run && request.experiment.as_written() && request.boundary.as_written(),
                             motion, curves->get());
  if (!film_path.empty() && exit == done) {
    if (const ExitCode filmed = parts.write_film(request.experiment, film_path); filmed != done) return filmed;
  }
  return is_recorded || exit != done ? exit : usage;
}

}  // namespace

void add_run(CLI::App& app, ExitCode& exit, RunParts parts) {
  static constexpr std::string_view examples =
      "  continuo run models/bouncing_ball.sim                      the motion in a few lines\n"
      "  continuo run ball.sim -o ball.csv --plot ball.svg          all rows, and a plot\n"
      "  continuo run gas.sim -o gas.nc                             the same for xarray, bodies as arrays\n"
      "  continuo run ball.sim --plot phase.svg --plot \"h' against h\"   what to draw, in words\n"
      "  continuo run ball.sim --plot ball.gif                      the scene as a film (.gif, .mp4)\n"
      "  continuo run ball.sim --set g=1.62 --until 20              on the Moon, for longer\n"
      "  continuo run spring.sim --set k=1,2,5 --plot k.svg         several runs: one table, one picture\n"
      "  continuo run spring.sim --set k=1..5/9 --initial x=1,2     nine values of k, each from two starts\n"
      "  continuo run orbit.sim --method rk4 --step 0.01 --events apsides.csv\n"
      "  continuo run scene.sim --method fast --step 0.01           a world of bodies, in fixed steps\n"
      "  continuo run ball.sim --initial h=3 --initial \"h'=-1\"      from another start\n"
      "  continuo run ball.sim --initial-from ball.csv              on from the last row of a table\n"
      "  continuo run gas.sim --record gas.run                      a recording, for replay and resume\n"
      "  continuo run ball.sim -o - | head                          rows for another program\n"
      "  continuo run layer.sim --along eps=1..1e-4                 boundary-value problem, continued from an easy "
      "case\n"
      "  continuo run bratu.sim --family p=0.1..4 --plot bratu.svg  all solutions along p, around folds and at branch "
      "points\n"
      "  continuo run ball.sim --json                               outcome, state, events, cost\n";
  Verb* verb = add_verb(app, listed("run"), examples, {wrong_model, numerical_failure, check_failed, interrupted});
  verb->json_examples = {"continuo run models/bouncing_ball.sim --json",
                         "continuo run models/mass_spring.sim --set k=1,2,5 --json",
                         "continuo run models/bratu.sim --family lambda=0.1..4 --json"};
  auto request = std::make_shared<RunRequest>();
  add_experiment(*verb, request->experiment);
  add_method(*verb, request->experiment);
  add_limits(*verb, request->experiment);
  add_initial(*verb, request->experiment);
  add_outputs(*verb, request->outputs);
  add_record(*verb, request->record);
  verb->add_flag("--estimate-error", request->estimate_error,
                 "Estimates the global error by a second run with a tolerance a hundred times smaller");
  add_boundary(*verb, request->boundary);
  verb->add_option("--sweep-run", request->sweep_run, "One run of the model's sweep, by its number, to the same bits")
      ->check(count_from(0, model::most_sweep_runs))
      ->type_name("N");
  add_sweep_words(*verb, request->experiment.sweep, false);
  verb->callback([&exit, request, parts = std::move(parts)] {
    request->experiment.sweep.is_wanted = request->sweep_run.has_value();
    exit = run(*request, parts);
  });
}

}  // namespace continuo::app
