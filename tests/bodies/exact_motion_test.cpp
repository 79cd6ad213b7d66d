// The exact motion of spheres, against closed forms and conservation laws.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <bench/bodies/overlap.hpp>
#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>

namespace continuo::exact_motion_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
const Material<double> elastic{.restitution = 1, .friction = 0};

/// `count` spheres of radius 1/2 on a grid in a box of edge `edge`, all at speed 5 in random directions.
template <int Dim>
World<double, Dim> gas(std::size_t count, double edge, const Material<double>& material, unsigned seed = 1) {
  World<double, Dim> world;
  Vector<double, Dim> upper;
  for (std::size_t axis = 0; axis < upper.size(); ++axis) upper[axis] = edge;
  EXPECT_TRUE(world.add_container({}, upper, material));
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  std::size_t side = 1;
  while (std::pow(side, Dim) < static_cast<double>(count)) ++side;
  for (std::size_t i = 0; i < count; ++i) {
    BodyDefinition<double, Dim> ball{.material = material};
    std::size_t rest = i;
    for (std::size_t axis = 0; axis < upper.size(); ++axis, rest /= side) {
      ball.position[axis] = (static_cast<double>(rest % side) + 0.5) * edge / static_cast<double>(side);
      ball.velocity[axis] = normal(engine);
    }
    ball.velocity *= 5 / length(ball.velocity);
    EXPECT_TRUE(world.add(ball));
  }
  return world;
}

// Each collision changes the energy of its balls by an ulp or two: the normal is a unit to that. Places are right to an
// ulp of the edge of the box.
template <int Dim>
void keeps_energy_and_room(std::size_t count, double edge, double duration) {
  World<double, Dim> world = gas<Dim>(count, edge, elastic);
  const double energy = kinetic_energy(world);
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(duration));
  EXPECT_GT(motion.statistics().collisions, 20 * count);
  const double collisions_of_each = static_cast<double>(2 * motion.statistics().collisions / count);
  EXPECT_NEAR(kinetic_energy(world) / energy, 1, 2 * epsilon * collisions_of_each);
  EXPECT_LT(deepest_overlap_of_bodies(world), 4 * 20 * epsilon);
  for (const auto& x : world.position)
    for (std::size_t axis = 0; axis < x.size(); ++axis) {
      EXPECT_GT(x[axis], 0.5 - 20 * epsilon);
      EXPECT_LT(x[axis], edge - 0.5 + 20 * epsilon);
    }
}
TEST(ExactMotion, KeepsTheEnergyOfAGas) {
  keeps_energy_and_room<3>(1000, 20, 60);
}
TEST(ExactMotion, KeepsTheEnergyOfAGasInThePlane) {
  keeps_energy_and_room<2>(400, 40, 60);
}

// Away from walls, momentum and angular momentum change by rounding alone, friction and spin or not.
TEST(ExactMotion, KeepsMomentumAndAngularMomentum) {
  World<double, 3> world;
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 125; ++i) {
    const Vector<double, 3> x{{1.5 * (i % 5 - 2), 1.5 * (i / 5 % 5 - 2), 1.5 * (i / 25 - 2)}};
    const double r = 0.4 + 0.1 * uniform(engine);
    ASSERT_TRUE(
        world.add({.shape = Sphere<double>{r},
                   .position = x,
                   .velocity = x * -1.0 + Vector<double, 3>{{uniform(engine), uniform(engine), uniform(engine)}},
                   .spin = {{uniform(engine), uniform(engine), uniform(engine)}},
                   .material = {.restitution = 0.8, .friction = 0.5}}));
  }
  const auto p = momentum(world), l = angular_momentum(world);
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(5));
  EXPECT_GT(motion.statistics().collisions, 200u);
  // Sums of 125 products of size 10, each rounded at every collision.
  const double rounding = 125 * 10 * epsilon * 10;
  EXPECT_LT(length(momentum(world) - p), rounding);
  EXPECT_LT(length(angular_momentum(world) - l), rounding);
}

/// Collisions of each ball per time of a gas of balls of diameter 1 and unit temperature over mass in a box with the
/// free edge `free` for centres: Enskog's rate, with g at contact by Carnahan and Starling or Henderson. Near walls a
/// part of the directions in which a partner could be is outside: of an offset u, prod(1 - |u_i| / free) is left.
template <int Dim>
double enskog_rate(double count, double free) {
  const double n = count / std::pow(free, Dim), pi = std::numbers::pi;
  const double bulk = count / std::pow(free + 1, Dim);  // packing fraction without walls
  if (Dim == 3) {
    const double packing = pi / 6 * bulk, g = (1 - packing / 2) / std::pow(1 - packing, 3);
    return 4 * std::sqrt(pi) * n * g * (1 - 3 * 0.5 / free + 3 * 2 / (3 * pi) / (free * free));
  }
  const double packing = pi / 4 * bulk, g = (1 - 7 * packing / 16) / std::pow(1 - packing, 2);
  return 2 * std::sqrt(pi) * n * g * (1 - 2 * 2 / pi / free + 1 / pi / (free * free));
}

