// Which pairs the fast motion lists, against a search through all, and how often.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <tests/bodies/heaps.hpp>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/time_stepping/body_transfer.hpp>
#include <continuo/bodies/time_stepping/broad_phase.hpp>

namespace continuo::broad_phase_test {
namespace {

// A single fast ball among many at rest searches for neighbours by itself. All pairs are not listed anew on its
// account, which at a speed of 6 and a skin of 0.11 would be every other step. Balls that it passes stay at rest; the
// ball that it hits does not.
TEST(FastMotion, ListsPairsAnewForFewThatAreFastNoOftenerThanTheyReach) {
  for (const bool is_last : {false, true}) {  // it finds the others on either side of its place
    World<double, 3> world;
    const auto add_fast = [&] { EXPECT_TRUE(world.add({.position = {{0, 0, 1.2}}, .velocity = {{6, 0, 0}}})); };
    if (!is_last) add_fast();
    for (int i = 0; i < 400; ++i) ASSERT_TRUE(world.add({.position = {{(i % 20) * 1.5, (i / 20) * 1.5, 0}}}));
    ASSERT_TRUE(world.add({.position = {{5.5, 0.3, 1.2}}}));
    if (is_last) add_fast();
    FastMotion<double, 3> motion(world);
    for (int step = 0; step < 60; ++step) ASSERT_TRUE(motion.advance());
    EXPECT_LE(motion.statistics().lists, 10u);
    const std::size_t met = is_last ? 400 : 401;
    EXPECT_GT(length(world.velocity[met]), 1);
    for (std::size_t i = 0; i < world.size(); ++i)
      if (i != met && i != (is_last ? 401 : 0)) {
        EXPECT_EQ(length(world.velocity[i]), 0) << i;
      }
  }
}

/// Balls of which some are `times` as large as the others, or with 0 of all sizes within three decades; some are fixed,
/// some ignore each other. `speed` in radii per step.
template <class Real, int Dim>
World<Real, Dim> balls_of_many_sizes(std::uint32_t seed, double part, double times, double speed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  World<Real, Dim> world;
  EXPECT_TRUE(world.ignore(1, 2));
  EXPECT_TRUE(world.add_wall({.normal = {{1}}}));
  for (int i = 0; i < 120; ++i) {
    const double radius = times == 0 ? std::pow(10, 3 * uniform(engine) - 2) : uniform(engine) < part ? times : 1;
    BodyDefinition<Real, Dim> ball{.shape = Sphere<Real>{static_cast<Real>(radius)}, .fixed = i % 13 == 0};
    for (std::size_t axis = 0; axis < ball.position.size(); ++axis) {
      ball.position[axis] = static_cast<Real>((axis == 1 ? 40 : 10) * uniform(engine));
      ball.velocity[axis] = static_cast<Real>(60 * speed * (2 * uniform(engine) - 1));
    }
    ball.group = static_cast<std::uint32_t>(i % 3);
    EXPECT_TRUE(world.add(ball));
  }
  return world;
}

/// The sum of two radii and reaches may be rounded in any order.
template <class Real, int Dim>
void expect_all_pairs(const World<Real, Dim>& world, int threads) {
  ThreadTeam team(threads);
  BroadPhase<Real, Dim> list;
  SolverBodies<Real, Dim> bodies;
  ContactRows rows;
  std::vector<std::uint32_t> place_before;
  list.begin(world);
  list.sort(world, place_before);
  team.run([&] {
    load_bodies(team, world, list.order(), list.blocks(), Sleep<Real, Dim>{}, bodies);
    list.list(team, world, bodies, SweptBounds<Real>(bodies, Real(1) / Real(60)), rows);
  });
  ASSERT_EQ(rows.rows(), world.size());
  for (std::uint32_t k = 0; k < world.size(); ++k) {
    const auto row = rows.row(k);
    EXPECT_TRUE(std::ranges::is_sorted(row, std::less_equal<>{}, &ContactEntry::other));  // none twice
    std::vector<std::uint8_t> is_listed(world.size() + 1, 0);
    for (const ContactEntry& entry : row) is_listed[std::min<std::size_t>(entry.other, world.size())] = 1;
    for (std::uint32_t j = 0; j < world.size(); ++j) {
      const bool belongs =
          j != k && bodies.moves(k) && (j > k || !bodies.moves(j)) && world.collide(list.order()[k], list.order()[j]);
      const Real out = bodies.radius(k) + bodies.radius(j) + list.reach_of_list()[k] + list.reach_of_list()[j];
      const Real ratio = length(Vector<Real, Dim>(bodies.x(j) - bodies.x(k))) / out;
      if (std::abs(ratio - 1) < Real(1e-5)) continue;
      EXPECT_EQ(is_listed[j] == 1, belongs && ratio < 1) << k << ' ' << j;
    }
    const bool is_near_wall = bodies.x(k)[0] - bodies.radius(k) <= list.reach_of_list()[k];
    EXPECT_EQ(is_listed.back() == 1, bodies.moves(k) && is_near_wall);
  }
}
template <class Real, int Dim>
void all_pairs_are_listed() {
  const oneapi::tbb::global_control allowed(oneapi::tbb::global_control::max_allowed_parallelism, 8);
  struct Sizes {
    double part, times;
  };
  std::uint32_t seed = 0;
  for (const double speed : {0.01, 3.0})
    for (const auto& [part, times] : {Sizes{0, 0}, Sizes{0, 1}, Sizes{0.01, 15}, Sizes{0.3, 7}, Sizes{0.9, 15}}) {
      SCOPED_TRACE(testing::Message() << Dim << "D, part " << part << " times " << times << " speed " << speed);
      ++seed;
      expect_all_pairs(balls_of_many_sizes<Real, Dim>(seed, part, times, speed), seed % 2 == 0 ? 1 : 3);
    }
}
TEST(BroadPhase, AllPairsAreListedWhateverTheSizes) {
  all_pairs_are_listed<float, 3>();
  all_pairs_are_listed<double, 2>();
}

TEST(BroadPhase, AHeapOfTwoSizesIsTheSameForAnyNumberOfThreads) {
  World<float, 3> world = heap<float>(250, 6, 3);
  for (int i = 0; i < 28; ++i) {
    const Vector<float, 3> at{
        {i % 2 == 0 ? 2.1f : 5.05f, i / 2 % 2 == 0 ? 2.1f : 5.05f, 12.f + 3.2f * static_cast<float>(i / 4)}};
    ASSERT_TRUE(world.add({.shape = Sphere<float>{1.4f}, .position = at}));
  }
  expect_the_same_for_any_number_of_threads(world, {}, 40);
}

}  // namespace
}  // namespace continuo::broad_phase_test
