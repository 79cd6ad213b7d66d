// continuo replay FILE: a recorded run again, without simulating. continuo resume FILE: on from a place in it.
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/runs/run_file.hpp>
#include <apps/continuo/runs/run_results.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>

#include <continuo/language/load.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/recording.hpp>
#include <continuo/runs/run.hpp>

namespace continuo::app {
namespace {

struct ReplayRequest {
  std::string file;
  RunOutputs outputs;
  std::optional<double> at, until;
  std::optional<std::size_t> max_steps;
  RecordTo record;
};

/// A recording and the model in it, or how the verb ends without.
struct Opened {
  ExitCode exit = usage;
  runs::Recording recording{};
  model::Loaded loaded{model::Source("", ""), {}, {}};
  std::shared_ptr<const model::ModelProgram> program{};
};

Opened open(const ReplayRequest& request) {
  Opened opened;
  if (!can_be_written(request.outputs)) return opened;
  auto recording = read_run(request.file);
  if (!recording) return opened;
  opened.recording = std::move(*recording);
  const model::RunHead& head = runs::head_of(opened.recording);
  model::CheckOptions options;
  if (head.decides_size) options.overrides = head.experiment.parameters;
  opened.loaded = model::load(model::Source(head.file, head.text), options);
  if (!opened.loaded || !runs::fits(opened.recording, *opened.loaded.model)) {
    show(opened.loaded.diagnostics, opened.loaded.source);
    say(fmt::format("{}: the model in the recording is not in order", request.file));
    opened.exit = wrong_model;
    return opened;
  }
  opened.program = model::compile(*std::exchange(opened.loaded.model, std::nullopt));
  opened.exit = done;
  return opened;
}

std::string places_of(const runs::Recording& recording) {
  const std::vector<double> times = runs::checkpoints_of(recording);
  if (times.empty()) return "none to go on from";
  return fmt::format("{} to go on from, t = {:g} to {:g}: continuo resume", times.size(), times.front(), times.back());
}

/// The curves of the picture that is wanted, through the rows of the recording; nothing where their text is wrong.
std::optional<std::unique_ptr<results::MotionCurves>> curves_for(const ReplayRequest& request, const Opened& opened) {
  return curves_for(request.outputs, {.exit = done,
                                      .loaded = opened.loaded,
                                      .program = opened.program,
                                      .experiment = runs::head_of(opened.recording).experiment,
                                      .decides_size = runs::head_of(opened.recording).decides_size});
}

/// The rows of such an experiment go to the table, and are kept only for what is made of all of them.
model::RowsOfRecording rows_for(MotionTable& motion, model::Experiment experiment, const RunOutputs& outputs) {
  experiment.keep_rows = needs_rows(outputs);
  model::OnRow on_row = motion.rows_of(experiment, needs_rows(outputs));
  return {.on_row = std::move(on_row), .keep_rows = experiment.keep_rows};
}

ExitCode replay(const ReplayRequest& request) {
  const Opened opened = open(request);
  if (opened.exit != done) return opened.exit;
  const auto curves = curves_for(request, opened);
  if (!curves) return usage;
  const runs::Recording& recording = opened.recording;
  if (!runs::is_whole(recording))
    mention(fmt::format("{} was cut off after t = {:g}", request.file, runs::last_time(recording)));
  MotionTable motion(request.outputs.motion, *opened.program);
  const model::Simulated simulated =
      runs::replay(opened.program, recording, rows_for(motion, runs::head_of(recording).experiment, request.outputs));
  const ExitCode exit = tell(simulated, opened.loaded.source, *opened.program, request.outputs,
                             runs::head_of(recording).as_written, motion, curves->get());
  if (simulated.run && !request.outputs.data_to_standard_output())
    print(fmt::format("places  {}\n", places_of(recording)));
  return exit;
}

ExitCode resume(const ReplayRequest& request) {
  if (!can_be_written(request.record)) return usage;
  const Opened opened = open(request);
  if (opened.exit != done) return opened.exit;
  if (has_changed(runs::head_of(opened.recording), *opened.program, request.file)) return usage;
  const runs::Recording& recording = opened.recording;
  const std::vector<double> times = runs::checkpoints_of(recording);
  if (times.empty()) {
    say(fmt::format("{} contains no snapshot to resume from: it was recorded with --snapshots 0", request.file));
    return usage;
  }
  const std::optional<double> latest = request.at ? request.at : request.until;
  const std::size_t checkpoint = latest ? runs::checkpoint_at(recording, *latest) : times.size() - 1;
  const double from = times[checkpoint];
  if ((request.at && *request.at < from) || (request.until && *request.until < from)) {
    say(fmt::format("the snapshot to resume from is at t = {:g}; --at and --until cannot be earlier", from));
    return usage;
  }
  if (request.max_steps && !std::holds_alternative<model::IntegrationRecording>(recording)) {
    say("--max-steps is for equations");
    return usage;
  }
  const auto curves = curves_for(request, opened);
  if (!curves) return usage;
  mention(fmt::format("resumes from t = {:g}", from));
  RunFile file(request.record);
  model::RunHead head = runs::head_of(recording);
  if (request.until) head.experiment.to = request.until;
  if (request.max_steps) head.experiment.max_steps = request.max_steps;
  runs::Log* const log = file.begin(*opened.program, head);
  MotionTable motion(request.outputs.motion, *opened.program);
  const model::Simulated simulated = [&] {
    Progress progress;
    std::vector<model::Diagnostic> problems;  // the run itself will tell of them
    const auto plan = runs::plan(opened.program->model, head.experiment, problems);
    return runs::resume(opened.program, recording, checkpoint,
                        {.to = request.until,
                         .max_steps = request.max_steps,
                         .interrupt = &interrupt_flag(),
                         .progress = plan ? progress.over(from, plan->to) : nullptr,
                         .rows = rows_for(motion, head.experiment, request.outputs)},
                        log);
  }();
  const bool is_recorded = file.finish(simulated);
  const ExitCode exit = tell(simulated, opened.loaded.source, *opened.program, request.outputs,
                             head.as_written && !request.until, motion, curves->get());
  return is_recorded || exit != done ? exit : usage;
}

}  // namespace

void add_replay(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo run gas.sim --record gas.run                      runs a model and records it\n"
      "  continuo replay gas.run                                    its results, without simulating\n"
      "  continuo replay gas.run -o gas.nc --plot gas.svg           its rows and a plot\n";
  Verb* verb = add_verb(app, listed("replay"), examples, {wrong_model, numerical_failure, check_failed, interrupted});
  verb->json_examples = {
      "continuo run models/newtons_cradle.sim --record cradle.run && continuo replay cradle.run --json"};
  auto request = std::make_shared<ReplayRequest>();
  reads_file(*verb, verb->add_option("file", request->file, "A recording, written by --record")->required(),
             files_of_recording);
  add_outputs(*verb, request->outputs);
  verb->callback([&exit, request] { exit = replay(*request); });
}

void add_resume(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo resume gas.run                                    continues an interrupted run to its end\n"
      "  continuo resume gas.run --until 100 --record longer.run    continues beyond its end\n"
      "  continuo resume gas.run --at 20 -o gas.csv                 restarts from the last snapshot before t = 20\n";
  Verb* verb = add_verb(app, listed("resume"), examples, {wrong_model, numerical_failure, check_failed, interrupted});
  verb->json_examples = {
      "continuo run models/newtons_cradle.sim --record cradle.run && continuo resume cradle.run --json"};
  auto request = std::make_shared<ReplayRequest>();
  reads_file(*verb, verb->add_option("file", request->file, "A recording, written by --record")->required(),
             files_of_recording);
  verb->add_option("--at", request->at, "Starts from the last snapshot at or before this time (default: the last one)")
      ->type_name("T");
  verb->add_option("--until", request->until, "End time of the run")->type_name("T");
  verb->add_option("--max-steps", request->max_steps, "Equations: largest number of steps, with those before the break")
      ->check(count_from(1, 1'000'000'000'000))
      ->type_name("N");
  add_outputs(*verb, request->outputs);
  add_record(*verb, request->record);
  verb->callback([&exit, request] { exit = resume(*request); });
}

}  // namespace continuo::app
