// Rolling resistance of persistent contacts under general forces: the law of rolling.hpp, by closed forms.
#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "round.hpp"
#include <continuo/bodies/exact_motion.hpp>

namespace continuo::persistent_rolling_test {
namespace {

/// A force law of zero, which prevents the motion on parabolas.
template <int Dim>
void disguise(World<double, Dim>& world) {
  world.force_laws.emplace_back([](const auto&, double, auto, auto, auto) {});
}

/// A body that rolls on the floor z = 0 (or y = 0) at `speed` along x.
template <int Dim>
void add_rolling(World<double, Dim>& world, double speed, const Material<double>& material) {
  Vector<double, Dim> position{}, velocity{};
  position[Dim - 1] = 0.5;
  velocity[0] = speed;
  Spin<double, Dim> spin{};
  spin[Dim - 2] = (Dim == 2 ? -1 : 1) * speed / 0.5;
  ASSERT_TRUE(world.add({.position = position, .velocity = velocity, .spin = spin, .material = material}));
}
template <class T>
class HeldRolling : public testing::Test {};
TYPED_TEST_SUITE(HeldRolling, round::DiscAndBall);

// v' = -rho g / (1 + c) until the body stops, exact to rounding in the motion under gravity alone. It is stopped at
// half of the speed gained within 1e-5 of the time of a fall of its radius, 1e-5 m/s: places differ by v^2 / 2a, 1e-10
// m.
TYPED_TEST(HeldRolling, EndsByResistanceAsUnderGravityAlone) {
  constexpr int dim = TypeParam::dim;
  World<double, dim> world;
  world.gravity[dim - 1] = -10;
  const Material<double> material{.restitution = 0, .friction = 0.3, .rolling_resistance = 0.05};
  ASSERT_TRUE(world.add_wall({.material = material}));
  add_rolling(world, 2, material);
  World<double, dim> known = world;
  disguise(world);
  ExactMotion motion(world), under_gravity(known);
  const double slows = 0.05 * 10 / (1 + TypeParam::inertia), stops = 2 / slows;
  for (const double t : {1.0, stops - 0.1, stops + 0.1, 100.0}) {
    ASSERT_TRUE(motion.advance_to(t));
    ASSERT_TRUE(under_gravity.advance_to(t));
    const double on = std::min(t, stops);
    EXPECT_NEAR(world.position[0][0], 2 * on - slows * on * on / 2, 1e-8) << t;
    EXPECT_NEAR(world.position[0][0], known.position[0][0], 1e-8) << t;
    EXPECT_LT(length(world.spin[0] - known.spin[0]), 1e-8) << t;
  }
  EXPECT_LT(length(world.velocity[0]), 1e-12);
}

// With drag, m (1 + c) v' = -rho m g - k v: v = (v0 + b) exp(-a t) - b, of a = k / (m (1 + c)) and b = rho m g / k; it
// stops at ln(1 + v0 / b) / a, after (v0 - b ln(1 + v0 / b)) / a.
TYPED_TEST(HeldRolling, EndsByResistanceAndDrag) {
  constexpr int dim = TypeParam::dim;
  World<double, dim> world;
  world.gravity[dim - 1] = -10;
  world.drag.linear = 0.4;
  const Material<double> material{.restitution = 0, .friction = 0.3, .rolling_resistance = 0.05};
  ASSERT_TRUE(world.add_wall({.material = material}));
  add_rolling(world, 2, material);
  const double m = world.mass[0], a = 0.4 / (m * (1 + TypeParam::inertia)), b = 0.05 * m * 10 / 0.4;
  const double stops = std::log(1 + 2 / b) / a;
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(stops / 2));
  EXPECT_NEAR(world.velocity[0][0], (2 + b) * std::exp(-a * stops / 2) - b, 1e-8);
  ASSERT_TRUE(motion.advance_to(stops + 1));
  EXPECT_NEAR(world.position[0][0], (2 - b * std::log(1 + 2 / b)) / a, 1e-8);
  EXPECT_LT(length(world.velocity[0]), 1e-12);
}

// On a slope it stays while tan <= rho, and else rolls with (g sin - rho g cos) / (1 + c).
TYPED_TEST(HeldRolling, BeginsWhereASlopeIsSteeperThanTheResistance) {
  constexpr int dim = TypeParam::dim;
  for (const double tan : {0.049, 0.051}) {
    World<double, dim> world;
    disguise(world);
    const double slope = std::atan(tan);
    world.gravity[0] = 10 * std::sin(slope);
    world.gravity[dim - 1] = -10 * std::cos(slope);
    const Material<double> material{.restitution = 0, .friction = 0.3, .rolling_resistance = 0.05};
    ASSERT_TRUE(world.add_wall({.material = material}));
    add_rolling(world, 0, material);
    ExactMotion motion(world);
    ASSERT_TRUE(motion.advance_to(10));
    const double a = tan > 0.05 ? 10 * std::cos(slope) * (tan - 0.05) / (1 + TypeParam::inertia) : 0.0;
    EXPECT_NEAR(world.position[0][0], 50 * a, 1e-8) << tan;
    EXPECT_NEAR(world.velocity[0][0], 10 * a, 1e-8) << tan;
  }
}

// A spring pulls a rolling body: (1 + c) m x'' = -k x - rho m g sign(x'). Each half oscillation ends 2 rho m g / k
// closer to 0, until the spring is too weak: from 1 by 0.3 each, x = 1, -0.7, 0.4, -0.1, where k x < rho m g.
TYPED_TEST(HeldRolling, SwingsOnASpringUntilResistanceHoldsIt) {
  constexpr int dim = TypeParam::dim;
  World<double, dim> world;
  world.gravity[dim - 1] = -10;
  const Material<double> material{.restitution = 0, .friction = 1, .rolling_resistance = 0.06};
  ASSERT_TRUE(world.add_wall({.material = material}));
  Vector<double, dim> position{};
  position[0] = 1, position[dim - 1] = 0.5;
  const auto body = world.add({.position = position, .mass = 2, .material = material});
  world.force_laws.emplace_back(
      [](const auto&, double, auto x, auto, auto force) { force[0][0] -= 0.06 * 2 * 10 / 0.15 * x[0][0]; });
  ExactMotion motion(world);
  const double half = std::acos(-1.0) * std::sqrt(2 * (1 + TypeParam::inertia) * 0.15 / (0.06 * 2 * 10));
  const std::array<double, 6> turns{1, -0.7, 0.4, -0.1, -0.1, -0.1};
  for (std::size_t k = 0; k < turns.size(); ++k) {
    ASSERT_TRUE(motion.advance_to(static_cast<double>(k) * half));
    // At a turning point the velocity is zero, so an error of 1e-5 s has an effect of second order.
    EXPECT_NEAR(world.position_of(*body)[0], turns[k], 1e-7) << k;
  }
}

// Rolling resistance beyond the limit of friction acts like that limit, less 1e-8 so that the body does not slip.
TYPED_TEST(HeldRolling, IsHeldBackByNoMoreThanFriction) {
  constexpr int dim = TypeParam::dim;
  World<double, dim> world;
  disguise(world);
  world.gravity[dim - 1] = -10;
  const Material<double> material{.restitution = 0, .friction = 0.2, .rolling_resistance = 5};
  ASSERT_TRUE(world.add_wall({.material = material}));
  add_rolling(world, 3, material);
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(1));
  EXPECT_NEAR(world.velocity[0][0], 3 - 0.2 * 10, 1e-7);
  ASSERT_TRUE(motion.advance_to(3));
  EXPECT_NEAR(world.position[0][0], 3 * 1.5 / 2, 1e-7);
}

