// continuo sweep FILE: many runs of a model with other parameters, initial values and inputs, and what they leave.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/studies/sweep_indices.hpp>
#include <apps/continuo/studies/sweep_pictures.hpp>
#include <apps/continuo/studies/sweep_ranks.hpp>
#include <apps/continuo/studies/sweep_report.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/terminal/version.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/file_place.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/studies/sweep/sweep_table.hpp>
#include <continuo/studies/sweep/sweep_work.hpp>

namespace continuo::app {
namespace {

using studies::PreparedSweep;
using studies::SweepFolder;
using studies::SweepIdentity;
using Outcomes = std::vector<studies::SweepOutcome>;

/// "3/16".
struct Part {
  std::uint64_t number = 0, of = 0;
};

struct SweepOptions {
  ExperimentOptions experiment;
  std::string out;
  std::string part;
  std::string plot;
  std::size_t threads = 0;  // 0: as many as there are cores
  bool resume = false, merge = false, json = false, dark = false;
  SweepRanks* ranks = nullptr;  // those that make it together with this process
};

std::optional<Part> read_part(const std::string& text) {
  Part part;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, part.number);
  if (number.ec != std::errc() || number.ptr == end || *number.ptr != '/') return std::nullopt;
  const auto of = std::from_chars(number.ptr + 1, end, part.of);
  const bool fits = of.ec == std::errc() && of.ptr == end && part.number >= 1 && part.number <= part.of;
  return fits ? std::optional(part) : std::nullopt;
}

/// Whether there is a file beside which chunks can be kept; not a pipe or a device.
bool has_folder(const SweepOptions& options) {
  if (options.out.empty()) return false;
  const results::FilePlace place = results::place_of(options.out);
  return place.kind == results::FilePlace::Kind::file && !place.descriptor;
}

/// False after saying why the options do not go together.
bool fit_together(const SweepOptions& options) {
  const char* needs_file = !options.part.empty() ? "--part"
                           : options.merge       ? "--merge"
                           : options.resume      ? "--resume"
                           : options.ranks       ? "a sweep by several processes"
                                                 : "";
  if (*needs_file != '\0' && !has_folder(options)) {
    say(fmt::format("{} needs -o FILE: beside it is the folder of what is done", needs_file));
    return false;
  }
  if (options.merge && !options.part.empty()) {
    say("--part makes runs and --merge makes the table of them: give one of the two");
    return false;
  }
  if (options.json && options.out == "-") {
    say("--json and -o - both go to standard output: write the table to a file");
    return false;
  }
  return true;
}

std::string folder_of(const SweepOptions& options) {
  return options.out + ".sweep";
}

std::size_t threads_of(const SweepOptions& options) {
  const std::size_t usual = options.ranks ? 1 : std::max(1U, std::thread::hardware_concurrency());
  return options.threads > 0 ? options.threads : usual;
}

std::vector<std::uint64_t> all_chunks(const SweepIdentity& identity) {
  std::vector<std::uint64_t> chunks(static_cast<std::size_t>(identity.chunks()));
  std::iota(chunks.begin(), chunks.end(), std::uint64_t{0});
  return chunks;
}

/// A sweep on its way: made, and told.
class Study {
 public:
  Study(const SweepOptions& options, const PreparedSweep& sweep)
      : options_(options),
        sweep_(sweep),
        identity_(options.out.empty() ? SweepIdentity{.runs = sweep.runs(), .width = sweep.width()}
                                      : identity_of(sweep, version_of_program())),
        report_(sweep),
        indices_(sweep),
        pictures_(sweep) {}

  ExitCode go() {
    if (options_.ranks && !options_.ranks->agree(identity_.hash)) {
      say("the processes do not have the same sweep: each needs the same model, the same options and the same version "
          "of Continuo, and files in a folder that all machines share");
      return usage;
    }
    return !options_.ranks || options_.ranks->is_first() ? lead() : help();
  }

 private:
  /// Makes the sweep, and the table; with the help of the other ranks where there are some.
  ExitCode lead() {
    if (!has_folder(options_)) return without_folder();
    const bool is_new = !SweepFolder::exists(folder_of(options_));
    if (options_.merge && is_new) {
      say(fmt::format("there is no folder {}: make the runs first, in one go or by --part", folder_of(options_)));
      return usage;
    }
    if (const Status status = results::check_table(options_.out); !status) {
      say(status.message);
      return usage;
    }
    auto folder = SweepFolder::open(folder_of(options_), identity_);
    if (!folder) {
      say(describe(folder.status()));
      return usage;
    }
    if (options_.merge) return merge(*folder);
    return make(*folder);
  }

