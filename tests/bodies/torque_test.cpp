// Torques of the user's own, against closed forms: exact and by each integrator of the fast motion.
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::torque_test {
namespace {

/// A disc of moment of inertia 1 (mass 2, radius 1) held by a torsion spring of stiffness 4, turned by 0.5: it swings
/// with omega = 2.
World<double, 2> torsion_pendulum() {
  World<double, 2> world;
  EXPECT_TRUE(world.add({.shape = Sphere<double>{1}, .orientation = {{0.5}}, .mass = 2}));
  world.torque_laws.emplace_back(
      [](const auto&, double, const BodyStates<double, 2>& at, auto torque) { torque[0] -= at.orientation[0] * 4.0; });
  return world;
}
double error_after_3(const World<double, 2>& world) {
  return std::max(std::abs(world.orientation[0][0] - 0.5 * std::cos(6)), std::abs(world.spin[0][0] + std::sin(6)));
}

// The tolerance is 1e-10 a step, of some twenty steps.
TEST(Torque, SwingsATorsionPendulumExactly) {
  World<double, 2> world = torsion_pendulum();
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(3));
  EXPECT_LT(error_after_3(world), 2e-9);
}

// Halving h divides the error by 2^order; the next term is h times smaller.
TEST(Torque, KeepsTheOrderOfTheFastIntegrators) {
  const auto error_of = [](ForceIntegrator integrator, double h) {
    World<double, 2> world = torsion_pendulum();
    FastMotion<double, 2> motion(world, {.step = h, .substeps = 1, .integrator = integrator});
    for (int i = 0; i < std::lround(3 / h); ++i) EXPECT_TRUE(motion.advance());
    return error_after_3(world);
  };
  for (const auto integrator : {ForceIntegrator::semi_implicit_euler, ForceIntegrator::explicit_euler,
                                ForceIntegrator::central_difference, ForceIntegrator::implicit_euler}) {
    const double h = 1.0 / 600, order = std::log2(error_of(integrator, h) / error_of(integrator, h / 2));
    EXPECT_NEAR(order, integrator == ForceIntegrator::central_difference ? 2 : 1, 0.03) << static_cast<int>(integrator);
  }
}

// A torque W x L on a ball of moment L = J w turns the spin about W: w(t) = R(W t) w0. In a frame that turns with W the
// ball has the constant spin w0 - W, so that its orientation is exp(W t) exp((w0 - W) t).
TEST(Torque, MakesASpinPrecess) {
  const Vector<double, 3> about{{0, 0, 1.5}}, spin{{2, 1, 0.5}};
  World<double, 3> world;
  ASSERT_TRUE(world.add({.spin = spin}));
  const double inertia = 1 / world.inverse_inertia[0];
  world.torque_laws.emplace_back([=](const auto&, double, const BodyStates<double, 3>& at, auto torque) {
    torque[0] += turning(about, at.spin[0]) * inertia;
  });
  World<double, 3> fast = world;
  ExactMotion motion(world);
  const double t = 2;
  ASSERT_TRUE(motion.advance_to(t));
  const Vector<double, 4> expected = turned(turned(upright<double, 3>(), Vector<double, 3>(spin - about), t), about, t);
  const double c = std::cos(1.5 * t), s = std::sin(1.5 * t);
  const Vector<double, 3> turned_spin{{2 * c - s, 2 * s + c, 0.5}};
  EXPECT_LT(length(world.orientation[0] - expected), 2e-9);  // some twenty steps to 1e-10
  EXPECT_LT(length(world.spin[0] - turned_spin), 2e-9);
  // Of order 2: (spin h)^2 a unit of time, times the time, over 24 and the like.
  FastMotion<double, 3> steps(fast, {.step = 1e-3, .substeps = 1, .integrator = ForceIntegrator::central_difference});
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(steps.advance());
  EXPECT_LT(length(fast.orientation[0] - expected), 1e-5);
  EXPECT_LT(length(fast.spin[0] - turned_spin), 1e-5);
}

// A motor of torque T against friction f m g of a floor: where T > f m g r it slips and the ball gains f g.
TEST(Torque, DrivesABallAlongAFloor) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  ASSERT_TRUE(world.add_wall({.material = {.friction = 0.25}}));
  ASSERT_TRUE(world.add({.shape = Sphere<double>{1}, .position = {{0, 1}}, .mass = 2, .material = {.friction = 0.25}}));
  world.torque_laws.emplace_back([](const auto&, double, const auto&, auto torque) { torque[0][0] -= 8.0; });
  FastMotion<double, 2> motion(world, {.step = 1e-3});
  const auto go_on = [&](int steps) {
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(motion.advance());
    return std::pair(world.velocity[0][0], world.spin[0][0]);
  };
  const auto [v, spin] = go_on(1000);  // a soft contact, overdamped: sunk in to exp(-2 pi 120/20 t)
  const auto [v_end, spin_end] = go_on(500);
  EXPECT_NEAR(v_end - v, 0.25 * 10 * 0.5, 1e-9);
  EXPECT_NEAR(spin_end - spin, -(8 - 0.25 * 2 * 10) * 0.5, 1e-9);  // J = 1
}

}  // namespace
}  // namespace continuo::torque_test
