#include <array>
#include <cstdio>
#include <stdexcept>

#include <sys/wait.h>
#include <tests/docs/process.hpp>

namespace continuo::docs {

Finished run_in(const std::filesystem::path& folder, const std::string& command) {
  std::filesystem::create_directories(folder);
  // `2>&1` inside the group, so that both streams arrive in the order they were written.
  const std::string line = "cd '" + folder.string() +
                           "' && export NO_COLOR=1 PYTHONDONTWRITEBYTECODE=1 PYTHONPATH='" CONTINUO_PYTHON_MODULE
                           "' CONTINUO_COMMAND='" CONTINUO_COMMAND "' && continuo() { '" CONTINUO_COMMAND
                           "' \"$@\"; }; python3() { '" +
                           CONTINUO_PYTHON + "' \"$@\"; }; { " + command + "\n} 2>&1";
  std::FILE* pipe = ::popen(line.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("no shell to run: " + command);
  Finished finished{0, ""};
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    finished.printed.append(buffer.data(), count);
  }
  const int status = ::pclose(pipe);
  finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return finished;
}

std::filesystem::path fresh_folder(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(CONTINUO_DOCS_SCRATCH) / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::filesystem::path root = CONTINUO_SOURCE_DIR;
  std::filesystem::create_directory_symlink(root / "models", folder / "models");
  std::filesystem::create_directory_symlink(root / "docs", folder / "docs");
  return folder;
}

}  // namespace continuo::docs