  /// Makes runs for the first rank, which says what there is to say.
  ExitCode help() {
    const auto chunks = options_.ranks->share(std::nullopt);
    if (!chunks) return done;
    const auto folder = SweepFolder::open(folder_of(options_), identity_);
    const Status status = options_.ranks->join(folder ? fill(*folder, *chunks) : folder.status());
    if (status || status.ending == Ending::interrupted || status.ending == Ending::cannot_continue) return done;
    say(describe(status));
    return usage;
  }

  Status fill(const SweepFolder& folder, std::vector<std::uint64_t> chunks) const {
    studies::SweepWork work = work_of(std::move(chunks));
    work.at_once = true;
    work.on_chunk = [&](std::uint64_t chunk, const Outcomes& outcomes) { return folder.write(chunk, outcomes); };
    if (options_.ranks) work.take = [ranks = options_.ranks] { return ranks->take(); };
    return run(work);
  }

  /// Rows go straight to where they are wanted, in the order of the runs.
  ExitCode without_folder() {
    std::optional<studies::SweepTable> table;
    if (!options_.out.empty()) table.emplace(options_.out, sweep_, identity_.hash);
    studies::SweepWork work = work_of(all_chunks(identity_));
    work.in_order = true;
    work.on_chunk = [&](std::uint64_t chunk, Outcomes outcomes) { return take(chunk, outcomes, table); };
    Status status = run(work);
    if (table && status) status = table->close();
    if (table && !status) (void)table->leave();
    return tell(status);
  }

  Status take(std::uint64_t chunk, const Outcomes& outcomes, std::optional<studies::SweepTable>& table) {
    const std::uint64_t first = identity_.first_run(chunk);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      report_.add(first + i, outcomes[i]);
      indices_.add(outcomes[i]);
      if (!options_.plot.empty()) pictures_.add(first + i, outcomes[i]);
      if (table) table->add(first + i, outcomes[i]);
    }
    return table ? table->status() : Status();
  }

  studies::SweepWork work_of(std::vector<std::uint64_t> chunks) const {
    return {.chunks = std::move(chunks), .threads = threads_of(options_), .interrupt = &interrupt_flag()};
  }

  Status run(studies::SweepWork& work) const {
    Progress progress;
    std::uint64_t runs = 0;
    for (const std::uint64_t chunk : work.chunks) runs += identity_.size(chunk);
    const auto ranks = static_cast<double>(options_.ranks ? options_.ranks->count() : 1);
    if (const auto show = progress.parts())
      work.progress = [show, all = static_cast<double>(runs) / ranks](std::uint64_t done_so_far) {
        show(std::min(1.0, static_cast<double>(done_so_far) / all));
      };
    return run_chunks(sweep_, identity_, work);
  }

  /// The chunks that are to be made; nothing after saying why none is.
  std::optional<std::vector<std::uint64_t>> chunks_to_make(const SweepFolder& folder) const {
    std::vector<std::uint64_t> wanted = all_chunks(identity_);
    if (!options_.part.empty()) {
      const auto part = read_part(options_.part);
      if (!part) {
        say(fmt::format("--part {}: write which of how many, as in --part 3/16", options_.part));
        return std::nullopt;
      }
      wanted = chunks_of_part(identity_, part->number, part->of);
    }
    std::size_t whole = 0, damaged = 0;
    std::erase_if(wanted, [&](std::uint64_t chunk) {
      const studies::ChunkState state = folder.state(chunk);
      whole += state == studies::ChunkState::whole ? 1 : 0;
      damaged += state == studies::ChunkState::damaged ? 1 : 0;
      return state == studies::ChunkState::whole;
    });
    if (!options_.resume && whole + damaged > 0) {
      say(fmt::format("{} has {} chunks of this sweep already: go on with --resume, or remove it", folder.path(),
                      whole + damaged));
      return std::nullopt;
    }
    if (damaged > 0)
      mention(
          fmt::format("{} of the chunks in {} are cut short or damaged, and are made again", damaged, folder.path()));
    return wanted;
  }

