// The clock of a session, and its history.
#include <algorithm>
#include <cmath>
#include <string>

#include <tests/live/spectator.hpp>

namespace continuo::live {
namespace {

const std::string circle = "x'' = -x\nx(0) = 1;  x'(0) = 0\nenergy all = 1/2*x'^2 + 1/2*x^2\nrun 0..10 tol 1e-9\n";

TEST(LiveTime, IsThatOfTheWall) {
  Stage stage(circle);
  const double begin = stage.wall;
  stage.play(60);
  EXPECT_NEAR(stage.session->shown_time(), stage.wall - begin, 1e-9);
  EXPECT_NEAR(stage.session->clock().reached_speed(), 1, 1e-6);
  EXPECT_FALSE(stage.session->clock().slow());
  // The displayed position is within the tolerance of the run, at any step size.
  EXPECT_NEAR(stage.state("x"), std::cos(stage.session->shown_time()), 1e-6);
}

// The flights of an elastic ball, also in the step whose end is an impact; by methods that land on it, and one that
// does not.
TEST(LiveTime, ABallFliesOnItsParabolaUntilItsImpact) {
  for (const std::string method : {"", "rodas5p", "dop853_radau", "dop853"}) {
    Stage stage("h'' = -9.8\nh(0) = 10;  h'(0) = 0\nwhen h falls through 0 { h' := -h' }\nrun 0..20 tol 1e-9" +
                (method.empty() ? method : " method " + method) + "\n");
    const double period = 2 * std::sqrt(2 * 10 / 9.8);
    stage.session->play();
    for (int k = 0; k < 240; ++k) {
      stage.run(1.0 / 60);
      const double s = std::remainder(stage.session->shown_time(), period);  // from the nearest top
      EXPECT_NEAR(stage.state("h"), 10 - 4.9 * s * s, 1e-5) << method << " at t = " << stage.session->shown_time();
      EXPECT_NEAR(std::abs(stage.state("h'")), 9.8 * std::abs(s), 1e-5) << method;
    }
  }
}

TEST(LiveTime, RunsAtTheSpeedAskedFor) {
  Stage stage(circle);
  stage.session->set_speed(0.001);
  stage.play(2);
  EXPECT_NEAR(stage.session->shown_time(), 0.002, 1e-9);
  stage.session->set_speed(50);
  stage.run(2);
  EXPECT_NEAR(stage.session->shown_time(), 100.002, 1e-6);
}

TEST(LiveTime, AStallOfTheMachineIsCaughtUpWith) {
  Stage stage(circle);
  const double begin = stage.wall;
  stage.play(1);
  stage.wall += 0.2;  // less than the largest debt
  stage.run(1);
  EXPECT_NEAR(stage.session->shown_time(), stage.wall - begin, 1e-9);
}

TEST(LiveTime, ADebtIsDroppedNotPaid) {
  Stage stage(circle);
  stage.play(1);
  const double before = stage.session->shown_time();
  stage.wall += 3600;  // the lid was closed
  stage.run(1);
  EXPECT_LT(stage.session->shown_time(), before + 1 + 2 * PacedClock::largest_debt);
}

// A step of 1e-4, with the clock read every 8 steps: at a cost of 8 ms for each reading, simulated time passes at a
// tenth of wall time.
TEST(LiveTime, ATooSlowMachineSlowsDownEvenlyAndSaysSo) {
  Stage stage("x'' = -x\nx(0) = 1;  x'(0) = 0\nrun 0..10 method rk4 step 1e-4\n");
  stage.cost = 8e-3;
  stage.session->play();
  double longest = 0;
  for (int k = 0; k < 300; ++k) {
    const double begin = stage.wall;
    stage.session->turn();
    longest = std::max(longest, stage.wall - begin);
  }
  EXPECT_TRUE(stage.session->clock().slow());
  EXPECT_NEAR(stage.session->clock().reached_speed(), 0.1, 0.05);  // other readings of the clock cost time as well
  EXPECT_LT(longest, 0.1);                                         // the response time to the user
  const auto states = stage.audience.said("state");
  EXPECT_TRUE(states.back()["slow"].get<bool>());
  stage.cost = 0;
  stage.run(2);
  EXPECT_FALSE(stage.session->clock().slow());
  EXPECT_NEAR(stage.session->clock().reached_speed(), 1, 1e-3);
}

TEST(LiveTime, UnlimitedIsAsFastAsCanBe) {
  Stage stage(circle);
  stage.cost = 1e-4;
  stage.session->set_speed(0);
  stage.play(0.5);
  EXPECT_GT(stage.session->shown_time(), 10);
}

TEST(LiveTime, AStepIsOneStepOfTheMethod) {
  Stage stage("mass_spring");  // semi-implicit Euler, step 0.1
  stage.session->step();
  EXPECT_DOUBLE_EQ(stage.session->shown_time(), 0.1);
  EXPECT_DOUBLE_EQ(stage.state("x'"), -0.5);
  EXPECT_DOUBLE_EQ(stage.state("x"), 4.95);
  stage.session->step();
  EXPECT_DOUBLE_EQ(stage.session->shown_time(), 0.2);
  EXPECT_FALSE(stage.session->playing());
}

TEST(LiveTime, UntilTheNextEvent) {
  Stage stage("bouncing_ball");
  stage.session->until_event();
  stage.run(0.2);
  EXPECT_FALSE(stage.session->playing());
  EXPECT_NEAR(stage.session->shown_time(), 10.0 / 7, 1e-9);
  EXPECT_NEAR(stage.state("h'"), 0.9 * 14, 1e-8);  // after it
  bool told = false;
  for (const auto& slice : stage.audience.slices) {
    for (const LiveEvent& event : slice->events) told = told || event.name.starts_with("h falls through 0");
  }
  EXPECT_TRUE(told);
}

TEST(LiveTime, RowsStandOnBothSidesOfAnEvent) {
  Stage stage("bouncing_ball");
  stage.play(2);
  const std::size_t columns = stage.session->shown().columns.size(), speed = stage.column("h'");
  int seen = 0;
  for (const auto& slice : stage.audience.slices) {
    for (std::size_t i = 1; i < slice->row_t.size(); ++i) {
      if (slice->row_t[i] != slice->row_t[i - 1]) continue;
      ++seen;
      EXPECT_NEAR(slice->rows[(i - 1) * columns + speed], -14, 1e-5);
      EXPECT_NEAR(slice->rows[i * columns + speed], 12.6, 1e-5);
    }
  }
  EXPECT_EQ(seen, 1);
}

// An event ends a step, and its actions begin another: displayed rows of the first step must not change. A float of 10
// is right to 5e-7, one of 98 to 4e-6.
TEST(LiveTime, RowsBeforeAnEventLieOnThePathThatLedThere) {
  const auto worst = [](Stage& stage, const std::string& name, double end, auto&& truth) {
    double found = 0;
    std::size_t rows = 0;
    for (const auto& slice : stage.audience.slices) {
      for (std::size_t i = 0; i < slice->row_t.size() && slice->row_t[i] < end; ++i, ++rows) {
        const double shown = slice->rows[i * stage.session->shown().columns.size() + stage.column(name)];
        found = std::max(found, std::abs(shown - truth(slice->row_t[i])));
      }
    }
    EXPECT_GT(rows, 80U);
    return found;
  };
  Stage located("bouncing_ball");
  located.play(1.5);
  EXPECT_LT(worst(located, "h", 10.0 / 7, [](double t) { return 10 - 4.9 * t * t; }), 1e-6);
  Stage scheduled(
      "ball_through_floor");  // looked at every 0.1 s, turned round at 1.5; Euler's speed is right in free fall
  scheduled.play(1.6);
  EXPECT_LT(worst(scheduled, "h'", 1.5, [](double t) { return -9.81 * t; }), 1e-5);
}

TEST(LiveHistory, GoesBackAndOnFromThere) {
  Stage stage(circle);
  stage.play(2);
  const double last = stage.session->shown_time();
  stage.session->seek(0.5);
  const double then = stage.session->shown_time();
  EXPECT_NEAR(then, 0.5, 1.0 / 60);
  stage.session->turn();
  EXPECT_TRUE(stage.audience.slices.back()->looking_back);
  EXPECT_TRUE(stage.audience.slices.back()->row_t.empty());
  stage.session->back();
  EXPECT_LT(stage.session->shown_time(), then);
  stage.session->step();
  EXPECT_DOUBLE_EQ(stage.session->shown_time(), then);
  EXPECT_DOUBLE_EQ(stage.session->history().last_time(), last);  // looking back loses nothing
  stage.play(1);
  EXPECT_NEAR(stage.session->shown_time(), then + 1, 1e-9);
  EXPECT_NEAR(stage.state("x"), std::cos(then + 1), 1e-6);
  EXPECT_LT(stage.session->history().last_time(), last);
}

TEST(LiveHistory, GoesOnAfterAnImpactItLooksAt) {
  Stage stage("bouncing_ball");
  stage.play(3);
  stage.session->seek(10.0 / 7 + 1e-9);
  EXPECT_NEAR(stage.session->shown_time(), 10.0 / 7, 1e-9);
  stage.play(5);
  for (std::size_t i = 0; i < stage.session->history().size(); ++i)
    EXPECT_GE(stage.session->history()[i].main.x[0], -1e-12);
}

TEST(LiveHistory, IsBounded) {
  History history(100'000, 1000);
  for (int i = 0; i < 5000; ++i) {
    Sample sample;
    sample.main.t = i * 0.1;
    sample.main.x.resize(10);
    history.add(sample);
  }
  EXPECT_LE(history.bytes(), 100'000U);
  EXPECT_LE(history.size(), 1000U);
  EXPECT_DOUBLE_EQ(history.last_time(), 499.9);
  EXPECT_EQ(history.index_at(499.95), history.size() - 1);
  EXPECT_EQ(history.index_at(0), 0U);
  history.cut_from(499.9);
  EXPECT_NEAR(history.last_time(), 499.8, 1e-9);
}

TEST(LiveTime, GoesOnBeyondTheRunOfTheText) {
  Stage stage("bouncing_ball");
  stage.session->set_speed(20);
  stage.play(3);  // 60 s of a run of 30
  EXPECT_NEAR(stage.session->shown_time(), 60, 1e-6);
  EXPECT_FALSE(stage.session->has_ended());
}

TEST(LiveTime, AFailureOfTheSolverPausesAndSaysWhy) {
  Stage stage("param k = 1\nx' = k*x^2\nx(0) = 1\nrun 0..3 tol 1e-8\n");  // x = 1/(1 - t)
  stage.play(2);
  EXPECT_FALSE(stage.session->playing());
  EXPECT_TRUE(stage.session->has_ended());
  EXPECT_NEAR(stage.session->shown_time(), 1, 1e-3);
  const auto messages = stage.audience.said("message");
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages.back()["severity"], "error");
  EXPECT_TRUE(messages.back()["code"].get<std::string>().starts_with("E30"));
  EXPECT_NE(messages.back()["hint"], "");
  stage.session->seek(0.5);
  stage.session->set_parameter("k", -1);
  const double from = stage.session->shown_time();
  stage.play(1);
  EXPECT_NEAR(stage.session->shown_time(), from + 1, 1e-9);
  EXPECT_FALSE(stage.session->has_ended());
}

TEST(LiveTime, AStopOfTheTextEndsTheRun) {
  Stage stage("x' = 1\nx(0) = 0\nwhen x rises through 1 { stop \"there\" }\nrun 0..3\n");
  stage.play(2);
  EXPECT_TRUE(stage.session->has_ended());
  EXPECT_EQ(stage.audience.said("state").back()["ended"], "there");
  EXPECT_NEAR(stage.session->shown_time(), 1, 1e-12);
  stage.session->reset();
  EXPECT_EQ(stage.session->shown_time(), 0);
  EXPECT_FALSE(stage.session->has_ended());
}

// ---- curves that bend between two pictures ----

const std::string circling =
    "x'' = -x; y'' = -y\nx(0) = 1; x'(0) = 0; y(0) = 0; y'(0) = 1\ndraw { ball (x, y) radius 0.1; trail (x, y) }\n"
    "plot x\nrun 0..1000";

struct Trail {
  std::vector<double> t, x, y;
  std::size_t frames = 0;
  /// The greatest distance of the chords between its points from the unit circle on which they lie.
  double deepest() const {
    double least = 1;
    for (std::size_t i = 1; i < t.size(); ++i)
      least = std::min(least, std::hypot((x[i] + x[i - 1]) / 2, (y[i] + y[i - 1]) / 2));
    return 1 - least;
  }
};

Trail trail_at(double speed, const std::string& method) {
  Stage stage(circling + method);
  stage.session->set_speed(speed);
  stage.play(2);
  Trail trail;
  for (const auto& slice : stage.audience.slices) {
    EXPECT_EQ(slice->paths.size(), 2 * slice->row_t.size());
    EXPECT_LE(slice->row_t.size(), 64U);
    ++trail.frames;
    for (std::size_t row = 0; row < slice->row_t.size(); ++row) {
      trail.t.push_back(slice->row_t[row]);
      trail.x.push_back(static_cast<double>(slice->paths[2 * row]));
      trail.y.push_back(static_cast<double>(slice->paths[2 * row + 1]));
    }
  }
  EXPECT_TRUE(std::ranges::is_sorted(trail.t));
  return trail;
}

TEST(LiveRows, AreDenserWhereACurveBends) {
  for (const std::string method : {" method dop853 tol 1e-10\n", " method rk4 step 0.02\n"}) {
    // At a radian for each picture a chord is 1 - cos(1/2) = 0.12 inside of the circle. Points are added where a line
    // would be off by a 500th of the width 2. With the eighths of steps or 64ths of pictures needed to detect it, the
    // error is less than three times that.
    const Trail fast = trail_at(60, method);
    EXPECT_LT(fast.deepest(), 3 * 2.0 / 500);
    // A hundredth of a radian deviates by 1e-5: one row for each picture is enough, once the curve is long compared
    // with that.
    const Trail slow = trail_at(0.6, method);
    const auto late = std::ranges::count_if(slow.t, [](double t) { return t > 0.2; });
    EXPECT_LE(late, static_cast<std::ptrdiff_t>(slow.frames));
  }
}

TEST(LiveRows, OfMotionAlongALineAreAsManyAsPictures) {
  Stage stage("x'' = 0\nx(0) = 0; x'(0) = 1\ndraw { trail (x, 0) }\nplot x\nrun 0..10000 method rk4 step 0.05\n");
  stage.session->set_speed(60);
  stage.play(2);
  std::size_t rows = 0;
  for (const auto& slice : stage.audience.slices) rows += slice->row_t.size();
  EXPECT_LE(rows, stage.audience.slices.size() + 1);  // and the start
}

TEST(LiveHistory, ThinsWhatIsLongAgoWhereMemoryIsShort) {
  constexpr std::size_t most = 1 << 20;
  History history(most);
  for (int i = 0; i < 10'000; ++i) {
    Sample sample;
    sample.main.t = i;
    sample.main.x.assign(1000, 0.0);  // some 130 of them fit
    history.add(std::move(sample));
    ASSERT_LE(history.bytes(), most);
  }
  EXPECT_EQ(history.first_time(), 0);
  EXPECT_EQ(history.last_time(), 9999);
  double before = 0;
  for (std::size_t i = 1; i < history.size(); ++i) {
    const double gap = history[i].main.t - history[i - 1].main.t, age = 9999 - history[i - 1].main.t;
    EXPECT_GT(gap, 0);
    EXPECT_LE(gap, 1 + age) << before;
    before = gap;
  }
  // All of the last moments are kept: none of the newer half is deleted.
  for (std::size_t i = 0; i < 40; ++i)
    EXPECT_EQ(history[history.size() - 1 - i].main.t, 9999.0 - static_cast<double>(i));
}

}  // namespace
}  // namespace continuo::live
