// Files that belong to the command: the second program and the shared libraries that it loads.
#pragma once
#include <filesystem>
#include <string>

namespace continuo::app {

struct Part {
  std::filesystem::path file;
  std::string problem{};  // "there is neither ... nor ...": the places where it was looked for
};

/// Beside this program, where it was built, or in the folder of libraries that the command was installed with. Links to
/// the program are followed.
Part find_part(const std::string& name);

}  // namespace continuo::app
