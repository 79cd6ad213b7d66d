// Finds the C compiler and runs it as a process of its own, which a request to stop ends.
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include <continuo/symbolic/native/c_compiler.hpp>

namespace continuo::model {

namespace fs = std::filesystem;

namespace {

// Products and sums are not contracted, errno is not set, and powers are those of the library: the same bits as a tape.
// Statements that are alike are not joined to vectors: gcc 12 would fuse those of code in lanes (see
// native_compiler.cpp).
constexpr std::array flags = {
    "-x",
    "c",
    "-std=gnu11",
    "-O2",
    "-ftree-vectorize",
    "-fno-tree-slp-vectorize",
    "-ffp-contract=off",
    "-fno-math-errno",
    "-fno-trapping-math",
    "-fno-builtin-pow",
    "-w",
    "-shared",
    "-fPIC",
#if defined(__x86_64__)
    "-march=native",
#endif
};

/// Numbers that tell this processor from others for which `-march=native` gives other code.
std::string processor() {
#if defined(__x86_64__)
  std::string text;
  for (const unsigned leaf : {0u, 1u, 7u}) {
    unsigned a = 0, b = 0, c = 0, d = 0;
    if (__get_cpuid_count(leaf, 0, &a, &b, &c, &d) == 0) continue;
    if (leaf == 1) b = 0;  // the number of the core that asks
    text += fmt::format("{:x} {:x} {:x} {:x} ", a, b, c, d);
  }
  return text;
#else
  return {};
#endif
}

std::optional<fs::path> in_path(const std::string& program) {
  if (program.find('/') != std::string::npos) return fs::path(program);
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    fs::path candidate = fs::path(folder.empty() ? "." : folder) / program;
    if (access(candidate.c_str(), X_OK) == 0 && !fs::is_directory(candidate)) return candidate;
  }
  return std::nullopt;
}

/// A compiler that is updated is another one.
std::string identity_of(const fs::path& program) {
  std::error_code error;
  const fs::path real = fs::canonical(program, error);
  struct stat info = {};
  if (error || stat(real.c_str(), &info) != 0) return program.string();
  return fmt::format("{} {} {}", real.string(), static_cast<long long>(info.st_size),
                     static_cast<long long>(info.st_mtime));
}

std::string first_lines(const fs::path& file) {
  std::ifstream stream(file);
  std::string text, line;
  for (int lines = 0; lines < 3 && std::getline(stream, line); ++lines) text += (lines > 0 ? "; " : "") + line;
  return text.substr(0, 400);
}

Status failed(std::string what) {
  return {.ending = Ending::unreadable, .message = std::move(what)};
}

/// Starts a program in a process group of its own, which a Ctrl-C at the terminal does not reach. 0: it did not start.
pid_t start(const std::vector<std::string>& words, const fs::path& messages) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   S_IRUSR | S_IWUSR);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t child = 0;
  if (posix_spawnp(&child, arguments.front(), &files, &attributes, arguments.data(), environ) != 0) child = 0;
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return child;
}

}  // namespace

Status CCompiler::compile(const fs::path& source, const fs::path& shared_object, std::stop_token stop) const {
  if (command.empty()) return failed("there is no C compiler: install gcc, or set CC");
  std::vector<std::string> words = command;
  words.insert(words.end(), flags.begin(), flags.end());
  words.insert(words.end(), {source.string(), "-o", shared_object.string(), "-lm"});
  const fs::path messages = shared_object.string() + ".messages";
  const pid_t child = start(words, messages);
  if (child == 0)
    return failed(fmt::format("the C compiler {} cannot be started: {}", command.front(), std::strerror(errno)));
  const std::stop_callback kill_it(stop, [child] { kill(-child, SIGKILL); });
  int how = 0;
  while (waitpid(child, &how, 0) < 0 && errno == EINTR) {
  }
  const std::string said = first_lines(messages);
  std::error_code ignored;
  fs::remove(messages, ignored);
  if (stop.stop_requested()) return failed("the compilation was given up");
  if (!WIFEXITED(how) || WEXITSTATUS(how) != 0)
    return failed(fmt::format("{} failed: {}", command.front(), said.empty() ? "it said nothing" : said));
  return {};
}

CCompiler find_c_compiler() {
  CCompiler found;
  if (const char* own = std::getenv("CC"); own != nullptr && *own != '\0') {
    std::istringstream words(own);
    found.command.assign(std::istream_iterator<std::string>(words), {});
  }
  for (const char* name : {"cc", "gcc", "clang"})
    if (found.command.empty() && in_path(name)) found.command = {name};
  if (found.command.empty()) return found;
  for (const std::string& word : found.command) {
    const std::optional<fs::path> program = in_path(word);
    found.identity += (program ? identity_of(*program) : word) + " ";
  }
  for (const char* flag : flags) found.identity += fmt::format("{} ", flag);
  found.identity += processor();
  return found;
}

}  // namespace continuo::model
