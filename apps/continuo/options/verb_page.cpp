// Writes the options, exit codes and examples of a verb as Markdown.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <apps/continuo/options/verb_page.hpp>
#include <fmt/format.h>

namespace continuo::app {
namespace {

struct ValueKind {
  std::string_view name, meaning;
};

/// The words for values in the tables of options.
constexpr std::array value_kinds{
    ValueKind{"T", "a time, in the unit of the model's times"},
    ValueKind{"DT", "a duration, in the unit of the model's times; a quotient such as 1/60 is possible"},
    ValueKind{"H", "a step size, in the unit of the model's times; a quotient such as 1/60 is possible"},
    ValueKind{"N", "a whole number"},
    ValueKind{"FILE", "the path of a file"},
    ValueKind{"RTOL", "a relative tolerance, without unit"},
    ValueKind{"[NAME=]RTOL", "a relative tolerance, without unit, for all states or for the state named"},
    ValueKind{"[NAME=]ATOL", "an absolute tolerance, in the unit of the state, for all states or for the state named"},
    ValueKind{"NAME=LOW..HIGH", "a name of the model and a range, in the unit of that quantity"},
};

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

std::string names_of(const CLI::Option& option) {
  if (option.get_positional()) return code(option.get_name(true));
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back(code("-" + name));
  for (const std::string& name : option.get_lnames()) names.push_back(code("--" + name));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Sorted: CLI11 orders them by their addresses.
std::string listed(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(names_of(*option));
  std::ranges::sort(names);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool is_repeated(const CLI::Option& option) {
  return option.get_expected_max() == CLI::detail::expected_max_vector_size ||
         option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
}

std::string row_of(const CLI::Option& option) {
  std::string text = prose(option.get_description()) + ".";
  if (option.get_required()) text += " Required.";
  if (is_repeated(option)) text += " May be repeated.";
  if (!option.get_needs().empty()) text += fmt::format(" Needs {}.", listed(option.get_needs()));
  if (!option.get_excludes().empty()) text += fmt::format(" Not together with {}.", listed(option.get_excludes()));
  return fmt::format("| {} | {} | {} |\n", names_of(option), code(option.get_type_name()), text);
}

std::vector<const CLI::Option*> options_of(const Verb& verb, bool positional) {
  return verb.get_options([positional](const CLI::Option* option) {
    return option->get_positional() == positional && !option->get_group().empty();
  });
}

std::string table_of(const std::vector<const CLI::Option*>& options) {
  std::string text = "| Name | Value | Meaning |\n|---|---|---|\n";
  for (const CLI::Option* option : options) text += row_of(*option);
  std::string kinds;
  for (const ValueKind& kind : value_kinds)
    if (std::ranges::any_of(options, [&](const CLI::Option* option) { return option->get_type_name() == kind.name; }))
      kinds += fmt::format("- {}: {}\n", code(kind.name), kind.meaning);
  return kinds.empty() ? text : text + "\n" + kinds;
}

std::string synopsis_of(const Verb& verb) {
  std::string text = "continuo " + verb.get_name();
  for (const CLI::Option* option : options_of(verb, true)) {
    const std::string name = option->get_name(true) + (is_repeated(*option) ? "..." : "");
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  return text + " [OPTIONS]";
}

std::string exit_codes(const std::vector<ExitCode>& codes) {
  std::string text = "| Code | Meaning |\n|---|---|\n";
  for (const ExitCode code : codes) text += fmt::format("| {} | {} |\n", static_cast<int>(code), meaning(code));
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
                            exit_codes({done, usage, wrong_model, numerical_failure, check_failed, interrupted}));
}

std::string verb_page(const Verb& verb) {
  std::string text = fmt::format("# continuo {}\n\n{}.\n\n```text\n{}\n```\n\n## Examples\n\n```text\n{}```\n",
                                 verb.get_name(), prose(verb.get_description()), synopsis_of(verb), verb.examples);
  const auto arguments = options_of(verb, true), options = options_of(verb, false);
  if (!arguments.empty()) text += "\n## Arguments\n\n" + table_of(arguments);
  text += "\n## Options\n\n" + table_of(options);
  std::vector<ExitCode> codes{done, usage};
  codes.insert(codes.end(), verb.failures.begin(), verb.failures.end());
  text += "\n## Exit codes\n\n" + exit_codes(codes);
  if (!verb.json_examples.empty()) text += "\n## Layout of --json\n";
  for (const std::string& example : verb.json_examples) text += fmt::format("\n<!-- json: {} -->\n", example);
  return text;
}

}  // namespace continuo::app
