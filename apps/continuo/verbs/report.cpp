// continuo report FILE: a run and studies of a model on one page.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/own_process.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/language/describe.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/report.hpp>

namespace continuo::app {
namespace {

struct ReportOptions {
  std::string file, out;
  std::vector<std::string> studies;
  bool json = false;
};

std::string quoted(const std::string& word) {
  return word.find_first_of(" ;'\"[]()*") == std::string::npos ? word : "\"" + word + "\"";
}

/// Whether a study writes a file of its own, which the report cannot hold against its own and those of other studies;
/// says so.
bool writes_files(const std::vector<std::string>& studies) {
  for (const std::string& line : studies) {
    for (const std::string& word : words_of(line)) {
      const std::string name = word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
      if (std::ranges::find(options_that_write, name) == options_that_write.end()) continue;
      say(fmt::format(
          "--with \"{}\": a study of a report writes no files, its text and picture are on the page; leave out "
          "{}, or call it by itself",
          line, name));
      return true;
    }
  }
  return false;
}

/// What a verb says of the model, with its picture. A verb that takes no --plot is asked again without.
results::ReportSection section_of(std::string title, std::vector<std::string> words, const ScratchFolder& scratch,
                                  const std::string& input, int& exit) {
  results::ReportSection section{.title = std::move(title)};
  for (const std::string& word : words) section.command += (section.command.empty() ? "continuo " : " ") + quoted(word);
  const std::string picture = scratch.file("picture.svg");
  std::vector<std::string> with_plot = words;
  with_plot.insert(with_plot.end(), {"--plot", picture});
  Printed printed = call_self(with_plot, input);
  if (printed.exit == usage) printed = call_self(words, input);
  section.text = printed.out;
  section.messages = printed.err;
  section.svg = contents_of(picture);
  std::filesystem::remove(picture);
  exit = printed.exit;
  return section;
}

ExitCode report(const ReportOptions& options) {
  interrupt_flag();  // handled from here on: what runs is told to end
  if (!readable(options.file) || writes_files(options.studies)) return usage;
  const model::Loaded loaded = load_model(options.file);
  if (!loaded) return wrong_model;
  const model::Model& model = *loaded.model;
  const ScratchFolder scratch;
  std::string input = "/dev/null";
  if (options.file == standard_input) {  // which has been read: the verbs read a copy
    input = scratch.file("model");
    if (!written(results::write_file(input, model.text.content))) return usage;
  }
  std::vector<results::ReportSection> sections;
  auto parts = nlohmann::ordered_json::array();
  sections.push_back({.title = "Model", .text = model.text.content});
  sections.push_back({.title = "What Continuo made of it", .text = model::describe(model)});
  int exit = 0;
  const std::string manifest = scratch.file("manifest.json");
  sections.push_back(section_of("Run", {"run", options.file, "--manifest", manifest}, scratch, input, exit));
  sections.back().command = "continuo run " + quoted(options.file);
  parts.push_back({{"command", sections.back().command}, {"exit", exit}});
  ExitCode worst = exit == done ? done : exit == interrupted ? interrupted : numerical_failure;
  for (const std::string& line : options.studies) {
    if (interrupt_flag() || worst == interrupted) break;
    std::vector<std::string> words = words_of(line);
    if (words.empty()) continue;
    if (words.front() == "stability") {  // whose first word are methods
      words.insert(words.end(), {"--model", options.file});
    } else {
      words.insert(words.begin() + 1, options.file);
    }
    sections.push_back(section_of(line, words, scratch, input, exit));
    parts.push_back({{"command", sections.back().command}, {"exit", exit}});
    if (exit == usage) {
      say(fmt::format("`{}` was refused:\n{}", line, sections.back().messages));
      return usage;
    }
    if (exit != done) worst = exit == interrupted ? interrupted : numerical_failure;
  }
  if (const std::string text = contents_of(manifest); !text.empty())
    sections.push_back({.title = "Manifest", .text = text, .folded = true});
  if (!written(results::write_file(options.out, results::report_page(model.name, model.heading, sections))))
    return usage;
  if (options.json) answer("continuo.report/1", {{"file", options.out}, {"model", model.name}, {"sections", parts}});
  return worst;  // the page is there all the same, and says what failed
}

}  // namespace

void add_report(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo report models/bouncing_ball.sim -o ball.html\n"
      "  continuo report models/lorenz.sim --with steady --with \"steady --along rho=0..30\" -o lorenz.html\n"
      "  continuo report models/pendulum.sim --with \"phase --box theta=-7..7\" --with linearize -o pendulum.html\n";
  Verb* verb = add_verb(app, listed("report"), examples, {wrong_model, numerical_failure, interrupted});
  verb->json_examples = {"continuo report models/bouncing_ball.sim -o ball.html --json"};
  auto options = std::make_shared<ReportOptions>();
  reads_file(*verb, verb->add_option("file", options->file, "The model (- for standard input)")->required(),
             files_of_model);
  verb->add_option("--with", options->studies,
                   "A study: another verb with its options, without the file; may be repeated")
      ->type_name("\"VERB ...\"")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  writes_file(*verb, verb->add_option("-o,--out", options->out, "The page, .html")->required(), {".html"});
  verb->add_flag("--json", options->json, "The file that was written, and how each part ended, as one JSON object");
  verb->callback([&exit, options] { exit = report(*options); });
}

}  // namespace continuo::app
