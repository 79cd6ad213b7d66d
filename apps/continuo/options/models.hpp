// apps/continuo/options/models.hpp
// Reading models for the verbs: what is wrong with them goes to standard error.
#pragma once
#include <string>
#include <vector>

#include <continuo/language/load.hpp>

namespace continuo::app {

/// Loads a model and prints its diagnostics; without a model the verb ends with `wrong_model`, or with `usage` where
/// the file cannot be read.
model::Loaded load_model(const std::string& path, const model::CheckOptions& options = {});

/// The .sim files of a list of files and folders, in order; says which are not there.
struct ModelFiles {
  std::vector<std::string> paths;
  bool complete = true;
};
ModelFiles find_models(const std::vector<std::string>& files_and_folders);

/// Whether the path can be read; says so where not.
bool readable(const std::string& path);

/// Whether a picture of this name can be drawn: told before a long run, not after it.
bool drawable(const std::string& path);

}  // namespace continuo::app
