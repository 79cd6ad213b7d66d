// apps/continuo/terminal/own_process.cpp
// Calls the command itself in a process of its own, and reads what it prints.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <thread>
#include <utility>

#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/own_process.hpp>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX wants it declared by its user

namespace continuo::app {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "continuo-report-XXXXXX").string();
  if (mkdtemp(name.data()) != nullptr) folder_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (exists()) std::filesystem::remove_all(folder_, ignored);
}

std::string contents_of(const std::string& path) {
  if (path == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Printed call_self(const std::vector<std::string>& arguments, const std::string& input) {
  const ScratchFolder scratch;
  if (!scratch.exists()) return {};
  std::vector<std::string> words{"continuo"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const std::string out = scratch.file("out"), err = scratch.file("err");
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, input.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t process = 0;
  const int problem = posix_spawn(&process, "/proc/self/exe", &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) return {};
  int status = -1;
  bool is_told = false;
  constexpr auto moment = std::chrono::milliseconds(10);
  while (waitpid(process, &status, WNOHANG) == 0) {
    if (interrupt_flag().load() && !std::exchange(is_told, true)) ::kill(process, SIGTERM);
    std::this_thread::sleep_for(moment);
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents_of(out), contents_of(err)};
}

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  bool inside = false;
  char quote = 0;
  for (const char c : line) {
    if (quote == 0 && (c == ' ' || c == '\t')) {
      inside = false;
      continue;
    }
    if (!inside) words.emplace_back();
    inside = true;
    if (quote == 0 && c == '"') {
      quote = c;
    } else if (quote != 0 && c == quote) {
      quote = 0;
    } else {
      words.back() += c;
    }
  }
  return words;
}

}  // namespace continuo::app
