// apps/continuo/terminal/exit_codes.hpp
#pragma once

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

}  // namespace continuo::app