// T(t) = T(0) / (1 + t / tau)^2 for a gas whose restitution e does not depend on speed (P. K. Haff, J. Fluid Mech. 134
// (1983) 401-430). A collision takes (1 - e^2) T on average, and each ball has `rate` of them, so that tau = 2 d /
// ((1 - e^2) rate). Walls are elastic. Until t = 4 tau the gas stays homogeneous: shear modes grow by (1 - e^2) / (2 d)
// a collision at most, e^1.6 in all, from 1/sqrt(N) of the thermal speed.
//
// What the theory leaves out: walls attract balls (packing times 2 d over the edge, 2 per cent), speeds are not quite
// Maxwell's (0.5 per cent at this e), and N balls fluctuate by 1/sqrt(N) (2 per cent).
template <int Dim>
void follows_haff(std::size_t count, double edge) {
  const Material<double> material{.restitution = 0.9, .friction = 0};
  World<double, Dim> mixing = gas<Dim>(count, edge, elastic);
  ExactMotion first(mixing);  // let the speeds get their distribution
  ASSERT_TRUE(first.advance_to(3));
  World<double, Dim> world = mixing;
  world.time = 0;
  for (auto& of_ball : world.material) of_ball = material;
  const double balls = static_cast<double>(count);
  const auto temperature = [&] { return 2 * kinetic_energy(world) / (Dim * balls * world.mass[0]); };  // over mass
  const double start = temperature();
  const double rate = enskog_rate<Dim>(balls, edge - 1) * std::sqrt(start);
  const double tau = 2 * Dim / ((1 - 0.9 * 0.9) * rate);
  ExactMotion motion(world);
  // The slope of log T over log(1 + t / tau), by least squares.
  double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (double t = 0.25 * tau; t <= 4 * tau; t *= 1.25) {
    ASSERT_TRUE(motion.advance_to(t));
    const double x = std::log(1 + t / tau), y = std::log(temperature() / start);
    EXPECT_NEAR(std::exp(y / 2) * (1 + t / tau), 1, 0.045) << t / tau;
    n += 1, sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
  }
  EXPECT_NEAR((n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x), -2, 0.09);
}
TEST(ExactMotion, CoolsAsHaffSays) {
  follows_haff<3>(2000, 24);
}
TEST(ExactMotion, CoolsAsHaffSaysInThePlane) {
  follows_haff<2>(2000, 120);
}

// Every impact is found and reversed to some ulp of the speed, 14: of the height, 10, some tens of ulps in 35 bounces.
TEST(ExactMotion, AnElasticBallReachesItsHeightAgain) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  ASSERT_TRUE(world.add_wall({}));
  ASSERT_TRUE(world.add({.position = {{0, 10}}, .material = {.restitution = 1}}));
  ExactMotion motion(world);
  const double fall = std::sqrt(2 * 9.5 / 9.81);
  for (int bounce = 1; 2 * bounce * fall < 100; ++bounce) {
    ASSERT_TRUE(motion.advance_to(2 * bounce * fall));
    EXPECT_NEAR(world.position[0][1], 10, 1e-12) << bounce;
  }
}

// Heights decrease by e^2 in each bounce, and after the last one, at fall (1 + e) / (1 - e), the ball is at rest.
TEST(ExactMotion, ADampedBallComesToRest) {
  World<double, 3> world;
  world.gravity = {{0, 0, -10}};
  ASSERT_TRUE(world.add_wall({}));
  ASSERT_TRUE(
      world.add({.position = {{0, 0, 5.5}}, .velocity = {{2, 0, 0}}, .material = {.restitution = 0.5, .friction = 0}}));
  ExactMotion motion(world);
  const double fall = 1;  // from 5 at g = 10
  ASSERT_TRUE(motion.advance_to(fall + 0.5 * fall));
  EXPECT_NEAR(world.position[0][2], 0.5 + 5 * 0.25, 1e-14);
  ASSERT_TRUE(motion.advance_to(100));
  EXPECT_EQ(world.velocity[0], (Vector<double, 3>{{2, 0, 0}}));
  EXPECT_NEAR(world.position[0][2], 0.5, 1e-9);  // half of g times the contact time squared
  EXPECT_LT(motion.statistics().wall_collisions, 40u);
}

