#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include <tests/architecture/source_tree.hpp>

namespace continuo::architecture {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> all_matches(const std::string& text, const char* pattern) {
  const std::regex expression(pattern, std::regex::ECMAScript | std::regex::multiline);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match) {
    found.push_back((*match)[1]);
  }
  return found;
}

std::string directives_of(const std::string& text) {
  std::istringstream in(text);
  std::string directives;
  for (std::string line; std::getline(in, line);) {
    const auto first = line.find_first_not_of(" \t");
    if (first != std::string::npos && line[first] == '#') directives += line + "\n";
  }
  return directives;
}

std::vector<fs::path> sources_below(const fs::path& folder) {
  std::vector<fs::path> found;
  if (!fs::exists(folder)) return found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".hpp" || extension == ".cpp") found.push_back(entry.path());
  }
  return found;
}

namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

bool is_keyword(const std::string& word) {
  return std::ranges::all_of(word, [](unsigned char c) { return std::isupper(c) != 0; });
}

std::string without_comments(const std::string& cmake) {
  return std::regex_replace(cmake, std::regex("#[^\n]*"), "");
}

}  // namespace

SourceTree::SourceTree(const fs::path& root) : root_(root) {
  for (const auto& call :
       all_matches(without_comments(text_of(root / "CMakeLists.txt")), R"(^continuo_library\(([^)]*)\))")) {
    const auto words = words_of(call);
    Module module{"continuo/" + words.front(), {}};
    auto word = std::ranges::find(words, "FOLDERS");
    while (word != words.end() && ++word != words.end() && !is_keyword(*word)) module.folders.push_back(*word);
    modules_.push_back(std::move(module));
  }
  Module command{"apps/continuo", {}};
  for (const auto& list : all_matches(text_of(root / "apps/continuo/CMakeLists.txt"), R"(^set\(folders([^)]*)\))")) {
    command.folders = words_of(list);
  }
  command.folders.push_back("modules");  // libraries of their own, opened by the command
  modules_.push_back(std::move(command));

  for (const auto* top : {"continuo", "apps"}) {
    for (const auto& file : sources_below(root / top)) {
      includes_[fs::relative(file, root).generic_string()] =
          all_matches(directives_of(text_of(file)), R"(^\s*#\s*include\s*[<"]((?:continuo|apps)/[^>"]+)[>"])");
    }
  }
}

std::vector<SourceTree::Place> SourceTree::place_of(const std::string& file) const {
  for (std::size_t i = 0; i < modules_.size(); ++i) {
    const auto& path = modules_[i].path;
    if (!file.starts_with(path + "/")) continue;
    const auto folder = fs::path(file).parent_path().generic_string();
    return {{i, folder == path ? "" : folder.substr(path.size() + 1)}};
  }
  return {};
}

std::size_t SourceTree::number_of(const Place& place) const {
  const auto& folders = modules_[place.module].folders;
  return static_cast<std::size_t>(std::ranges::find(folders, place.folder) - folders.begin());
}

void SourceTree::follow(const std::string& file, const std::string& from, const Place& own,
                        std::vector<std::string>& seen, std::vector<std::string>& faults) const {
  const auto found = includes_.find(file);
  if (found == includes_.end()) return;
  for (const auto& other : found->second) {
    const auto place = place_of(other);
    if (place.empty() || place[0].module != own.module || std::ranges::count(seen, other) > 0) continue;
    seen.push_back(other);
    if (place[0].folder.empty()) {
      follow(other, from, own, seen, faults);
    } else if (number_of(place[0]) > number_of(own)) {
      const auto by = file == from ? "" : " by " + file;
      faults.push_back(from + " includes" + by + " " + other + ", a folder above its own");
    }
  }
}

std::vector<std::string> SourceTree::upward_includes() const {
  std::vector<std::string> faults;
  for (const auto& [file, includes] : includes_) {
    if (file.ends_with("/continuo.hpp") && file.find('/') == file.rfind('/')) continue;  // all of the library
    const auto own = place_of(file);
    if (own.empty()) {
      faults.push_back(file + " lies in no module that CMakeLists.txt names");
      continue;
    }
    for (const auto& other : includes) {
      const auto place = place_of(other);
      if (place.empty() || place[0].module > own[0].module) {
        faults.push_back(file + " includes " + other + ", a module above its own");
      }
    }
    if (own[0].folder.empty()) continue;
    if (number_of(own[0]) == modules_[own[0].module].folders.size()) {
      faults.push_back(file + " lies in a folder that CMake does not name");
      continue;
    }
    std::vector<std::string> seen;
    follow(file, file, own[0], seen, faults);
  }
  return faults;
}

std::vector<std::string> SourceTree::crowded_folders(std::size_t most_subjects, std::size_t most_files) const {
  std::map<std::string, std::set<std::string>> subjects;
  for (const auto& [file, includes] : includes_) {
    subjects[fs::path(file).parent_path().generic_string()].insert(fs::path(file).stem().string());
  }
  std::vector<std::string> crowded;
  for (const auto& [folder, names] : subjects) {
    const auto files = static_cast<std::size_t>(std::ranges::count_if(
        fs::directory_iterator(root_ / folder), [](const auto& entry) { return entry.is_regular_file(); }));
    if (names.size() > most_subjects || files > most_files) {
      crowded.push_back(folder + ": " + std::to_string(names.size()) + " subjects in " + std::to_string(files) +
                        " files");
    }
  }
  return crowded;
}

std::vector<std::string> SourceTree::sources_without_purpose() const {
  std::vector<std::string> without;
  for (const auto& [file, includes] : includes_) {
    if (fs::path(file).extension() != ".cpp") continue;
    std::ifstream in(root_ / file);
    std::string line;
    bool says = false;
    while (!says && std::getline(in, line) && line.starts_with("//")) {
      const auto first = line.find_first_not_of("/ ");
      says = first != std::string::npos && line.substr(first) != file;
    }
    if (!says) without.push_back(file);
  }
  return without;
}

}  // namespace continuo::architecture
