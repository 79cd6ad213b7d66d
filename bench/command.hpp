// bench/command.hpp
// The command line of the comparisons: PROGRAM [FOLDER [SECONDS [PROBLEM...]]].
#pragma once
#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace continuo::bench {

struct Command {
  std::string folder = ".";             // where tables and plots go
  double seconds = 15;                  // for which each problem is timed
  std::vector<std::string> problems{};  // empty: all

  bool wants(std::string_view problem) const {
    return problems.empty() || std::find(problems.begin(), problems.end(), problem) != problems.end();
  }
};

inline Command read_command(int count, char** arguments) {
  Command command;
  if (count > 1) command.folder = arguments[1];
  if (count > 2) command.seconds = std::atof(arguments[2]);
  command.problems.assign(arguments + std::min(count, 3), arguments + count);
  return command;
}

}  // namespace continuo::bench
