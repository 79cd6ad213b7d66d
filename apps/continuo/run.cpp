// continuo run FILE: the motion, its events, plots, and what it cost.
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <apps/continuo/command_line.hpp>
#include <apps/continuo/experiment_options.hpp>
#include <apps/continuo/models.hpp>
#include <apps/continuo/progress.hpp>
#include <apps/continuo/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>

#include <continuo/model/diagnostic.hpp>
#include <continuo/model/simulate.hpp>
#include <continuo/results/json.hpp>
#include <continuo/results/netcdf.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/results/tables.hpp>
#include <continuo/studies/boundary_of_model.hpp>

namespace continuo::app {
namespace {

struct RunRequest {
  ExperimentOptions experiment;
  std::string motion, events, plot, manifest;  // files; empty: not wanted
  bool json = false, estimate_error = false;
  std::size_t solution = 1;

  bool data_to_standard_output() const { return json || motion == "-" || events == "-" || manifest == "-"; }
};

/// Beside a table stands the manifest that its first line points to.
std::string manifest_file(const RunRequest& request) {
  if (!request.manifest.empty()) return request.manifest;
  for (const std::string& table : {request.motion, request.events}) {
    if (!table.empty() && table != "-") return table + ".manifest.json";
  }
  return {};
}

bool write_files(const RunRequest& request, const model::ModelProgram& program, const model::Run& run) {
  const model::Model& model = program.model;
  const std::string manifest_path = manifest_file(request);
  bool fine = true;
  if (!request.motion.empty() || !request.events.empty()) {
    const std::string hash = results::manifest_hash(model, run, CONTINUO_VERSION);
    if (results::is_netcdf(request.motion)) {
      fine = written(results::write_netcdf(model, run, request.motion, hash)) && fine;
    } else if (!request.motion.empty()) {
      fine = written(results::write_motion(run, request.motion, hash)) && fine;
    }
    if (!request.events.empty()) fine = written(results::write_events(run, request.events, hash)) && fine;
  }
  if (!manifest_path.empty()) {
    fine = written(results::write_file(manifest_path, results::manifest(model, run, CONTINUO_VERSION))) && fine;
  }
  if (!request.plot.empty()) {
    const auto plots = results::plots_of(program, run);
    fine = written(results::draw(results::figure_of(model.name, run, plots), request.plot)) && fine;
  }
  return fine;
}

void show_failed_checks(const model::Run& run, bool as_written) {
  for (const model::CheckResult& check : run.checks) {
    if (!check.passed && as_written) say(results::failed_check(check));
  }
}

/// Checks hold for the model as written; another parameter or method may break them without being wrong.
ExitCode exit_of(const model::Run& run, bool as_written) {
  if (run.outcome.ending == Ending::interrupted) return interrupted;
  if (!succeeded(run.outcome.ending)) return numerical_failure;
  return as_written && !run.checks_passed() ? check_failed : done;
}

/// E33x and E34x: what was asked does not fit the model; else it cannot be computed.
ExitCode exit_without_run(std::span<const model::Diagnostic> diagnostics) {
  const bool asked_wrongly = std::ranges::any_of(diagnostics, [](const auto& problem) {
    return problem.code.starts_with("E33") || problem.code.starts_with("E34");
  });
  if (std::ranges::any_of(diagnostics, [](const auto& problem) { return problem.code == "E307"; })) return interrupted;
  return asked_wrongly ? usage : numerical_failure;
}

/// Why there is no run, as JSON.
void print_no_run(std::span<const model::Diagnostic> diagnostics, const model::Source& source) {
  print(fmt::format("{{\n  \"outcome\": \"not run\",\n  \"messages\": {}\n}}\n", model::to_json(diagnostics, source)));
}

bool all_can_be_written(const RunRequest& request) {
  return writable(request.motion) && writable(request.events) && writable(request.manifest) && drawable(request.plot);
}

ExitCode run(const RunRequest& request) {
  if (!all_can_be_written(request)) return usage;
  Prepared prepared = prepare(request.experiment, Worlds::welcome);
  const model::Source& source = prepared.loaded.source;
  if (prepared.exit != done) {
    if (request.json) print_no_run(prepared.loaded.diagnostics, source);
    return prepared.exit;
  }
  const model::Simulated simulated = [&] {
    Progress progress;
    prepared.experiment.progress = watcher_of(prepared, progress);
    prepared.experiment.estimate_error = request.estimate_error;
    return studies::run_model(prepared.program, prepared.experiment, request.solution);
  }();
  show(simulated.diagnostics, source);
  if (!simulated.run) {
    if (request.json) print_no_run(simulated.diagnostics, source);
    return exit_without_run(simulated.diagnostics);
  }
  const model::Run& run = *simulated.run;
  const bool as_written = request.experiment.as_written() && request.solution == 1;
  const bool fine = write_files(request, *prepared.program, run);
  if (request.json) {
    print(results::run_json(run));
  } else if (!request.data_to_standard_output()) {
    print(results::summary(prepared.program->model, run, as_written));
  }
  show_failed_checks(run, as_written);
  const ExitCode exit = exit_of(run, as_written);
  return exit == done && !fine ? usage : exit;
}

}  // namespace

void add_run(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo run models/bouncing_ball.sim                      the motion in a few lines\n"
      "  continuo run ball.sim -o ball.csv --plot ball.svg          every row, and a picture\n"
      "  continuo run gas.sim -o gas.nc                             the same for xarray, bodies as arrays\n"
      "  continuo run ball.sim --set g=1.62 --until 20              on the Moon, for longer\n"
      "  continuo run orbit.sim --method rk4 --step 0.01 --events apsides.csv\n"
      "  continuo run scene.sim --method fast --step 0.01           a world of bodies, in steps\n"
      "  continuo run ball.sim -o - | head                          rows to another program\n"
      "  continuo run ball.sim --json                               outcome, state, events, cost\n";
  CLI::App* verb = add_verb(app, "run", "Runs a model and shows, plots or writes its motion", examples);
  auto request = std::make_shared<RunRequest>();
  add_experiment(*verb, request->experiment);
  add_method(*verb, request->experiment);
  verb->add_option("-o,--out", request->motion, "Every row, as CSV (- for standard output) or .nc (netCDF)")
      ->type_name("FILE");
  verb->add_option("--events", request->events, "Every event as CSV, with the states before and after")
      ->type_name("FILE");
  verb->add_option("--plot", request->plot, "A picture, .svg or .png")->type_name("FILE");
  verb->add_option("--manifest", request->manifest, "What was run and how (else beside the CSV)")->type_name("FILE");
  verb->add_flag("--estimate-error", request->estimate_error,
                 "The true error, by a second run a hundred times as strict");
  verb->add_option("--solution", request->solution, "Of a boundary-value problem with several: which one")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  verb->add_flag("--json", request->json, "The result as one JSON object on standard output");
  verb->callback([&exit, request] { exit = run(*request); });
}

}  // namespace continuo::app
