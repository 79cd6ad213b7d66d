// The register of codes against the sources that raise them.
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/text/codes.hpp>

namespace continuo::model {
namespace {

std::vector<Code> all_codes() {
  std::vector<Code> all;
  for (const auto family : {syntax_codes(), check_codes(), numerical_codes()})
    all.insert(all.end(), family.begin(), family.end());
  return all;
}

/// The codes that occur as texts in the sources, except in the register itself.
std::set<std::string> raised_codes() {
  std::set<std::string> raised;
  const std::regex code("\"(E[0-9]{3})\"");
  for (const char* room : {"continuo", "apps"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(CONTINUO_SOURCE_DIR) / room)) {
      const std::string name = entry.path().filename().string();
      const bool source = name.ends_with(".cpp") || name.ends_with(".hpp");
      if (!source || name.starts_with("codes") || name == "diagnostic.hpp") continue;
      std::ifstream file(entry.path());
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      for (std::sregex_iterator i(text.begin(), text.end(), code), end; i != end; ++i) raised.insert((*i)[1].str());
    }
  }
  return raised;
}

TEST(Codes, EveryCodeThatIsRaisedHasItsExplanation) {
  const std::set<std::string> raised = raised_codes();
  EXPECT_GE(raised.size(), 30U);
  for (const std::string& code : raised) EXPECT_NE(find_code(code), nullptr) << code << " is raised but not explained";
}

TEST(Codes, EveryExplanationBelongsToACodeThatIsRaised) {
  const std::set<std::string> raised = raised_codes();
  for (const Code& code : all_codes())
    EXPECT_TRUE(raised.contains(std::string(code.code))) << code.code << " is explained but never raised";
}

TEST(Codes, FamiliesAreInOrderAndEachCodeIsThereOnce) {
  std::string last;
  for (const Code& code : all_codes()) {
    EXPECT_LT(last, code.code);
    last = code.code;
  }
}

TEST(Codes, AnExplanationIsMoreThanItsTitle) {
  for (const Code& code : all_codes()) {
    EXPECT_GT(code.explanation.size(), code.title.size()) << code.code;
    std::istringstream lines{std::string(code.explanation)};
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120U) << code.code << ": " << line;
  }
}

TEST(Codes, ACodeIsFoundInAnyCase) {
  ASSERT_NE(find_code("e101"), nullptr);
  EXPECT_EQ(find_code("e101")->code, "E101");
  EXPECT_EQ(find_code("E999"), nullptr);
  EXPECT_EQ(find_code(""), nullptr);
}

}  // namespace
}  // namespace continuo::model
