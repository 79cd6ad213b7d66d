// The integrators of the fast world on bodies and springs: order against the closed form, and the limits of stability.
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>

namespace continuo::integrator_test {
namespace {

/// Two bodies of mass 1 and 3 on a spring of stiffness 3: the distance swings with omega^2 = 3 (1/1 + 1/3) = 4.
World<double, 2> pair_on_a_spring(double damping = 0) {
  World<double, 2> world;
  EXPECT_TRUE(world.ignore(0, 0));  // no contacts
  const auto a = world.add({.position = {{0, 0}}, .mass = 1}), b = world.add({.position = {{4.5, 0}}, .mass = 3});
  world.springs.push_back({.a = *a, .b = *b, .rest_length = 4, .stiffness = 3, .damping = damping});
  return world;
}
constexpr double omega = 2;

double distance(const World<double, 2>& world) {
  return world.position[1][0] - world.position[0][0];
}

/// The greater of the errors of distance and rate after time 3, in steps of h.
double error_of(ForceIntegrator integrator, double h) {
  World<double, 2> world = pair_on_a_spring();
  FastMotion<double, 2> motion(world, {.step = h, .substeps = 1, .integrator = integrator});
  for (int i = 0; i < std::lround(3 / h); ++i) EXPECT_TRUE(motion.advance());
  const double x = 4 + 0.5 * std::cos(omega * 3), v = -0.5 * omega * std::sin(omega * 3);
  return std::max(std::abs(distance(world) - x), std::abs(world.velocity[1][0] - world.velocity[0][0] - v));
}

// The loop x += h v; v += h a(x, v), written out for both bodies of a damped spring. The world adds and takes away h a
// where the loop does not: each step rounds a little differently.
TEST(ForceIntegrator, PositionFirstGivesTheNumbersOfItsLoop) {
  const double h = 0.01, stiffness = 3, damping = 0.4, rest = 4;
  World<double, 2> world = pair_on_a_spring(damping);
  FastMotion<double, 2> motion(
      world, {.step = h, .substeps = 1, .integrator = ForceIntegrator::symplectic_euler_position_first});
  double x[]{0, 4.5}, v[]{0, 0};
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(motion.advance());
    for (int k = 0; k < 2; ++k) x[k] += h * v[k];
    const double force = stiffness * (x[1] - x[0] - rest) + damping * (v[1] - v[0]);
    v[0] += h * force / 1, v[1] -= h * force / 3;
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_NEAR(world.position[k][0], x[k], 1e-12) << i;
      ASSERT_NEAR(world.velocity[k][0], v[k], 1e-12) << i;
    }
  }
}

// Halving h divides the error by 2^order; the next term is h times smaller, 1/600 here.
TEST(ForceIntegrator, HasItsOrder) {
  struct Case {
    ForceIntegrator integrator;
    double order;
  };
  for (const Case& one :
       {Case{ForceIntegrator::semi_implicit_euler, 1}, Case{ForceIntegrator::symplectic_euler_position_first, 1},
        Case{ForceIntegrator::implicit_euler, 1}, Case{ForceIntegrator::explicit_euler, 1},
        Case{ForceIntegrator::central_difference, 2}}) {
    const double h = 1.0 / 600, order = std::log2(error_of(one.integrator, h) / error_of(one.integrator, h / 2));
    EXPECT_NEAR(order, one.order, 0.03) << static_cast<int>(one.integrator);
  }
}

/// The greatest stretch of the spring in so many steps.
double greatest_swing(ForceIntegrator integrator, double h, int steps) {
  World<double, 2> world = pair_on_a_spring();
  FastMotion<double, 2> motion(world, {.step = h, .substeps = 1, .integrator = integrator});
  double greatest = 0;
  for (int i = 0; i < steps && greatest < 3; ++i) {
    EXPECT_TRUE(motion.advance());
    greatest = std::max(greatest, std::abs(distance(world) - 4));
  }
  return greatest;
}

// Below h = 2 / omega the oscillation is bounded: the quadratic form that the methods conserve, x^2 -+ h x v + v^2 /
// omega^2 or x^2 (1 - (h omega)^2 / 4) + v^2 / omega^2, bounds it by 0.5 / sqrt(1 - (h omega / 2)^2). Above, it grows.
TEST(ForceIntegrator, IsStableUpToTwoOverOmega) {
  for (const ForceIntegrator integrator :
       {ForceIntegrator::semi_implicit_euler, ForceIntegrator::symplectic_euler_position_first,
        ForceIntegrator::central_difference}) {
    for (const double part : {0.5, 0.9, 0.97}) {
      const double bound = 0.5 / std::sqrt(1 - part * part);
      EXPECT_LE(greatest_swing(integrator, part * 2 / omega, 3000), bound * (1 + 1e-9)) << part;
    }
    EXPECT_GT(greatest_swing(integrator, 1.01 * 2 / omega, 3000), 3.0);
  }
}

