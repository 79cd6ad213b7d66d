#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <continuo/results/measurements.hpp>

namespace continuo::results::measurements_test {
namespace {

TEST(Measurements, AreReadWithGapsAndInAnyOrder) {
  const Result<Measurements> read = parse_measurements("# a comment\nx, t ,y\n1,0.5,\n,0,3\n\n2,1,NA\n", "a.csv");
  ASSERT_TRUE(read) << read.status().message;
  const Measurements& data = *read;
  EXPECT_EQ(data.columns, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(data.times, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(data.lines, (std::vector<std::size_t>{4, 3, 6}));
  EXPECT_TRUE(std::isnan(data.values[0][0]));
  EXPECT_EQ(data.values[0][1], 1);
  EXPECT_EQ(data.values[1][0], 3);
  EXPECT_TRUE(std::isnan(data.values[1][1]));
  EXPECT_TRUE(std::isnan(data.values[1][2]));
}

TEST(Measurements, TakeTheFirstColumnAsTimeWhereNoneIsCalledT) {
  EXPECT_EQ(parse_measurements("seconds;x\n1;2\n", "a.csv")->columns, std::vector<std::string>{"x"});
}

TEST(Measurements, SayFileAndLineOfWhatIsWrong) {
  const auto problem = [](const char* text) { return parse_measurements(text, "a.csv").status().message; };
  EXPECT_EQ(problem(""), "a.csv:1: the file is empty");
  EXPECT_EQ(problem("t,x\n"), "a.csv:1: no rows of numbers below the names of the columns");
  EXPECT_EQ(problem("0,1\n"), "a.csv:1: the first line must name the columns, like `t,x`");
  EXPECT_EQ(problem("t\n0\n"), "a.csv:1: one column only; a time and at least one quantity are needed");
  EXPECT_EQ(problem("t,x,x\n"), "a.csv:1: two columns are called `x`");
  EXPECT_EQ(problem("t,x\n0,1\n1,abc\n"), "a.csv:3: `abc` in column `x` is no number");
  EXPECT_EQ(problem("t,x\n,1\n"), "a.csv:2: no time in column `t`");
  EXPECT_EQ(problem("t,x\n0,1,2\n"),
            "a.csv:2: 3 cells under 2 names of columns; numbers with decimal commas need semicolons between the cells");
  EXPECT_EQ(problem("t;x\n0;1;2\n"), "a.csv:2: 3 cells under 2 names of columns");
  const Status status = read_measurements("/no/such.csv").status();
  EXPECT_EQ(status.ending, Ending::unreadable);
  EXPECT_EQ(status.message, "/no/such.csv:1: the file cannot be read");
}

TEST(Measurements, WithDecimalCommasAreReadAndSaidToBe) {
  const auto read = parse_measurements("t;x;y\r\n0,5;-1,25;\r\n1;2e-1;\"3,5\"\r\n", "a.csv");
  ASSERT_TRUE(read) << read.status().message;
  EXPECT_TRUE(read->has_decimal_commas);
  EXPECT_EQ(read->times, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(read->values[0], (std::vector<double>{-1.25, 0.2}));
  EXPECT_TRUE(std::isnan(read->values[1][0]));  // not the half of a number
  EXPECT_EQ(read->values[1][1], 3.5);
  EXPECT_EQ(parse_measurements("t\tx\n0,5\t1,5\n", "a.csv")->values[0][0], 1.5);
  EXPECT_EQ(parse_measurements("t x\n0,5 1,5\n", "a.csv")->values[0][0], 1.5);
  EXPECT_FALSE(parse_measurements("t;x\n0.5;1.5\n", "a.csv")->has_decimal_commas);
  EXPECT_FALSE(parse_measurements("t,x\n0,1\n", "a.csv")->has_decimal_commas);
}

// What one country writes for three halves is fifteen hundred in another.
TEST(Measurements, OfTwoDecimalSignsOneIsWrong) {
  const auto problem = [](const char* text) { return parse_measurements(text, "a.csv").status().message; };
  EXPECT_EQ(problem("t;x\n0;1,5\n1;1.5\n"),
            "a.csv:3: `1.5` in column `x` has a decimal point, but line 2 has a decimal comma");
  EXPECT_EQ(problem("t;x\n0;1.234,5\n"), "a.csv:2: `1.234,5` in column `x` is no number");
  EXPECT_EQ(problem("t,x\n0,\"1,234\"\n"), "a.csv:2: `1,234` in column `x` is no number");
}

TEST(Measurements, EveryBadCellIsNamedByItsPlace) {
  const auto problem = [](const std::string& text) { return parse_measurements(text, "a.csv").status().message; };
  EXPECT_EQ(problem("t,x,y\n0,one,1\n1,2,2,\nx,3,-\n"),
            "a.csv:2: `one` in column `x` is no number\n"
            "a.csv:4: `x` in column `t` is no number\n"
            "a.csv:4: `-` in column `y` is no number");
  std::string many = "t,x\n";
  for (int i = 0; i < 25; ++i) many += std::to_string(i) + ",bad\n";
  EXPECT_NE(problem(many).find("a.csv:11: `bad` in column `x` is no number\nand 15 more cells"), std::string::npos);
}

}  // namespace
}  // namespace continuo::results::measurements_test
