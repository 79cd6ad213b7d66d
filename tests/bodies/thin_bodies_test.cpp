// Heaps of thin cards and rods: nobody hangs in the air, and no energy comes from nowhere. What is thin is stopped at
// other bodies in most steps, and of two long shapes that nearly touch the nearest points say little. A needle that a
// body of ten thousand times its mass hits turns by many radians in a step.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/rigid_stepping/rigid_body.hpp>
#include <continuo/status/status.hpp>

namespace continuo::thin_bodies_test {
namespace {

using Random = std::mt19937;

template <class Real>
Real uniform(Random& random, Real from, Real to) {
  return from + (to - from) * static_cast<Real>(random() >> 8) / Real(0x1p24);
}

/// Boxes from 0.1 to 0.5 long that are 1 mm to 10 cm thick in one direction or two, and do not overlap.
template <class Real, int Dim>
World<Real, Dim> heap(Random& random) {
  World<Real, Dim> world;
  world.gravity[Dim - 1] = Real(-9.81);
  Vector<Real, Dim> up;
  up[Dim - 1] = 1;
  EXPECT_TRUE(world.add_wall({.normal = up}));
  for (int k = 0; k < 24; ++k) {
    BodyDefinition<Real, Dim> body;
    Vector<Real, Dim> size;
    for (std::size_t i = 0; i < Dim; ++i) {
      size[i] = uniform(random, Real(0.1), Real(0.5));
      if (i + 1 < Dim) body.position[i] = uniform(random, Real(-0.3), Real(0.3));
      body.velocity[i] = uniform(random, Real(-3), Real(3));
    }
    for (int i = 1; i < Dim; ++i) size[random() % Dim] = std::pow(Real(10), uniform(random, Real(-3), Real(-1)));
    body.shape = Box<Real, Dim>{size};
    body.position[Dim - 1] = Real(0.6) + Real(0.9) * static_cast<Real>(k);
    for (Real& q : body.orientation.components) q = uniform(random, Real(-1), Real(1));
    if constexpr (Dim == 3) body.orientation *= 1 / length(body.orientation);
    for (Real& spin : body.spin.components) spin = uniform(random, Real(-30), Real(30));
    body.material = {.restitution = uniform(random, Real(0), Real(0.8)), .friction = uniform(random, Real(0), Real(1))};
    EXPECT_TRUE(world.add(body));
  }
  return world;
}

template <class Real, int Dim>
void expect_to_fall(unsigned seed) {
  Random random(seed);
  World<Real, Dim> world = heap<Real, Dim>(random);
  FastMotion<Real, Dim> motion(world);
  const Real at_start = kinetic_energy(world) + potential_energy(world);
  std::vector<int> hangs(world.size());
  for (int step = 0; step < 360; ++step) {
    const std::vector<Vector<Real, Dim>> before = world.position;
    const Status status = motion.advance();
    ASSERT_TRUE(status) << describe(status) << " seed " << seed << " step " << step;
    for (std::size_t i = 0; i < world.size(); ++i) {
      hangs[i] = world.position[i] == before[i] && length(world.velocity[i]) > Real(0.5) ? hangs[i] + 1 : 0;
      ASSERT_LT(hangs[i], 5) << "body " << i << " seed " << seed << " step " << step;
    }
    // At an impact a body may be as fast as a step later: by 9.81/60 of the 20 m/s that it falls with.
    ASSERT_LT(kinetic_energy(world) + potential_energy(world), Real(1.02) * at_start)
        << "seed " << seed << " step " << step;
  }
}
TEST(ThinBodies, OfSinglePrecisionFallWithoutEnergyFromNowhere) {
  for (const unsigned seed : {1U, 2U}) expect_to_fall<float, 2>(seed);
  for (const unsigned seed : {1U, 2U}) expect_to_fall<float, 3>(seed);
}
// Sweeps over the contacts of these needles, begun with the impulses of a hard hit, gave up to 1e18 times the energy.
TEST(ThinBodies, OfDoublePrecisionFallWithoutEnergyFromNowhere) {
  for (const unsigned seed : {5U, 26U, 29U}) expect_to_fall<double, 3>(seed);
}

// A needle of 1 mg: the determinant of its moment of inertia is 1e-41, that of the inverse 1e41.
TEST(ThinBodies, MomentsOfInertiaHaveTheirInverses) {
  const std::array principal{4e-15F, 2e-13F, 1e-13F};
  const Matrix<float, 3> axes = rotation(Vector<float, 4>{{0.5F, 0.5F, -0.5F, 0.5F}});
  Matrix<float, 3> own;
  for (std::size_t i = 0; i < 3; ++i) own[i][i] = principal[i];
  const Matrix<float, 3> inertia = axes * own * transposed(axes);
  const Matrix<float, 3> there = inverse(inertia), back = inverse(there);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector<float, 3> column = inertia * there[j];
      EXPECT_NEAR(column[i], i == j ? 1 : 0, 1e-4) << i << j;  // 50 times as long as thick: 50 epsilon and some
      EXPECT_NEAR(back[j][i], inertia[j][i], 1e-4F * principal[1]) << i << j;
    }
  }
}

/// Five floors of cards 2 mm thick that lean against each other, at 20 degrees, each pair on a card that lies on two
/// others. Every card is where it touches its neighbours, or 0.5 mm beside them.
World<double, 2> house_of_cards(double friction) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  const Material<double> material{.friction = friction};
  EXPECT_TRUE(world.add_wall({.normal = {{0, 1}}, .material = material}));
  const auto card = [&](double x, double y, double angle, double size) {
    const Box<double, 2> box{{{0.002, size}}};
    EXPECT_TRUE(world.add({.shape = box, .position = {{x, y}}, .orientation = {{angle}}, .material = material}));
  };
  const double angle = std::numbers::pi / 9, half = 0.2;
  const double apart = 2 * (half * std::sin(angle) + 0.001 * std::cos(angle));
  const double high = 2 * (half * std::cos(angle) + 0.001 * std::sin(angle)), pitch = 2 * apart + 0.01;
  for (int floor = 0; floor < 5; ++floor) {
    const double ground = floor * (high + 0.002), left = -pitch * (4 - floor) / 2;
    for (int i = 0; i < 5 - floor; ++i) {
      const double middle = left + pitch * i;
      card(middle - apart / 2, ground + high / 2, -angle, 2 * half);
      card(middle + apart / 2, ground + high / 2, angle, 2 * half);
      if (i < 4 - floor) card(middle + pitch / 2, ground + high + 0.001, std::numbers::pi / 2, pitch - 0.0005);
    }
  }
  return world;
}
double farthest_way(double friction, int steps) {
  World<double, 2> world = house_of_cards(friction);
  const std::vector<Vector<double, 2>> start = world.position;
  FastMotion<double, 2> motion(world);
  for (int step = 0; step < steps; ++step) EXPECT_TRUE(motion.advance());
  double farthest = 0;
  for (std::size_t i = 0; i < start.size(); ++i) farthest = std::max(farthest, length(world.position[i] - start[i]));
  return farthest;
}
// A card that bears many others pushes at its foot along the floor by the tangent of 20 degrees, 0.364, of what it
// bears; where two corners meet, the force is up to 20 degrees from a normal, and as much from the other one. With
// friction 0.3 neither holds.
TEST(ThinBodies, AHouseOfCardsStandsByFriction) {
  EXPECT_LT(farthest_way(0.7, 600), 5e-4);  // the gaps between them
  EXPECT_GT(farthest_way(0.3, 120), 0.1);
}

}  // namespace
}  // namespace continuo::thin_bodies_test
