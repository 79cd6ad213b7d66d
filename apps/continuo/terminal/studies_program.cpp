// Starts the second program of the command in the place of this one.
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include <apps/continuo/terminal/parts.hpp>
#include <apps/continuo/terminal/studies_program.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <unistd.h>

namespace continuo::app {

void become_studies_program(char** words) {
  std::string program;
  if (const char* named = std::getenv("CONTINUO_STUDIES"); named != nullptr) program = named;
  if (program.empty()) {
    const Part part = find_part("continuo-studies");
    if (!part.problem.empty()) {
      say(fmt::format(
          "the part of the command for studies is missing: {}; build it with `cmake --build FOLDER --target "
          "continuo-studies`, or call ./continuo.sh, which does so",
          part.problem));
      return;
    }
    program = part.file.string();
  }
  execv(program.c_str(), words);
  say(fmt::format("cannot start a part of the command, {}: {}", program, std::strerror(errno)));
}

}  // namespace continuo::app
