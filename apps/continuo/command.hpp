// The command line of both programs of the command.
#pragma once
#include <functional>
#include <span>
#include <string_view>

#include <CLI/App.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

namespace continuo::app {

/// A verb that a program has, with the function that adds it to the command line.
struct OwnVerb {
  std::string_view name;
  std::function<void(CLI::App&, ExitCode&)> add;
};

/// Parses the words and runs their verb, one of `verbs`; returns the exit code of the process. Help and advice list all
/// verbs of the command, whichever program has them.
int run_command(int argc, char** argv, std::span<const OwnVerb> verbs);

}  // namespace continuo::app
