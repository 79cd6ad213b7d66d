// Tables: values between the points, and messages that name the line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/symbolic/graph/table.hpp>

namespace continuo::model {
namespace {

constexpr auto linear = Table::Between::linear;
constexpr auto stepwise = Table::Between::step;

TEST(Table, IsALineBetweenPointsAndConstantOutside) {
  const auto read = parse_table("t,F\n0,1\n2,5\n3,5\n", "f.csv", linear);
  ASSERT_TRUE(read) << describe(read.status());
  EXPECT_EQ(read->value(-1), 1);
  EXPECT_EQ(read->value(0.5), 2);
  EXPECT_EQ(read->value(2), 5);
  EXPECT_EQ(read->value(9), 5);
  EXPECT_EQ(read->slope(1), 2);
  EXPECT_EQ(read->slope(2.5), 0);
  EXPECT_EQ(read->slope(9), 0);
}

TEST(Table, AStepHoldsFromItsPointOn) {
  const auto read = parse_table("# a pulse\n0;0\n1;10\n2;0\n", "f.csv", stepwise);
  ASSERT_TRUE(read) << describe(read.status());
  EXPECT_EQ(read->value(0.999), 0);
  EXPECT_EQ(read->value(1), 10);
  EXPECT_EQ(read->value(1.5), 10);
  EXPECT_EQ(read->value(2), 0);
}

TEST(Table, ColumnsAreFoundByName) {
  const auto read = parse_table("time a \"b\"\n0 1 2\n1 3 4\n", "f.csv", linear, "time", "b");
  ASSERT_TRUE(read) << describe(read.status());
  EXPECT_EQ(read->value(1), 4);
}

TEST(Table, SemicolonsLeaveCommasToTheNumbers) {
  const auto read = parse_table("x;y\n0,5;1,25\n1,5;2\n", "f.csv", linear);
  ASSERT_TRUE(read) << describe(read.status());
  EXPECT_EQ(read->value(0.5), 1.25);
  EXPECT_EQ(read->value(1), 1.625);
  const auto problem = [](const char* text) { return describe(parse_table(text, "f.csv", linear).status()); };
  EXPECT_EQ(problem("x;y\n0,5;1\n1.5;2\n"),
            "f.csv:3: `1.5` and line 2 have different decimal signs, a point and a comma");
  EXPECT_EQ(problem("0,1,2\n1,2,3\n"), "f.csv:1: 3 columns, but a table has two: which ones are meant, nobody knows");
}

TEST(Table, WrongFilesAreNamedByLine) {
  const auto problem = [](const char* text) { return describe(parse_table(text, "f.csv", linear).status()); };
  EXPECT_EQ(problem("t,y\n0,1\n3,1\n2,1\n"), "f.csv:4: 2 comes after 3: t must increase");
  EXPECT_EQ(problem("0,1\n1,x\n"), "f.csv:2: `x` is not a number");
  EXPECT_EQ(problem("0,1\n1\n"), "f.csv:2: 1 columns, but column 2 is needed");
  EXPECT_EQ(problem("0,1\n1,inf\n"), "f.csv:2: a number is not finite");
  EXPECT_EQ(problem(""), "f.csv:1: no numbers here");
  EXPECT_TRUE(parse_table("0,1\r\n1,2\r\n", "f.csv", linear));
  EXPECT_EQ(describe(parse_table("t,y\n0,1\n", "f.csv", linear, "t", "z").status()),
            "f.csv:1: no column `z`; there are: t, y");
  EXPECT_THAT(describe(read_table("does/not/exist.csv", linear).status()),
              testing::HasSubstr("exist.csv:1: the file cannot"));
}

}  // namespace
}  // namespace continuo::model
