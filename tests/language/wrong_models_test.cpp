// Wrong models and their messages: each NAME.sim of tests/language/wrong has its messages in NAME.txt, as they are
// shown, with line and column. See the README there.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tests/language/model_folder.hpp>

#include <continuo/language/check/check.hpp>
#include <continuo/language/syntax/parser.hpp>

namespace continuo::model {
namespace {

const std::filesystem::path folder = CONTINUO_SOURCE_DIR "/tests/language/wrong";

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

INSTANTIATE_TEST_SUITE_P(Each, WrongModels, testing::ValuesIn(models_in(folder)), name_of_test);

TEST(WrongModelsTogether, AreFiftyAndMore) {
  EXPECT_GE(models_in(folder).size(), 50U);
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
