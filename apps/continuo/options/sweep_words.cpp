// Writes the block anew behind the text of the model, with the old one blanked out, so that the language checks all of
// it, and brings its messages back to where the words come from.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include <apps/continuo/options/sweep_words.hpp>
#include <apps/continuo/terminal/own_process.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/language/syntax/parser.hpp>

namespace continuo::app {
namespace {

namespace ast = model::ast;

constexpr std::string_view block_begin = "sweep {\n";

enum class Sort { axis, runs, keep };

Sort sort_of(const ast::SweepItem& item) {
  if (std::holds_alternative<ast::SweepAxis>(item.node)) return Sort::axis;
  return std::holds_alternative<ast::SweepRuns>(item.node) ? Sort::runs : Sort::keep;
}

/// What the language writes before the words of an option.
std::string_view words_before(Sort sort) {
  return sort == Sort::axis ? "" : sort == Sort::runs ? "runs " : "keep ";
}
std::string_view option_of(Sort sort) {
  return sort == Sort::axis ? "--vary" : sort == Sort::runs ? "--runs" : "--keep";
}

/// A line of the block, and where it comes from: an option, or a place in the model.
struct Line {
  Sort sort;
  std::string text;     // without the prefix where it is of an option
  std::string subject;  // of an axis: what is varied
  bool is_option = false;
  std::uint32_t place = 0;  // in the model
};

std::string subject_of(const ast::SweepItem& item, const model::Source& source) {
  const auto* axis = std::get_if<ast::SweepAxis>(&item.node);
  std::string text = axis ? std::string(source.slice(axis->subject.span)) : std::string();
  std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
  return text;
}

/// Moves a message to a text in which its words begin elsewhere.
model::Diagnostic moved(model::Diagnostic message, std::uint32_t begin, std::uint32_t place, std::size_t size) {
  const auto move = [&](model::Span& span) {
    span.begin = std::max(span.begin, begin) - begin + place;
    span.end = std::max(span.end, begin) - begin + place;
    span.begin = std::min(span.begin, static_cast<std::uint32_t>(size));
    span.end = std::clamp(span.end, span.begin, static_cast<std::uint32_t>(size));
  };
  move(message.span);
  message.related.clear();
  return message;
}

/// The words of one option as an item of a sweep; nothing after saying what is wrong.
std::optional<Line> read_line(Sort sort, const std::string& text) {
  const model::Source block("sweep", fmt::format("{}{}{}\n}}\n", block_begin, words_before(sort), text));
  model::ParseResult parsed = model::parse(block);
  const auto begin = static_cast<std::uint32_t>(block_begin.size() + words_before(sort).size());
  std::vector<model::Diagnostic> problems;
  for (model::Diagnostic& problem : parsed.diagnostics)
    problems.push_back(moved(std::move(problem), begin, 0, text.size()));
  if (!problems.empty()) {
    show(problems, model::Source(std::string(option_of(sort)), text));
    return std::nullopt;
  }
  const auto& statements = parsed.model.statements;
  const auto* sweep = statements.size() == 1 ? std::get_if<ast::Sweep>(&statements.front().node) : nullptr;
  if (!sweep || sweep->items.size() != 1 || sort_of(sweep->items.front()) != sort) {
    say(fmt::format("{} \"{}\": one {} is expected, in the words of the language", option_of(sort), text,
                    sort == Sort::axis   ? "name and its values"
                    : sort == Sort::runs ? "number of runs"
                                         : "list of what is kept"));
    return std::nullopt;
  }
  return Line{.sort = sort, .text = text, .subject = subject_of(sweep->items.front(), block), .is_option = true};
}

std::optional<std::vector<Line>> read_lines(const SweepWords& words) {
  std::vector<Line> lines;
  bool fine = true;
  const auto add = [&](Sort sort, const std::string& text) {
    auto line = read_line(sort, text);
    fine = fine && line;
    if (line) lines.push_back(*std::move(line));
  };
  for (const std::string& text : words.vary) add(Sort::axis, text);
  if (!words.runs.empty() && words.runs != "all") add(Sort::runs, words.runs);
  for (const std::string& text : words.keep) add(Sort::keep, text);
  return fine ? std::optional(std::move(lines)) : std::nullopt;
}

/// Whether the command line has something in place of this item of the model.
bool is_replaced(const ast::SweepItem& item, const model::Source& source, const SweepWords& words,
                 const std::vector<Line>& lines) {
  switch (sort_of(item)) {
    case Sort::runs:
      return !words.runs.empty();
    case Sort::keep:
      return !words.keep.empty();
    case Sort::axis:
      break;
  }
  return std::ranges::any_of(lines, [&](const Line& line) { return line.subject == subject_of(item, source); });
}

/// The text of the model with another block, and where its lines begin.
struct Rewritten {
  std::string text;
  std::vector<Line> lines;
  std::vector<std::size_t> begins;  // of the words of each line
};

Rewritten rewritten(const model::Source& source, const ast::Model& tree, const SweepWords& words,
                    std::vector<Line> given) {
  Rewritten made{source.text(), {}, {}};
  for (const ast::Statement& statement : tree.statements) {
    const auto* sweep = std::get_if<ast::Sweep>(&statement.node);
    if (!sweep) continue;
    for (const ast::SweepItem& item : sweep->items) {
      if (is_replaced(item, source, words, given)) continue;
      made.lines.push_back({.sort = sort_of(item),
                            .text = std::string(source.slice(item.span)),
                            .subject = {},
                            .place = item.span.begin});
    }
    for (std::uint32_t i = statement.span.begin; i < statement.span.end; ++i)
      if (made.text[i] != '\n') made.text[i] = ' ';
  }
  std::ranges::move(given, std::back_inserter(made.lines));
  made.text += '\n';
  made.text += block_begin;
  for (const Line& line : made.lines) {
    if (line.is_option) made.text += words_before(line.sort);
    made.begins.push_back(made.text.size());
    made.text += line.text + '\n';
  }
  made.text += "}\n";
  return made;
}

/// Shows each message under the option that it is about, or at its place in the model. Gives those of the model.
std::vector<model::Diagnostic> show_moved(const std::vector<model::Diagnostic>& diagnostics, const Rewritten& made,
                                          const model::Source& original) {
  std::vector<model::Diagnostic> of_model;
  for (const model::Diagnostic& diagnostic : diagnostics) {
    const auto behind = std::ranges::upper_bound(made.begins, diagnostic.span.begin);
    if (behind == made.begins.begin()) {
      of_model.push_back(moved(diagnostic, 0, 0, original.text().size()));
      continue;
    }
    const auto i = static_cast<std::size_t>(behind - made.begins.begin()) - 1;
    const Line& line = made.lines[i];
    const auto begin = static_cast<std::uint32_t>(made.begins[i]);
    if (line.is_option) {
      model::Diagnostic message = moved(diagnostic, begin, 0, line.text.size());
      // Nothing can be declared here.
      if (message.code == "E210" && message.help.starts_with("declare"))
        message.help = fmt::format("`continuo info {}` lists what there is", original.name());
      show({&message, 1}, model::Source(std::string(option_of(line.sort)), line.text));
    } else {
      of_model.push_back(moved(diagnostic, begin, line.place, original.text().size()));
    }
  }
  show(of_model, original);
  return of_model;
}

}  // namespace

void add_sweep_words(CLI::App& verb, SweepWords& words, bool with_keep) {
  const auto list = [&verb](const char* name, std::vector<std::string>& texts, const char* help) {
    verb.add_option(name, texts, help)->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  list("--vary", words.vary,
       "What a sweep varies, besides what the model says: \"k from 1 to 10 count 50\", \"x(0) in (1, 2)\", \"c "
       "normal(0.5, 0.1)\", \"c from \\\"samples.csv\\\"\"");
  verb.add_option("--runs", words.runs, "How many runs: \"10000 sobol seed 7\"; all: every combination of the values")
      ->type_name("RUNS");
  if (with_keep)
    list("--keep", words.keep,
         "What is kept of each run, in place of what the model says: \"x at end, max(x) as peak\"");
}

model::Loaded load_with_sweep(const std::string& path, const SweepWords& words) {
  std::optional<model::Source> read =
      path == standard_input ? model::Source(name_of_file(path), contents_of(path)) : model::read_source(path);
  if (!read) return load_model(path);  // which says why
  const model::Source original = *std::move(read);
  const model::ParseResult parsed = model::parse(original);
  if (has_errors(parsed.diagnostics)) return load_model(original);  // which says what is wrong
  auto lines = read_lines(words);
  if (!lines) return {original, std::nullopt, {}};
  const Rewritten made = rewritten(original, parsed.model, words, *std::move(lines));
  model::Loaded loaded = model::load(model::Source(original.name(), made.text));
  loaded.diagnostics = show_moved(loaded.diagnostics, made, original);
  return loaded;
}

}  // namespace continuo::app
