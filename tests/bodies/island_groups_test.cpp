// Small islands go through all substeps of a step together, each group by one thread: the motion is that of islands
// that are swept pass by pass, to the bit.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/rigid_stepping/island_groups.hpp>

namespace continuo::island_groups_test {
namespace {

using test::advance;
using test::upright_vector;

TEST(IslandGroups, HaveEachIslandOnceThatMayJoin) {
  std::mt19937 engine(5);
  for (int trial = 0; trial < 20; ++trial) {
    // Chains of bodies, with a block between each and the next one, and several at some.
    std::vector<RowBlock> blocks;
    std::uint32_t bodies = 0;
    while (bodies < 3000) {
      const std::uint32_t size = 2 + static_cast<std::uint32_t>(engine() % (trial % 2 == 0 ? 50 : 900));
      for (std::uint32_t i = 0; i + 1 < size; ++i)
        for (std::uint32_t n = 0; n <= engine() % 2; ++n) blocks.push_back({.a = bodies + i, .b = bodies + i + 1});
      bodies += size;
    }
    RigidIslands islands;
    islands.find(bodies, blocks, [](std::uint32_t) { return true; });
    const auto may_join = [](std::size_t k) { return k % 3 != 0; };
    IslandGroups groups;
    EXPECT_FALSE(groups.find(islands, bodies, may_join));
    EXPECT_TRUE(groups.find(islands, bodies, may_join));
    std::vector<std::size_t> blocks_of(groups.size());
    std::vector<std::uint32_t> listed(bodies);
    for (std::size_t group = 1; group < groups.size(); ++group)
      for (const std::uint32_t i : groups.bodies(group)) {
        EXPECT_EQ(groups.of(i), group);
        ++listed[i];
      }
    for (std::size_t k = 0; k < islands.size(); ++k) {
      const std::size_t group = groups.of(islands.bodies(k)[0]);
      const bool joins = may_join(k) && islands.blocks(k).size() <= IslandGroups::most_blocks;
      EXPECT_EQ(group != 0, joins);
      blocks_of[group] += islands.blocks(k).size();
      for (const std::uint32_t i : islands.bodies(k)) {
        EXPECT_EQ(groups.of(i), group);
        EXPECT_EQ(listed[i], joins ? 1u : 0u);
      }
    }
    for (std::size_t group = 1; group + 1 < groups.size(); ++group)
      EXPECT_GE(blocks_of[group], IslandGroups::blocks_of_group);
  }
}

/// Pyramids of boxes on a floor, not quite side by side, and boxes that fly among them.
template <int Dim>
World<double, Dim> pyramids(std::uint32_t seed) {
  World<double, Dim> world = test::world_on_slope<Dim>(0, 0.6);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform;
  const int base = 7;
  for (int n = 0; n < 24; ++n)
    for (int row = 0; row < base; ++row)
      for (int k = row; k < base; ++k)
        test::add_box<Dim>(world,
                           upright_vector<Dim>(9 * n + 0.5 * row + k - row + 0.01 * uniform(engine), 0.5 + 1.02 * row));
  for (int n = 0; n < 12; ++n) {
    const BodyHandle box = test::add_box<Dim>(world, upright_vector<Dim>(200 * uniform(engine), 8 + 0.1 * n));
    world.velocity[world.index(box)] = upright_vector<Dim>(4 * uniform(engine) - 2, -2);
  }
  return world;
}
// With a torque, which is 0 here, nothing is known of a step before its substeps. Nothing turns by more than 0.1
// radians in a step: what does may not gain energy, unless there are torques.
template <int Dim>
void expect_motion_of_islands_that_are_swept_pass_by_pass() {
  World<double, Dim> grouped = pyramids<Dim>(Dim), by_threads = grouped, swept = grouped;
  swept.torque_laws.emplace_back([](const auto&, double, const auto&, auto) {});
  FastMotion<double, Dim> of_grouped(grouped), of_threads(by_threads, {.threads = 3}), of_swept(swept);
  const auto turn_far = [&] {
    return std::ranges::any_of(grouped.spin, [](const auto& spin) { return length(spin) > 0.09 * 60; });
  };
  int steps = 0;
  for (; steps < 120 && !turn_far(); ++steps) {
    advance<Dim>(of_grouped, 1), advance<Dim>(of_threads, 1), advance<Dim>(of_swept, 1);
    for (std::size_t i = 0; i < grouped.size(); ++i) {
      ASSERT_EQ(grouped.position[i], swept.position[i]) << i << " after " << steps;
      ASSERT_EQ(grouped.velocity[i], swept.velocity[i]) << i << " after " << steps;
      ASSERT_EQ(grouped.spin[i], swept.spin[i]) << i << " after " << steps;
      ASSERT_EQ(grouped.position[i], by_threads.position[i]) << i << " after " << steps;
    }
  }
  EXPECT_GT(steps, 20);  // until some box that flies has landed and turns
}
TEST(IslandGroups, MoveAsIslandsThatAreSweptPassByPass) {
  expect_motion_of_islands_that_are_swept_pass_by_pass<2>();
  expect_motion_of_islands_that_are_swept_pass_by_pass<3>();
}

}  // namespace
}  // namespace continuo::island_groups_test
