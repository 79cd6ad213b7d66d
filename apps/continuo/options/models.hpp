// apps/continuo/options/models.hpp
// Reading models for the verbs: what is wrong with them goes to standard error.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/language/load.hpp>
#include <continuo/results/measurements.hpp>

namespace continuo::app {

/// Messages about a model as people read them, on standard error, and as objects in the answer to --json.
void show(std::span<const model::Diagnostic> diagnostics, const model::Source& source);

/// The file `-`, which is standard input.
inline constexpr std::string_view standard_input = "-";

/// How messages call a file: standard input has a name without a dash.
std::string name_of_file(const std::string& path);

/// Loads a model, of standard input too, and shows its diagnostics; without a model the verb ends with `wrong_model`,
/// or with `usage` where the file cannot be read.
model::Loaded load_model(const std::string& path, const model::CheckOptions& options = {});
model::Loaded load_model(model::Source source, const model::CheckOptions& options = {});

/// A table of measurements, of standard input too. Says what is wrong with it, and how its numbers are read.
std::optional<results::Measurements> measurements_in(const std::string& file);

/// The .sim files of a list of files and folders, in order; says which are not there.
struct ModelFiles {
  std::vector<std::string> paths;
  bool complete = true;
};
ModelFiles find_models(const std::vector<std::string>& files_and_folders);

/// Whether the path can be read, or is standard input; says so where not.
bool readable(const std::string& path);

/// Whether a picture of this name can be drawn: told before a long run, not after it.
bool drawable(const std::string& path);

/// Whether at most one of these is standard input, which can be read once; says so where not.
bool reads_standard_input_once(const std::vector<std::string>& read);

}  // namespace continuo::app
