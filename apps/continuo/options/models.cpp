// Loads models, tests whether files can be read and written, and collects the models of folders.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <apps/continuo/options/models.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::app {
namespace {

namespace fs = std::filesystem;

/// The models beside a file that is not there, for "did you mean".
std::vector<std::string> neighbours(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".sim") {
      names.push_back(path.has_parent_path() ? entry.path().string() : entry.path().filename().string());
    }
  }
  std::ranges::sort(names);
  return names;
}

/// Whether two names are of one file on a disk. Devices and pipes take what comes.
bool are_names_of_one_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == "-" || b == "-") return false;
  std::error_code error;
  if (fs::exists(b, error)) return fs::is_regular_file(b, error) && fs::equivalent(a, b, error) && !error;
  return fs::absolute(a, error).lexically_normal() == fs::absolute(b, error).lexically_normal();
}

}  // namespace

bool readable(const std::string& path) {
  std::error_code error;
  std::string reason;
  if (fs::is_directory(path, error)) {
    reason = "it is a folder";
  } else {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (file) return true;
    reason = std::strerror(errno);
  }
  const std::string hint = fs::exists(path, error) ? "" : model::did_you_mean(path, neighbours(path));
  say(fmt::format("cannot read {}: {}{}{}", path, reason, hint.empty() ? "" : "; ", hint));
  return false;
}

bool writable(const std::string& path) {
  if (path.empty() || path == "-") return true;
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  std::error_code error;
  const std::string place = fs::exists(path, error) ? path : folder.string();
  if (access(place.c_str(), W_OK) == 0) return true;
  say(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
  return false;
}

bool drawable(const std::string& path) {
  if (path.empty()) return true;
  const std::string ending = fs::path(path).extension().string();
  if (ending == ".svg" || ending == ".png") return writable(path);
  say(fmt::format("cannot plot to {}: the file's name ends in .svg or .png", path));
  return false;
}

bool are_apart(const std::vector<std::string>& read, const std::vector<std::string>& written) {
  for (auto output = written.begin(); output != written.end(); ++output) {
    if (std::ranges::any_of(read, [&](const std::string& input) { return are_names_of_one_file(input, *output); })) {
      say(fmt::format("cannot write {}: it is read as input; give another name", *output));
      return false;
    }
    if (std::any_of(written.begin(), output,
                    [&](const std::string& other) { return are_names_of_one_file(other, *output); })) {
      say(fmt::format("cannot write {} twice: each output needs a name of its own", *output));
      return false;
    }
  }
  return true;
}

std::vector<std::string> files_of(const model::Model& model, const std::string& path) {
  std::vector<std::string> files;
  const auto add = [&](const std::string& file) {
    if (!file.empty()) files.push_back((fs::path(path).parent_path() / file).string());
  };
  for (const auto& table : model.tables) add(table.file);
  for (const auto& input : model.inputs) add(input.file);
  return files;
}

model::Loaded load_model(const std::string& path, const model::CheckOptions& options) {
  model::Loaded loaded = model::load(path, options);
  if (!loaded.diagnostics.empty()) fmt::print(stderr, "{}", loaded.text({.color = colors_wanted()}));
  return loaded;
}

ModelFiles find_models(const std::vector<std::string>& files_and_folders) {
  ModelFiles found;
  for (const std::string& place : files_and_folders) {
    std::error_code error;
    if (!fs::is_directory(place, error)) {
      if (readable(place)) {
        found.paths.push_back(place);
      } else {
        found.complete = false;
      }
      continue;
    }
    std::vector<std::string> inside;
    for (const auto& entry : fs::recursive_directory_iterator(place, error)) {
      if (entry.path().extension() == ".sim") inside.push_back(entry.path().string());
    }
    if (inside.empty()) say(fmt::format("there is no .sim file in {}", place));
    if (inside.empty()) found.complete = false;
    std::ranges::sort(inside);
    found.paths.insert(found.paths.end(), inside.begin(), inside.end());
  }
  return found;
}

}  // namespace continuo::app
