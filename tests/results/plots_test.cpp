#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "example.hpp"
#include <continuo/results/plots.hpp>

namespace continuo::results {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

PlotRequest both_states(const Record& record) {
  return default_plots(record).front();
}

TEST(Plots, CurvesOfOneUnitShareAPanelOthersDoNot) {
  Record record = falling_ball();
  EXPECT_THAT(figure_of(record, {both_states(record)}, {}).panels, SizeIs(2));
  record.motion.columns[2].unit = "m";
  EXPECT_THAT(figure_of(record, {both_states(record)}, {}).panels, SizeIs(1));
}

TEST(Plots, LabelsNameCurvesAndUnits) {
  const Record record = falling_ball();
  const Figure figure = figure_of(record, {both_states(record)}, {});
  EXPECT_EQ(figure.panels[0].y_label, "h [m]");
  EXPECT_EQ(figure.panels[1].y_label, "h' [m/s]");
  EXPECT_EQ(figure.panels[0].x_label, "t [s]");
}

TEST(Plots, TheEnergyDriftHasAPanelOfItsOwn) {
  const Record record = falling_ball();
  const Figure figure = figure_of(record, {both_states(record)}, {2, 2, 2, 0.5});
  ASSERT_THAT(figure.panels, SizeIs(3));
  EXPECT_EQ(figure.panels[2].curves[0].y, (std::vector<double>{0, 0, 0, -0.75}));
}

TEST(Plots, EventsAreMarkedOnceEach) {
  const Record record = falling_ball();
  const Figure figure = figure_of(record, {both_states(record)}, {});
  EXPECT_EQ(figure.panels[0].marks, std::vector<double>{1});
  EXPECT_THAT(gnuplot_script(figure, "x.svg"), HasSubstr("set arrow from first 1,"));
}

TEST(Plots, AnOrbitKeepsItsShape) {
  const Record record = falling_ball();
  PlotRequest orbit{.against = {"x", "m"}, .x = {0, 1, 0, -1}, .curves = {{"y", "m"}}, .y = {{1, 0, -1, 0}}};
  orbit.against_time = false;
  EXPECT_TRUE(figure_of(record, {orbit}, {}).panels[0].equal_scale);
  orbit.against.unit = "rad";
  EXPECT_FALSE(figure_of(record, {orbit}, {}).panels[0].equal_scale);
}

TEST(Plots, NamesAreTextNeverMarkupOrCommands) {
  Record record = falling_ball();
  record.setup.model = "it's_a ^ball'; system 'false";
  const std::string script = gnuplot_script(figure_of(record, {both_states(record)}, {}), "it's.svg");
  EXPECT_THAT(script, HasSubstr("noenhanced"));
  EXPECT_THAT(script, HasSubstr("'it''s_a ^ball''; system ''false'"));
  EXPECT_THAT(script, HasSubstr("set output 'it''s.svg'"));
}

TEST(Plots, AMillionPointsAreDrawnFromAFewThousandAndEveryPeakStays) {
  Curve curve{.label = "x", .x = {}, .y = {}};
  for (int i = 0; i < 1000000; ++i) {
    curve.x.push_back(i);
    curve.y.push_back(i == 654321 ? 5 : std::sin(0.01 * i));
  }
  const Curve few = thinned(curve, 1000);
  EXPECT_LE(few.x.size(), 4004u);
  EXPECT_EQ(*std::ranges::max_element(few.y), 5);
  EXPECT_EQ(few.x.front(), 0);
  EXPECT_EQ(few.x.back(), 999999);
}

TEST(Plots, AnUnknownEndingAndAMissingFolderAreMessages) {
  const Record record = falling_ball();
  const Figure figure = figure_of(record, {both_states(record)}, {});
  EXPECT_THAT(draw(figure, "ball.pdf").value_or(""), HasSubstr("ends in .svg or .png"));
  EXPECT_THAT(draw(figure, "/no such folder/ball.svg").value_or(""), HasSubstr("No such file or directory"));
}

TEST(Plots, WithoutGnuplotTheMessageSaysWhatToInstall) {
  const Folder folder;
  const Record record = falling_ball();
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path.c_str(), 1);
  const auto failure = draw(figure_of(record, {both_states(record)}, {}), folder / "ball.svg");
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(failure.value_or(""), HasSubstr("apt-get install gnuplot-nox"));
}

TEST(Plots, BothFormatsAreDrawn) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
  const Folder folder;
  const Record record = falling_ball();
  const Figure figure = figure_of(record, {both_states(record)}, {2, 2, 2, 0.5});
  ASSERT_EQ(draw(figure, folder / "ball.svg").value_or(""), "");
  ASSERT_EQ(draw(figure, folder / "ball.png").value_or(""), "");
  EXPECT_THAT(content(folder / "ball.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(content(folder / "ball.svg"), HasSubstr("energy drift, relative"));
  EXPECT_EQ(content(folder / "ball.png").substr(1, 3), "PNG");
}

}  // namespace
}  // namespace continuo::results
