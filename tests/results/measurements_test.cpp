#include <cmath>

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
  EXPECT_EQ(problem("t,x\n0,1,2\n"), "a.csv:2: 3 cells under 2 names of columns");
  const Status status = read_measurements("/no/such.csv").status();
  EXPECT_EQ(status.ending, Ending::unreadable);
  EXPECT_EQ(status.message, "/no/such.csv:1: the file cannot be read");
}

}  // namespace
}  // namespace continuo::results::measurements_test