// Explicit Euler multiplies the amplitude by sqrt(1 + (h omega)^2) in each step, implicit Euler divides it by as much.
TEST(ForceIntegrator, EulersGrowAndDamp) {
  for (const double h : {0.05, 0.5, 5.0}) {
    const int steps = h < 0.1 ? 20 : 3;
    for (const ForceIntegrator integrator : {ForceIntegrator::explicit_euler, ForceIntegrator::implicit_euler}) {
      if (h > 1 && integrator == ForceIntegrator::explicit_euler) continue;  // the spring would turn over
      World<double, 2> world = pair_on_a_spring();
      FastMotion<double, 2> motion(world, {.step = h, .substeps = 1, .integrator = integrator});
      for (int i = 0; i < steps; ++i) ASSERT_TRUE(motion.advance());
      const double stretch = distance(world) - 4, rate = world.velocity[1][0] - world.velocity[0][0];
      const double factor =
          std::pow(1 + h * h * omega * omega, (integrator == ForceIntegrator::explicit_euler ? 0.5 : -0.5) * steps);
      EXPECT_NEAR(std::hypot(stretch, rate / omega), 0.5 * factor, 1e-7 * factor) << h;
    }
  }
}

// A chain of 30 stiff springs under gravity, far above the limit of the explicit methods: implicit Euler brings it to
// its equilibrium, where spring i carries all that hangs below it.
TEST(ForceIntegrator, ImplicitEulerHasNoLimit) {
  World<double, 3> world;
  world.gravity = {{0, 0, -10}};
  const int links = 30;
  BodyHandle above{};
  for (int i = 0; i < links; ++i) {
    const auto ball =
        world.add({.shape = Sphere<double>{0.1}, .position = {{0.01 * i, 0, -1.0 * (i + 1)}}, .mass = 0.1});
    ASSERT_TRUE(ball);
    if (i == 0)
      world.springs.push_back({.a = *ball, .b = Vector<double, 3>{}, .rest_length = 1, .stiffness = 1e5, .damping = 1});
    if (i > 0) world.springs.push_back({.a = *ball, .b = above, .rest_length = 1, .stiffness = 1e5, .damping = 1});
    above = *ball;
  }
  // The highest omega is 2 sqrt(k/m) = 2000: semi-implicit Euler needs steps below 1/1000.
  FastMotion<double, 3> motion(world, {.step = 0.05, .substeps = 1, .integrator = ForceIntegrator::implicit_euler});
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(motion.advance()) << i;
  double z = 0;
  for (int i = 0; i < links; ++i) {
    z -= 1 + 0.1 * 10 * (links - i) / 1e5;
    EXPECT_NEAR(world.position[static_cast<std::size_t>(i)][2], z, 2e-4);
  }
}

// Parabolas of constant forces are exact by all integrators but those that move by the velocity at the start: their
// error is that of a delay of h / 2.
TEST(ForceIntegrator, FollowsParabolas) {
  for (const ForceIntegrator integrator : {ForceIntegrator::semi_implicit_euler, ForceIntegrator::implicit_euler,
                                           ForceIntegrator::symplectic_euler_position_first,
                                           ForceIntegrator::central_difference, ForceIntegrator::explicit_euler}) {
    World<double, 2> world;
    world.gravity = {{0, -10}};
    ASSERT_TRUE(world.add({.velocity = {{1, 2}}, .mass = 2}));
    world.constant_force[0] = {{4, 0}};
    FastMotion<double, 2> motion(world, {.step = 0.1, .substeps = 1, .integrator = integrator});
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(motion.advance());
    const bool by_start =
        integrator == ForceIntegrator::explicit_euler || integrator == ForceIntegrator::symplectic_euler_position_first;
    const double late = by_start ? 0.1 / 2 : 0;
    EXPECT_NEAR(world.position[0][0], 1 + 2.0 / 2 - 2 * late, 1e-7);
    EXPECT_NEAR(world.position[0][1], 2 - 10.0 / 2 + 10 * late, 1e-7);
  }
}

}  // namespace
}  // namespace continuo::integrator_test
