// The picture of a world at the end of a run, from rows made by hand.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "example.hpp"
#include <continuo/language/load.hpp>
#include <continuo/language/world.hpp>
#include <continuo/results/bodies_panel.hpp>

namespace continuo::results::bodies_panel_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

model::Model model_of(const std::string& text) {
  model::Loaded loaded = model::load(model::Source("model.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return std::move(loaded.model).value();
}

/// Two rows: the start, and the same with every place along the first axis greater by 1.
model::Run moved_by_one(const model::Model& model) {
  model::Run run;
  run.plan.variables = start_values(model);
  run.motion.states = model.states.size();
  run.motion.columns = {{"t", "s"}};
  for (const model::State& state : model.states) run.motion.columns.push_back({state.column, state.unit});
  for (const double row : {0.0, 1.0}) {
    run.motion.values.push_back(row);
    const std::size_t first = run.motion.values.size();
    for (std::size_t k = 0; k < model.states.size(); ++k)
      run.motion.values.push_back(
          k < model.world->body_states() ? evaluate(model, model.states[k].initial, run.plan.variables) : 0);
    for (const model::BodyDescription& body : model.world->bodies) run.motion.values[first + body.first_state] += row;
  }
  return run;
}

const Curve& discs_of(const Panel& panel) {
  for (const Curve& curve : panel.curves)
    if (curve.style == Curve::Style::discs) return curve;
  ADD_FAILURE() << "no discs";
  return panel.curves.front();
}

// A box of 2 by 4, turned by a right angle and moved by 1, is 4 wide and 2 high; the ball beside it is a disc.
TEST(BodiesPanel, ShowsBoxesAsTheyStand) {
  const model::Model model = model_of(
      "world { body crate at (0, 1) [m] box (2, 4) angle 90 [deg]\nbody ball at (5, 1) radius 0.5 fixed }\nrun 0..1\n");
  const Panel panel = bodies_panel(model, moved_by_one(model));
  const auto area = std::ranges::find(panel.curves, Curve::Style::area, &Curve::style);
  ASSERT_NE(area, panel.curves.end());
  std::vector<double> x, y;
  for (std::size_t i = 0; i < 4; ++i) x.push_back(area->x[i]), y.push_back(area->y[i]);
  EXPECT_NEAR(std::ranges::min(x), -1, 1e-12);
  EXPECT_NEAR(std::ranges::max(x), 3, 1e-12);
  EXPECT_NEAR(std::ranges::min(y), 0, 1e-12);
  EXPECT_NEAR(std::ranges::max(y), 2, 1e-12);
  EXPECT_EQ(discs_of(panel).discs.size(), 1U);
}

// Of a cube in space three faces are seen.
TEST(BodiesPanel, ShowsTheFacesOfACubeThatLookAtUs) {
  const model::Model model = model_of("world { dimension 3\nbody crate at (0, 0, 0) box (2, 2, 2) }\nrun 0..1\n");
  const Panel panel = bodies_panel(model, moved_by_one(model));
  const auto area = std::ranges::find(panel.curves, Curve::Style::area, &Curve::style);
  ASSERT_NE(area, panel.curves.end());
  EXPECT_EQ(std::ranges::count_if(area->x, [](double x) { return std::isnan(x); }), 3);
  EXPECT_EQ(area->x.size(), 3U * 6);
}

TEST(BodiesPanel, ShowsBodiesAsLargeAsTheyAreAndTheirWays) {
  const model::Model model = model_of(
      "world { wall floor (0, 2) at 3\nwall (1, 1) at -1000\nbody ball at (1, 2) [m] radius 0.5\n"
      "bodies peg grid 2 from (4, 2) spacing (2, 0) radius 0.25 fixed\nbody other at (3, 5) radius 1 }\nrun 0..1 "
      "[s]\n");
  const Panel panel = bodies_panel(model, moved_by_one(model));
  EXPECT_TRUE(panel.equal_scale);
  EXPECT_EQ(panel.x_label, "x [m], at t = 1 s");
  const Curve& discs = discs_of(panel);
  EXPECT_THAT(discs.x, ElementsAre(2, 5, 7, 4));
  EXPECT_THAT(discs.y, ElementsAre(2, 2, 2, 5));
  ASSERT_EQ(discs.discs.size(), 4u);
  EXPECT_EQ(discs.discs[0].radius, 0.5);
  EXPECT_EQ(discs.discs[1].radius, 0.25);
  EXPECT_EQ(discs.discs[1].color, discs.discs[2].color);  // all fixed bodies are grey
  EXPECT_NE(discs.discs[0].color, discs.discs[3].color);
  EXPECT_THAT(panel.curves[0].x, ElementsAre(1, 2));  // the path of the ball
  // The floor y = 3/2, from the least to the greatest x with a fiftieth of that on both sides; the other is far away.
  const Curve& floor = panel.curves[3];
  EXPECT_THAT(floor.y, ElementsAre(1.5, 1.5));
  EXPECT_NEAR(std::min(floor.x[0], floor.x[1]), 1 - 0.02 * 6.25, 1e-12);
  EXPECT_NEAR(std::max(floor.x[0], floor.x[1]), 7.25 + 0.02 * 6.25, 1e-12);
  ASSERT_EQ(panel.curves.size(), 6u);
  EXPECT_EQ(panel.curves[4].label, "ball");
  EXPECT_EQ(panel.curves[5].label, "other");
}

// Seen along (-1, 1, -1) a large body hides a small one behind it, but not the one beside it. Two distant bodies
// determine the extent of the picture.
TEST(BodiesPanel, InSpaceLeavesOutWhatIsHidden) {
  const model::Model model = model_of(
      "world { dimension 3\nbody hidden at (-5, 5, -5) radius 0.5\nbody beside at (-5, 5, 0) radius 0.5\n"
      "body large at (0, 0, 0) radius 2\nbody before at (5, -5, 5) radius 1 }\nrun 0..1\n");
  const Panel panel = bodies_panel(model, moved_by_one(model));
  const Curve& discs = discs_of(panel);
  // From far to near; the place of (x, y, z) is sqrt(3/4) (x + y), z + (y - x)/2.
  const double shift = std::sqrt(0.75);
  ASSERT_EQ(discs.x.size(), 3u);
  for (const double x : discs.x) EXPECT_NEAR(x, shift, 1e-14);
  EXPECT_THAT(discs.y, ElementsAre(4.5, -0.5, -0.5));
  EXPECT_NEAR(discs.discs[1].radius, 2 * std::sqrt(1.5), 1e-14);
  EXPECT_NEAR(discs.discs[2].radius, std::sqrt(1.5), 1e-14);
}

// What turns to the left in space turns to the left in its picture: right, up and towards us are a right-handed system,
// perpendicular to each other and as long as they say.
TEST(BodiesPanel, DoesNotMirrorSpace) {
  const std::array<std::array<double, 3>, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::array<std::array<double, 3>, 3> seen;  // right, up, near
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [x, y, z] = axes[k];
    seen[0][k] = right_in_space(x, y), seen[1][k] = up_in_space(x, y, z), seen[2][k] = nearness_in_space(x, y, z);
  }
  const auto dot = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const auto& [right, up, near] = seen;
  const std::array<double, 3> turn{right[1] * up[2] - right[2] * up[1], right[2] * up[0] - right[0] * up[2],
                                   right[0] * up[1] - right[1] * up[0]};
  EXPECT_GT(dot(turn, near), 0);
  EXPECT_NEAR(dot(right, up), 0, 1e-15);
  EXPECT_NEAR(dot(right, near), 0, 1e-15);
  EXPECT_NEAR(dot(up, near), 0, 1e-15);
  EXPECT_NEAR(dot(right, right), size_in_space * size_in_space, 1e-15);
  EXPECT_NEAR(dot(up, up), size_in_space * size_in_space, 1e-15);
}

TEST(BodiesPanel, SoManyAreDots) {
  const model::Model model =
      model_of("world { bodies grain grid 60 x 60 from (0, 0) spacing (1, 1) radius 0.4 }\nrun 0..1\n");
  const Panel panel = bodies_panel(model, moved_by_one(model));
  ASSERT_EQ(panel.curves.size(), 1u);
  EXPECT_EQ(panel.curves[0].style, Curve::Style::dots);
  EXPECT_EQ(panel.curves[0].x.size(), 3600u);
}

TEST(BodiesPanel, IsDrawnWithoutAWord) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
  const model::Model model = model_of(
      "world { dimension 3\nbodies a grid 2 x 2 from (0, 0, 0) spacing (2, 2, 2)\nbody b at (0, 0, 5) }\nrun 0..1\n");
  const Folder folder;
  testing::internal::CaptureStderr();
  const Status status =
      draw({.title = "", .panels = {bodies_panel(model, moved_by_one(model))}}, folder / "bodies.svg");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(status) << status.message;
  const std::string svg = content(folder / "bodies.svg");
  EXPECT_THAT(svg, HasSubstr("rgb(  0, 114, 178)"));
}

}  // namespace
}  // namespace continuo::results::bodies_panel_test
