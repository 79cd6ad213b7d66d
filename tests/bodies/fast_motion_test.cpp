// The fast motion against closed forms and against the exact one.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>

#include <bench/bodies/overlap.hpp>
#include <gtest/gtest.h>
#include <tests/bodies/heaps.hpp>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::fast_motion_test {
namespace {

const Material<double> elastic{.restitution = 1, .friction = 0};

template <class Real, int Dim>
void run(World<Real, Dim>& world, Real duration, const FastOptions<Real>& options = {}) {
  FastMotion<Real, Dim> motion(world, options);
  const auto steps = static_cast<int>(std::lround(duration / options.step));
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(motion.advance());
}

// Flight and impacts are exact but for rounding. The peak is within half a step of a sample, so the highest sample is
// below it by g (1/120)^2 / 2 = 3.4e-4 at most.
TEST(FastMotion, AnElasticBallReachesItsHeightAgain) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  ASSERT_TRUE(world.add_wall({}));
  ASSERT_TRUE(world.add({.position = {{0, 10}}, .material = {.restitution = 1}}));
  FastMotion<double, 2> motion(world);
  double peak = 0;
  int peaks = 0;
  for (int step = 0; step < 6000; ++step) {
    const double before = world.velocity[0][1];
    ASSERT_TRUE(motion.advance());
    peak = std::max(peak, world.position[0][1]);
    if (before < 0 && world.velocity[0][1] > 0) {
      if (peaks++ > 0) {
        EXPECT_NEAR(peak, 10, 1e-3) << step;
      }
      peak = 0;
    }
  }
  EXPECT_GT(peaks, 30);
  EXPECT_NEAR((kinetic_energy(world) + potential_energy(world)) / world.mass[0] / (9.81 * 10), 1, 1e-10);
}

TEST(FastMotion, NewtonsCradleSendsOutAsManyAsCameIn) {
  for (const double gap : {0.0, 0.001}) {
    for (const int in : {1, 2}) {
      World<double, 3> world;
      for (int i = 0; i < 5; ++i) {
        const bool moves = i < in;
        ASSERT_TRUE(world.add({.position = {{i * (1 + gap) - (moves ? 1.0 : 0.0), 0, 0}},
                               .velocity = {{moves ? 1.0 : 0.0, 0, 0}},
                               .material = elastic}));
      }
      run(world, 2.0);
      for (int i = 0; i < 5; ++i)
        EXPECT_NEAR(world.velocity[static_cast<std::size_t>(i)][0], i >= 5 - in ? 1 : 0, 0.01)
            << gap << ' ' << in << ' ' << i;
    }
  }
}

/// A body of radius 1/2 that touches the floor.
template <int Dim>
World<double, Dim> on_the_floor(BodyDefinition<double, Dim> body) {
  World<double, Dim> world;
  world.gravity[static_cast<std::size_t>(Dim - 1)] = -9.81;
  EXPECT_TRUE(world.add_wall({}));
  body.position[static_cast<std::size_t>(Dim - 1)] = 0.5;
  EXPECT_TRUE(world.add(body));
  return world;
}

// Friction turns sliding into rolling; from then on a ball has 5/7 of its speed, a disc 2/3, whatever the friction.
template <int Dim>
void slides_until_it_rolls(double part) {
  BodyDefinition<double, Dim> ball;
  ball.velocity[0] = 3;
  World<double, Dim> world = on_the_floor(ball);
  run(world, 2.0);
  EXPECT_NEAR(world.velocity[0][0], part * 3, 0.01 * 3);
  EXPECT_NEAR(length(world.spin[0]) * 0.5, part * 3, 0.01 * 3);
  EXPECT_NEAR(world.position[0][static_cast<std::size_t>(Dim - 1)], 0.5, 0.001);
}
TEST(FastMotion, SlidesUntilItRolls) {
  slides_until_it_rolls<3>(5.0 / 7);
  slides_until_it_rolls<2>(2.0 / 3);
}

