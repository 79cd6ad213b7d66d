// Finds the models of a folder that can move while somebody looks.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <utility>
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

/// Where a model stands in the list of its folder.
struct Listed {
  std::size_t place;
  std::string subject;
};

/// The list `gallery.txt`; empty where there is none.
std::map<std::string, Listed, std::less<>> list_in(const std::filesystem::path& folder) {
  std::map<std::string, Listed, std::less<>> listed;
  std::ifstream file(folder / "gallery.txt");
  std::string subject;
  for (std::string line; std::getline(file, line);) {
    const std::size_t begin = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '#') continue;
    const std::string words = line.substr(begin, end + 1 - begin);
    if (begin == 0) {
      subject = words;
    } else {
      listed.emplace(words, Listed{listed.size(), subject});
    }
  }
  return listed;
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
  const auto listed = list_in(folder);
  for (GalleryModel& model : found) {
    if (const auto place = listed.find(model.name); place != listed.end()) model.subject = place->second.subject;
  }
  std::ranges::sort(found, {}, [&](const GalleryModel& model) {
    const auto place = listed.find(model.name);
    return std::pair(place == listed.end() ? listed.size() : place->second.place, model.name);
  });
  return found;
}

}  // namespace continuo::live
