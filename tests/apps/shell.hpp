// tests/apps/shell.hpp
// The command run in a folder of its own.
//
//   Shell shell;
//   shell.write("ball.sim", "...");
//   const Result result = shell.run("run ball.sim");    // result.exit, result.out, result.err
#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace continuo::app {

struct Result {
  int exit;
  std::string out, err;
};

class Shell {
 public:
  Shell() {
    std::string name = (std::filesystem::temp_directory_path() / "continuo-apps-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  Shell(const Shell&) = delete;
  Shell& operator=(const Shell&) = delete;
  ~Shell() { std::filesystem::remove_all(folder_); }

  /// `before` precedes the command: variables, `timeout`.
  Result run(const std::string& arguments, const std::string& before = "") const {
    return call(before + " '" CONTINUO_COMMAND "' " + arguments);
  }
  /// Sends the command what Ctrl-C sends, once the files of a pattern hold so many bytes: however slow the machine is.
  Result interrupt(const std::string& arguments, const std::string& files, int bytes) const {
    return call("'" CONTINUO_COMMAND "' " + arguments + " & run=$!; for i in $(seq 1200); do [ $(cat " + files +
                " 2> .none | wc -c) -gt " + std::to_string(bytes) +
                " ] && break; sleep 0.1; done; kill -INT $run; wait $run");
  }
  /// Any line of the shell's.
  Result call(const std::string& line) const {
    const std::string inside = "cd '" + folder_.string() + "' && { " + line + "; } >.out 2>.err </dev/null";
    const int status = std::system(inside.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(".out"), read(".err")};
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  std::string read(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  bool has(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

 private:
  std::filesystem::path folder_;
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// A model of the gallery.
inline std::string gallery(const std::string& name) {
  return "'" CONTINUO_SOURCE_DIR "/models/" + name + ".sim'";
}

inline constexpr const char* spring =
    "model Spring\n"
    "param k = 4 in 0..10\n"
    "x'' = -k*x\n"
    "x(0) = 1; x'(0) = 0\n"
    "energy all = x'^2/2 + k*x^2/2\n"
    "when x falls through 0 { mark \"half way\" }\n"
    "run 0..2 output 0.5 tol 1e-10\n";

}  // namespace continuo::app
