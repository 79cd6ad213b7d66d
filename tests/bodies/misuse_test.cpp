// What makes no sense is refused with a sentence, and moves nothing.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::misuse_test {
namespace {

using testing::HasSubstr;

World<double, 2> two_discs() {
  World<double, 2> world;
  EXPECT_TRUE(world.add({.position = {{0, 0}}, .velocity = {{1, 0}}}));
  EXPECT_TRUE(world.add({.position = {{5, 0}}}));
  return world;
}

TEST(Misuse, GroupsThatDoNotExistAreRefused) {
  World<double, 2> world;
  EXPECT_THAT(world.ignore(40, 2).message, HasSubstr("from 0 to 31"));
  EXPECT_FALSE(world.ignore(2, 32));
  EXPECT_FALSE(world.has_ignored_groups());
  EXPECT_TRUE(world.ignore(31, 0));
}

TEST(Misuse, BodiesThatDoNotExistAreNowhere) {
  World<double, 2> world = two_discs();
  EXPECT_FALSE(world.contains({}));
  const BodyHandle body = world.handle(1);
  EXPECT_EQ(world.position_of(body)[0], 5);
  EXPECT_TRUE(world.remove(body));
  EXPECT_FALSE(world.contains(body));
  EXPECT_TRUE(std::isnan(world.position_of(body)[0]));
  EXPECT_TRUE(std::isnan(world.velocity_of({99, 1})[1]));
  EXPECT_FALSE(world.remove(body));
}

// A spring between bodies that were never given pulls at none, least of all at the first.
TEST(Misuse, SpringsBetweenNoBodiesPullNothing) {
  World<double, 2> world = two_discs();
  world.springs.push_back({.b = Vector<double, 2>{{0, 9}}, .stiffness = 100});
  FastMotion motion(world);
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(motion.advance());
  EXPECT_EQ(world.position[0][1], 0);
}

TEST(Misuse, OptionsOfTheFastMotion) {
  const auto refusal = [](const FastOptions<double>& options) {
    World<double, 2> world = two_discs();
    FastMotion motion(world, options);
    const Status status = motion.advance();
    EXPECT_EQ(world.position[0][0], 0);
    return status.message;
  };
  EXPECT_THAT(refusal({.step = 0}), HasSubstr("step"));
  EXPECT_THAT(refusal({.substeps = 0}), HasSubstr("substep"));
  EXPECT_THAT(refusal({.hertz = -1}), HasSubstr("hertz"));
  EXPECT_THAT(refusal({.hertz = NAN}), HasSubstr("hertz"));
  EXPECT_THAT(refusal({.damping = -1}), HasSubstr("damping"));
  EXPECT_THAT(refusal({.fastest_push = NAN}), HasSubstr("fastest_push"));
  EXPECT_THAT(refusal({.sleep_after = -1}), HasSubstr("sleep_after"));
  EXPECT_THAT(refusal({.threads = -3}), HasSubstr("thread"));
  EXPECT_THAT(refusal({.registers = 24}), HasSubstr("registers must be 16, 32 or 64 bytes"));
  EXPECT_THAT(refusal({.registers = -16}), HasSubstr("registers"));
}

TEST(Misuse, OptionsOfTheExactMotion) {
  const auto refusal = [](const ExactOptions<double>& options) {
    World<double, 2> world = two_discs();
    ExactMotion motion(world, options);
    return motion.advance_to(1).message;
  };
  EXPECT_THAT(refusal({.tolerance = 0}), HasSubstr("tolerance"));
  EXPECT_THAT(refusal({.tolerance = NAN}), HasSubstr("tolerance"));
  EXPECT_THAT(refusal({.step = -1}), HasSubstr("step"));
  EXPECT_THAT(refusal({.contact_time = -1}), HasSubstr("contact_time"));
}

// Fields that the caller has written, before the motion is made and after.
template <class Motion, class Advance>
void fields_are_checked(Advance&& advance) {
  const auto refusal = [&](auto&& spoil) {
    World<double, 2> world = two_discs();
    Motion motion(world);
    EXPECT_TRUE(advance(motion, 0.1));
    spoil(world);
    const Status status = advance(motion, 0.2);
    EXPECT_FALSE(status);
    return status.message;
  };
  EXPECT_THAT(refusal([](auto& world) { world.radius[1] = -1; }), HasSubstr("the radius of body 1"));
  EXPECT_THAT(refusal([](auto& world) { world.mass[0] = 0; }), HasSubstr("the mass of body 0"));
  EXPECT_THAT(refusal([](auto& world) { world.mass[0] *= 2; }), HasSubstr("inverse_mass of body 0 must be 1 / mass"));
  EXPECT_THAT(refusal([](auto& world) { world.radius.pop_back(); }), HasSubstr("different lengths"));
}
TEST(Misuse, FieldsThatContradictEachOther) {
  fields_are_checked<FastMotion<double, 2>>([](auto& motion, double) { return motion.advance(); });
  fields_are_checked<ExactMotion<double, 2>>([](auto& motion, double t) { return motion.advance_to(t); });

  World<double, 2> world = two_discs();
  world.radius[0] = -1;
  FastMotion motion(world);
  EXPECT_FALSE(motion.advance());
  world.radius[0] = 0.5;
  EXPECT_TRUE(motion.advance());
}

TEST(Misuse, TheFrequencyOfContactsIsSaidWhereItIsLimited) {
  World<double, 2> world = two_discs();
  FastMotion motion(world, {.step = 1.0 / 60, .substeps = 4, .hertz = 1000});
  EXPECT_TRUE(motion.advance());
  EXPECT_NEAR(motion.statistics().hertz, 80, 1e-12);  // a third of 240
}

TEST(Misuse, TimeIsTheStepTimesItsNumber) {
  World<double, 2> world = two_discs();
  FastMotion motion(world, {.step = 0.1});
  for (int k = 1; k <= 1000; ++k) {
    EXPECT_TRUE(motion.advance());
    EXPECT_EQ(world.time, k * 0.1);
  }
}

}  // namespace
}  // namespace continuo::misuse_test
