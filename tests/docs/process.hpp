// tests/docs/process.hpp
// Runs a shell command in a folder and returns its exit code and its output.
#pragma once
#include <filesystem>
#include <string>

namespace continuo::docs {

struct Finished {
  int exit_code;
  std::string printed;  // standard output and standard error, as they came
};

/// `continuo` names the command just built. The folder is made when missing.
Finished run_in(const std::filesystem::path& folder, const std::string& command);

/// A fresh folder for one test, with a link `models` to the gallery and `docs` to the documentation.
std::filesystem::path fresh_folder(const std::string& name);

}  // namespace continuo::docs
