// Adds the options for results, writes the files of a run, prints its summary, chooses the exit code.
#include <algorithm>
#include <span>

#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/runs/run_results.hpp>
#include <apps/continuo/terminal/modules.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/results/json.hpp>
#include <continuo/results/netcdf.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/results/run_tables.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

/// Beside a table stands the manifest that its first line points to.
std::string manifest_file(const RunOutputs& outputs) {
  if (!outputs.manifest.empty()) return outputs.manifest;
  for (const std::string& table : {outputs.motion, outputs.events}) {
    if (!table.empty() && table != "-") return table + ".manifest.json";
  }
  return {};
}

bool write_files(const RunOutputs& outputs, const model::ModelProgram& program, const model::Run& run) {
  const model::Model& model = program.model;
  const std::string manifest_path = manifest_file(outputs);
  bool fine = true;
  if (!outputs.motion.empty() || !outputs.events.empty()) {
    const std::string hash = results::manifest_hash(model, run, CONTINUO_VERSION);
    if (results::is_netcdf(outputs.motion)) {
      fine = written(results::write_netcdf(model, run, outputs.motion, hash)) && fine;
    } else if (!outputs.motion.empty()) {
      fine = written(results::write_motion(run, outputs.motion, hash)) && fine;
    }
    if (!outputs.events.empty()) fine = written(results::write_events(run, outputs.events, hash)) && fine;
  }
  if (!manifest_path.empty()) {
    fine = written(results::write_file(manifest_path, results::manifest(model, run, CONTINUO_VERSION))) && fine;
  }
  if (!outputs.plot.empty()) {
    fine = written(results::draw(results::figure_of(program, run), outputs.plot)) && fine;
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

}  // namespace

void add_outputs(CLI::App& verb, RunOutputs& outputs) {
  verb.add_option("-o,--out", outputs.motion, "Writes all rows, as CSV (- for standard output) or .nc (netCDF)")
      ->type_name("FILE");
  verb.add_option("--events", outputs.events,
                  "Writes all events as CSV, with the states before and after; contacts of bodies with their impulse")
      ->type_name("FILE");
  verb.add_option("--plot", outputs.plot, "Writes a plot, .svg or .png")->type_name("FILE");
  verb.add_option("--manifest", outputs.manifest,
                  "Writes the manifest: model, options, versions (default: beside the CSV)")
      ->type_name("FILE");
  verb.add_flag("--json", outputs.json, "The result as one JSON object on standard output");
}

void print_no_run(std::span<const model::Diagnostic> diagnostics, const model::Source& source) {
  print(fmt::format("{{\n  \"outcome\": \"not run\",\n  \"messages\": {}\n}}\n", model::to_json(diagnostics, source)));
}

bool can_be_written(const RunOutputs& outputs) {
  if (results::is_netcdf(outputs.motion) && !loadable(netcdf_module)) return false;
  return writable(outputs.motion) && writable(outputs.events) && writable(outputs.manifest) && drawable(outputs.plot);
}

std::vector<std::string> files_of(const RunOutputs& outputs) {
  return {outputs.motion, outputs.events, outputs.manifest, outputs.plot};
}

ExitCode tell(const model::Simulated& simulated, const model::Source& source, const model::ModelProgram& program,
              const RunOutputs& outputs, bool as_written) {
  show(simulated.diagnostics, source);
  if (!simulated.run) {
    if (outputs.json) print_no_run(simulated.diagnostics, source);
    return exit_without_run(simulated.diagnostics);
  }
  const model::Run& run = *simulated.run;
  const bool fine = write_files(outputs, program, run);
  if (outputs.json) {
    print(results::run_json(run));
  } else if (!outputs.data_to_standard_output()) {
    print(results::summary(program.model, run, as_written));
  }
  show_failed_checks(run, as_written);
  const ExitCode exit = exit_of(run, as_written);
  return exit == done && !fine ? usage : exit;
}

}  // namespace continuo::app
