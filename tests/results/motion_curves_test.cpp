// The drawn line against the motion itself: closed forms at many more times than the line has points.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "example.hpp"
#include <continuo/language/load.hpp>
#include <continuo/results/motion_curves.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/runs/watched_run.hpp>

namespace continuo::results::motion_curves_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

/// A run with the curves of its plots.
struct Followed {
  std::shared_ptr<const model::ModelProgram> program;
  std::unique_ptr<MotionCurves> curves;
  model::Run run;

  Figure figure() { return figure_of(*program, run, *curves); }
};

Followed follow(const std::string& text, const model::Experiment& experiment = {}) {
  model::Loaded loaded = model::load(model::Source("model.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  Followed followed{model::compile(*std::move(loaded.model)), {}, {}};
  followed.curves = std::make_unique<MotionCurves>(followed.program, plot_requests(followed.program->model));
  model::Simulated simulated = simulate(followed.program, experiment, {.watcher = followed.curves.get()});
  EXPECT_TRUE(simulated.run);
  followed.run = *std::move(simulated.run);
  return followed;
}

struct Pixel {
  double x, y;
};

double distance(Pixel p, Pixel a, Pixel b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double part = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - part * dx, p.y - a.y - part * dy);
}

double distance(Pixel p, const std::vector<Pixel>& line) {
  double least = INFINITY;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) least = std::min(least, distance(p, line[i], line[i + 1]));
  return least;
}

/// The farthest that a point of either line is from the other one.
double apart(const std::vector<Pixel>& dense, const std::vector<Pixel>& drawn) {
  double farthest = 0;
  for (const Pixel p : dense) farthest = std::max(farthest, distance(p, drawn));
  for (std::size_t i = 0; i + 1 < drawn.size(); ++i)
    for (const double part : {0.0, 0.25, 0.5, 0.75})
      farthest = std::max(farthest, distance({drawn[i].x + part * (drawn[i + 1].x - drawn[i].x),
                                              drawn[i].y + part * (drawn[i + 1].y - drawn[i].y)},
                                             dense));
  return farthest;
}

/// On a picture 960 by 600 pixels large that shows the ranges of the curve.
struct Screen {
  double left, right, low, high;
  explicit Screen(const Path& path) {
    const auto [x0, x1] = std::ranges::minmax(path.x);
    const auto [y0, y1] = std::ranges::minmax(path.y);
    left = x0, right = x1, low = y0, high = y1;
  }
  Pixel operator()(double x, double y) const {
    return {(x - left) / (right - left) * 960, (y - low) / (high - low) * 600};
  }
  std::vector<Pixel> operator()(const Path& path) const {
    std::vector<Pixel> line;
    for (std::size_t i = 0; i < path.x.size(); ++i) line.push_back((*this)(path.x[i], path.y[i]));
    return line;
  }
};

/// The longest line of an SVG, which has so many points at least.
std::vector<Pixel> line_of(const std::string& svg, std::size_t least) {
  const std::regex number(R"(([ML ])(-?[0-9.]+),(-?[0-9.]+))");
  const std::regex path(R"re(d='([^']*)')re");
  std::vector<Pixel> longest;
  for (std::sregex_iterator each(svg.begin(), svg.end(), path), end; each != end; ++each) {
    const std::string points = (*each)[1];
    std::vector<Pixel> line;
    for (std::sregex_iterator point(points.begin(), points.end(), number); point != end; ++point) {
      if ((*point)[1] == "M") line.clear();  // the sample in the key is part of the path
      line.push_back({std::stod((*point)[2]), std::stod((*point)[3])});
    }
    if (line.size() > longest.size()) longest = line;
  }
  EXPECT_GE(longest.size(), least);
  return longest;
}

// x'' = 2 with three rows: in the file the line lies within a pixel of x = t^2, which its ends place in the picture.
TEST(MotionCurves, ConstantAccelerationIsAParabolaInTheFile) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
  for (const char* how : {"", ", method rk4, step 5", ", method velocity_verlet, step 5"}) {
    const Folder folder;
    const std::string path = folder / "parabola.svg";
    ASSERT_TRUE(
        draw(follow(fmt::format("x'' = 2\nx(0) = 0\nx'(0) = 0\nplot x\nrun 0..10, output 5{}\n", how)).figure(), path));
    const std::vector<Pixel> line = line_of(content(path), 20);
    const Pixel first = line.front(), last = line.back();
    ASSERT_GT(last.x - first.x, 700);
    std::vector<Pixel> parabola;
    for (int k = 0; k <= 2000; ++k) {
      const double part = k / 2000.0;
      parabola.push_back({first.x + part * (last.x - first.x), first.y + part * part * (last.y - first.y)});
    }
    EXPECT_LT(apart(parabola, line), 1) << how;
  }
}

