// Loads models, tests whether files can be read, and collects the models of folders.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <apps/continuo/options/models.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/own_process.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/figure.hpp>
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

}  // namespace

bool readable(const std::string& path) {
  if (path == standard_input) return true;
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

bool drawable(const std::string& path) {
  if (path.empty()) return true;
  if (results::is_picture(path)) return true;
  say(fmt::format("cannot plot to {}: the file's name ends in {}", path, results::picture_endings));
  return false;
}

bool reads_standard_input_once(const std::vector<std::string>& read) {
  if (std::ranges::count(read, standard_input) <= 1) return true;
  say("standard input (-) can be read once: give the name of a file for the others");
  return false;
}

void show(std::span<const model::Diagnostic> diagnostics, const model::Source& source) {
  if (diagnostics.empty()) return;
  fmt::print(stderr, "{}", model::render(diagnostics, source, {.color = colors_wanted()}));
  for (const model::Diagnostic& diagnostic : diagnostics)
    record_message(nlohmann::ordered_json::parse(model::to_json(diagnostic, source)));
}

std::string name_of_file(const std::string& path) {
  return path == standard_input ? "standard input" : path;
}

model::Loaded load_model(const std::string& path, const model::CheckOptions& options) {
  if (path == standard_input) return load_model(model::Source(name_of_file(path), contents_of(path)), options);
  model::Loaded loaded = model::load(path, options);
  show(loaded.diagnostics, loaded.source);
  return loaded;
}

model::Loaded load_model(model::Source source, const model::CheckOptions& options) {
  model::Loaded loaded = model::load(std::move(source), options);
  show(loaded.diagnostics, loaded.source);
  return loaded;
}

std::optional<results::Measurements> measurements_in(const std::string& file) {
  auto read = file == standard_input ? results::parse_measurements(contents_of(file), name_of_file(file))
                                     : results::read_measurements(file);
  if (!read) {
    say(read.status().message);
    return std::nullopt;
  }
  if (read->has_decimal_commas) mention(fmt::format("{} has decimal commas: 1,5 is read as 1.5", name_of_file(file)));
  return *std::move(read);
}

ModelFiles find_models(const std::vector<std::string>& files_and_folders) {
  ModelFiles found{.paths = {}, .complete = reads_standard_input_once(files_and_folders)};
  if (!found.complete) return found;
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
