// No text makes the parser slow, recurse deeply, or throw. Its work is counted in tokens and accesses to them, never
// timed. The stack is the machine's usual one of 8 MB.
#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/syntax/parser.hpp>

namespace continuo::model {
namespace {

constexpr std::size_t ten_megabytes = 10'000'000, hundred_kilobytes = 100'000;

/// Each time a token is visited it is compared with the words that may begin a statement (20) and the operators that
/// may follow (20); these texts need at most 10 visits of each. A parser that repeatedly reads the same tokens exceeds
/// any constant.
constexpr std::size_t most_looks_per_token = 40;
constexpr std::size_t most_tokens = 1'000'000;

/// Codes of the diagnostics, at most 21 of them: the parser stops after 20 errors.
std::vector<std::string> codes(const std::string& text) {
  const Source source("test.sim", text);
  const ParseResult result = parse(source);
  EXPECT_LE(result.tokens, std::min(text.size() + 1, most_tokens));  // no token is empty but the end
  EXPECT_LE(result.looks, most_looks_per_token * (result.tokens + 1)) << text.substr(0, 40);
  EXPECT_LT(render(result.diagnostics, source).size(), 40'000U);
  EXPECT_LE(result.diagnostics.size(), 21U);
  std::vector<std::string> found;
  for (const Diagnostic& diagnostic : result.diagnostics) found.push_back(diagnostic.code);
  return found;
}

std::string repeated(const std::string& part, std::size_t size) {
  std::string text;
  text.reserve(size + part.size());
  while (text.size() < size) text += part;
  return text;
}

std::string noise(const std::string& alphabet) {
  std::mt19937 random(20240229);
  std::string text(ten_megabytes, ' ');
  for (char& c : text) c = alphabet[random() % alphabet.size()];
  return text;
}

TEST(ParserLimits, TenMegabytesOfBytesAreRefusedAtTheFirstThatIsNotUtf8) {
  std::string bytes;
  for (int i = 1; i < 256; ++i) bytes += static_cast<char>(i);
  EXPECT_THAT(codes(noise(bytes)), testing::ElementsAre("E101"));
}

TEST(ParserLimits, TenMegabytesOfSignsEndAfterTwentyErrors) {
  EXPECT_EQ(codes(noise("abx019 .'\"()[]{},;:=+-*/^<>#\n")).size(), 20U);
  EXPECT_EQ(codes(noise("{}();\n")).size(), 20U);
  EXPECT_THAT(codes(noise("ab ")), testing::ElementsAre("E111", "E108"));  // one line
  EXPECT_GE(codes(noise("x'=1;\n")).size(), 20U);
}

TEST(ParserLimits, ALongRunOfTheSameIsRead) {
  for (const char* part : {"a",        "1",        "(",        ")",  "[",   "{",  "}",       "-",      "'",
                           "\"",       "#",        "=",        ";",  "\n",  ",",  ".",       "x^",     "x'",
                           "u[",       "if ",      "not ",     "1+", "(1,", "f(", "mode a{", "if a {", "sum(i in 1..2:",
                           "\xCF\x89", "mode a\n", "when a\n", "(\n"}) {
    EXPECT_LE(codes(repeated(part, hundred_kilobytes)).size(), 21U) << part;
    EXPECT_LE(codes("x' = " + repeated(part, hundred_kilobytes)).size(), 21U) << part;
    EXPECT_LE(codes("when a < 0 { " + repeated(part, hundred_kilobytes)).size(), 21U) << part;
  }
}

TEST(ParserLimits, AMillionWordsAreTheLimit) {
  EXPECT_THAT(codes(repeated("x' = 1\n", ten_megabytes)), testing::ElementsAre("E108"));
  EXPECT_THAT(codes("param a = 1" + repeated(", a = 1", ten_megabytes)), testing::ElementsAre("E108"));
}

TEST(ParserLimits, NestingIsRefusedBeforeTheStackEnds) {
  EXPECT_THAT(codes("x' = " + std::string(190, '(') + "1" + std::string(190, ')')), testing::IsEmpty());
  const std::string open(100'000, '(');
  EXPECT_THAT(codes("x' = " + open + "1"), testing::ElementsAre("E107"));
  EXPECT_THAT(codes("x' = " + std::string(100'000, '-') + "1"), testing::ElementsAre("E107"));
  EXPECT_THAT(codes("x' = " + repeated("2^", 100'000) + "1"), testing::ElementsAre("E107"));
  EXPECT_THAT(codes("x' = " + repeated("if a then b else ", 100'000) + "1"), testing::ElementsAre("E107"));
  EXPECT_THAT(codes("x' = " + repeated("u[", 100'000) + "1"), testing::ElementsAre("E107"));
  EXPECT_THAT(codes("x' = " + repeated("sum(i in 1..2: ", 100'000) + "1"), testing::ElementsAre("E107"));
}

TEST(ParserLimits, ALongSumIsRefusedByItsHeight) {
  EXPECT_THAT(codes("x' = 1" + repeated(" + 1", 4 * 600)), testing::ElementsAre("E107"));
  EXPECT_THAT(codes("x' = 1" + repeated(" + 1", 4 * 400)), testing::IsEmpty());
  // Long sums inside long sums: the height counts along the deepest path, through brackets, indices and ranges.
  std::string nested = "1";
  for (int i = 0; i < 10; ++i) nested = "(" + nested + repeated(" + 1", 4 * 100) + ")";
  EXPECT_THAT(codes("x' = " + nested), testing::ElementsAre("E107"));
  nested = "1";
  for (int i = 0; i < 10; ++i) nested = "u[" + nested + repeated(" + 1", 4 * 100) + "]";
  EXPECT_THAT(codes("x' = " + nested), testing::ElementsAre("E107"));
  nested = "1";
  for (int i = 0; i < 10; ++i) nested = "sum(i in 1.." + nested + repeated(" + 1", 4 * 100) + ": i)";
  EXPECT_THAT(codes("x' = " + nested), testing::ElementsAre("E107"));
}

TEST(ParserLimits, AnUnclosedBlockHidesNothingThatFollowsIt) {
  const ParseResult result = parse(Source("test.sim", "when x < 0 {\n  x := 1\nrun 0..3\nplot x\n"));
  EXPECT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.model.statements.size(), 3U);
}

}  // namespace
}  // namespace continuo::model
