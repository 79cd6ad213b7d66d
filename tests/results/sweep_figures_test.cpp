#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/results/sweep_figures.hpp>

namespace continuo::results {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

FanChart fan_chart() {
  return {.x_label = "t [s]",
          .label = "x [m]",
          .x = {0, 1, 2},
          .parts = {0.05, 0.25, 0.5, 0.75, 0.95},
          .quantiles = {{1, 2, 3}, {2, 3, 4}, {3, 4, 5}, {4, 5, 6}, {5, 6, 7}}};
}

TEST(FanPanel, HasABandForEachPairOfQuantilesAndTheMedian) {
  const Panel panel = fan_panel(fan_chart());
  ASSERT_THAT(panel.curves, SizeIs(4));
  EXPECT_EQ(panel.curves[0].label, "5 % to 95 %");  // below and above the next one
  EXPECT_THAT(panel.curves[0].y, ElementsAre(1, 2, 3, 4, 3, 2));
  EXPECT_EQ(panel.curves[1].label, "");
  EXPECT_THAT(panel.curves[1].y, ElementsAre(4, 5, 6, 7, 6, 5));
  EXPECT_EQ(panel.curves[2].label, "25 % to 75 %");
  EXPECT_THAT(panel.curves[2].y, ElementsAre(2, 3, 4, 6, 5, 4));
  EXPECT_GT(panel.curves[2].fill, panel.curves[0].fill);
  EXPECT_EQ(panel.curves[3].label, "median");
}

TEST(FanPanel, BreaksWhereNoRunHasAValue) {
  FanChart fan = fan_chart();
  for (auto& row : fan.quantiles) row[1] = NAN;
  fan.parts = {0.1, 0.9}, fan.quantiles = {fan.quantiles[0], fan.quantiles[4]};
  const Panel panel = fan_panel(fan);
  ASSERT_THAT(panel.curves, SizeIs(2));
  EXPECT_EQ(panel.curves[0].label, "10 % to 90 %");
  EXPECT_THAT(panel.curves[0].x, ElementsAre(0, 0));
  EXPECT_EQ(panel.curves[1].label, "");  // named once
  EXPECT_THAT(panel.curves[1].y, ElementsAre(3, 7));
}

TEST(HeatPanel, CellsReachHalfwayToTheirNeighbours) {
  const Panel panel = heat_panel({.x_label = "k",
                                  .y_label = "c",
                                  .label = "peak [m]",
                                  .x = {1, 2, 4},
                                  .y = {1, 100},
                                  .values = {1, 2, 3, 4, NAN, 6},
                                  .logarithmic_y = true});
  EXPECT_THAT(panel.cells.x_edges, ElementsAre(0.5, 1.5, 3, 5));
  ASSERT_THAT(panel.cells.y_edges, SizeIs(3));
  EXPECT_NEAR(panel.cells.y_edges[0], 0.1, 1e-12);
  EXPECT_NEAR(panel.cells.y_edges[1], 10, 1e-12);
  const std::string script = gnuplot_script({.title = "", .panels = {panel}}, "x.svg");
  EXPECT_THAT(script, HasSubstr("set cblabel \"peak [m]\""));
  EXPECT_THAT(script, HasSubstr("set cbrange [1:6]"));
  EXPECT_THAT(script, HasSubstr("title 'no value'"));
  EXPECT_THAT(script, HasSubstr("set logscale y"));
}

TEST(HeatPanel, AFineGridIsThinned) {
  HeatMap map{.x_label = "", .y_label = "", .label = "", .x = {}, .y = {0, 1}, .values = {}};
  for (int i = 0; i < 2000; ++i) map.x.push_back(i), map.values.push_back(i);
  map.values.insert(map.values.end(), map.values.begin(), map.values.end());
  const Panel panel = heat_panel(map);
  EXPECT_LT(panel.cells.values.size(), 600u);
  EXPECT_EQ(panel.cells.values.size(), 2 * (panel.cells.x_edges.size() - 1));
  EXPECT_LT(panel.cells.values.front(), 10);
  EXPECT_GT(panel.cells.values.back(), 1990);
}

TEST(BarPanel, BarsOfOneNameStandSideBySide) {
  const Panel panel =
      bar_panel("part", {"k", "c"},
                {{"first order", {{0.5, {0.4, 0.6}}, {-0.1, {-0.3, 0.1}}}}, {"total", {{0.7, {}}, {0.2, {}}}}});
  ASSERT_THAT(panel.curves, SizeIs(2));
  EXPECT_NEAR(panel.curves[0].x[0], -0.2, 1e-12);
  EXPECT_NEAR(panel.curves[1].x[1], 1.2, 1e-12);
  EXPECT_LT(panel.curves[0].bar_width, 0.4);
  const std::string script = gnuplot_script({.title = "", .panels = {panel}}, "x.svg");
  EXPECT_THAT(script, HasSubstr("(\"k\" 0, \"c\" 1)"));
  EXPECT_THAT(script, HasSubstr("set yrange [-0.35:0.75]"));  // the interval below, and 5 % more on each side
}

TEST(ScatterPanel, OfManyRunsShowsSome) {
  std::vector<double> x(100'000), y(100'000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i), y[i] = -x[i];
  const Panel panel = scatter_panel("k", "peak", x, y);
  EXPECT_LE(panel.curves[0].x.size(), 20'000u);
  EXPECT_GE(panel.curves[0].x.size(), 10'000u);
  EXPECT_EQ(panel.curves[0].y.back(), -panel.curves[0].x.back());
  EXPECT_THAT(scatter_panel("k", "peak", {1, 2}, {3, 4}).curves[0].x, ElementsAre(1, 2));
}

TEST(SweepFigures, AreDrawnLightAndDark) {
  const auto file = std::filesystem::path(testing::TempDir()) / "continuo_sweep_figures.svg";
  const HeatMap nothing{.x_label = "k", .y_label = "c", .label = "x", .x = {1}, .y = {0}, .values = {NAN}};
  const HeatMap constant{.x_label = "k", .y_label = "c", .label = "x", .x = {1, 2}, .y = {0}, .values = {3, 3}};
  for (const bool is_dark : {false, true}) {
    const Figure figure{.title = "Spring",
                        .panels = {fan_panel(fan_chart()), heat_panel(nothing), heat_panel(constant),
                                   bar_panel("part", {"k"}, {{"total", {{0.5, {NAN, NAN}}}}}),
                                   scatter_panel("k", "peak", {1, NAN}, {2, 3})},
                        .is_dark = is_dark};
    const Status status = draw(figure, file.string());
    EXPECT_TRUE(status) << status.message;
    EXPECT_GT(std::filesystem::file_size(file), 4000u);
    EXPECT_EQ(gnuplot_script(figure, "x.svg").find("background '#16181d'") != std::string::npos, is_dark);
    EXPECT_EQ(gnuplot_script(figure, "x.png").find("background '#16181d'") != std::string::npos, is_dark);
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace continuo::results
