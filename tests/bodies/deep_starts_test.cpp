// Bodies that begin deep in each other or in the ground: they are pushed out, gain no more speed than that needs, and
// do not stand still. Bullets do not pass a wall that comes towards them.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"

namespace continuo::deep_starts_test {
namespace {

/// Numbers that are the same on every machine.
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : state_(seed) {}
  double between(double low, double high) {
    state_ = state_ * 1664525u + 1013904223u;
    return low + (high - low) * (state_ >> 8) / double(1 << 24);
  }
  bool one_in(int count) { return between(0, count) < 1; }

 private:
  std::uint32_t state_;
};

// Rows of boxes that overlap by 0.4, between walls that leave them no room. Each contact pushes two of them apart by no
// more than 4 m/s, so that none of a row of 11 leaves with more than 44 m/s, beside what it falls. Where such a row was
// solved directly, contradicting pushes added up without end, to 1e6 m/s.
void expect_squeezed_boxes_stay_slow(bool is_hinged, int substeps) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  const auto body = world.add({.shape = test::tray(), .mass = 50, .fixed = !is_hinged});
  ASSERT_TRUE(body);
  if (is_hinged) {
    ASSERT_TRUE(world.add_joint({.b = *body, .anchor = {{0, 0}}, .motor = JointMotor<double>{0.2, 1e5}}));
  }
  for (int k = 0; k < 66; ++k) test::add_box<2>(world, {{-3 + 0.6 * (k % 11), -1 + 1.1 * (k / 11)}}, 0.2);
  FastMotion<double, 2> motion(world, {.substeps = substeps});
  double fastest = 0;
  for (int k = 0; k < 30; ++k) {
    ASSERT_TRUE(motion.advance());
    for (const auto& v : world.velocity) fastest = std::max(fastest, length(v));
  }
  EXPECT_LT(fastest, 44 + 9.81 * 0.5) << is_hinged << " " << substeps;
}
TEST(DeepStarts, SqueezedBoxesStaySlow) {
  for (const bool is_hinged : {false, true})
    for (const int substeps : {2, 4}) expect_squeezed_boxes_stay_slow(is_hinged, substeps);
}

template <int Dim>
Shape<double, Dim> random_shape(Numbers& numbers) {
  if (numbers.one_in(3)) return Sphere<double>{numbers.between(0.2, 0.6)};
  if (numbers.one_in(2)) return Capsule<double>{numbers.between(0.3, 2), numbers.between(0.1, 0.4)};
  Box<double, Dim> box;
  for (double& side : box.size.components) side = numbers.between(0.2, 2);
  return box;
}
/// A plane, a thick plate or a thin one, whose upper side is at height 0.
template <int Dim>
void add_ground(World<double, Dim>& world, int kind) {
  if (kind == 0) {
    ASSERT_TRUE(world.add_wall({}));
    return;
  }
  Box<double, Dim> plate;
  plate.size.components.fill(40);
  plate.size[Dim - 1] = kind == 1 ? 10 : 0.01;
  BodyDefinition<double, Dim> ground{.shape = plate, .fixed = true};
  ground.position[Dim - 1] = -plate.size[Dim - 1] / 2;
  ASSERT_TRUE(world.add(ground));
}
// A fast body that begins deep in the ground was set back to where it had been in each step, for ever. The push of
// 4 m/s gives it no more energy than that of this speed, and than to be lifted by its size.
template <int Dim>
void expect_to_leave_the_ground(std::uint32_t seed) {
  Numbers numbers(seed);
  World<double, Dim> world;
  if (!numbers.one_in(3)) world.gravity[Dim - 1] = -9.81;
  add_ground<Dim>(world, static_cast<int>(seed % 3));
  BodyDefinition<double, Dim> body{.shape = random_shape<Dim>(numbers)};
  for (double& x : body.position.components) x = numbers.between(-0.5, 0.5);
  for (double& v : body.velocity.components) v = numbers.between(-1, 1) * std::pow(10, numbers.between(0, 2));
  for (double& w : body.spin.components) w = numbers.between(-30, 30);
  for (double& part : body.orientation.components) part = numbers.between(0.1, 1);
  const auto added = world.add(body);
  ASSERT_TRUE(added);
  const std::size_t i = world.index(*added);
  const double start = kinetic_energy(world) + potential_energy(world);
  FastMotion<double, Dim> motion(world);
  int still = 0;
  for (int k = 0; k < 60; ++k) {
    const auto x = world.position[i];
    const auto orientation = world.orientation[i];
    ASSERT_TRUE(motion.advance());
    const double speed = length(world.velocity[i]), way = length(Vector<double, Dim>(world.position[i] - x));
    still = speed > 0.5 && way < speed / 3000 && world.orientation[i] == orientation ? still + 1 : 0;
    ASSERT_LT(still, 6) << seed << " stands still at " << speed;
    const double energy = kinetic_energy(world) + potential_energy(world);
    ASSERT_LT(energy - start, world.mass[i] * (0.5 * 4 * 4 + 9.81 * 3)) << seed;
  }
}
TEST(DeepStarts, BodiesLeaveTheGround) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    expect_to_leave_the_ground<2>(seed);
    expect_to_leave_the_ground<3>(seed);
  }
}

// A wall of 1 cm that comes with up to 40 m/s passed bullets that had been stopped at it.
template <class Real, int Dim>
void expect_wall_to_stop(std::uint32_t seed) {
  Numbers numbers(seed);
  const auto number = [&](double low, double high) { return static_cast<Real>(numbers.between(low, high)); };
  World<Real, Dim> world;
  Box<Real, Dim> plate;
  plate.size.components.fill(Real(100));
  plate.size[Dim - 1] = Real(0.01);
  BodyDefinition<Real, Dim> wall{.shape = plate, .fixed = true, .traits = {.is_driven = true}};
  wall.velocity[Dim - 1] = number(0, 40);
  const auto driven = world.add(wall);
  Box<Real, Dim> rod;
  for (Real& side : rod.size.components) side = number(0.02, 0.3);
  BodyDefinition<Real, Dim> bullet{.shape = rod};
  if (numbers.one_in(2)) bullet.shape = Capsule<Real>{number(0.1, 1), number(0.01, 0.1)};
  bullet.position[Dim - 1] = Real(0.9);
  const Real speed = std::pow(Real(10), number(1, 3));
  bullet.velocity[0] = speed * number(-0.7, 0.7), bullet.velocity[Dim - 1] = -speed;
  for (Real& w : bullet.spin.components) w = number(-1, 1) * std::pow(Real(10), number(0, 3));
  const auto shot = world.add(bullet);
  ASSERT_TRUE(driven && shot);
  FastMotion<Real, Dim> motion(world);
  for (int k = 0; k < 12; ++k) {
    ASSERT_TRUE(motion.advance());
    if (std::abs(world.position_of(*shot)[0]) > Real(49)) return;  // beside the wall
    ASSERT_GT(world.position_of(*shot)[Dim - 1], world.position_of(*driven)[Dim - 1]) << seed;
  }
}
TEST(DeepStarts, MovingWallsStopBullets) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    expect_wall_to_stop<double, 2>(seed);
    expect_wall_to_stop<double, 3>(seed);
    expect_wall_to_stop<float, 3>(seed);
  }
}

}  // namespace
}  // namespace continuo::deep_starts_test