// Of an oscillator in steps of 1/2, rows and looks at a tenth of it: the steps by the formulas on the blackboard, and
// nothing between them. The energy, which straight lines between positions and velocities would let sag, is as
// straight.
TEST(MotionCurves, MethodsOfTheFirstOrderAreDrawnStraightFromStepToStep) {
  struct State {
    double x, v;
  };
  using Step = std::function<State(State, double)>;
  const std::pair<const char*, Step> methods[] = {
      {"explicit_euler", [](State s, double h) { return State{s.x + h * s.v, s.v - h * s.x}; }},
      {"semi_implicit_euler",
       [](State s, double h) {
         const double v = s.v - h * s.x;
         return State{s.x + h * v, v};
       }},
      {"symplectic_euler_position_first",
       [](State s, double h) {
         const double x = s.x + h * s.v;
         return State{x, s.v - h * x};
       }},
      {"implicit_euler",
       [](State s, double h) {
         const double v = (s.v - h * s.x) / (1 + h * h);
         return State{s.x + h * v, v};
       }},
  };
  for (const auto& [method, step] : methods) {
    Followed followed =
        follow(fmt::format("x'' = -x\nx(0) = 1\nx'(0) = 0\nplot x\nplot (x^2 + x'^2)/2\n"
                           "run 0..10, output 0.05, method {}, step 0.5\n",
                           method));
    const Path position = followed.curves->curves_of(0).front().path,
               energy = followed.curves->curves_of(1).front().path;
    ASSERT_THAT(position.x, SizeIs(21)) << method;
    ASSERT_THAT(energy.x, SizeIs(21)) << method;
    State state{1, 0};
    for (std::size_t n = 0; n <= 20; ++n, state = step(state, 0.5)) {
      EXPECT_EQ(position.x[n], 0.5 * static_cast<double>(n)) << method;
      EXPECT_NEAR(position.y[n], state.x, 1e-7) << method;
      EXPECT_NEAR(energy.y[n], (state.x * state.x + state.v * state.v) / 2, 1e-5) << method;
    }
  }
}

// Oscillators with random frequencies and amplitudes that are put elsewhere twice: over time and in the plane.
TEST(MotionCurves, RandomMotionsLieWithinAPixelOfTheirClosedFormsAndJumpsStandUpright) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> number(0.5, 3);
  for (int trial = 0; trial < 12; ++trial) {
    const double w = 2 * number(random), a = number(random), jump = number(random);
    const double first = 1 + number(random), second = 5 + number(random);
    Followed followed = follow(
        fmt::format("x'' = -{0}*{0}*x\nx(0) = {1}\nx'(0) = 0\nat {3} {{ x := x + {2} }}\nat {4} {{ x := x - {2} }}\n"
                    "plot x\nplot x' against x\nrun 0..10, output 2.5, tol 1e-10\n",
                    w, a, jump, first, second));
    const auto motion = [&](double t) {
      double sum = a * std::cos(w * t);
      if (t >= first) sum += jump * std::cos(w * (t - first));
      if (t >= second) sum -= jump * std::cos(w * (t - second));
      return sum;
    };
    const auto speed = [&](double t) {
      double sum = -a * w * std::sin(w * t);
      if (t >= first) sum -= jump * w * std::sin(w * (t - first));
      if (t >= second) sum += jump * w * std::sin(w * (t - second));
      return sum;
    };
    const MotionCurve curve = followed.curves->curves_of(0).front();
    const Screen screen(curve.path);
    std::vector<Pixel> dense;
    constexpr int many = 2000;
    for (int k = 0; k <= many; ++k) {
      const double t = 10.0 * k / many, before = t - 10.0 / many;
      for (const double at : {first, second})
        if (before < at && at <= t)
          dense.push_back(screen(at, motion(at - 1e-12))), dense.push_back(screen(at, motion(at)));
      dense.push_back(screen(t, motion(t)));
    }
    EXPECT_LT(apart(dense, screen(curve.path)), 1) << trial;
    EXPECT_LT(curve.path.x.size(), 3000u);
    for (const double at : {first, second}) {
      const auto place = std::ranges::find(curve.path.x, at) - curve.path.x.begin();
      ASSERT_LT(place + 1, static_cast<std::ptrdiff_t>(curve.path.x.size()));
      const auto i = static_cast<std::size_t>(place);
      EXPECT_EQ(curve.path.x[i + 1], at);
      EXPECT_NEAR(std::abs(curve.path.y[i + 1] - curve.path.y[i]), jump, 1e-6);
    }
    // In the plane nothing has moved where the state was put elsewhere: a gap, and the jump apart.
    const MotionCurve orbit = followed.curves->curves_of(1).front();
    EXPECT_EQ(std::ranges::count_if(orbit.path.x, [](double x) { return std::isnan(x); }), 2);
    EXPECT_THAT(orbit.jumps.x, SizeIs(6));
    EXPECT_NEAR(std::abs(orbit.jumps.x[1] - orbit.jumps.x[0]), jump, 1e-6);
    Path piece;
    for (std::size_t i = 0; !std::isnan(orbit.path.x[i]); ++i)
      piece.x.push_back(orbit.path.x[i]), piece.y.push_back(orbit.path.y[i]);
    const Screen plane(piece);
    std::vector<Pixel> ellipse;
    for (int k = 0; k <= many; ++k) {
      const double t = first * k / many * (1 - 1e-12);
      ellipse.push_back(plane(motion(t), speed(t)));
    }
    EXPECT_LT(apart(ellipse, plane(piece)), 1) << trial;
  }
}

