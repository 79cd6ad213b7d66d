// Adds the options for results, writes the files of a run, prints its summary, chooses the exit code.
#include <algorithm>
#include <span>

#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/file_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/runs/run_results.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/results/json.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/results/run_tables.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

constexpr std::string_view manifest_suffix = ".manifest.json";

/// Not standard output, a pipe or a device.
bool is_file(const std::string& path) {
  const results::FilePlace place = results::place_of(path);
  return !path.empty() && !place.descriptor && place.kind == results::FilePlace::Kind::file;
}

/// The files of a run that was ended before its time have the names of unfinished ones.
RunOutputs unfinished(RunOutputs outputs) {
  for (std::string* path : {&outputs.events, &outputs.plot, &outputs.manifest})
    if (is_file(*path)) *path = results::free_unfinished_name(*path);
  return outputs;
}

bool write_files(const RunOutputs& asked, const model::ModelProgram& program, const model::Run& run,
                 MotionTable& motion) {
  const model::Model& model = program.model;
  const bool is_whole = !interrupt_flag().load();
  RunOutputs outputs = is_whole ? asked : unfinished(asked);
  bool fine = written(motion.finish(run, is_whole));
  if (!is_whole && !motion.present_name().empty()) {
    outputs.motion = motion.present_name();
    say(fmt::format("the rows up to t = {:g} are in {}", run.final_time(), outputs.motion));
  }
  if (!outputs.events.empty()) {
    const std::string hash = results::manifest_hash(model, run.plan, run.first_state(), CONTINUO_VERSION);
    fine = written(results::write_events(run, outputs.events, hash)) && fine;
  }
  const std::string manifest_path = manifest_file(outputs);
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

std::string manifest_file(const RunOutputs& outputs) {
  if (!outputs.manifest.empty()) return outputs.manifest;
  for (const std::string& table : {outputs.motion, outputs.events}) {
    if (is_file(table)) return table + std::string(manifest_suffix);
  }
  return {};
}

void add_outputs(CLI::App& verb, RunOutputs& outputs) {
  const auto* motion = writes_table(
      verb,
      verb.add_option("-o,--out", outputs.motion,
                      "Writes all rows, as .csv, .tsv, .json, .nc (netCDF) or .mat (MATLAB); - for standard output"));
  const auto* events = writes_file(
      verb,
      verb.add_option(
          "--events", outputs.events,
          "Writes all events as CSV, with the states before and after; contacts of bodies with their impulse"),
      {".csv"});
  writes_file(verb, verb.add_option("--plot", outputs.plot, "Writes a plot, .svg or .png"));
  const auto* manifest =
      writes_file(verb, verb.add_option("--manifest", outputs.manifest,
                                        "Writes the manifest: model, options, versions (default: beside the table)"));
  for (const CLI::Option* table : {motion, events}) writes_beside(verb, table, std::string(manifest_suffix), manifest);
  verb.add_flag("--json", outputs.json, "The result as one JSON object on standard output");
}

bool can_be_written(const RunOutputs& outputs) {
  return drawable(outputs.plot);
}

bool needs_rows(const RunOutputs& outputs) {
  return !outputs.plot.empty();
}

ExitCode tell(const model::Simulated& simulated, const model::Source& source, const model::ModelProgram& program,
              const RunOutputs& outputs, bool as_written) {
  MotionTable motion(outputs.motion, program);
  return tell(simulated, source, program, outputs, as_written, motion);
}

ExitCode tell(const model::Simulated& simulated, const model::Source& source, const model::ModelProgram& program,
              const RunOutputs& outputs, bool as_written, MotionTable& motion) {
  show(simulated.diagnostics, source);
  if (!simulated.run) return exit_without_run(simulated.diagnostics);
  const model::Run& run = *simulated.run;
  const bool fine = write_files(outputs, program, run, motion);
  if (outputs.json) {
    answer("continuo.run/1", nlohmann::ordered_json::parse(results::run_json(run)));
  } else if (!outputs.data_to_standard_output()) {
    print(results::summary(program.model, run, as_written));
  }
  show_failed_checks(run, as_written);
  const ExitCode exit = exit_of(run, as_written);
  return fine || exit == numerical_failure ? exit : usage;
}

}  // namespace continuo::app
