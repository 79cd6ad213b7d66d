// Writes the options, exit codes and examples of a verb as Markdown.
#include <algorithm>
#include <span>
#include <vector>

#include <apps/continuo/options/verb_facts.hpp>
#include <apps/continuo/options/verb_page.hpp>
#include <fmt/format.h>

namespace continuo::app {
namespace {

/// One cell of a table: a vertical bar would end it.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string code(std::string_view text) {
  return text.empty() ? "" : fmt::format("`{}`", cell(text));
}

/// Sentences with `<` in them are no tags.
std::string prose(std::string_view text) {
  std::string escaped;
  for (const char c : cell(text)) {
    if (c == '*' || c == '_' || c == '<' || c == '`' || c == '[') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string codes(std::vector<std::string> names) {
  for (std::string& name : names) name = code(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string row_of(const OptionFacts& option) {
  std::string text = prose(option.meaning) + ".";
  if (option.required) text += " Required.";
  if (option.repeated) text += " May be repeated.";
  if (!option.needs.empty()) text += fmt::format(" Needs {}.", codes(option.needs));
  if (!option.excludes.empty()) text += fmt::format(" Not together with {}.", codes(option.excludes));
  return fmt::format("| {} | {} | {} |\n", codes(option.names), code(option.value), text);
}

std::string table_of(const std::vector<OptionFacts>& options) {
  std::string text = "| Name | Value | Meaning |\n|---|---|---|\n";
  for (const OptionFacts& option : options) text += row_of(option);
  std::string kinds;
  std::vector<std::string> explained;
  for (const OptionFacts& option : options) {
    const std::string_view meaning = meaning_of_value(option.value);
    if (meaning.empty() || std::ranges::find(explained, option.value) != explained.end()) continue;
    explained.push_back(option.value);
    kinds += fmt::format("- {}: {}\n", code(option.value), meaning);
  }
  return kinds.empty() ? text : text + "\n" + kinds;
}

std::string table_of(std::span<const ExitCode> exit_codes) {
  std::string text = "| Code | Meaning |\n|---|---|\n";
  for (const ExitCode exit : exit_codes) text += fmt::format("| {} | {} |\n", static_cast<int>(exit), meaning(exit));
  return text;
}

}  // namespace

const Verb* find_verb(const CLI::App& app, std::string_view name) {
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    if (verb->get_name() == name) return dynamic_cast<const Verb*>(verb);
  return nullptr;
}

std::string verbs_page(const CLI::App& app) {
  std::string text =
      fmt::format("# The command continuo\n\n{}\n\n| Verb | Purpose |\n|---|---|\n", app.get_description());
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    text += fmt::format("| [continuo {0}](verb_{0}.md) | {1} |\n", verb->get_name(), prose(verb->get_description()));
  return text + fmt::format("\nData go to standard output, messages to standard error.\n\n## Exit codes\n\n{}",
                            table_of(all_exit_codes()));
}

std::string verb_page(const Verb& verb) {
  const VerbFacts facts = facts_of(verb);
  std::string text = fmt::format("# continuo {}\n\n{}.\n\n```text\n{}\n```\n\n## Examples\n\n```text\n{}```\n",
                                 facts.name, prose(facts.purpose), facts.synopsis, facts.examples);
  if (!facts.arguments.empty()) text += "\n## Arguments\n\n" + table_of(facts.arguments);
  text += "\n## Options\n\n" + table_of(facts.options) + "\n## Exit codes\n\n" + table_of(facts.exit_codes);
  if (!verb.json_examples.empty()) text += "\n## Layout of --json\n";
  for (const std::string& example : verb.json_examples) text += fmt::format("\n<!-- json: {} -->\n", example);
  return text;
}

}  // namespace continuo::app
