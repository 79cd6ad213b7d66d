#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/syntax/lexer.hpp>
#include <continuo/language/text/unicode.hpp>

namespace continuo::model {
namespace {

using Kind = TokenKind;
using testing::ElementsAre;

std::vector<Kind> kinds(const std::string& text) {
  const Source source("a.sim", text);
  Lexer lexer(source);
  std::vector<Kind> result;
  for (Token token = lexer.next(); token.kind != Kind::end; token = lexer.next()) result.push_back(token.kind);
  return result;
}

double number(const std::string& text) {
  const Source source("a.sim", text);
  return Lexer(source).next().number;
}

TEST(Lexing, ABracketDirectlyAfterANameIsAnIndexElseAUnit) {
  EXPECT_THAT(kinds("u[i]"), ElementsAre(Kind::name, Kind::open_index, Kind::name, Kind::close_index));
  EXPECT_THAT(kinds("u [i]"), ElementsAre(Kind::name, Kind::unit));
  EXPECT_THAT(kinds("3[m]"), ElementsAre(Kind::number, Kind::unit));
  EXPECT_THAT(kinds("(x)[m/s^2]"), ElementsAre(Kind::open_round, Kind::name, Kind::close_round, Kind::unit));
}

TEST(Lexing, TwoDotsEndANumber) {
  EXPECT_THAT(kinds("0..60"), ElementsAre(Kind::number, Kind::dots, Kind::number));
  EXPECT_THAT(kinds("0...5"), ElementsAre(Kind::number, Kind::bad, Kind::number));
}

TEST(Lexing, NumbersAreReadToTheLastBit) {
  EXPECT_EQ(number("0.1"), 0.1);
  EXPECT_EQ(number(".5"), 0.5);
  EXPECT_EQ(number("5."), 5.0);
  EXPECT_EQ(number("1e-10"), 1e-10);
  EXPECT_EQ(number("6.02E+23"), 6.02e23);
  EXPECT_EQ(number("2.2250738585072014e-308"), 2.2250738585072014e-308);
}

TEST(Lexing, ALineGoesOnAfterAnOperatorACommaOrAnOpenBracket) {
  EXPECT_THAT(kinds("a +\n\n b"), ElementsAre(Kind::name, Kind::plus, Kind::name));
  EXPECT_THAT(kinds("a, # first\n b"), ElementsAre(Kind::name, Kind::comma, Kind::name));
  EXPECT_THAT(kinds("(\na"), ElementsAre(Kind::open_round, Kind::name));
  EXPECT_THAT(kinds("a\n+ b"), ElementsAre(Kind::name, Kind::line_end, Kind::plus, Kind::name));
  EXPECT_THAT(kinds("{\na"), ElementsAre(Kind::open_brace, Kind::line_end, Kind::name));
}

TEST(Lexing, LettersOfOtherAlphabetsStandInNames) {
  EXPECT_THAT(kinds("\xCF\x89\xE2\x82\x80 \xD0\xB6 \xC3\xA9t\xC3\xA9"),
              ElementsAre(Kind::name, Kind::name, Kind::name));
}

TEST(Lexing, LineEndsOfAnySystemAndAByteOrderMarkAreTaken) {
  EXPECT_THAT(kinds("\xEF\xBB\xBF"
                    "a\r\nb"),
              ElementsAre(Kind::name, Kind::line_end, Kind::name));
}

TEST(Lexing, TextsResolveTheirEscapes) {
  EXPECT_EQ(unescape(R"("a\"b\\c\n\t")"), "a\"b\\c\n\t");
}

TEST(Lexing, TheHeadingIsTheFirstBlockOfComments) {
  EXPECT_EQ(heading_of("\n# One.\n#\n#  Two.\nmodel A\n# no"), "One.\n\n Two.");
  EXPECT_EQ(heading_of("# One.\n\n# no"), "One.");
  EXPECT_EQ(heading_of("model A\n# no"), "");
  EXPECT_EQ(heading_of(""), "");
}

// sequences that are not well-formed UTF-8
TEST(Lexing, IllFormedUtf8IsFoundAtItsByte) {
  EXPECT_EQ(first_invalid_byte("abc"), std::nullopt);
  EXPECT_EQ(first_invalid_byte("\xF0\x9D\x94\xB8"), std::nullopt);
  EXPECT_EQ(first_invalid_byte("a\xE9z"), 1U);            // Latin-1
  EXPECT_EQ(first_invalid_byte("ab\xC0\x80"), 2U);        // overlong
  EXPECT_EQ(first_invalid_byte("\xED\xA0\x80"), 0U);      // a surrogate
  EXPECT_EQ(first_invalid_byte("\xF4\x90\x80\x80"), 0U);  // beyond U+10FFFF
  EXPECT_EQ(first_invalid_byte("a\xE2\x82"), 1U);         // cut off
}

}  // namespace
}  // namespace continuo::model
