// The contact events of both motions, against the laws of mechanics: sums of impulses, weights, times.
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::contact_events_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// The momentum of a gas changes by the impulses of the walls and nothing else; each body's by those on it.
TEST(ContactEvents, ImpulsesAreTheChangeOfMomentum) {
  World<double, 3> world;
  const Material<double> material{.restitution = 0.9, .friction = 0};
  ASSERT_TRUE(world.add_container({}, {{6, 6, 6}}, material));
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 64; ++i)
    ASSERT_TRUE(world.add({.position = {{1 + 1.3 * (i % 4), 1 + 1.3 * (i / 4 % 4), 1 + 1.3 * (i / 16)}},
                           .velocity = {{normal(engine), normal(engine), normal(engine)}},
                           .mass = 1 + std::abs(normal(engine)),
                           .material = material}));
  const World<double, 3> before = world;
  ExactMotion motion(world, {.contact_events = 100000});
  ASSERT_TRUE(motion.advance_to(5));
  EXPECT_EQ(motion.contact_events().size(), motion.statistics().collisions + motion.statistics().wall_collisions);
  EXPECT_EQ(motion.lost_contact_events(), 0u);
  EXPECT_GT(motion.statistics().collisions, 200u);
  std::vector<Vector<double, 3>> gained(world.size());
  double last = 0;
  for (const ContactEvent<double, 3>& event : motion.contact_events()) {
    EXPECT_EQ(event.change, ContactChange::impact);
    EXPECT_GE(event.time, last);
    last = event.time;
    EXPECT_GT(event.impulse, 0);
    gained[world.index(event.a)] -= event.normal * event.impulse;
    if (!event.with_wall()) gained[world.index(event.b)] += event.normal * event.impulse;
    // A contact with a wall is in its surface: here, in a face of the box.
    if (event.with_wall()) {
      EXPECT_NEAR(dot(world.walls()[event.wall].normal, event.point), world.walls()[event.wall].offset, 20 * epsilon);
    }
  }
  // Some tens of impulses of size 10, rounded each.
  for (std::size_t i = 0; i < world.size(); ++i)
    EXPECT_LT(length(world.mass[i] * (world.velocity[i] - before.velocity[i]) - gained[i]), 100 * 10 * epsilon) << i;
}

// A ball that comes to rest on the floor presses on it with its weight until another one hits it.
TEST(ContactEvents, RestBeginsAndEndsWithTheWeight) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  ASSERT_TRUE(world.add_wall({}));
  const auto low = world.add({.position = {{0, 0.5}}, .mass = 3, .material = {.restitution = 0, .friction = 0}});
  ASSERT_TRUE(
      world.add({.position = {{-5, 0.5}}, .velocity = {{1, 0}}, .material = {.restitution = 1, .friction = 0}}));
  ExactMotion motion(world, {.contact_events = 100});
  ASSERT_TRUE(motion.advance_to(6));
  double begun = -1, ended = -1, impulse = 0;
  for (const auto& event : motion.contact_events()) {
    if (event.a != *low || !event.with_wall()) continue;
    if (event.change == ContactChange::begin && begun < 0) begun = event.time;
    if (event.change == ContactChange::end && ended < 0) ended = event.time, impulse = event.impulse;
  }
  EXPECT_EQ(begun, 0);
  EXPECT_NEAR(ended, 4, 1e-4);  // the other ball bounces until then
  EXPECT_NEAR(impulse, 3 * 10 * ended, 1e-9);
}

// The same of the fast motion: an elastic ball strikes at the times of a fall, with twice its momentum. A collision is
// located on the parabola between steps, so that only the ulps of some bounces are lost.
TEST(ContactEvents, OfTheFastMotionTellOfImpacts) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  ASSERT_TRUE(world.add_wall({}));
  ASSERT_TRUE(world.add({.position = {{0, 5.5}}, .mass = 2, .material = {.restitution = 1, .friction = 0}}));
  FastMotion motion(world, {.contact_events = 10});
  std::vector<double> times;
  for (int step = 0; step < 600; ++step) {
    ASSERT_TRUE(motion.advance());
    for (const auto& event : motion.contact_events()) {
      EXPECT_EQ(event.change, ContactChange::impact);
      EXPECT_NEAR(event.impulse, 2 * 2 * 10, 1e-9);
      EXPECT_NEAR(event.point[1], 0, 1e-9);
      times.push_back(event.time);
    }
  }
  ASSERT_EQ(times.size(), 5u);  // after 1, 3, 5, 7 and 9 s
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], 1 + 2 * static_cast<double>(i), 1e-9);
}

