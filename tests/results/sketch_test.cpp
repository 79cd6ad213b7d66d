// A panel in characters: what stands where, and how wide it is.
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/results/sketch.hpp>

namespace continuo::results::sketch_test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}
std::size_t width_of(const std::string& line) {
  std::size_t width = 0;
  for (const char c : line) width += (c & 0xC0) != 0x80 ? 1 : 0;
  return width;
}

Panel rising() {
  return {.x_label = "t [s]", .y_label = "x [m]", .curves = {{.label = "x", .x = {0, 10}, .y = {0, 100}}}};
}

TEST(Sketch, ALineRisesFromTheLowerLeftCornerToTheUpperRightOne) {
  const std::vector<std::string> lines = lines_of(sketch(rising(), {.columns = 40, .rows = 10}));
  ASSERT_EQ(lines.size(), 10U);
  EXPECT_THAT(lines[0], HasSubstr("x [m]"));
  EXPECT_THAT(lines[1], HasSubstr("100│"));
  EXPECT_EQ(lines[1].substr(lines[1].size() - 3), "⠉") << lines[1];
  EXPECT_THAT(lines[7], HasSubstr("0│⣀")) << lines[7];
  EXPECT_THAT(lines[9], HasSubstr("t [s]"));
  EXPECT_THAT(lines[9], HasSubstr("10"));
}

TEST(Sketch, NoLineIsWiderThanTheTerminal) {
  Panel panel = rising();
  for (int i = 0; i < 30; ++i)
    panel.curves.push_back({.label = "a long name " + std::to_string(i), .x = {-1e-300, 1e300}, .y = {NAN, -1e12}});
  for (const std::size_t columns : {30U, 41U, 80U, 100U})
    for (const std::string& line : lines_of(sketch(panel, {.columns = columns, .rows = 12})))
      EXPECT_LE(width_of(line), columns) << line;
}

TEST(Sketch, AConstantAndNothingAtAllAreNoMishap) {
  for (const std::vector<double>& y : {std::vector<double>{2, 2}, {NAN, NAN}, {INFINITY, -INFINITY}, {}}) {
    Panel panel = rising();
    panel.curves.front().y = y;
    if (y.empty()) panel.curves.front().x.clear();
    EXPECT_EQ(lines_of(sketch(panel, {.columns = 40, .rows = 10})).size(), 10U);
  }
}

TEST(Sketch, ColoursAreThereOnlyWhereTheyAreWanted) {
  EXPECT_THAT(sketch(rising(), {.color = true}), HasSubstr("\033["));
  EXPECT_THAT(sketch(rising(), {}), Not(HasSubstr("\033[")));
}

}  // namespace
}  // namespace continuo::results::sketch_test
