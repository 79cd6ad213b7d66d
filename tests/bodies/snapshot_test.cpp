// Worlds as bytes: a restored world moves on to the same bits, and wrong bytes are refused.
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <continuo/bodies/recording.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo::snapshot_test {
namespace {

/// Balls of several sizes and materials over a floor between walls, some fixed, some removed again, with groups.
template <class Real, int Dim>
World<Real, Dim> crowd(unsigned seed, bool has_springs) {
  World<Real, Dim> world;
  std::mt19937 engine(seed);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  Vector<Real, Dim> upper;
  for (std::size_t axis = 0; axis < upper.size(); ++axis) upper[axis] = Real(axis + 1 == upper.size() ? 100 : 8);
  EXPECT_TRUE(world.add_container({}, upper, {.restitution = Real(0.3)}));
  world.gravity[upper.size() - 1] = Real(-9.81);
  BodyHandle last{};
  for (int i = 0; i < 60; ++i) {
    BodyDefinition<Real, Dim> ball{.shape = Sphere<Real>{Real(0.3) + Real(0.15) * uniform(engine)}};
    ball.position[0] = Real(1 + i % 7);
    ball.position[1] = Real(Dim == 2 ? 1 + i / 7 : 1 + i / 7 % 3 * 2);
    if (Dim == 3) ball.position[2] = Real(1 + i / 21);
    for (std::size_t axis = 0; axis < upper.size(); ++axis) ball.velocity[axis] = 3 * uniform(engine);
    for (std::size_t axis = 0; axis < ball.spin.size(); ++axis) ball.spin[axis] = uniform(engine);
    ball.material = {.restitution = Real(i % 3) / 4, .friction = Real(0.4), .rolling_resistance = Real(i % 2) / 50};
    ball.fixed = i % 13 == 0;
    ball.group = static_cast<std::uint32_t>(i % 5);
    const auto added = world.add(ball);
    EXPECT_TRUE(added) << added.status().message;
    if (i % 9 == 8) world.remove(last);
    if (has_springs && i % 4 == 1) world.springs.push_back({.a = *added, .b = last, .rest_length = 1, .stiffness = 3});
    if (has_springs && i == 30) world.springs.push_back({.a = *added, .b = upper, .stiffness = 2, .damping = 1});
    last = *added;
  }
  EXPECT_TRUE(world.ignore(2, 3));
  world.combine_rule = {.restitution = Combine::average, .rolling_resistance = Combine::product};
  return world;
}

template <class Real, int Dim>
void expect_equal(const World<Real, Dim>& a, const World<Real, Dim>& b) {
  EXPECT_EQ(snapshot(a), snapshot(b));  // every bit of a world is in it
}

template <class Real, int Dim>
void exact_goes_on() {
  // A long contact time: a heap of 60 that rattles within a millisecond.
  const ExactOptions<Real> options{.contact_time = Real(1e-3), .contact_events = 100000};
  World<Real, Dim> world = crowd<Real, Dim>(5, false), again;
  ExactMotion<Real, Dim> motion(world, options), motion_again(again, options);
  ASSERT_TRUE(motion.advance_to(1));
  const Bytes bytes = snapshot(world, motion);
  ASSERT_TRUE(restore(bytes, again, motion_again));
  expect_equal(world, again);
  EXPECT_EQ(snapshot(again, motion_again), bytes);
  ASSERT_TRUE(motion.advance_to(1.5));
  ASSERT_TRUE(motion_again.advance_to(1.5));
  expect_equal(world, again);
  EXPECT_EQ(snapshot(again, motion_again), snapshot(world, motion));
  EXPECT_EQ(motion.statistics().collisions, motion_again.statistics().collisions);
  ASSERT_EQ(motion.contact_events().size(), motion_again.contact_events().size());
  EXPECT_GT(motion.contact_events().size(), 10u);
  for (std::size_t i = 0; i < motion.contact_events().size(); ++i)
    EXPECT_EQ(motion.contact_events()[i].impulse, motion_again.contact_events()[i].impulse);
  // The motion without a snapshot, for comparison.
  World<Real, Dim> undisturbed = crowd<Real, Dim>(5, false);
  ExactMotion<Real, Dim> alone(undisturbed, {.contact_time = Real(1e-3)});
  ASSERT_TRUE(alone.advance_to(1));
  ASSERT_TRUE(alone.advance_to(1.5));
  expect_equal(undisturbed, again);
}
TEST(Snapshot, ExactMotionGoesOnToTheSameBits) {
  exact_goes_on<double, 3>();
  exact_goes_on<double, 2>();
  exact_goes_on<float, 3>();
  exact_goes_on<float, 2>();
}

template <class Real, int Dim>
void fast_goes_on() {
  World<Real, Dim> world = crowd<Real, Dim>(6, true), again, undisturbed = world;
  FastMotion<Real, Dim> motion(world, {.contact_events = 1000}), motion_again(again, {.contact_events = 1000});
  FastMotion<Real, Dim> alone(undisturbed);
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(motion.advance());
    ASSERT_TRUE(alone.advance());
  }
  ASSERT_TRUE(restore(snapshot(world, motion), again, motion_again));
  expect_equal(world, again);
  EXPECT_EQ(snapshot(world, motion), snapshot(again, motion_again));
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(motion.advance());
    ASSERT_TRUE(alone.advance());
    ASSERT_TRUE(motion_again.advance());
    ASSERT_EQ(motion.contact_events().size(), motion_again.contact_events().size()) << i;
  }
  expect_equal(world, again);
  expect_equal(undisturbed, again);
}
TEST(Snapshot, FastMotionGoesOnToTheSameBits) {
  fast_goes_on<double, 3>();
  fast_goes_on<double, 2>();
  fast_goes_on<float, 3>();
  fast_goes_on<float, 2>();
}

