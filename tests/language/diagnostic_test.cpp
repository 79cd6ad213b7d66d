#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <continuo/language/text/diagnostic.hpp>

namespace continuo::model {
namespace {

const std::string sprung =
    "# A spring\nmodel Spring\nparam k = 4 [N/m], c = 1 [N*s/m], m = 1 [kg]\n"
    "param F = 1 [N]\n\nx'' = (F - k*x - c*x)/m\n";

Diagnostic units_do_not_match() {
  const auto begin = static_cast<std::uint32_t>(sprung.find("F - k*x - c"));
  return error("E201", {begin, begin + 13}, "units do not match", "`F - k*x` is N, `c*x` is N*s",
               "did you mean c*x' ?");
}

// The expected text is that of the language's description, character by character.
TEST(Diagnostics, AMessageShowsCodePlaceLineCaretsAndFix) {
  const Source source("spring.sim", sprung);
  EXPECT_EQ(render(units_do_not_match(), source), R"(error[E201]: units do not match
 --> spring.sim:6:8
  6 | x'' = (F - k*x - c*x)/m
    |        ^^^^^^^^^^^^^ `F - k*x` is N, `c*x` is N*s
    = help: did you mean c*x' ?
)");
}

TEST(Diagnostics, ASecondPlaceIsShownBelow) {
  const Source source("a.sim", "param k = 1\nparam k = 2\n");
  Diagnostic twice = error("E211", {18, 19}, "`k` is defined twice", "again here");
  twice.related.push_back({{6, 7}, "first here"});
  EXPECT_EQ(render(twice, source), R"(error[E211]: `k` is defined twice
 --> a.sim:2:7
  2 | param k = 2
    |       ^ again here
  1 | param k = 1
    |       - first here
)");
}

TEST(Diagnostics, CaretsStandUnderTheirCharactersAfterTabsAndLongLetters) {
  const Source source("a.sim", "\t\xCF\x89\xCF\x89 = ?");
  EXPECT_EQ(render(error("E102", {8, 9}, "`?` has no meaning here"), source), R"(error[E102]: `?` has no meaning here
 --> a.sim:1:7
  1 |  )"
                                                                              "\xCF\x89\xCF\x89"
                                                                              R"( = ?
    |       ^
)");
}

TEST(Diagnostics, OfALongLineThePartAroundTheCaretIsShown) {
  const std::string text = std::string(5000, 'a') + "?" + std::string(5000, 'b');
  const std::string shown = render(error("E102", {5000, 5001}, "no"), Source("a.sim", text));
  const std::string before(40, 'a'), after(59, 'b');  // 100 columns, 40 of them before the caret
  EXPECT_THAT(shown,
              testing::HasSubstr("  1 | ..." + before + "?" + after + "...\n    |    " + std::string(40, ' ') + "^\n"));
}

TEST(Diagnostics, ASpanOverSeveralLinesIsMarkedToTheEndOfItsFirst) {
  const Source source("a.sim", "x' = (1\n + 2)\n");
  EXPECT_THAT(render(error("E110", {5, 12}, "no"), source), testing::HasSubstr("x' = (1\n    |      ^^\n"));
}

TEST(Diagnostics, SeveralComeInOrderOfPlaceAndTheRestIsCounted) {
  const Source source("a.sim", "a\nb\nc\n");
  const std::vector<Diagnostic> all = {error("E110", {4, 5}, "third"), error("E110", {0, 1}, "first"),
                                       error("E110", {2, 3}, "second")};
  const std::string text = render(all, source, {.most_shown = 2});
  EXPECT_THAT(text, testing::StartsWith("error[E110]: first"));
  EXPECT_THAT(text, testing::HasSubstr("\n\nerror[E110]: second"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("third")));
  EXPECT_THAT(text, testing::EndsWith("\n... and 1 more\n"));
}

TEST(Diagnostics, TheSameObjectIsJson) {
  const auto json = nlohmann::json::parse(to_json(units_do_not_match(), Source("spring.sim", sprung)));
  EXPECT_EQ(json["code"], "E201");
  EXPECT_EQ(json["severity"], "error");
  EXPECT_EQ(json["message"], "units do not match");
  EXPECT_EQ(json["label"], "`F - k*x` is N, `c*x` is N*s");
  EXPECT_EQ(json["help"], "did you mean c*x' ?");
  EXPECT_EQ(json["file"], "spring.sim");
  EXPECT_EQ(json["line"], 6);
  EXPECT_EQ(json["column"], 8);
  EXPECT_EQ(json["end_line"], 6);
  EXPECT_EQ(json["end_column"], 21);
}

TEST(Diagnostics, JsonHoldsForAnyBytesInAName) {
  const Source source("a\xFF\"\n.sim", "x");
  EXPECT_TRUE(nlohmann::json::accept(to_json(error("E110", {0, 1}, "quote \" and \x01"), source)));
}

TEST(Diagnostics, OnlyErrorsCountAsErrors) {
  const std::vector<Diagnostic> warnings = {warning("E110", {}, "mind")};
  EXPECT_FALSE(has_errors(warnings));
  EXPECT_TRUE(has_errors(std::vector{warning("E110", {}, "mind"), error("E110", {}, "wrong")}));
}

TEST(Diagnostics, ColorsAreOnlyThereWhenAskedFor) {
  const Source source("a.sim", "x");
  const Diagnostic one = error("E110", {0, 1}, "wrong", "here", "mend it");
  EXPECT_THAT(render(one, source), testing::Not(testing::HasSubstr("\x1b[")));
  EXPECT_THAT(render(one, source, {.color = true}), testing::HasSubstr("\x1b[1;31merror[E110]"));
}

}  // namespace
}  // namespace continuo::model