// Two equal balls, drawn together by a spring of force F in space, one spinning about an axis across the line between
// them: friction F mu rubs until the surfaces move as one, and then resistance rho r F acts on the difference of the
// spins, which the surfaces' slip does not see. From spins +w and -w, that roll on each other as gear wheels do, each
// loses rho r F / J a second.
TEST(PersistentContacts, WheelsInGearAreHeldBackByRollingResistance) {
  World<double, 3> world;
  const Material<double> material{.restitution = 0, .friction = 0.5, .rolling_resistance = 0.02};
  const auto a = world.add({.position = {{-0.5, 0, 0}}, .spin = {{0, 0, 4}}, .mass = 1, .material = material});
  const auto b = world.add({.position = {{0.5, 0, 0}}, .spin = {{0, 0, -4}}, .mass = 1, .material = material});
  world.springs.push_back({.a = *a, .b = *b, .rest_length = 0.5, .stiffness = 12});
  ExactMotion motion(world);
  const double J = 0.4 * 0.25, F = 6, slows = 0.02 * 0.5 * F / J;
  ASSERT_TRUE(motion.advance_to(2));
  EXPECT_NEAR(world.spin[0][2], 4 - 2 * slows, 1e-8);
  EXPECT_NEAR(world.spin[1][2], -4 + 2 * slows, 1e-8);
  ASSERT_TRUE(motion.advance_to(4 / slows + 1));
  EXPECT_LT(length(world.spin[0]) + length(world.spin[1]), 1e-8);
  EXPECT_LT(length(momentum(world)) + length(angular_momentum(world)), 1e-10);
}

}  // namespace
}  // namespace continuo::persistent_rolling_test