// A body comes, or goes, or another one comes in its place, or one is lifted, after the step in which all have fallen
// asleep.
TEST(Snapshot, GoesOnWhereBodiesHaveChangedSince) {
  for (int change = 0; change < 5; ++change) {
    World<double, 2> world;
    world.gravity = {{0, -9.81}};
    ASSERT_TRUE(world.add_wall({.normal = {{0, 1}}}));
    for (const double x : {0.0, 0.1, 8.0, 8.2})
      ASSERT_TRUE(world.add({.shape = Box<double, 2>{}, .position = {{x, x == 0.1 || x == 8.2 ? 1.5 : 0.5}}}));
    const FastOptions<double> options{.sleep_after = 0.3};
    FastMotion<double, 2> motion(world, options);
    for (int k = 0; k < 100; ++k) ASSERT_TRUE(motion.advance());
    ASSERT_EQ(motion.statistics().asleep, 4u);
    if (change == 1 || change == 3) {
      ASSERT_TRUE(world.remove(world.handle(0)));
    }
    if (change == 2 || change == 3) {
      ASSERT_TRUE(world.add({.shape = Box<double, 2>{}, .position = {{4, 0.6}}}));
    }
    if (change == 4) world.position[1][1] += 0.5;
    World<double, 2> restored;
    FastMotion<double, 2> of_restored(restored, options);
    const Status status = restore(snapshot(world, motion), restored, of_restored);
    ASSERT_TRUE(status) << change << ' ' << describe(status);
    for (int k = 0; k < 100; ++k) {
      ASSERT_TRUE(motion.advance() && of_restored.advance());
      ASSERT_EQ(state_hash(restored), state_hash(world)) << change << " step " << k;
      ASSERT_EQ(of_restored.statistics().asleep, motion.statistics().asleep) << change << " step " << k;
    }
    EXPECT_EQ(motion.statistics().asleep, world.size()) << change;
  }
}
TEST(Snapshot, HandlesSurvive) {
  World<double, 3> world;
  const auto a = world.add({}), b = world.add({.position = {{5, 0, 0}}});
  ASSERT_TRUE(world.remove(*a));
  World<double, 3> again;
  ASSERT_TRUE(restore(snapshot(world), again));
  EXPECT_FALSE(again.contains(*a));
  ASSERT_TRUE(again.contains(*b));
  EXPECT_EQ(again.position_of(*b)[0], 5);
  EXPECT_EQ(*again.add({}), *world.add({}));
}

TEST(Snapshot, SaysWhatIsWrongAndLeavesTheWorldAlone) {
  World<double, 3> world = crowd<double, 3>(7, true);
  const Bytes before = snapshot(world);
  World<double, 2> flat;
  World<float, 3> single;
  EXPECT_FALSE(restore(before, flat));
  EXPECT_FALSE(restore(before, single));
  EXPECT_FALSE(restore({}, world));
  ExactMotion motion(world);
  EXPECT_FALSE(restore(before, world, motion));  // without a motion
  World<double, 3> with_law;
  with_law.force_laws.emplace_back();
  EXPECT_FALSE(restore(before, with_law));
  EXPECT_EQ(snapshot(world), before);
}

