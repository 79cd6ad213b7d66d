// apps/continuo/terminal/exit_codes.hpp
#pragma once
#include <string_view>

namespace continuo::app {

/// What the command tells the shell.
enum ExitCode : int {
  done = 0,
  usage = 1,  // wrong verb, option or file
  wrong_model = 2,
  numerical_failure = 3,
  check_failed = 4,
  interrupted = 130,  // 128 + SIGINT; what was computed is kept
};

/// The meaning as a sentence, for the reference.
constexpr std::string_view meaning(ExitCode code) {
  switch (code) {
    case done:
      return "The verb did its work.";
    case usage:
      return "An option, a name or a file of the command line is wrong, or a file cannot be read or written; standard "
             "error names it.";
    case wrong_model:
      return "The model contains an error, or this verb does not apply to it; standard error explains it.";
    case numerical_failure:
      return "The computation failed, or ended early; standard error names the reason.";
    case check_failed:
      return "The computation succeeded, and a check does not hold.";
    case interrupted:
      return "Ctrl-C ended the verb; the results up to then are printed or written.";
  }
  return "";
}

}  // namespace continuo::app
