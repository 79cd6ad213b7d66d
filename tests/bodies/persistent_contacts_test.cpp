// Persistent contacts under general forces: constraint forces and motions against closed forms.
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo::persistent_contacts_test {
namespace {

const Material<double> smooth{.restitution = 0, .friction = 0};

/// A force law of zero, which prevents the motion on parabolas.
template <int Dim>
void disguise(World<double, Dim>& world) {
  world.force_laws.emplace_back([](const auto&, double, auto, auto, auto) {});
}

// Along a smooth floor with drag, m x'' = -c x': x = v0 m/c (1 - exp(-c t/m)), and the floor carries m g all the time.
TEST(PersistentContacts, SlideWithDragWithoutLeavingTheFloor) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  world.drag.linear = 0.5;
  ASSERT_TRUE(world.add_wall({.material = smooth}));
  ASSERT_TRUE(world.add({.position = {{0, 0.5}}, .velocity = {{3, 0}}, .mass = 2, .material = smooth}));
  ExactMotion motion(world, {.contact_events = 10});
  ASSERT_TRUE(motion.advance_to(4));
  EXPECT_NEAR(world.position[0][0], 3 * 4 * (1 - std::exp(-1.0)), 1e-8);  // the tolerance, 1e-10, a step
  EXPECT_NEAR(world.position[0][1], 0.5, 1e-10);
  ASSERT_EQ(motion.contact_events().size(), 1u);
  EXPECT_EQ(motion.contact_events()[0].change, ContactChange::begin);
}

// A ball released near the top of a smooth fixed one leaves it at cos = 2/3, where its height has fallen by a third of
// the distance of the centres (by energy and the centripetal force), for any small initial angle.
TEST(PersistentContacts, LetGoWhereABallLeavesAnother) {
  World<double, 3> world;
  world.gravity = {{0, 0, -10}};
  disguise(world);
  ASSERT_TRUE(world.add({.shape = Sphere<double>{1}, .fixed = true, .material = smooth}));
  const double begin = 0.1, R = 1.5;
  ASSERT_TRUE(world.add({.position = {{R * std::sin(begin), 0, R * std::cos(begin)}}, .material = smooth}));
  ExactMotion motion(world, {.contact_events = 10});
  double t = 0;
  while (motion.contact_events().empty() || motion.contact_events().back().change != ContactChange::end) {
    ASSERT_TRUE(motion.advance_to(t += 0.01));
    ASSERT_LT(t, 2);
  }
  // From rest at `begin`: v^2 = 2 g R (cos begin - cos), and g cos = v^2/R where it leaves.
  EXPECT_NEAR(-dot(motion.contact_events().back().normal, {{0, 0, 1}}), std::cos(begin) * 2 / 3, 1e-8);
}

// A ball thrown along a rough floor slips for 2 v0/(7 f g) and then rolls with 5/7 of its speed.
TEST(PersistentContacts, SlipUntilTheyRoll) {
  World<double, 3> world;
  world.gravity = {{0, 0, -10}};
  disguise(world);
  const Material<double> rough{.restitution = 0, .friction = 0.25};
  ASSERT_TRUE(world.add_wall({.material = rough}));
  ASSERT_TRUE(world.add({.position = {{0, 0, 0.5}}, .velocity = {{7, 0, 0}}, .material = rough}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(0.4));
  EXPECT_NEAR(world.velocity[0][0], 7 - 0.25 * 10 * 0.4, 1e-9);
  ASSERT_TRUE(motion.advance_to(2));
  // Slip ends at 0.8 s, too early by the speed gained within 1e-5 of a fall: an error of 1e-5 squared.
  EXPECT_NEAR(world.velocity[0][0], 5, 1e-8);
  EXPECT_NEAR(world.spin[0][1], 5 / 0.5, 1e-8);
  EXPECT_NEAR(world.position[0][0], 7 * 0.8 - 1.25 * 0.8 * 0.8 + 5 * 1.2, 1e-8);
  EXPECT_LT(motion.statistics().wall_collisions, 3u);
}

// On a slope of tan = 1 a disc rolls with g sin (2/3) where friction is above tan/3, and slips below.
TEST(PersistentContacts, RollDownASlopeOrSlip) {
  for (const double friction : {0.4, 0.2}) {
    World<double, 2> world;
    disguise(world);
    world.gravity = {{std::sqrt(50.0), -std::sqrt(50.0)}};
    ASSERT_TRUE(world.add_wall({.material = {.friction = friction}}));
    ASSERT_TRUE(world.add({.position = {{0, 0.5}}, .material = {.friction = friction}}));
    ExactMotion motion(world);
    ASSERT_TRUE(motion.advance_to(2));
    const double along = std::sqrt(50.0), a = friction > 1.0 / 3 ? along * 2 / 3 : along * (1 - friction);
    EXPECT_NEAR(world.velocity[0][0], 2 * a, 1e-7) << friction;
    EXPECT_NEAR(world.position[0][0], 2 * a, 1e-7) << friction;
    EXPECT_NEAR(world.spin[0][0], friction > 1.0 / 3 ? -4 * a : -2 * friction * along / (0.5 * 0.5), 1e-6) << friction;
  }
}

// Twenty discs in touching rows, all drawn to a point by springs: more contacts than are needed, and an endless
// sequence of bounces if each were computed. The springs act as one on the centre of mass, which oscillates with drag
// as if alone: X'' = -10 X - X', independent of the contacts.
TEST(PersistentContacts, HoldAHeapThatForcesPressTogether) {
  for (const double friction : {0.0, 0.5}) {
    World<double, 2> world;
    world.drag.linear = 1;
    for (int i = 0; i < 20; ++i) {
      const auto body = world.add({.position = {{i % 5 + 0.5 * (i / 5 % 2), std::sqrt(0.75) * (i / 5)}},
                                   .mass = 1,
                                   .material = {.restitution = 0.3, .friction = friction}});
      world.springs.push_back({.a = *body, .b = Vector<double, 2>{{2.3, 1.2}}, .stiffness = 10});
    }
    const auto offset = [&] {
      Vector<double, 2> sum{{-2.3, -1.2}};
      for (const auto& x : world.position) sum += x * (1.0 / 20);
      return sum;
    };
    const Vector<double, 2> before = offset();
    ExactMotion motion(world);
    ASSERT_TRUE(motion.advance_to(3));
    const double w = std::sqrt(10 - 0.25), swing = std::exp(-1.5) * (std::cos(3 * w) + std::sin(3 * w) / (2 * w));
    EXPECT_LT(length(offset() - before * swing), 1e-8) << friction;  // a tolerance of 1e-10 a step, some hundred steps
    for (std::size_t i = 0; i < world.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT(length(world.position[i] - world.position[j]), 1 - 1e-8);
    EXPECT_LT(motion.statistics().collisions, 10000u) << friction;
  }
}

// A smooth disc falls with v between two that lie side by side on a smooth floor and none bounces: it goes on with v'
// and drives them apart with u, where the contacts, 30 degrees off the vertical, hold v' cos 30 = u sin 30 and the
// impulses P of both 2 P cos 30 = m (v - v'), P sin 30 = m u. So v' = v / 7 and u = sqrt(3) v / 7, on both sides alike.
// After a microsecond gravity has changed that by 1e-5, and speeds below 3e-5 of a fall in the contact time are none.
TEST(PersistentContacts, AreStruckTogetherWhereNothingBounces) {
  World<double, 2> world;
  disguise(world);
  world.gravity = {{0, -10}};
  ASSERT_TRUE(world.add_wall({.material = smooth}));
  ASSERT_TRUE(world.add({.position = {{-0.5, 0.5}}, .material = smooth}));
  ASSERT_TRUE(world.add({.position = {{0.5, 0.5}}, .material = smooth}));
  ASSERT_TRUE(world.add({.position = {{0, 0.5 + std::sqrt(0.75)}}, .velocity = {{0, -7}}, .material = smooth}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(1e-6));
  EXPECT_NEAR(world.velocity[2][1], -1, 5e-5);
  EXPECT_NEAR(world.velocity[2][0], 0, 5e-5);
  EXPECT_NEAR(world.velocity[0][0], -std::sqrt(3.0), 5e-5);
  EXPECT_NEAR(world.velocity[1][0], std::sqrt(3.0), 5e-5);
  EXPECT_NEAR(world.velocity[0][1], 0, 5e-5);
}

// A touching row, struck at its end without restitution, moves on together.
TEST(PersistentContacts, MoveOnAsOneWhereARowIsStruck) {
  World<double, 3> world;
  world.drag.linear = 1e-9;
  for (int i = 0; i < 8; ++i)
    ASSERT_TRUE(world.add({.position = {{i + 0.0, 0, 0}}, .velocity = {{i == 0 ? 8.0 : 0, 0, 0}}, .material = smooth}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(1e-6));
  // The effect of a drag of 1e-9 within the contact time is negligible, far less than the rounding of speeds of 8.
  for (const auto& v : world.velocity) EXPECT_NEAR(v[0], 1, 1e-8);
}

// A ball between two walls rests on both, and the impulses of the contacts add up to its weight.
TEST(PersistentContacts, TellTheImpulseThatCarried) {
  World<double, 2> world;
  disguise(world);
  world.gravity = {{0, -10}};
  ASSERT_TRUE(world.add_wall({.normal = {{1, 1}}, .material = smooth}));
  ASSERT_TRUE(world.add_wall({.normal = {{-1, 1}}, .material = smooth}));
  const auto ball = world.add({.position = {{0, 0.5 * std::sqrt(2.0)}}, .mass = 3, .material = smooth});
  bool lifts = false;
  world.force_laws.emplace_back([&](const auto&, double, auto, auto, auto force) {
    if (lifts) force[0][1] += 100;
  });
  ExactMotion motion(world, {.contact_events = 10});
  ASSERT_TRUE(motion.advance_to(2));
  EXPECT_EQ(motion.contact_events().size(), 2u);
  EXPECT_LT(length(world.velocity_of(*ball)), 1e-12);
  lifts = true;
  ASSERT_TRUE(motion.advance_to(2.5));
  ASSERT_EQ(motion.contact_events().size(), 2u);
  for (const auto& event : motion.contact_events()) {
    EXPECT_EQ(event.change, ContactChange::end);
    EXPECT_NEAR(event.impulse, 3 * 10 * 2 / std::sqrt(2.0), 1e-9);
  }
}

// Between neighbouring discs in a row there is neither pressure nor friction, and the rounding of these forces must not
// release contacts. At rest one flight of few steps leads to the end: 12 evaluations each, and three at the start.
TEST(PersistentContacts, LieSideBySideInOneFlight) {
  for (const double friction : {0.0, 0.5}) {
    World<double, 2> world;
    std::size_t evaluations = 0;
    world.gravity = {{0, -10}};
    world.force_laws.emplace_back([&](const auto&, double, auto, auto, auto) { ++evaluations; });
    const Material<double> material{.restitution = 0, .friction = friction};
    ASSERT_TRUE(world.add_container({}, {{8, 100}}, material));
    for (int i = 0; i < 64; ++i)
      ASSERT_TRUE(world.add({.position = {{i % 8 + 0.5, i / 8 + 0.5}}, .material = material}));
    const auto before = world.position;
    ExactMotion motion(world);
    ASSERT_TRUE(motion.advance_to(0.2));
    EXPECT_LT(evaluations, 100u) << friction;
    for (std::size_t i = 0; i < 64; ++i) EXPECT_LT(length(world.position[i] - before[i]), 1e-9);  // 1e-10 a step
  }
}

// Going on from a snapshot in the middle gives the same bits.
TEST(PersistentContacts, GoOnFromASnapshot) {
  World<double, 2> world;
  world.drag.linear = 0.1;
  world.gravity = {{1, -10}};
  ASSERT_TRUE(world.add_wall({.material = {.friction = 0.3}}));
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(
        world.add({.position = {{0.97 * i, 0.5 + 0.8 * (i % 2)}}, .material = {.restitution = 0.5, .friction = 0.3}}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(0.5));
  const Bytes saved = snapshot(world, motion);
  World<double, 2> other = world;
  ExactMotion of_other(other);
  ASSERT_TRUE(restore(saved, other, of_other));
  ASSERT_TRUE(motion.advance_to(1));
  ASSERT_TRUE(of_other.advance_to(1));
  EXPECT_EQ(state_hash(world), state_hash(other));
}

}  // namespace
}  // namespace continuo::persistent_contacts_test