// Two balls, one on the other: while they rest, the impulse of each contact is that of the weight above it. The soft
// contacts settle in the first tenth of a second; their overshoot there cancels, but for the momentum at the end.
TEST(ContactEvents, OfTheFastMotionTellOfWeight) {
  World<double, 3> world;
  world.gravity = {{0, 0, -10}};
  ASSERT_TRUE(world.add_wall({}));
  const auto low = world.add({.position = {{0, 0, 0.5}}, .mass = 3, .material = {.friction = 0}});
  const auto high = world.add({.position = {{0, 0, 1.5}}, .mass = 2, .material = {.friction = 0}});
  FastMotion motion(world, {.contact_events = 10});
  int begun = 0;
  for (int step = 0; step < 120; ++step) {
    ASSERT_TRUE(motion.advance());
    for (const auto& event : motion.contact_events()) begun += event.change == ContactChange::begin ? 1 : 0;
  }
  EXPECT_EQ(begun, 2);
  world.velocity[world.index(*low)] = {{0, 100, 0}};  // the lower one is pulled away, and both are lifted
  world.velocity[world.index(*high)] = {{0, 0, 100}};
  world.position[world.index(*low)][2] += 0.1;
  world.position[world.index(*high)][2] += 1;
  ASSERT_TRUE(motion.advance());
  ASSERT_EQ(motion.contact_events().size(), 2u);
  for (const auto& event : motion.contact_events()) {
    EXPECT_EQ(event.change, ContactChange::end);
    EXPECT_NEAR(event.impulse, (event.with_wall() ? 5 : 2) * 10 * 2.0, 0.01 * 100);
  }
}

// A ball rolls off a fixed one: a persistent contact has one begin and one end, however many calls it spans.
TEST(ContactEvents, OfAnIslandBeginAndEndOnce) {
  double when = 0;
  for (const int calls : {1, 300}) {
    const Material<double> rough{.restitution = 0, .friction = 0.5};
    World<double, 2> world;
    world.gravity = {{0, -10}};
    ASSERT_TRUE(world.add({.shape = Sphere<double>{1}, .fixed = true, .material = rough}));
    ASSERT_TRUE(world.add({.position = {{1.5 * std::sin(0.1), 1.5 * std::cos(0.1)}}, .material = rough}));
    ExactMotion motion(world, {.contact_events = 100});
    std::vector<ContactEvent<double, 2>> all;
    for (int k = 1; k <= calls; ++k) {
      ASSERT_TRUE(motion.advance_to(3.0 * k / calls));
      for (const auto& event : motion.contact_events())
        if (event.change != ContactChange::impact) all.push_back(event);
    }
    ASSERT_EQ(all.size(), 2u) << calls;
    EXPECT_EQ(all[0].change, ContactChange::begin);
    EXPECT_EQ(all[1].change, ContactChange::end);
    if (calls > 1) {
      EXPECT_NEAR(all[1].time, when, 1e-4);  // flights end where calls do, to the contact time and the tolerance
    }
    when = all[1].time;
  }
}

TEST(ContactEvents, AreBounded) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  ASSERT_TRUE(world.add_wall({}));
  ASSERT_TRUE(world.add({.position = {{0, 1}}, .material = {.restitution = 1}}));
  ExactMotion motion(world, {.contact_events = 3});
  ASSERT_TRUE(motion.advance_to(10));
  EXPECT_EQ(motion.contact_events().size(), 3u);
  EXPECT_EQ(motion.lost_contact_events() + 3, motion.statistics().wall_collisions);
  ASSERT_TRUE(motion.advance_to(10));  // each call has its own events
  EXPECT_TRUE(motion.contact_events().empty());
}

}  // namespace
}  // namespace continuo::contact_events_test
