// Every link or picture in the documentation that names a file of this repository names an existing one.
#include <regex>
#include <string>

#include <gtest/gtest.h>
#include <tests/docs/blocks.hpp>

namespace continuo::docs {
namespace {

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

}  // namespace
}  // namespace continuo::docs
