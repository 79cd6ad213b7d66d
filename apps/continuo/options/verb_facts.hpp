// What the declarations of a verb say, as plain values: its page, its manual and its JSON are written from them.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <nlohmann/json_fwd.hpp>

namespace continuo::app {

/// An option, or an argument without a dash.
struct OptionFacts {
  std::vector<std::string> names;  // "-o", "--out"; of an argument the one without dashes
  std::string value;               // "FILE"; empty for a flag
  std::string meaning;             // a sentence without its full stop
  bool required = false, repeated = false;
  std::vector<std::string> needs, excludes;  // other options
};

struct VerbFacts {
  std::string name, purpose, synopsis, examples;
  std::vector<OptionFacts> arguments, options;
  std::vector<ExitCode> exit_codes;
};
VerbFacts facts_of(const Verb& verb);

/// All exit codes of the command.
std::vector<ExitCode> all_exit_codes();

/// What the word for a value means, "a whole number" for N; empty where it needs no explanation.
std::string_view meaning_of_value(std::string_view word);

/// The fields of `continuo help VERB --json`, and of `continuo help --json`.
nlohmann::ordered_json verb_json(const VerbFacts& facts);
nlohmann::ordered_json verbs_json(const CLI::App& app);

}  // namespace continuo::app
