// Adds the options for results, writes the files of a run, prints its summary, chooses the exit code.
#include <algorithm>
#include <memory>
#include <span>

#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/file_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/plot_text.hpp>
#include <apps/continuo/runs/run_results.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/show_sketch.hpp>
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

bool write_files(const RunOutputs& asked, const model::ModelProgram& program, const model::Run& run,
                 MotionTable& motion, results::MotionCurves& curves) {
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
    results::Figure figure = results::figure_of(program, run, curves);
    figure.size = outputs.size;
    fine = written(results::draw(figure, outputs.plot)) && fine;
  }
  return fine;
}

/// Where the result is read on a terminal, and drawn nowhere else.
bool wants_sketch(const RunOutputs& outputs) {
  const bool asks_for_files = !outputs.plot.empty() || !outputs.motion.empty() || !outputs.events.empty();
  return !outputs.no_sketch && !asks_for_files && !outputs.json && outputs.manifest != "-" && can_show_sketch();
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

RunOutputs unfinished(RunOutputs outputs) {
  for (std::string* path : {&outputs.events, &outputs.plot, &outputs.manifest})
    if (is_file(*path)) *path = results::free_unfinished_name(*path);
  return outputs;
}

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
  writes_file(
      verb,
      verb.add_option_function<std::vector<std::string>>(
          "--plot",
          [&outputs](const std::vector<std::string>& values) {
            for (const std::string& value : values) {
              if (!names_picture(value)) {
                outputs.plot_texts.push_back(value);
              } else if (outputs.plot.empty()) {
                outputs.plot = value;
              } else {
                throw CLI::ValidationError("--plot", fmt::format("{} and {}: one picture is written; panels are "
                                                                 "plots, as in --plot \"y against x\"",
                                                                 outputs.plot, value));
              }
            }
          },
          "Writes a picture: .svg, .png or .pdf; and says what it shows, where not what the model says: \"y against "
          "x\", "
          "\"u[1..N] against index at 0, 1, 5\", \"c against t log xy\"; a panel for each --plot and each ;"),
      {}, names_picture)
      ->type_name("FILE|PLOT")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb.add_option_function<std::string>(
          "--size",
          [&outputs](const std::string& text) {
            const auto size = read_size(text);
            if (!size)
              throw CLI::ValidationError(
                  "--size",
                  text + " is no size: write the width and the height in pixels, from 100 to 10000, as in 1280x720");
            outputs.size = *size;
          },
          "The size of the picture in pixels: --size 1280x720")
      ->type_name("WxH");
  const auto* manifest =
      writes_file(verb,
                  verb.add_option("--manifest", outputs.manifest,
                                  "Writes the manifest: model, options, versions (default: beside the table)"),
                  {".json"});
  for (const CLI::Option* table : {motion, events}) writes_beside(verb, table, std::string(manifest_suffix), manifest);
  verb.add_flag("--no-sketch", outputs.no_sketch, "Draws no small picture in the terminal");
  verb.add_flag("--json", outputs.json, "The result as one JSON object on standard output");
}

bool can_be_written(const RunOutputs& outputs) {
  return moves(outputs.plot) || drawable(outputs.plot);
}

bool moves(const std::string& picture) {
  return picture.ends_with(".gif") || picture.ends_with(".mp4");
}

bool wants_picture(const RunOutputs& outputs) {
  return !outputs.plot.empty() || wants_sketch(outputs);
}

std::optional<std::unique_ptr<results::MotionCurves>> curves_for(const RunOutputs& outputs, const Prepared& prepared) {
  if (!outputs.plot_texts.empty() && !wants_picture(outputs)) {
    say(fmt::format("--plot \"{}\" says what to draw, and nothing says where: add --plot FILE.svg",
                    outputs.plot_texts.front()));
    return std::nullopt;
  }
  if (!wants_picture(outputs)) return nullptr;
  auto asked = read_plots(outputs.plot_texts, prepared);
  if (!asked) return std::nullopt;
  auto curves = std::make_unique<results::MotionCurves>(std::move(asked->program), std::move(asked->plots));
  if (!outputs.plot_texts.empty()) curves->leave_out_drift();
  return curves;
}

bool needs_rows(const RunOutputs& outputs) {
  return wants_picture(outputs);
}

ExitCode tell(const model::Simulated& simulated, const model::Source& source, const model::ModelProgram& program,
              const RunOutputs& outputs, bool as_written, MotionTable& motion, results::MotionCurves* curves) {
  show(simulated.diagnostics, source);
  if (!simulated.run) return exit_without_run(simulated.diagnostics);
  const model::Run& run = *simulated.run;
  results::MotionCurves of_rows(std::shared_ptr<const model::ModelProgram>(std::shared_ptr<void>(), &program),
                                results::plot_requests(program.model));
  results::MotionCurves& drawn = curves ? *curves : of_rows;
  const bool fine = write_files(outputs, program, run, motion, drawn);
  if (outputs.json) {
    answer("continuo.run/1", nlohmann::ordered_json::parse(results::run_json(run)));
  } else if (!outputs.data_to_standard_output()) {
    print(results::summary(program.model, run, as_written));
    if (wants_sketch(outputs)) show_sketch(results::figure_of(program, run, drawn));
  }
  show_failed_checks(run, as_written);
  const ExitCode exit = exit_of(run, as_written);
  return fine || exit == numerical_failure ? exit : usage;
}

}  // namespace continuo::app
