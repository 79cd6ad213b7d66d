// Materials combined by the rule of their world: rebounding, slipping and rolling in closed form, in every motion.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::materials_test {
namespace {

constexpr double g = 9.81;
constexpr std::array every_way{Combine::average, Combine::minimum, Combine::maximum, Combine::product,
                               Combine::geometric_mean};

/// The combination of 4 c and c by each rule, written out.
double by_hand(Combine how, double c) {
  switch (how) {
    case Combine::average:
      return 2.5 * c;
    case Combine::minimum:
      return c;
    case Combine::maximum:
      return 4 * c;
    case Combine::product:
      return 4 * c * c;
    case Combine::geometric_mean:
      return 2 * c;
  }
  return 0;
}

enum class Motion { exact, forced, fast };

/// `forced`: by the exact motion along integrated paths, under a spring of no stiffness.
void move(World<double, 2>& world, Motion motion, double t) {
  if (motion == Motion::fast) {
    FastMotion<double, 2> fast(world, {.step = 1.0 / 240});
    while (world.time < t - 1e-9) ASSERT_TRUE(fast.advance());
    return;
  }
  if (motion == Motion::forced) world.springs.push_back({.a = world.handle(0), .stiffness = 0});
  ExactMotion<double, 2> exact(world);
  ASSERT_TRUE(exact.advance_to(t));
}

World<double, 2> over_a_floor(const CombineRule& combine_rule, const Material<double>& ball,
                              const Material<double>& floor) {
  World<double, 2> world;
  world.gravity = {{0, -g}};
  world.combine_rule = combine_rule;
  EXPECT_TRUE(world.add_wall({.material = floor}));
  EXPECT_TRUE(world.add({.position = {{0, 0.5}}, .mass = 2, .material = ball}));
  return world;
}

// From a height h above the floor it rebounds to e^2 h, computed from its energy.
TEST(Materials, ABallReboundsByTheRuleOfItsWorld) {
  for (const Combine how : every_way) {
    for (const Motion motion : {Motion::exact, Motion::forced, Motion::fast}) {
      World<double, 2> world = over_a_floor({.restitution = how}, {.restitution = 0.88, .friction = 0},
                                            {.restitution = 0.22, .friction = 0});
      world.position[0][1] = 10.5;
      const double e = by_hand(how, 0.22), fall = std::sqrt(2 * 10 / g);
      move(world, motion, fall * (1 + e / 2));
      const double height = (kinetic_energy(world) + potential_energy(world)) / (2 * g) - 0.5;
      // Exact to rounding, along integrated paths to their tolerance of 1e-10; the fast motion makes the impact at its
      // instant, on the parabola.
      EXPECT_NEAR(height, e * e * 10,
                  motion == Motion::exact    ? 1e-12
                  : motion == Motion::forced ? 1e-8
                                             : 1e-3)
          << static_cast<int>(how) << " " << static_cast<int>(motion);
    }
  }
}

TEST(Materials, TwoBallsPartByTheRuleOfTheirWorld) {
  for (const Combine how : every_way) {
    for (const Motion motion : {Motion::exact, Motion::forced, Motion::fast}) {
      World<double, 2> world;
      world.combine_rule.restitution = how;
      EXPECT_TRUE(world.add({.velocity = {{3, 0}}, .mass = 1, .material = {.restitution = 0.2}}));
      EXPECT_TRUE(world.add({.position = {{2, 0}}, .mass = 1, .material = {.restitution = 0.8}}));
      move(world, motion, 1);
      EXPECT_NEAR(world.velocity[1][0] - world.velocity[0][0], 3 * by_hand(how, 0.2),
                  motion == Motion::forced ? 1e-9 : 1e-12);
    }
  }
}

// It slips at first: v' = -mu g, and with the moment of inertia m r^2 / 2 of a disc it rolls from v = 2/3 v0 on.
TEST(Materials, ADiscSlipsByTheRuleOfItsWorld) {
  for (const Combine how : every_way) {
    for (const Motion motion : {Motion::exact, Motion::forced, Motion::fast}) {
      World<double, 2> world = over_a_floor({.friction = how}, {.friction = 0.4}, {.friction = 0.1});
      world.velocity[0][0] = 6;
      move(world, motion, 0.4);  // the roughest rolls from 1/3 * 6 / (0.4 * 9.81) = 0.51 on
      // The fast motion lets the contact yield at first: by less than one step's impulse of friction, mu g / 240.
      const double mu = by_hand(how, 0.1);
      EXPECT_NEAR(world.velocity[0][0], 6 - mu * g * 0.4, motion == Motion::fast ? mu * g / 240 : 1e-9);
    }
  }
}

// Identical materials give the same results, although the fast motion has a separate path for them.
TEST(Materials, SoDoAllOfOneMaterial) {
  for (const auto& [how, mu] :
       {std::pair(Combine::product, 0.25), {Combine::geometric_mean, 0.5}, {Combine::average, 0.5}}) {
    World<double, 2> world = over_a_floor({.friction = how}, {.friction = 0.5}, {.friction = 0.5});
    world.velocity[0][0] = 6;
    move(world, Motion::fast, 0.3);
    EXPECT_NEAR(world.velocity[0][0], 6 - mu * g * 0.3, mu * g / 240);
  }
}

// A rolling disc is slowed by (1 + 1/2) m a = c m g.
TEST(Materials, ADiscRollsByTheRuleOfItsWorld) {
  for (const Combine how : every_way) {
    for (const Motion motion : {Motion::exact, Motion::fast}) {
      World<double, 2> world =
          over_a_floor({.rolling_resistance = how}, {.rolling_resistance = 0.08}, {.rolling_resistance = 0.02});
      world.velocity[0][0] = 3;
      world.spin[0][0] = -6;
      move(world, motion, 2);
      EXPECT_NEAR(world.velocity[0][0], 3 - by_hand(how, 0.02) * g / 1.5 * 2, motion == Motion::fast ? 0.01 : 1e-9);
    }
  }
}

}  // namespace
}  // namespace continuo::materials_test