// An expression that jumps where no event does. A point in the middle of what rises is a quarter of a pixel of 1920
// away at most, so that all of it is half such a pixel wide.
TEST(MotionCurves, AnExpressionThatJumpsWithinAStepStandsUpright) {
  Followed followed = follow("x' = 1\nx(0) = 0\nplot floor(x + 0.25)\nrun 0..3, output 3\n");
  const Path path = followed.curves->curves_of(0).front().path;
  for (std::size_t i = 0; i + 1 < path.x.size(); ++i) {
    if (path.y[i] != path.y[i + 1]) {
      EXPECT_LE((path.x[i + 1] - path.x[i]) / 3 * 1920, 0.5);
    }
  }
  EXPECT_EQ(*std::ranges::max_element(path.y), 3);
}

// The square root of a number that comes out of the negative ones, and of one that goes there: half a run has values.
TEST(MotionCurves, AnExpressionIsDrawnFromWhereAndToWhereItHasValues) {
  for (const bool begins : {true, false}) {
    const char* const expression = begins ? "sqrt(x - 1)" : "sqrt(1 - x)";
    Followed followed = follow(fmt::format("x' = 1\nx(0) = 0\nplot {}\nrun 0..2, output 1\n", expression));
    const Path path = followed.curves->curves_of(0).front().path;
    Path values;
    for (std::size_t i = 0; i < path.x.size(); ++i)
      if (std::isfinite(path.y[i])) values.x.push_back(path.x[i]), values.y.push_back(path.y[i]);
    ASSERT_GT(values.x.size(), 20u);
    const Screen screen(values);
    std::vector<Pixel> root;
    for (int k = 0; k <= 2000; ++k) {
      const double height = k / 2000.0;
      root.push_back(screen(begins ? 1 + height * height : 1 - height * height, height));
    }
    // The end is known to 2^-18 of a step, which is 2 at most; the root of that is 1.7 pixels of 600 high.
    EXPECT_LT(apart(root, screen(values)), 1.7) << expression;
  }
}

TEST(MotionCurves, AWatchedRunHasTheSameBits) {
  const std::string text =
      "h'' = -9.81\nh(0) = 10\nh'(0) = 0\nwhen h falls through 0 { h' := -0.8*h' }\nrun 0..5, output 0.1\n";
  model::Loaded loaded = model::load(model::Source("model.sim", text));
  const model::Simulated alone = model::simulate(*loaded.model);
  EXPECT_EQ(follow(text).run.motion.values, alone.run->motion.values);
}

// The tolerance of the run is 1e-8 of the energy or so: an axis of a thousand of them, in which the line is level.
TEST(MotionCurves, AConservedEnergyIsALevelLine) {
  Followed followed = follow(
      "x'' = -x\nx(0) = 1\nx'(0) = 0\nenergy kinetic = x'^2/2\nenergy potential = x^2/2\nrun 0..20, output 1, tol "
      "1e-8\n");
  const Figure figure = followed.figure();
  const Panel& drift = figure.panels.back();
  EXPECT_GT(drift.least_height, 1e-6);
  EXPECT_LT(drift.least_height, 1e-3);
  const auto [low, high] = std::ranges::minmax(drift.curves.front().y);
  EXPECT_LT(high - low, 0.1 * drift.least_height);
  // By explicit Euler the energy grows, and the axis shows that.
  const Figure euler = follow(
                           "x'' = -x\nx(0) = 1\nx'(0) = 0\nenergy kinetic = x'^2/2\nenergy potential = x^2/2\n"
                           "run 0..20, output 1, method euler, step 0.01\n")
                           .figure();
  const auto [least, most] = std::ranges::minmax(euler.panels.back().curves.front().y);
  EXPECT_GT(most - least, 0.2);
  EXPECT_LT(euler.panels.back().least_height, 1e-7);
}

