// Every link or picture in the documentation that names a file of this repository names an existing one, and every link
// to a heading an existing heading; every page of docs/ is listed on its front page.
#include <cctype>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <tests/docs/blocks.hpp>

namespace continuo::docs {
namespace {

/// As GitHub makes it: lower case, without punctuation, spaces as hyphens; of headings alike the second has -1.
std::set<std::string> anchors_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::multiset<std::string> seen;
  std::set<std::string> anchors;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("```")) inside = !inside;
    const std::size_t level = line.find_first_not_of('#');
    if (inside || level == 0 || level == std::string::npos || line[level] != ' ') continue;
    std::string anchor;
    for (const char c : line.substr(level + 1)) {
      const auto letter = static_cast<unsigned char>(c);
      if (c == ' ') anchor += '-';
      if (std::isalnum(letter) != 0 || c == '-' || c == '_') anchor += static_cast<char>(std::tolower(letter));
    }
    const std::size_t before = seen.count(anchor);
    seen.insert(anchor);
    anchors.insert(before == 0 ? anchor : anchor + "-" + std::to_string(before));
  }
  return anchors;
}

TEST(Documentation, LinksToFilesThatExist) {
  static const std::regex link(R"(\]\(([^)#: ]+)[^):]*\))");
  for (const auto& file : documentation()) {
    const std::string text = prose_of(file);
    for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match) {
      const auto target = file.parent_path() / (*match)[1].str();
      EXPECT_TRUE(std::filesystem::exists(target)) << file << " links to " << (*match)[1].str();
    }
  }
}

TEST(Documentation, LinksToHeadingsThatExist) {
  static const std::regex link(R"(\]\(([^)#: ]*)#([^)]+)\))");
  std::size_t found = 0;
  for (const auto& file : documentation()) {
    const std::string text = prose_of(file);
    for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match, ++found) {
      const std::string page = (*match)[1].str(), heading = (*match)[2].str();
      const auto target = page.empty() ? file : file.parent_path() / page;
      EXPECT_TRUE(anchors_of(target).contains(heading)) << file << " links to " << page << "#" << heading;
    }
  }
  EXPECT_GT(found, 50U);
}

TEST(Documentation, TheFrontPageListsEveryPage) {
  const std::filesystem::path docs = std::filesystem::path(CONTINUO_SOURCE_DIR) / "docs";
  const std::string front = prose_of(docs / "README.md");
  for (const auto& file : documentation()) {
    if (file.parent_path() != docs || file.filename() == "README.md") continue;
    EXPECT_NE(front.find("](" + file.filename().string() + ")"), std::string::npos) << file << " is not listed";
  }
}

}  // namespace
}  // namespace continuo::docs