// On a smooth slope of 45 degrees the component of gravity along the slope is g sin(45): after the bounces the ball
// slides as on a rail, and at the foot it comes to rest in the corner of slope and wall.
TEST(ExactMotion, ABallSlidesDownASlopeAndRestsInTheCorner) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  ASSERT_TRUE(world.add_wall({.normal = {{1, 1}}}));
  ASSERT_TRUE(world.add_wall({.normal = {{-1, 0}}, .offset = -10}));
  const double half = std::sqrt(0.5);
  ASSERT_TRUE(world.add({.position = {{half * 0.5, half * 0.5}}, .material = {.restitution = 0.5, .friction = 0}}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(1));
  EXPECT_NEAR(world.velocity[0][0], 10 * half * half, 1e-9);
  EXPECT_NEAR(world.velocity[0][1], -10 * half * half, 1e-9);
  EXPECT_NEAR(world.position[0][0] + world.position[0][1], 0.5 * 2 * half, 1e-9);
  ASSERT_TRUE(motion.advance_to(100));
  EXPECT_NEAR(world.position[0][0], 9.5, 1e-9);
  EXPECT_LT(length(world.velocity[0]), 1e-9);
  EXPECT_LT(motion.statistics().wall_collisions, 2000u);  // no collapse
}

// As many balls go out as came in, at their speed, with and without a gap.
TEST(ExactMotion, NewtonsCradleSendsOutAsManyAsCameIn) {
  for (const double gap : {0.0, 0.001}) {
    for (const int in : {1, 2, 3}) {
      World<double, 3> world;
      for (int i = 0; i < 5; ++i) {
        const bool moves = i < in;
        ASSERT_TRUE(world.add({.position = {{i * (1 + gap) - (moves ? 1.0 : 0.0), 0, 0}},
                               .velocity = {{moves ? 1.0 : 0.0, 0, 0}},
                               .material = elastic}));
      }
      ExactMotion motion(world);
      ASSERT_TRUE(motion.advance_to(2));
      for (int i = 0; i < 5; ++i)
        EXPECT_NEAR(world.velocity[static_cast<std::size_t>(i)][0], i >= 5 - in ? 1 : 0, 1e-12)
            << gap << ' ' << in << ' ' << i;
    }
  }
}

// A ball bounces on a fixed sphere and the floor under gravity, so that times of impact are roots of polynomials of
// degree 4. The energy shows whether each root was right.
TEST(ExactMotion, FindsFixedSpheresOnCurvedPaths) {
  World<double, 3> world;
  world.gravity = {{0, 0, -9.81}};
  ASSERT_TRUE(world.add_container({{-3, -3, 0}}, {{3, 3, 50}}, elastic));
  ASSERT_TRUE(world.add({.shape = Sphere<double>{1.0}, .fixed = true, .material = elastic}));
  ASSERT_TRUE(world.add({.shape = Sphere<double>{0.3}, .position = {{1, 1, 1}}, .fixed = true, .material = elastic}));
  ASSERT_TRUE(world.add(
      {.shape = Sphere<double>{0.2}, .position = {{0.1, 0.2, 4}}, .velocity = {{0.3, 0, 0}}, .material = elastic}));
  const double energy = kinetic_energy(world) + potential_energy(world);
  ExactMotion motion(world);
  for (int second = 1; second <= 60; ++second) {
    ASSERT_TRUE(motion.advance_to(second));
    EXPECT_NEAR((kinetic_energy(world) + potential_energy(world)) / energy, 1, 1e-12);
    EXPECT_LT(deepest_overlap_of_bodies(world), 1e-12);
  }
  EXPECT_GT(motion.statistics().collisions, 10u);
}

// The order in memory does not matter: the same bodies in another order move identically, as long as no two events
// coincide.
TEST(ExactMotion, TheOrderOfBodiesDoesNotMatter) {
  World<double, 3> a = gas<3>(200, 12, elastic), b;
  ASSERT_TRUE(b.add_container({}, {{12, 12, 12}}, elastic));
  for (std::size_t i = a.size(); i-- > 0;)
    ASSERT_TRUE(b.add({.position = a.position[i], .velocity = a.velocity[i], .material = elastic}));
  ExactMotion one(a), other(b);
  ASSERT_TRUE(one.advance_to(1));
  ASSERT_TRUE(other.advance_to(1));
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(length(a.position[i] - b.position[a.size() - 1 - i]), 1e-6) << i;
}