TEST(MotionCurves, ALongMotionTakesNoMorePointsThanAPictureShows) {
  Followed followed = follow("x'' = -x\nx(0) = 1\nx'(0) = 0\nplot x\nplot x' against x\nrun 0..20000, output 20000\n");
  const Path time = followed.curves->curves_of(0).front().path, plane = followed.curves->curves_of(1).front().path;
  EXPECT_LT(time.x.size(), 1u << 16);
  EXPECT_LT(plane.x.size(), 1u << 17);
  EXPECT_NEAR(*std::ranges::max_element(time.y), 1, 1e-3);
}

TEST(MotionCurves, ProfilesOfAFamilyAreThoseOfTheirTimes) {
  model::Loaded loaded = model::load(model::Source(
      "model.sim", "for i in 1..3 { u[i]' = i\nu[i](0) = 0 }\nat 1 { u[1] := 10 }\nplot u[1], u[2], u[3]\nrun 0..2\n"));
  ASSERT_TRUE(loaded) << loaded.text();
  const auto program = model::compile(*std::move(loaded.model));
  PlotRequest request = plot_requests(program->model).front();
  request.times = {2, 0, 1, 7};
  MotionCurves curves(program, {request});
  const model::Simulated simulated = simulate(program, {}, {.watcher = &curves});
  ASSERT_TRUE(simulated.run);
  const std::vector<Profile> profiles = curves.profiles_of(0);
  ASSERT_THAT(profiles, SizeIs(3));  // the run does not come to 7
  EXPECT_EQ(profiles[0].t, 2);
  EXPECT_NEAR(profiles[0].y[0], 11, 1e-9);
  EXPECT_NEAR(profiles[0].y[2], 6, 1e-9);
  EXPECT_EQ(profiles[1].y[1], 0);
  EXPECT_NEAR(profiles[2].y[0], 10, 1e-9);  // after the event
  EXPECT_EQ(profiles[2].x[2], 3);
}

// A look that is due at the end of a step, to rounding, is not waited for: here every other one.
TEST(MotionCurves, AWorldInStepsIsFollowedToItsEnd) {
  model::Loaded loaded = model::load(model::Source(
      "model.sim", "world { body ball at (0, 0) velocity (1, 0)\nmode fast step 1/240 }\nplot ball.x\nrun 0..2\n"));
  ASSERT_TRUE(loaded) << loaded.text();
  const auto program = model::compile(*std::move(loaded.model));
  MotionCurves curves(program, plot_requests(program->model));
  const runs::WatchedRun watched = runs::run(program, {}, {}, curves);
  ASSERT_TRUE(watched.is_shown);
  EXPECT_NEAR(curves.curves_of(0).front().path.x.back(), 2, 1e-9);
}

// A ball that bounces without loss: parabolas of the height 5 with corners at the floor, from rows one second apart.
TEST(MotionCurves, AWorldFliesInParabolasBetweenItsContacts) {
  model::Loaded loaded =
      model::load(model::Source("model.sim",
                                "world { gravity (0, -10)\nwall floor (0, 1) at 0\nbody ball at (0, 6) radius 1 "
                                "velocity (1, 0) mass 1\nmaterial restitution 1 friction 0 }\n"
                                "plot ball.y\nrun 0..5, output 1\n"));
  ASSERT_TRUE(loaded) << loaded.text();
  const auto program = model::compile(*std::move(loaded.model));
  MotionCurves curves(program, plot_requests(program->model));
  const runs::WatchedRun watched = runs::run(program, {}, {}, curves);
  ASSERT_TRUE(watched.simulated.run);
  ASSERT_TRUE(watched.is_shown);
  const Path path = curves.curves_of(0).front().path;
  const Screen screen(path);
  std::vector<Pixel> dense;
  for (int k = 0; k <= 4000; ++k) {
    const double t = 5.0 * k / 4000, since = std::fmod(t + 1, 2.0) - 1;  // it falls for a second
    dense.push_back(screen(t, 1 + 5 - 5 * since * since));
  }
  EXPECT_LT(apart(dense, screen(path)), 1);
}

}  // namespace
}  // namespace continuo::results::motion_curves_test
