#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "example.hpp"
#include <continuo/results/method_colors.hpp>
#include <continuo/results/plots.hpp>

namespace continuo::results {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

PlotData both_states(const model::Run& run) {
  PlotData plot{.against = run.motion.columns[0],
                .x = {},
                .curves = {run.motion.columns[1], run.motion.columns[2]},
                .y = {{}, {}}};
  for (std::size_t i = 0; i < run.motion.rows(); ++i) {
    plot.x.push_back(run.motion.row(i)[0]);
    for (std::size_t c = 0; c < 2; ++c) plot.y[c].push_back(run.motion.row(i)[1 + c]);
  }
  return plot;
}

/// Both states of the falling ball, without the panel of the energy.
Figure states_figure(model::Run run, const std::string& title = "Ball") {
  run.total_energy.clear();
  const PlotData plot = both_states(run);
  return figure_of(title, run, std::span(&plot, 1));
}

TEST(Plots, CurvesOfOneUnitShareAPanelOthersDoNot) {
  model::Run run = falling_ball().run;
  EXPECT_THAT(states_figure(run).panels, SizeIs(2));
  run.motion.columns[2].unit = "m";
  EXPECT_THAT(states_figure(run).panels, SizeIs(1));
}

TEST(Plots, LabelsNameCurvesAndUnits) {
  const Figure figure = states_figure(falling_ball().run);
  EXPECT_EQ(figure.panels[0].y_label, "h [m]");
  EXPECT_EQ(figure.panels[1].y_label, "h' [m/s]");
  EXPECT_EQ(figure.panels[0].x_label, "t [s]");
}

TEST(Plots, TheEnergyDriftHasAPanelOfItsOwn) {
  const model::Run run = falling_ball().run;
  const PlotData plot = both_states(run);
  const Figure figure = figure_of("Ball", run, std::span(&plot, 1));
  ASSERT_THAT(figure.panels, SizeIs(3));
  EXPECT_EQ(figure.panels[2].curves[0].y, (std::vector<double>{0, 0, 0, -0.75}));
}

TEST(Plots, EventsAreMarkedOnceEach) {
  const Figure figure = states_figure(falling_ball().run);
  EXPECT_EQ(figure.panels[0].marks, std::vector<double>{1});
  EXPECT_THAT(gnuplot_script(figure, "x.svg"), HasSubstr("set arrow from first 1,"));
}

TEST(Plots, ThousandsOfEventsDoNotPaintTheBackground) {
  model::Run run = falling_ball().run;
  const model::RecordedEvent event = run.events.front();
  run.events.clear();
  for (int i = 0; i < 5000; ++i) {
    run.events.push_back(event);
    run.events.back().t = i / 5000.0;
  }
  const std::string script = gnuplot_script(states_figure(run), "x.svg");
  EXPECT_THAT(script, HasSubstr("graph 0.04 nohead"));
  EXPECT_THAT(script, Not(HasSubstr("graph 1 nohead")));
}

TEST(Plots, AnAxisMagnifiesNothingSmallerThanItIsTold) {
  Figure figure{.title = "", .panels = {{.x_label = "", .y_label = "", .curves = {{"E", {0, 1}, {10, 10 + 1e-9}}}}}};
  figure.panels.front().least_height = 0.5;
  EXPECT_THAT(gnuplot_script(figure, "x.svg"), HasSubstr("set yrange [9.75"));
  figure.panels.front().least_height = 0;
  EXPECT_THAT(gnuplot_script(figure, "x.svg"), HasSubstr("set yrange [9.99999"));
}

TEST(Plots, TheSizeOfAFileIsTheOneThatIsNamed) {
  Figure figure = states_figure(falling_ball().run);
  EXPECT_THAT(gnuplot_script(figure, "x.png"), HasSubstr("size 1920,"));
  figure.size = {400, 300};
  EXPECT_THAT(gnuplot_script(figure, "x.svg"), HasSubstr("size 400,300"));
  EXPECT_THAT(gnuplot_script(figure, "x.png"), HasSubstr("size 400,300"));
  EXPECT_THAT(gnuplot_script(figure, "x.pdf"), HasSubstr("size 4.1667in,3.1250in"));
}

TEST(Plots, AQuantityHasOneColourInAllPanels) {
  const model::Run run = falling_ball().run;
  const std::vector<PlotData> plots = {both_states(run), both_states(run)};
  const Figure figure = figure_of("Ball", run, plots);
  for (const Panel& panel : figure.panels)
    for (const Curve& curve : panel.curves) {
      if (curve.label == "h") {
        EXPECT_EQ(curve.number, 0U);
      }
      if (curve.label == "h'") {
        EXPECT_EQ(curve.number, 1U);
      }
    }
}

TEST(Plots, AMethodHasOneColourWhicheverOthersAreThere) {
  using Names = std::vector<std::string>;
  const auto alone = colors_of_methods(Names{"rk4"}), among = colors_of_methods(Names{"heun", "euler", "rk4"});
  EXPECT_EQ(alone[0], among[2]);
  EXPECT_EQ(colors_of_methods(Names{"explicit_euler"})[0], among[1]);
  const auto twice = colors_of_methods(Names{"rk4", "rk4"});
  EXPECT_NE(twice[0], twice[1]);
  EXPECT_EQ(color_of(twice[0]), color_of(twice[1]));
}

TEST(Plots, RowsByDecadesGetALogarithmicTime) {
  model::Run run = falling_ball().run;
  run.plan.output = model::OutputPlan::Kind::logarithmic;
  const PlotData plot = both_states(run);
  Figure figure = figure_of("Ball", run, std::span(&plot, 1));
  for (const Panel& panel : figure.panels) EXPECT_TRUE(panel.logarithmic_x);
  // The first row, at t = 0, has no place; nor has a mark there.
  figure.panels.front().curves.front().x = {0, 0.01, 1, 100};
  figure.panels.front().marks = {0, 0.5};
  figure.panels.resize(1);
  const std::string script = gnuplot_script(figure, "x.svg");
  EXPECT_THAT(script, HasSubstr("\nset logscale x"));
  EXPECT_THAT(script, HasSubstr("set xrange [0.01:100]"));
  EXPECT_THAT(script, HasSubstr("set arrow from first 0.5,"));
  EXPECT_THAT(script, Not(HasSubstr("set arrow from first 0,")));
  run.plan.output = model::OutputPlan::Kind::every;
  EXPECT_THAT(gnuplot_script(figure_of("Ball", run, std::span(&plot, 1)), "x.svg"), Not(HasSubstr("\nset logscale x")));
}

TEST(Plots, AnOrbitKeepsItsShape) {
  model::Run run = falling_ball().run;
  run.total_energy.clear();
  PlotData orbit{.against = {"x", "m"}, .x = {0, 1, 0, -1}, .curves = {{"y", "m"}}, .y = {{1, 0, -1, 0}}};
  orbit.against_time = false;
  EXPECT_TRUE(figure_of("Orbit", run, std::span(&orbit, 1)).panels[0].equal_scale);
  orbit.against.unit = "rad";
  EXPECT_FALSE(figure_of("Orbit", run, std::span(&orbit, 1)).panels[0].equal_scale);
}

TEST(Plots, NamesAreTextNeverMarkupOrCommands) {
  const Figure figure = states_figure(falling_ball().run, "it's_a ^ball\"; system \"false\"; `false`");
  const std::string script = gnuplot_script(figure, "it's.svg");
  EXPECT_THAT(script, HasSubstr("noenhanced"));
  EXPECT_THAT(script, HasSubstr(R"("it's_a ^ball\042; system \042false\042; \140false\140")"));
  EXPECT_THAT(script, HasSubstr("set output \"it's.svg\""));
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
  const Figure figure = states_figure(falling_ball().run);
  EXPECT_THAT(draw(figure, "ball.gif").message, HasSubstr("ends in .svg, .png or .pdf"));
  EXPECT_THAT(draw(figure, "/no such folder/ball.svg").message, HasSubstr("No such file or directory"));
}

TEST(Plots, WithoutGnuplotTheMessageSaysWhatToInstall) {
  const Folder folder;
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path.c_str(), 1);
  const Status status = draw(states_figure(falling_ball().run), folder / "ball.svg");
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(status.message, HasSubstr("apt-get install gnuplot-nox"));
}

// A bare machine has no locale but C, in which gnuplot warns of the script's UTF-8.
TEST(Plots, InTheLocaleCNothingIsSaidOfUtf8) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
  const Folder folder;
  const char* const before = std::getenv("LC_ALL");
  const std::string locale = before == nullptr ? "" : before;
  setenv("LC_ALL", "C", 1);
  testing::internal::CaptureStderr();
  const Status status = draw(states_figure(falling_ball().run), folder / "ball.svg");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(status) << status.message;
  if (before == nullptr) {
    unsetenv("LC_ALL");
  } else {
    setenv("LC_ALL", locale.c_str(), 1);
  }
}

TEST(Plots, BothFormatsAreDrawn) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
  const Folder folder;
  const model::Run run = falling_ball().run;
  const PlotData plot = both_states(run);
  const Figure figure = figure_of("Ball", run, std::span(&plot, 1));
  ASSERT_TRUE(draw(figure, folder / "ball.svg"));
  ASSERT_TRUE(draw(figure, folder / "ball.png"));
  EXPECT_THAT(content(folder / "ball.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(content(folder / "ball.svg"), HasSubstr("energy drift, relative"));
  EXPECT_EQ(content(folder / "ball.png").substr(1, 3), "PNG");
}

/// Half the sum of x_i y_(i+1) - x_(i+1) y_i.
double area_of(const Curve& path) {
  double sum = 0;
  for (std::size_t i = 0; i < path.x.size(); ++i) {
    const std::size_t next = i + 1 == path.x.size() ? 0 : i + 1;
    sum += path.x[i] * path.y[next] - path.x[next] * path.y[i];
  }
  return sum / 2;
}

TEST(Plots, AClosedPathIsCutToTheFrame) {
  const Curve square{.label = "", .x = {-1, 3, 3, -1}, .y = {-1, -1, 3, 3}};
  EXPECT_DOUBLE_EQ(area_of(clipped(square, {0, 2}, {0, 1})), 2);
  EXPECT_DOUBLE_EQ(area_of(clipped(square, {-9, 9}, {-9, 9})), 16);
  EXPECT_DOUBLE_EQ(area_of(clipped(square, {4, 5}, {4, 5})), 0);
  // The square without the middle of it, by a bridge from its corner: 16 - 1, of which the frame keeps a quarter.
  const Curve ring{
      .label = "", .x = {-1, 3, 3, -1, -1, 0.5, 0.5, 1.5, 1.5, 0.5}, .y = {-1, -1, 3, 3, -1, 0.5, 1.5, 1.5, 0.5, 0.5}};
  EXPECT_DOUBLE_EQ(area_of(clipped(ring, {1, 9}, {1, 9})), 15.0 / 4);
}

TEST(Plots, AnAreaThatGoesOnForeverLeavesTheAxesToTheOthers) {
  const Figure figure{.title = "",
                      .panels = {{.x_label = "",
                                  .y_label = "",
                                  .curves = {{.label = "line", .x = {0, 1}, .y = {0, 1}},
                                             {.label = "",
                                              .x = {-9, 9, 9},
                                              .y = {-9, -9, 9},
                                              .color = "#0072b2",
                                              .style = Curve::Style::area,
                                              .widens_axes = false}}}}};
  const std::string script = gnuplot_script(figure, "x.svg");
  EXPECT_THAT(script, HasSubstr("set xrange [0:1]"));
  EXPECT_THAT(script, HasSubstr("filledcurves closed"));
  EXPECT_THAT(script, Not(HasSubstr("\n9 ")));  // it is cut to them
}

// gnuplot warns on standard error of an axis without extent, and fails where a panel has no point.
TEST(Plots, WhatHasNoExtentIsDrawnWithoutAWord) {
  constexpr double huge = 1.7e308, tiny = 4e-324;
  const std::vector<std::vector<double>> values = {{3, 3},        {0, 0},       {-5, -5},    {1, 1 + 4e-16},
                                                   {7},           {NAN, NAN},   {NAN, 2},    {},
                                                   {huge, -huge}, {huge, huge}, {tiny, tiny}};
  Figure figure{.title = "", .panels = {}};
  for (const auto& y : values) {
    std::vector<double> x(y.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i + 1);
    for (const bool is_logarithmic : {false, true}) {
      const Panel panel{.x_label = "",
                        .y_label = "",
                        .curves = {{.label = "it", .x = x, .y = y}},
                        .logarithmic_x = is_logarithmic,
                        .logarithmic_y = is_logarithmic};
      Panel other = panel, turned = panel;
      std::swap(turned.curves[0].x, turned.curves[0].y);
      other.curves.push_back({.label = "another", .x = {0, 1}, .y = {0, 1}});
      figure.panels.insert(figure.panels.end(), {panel, turned, other});
    }
  }
  const std::string path = testing::TempDir() + "no_extent.svg";
  testing::internal::CaptureStderr();
  const Status status = draw(figure, path);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(status) << status.message;
  std::filesystem::remove(path);
}

TEST(Plots, SmallTicksStandBetweenFewDecadesOnly) {
  const auto script = [](double least) {
    return gnuplot_script({.title = "",
                           .panels = {{.x_label = "",
                                       .y_label = "",
                                       .curves = {{.label = "", .x = {1, 10}, .y = {least, 1}}},
                                       .logarithmic_y = true}}},
                          "x.svg");
  };
  EXPECT_THAT(script(1e-3), HasSubstr("set mytics default"));
  EXPECT_THAT(script(1e-12), HasSubstr("set mytics 1"));
}

}  // namespace
}  // namespace continuo::results
