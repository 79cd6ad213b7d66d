// continuo/language/load.cpp
// Reads, parses and checks a model.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include <continuo/language/check/check.hpp>
#include <continuo/language/load.hpp>
#include <continuo/language/load_confined.hpp>
#include <continuo/language/syntax/parser.hpp>

namespace continuo::model {

namespace {

Loaded load(Source source, const CheckOptions& options, FileReach files) {
  Loaded loaded{std::move(source), std::nullopt, {}};
  ParseResult parsed = parse(loaded.source);
  loaded.diagnostics = std::move(parsed.diagnostics);
  if (has_errors(loaded.diagnostics)) return loaded;  // what is not understood is not judged
  Checked checked = check(parsed.model, loaded.source, options, files);
  loaded.model = std::move(checked.model);
  std::ranges::move(checked.diagnostics, std::back_inserter(loaded.diagnostics));
  return loaded;
}

Loaded load(const std::string& path, const CheckOptions& options, FileReach files) {
  if (auto source = read_source(path)) return load(std::move(*source), options, files);
  std::error_code ignored;
  const bool there = std::filesystem::exists(path, ignored);
  Loaded loaded{Source(path, ""), std::nullopt, {}};
  loaded.diagnostics.push_back(error("E270", {}, fmt::format("`{}` cannot be read", path), {},
                                     there ? "is it a folder, or not yours to read?" : "there is no such file"));
  return loaded;
}

}  // namespace

Loaded load(Source source, const CheckOptions& options) {
  return load(std::move(source), options, FileReach::anywhere);
}
Loaded load(const std::string& path, const CheckOptions& options) {
  return load(path, options, FileReach::anywhere);
}

Loaded load_confined(Source source, const CheckOptions& options) {
  return load(std::move(source), options, FileReach::model_folder);
}
Loaded load_confined(const std::string& path, const CheckOptions& options) {
  return load(path, options, FileReach::model_folder);
}

}  // namespace continuo::model
