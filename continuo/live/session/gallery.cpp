// Finds the models of a folder that can move while somebody looks.
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <variant>

#include <continuo/language/load.hpp>
#include <continuo/language/syntax/format.hpp>
#include <continuo/language/syntax/parser.hpp>
#include <continuo/live/settings.hpp>
#include <continuo/runs/kind.hpp>

namespace continuo::live {

namespace {

void collect_times(const std::vector<model::ast::Statement>& statements, std::set<std::string>& times) {
  for (const model::ast::Statement& statement : statements) {
    if (const auto* condition = std::get_if<model::ast::Condition>(&statement.node))
      times.insert(model::to_text(condition->time));
    if (const auto* family = std::get_if<model::ast::Family>(&statement.node)) collect_times(family->body, times);
  }
}

/// Whether conditions stand at several times, so that nothing moves before all is known. Only where they are written in
/// several ways has the text to be checked; what has errors is no such model, and can be mended here.
bool has_no_start(const model::Source& source) {
  std::set<std::string> times;
  collect_times(model::parse(source).model.statements, times);
  if (times.size() < 2) return false;
  const model::Loaded loaded = model::load(source);
  return loaded.model && !runs::kind_of(*loaded.model).has_start;
}

}  // namespace

std::vector<GalleryModel> gallery_in(const std::string& folder) {
  std::vector<GalleryModel> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".sim") continue;
    const auto source = model::read_source(entry.path());
    if (!source || has_no_start(*source)) continue;
    const std::string line = source->text().substr(0, source->text().find('\n'));
    const std::size_t begin = line.find_first_not_of("# \t");
    const bool heading = line.starts_with('#') && begin != std::string::npos;
    found.push_back({entry.path().stem().string(), heading ? line.substr(begin) : "", entry.path().string()});
  }
  std::ranges::sort(found, {}, &GalleryModel::name);
  return found;
}

}  // namespace continuo::live
