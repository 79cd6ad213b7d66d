// Wrong models and what is said about them: each NAME.sim of tests/language/wrong has its messages in NAME.txt beside
// it, as they are shown, with line and column. See the README there.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/check/check.hpp>
#include <continuo/language/syntax/parser.hpp>

namespace continuo::model {
namespace {

const std::filesystem::path folder = CONTINUO_SOURCE_DIR "/tests/language/wrong";

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> names() {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".sim") found.push_back(entry.path().stem().string());
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Diagnostic> messages(const Source& source) {
  ParseResult parsed = parse(source);
  if (has_errors(parsed.diagnostics)) return parsed.diagnostics;
  return check(parsed.model, source).diagnostics;
}

class WrongModels : public testing::TestWithParam<std::string> {};

TEST_P(WrongModels, GetTheMessagesInTheFileBesideThem) {
  const Source source(GetParam() + ".sim", contents(folder / (GetParam() + ".sim")));
  const std::vector<Diagnostic> found = messages(source);
  EXPECT_TRUE(has_errors(found)) << "a wrong model has at least one error";
  EXPECT_EQ(render(found, source), contents(folder / (GetParam() + ".txt")));
}

INSTANTIATE_TEST_SUITE_P(Each, WrongModels, testing::ValuesIn(names()),
                         [](const testing::TestParamInfo<std::string>& model) { return model.param; });

TEST(WrongModelsTogether, AreFiftyAndMore) {
  EXPECT_GE(names().size(), 50U);
}

TEST(WrongModelsTogether, EveryTextBelongsToAModel) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".txt") continue;
    auto model = entry.path();
    EXPECT_TRUE(std::filesystem::exists(model.replace_extension(".sim"))) << entry.path();
  }
}

}  // namespace
}  // namespace continuo::model