  ExitCode make(const SweepFolder& folder) {
    const auto chunks = chunks_to_make(folder);
    if (!chunks) return usage;
    if (options_.ranks) (void)options_.ranks->share(*chunks);
    Status status = fill(folder, *chunks);
    if (options_.ranks) status = options_.ranks->join(status);
    if (!status) return stopped(folder, status);
    if (options_.ranks) wait_for(folder, *chunks);
    if (options_.part.empty()) return merge(folder);
    mention(fmt::format("part {} is in {}; when all parts are there, --merge makes {}", options_.part, folder.path(),
                        options_.out));
    if (options_.json) answer_json(&folder);
    return done;
  }

  /// A machine may see late what others have written in a folder that they share: some file systems look half a minute
  /// old.
  static void wait_for(const SweepFolder& folder, const std::vector<std::uint64_t>& chunks) {
    constexpr int most_seconds = 90;
    const auto is_there = [&](std::uint64_t chunk) { return std::filesystem::exists(folder.file(chunk)); };
    for (int i = 0; i < most_seconds && !std::ranges::all_of(chunks, is_there); ++i)
      std::this_thread::sleep_for(std::chrono::seconds(1));
  }

  /// What was done is kept, and what it was is said.
  ExitCode stopped(const SweepFolder& folder, const Status& status) {
    const std::uint64_t whole = identity_.chunks() - folder.missing().size();
    const bool is_interrupted = status.ending == Ending::interrupted;
    if (!is_interrupted) say(describe(status));
    say(fmt::format("{} of {} chunks are in {}; the same command with --resume goes on", whole, identity_.chunks(),
                    folder.path()));
    if (options_.json && is_interrupted) answer_json(&folder);
    return is_interrupted ? interrupted : usage;
  }

  /// The table and the statistics of all chunks. The folder goes when the table is on the disk.
  ExitCode merge(const SweepFolder& folder) {
    if (const auto left = folder.missing(); !left.empty()) {
      say(fmt::format("{} of {} chunks are missing in {}, the first is that of run {}: make them with --resume",
                      left.size(), identity_.chunks(), folder.path(), identity_.first_run(left.front())));
      return usage;
    }
    std::optional<studies::SweepTable> table(std::in_place, options_.out, sweep_, identity_.hash);
    for (std::uint64_t chunk = 0; chunk < identity_.chunks(); ++chunk) {
      const auto outcomes = folder.read(chunk);
      const Status status = outcomes ? take(chunk, *outcomes, table) : outcomes.status();
      if (status) continue;
      say(describe(status));
      return usage;
    }
    const Status status = table->close();
    if (!status) {
      say(fmt::format("{}; the runs are in {}, and --merge makes the table of them", describe(status), folder.path()));
      return usage;
    }
    if (!written(folder.remove())) return usage;
    return tell({});
  }

  /// `folder`: of runs that are made, but not yet in a table with its statistics.
  void answer_json(const SweepFolder* folder = nullptr) const {
    nlohmann::ordered_json fields = report_.json();
    fields["indices"] = indices_.json();
    fields["table"] = nullptr;
    fields["folder"] = nullptr;
    if (folder) {
      const std::vector<std::uint64_t> left = folder->missing();
      fields["done"] =
          std::accumulate(left.begin(), left.end(), identity_.runs,
                          [&](std::uint64_t rest, std::uint64_t chunk) { return rest - identity_.size(chunk); });
      fields["folder"] = folder->path();
    } else if (!options_.out.empty()) {
      fields["table"] = options_.out;
    }
    answer("continuo.sweep/2", std::move(fields));
  }

  ExitCode tell(const Status& status) {
    if (options_.json) {
      answer_json();
    } else if (options_.out != "-") {
      print(fmt::format("{} runs, {}\n\n{}{}", report_.runs(), to_string(sweep_.plan().sampling), report_.text(),
                        indices_.text()));
    }
    if (const std::string failures = report_.failures_text(); !failures.empty()) say(failures);
    if (status.ending == Ending::interrupted) {
      say(fmt::format("interrupted after {} of {} runs; with -o FILE a sweep can be resumed", report_.runs(),
                      sweep_.runs()));
      return interrupted;
    }
    if (!written(status) || !draw() || lacks_fused_code(sweep_.model())) return usage;
    return report_.failed() > 0 ? numerical_failure : done;
  }