// Every changed byte and every truncation is detected. With a corrected checksum nothing crashes: a restored world
// moves, or refuses with a reason.
TEST(Snapshot, CorruptBytesAreRefused) {
  World<double, 2> world = crowd<double, 2>(8, false);
  ExactMotion motion(world, {.contact_time = 1e-3});
  ASSERT_TRUE(motion.advance_to(1));
  const Bytes bytes = snapshot(world, motion);
  World<double, 2> again;
  ExactMotion motion_again(again, {.most_events = 2000});
  std::mt19937 engine(9);
  for (int k = 0; k < 300; ++k) {
    Bytes wrong = bytes;
    const std::size_t at = engine() % wrong.size();
    wrong[at] ^= static_cast<std::byte>(1 + engine() % 255);
    EXPECT_EQ(restore(wrong, again, motion_again).message.substr(0, 5), "byte ") << at;
    wrong = bytes;
    wrong.resize(engine() % wrong.size());
    EXPECT_EQ(restore(wrong, again, motion_again).message.substr(0, 5), "byte ");
    EXPECT_EQ(again.size(), 0u);
  }
  for (int k = 0; k < 300; ++k) {
    Bytes wrong(bytes.begin(), bytes.end() - 8);
    for (int n = 0; n < 3; ++n) wrong[20 + engine() % (wrong.size() - 20)] = static_cast<std::byte>(engine() % 256);
    ByteWriter sum;
    sum(checksum(wrong));
    wrong.insert(wrong.end(), sum.bytes().begin(), sum.bytes().end());
    if (restore(wrong, again, motion_again)) (void)motion_again.advance_to(again.time + 0.01);
  }
}

// Every byte of a spring's two ends is significant: a restored snapshot is written again as it was read.
TEST(Snapshot, OfSpringsHasNoBytesThatMeanNothing) {
  World<double, 2> world;
  const auto ball = world.add({}), other = world.add({.position = {{3, 0}}});
  world.springs.push_back({.a = *ball, .b = *other, .stiffness = 2});
  world.springs.push_back({.a = *ball, .b = Vector<double, 2>{{1, 2}}});
  const Bytes bytes = snapshot(world);
  std::size_t taken = 0;
  for (std::size_t at = 15; at + 8 < bytes.size(); ++at) {  // after the header
    Bytes wrong(bytes.begin(), bytes.end() - 8);
    wrong[at] ^= std::byte{1};
    ByteWriter sum;
    sum(checksum(wrong));
    wrong.insert(wrong.end(), sum.bytes().begin(), sum.bytes().end());
    World<double, 2> again;
    if (!restore(wrong, again)) continue;
    ++taken;
    EXPECT_EQ(snapshot(again), wrong) << at;
  }
  EXPECT_GT(taken, 100u);  // most changes are accepted
}

// The initial inputs of the fuzzer have the current version of the format; others would be refused at the version
// number.
TEST(Snapshot, TheFuzzersInputsAreOfThisVersion) {
  const auto input = [](const std::string& name) {
    std::ifstream file(CONTINUO_SOURCE_DIR "/tests/fuzz/snapshot/" + name, std::ios::binary);
    Bytes bytes;
    for (std::istreambuf_iterator<char> at(file), end; at != end; ++at) bytes.push_back(static_cast<std::byte>(*at));
    return bytes;
  };
  World<double, 3> world;
  World<float, 2> flat;
  EXPECT_TRUE(restore(input("world"), world));
  ExactMotion exact(world, {.contact_events = 10});
  FastMotion fast(world, {.contact_events = 10});
  EXPECT_TRUE(restore(input("exact"), world, exact));
  EXPECT_TRUE(restore(input("exact_heap"), world, exact));
  EXPECT_TRUE(restore(input("exact_islands"), world, exact));
  EXPECT_TRUE(restore(input("fast"), world, fast));
  ExactMotion exact_flat(flat, {.contact_events = 10});
  FastMotion fast_flat(flat, {.contact_events = 10});
  EXPECT_TRUE(restore(input("exact_flat"), flat, exact_flat));
  EXPECT_TRUE(restore(input("fast_flat"), flat, fast_flat));
  const auto recording = Recording<double, 3>::read(input("../recording/bodies"));
  ASSERT_TRUE(recording) << describe(recording.status());
  EXPECT_TRUE(recording->is_whole);
}

}  // namespace
}  // namespace continuo::snapshot_test
