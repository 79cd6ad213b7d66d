// How expressions are parsed, tested by the canonical text that each tree is formatted to.
#include <gtest/gtest.h>

#include <continuo/language/syntax/format.hpp>
#include <continuo/language/syntax/parser.hpp>

namespace continuo::model {
namespace {

std::string spelled(const std::string& text) {
  const Source source("expression", text);
  const ParsedExpression parsed = parse_expression(source);
  EXPECT_TRUE(parsed.diagnostics.empty()) << render(parsed.diagnostics, source);
  return to_text(parsed.expression);
}

std::string code(const std::string& text) {
  const ParsedExpression parsed = parse_expression(Source("expression", text));
  return parsed.diagnostics.empty() ? "" : parsed.diagnostics.front().code;
}

TEST(ParsedExpressions, OperatorsBindAsOnTheBlackboard) {
  EXPECT_EQ(spelled("(a + b) + c"), "a + b + c");
  EXPECT_EQ(spelled("a - (b - c)"), "a - (b - c)");
  EXPECT_EQ(spelled("a + (b*c)"), "a + b*c");
  EXPECT_EQ(spelled("(a/b)/c"), "a/b/c");
  EXPECT_EQ(spelled("a/(b/c)"), "a/(b/c)");
  EXPECT_EQ(spelled("a/(b*c)"), "a/(b*c)");
}

TEST(ParsedExpressions, PowersBindToTheRightAndAboveTheSign) {
  EXPECT_EQ(spelled("-(x^2)"), "-x^2");
  EXPECT_EQ(spelled("(-x)^2"), "(-x)^2");
  EXPECT_EQ(spelled("2^(3^2)"), "2^(3^2)");
  EXPECT_EQ(spelled("2^3^2"), "2^(3^2)");
  EXPECT_EQ(spelled("x^-1.5"), "x^-1.5");
  EXPECT_EQ(spelled("a*-b"), "a*-b");
  EXPECT_EQ(spelled("- -x"), "--x");
}

TEST(ParsedExpressions, LogicBindsBelowComparison) {
  EXPECT_EQ(spelled("(a < b) and not (c == d) or e"), "a < b and not c == d or e");
  EXPECT_EQ(spelled("a and (b or c)"), "a and (b or c)");
  EXPECT_EQ(spelled("if a < b then c else d + 1"), "if a < b then c else d + 1");
  EXPECT_EQ(spelled("1 + (if a < b then c else d)"), "1 + (if a < b then c else d)");
}

TEST(ParsedExpressions, NamesHaveIndicesAndThenPrimes) {
  EXPECT_EQ(spelled("u[i-1]'' + v[i, j + 1]"), "u[i - 1]'' + v[i, j + 1]");
  EXPECT_EQ(spelled("h'(1)"), "h'(1)");
  EXPECT_EQ(spelled("x[1](3)"), "x[1](3)");
  EXPECT_EQ(spelled("interp(drag, v)"), "interp(drag, v)");
}

TEST(ParsedExpressions, SumsNameTheirIndexAndLeaveTermsOut) {
  EXPECT_EQ(spelled("sum(j in 1..N where j != i: m[j]*x[j])"), "sum(j in 1..N where j != i: m[j]*x[j])");
  EXPECT_EQ(spelled("sum(j in i+1..N if j > 2: j)"), "sum(j in i + 1..N where j > 2: j)");
}

TEST(ParsedExpressions, AUnitBelongsToTheNumberBeforeIt) {
  EXPECT_EQ(spelled("x + 3 [m]"), "x + 3 [m]");
  EXPECT_EQ(spelled("v*3.6 [s/m]"), "v*3.6 [s/m]");
  EXPECT_EQ(spelled("10 [m]/2 [s]"), "10 [m]/2 [s]");
  EXPECT_EQ(spelled("10 [m]^2"), "10 [m]^2");
}

TEST(ParsedExpressions, NumbersAloneHaveTheUnitAtTheirEndTogether) {
  EXPECT_EQ(spelled("1/2 [m]"), "1/2 [m]");
  EXPECT_EQ(spelled("(-1/2) [m]"), "-1/2 [m]");
  EXPECT_EQ(spelled("2*pi^2 [m]"), "2*pi^2 [m]");
  EXPECT_EQ(spelled("(12 + 5*20) [g]"), "12 + 5*20 [g]");
  EXPECT_EQ(spelled("2*log(15/8) + 2*log(12/10) [h]"), "2*log(15/8) + 2*log(12/10) [h]");
  EXPECT_EQ(spelled("x*(1/2 [m])"), "x*(1/2 [m])");
  EXPECT_EQ(spelled("x < (1/2) [m]"), "x < 1/2 [m]");
  EXPECT_EQ(spelled("x + (1/2) [m]"), "x + 1/2 [m]");
  EXPECT_EQ(spelled("1/(2 [m])"), "1/(2 [m])");  // a bracket keeps it
  EXPECT_EQ(spelled("not 3 [s]"), "not 3 [s]");  // a condition has no unit
  EXPECT_EQ(spelled("(1/2 [m])/3"), "(1/2 [m])/3");
  EXPECT_EQ(spelled("-(3 [m])"), "-(3 [m])");
}

TEST(ParsedExpressions, TheUnitOfNumbersAloneIsOutermost) {
  for (const char* text : {"1/2 [m]", "-3 [m]", "12 + 5*20 [g]", "2*pi^2 [m]", "sqrt(2)/3 [s]"}) {
    const auto expression = parse_expression(Source("expression", text)).expression;
    EXPECT_TRUE(std::holds_alternative<ast::Quantity>(expression.node)) << text;
  }
  for (const char* text : {"1/(2 [m])", "v*2 [s]", "10 [m]/2 [s]"}) {
    const auto expression = parse_expression(Source("expression", text)).expression;
    EXPECT_TRUE(std::holds_alternative<ast::Binary>(expression.node)) << text;
  }
}

TEST(ParsedExpressions, InsideBracketsALineMayEndBeforeAnOperator) {
  EXPECT_EQ(spelled("(a\n + b\n)"), "a + b");
  EXPECT_EQ(spelled("max(a\n, b)"), "max(a, b)");
  EXPECT_EQ(spelled("a +\n b"), "a + b");
  EXPECT_EQ(code("a\n + b"), "E110");
}

TEST(ParsedExpressions, NumbersAreWrittenBackToTheSameBits) {
  EXPECT_EQ(spelled("0.1"), "0.1");
  EXPECT_EQ(spelled("1e-10"), "1e-10");
  EXPECT_EQ(spelled("0.30000000000000004"), "0.30000000000000004");
}

TEST(ParsedExpressions, WhatIsWrittenBackReadsAsTheSame) {
  for (const char* text :
       {"-a^-b^c", "not (a and b)", "(a < b) == (c < d)", "if a then if b then c else d else e",
        "(if a then b else c)*2", "(1 [m])^2", "sum(i in 1..3: i)^2", "a - -b", "-(a*b)", "(-a)*b", "x [m]*2",
        "(a + b) [m]", "2^(3 [m])", "1/(2 [m])", "1 + (1/2 [m])", "x*(1/2 [m])", "not not a", "(not a) == b"}) {
    const std::string once = spelled(text);
    EXPECT_EQ(spelled(once), once) << text;
  }
}

TEST(ParsedExpressions, MistakesHaveTheirCodes) {
  EXPECT_EQ(code("a < b < c"), "E117");
  EXPECT_EQ(code("2x"), "E116");
  EXPECT_EQ(code("(1, 2)"), "E121");
  EXPECT_EQ(code("(1"), "E113");
  EXPECT_EQ(code("\"text\""), "E122");
  EXPECT_EQ(code("a = b"), "E110");
  EXPECT_EQ(code(""), "E110");
  EXPECT_EQ(code("a\xFF"), "E101");
}

}  // namespace
}  // namespace continuo::model
