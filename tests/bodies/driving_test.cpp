// Both motions are driven alike: to a time, by steps of any size, with options that change on the way.
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/exact_motion.hpp>

namespace continuo::driving_test {

using namespace test;  // rigid_worlds.hpp

namespace {

/// Some boxes, or balls, above a floor.
World<double, 2> heap(bool of_boxes) {
  auto world = world_on_slope<2>(0, 0.5);
  for (int k = 0; k < 12; ++k) {
    BodyDefinition<double, 2> body{.position = {{0.3 * (k % 3), 0.6 + 1.1 * k}}};
    if (of_boxes) body.shape = Box<double, 2>{};
    EXPECT_TRUE(world.add(body));
  }
  return world;
}

/// A body that falls freely is where its parabola is, whatever the sizes of the steps.
template <class Motion>
void expect_parabola(bool of_boxes) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  BodyDefinition<double, 2> body{.velocity = {{3, 5}}};
  if (of_boxes) body.shape = Box<double, 2>{};
  ASSERT_TRUE(world.add(body));
  Motion motion(world);
  for (const double h : {0.1, 0.01, 0.25, 0.001, 0.04}) ASSERT_TRUE(motion.step(h));
  ASSERT_TRUE(motion.advance_to(0.401 + 0.08));
  const double t = world.time;
  EXPECT_NEAR(t, 0.481, 1e-14);
  EXPECT_NEAR(world.position[0][0], 3 * t, 1e-13);
  EXPECT_NEAR(world.position[0][1], 5 * t - 9.81 / 2 * t * t, 1e-13);
}

TEST(Driving, StepsOfAnySizeFollowTheParabola) {
  for (const bool of_boxes : {false, true}) {
    expect_parabola<FastMotion<double, 2>>(of_boxes);
    expect_parabola<ExactMotion<double, 2>>(of_boxes);
  }
}

TEST(Driving, AdvanceToIsSoManySteps) {
  for (const bool of_boxes : {false, true}) {
    auto one = heap(of_boxes), other = heap(of_boxes);
    FastMotion<double, 2> by_steps(one), to_time(other);
    for (int k = 0; k < 90; ++k) ASSERT_TRUE(by_steps.advance());
    ASSERT_TRUE(to_time.advance_to(0.5));
    ASSERT_TRUE(to_time.advance_to(0.5));  // no step
    ASSERT_TRUE(to_time.advance_to(1.5 - 0.9 / 60));
    EXPECT_EQ(state_hash(one), state_hash(other));
    EXPECT_NEAR(other.time, 1.5, 1e-14);
    EXPECT_EQ(to_time.statistics().steps, by_steps.statistics().steps);
  }
}

TEST(Driving, OptionsThatAreTheSameChangeNothing) {
  for (const bool of_boxes : {false, true}) {
    auto one = heap(of_boxes), other = heap(of_boxes);
    FastMotion<double, 2> undisturbed(one), changed(other);
    for (int k = 0; k < 120; ++k) {
      ASSERT_TRUE(undisturbed.advance());
      changed.set_options(changed.options());
      ASSERT_TRUE(changed.step(1.0 / 60));
    }
    EXPECT_EQ(state_hash(one), state_hash(other));
  }
}

TEST(Driving, OptionsChangeOnTheWay) {
  for (const bool of_boxes : {false, true}) {
    auto world = heap(of_boxes);
    FastMotion<double, 2> motion(world);
    ASSERT_TRUE(motion.advance_to(3));
    const auto steps = motion.statistics().steps;
    auto options = motion.options();
    options.hertz = 20, options.fastest_push = 1;  // goes on
    motion.set_options(options);
    ASSERT_TRUE(motion.advance());
    EXPECT_LE(motion.statistics().hertz, 20);
    options.substeps = 8, options.threads = 2, options.contact_events = 100;  // begins anew
    motion.set_options(options);
    ASSERT_TRUE(motion.advance());
    EXPECT_EQ(motion.statistics().steps, steps + 2);
    EXPECT_GT(motion.contact_events().size(), 5u);
    ASSERT_TRUE(motion.advance_to(6));
    EXPECT_LT(motion.deepest_overlap(), 0.05);
    options.substeps = 0;
    motion.set_options(options);
    EXPECT_FALSE(motion.advance());
    options.substeps = 4;
    motion.set_options(options);
    EXPECT_TRUE(motion.advance());
  }
  auto world = heap(false);
  ExactMotion<double, 2> exact(world);
  ASSERT_TRUE(exact.advance_to(0.5));
  auto options = exact.options();
  options.tolerance = 0;
  exact.set_options(options);
  EXPECT_FALSE(exact.step(0.1));
  options.tolerance = 1e-12;
  exact.set_options(options);
  EXPECT_TRUE(exact.step(0.1));
  EXPECT_NEAR(world.time, 0.6, 1e-15);
}

TEST(Driving, TimesThatMakeNoSenseAreErrors) {
  auto world = heap(true);
  FastMotion<double, 2> motion(world);
  ASSERT_TRUE(motion.advance_to(0.1));
  const auto hash = state_hash(world);
  for (const double t : {0.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    const Status status = motion.advance_to(t);
    EXPECT_FALSE(status) << t;
    EXPECT_NE(status.message.find("the time to advance to"), std::string::npos) << describe(status);
  }
  for (const double h : {0.0, -0.1, std::nan("")}) EXPECT_FALSE(motion.step(h)) << h;
  EXPECT_FALSE(motion.advance_to(1));  // of that step
  EXPECT_EQ(state_hash(world), hash);
  EXPECT_TRUE(motion.step(0.01));
}

}  // namespace
}  // namespace continuo::driving_test