  /// False after saying why the picture could not be drawn.
  bool draw() const {
    if (options_.plot.empty()) return true;
    std::vector<results::Panel> panels = indices_.panels();
    if (panels.empty()) panels = pictures_.panels(report_);
    const auto title = fmt::format("{}, {} runs", sweep_.model().name, report_.runs());
    return written(
        results::draw({.title = title, .panels = std::move(panels), .is_dark = options_.dark}, options_.plot));
  }

  const SweepOptions& options_;
  const PreparedSweep& sweep_;
  SweepIdentity identity_;  // without a hash where nothing is written
  SweepReport report_;
  SweepIndices indices_;
  SweepPictures pictures_;
};

ExitCode sweep(SweepOptions options) {
  options.experiment.sweep.is_wanted = true;
  if (!fit_together(options) || !drawable(options.plot)) return usage;
  const Prepared prepared = prepare(options.experiment, Worlds::welcome);
  if (prepared.exit != done) return prepared.exit;
  const model::Model& model = prepared.program->model;
  if (!model.sweep || model.sweep->axes.empty()) {
    say("nothing says what is varied: write sweep { k from 1 to 10 count 50 } in the model, or give --vary \"k from 1 "
        "to 10 count 50\"");
    return usage;
  }
  std::vector<model::Diagnostic> problems;
  if (!runs::plan(model, prepared.experiment, problems)) {
    show(problems, prepared.loaded.source);
    return wrong_model;
  }
  auto made = PreparedSweep::create(model, prepared.experiment);
  if (!made) {
    say(describe(made.status()));
    return wrong_model;
  }
  if (const auto* design = made->design()) {
    if (const std::string advice = design->advice(model.sweep->runs); !advice.empty()) mention(advice);
  }
  return Study(options, *made).go();
}

}  // namespace

void add_sweep(CLI::App& app, ExitCode& exit, SweepRanks* ranks) {
  static constexpr std::string_view examples =
      "  continuo sweep spring.sim -o spring.nc                      as the model's sweep says; opens in xarray\n"
      "  continuo sweep spring.sim --vary \"k from 1 to 10 [N/m] count 50\" --keep \"max(abs(x)) as peak\"\n"
      "  continuo sweep spring.sim --runs \"10000 indices\" --plot bars.svg     what causes the spread\n"
      "  continuo sweep spring.sim --vary \"c normal(0.5, 0.1)\" --runs \"10000 sobol seed 7\" --json\n"
      "  continuo sweep spring.sim -o spring.nc --resume             goes on with one that was interrupted\n"
      "  continuo sweep spring.sim -o spring.nc --part 3/16          one of sixteen jobs; at last\n"
      "  continuo sweep spring.sim -o spring.nc --merge              makes the table of all parts\n"
      "  continuo run spring.sim --sweep-run 4711                    one of the runs alone, to the same bits\n";
  Verb* verb = add_verb(app, listed("sweep"), examples, {wrong_model, numerical_failure, interrupted});
  verb->json_examples = {
      "continuo sweep models/mass_spring_damper.sim --vary \"k from 1 to 4 count 3\" --keep \"max(x)\" --json"};
  auto options = std::make_shared<SweepOptions>();
  options->ranks = ranks;
  add_experiment(*verb, options->experiment);
  add_method(*verb, options->experiment);
  add_limits(*verb, options->experiment);
  add_initial(*verb, options->experiment);
  add_sweep_words(*verb, options->experiment.sweep, true);
  writes_table(*verb,
               verb->add_option("-o,--out", options->out,
                                "Writes a row for each run, as .csv, .tsv, .json, .nc (netCDF) or .mat (MATLAB); "
                                "- for standard output"));
  writes_file(*verb, verb->add_option("--plot", options->plot,
                                      "Writes a picture, .svg or .png: quantiles over time, a plane of two "
                                      "parameters, outcomes over parameters, or bars of indices"));
  verb->add_flag("--dark", options->dark, "Draws it on a dark background");
  verb->add_flag("--resume", options->resume, "Goes on with a sweep that was interrupted: makes what is missing");
  verb->add_option("--part", options->part, "Makes one part of the runs, for jobs on several machines: 3/16")
      ->type_name("K/N");
  verb->add_flag("--merge", options->merge, "Makes the table and the statistics of all parts");
  verb->add_option("--threads", options->threads, "How many threads make runs (default: one for each core)")
      ->check(count_from(1, 4096))
      ->type_name("N");
  verb->add_flag("--json", options->json, "The statistics as one JSON object");
  verb->callback([&exit, options] { exit = sweep(*options); });
}

}  // namespace continuo::app