// A ball placed on a fixed one stays there, up to the distance that a body falls in the contact time.
TEST(ExactMotion, ABallLiesOnAFixedSphere) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  ASSERT_TRUE(world.add({.fixed = true, .material = {.restitution = 0, .friction = 0}}));
  ASSERT_TRUE(world.add({.position = {{0, 1}}, .material = {.restitution = 0, .friction = 0}}));
  ExactMotion motion(world, {.contact_time = 1e-3});
  for (int k = 1; k <= 100; ++k) {
    ASSERT_TRUE(motion.advance_to(0.01 * k));
    EXPECT_NEAR(world.position[1][1], 1, 10 * 1e-6);
  }
  EXPECT_LT(motion.statistics().collisions, 10u);
}

// Output does not change the motion: advance_to leaves the predicted events alone.
TEST(ExactMotion, LookingDoesNotDisturb) {
  World<double, 3> a = gas<3>(200, 12, elastic), b = a;
  ExactMotion once(a), often(b);
  ASSERT_TRUE(once.advance_to(3));
  for (int i = 1; i <= 300; ++i) ASSERT_TRUE(often.advance_to(i == 300 ? 3 : i * 0.01));
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
}

// Balls dropped into a narrow box slide over those on its floor. A persistent contact may overlap by the distance that
// a body falls in the contact time, which is 1e-5 of the time to fall its radius: 2e-10 of the radius.
TEST(ExactMotion, ABallDoesNotSinkIntoOneThatLies) {
  const Material<double> slack{.restitution = 0, .friction = 0};
  World<double, 3> world;
  world.gravity = {{0, 0, -9.81}};
  ASSERT_TRUE(world.add_container({}, {{3.45, 3.45, 100}}, slack));
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> jitter(-0.04, 0.04);
  for (int i = 0; i < 20; ++i) {
    BodyDefinition<double, 3> ball{.material = slack};
    for (int axis = 0, rest = i; axis < 3; ++axis, rest /= 3)
      ball.position[static_cast<std::size_t>(axis)] = 0.575 + 1.15 * (axis < 2 ? rest % 3 : rest) + jitter(engine);
    ASSERT_TRUE(world.add(ball));
  }
  ExactMotion motion(world);
  for (const double t : {0.1, 0.2, 0.3, 0.35, 0.4}) {
    ASSERT_TRUE(motion.advance_to(t));
    EXPECT_LT(deepest_overlap_of_bodies(world), 2e-10 * 0.5) << t;
  }
}

// A world too large for the cache is prefetched ahead of its next events, which must not change the results.
TEST(ExactMotion, LooksAheadInAGasTooLargeForTheCache) {
  constexpr std::size_t count = 25000;
  World<double, 3> world = gas<3>(count, 36, elastic), looked_at = world;
  const double energy = kinetic_energy(world);
  ExactMotion motion(world), seen(looked_at);
  ASSERT_TRUE(motion.advance_to(0.25));
  for (const double t : {0.02, 0.1, 0.11, 0.25}) ASSERT_TRUE(seen.advance_to(t));
  EXPECT_GT(motion.statistics().collisions, count);
  EXPECT_EQ(state_hash(looked_at), state_hash(world));
  const double collisions_of_each = static_cast<double>(2 * motion.statistics().collisions / count);
  EXPECT_NEAR(kinetic_energy(world) / energy, 1, 2 * epsilon * collisions_of_each);
}

// Extreme ratios: a ball at 1 km/s hits one of a centimetre, and a light ball one of 1e12 times its mass.
TEST(ExactMotion, NothingPassesThrough) {
  World<double, 3> world;
  ASSERT_TRUE(world.add(
      {.shape = Sphere<double>{0.005}, .position = {{-1000, 0, 0}}, .velocity = {{1000, 0, 0}}, .material = elastic}));
  ASSERT_TRUE(world.add({.shape = Sphere<double>{0.005}, .mass = 1e12, .material = elastic}));
  ExactMotion motion(world);
  ASSERT_TRUE(motion.advance_to(2));
  EXPECT_NEAR(world.velocity[0][0], -1000, 1e-8);  // 2 / 1e12 of it stays with the heavy one
  EXPECT_NEAR(world.position[0][0], -1000.02, 1e-6);
}

TEST(ExactMotion, SaysWhatItCannotDo) {
  World<double, 3> world;
  ASSERT_TRUE(world.add({}));
  ExactMotion motion(world);
  EXPECT_FALSE(motion.advance_to(-1));
  EXPECT_FALSE(motion.advance_to(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace continuo::exact_motion_test