// 10,000 balls at 1 km/s, 4 m in a substep, against a fixed ball of a centimetre and against walls, from all
// directions: none passes through. Half of them bounce.
TEST(FastMotion, NothingPassesThrough) {
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int shot = 0; shot < 10000; ++shot) {
    Vector<double, 3> direction{{normal(engine), normal(engine), normal(engine)}};
    direction *= 1 / length(direction);
    Vector<double, 3> aside{{normal(engine), normal(engine), normal(engine)}};
    aside -= direction * dot(aside, direction);
    aside *= 0.019 * uniform(engine) / length(aside);  // of the 0.02 at which it would pass by
    World<double, 3> world;
    const Material<double> material{.restitution = shot % 2 ? 1.0 : 0.0, .friction = 0};
    ASSERT_TRUE(world.add({.shape = Sphere<double>{0.01}, .fixed = true, .material = material}));
    ASSERT_TRUE(world.add({.shape = Sphere<double>{0.01},
                           .position = aside - direction * (5 + 20 * uniform(engine)),
                           .velocity = direction * 1000.0,
                           .material = material}));
    run(world, 0.05);
    // The velocity is deflected by twice the angle of incidence, or without restitution becomes tangential, up to
    // `fastest_push`, the largest speed with which a soft contact separates two bodies.
    const double sine = length(aside) / 0.02, expected = shot % 2 ? 2 * sine * sine - 1 : sine * sine;
    EXPECT_NEAR(dot(world.velocity[1], direction), 1000 * expected, shot % 2 ? 1e-6 : 4.0) << shot;
  }
}
TEST(FastMotion, NothingPassesThroughAWall) {
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int shot = 0; shot < 10000; ++shot) {
    World<double, 3> world;
    const Material<double> material{.restitution = shot % 2 ? 1.0 : 0.0, .friction = 0};
    ASSERT_TRUE(world.add_container({{-1, -1, -1}}, {{1, 1, 1}}, material));
    Vector<double, 3> v{{normal(engine), normal(engine), normal(engine)}};
    v *= 1000 / length(v);
    const Vector<double, 3> x{{uniform(engine), uniform(engine), uniform(engine)}};
    ASSERT_TRUE(world.add({.shape = Sphere<double>{0.01}, .position = x * 0.9, .velocity = v, .material = material}));
    run(world, 0.05);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(world.position[0][axis]), 0.99 + 1e-9) << shot;
    if (shot % 2) {
      EXPECT_NEAR(length(world.velocity[0]), 1000, 1e-6) << shot;
    }
  }
}

// Contacts that last act on two bodies by equal and opposite impulses.
TEST(FastMotion, KeepsMomentumAndAngularMomentum) {
  World<double, 3> world;
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 64; ++i) {
    const Vector<double, 3> x{{1.2 * (i % 4 - 1.5), 1.2 * (i / 4 % 4 - 1.5), 1.2 * (i / 16 - 1.5)}};
    ASSERT_TRUE(world.add({.position = x,
                           .velocity = x * -1.0,
                           .spin = {{uniform(engine), uniform(engine), uniform(engine)}},
                           .material = {.restitution = 0, .friction = 0.5}}));
  }
  const auto p = momentum(world);
  run(world, 2.0);
  EXPECT_LT(length(momentum(world) - p), 1e-11);
}

// A heap of 200 balls comes to rest. The deepest overlap of all steps is a hundredth of a radius, although balls fall
// at up to 4 m/s on others that rest on the floor.
TEST(FastMotion, AHeapComesToRest) {
  World<double, 3> world = heap<double>(200, 5, 5);
  FastMotion<double, 3> motion(world);
  double deepest = 0;
  for (int step = 0; step < 600; ++step) {
    ASSERT_TRUE(motion.advance());
    if (step > 15) deepest = std::max(deepest, motion.deepest_overlap());
  }
  EXPECT_LT(deepest, 0.005);
  EXPECT_LT(kinetic_energy(world), 0.05);
}

// A ball ten times as heavy hits a column at 22 m/s, without restitution: compressed contacts separate with at most
// `fastest_push`.
TEST(FastMotion, AHitColumnDoesNotSpringUp) {
  World<double, 3> world;
  world.gravity = {{0, 0, -9.81}};
  ASSERT_TRUE(world.add_wall({}));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(world.add({.position = {{0, 0, 0.5 + i}}}));
  ASSERT_TRUE(world.add({.position = {{0, 0, 28}}, .mass = 5}));
  const FastOptions<double> options;
  FastMotion<double, 3> motion(world, options);
  double fastest = 0;
  for (int step = 0; step < 600; ++step) {
    ASSERT_TRUE(motion.advance());
    for (const auto& v : world.velocity) fastest = std::max(fastest, v[2]);
  }
  EXPECT_LT(fastest, options.fastest_push);
  EXPECT_LT(kinetic_energy(world), 1e-9);  // at rest, but for rounding
  EXPECT_NEAR(world.position[3][2], 3.5, 0.01);
}

