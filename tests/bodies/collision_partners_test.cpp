// Bodies that collide with nobody are not looked up: against all pairs one by one, and when the rules change.
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/rigid_stepping/collision_partners.hpp>

namespace continuo {
namespace {

/// Bodies at random of few categories and groups, some of them fixed.
World<double, 2> random_world(std::mt19937& engine, std::size_t bodies) {
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(engine() % n); };
  World<double, 2> world;
  const bool has_traits = below(4) != 0;
  for (std::size_t k = below(4); k > 0; --k) EXPECT_TRUE(world.ignore(below(3), below(3)));
  for (std::size_t i = 0; i < bodies; ++i) {
    const auto body = world.add({.shape = Sphere<double>{0.5},
                                 .position = {{static_cast<double>(i), 0}},
                                 .fixed = below(3) == 0,
                                 .group = below(3)});
    EXPECT_TRUE(body);
    if (has_traits) {
      EXPECT_TRUE(world.set_traits(*body, {.category = 1u << below(3), .mask = below(8)}));
    }
  }
  return world;
}

TEST(CollisionPartners, AreThoseOfSomePair) {
  std::mt19937 engine(7);
  int lonely = 0;
  for (int world_number = 0; world_number < 2000; ++world_number) {
    const World<double, 2> world = random_world(engine, 1 + engine() % 8);
    const std::vector<std::uint8_t> have = bodies_with_partners(world);
    for (std::size_t i = 0; i < world.size(); ++i) {
      // A body may stand for others of its class, with which it would collide.
      bool has_partner = false;
      for (std::size_t j = 0; j < world.size(); ++j) has_partner |= world.collide(i, j);
      if (have.empty()) {
        EXPECT_TRUE(has_partner || (!world.has_traits() && !world.has_ignored_groups()));
      } else {
        EXPECT_EQ(have[i] != 0, has_partner);
        lonely += has_partner ? 0 : 1;
      }
    }
  }
  EXPECT_GT(lonely, 1000);
}

/// Two boxes above each other that fall onto a floor.
struct TwoBoxes {
  World<double, 2> world;
  std::vector<BodyHandle> boxes;

  TwoBoxes() {
    world.gravity = {{0, -10}};
    EXPECT_TRUE(world.add_wall({.normal = {{0, 1}}}));
    for (const double height : {0.5, 2.5}) {
      const auto box = world.add({.shape = Box<double, 2>{{{1, 1}}}, .position = {{0, height}}});
      EXPECT_TRUE(box);
      boxes.push_back(*box);
      set_mask(*box, 0);
    }
  }
  void set_mask(BodyHandle box, std::uint64_t mask) {
    EXPECT_TRUE(world.set_traits(box, {.category = 1, .mask = mask}));
  }
  [[nodiscard]] double height_of_second() const { return world.position[world.index(boxes[1])][1]; }
};

TEST(CollisionPartners, MayComeAndGoBetweenSteps) {
  TwoBoxes two;
  FastMotion<double, 2> motion(two.world, {});
  const auto run = [&] {
    for (int step = 0; step < 120; ++step) EXPECT_TRUE(motion.advance());
  };
  for (const BodyHandle box : two.boxes) two.set_mask(box, 1);
  run();
  EXPECT_NEAR(two.height_of_second(), 1.5, 0.01);  // on the other box
  for (const BodyHandle box : two.boxes) two.set_mask(box, 0);
  run();
  EXPECT_NEAR(two.height_of_second(), 0.5, 0.01);  // through it, on the floor, which has no mask
  two.world.position[two.world.index(two.boxes[1])] = {{0, 3}};
  for (const BodyHandle box : two.boxes) two.set_mask(box, 1);
  run();
  EXPECT_NEAR(two.height_of_second(), 1.5, 0.01);
}

}  // namespace
}  // namespace continuo
