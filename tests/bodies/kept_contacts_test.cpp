// The contacts of a heap are gathered only when they change, their materials are combined only when those change, and
// what sweeps need of them stays in lanes until then: nothing of it is seen in the motion.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/snapshot.hpp>

namespace continuo::kept_contacts_test {
namespace {

using test::advance;
using test::upright_vector;

/// Columns of boxes of two sizes that fall on a floor between walls.
template <int Dim>
World<double, Dim> heap(std::size_t columns, std::size_t rows) {
  World<double, Dim> world = test::world_on_slope<Dim>(0, 0.6);
  const double width = 1.1 * static_cast<double>(columns);
  for (const double side : {1.0, -1.0})
    EXPECT_TRUE(world.add_wall({.normal = upright_vector<Dim>(side, 0), .offset = side < 0 ? -width : -0.6}));
  for (std::size_t i = 0; i < columns; ++i)
    for (std::size_t j = 0; j < rows; ++j)
      test::add_box<Dim>(world, upright_vector<Dim>(1.1 * static_cast<double>(i) + (j % 2 == 0 ? 0 : 0.3),
                                                    0.6 + 1.05 * static_cast<double>(j)));
  return world;
}

/// One of the things that a caller may do between two steps.
template <int Dim>
void change(World<double, Dim>& world, std::mt19937& engine) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(engine() % n); };
  const std::size_t i = below(world.size());
  switch (below(8)) {
    case 0:
      world.material[i].friction = 0.1 * static_cast<double>(below(10));
      break;
    case 1:
      world.material[i].restitution = 0.1 * static_cast<double>(below(5));
      break;
    case 2:
      world.velocity[i][Dim - 1] += 3;
      break;
    case 3:
      EXPECT_TRUE(world.remove(world.handle(i)));
      break;
    case 4: {
      BodyTraits<double> traits = world.traits(i);
      traits.spin_damping = traits.spin_damping > 0 ? 0 : 0.1;
      EXPECT_TRUE(world.set_traits(world.handle(i), traits));
      break;
    }
    case 5:
      world.mass[i] *= 2, world.inverse_mass[i] /= 2;
      break;
    case 6:
      test::add_box<Dim>(world, upright_vector<Dim>(static_cast<double>(below(10)), 12));
      break;
    default:
      world.combine_rule.friction = static_cast<Combine>(below(5));
  }
}

// A filter that lets everything push is asked for each contact in each step, so that all is gathered anew.
template <int Dim>
void expect_motion_of_contacts_gathered_anew(std::uint32_t seed, std::size_t columns, std::size_t rows,
                                             bool has_mesh = false) {
  World<double, Dim> kept = heap<Dim>(columns, rows);
  if constexpr (Dim == 2)
    if (has_mesh) {
      EXPECT_TRUE(kept.add_mesh({.shape = Chain<double>{.points = {{{5, 30}}, {{10, 30}}}}}));
    }
  World<double, Dim> anew = kept;
  anew.may_push = [](const auto&, std::size_t, std::size_t, const auto&) { return true; };
  const FastOptions<double> options{.sleep_after = 0.5};
  FastMotion<double, Dim> with_kept(kept, options), with_anew(anew, options);
  std::mt19937 engine(seed);
  bool has_slept = false;
  for (int k = 0; k < 25; ++k) {
    std::mt19937 same = engine;
    change<Dim>(kept, engine), change<Dim>(anew, same);
    const int steps = 1 + static_cast<int>(engine() % 60);
    advance<Dim>(with_kept, steps), advance<Dim>(with_anew, steps);
    if (k % 4 == 3) {
      const Status restored = restore<double>(snapshot(kept, with_kept), kept, with_kept);
      EXPECT_TRUE(restored) << describe(restored);
    }
    has_slept |= with_kept.statistics().asleep > 0;
    ASSERT_EQ(kept.size(), anew.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      ASSERT_EQ(kept.position[i], anew.position[i]) << "body " << i << " after change " << k << " of seed " << seed;
      ASSERT_EQ(kept.velocity[i], anew.velocity[i]) << "body " << i << " after change " << k << " of seed " << seed;
    }
  }
  EXPECT_TRUE(has_slept);
}
TEST(KeptContacts, GiveTheMotionOfContactsGatheredAnew) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    expect_motion_of_contacts_gathered_anew<2>(seed, 3, 4);    // solved directly
    expect_motion_of_contacts_gathered_anew<2>(seed, 20, 10);  // swept in lanes
    expect_motion_of_contacts_gathered_anew<3>(seed, 15, 10);
    expect_motion_of_contacts_gathered_anew<2>(seed, 20, 10, true);  // beside a mesh that nothing touches
  }
}

/// What a box that slides on a wall at 5 m/s loses in half a second, where `change` acts before; or after a step.
template <class Change>
double speed_lost(Change&& change, bool is_before) {
  World<double, 2> world = test::world_on_slope<2>(0, 0.36);
  world.gravity = {{0, -10}};
  test::add_box<2>(world, {{0, 0.5}}, 1, 0.36);
  FastMotion<double, 2> motion(world);
  advance<2>(motion, 30);  // it has come to rest on the wall
  if (is_before) change(world);
  world.velocity[0][0] = 5;
  advance<2>(motion, 1);
  if (!is_before) change(world);
  const double speed = world.velocity[0][0];
  advance<2>(motion, 30);
  return speed - world.velocity[0][0];
}
// Coulomb's friction takes mu g t = 5 mu of it, whichever of the two materials or the rule has changed, and when.
TEST(KeptContacts, SlideByTheMaterialsOfNow) {
  for (const bool is_before : {true, false}) {
    const auto expect_lost = [&](double mu, auto&& change) {
      EXPECT_NEAR(speed_lost(change, is_before), 5 * mu, 1e-6) << mu << ' ' << is_before;
    };
    expect_lost(0.36, [](auto&) {});
    expect_lost(0, [](auto& world) { world.material[0].friction = 0; });
    expect_lost(0.18, [](auto& world) { world.material[0].friction = 0.09; });  // of 0.36 and 0.09
    expect_lost(0.09, [](auto& world) {
      world.material[0].friction = 0.09;
      world.combine_rule.friction = Combine::minimum;
    });
    expect_lost(0.1296, [](auto& world) { world.combine_rule.friction = Combine::product; });
  }
}

}  // namespace
}  // namespace continuo::kept_contacts_test