// Contacts of balls that touch and can bounce once left approach velocities from the solver to an impact that never
// came: heaps overlapped by a tenth of a ball, and columns of four without limit. A soft contact is compressed by load
// / (mass w^2), with w = 2 pi 60 / s at the lowest here: ten balls above give 0.0007, an impact a few times that. The
// limit 0.005 is that of the published heap.
TEST(FastMotion, WhatCanBounceDoesNotSink) {
  for (const double dt : {1.0 / 60, 1.0 / 240}) {
    for (const double restitution : {0.1, 0.3, 0.5}) {
      const Material<double> material{.restitution = restitution};
      World<double, 2> world;
      world.gravity = {{0, -10}};
      ASSERT_TRUE(world.add_container({{0, 0}}, {{6, 100}}, material));
      for (int i = 0; i < 40; ++i)
        ASSERT_TRUE(world.add(
            {.position = {{0.7 + 1.15 * (i % 5) + 0.02 * (i * 7 % 11), 1 + 1.2 * (i / 5)}}, .material = material}));
      FastMotion<double, 2> motion(world, {.step = dt});
      while (world.time < 8) ASSERT_TRUE(motion.advance());
      EXPECT_LT(deepest_overlap_of_bodies(world), 0.005) << dt << ' ' << restitution;
      EXPECT_LT(kinetic_energy(world), 0.01 * 40) << dt << ' ' << restitution;
    }
  }
}

TEST(FastMotion, APlainHeapIsTheSameForAnyNumberOfThreads) {
  expect_the_same_for_any_number_of_threads(heap<float>(4000, 20, 1), {}, 60);
}
TEST(FastMotion, AMixedHeapIsTheSameForAnyNumberOfThreads) {
  expect_the_same_for_any_number_of_threads(mixed(heap<float>(4000, 20, 1)), {}, 60);
}

// Every build gives the same bits: debug and release, g++ and clang, on any machine, unless fused multiply-add is
// enabled (by -march=native only), which rounds less often. The expected numbers are those of all these builds.
// Orientations are left out, since they depend on the sines of the system's library.
template <class Real, int Dim>
std::uint64_t hash_without_orientation(World<Real, Dim> world) {
  std::ranges::fill(world.orientation, upright<Real, Dim>());
  return state_hash(world);
}
TEST(FastMotion, IsTheSameInEveryBuild) {
#ifdef __FMA__
  GTEST_SKIP() << "compiled for a processor that fuses";
#endif
  World<float, 3> single = heap<float>(300, 6, 1);
  World<double, 3> twice = heap<double>(300, 6, 1);
  FastMotion<float, 3> fast_single(single);
  FastMotion<double, 3> fast_twice(twice);
  for (int step = 0; step < 120; ++step) {
    ASSERT_TRUE(fast_single.advance());
    ASSERT_TRUE(fast_twice.advance());
  }
  EXPECT_EQ(hash_without_orientation(single), 0x68e3de734b3c8a44u);
  EXPECT_EQ(hash_without_orientation(twice), 0xd5e5a90ee96a7bdfu);

  World<double, 2> exact;
  exact.gravity = {{0, -9.81}};
  ASSERT_TRUE(exact.add_container({{0, 0}}, {{10, 10}}));
  for (int i = 0; i < 20; ++i)
    ASSERT_TRUE(exact.add({.position = {{1.1 + 1.2 * (i % 7), 2 + 1.3 * (i / 7)}},
                           .velocity = {{0.3 * i, 1.0 - 0.1 * i}},
                           .material = {.restitution = 0.9, .friction = 0.2}}));
  ExactMotion motion(exact);
  ASSERT_TRUE(motion.advance_to(3));
  EXPECT_EQ(hash_without_orientation(exact), 0xc8f07dd83df5068fu);
}

// A wall without thickness through the middle of a box: balls shot at it from both sides stay on their side, by the
// exact and the fast motion. In the exact motion positions are right to rounding. In the fast motion contacts without
// restitution are soft: a ball driven into the wedge between two walls overlaps, but never with its centre.
TEST(FastMotion, NothingPassesThroughAThinWall) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const Vector<double, 3> across{{0.48, 0.6, 0.64}};  // a unit
  for (int shot = 0; shot < 10000; ++shot) {
    World<double, 3> world;
    const Material<double> material{.restitution = shot % 2 ? 1.0 : 0.0, .friction = 0};
    ASSERT_TRUE(world.add_container({{-1, -1, -1}}, {{1, 1, 1}}, material));
    ASSERT_TRUE(world.add_wall({.normal = across, .offset = 0.1, .material = material, .thin = true}));
    Vector<double, 3> v{{normal(engine), normal(engine), normal(engine)}}, x{};
    v *= 1000 / length(v);
    do {
      for (std::size_t axis = 0; axis < 3; ++axis) x[axis] = 1.8 * uniform(engine) - 0.9;
    } while (std::abs(dot(x, across) - 0.1) < 0.01);
    ASSERT_TRUE(world.add({.shape = Sphere<double>{0.01}, .position = x, .velocity = v, .material = material}));
    const double side = dot(x, across) > 0.1 ? 1 : -1;
    World<double, 3> exact = world;
    run(world, 0.05);
    EXPECT_GE(side * (dot(world.position[0], across) - 0.1), shot % 2 ? 0.01 - 1e-9 : 0.0) << shot;
    if (shot % 10 != 0) continue;
    ExactMotion motion(exact);
    ASSERT_TRUE(motion.advance_to(0.05));
    EXPECT_GE(side * (dot(exact.position[0], across) - 0.1), 0.01 - 1e-14) << shot;
  }
}

