// apps/continuo/options/command_line.hpp
// What CLI11 leaves to us: help that begins with examples, and "did you mean".
#pragma once
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <apps/continuo/options/file_options.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

namespace continuo::app {

/// Why a verb does not begin: a file of its command line would be written over another one.
struct FileFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A verb, with its files, and the facts that only its page in the reference states.
class Verb : public CLI::App {
 public:
  Verb(CLI::App& app, std::string name, std::string description);

  /// What the verb does once its words are read and its files in order; else there is a FileFault.
  void callback(std::function<void()> act);

  std::vector<FileOption> files;  // declared by reads_file, writes_file and their like
  std::string examples;
  std::vector<ExitCode> failures;          // its exit codes besides `done` and `usage`
  std::vector<std::string> json_examples;  // commands on models of the gallery: their output shows the layout of --json
};

/// A verb whose help begins with `examples` (lines of `continuo VERB ...`). `failures`: its exit codes besides `done`
/// and `usage`, which all verbs have.
Verb* add_verb(CLI::App& app, const ListedVerb& listed, std::string_view examples, std::vector<ExitCode> failures);

/// Help of every verb begins with its examples.
void examples_first(CLI::App& app, std::string_view examples);

/// For options that take a number: 1/60 is one, as in a model.
CLI::Validator quotients();

/// For options that count: a whole number from `least` to `most`. CLI11 itself takes -3 for a very large one.
CLI::Validator count_from(std::size_t least, std::size_t most = 1'000'000);

/// For options that take a number: neither infinite nor none, and not below `least`, or above it.
CLI::Validator finite_number();
CLI::Validator number_from(double least);
CLI::Validator number_above(double least);
/// From `least` to less than `below`.
CLI::Validator number_between(double least, double below);
/// A text that is empty, as an unset variable of a shell leaves it, is no value of any option.
void refuse_empty(CLI::App& verb);

/// The message for a word that names no verb, with the nearest name.
std::string no_such_verb(const CLI::App& app, std::string_view word);

/// What to say of words that no verb or option takes.
std::string unexpected(const CLI::App& app, int argc, char** argv);

}  // namespace continuo::app