// Snapshots of world and motion together, while balls rest on each other. With six seeds of the heap the greatest
// numbers are 400 to 404.
TEST(FastMotion, HoldsSome400BytesASphere) {
  const int count = 4000;
  World<float, 3> world = heap<float>(count, 20, 1);
  FastMotion<float, 3> motion(world);
  std::size_t most = 0;
  for (int step = 0; step < 200; ++step) {
    ASSERT_TRUE(motion.advance());
    most = std::max(most, motion.memory());
  }
  EXPECT_GT(motion.statistics().contacts, 2u * count);
  EXPECT_LE(most + world.memory(), 405u * count) << most / count << " + " << world.memory() / count;
}

// A rolling ball, of inertia 2/5 m r^2, slows by c m g r of torque: (1 + 2/5) m a = c m g. A disc: (1 + 1/2).
template <int Dim>
void rolls_ever_slower(double factor) {
  BodyDefinition<double, Dim> ball;
  ball.velocity[0] = 3;
  ball.spin[Dim == 2 ? 0 : 1] = Dim == 2 ? -6 : 6;
  ball.material.rolling_resistance = 0.05;
  World<double, Dim> world = on_the_floor(ball);
  run(world, 2.0);
  EXPECT_NEAR(world.velocity[0][0], 3 - 0.05 * 9.81 / factor * 2, 0.01);
  run(world, 10.0);
  EXPECT_NEAR(world.velocity[0][0], 0, 1e-3);
}
TEST(FastMotion, RollingResistanceSlowsDown) {
  rolls_ever_slower<3>(1.4);
  rolls_ever_slower<2>(1.5);
}

// More small balls round a large, fixed one than there are colours: a force towards its centre draws them from all
// sides until they rest on it.
TEST(FastMotion, ManyTouchOne) {
  for (const bool is_fixed : {true, false}) {
    World<float, 3> world;
    ASSERT_TRUE(world.add({.shape = Sphere<float>{3.0f}, .mass = 1e4f, .fixed = is_fixed}));
    const int balls = 150;
    for (int i = 0; i < balls; ++i) {  // a spiral on the sphere: nearly even
      const float z = 1 - (2 * static_cast<float>(i) + 1) / balls, angle = 2.399963f * static_cast<float>(i);
      const float out = std::sqrt(1 - z * z);
      ASSERT_TRUE(world.add({.shape = Sphere<float>{0.3f},
                             .position = Vector<float, 3>{{out * std::cos(angle), out * std::sin(angle), z}} * 3.5f}));
    }
    world.force_laws.push_back([](const World<float, 3>& w, float, auto x, auto v, auto force) {
      for (std::size_t i = 1; i < w.size(); ++i) force[i] += w.mass[i] * ((x[0] - x[i]) * 3.0f + (v[0] - v[i]) * 0.5f);
    });
    FastMotion<float, 3> motion(world);
    for (int step = 0; step < 600; ++step) ASSERT_TRUE(motion.advance());
    EXPECT_LT(motion.deepest_overlap(), 0.003f);
    EXPECT_GT(motion.statistics().contacts, 100u);
    EXPECT_LT(length(world.position[0]), 1e-3f);
    EXPECT_LT(kinetic_energy(world), 0.01f);
  }
}

TEST(FastMotion, SaysWhatItCannotDo) {
  World<double, 2> world;
  ASSERT_TRUE(world.add({}));
  for (const FastOptions<double>& options :
       {FastOptions<double>{.step = 0}, FastOptions<double>{.step = std::numeric_limits<double>::quiet_NaN()},
        FastOptions<double>{.substeps = 0}}) {
    FastMotion<double, 2> motion(world, options);
    EXPECT_FALSE(motion.advance());
  }
  world.force_laws.push_back([](const auto&, double, auto, auto, auto force) { force[0][0] = 1e308 * 1e308; });
  FastMotion<double, 2> motion(world);
  EXPECT_FALSE(motion.advance());
  EXPECT_EQ(world.position[0], (Vector<double, 2>{}));
}

}  // namespace
}  // namespace continuo::fast_motion_test
