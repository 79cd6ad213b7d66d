// Vehicles on wheels, against closed forms and laws of conservation.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/rigid_stepping/energy_bounds.hpp>
#include <continuo/bodies/vehicle.hpp>

namespace continuo::vehicle_test {

using namespace test;  // rigid_worlds.hpp

namespace {

constexpr double h = 1.0 / 60, gravity = 9.81, mass = 1200, radius = 0.35;

/// A car with its wheels at these places before the centre; in space two of each, 1.6 apart.
template <int Dim>
struct Driven {
  World<double, Dim> world;
  Vehicle<double, Dim> car{};

  Driven(World<double, Dim> on, const Vector<double, Dim>& place, const std::vector<double>& axles = {1.3, -1.3},
         double tilt = 0)
      : world(std::move(on)) {
    Box<double, Dim> box;
    box.size[0] = 4, box.size[1] = 1.8, box.size[Dim - 1] = 0.6;
    const auto body = world.add({.shape = box,
                                 .position = place,
                                 .orientation = tilted<Dim>(tilt),
                                 .mass = mass,
                                 .material = {.friction = 0.5}});
    EXPECT_TRUE(body) << describe(body.status());
    car.chassis = *body;
    for (const double x : axles)
      for (const double y : Dim == 2 ? std::vector{0.0} : std::vector{0.8, -0.8}) {
        VehicleWheel<double, Dim> wheel{.radius = radius};
        wheel.hub[0] = x, wheel.hub[Dim - 1] = -0.5;
        if constexpr (Dim == 3) wheel.hub[1] = y;
        wheel.stiffness *= Dim == 2 ? 2 : 1, wheel.damping *= Dim == 2 ? 2 : 1;
        car.wheels.push_back(wheel);
      }
  }
  [[nodiscard]] std::size_t index() const { return world.index(car.chassis); }
  [[nodiscard]] Vector<double, Dim> velocity() const { return world.velocity[index()]; }
  [[nodiscard]] Vector<double, Dim> position() const { return world.position[index()]; }
  [[nodiscard]] double wheels() const { return static_cast<double>(car.wheels.size()); }

  void drive_for(
      double time, const VehicleControls<double>& controls, double step = h,
      const std::function<void()>& after = [] {}) {
    FastMotion<double, Dim> motion(world, {.step = step});
    const auto steps = static_cast<int>(std::lround(time / step));
    for (int k = 0; k < steps; ++k) {
      const Status status = drive(world, Queries<double, Dim>(world), car, controls, step);
      ASSERT_TRUE(status) << describe(status);
      const Status moved = motion.advance();
      ASSERT_TRUE(moved) << describe(moved);
      after();
    }
  }
};

template <int Dim>
World<double, Dim> level(double friction = 1) {
  return world_on_slope<Dim>(0, friction);
}

/// Each axle bears its share by the law of the lever; each spring is compressed by its load over its stiffness.
template <int Dim>
void expect_rest() {
  Driven<Dim> of(level<Dim>(), upright_vector<Dim>(0, 0.9), {1.5, -1.0});
  of.drive_for(10, {});
  EXPECT_NEAR(length(of.velocity()), 0, 1e-9);
  EXPECT_LT(of.car.residual, 1e-15);
  const double each = Dim == 2 ? 1 : 0.5;
  for (std::size_t k = 0; k < of.car.wheels.size(); ++k) {
    const double share = of.car.wheels[k].hub[0] > 0 ? 1.0 / 2.5 : 1.5 / 2.5;
    // The car leans by what its springs differ, which moves its centre by a part of that.
    EXPECT_NEAR(of.car.states[k].load, share * each * mass * gravity, 0.01 * mass * gravity);
    EXPECT_NEAR(of.car.states[k].compression * of.car.wheels[k].stiffness, of.car.states[k].load, 0.01 * mass);
    EXPECT_TRUE(of.car.states[k].is_on_ground);
  }
  const double whole = std::accumulate(of.car.states.begin(), of.car.states.end(), 0.0,
                                       [](double sum, const auto& state) { return sum + state.load; });
  EXPECT_NEAR(whole, mass * gravity, 1e-6 * mass * gravity);
  const auto place = of.position();
  of.drive_for(10, {});
  EXPECT_NEAR(length(Vector<double, Dim>(of.position() - place)), 0, 1e-9);
}

/// Where the tyres hold, the torques move the car and turn its wheels.
template <int Dim>
void expect_acceleration() {
  Driven<Dim> of(level<Dim>(), upright_vector<Dim>(0, 0.73));
  for (auto& wheel : of.car.wheels) wheel.greatest_drive = 300;
  of.drive_for(2, {});
  of.drive_for(2, {.throttle = 0.8});
  const double before = of.velocity()[0], x = of.position()[0];
  of.drive_for(1, {.throttle = 0.8});
  const double turned_mass = mass + of.wheels() * of.car.wheels[0].inertia / (radius * radius);
  const double expected = of.wheels() * 0.8 * 300 / radius / turned_mass;
  EXPECT_NEAR(of.velocity()[0] - before, expected, 1e-5 * expected);  // the body still swings a little
  for (const auto& state : of.car.states) EXPECT_NEAR(state.spin * radius, of.velocity()[0], 1e-4);
  EXPECT_GT(of.position()[0], x);
}

/// With more torque than the tyres hold, they slide: the car has the acceleration of friction.
template <int Dim>
void expect_slides() {
  Driven<Dim> of(level<Dim>(0.64), upright_vector<Dim>(0, 0.73));  // with tyres of 1: 0.8
  for (auto& wheel : of.car.wheels) wheel.greatest_drive = Dim == 2 ? 3000 : 1500, wheel.top_spin = 60;
  of.drive_for(2, {});
  of.drive_for(1, {.throttle = -1});
  const double before = of.velocity()[0];
  of.drive_for(1, {.throttle = -1});
  EXPECT_NEAR(before - of.velocity()[0], 0.8 * gravity, 1e-3 * gravity);
  EXPECT_NEAR(of.car.states[0].spin, -60, 0.5);  // faster than it rolls
  // Locked by the brakes it slides to a halt, and stays there.
  const double v = of.velocity()[0], x = of.position()[0];
  for (auto& wheel : of.car.wheels) wheel.greatest_brake = 20'000;
  of.drive_for(0.5, {.brake = 1});
  EXPECT_NEAR(of.velocity()[0] - v, 0.8 * gravity * 0.5, 0.02 * gravity);
  of.drive_for(6, {.brake = 1});
  EXPECT_NEAR(x - of.position()[0], v * v / (2 * 0.8 * gravity), 0.02 * v * v / (2 * 0.8 * gravity));
  const auto place = of.position();
  of.drive_for(10, {.brake = 1});
  EXPECT_NEAR(length(Vector<double, Dim>(of.position() - place)), 0, 1e-7);
  EXPECT_NEAR(length(of.velocity()), 0, 1e-9);
}

/// A slope on which it rolls, parks, or slides with locked wheels.
template <int Dim>
void expect_slope() {
  const double angle = 0.4;
  const auto up = upright_vector<Dim>(-std::sin(angle), std::cos(angle));
  const auto along = upright_vector<Dim>(std::cos(angle), std::sin(angle));
  const auto speed = [&](const Driven<Dim>& of) { return dot(of.velocity(), along); };
  {
    Driven<Dim> of(world_on_slope<Dim>(angle, 1), up * 0.73, {1.3, -1.3}, angle);
    of.drive_for(3, {.brake = 1});
    const auto place = of.position();
    of.drive_for(60, {.brake = 1});
    EXPECT_NEAR(length(Vector<double, Dim>(of.position() - place)), 0, 1e-7);
    of.drive_for(2, {});  // the brakes are released
    const double before = speed(of);
    of.drive_for(1, {});
    const double turned_mass = mass + of.wheels() * of.car.wheels[0].inertia / (radius * radius);
    EXPECT_NEAR(speed(of) - before, -gravity * std::sin(angle) * mass / turned_mass, 1e-3);
  }
  Driven<Dim> of(world_on_slope<Dim>(angle, 0.09), up * 0.73, {1.3, -1.3}, angle);  // with tyres of 1: 0.3
  of.drive_for(2, {.brake = 1});
  const double before = speed(of);
  of.drive_for(1, {.brake = 1});
  EXPECT_NEAR(speed(of) - before, -gravity * (std::sin(angle) - 0.3 * std::cos(angle)), 2e-3);
}

/// What a motor gives to a wheel in the air, the body loses.
template <int Dim>
void expect_reaction() {
  World<double, Dim> nothing;
  Driven<Dim> of(nothing, {});
  for (auto& wheel : of.car.wheels) wheel.greatest_drive = 500, wheel.top_spin = 40;
  const auto momentum = [&] {
    const double of_body =
        Dim == 2 ? -of.world.spin[0][0] * of.world.inertia(0)[0][0]
                 : of.world.spin[0][Dim == 2 ? 0 : 1] * of.world.inertia(0)[Dim == 2 ? 0 : 1][Dim == 2 ? 0 : 1];
    double sum = of_body;
    for (std::size_t k = 0; k < of.car.states.size(); ++k) sum += of.car.states[k].spin * of.car.wheels[k].inertia;
    return sum;
  };
  of.drive_for(0.5, {.throttle = 1});
  EXPECT_NEAR(of.car.states[0].spin - (Dim == 2 ? -of.world.spin[0][0] : of.world.spin[0][Dim == 2 ? 0 : 1]), 40, 1e-9);
  EXPECT_GT(std::abs(of.world.spin[0][Dim == 2 ? 0 : 1]), 0.01);
  EXPECT_NEAR(momentum(), 0, 1e-9);
  of.drive_for(0.5, {.brake = 1});
  EXPECT_NEAR(momentum(), 0, 1e-9);
  EXPECT_NEAR(of.world.spin[0][Dim == 2 ? 0 : 1], 0, 1e-9);  // all is as it was
}

/// A car that accelerates on a raft which nothing holds.
template <int Dim>
void expect_momentum() {
  World<double, Dim> space;
  Driven<Dim> of(space, upright_vector<Dim>(0, 0.73));
  Box<double, Dim> raft;
  raft.size[0] = 40, raft.size[1] = 8, raft.size[Dim - 1] = 1;
  const auto under = of.world.add({.shape = raft, .position = upright_vector<Dim>(0, -0.5), .mass = 5000});
  ASSERT_TRUE(under) << describe(under.status());
  for (auto& wheel : of.car.wheels) wheel.greatest_drive = 200;
  // Both are pressed together by forces of the user, which stay what they are.
  of.world.constant_force[of.index()] = upright_vector<Dim>(0, -mass * gravity);
  of.world.constant_force[of.world.index(*under)] = upright_vector<Dim>(0, mass * gravity);
  of.drive_for(1.5, {.throttle = 1});
  const auto sum = mass * of.velocity() + 5000 * of.world.velocity_of(*under);
  EXPECT_GT(of.velocity()[0], 1);
  EXPECT_NEAR(length(sum), 0, 1e-8 * mass);
  release(of.world, of.car);
  EXPECT_EQ(of.world.constant_force[of.index()], upright_vector<Dim>(0, -mass * gravity));
  EXPECT_EQ(of.world.constant_force[of.world.index(*under)], upright_vector<Dim>(0, mass * gravity));
}

/// A body that falls on its springs swings as one on a spring and a damper, to the first order in the step.
template <int Dim>
double error_of_swing(double step) {
  Driven<Dim> of(level<Dim>(), upright_vector<Dim>(0, 0.85));  // the springs just touch the ground
  for (auto& wheel : of.car.wheels) wheel.travel = 1, wheel.damping /= 4;
  const double k = of.wheels() * of.car.wheels[0].stiffness / mass, d = of.wheels() * of.car.wheels[0].damping / mass;
  const double rate = std::sqrt(k - d * d / 4), sag = gravity / k;
  double worst = 0, t = 0;
  of.drive_for(1, {}, step, [&] {
    t += step;
    const double y = sag * (std::exp(-d * t / 2) * (std::cos(rate * t) + d / (2 * rate) * std::sin(rate * t)) - 1);
    worst = std::max(worst, std::abs(of.position()[Dim - 1] - 0.85 - y));
  });
  return worst / sag;
}

/// The height of hilly ground.
double hills(double x, double y) {
  return 0.3 * std::sin(0.9 * x + 0.4 * y) + 0.1 * std::sin(2.3 * x - 0.7 * y + 1);
}
/// These, some of them lower than others, as a field of heights that is 120 long.
template <int Dim>
HeightField<double, Dim> ground(double roughness, double shift) {
  constexpr double spacing = Dim == 2 ? 0.05 : 0.3;
  HeightField<double, Dim> field;
  field.spacing.fill(spacing);
  field.counts.fill(static_cast<std::uint32_t>(120 / spacing) + 1);
  for (std::size_t d = 0; d + 1 < Dim; ++d) field.origin[d] = -60;
  for (std::size_t j = 0; j < (Dim == 2 ? 1u : field.counts.back()); ++j)
    for (std::size_t i = 0; i < field.counts[0]; ++i)
      field.heights.push_back(roughness * hills(static_cast<double>(i) * spacing - 60 + shift,
                                                Dim == 2 ? 0 : static_cast<double>(j) * spacing - 60));
  return field;
}

/// Of a car without motor: of its body and wheels in motion, in height, and in its springs.
template <int Dim>
double energy(const Driven<Dim>& of) {
  Driven<Dim> probe = of;  // whose springs are looked at where the wheels are now
  const Status status = drive(probe.world, Queries<double, Dim>(probe.world), probe.car, {}, 1e-9);
  EXPECT_TRUE(status) << describe(status);
  const std::size_t i = of.index();
  const auto spin = in_frame(rotation(of.world.orientation[i]), of.world.spin[i]);
  double sum = mass * (squared(of.velocity()) / 2 + gravity * of.position()[Dim - 1]) +
               dot(spin, of.world.inertia(i) * spin) / 2;
  for (std::size_t k = 0; k < of.car.states.size(); ++k) {
    const double x = probe.car.states[k].compression, turning = of.car.states[k].spin;
    sum += of.car.wheels[k].inertia * turning * turning / 2 + of.car.wheels[k].stiffness * x * x / 2;
  }
  return sum;
}

/// Over hills, with any springs and dampers, steered anyhow, braked or not: no step may add energy. Contacts of the
/// body itself lose some as well.
template <int Dim>
void expect_no_energy_from_nowhere(unsigned seed) {
  std::mt19937 numbers(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(numbers); };
  World<double, Dim> world;
  world.gravity[Dim - 1] = -gravity;
  const double roughness = between(0, 1), shift = between(0, 7);
  ASSERT_TRUE(world.add_mesh({.shape = ground<Dim>(roughness, shift), .material = {.friction = between(0, 2)}}));
  Driven<Dim> of(world, upright_vector<Dim>(0, roughness * 0.4 + between(0.8, 1.2)),
                 {between(0.8, 1.6), between(-1.6, -0.8)});
  for (auto& wheel : of.car.wheels) {
    wheel.stiffness = mass * std::pow(between(8, 25), 2) / of.wheels();
    wheel.damping = between(0.1, 2) * std::sqrt(wheel.stiffness * mass);
    wheel.travel = between(0.2, 0.5), wheel.inertia = std::pow(10, between(-2, 1));
    wheel.greatest_steer = between(-0.5, 0.5);
  }
  of.world.velocity[0][0] = between(-12, 12);
  const VehicleControls<double> controls{.brake = std::max(between(-1, 1), 0.0), .steer = between(-1, 1)};
  double least = std::numeric_limits<double>::infinity();
  of.drive_for(4, controls, 1.0 / 240, [&] {
    const double now = energy(of);
    ASSERT_TRUE(std::isfinite(now));
    ASSERT_LT(of.car.residual, 1e-2);  // and mostly below 1e-9
    // The force of a step belongs to its end, but moves the car from its beginning: energy swings by a part of what a
    // spring takes and gives, which is as small as the step; it must not grow.
    ASSERT_LT(now, least + 0.01 * mass * gravity) << "seed " << seed;
    least = std::min(least, now);
    for (const auto& state : of.car.states) {
      const double y = Dim == 2 ? 0 : state.centre[1];
      ASSERT_GT(state.centre[Dim - 1] - roughness * hills(state.centre[0] + shift, y), 0.2) << "seed " << seed;
    }
  });
}

TEST(Vehicle, RestsOnItsSprings) {
  expect_rest<2>();
  expect_rest<3>();
}
TEST(Vehicle, IsAcceleratedByItsMotors) {
  expect_acceleration<2>();
  expect_acceleration<3>();
}
TEST(Vehicle, SlidesBeyondTheFrictionOfItsTyres) {
  expect_slides<2>();
  expect_slides<3>();
}
TEST(Vehicle, ParksOnASlopeRollsAndSlidesDown) {
  expect_slope<2>();
  expect_slope<3>();
}
TEST(Vehicle, TurnsAgainstItsWheelsInTheAir) {
  expect_reaction<2>();
  expect_reaction<3>();
}
TEST(Vehicle, PushesWhatItDrivesOn) {
  expect_momentum<2>();
  expect_momentum<3>();
}
TEST(Vehicle, SwingsAsASpringWithADamper) {
  for (const double ratio :
       {error_of_swing<2>(1e-3) / error_of_swing<2>(5e-4), error_of_swing<3>(1e-3) / error_of_swing<3>(5e-4)})
    EXPECT_NEAR(ratio, 2, 0.1);
  EXPECT_LT(error_of_swing<3>(5e-4), 0.02);
}

/// Steered wheels whose axles meet those behind in one point go round it, at a speed at which the tyres hold.
TEST(Vehicle, GoesInACircle) {
  Driven<3> of(level<3>(), {{0, 0, 0.73}});
  constexpr double turning_radius = 12, base = 2.6, track = 1.6;
  for (auto& wheel : of.car.wheels) {
    wheel.greatest_drive = 60;
    if (wheel.hub[0] > 0) wheel.greatest_steer = std::atan(base / (turning_radius - wheel.hub[1] / 0.8 * track / 2));
  }
  of.drive_for(2, {.steer = 1});
  of.drive_for(2, {.throttle = 1, .steer = 1});
  // The middle between the wheels behind goes in a circle about the point to its left.
  const auto behind = [&] {
    const std::size_t i = of.index();
    return of.position() + rotation(of.world.orientation[i]) * Vector<double, 3>{{-base / 2, 0, 0}};
  };
  const std::size_t i = of.index();
  const Vector<double, 3> centre =
      behind() + rotation(of.world.orientation[i]) * Vector<double, 3>{{0, turning_radius, 0}};
  double turned = 0, way = 0;
  auto before = behind();
  of.drive_for(20, {.throttle = 0.05, .steer = 1}, h, [&] {
    turned += of.world.spin[i][2] * h;
    way += length(Vector<double, 3>(behind() - before));
    before = behind();
    auto arm = before - centre;
    arm[2] = 0;
    // In a step it goes straight on by v h, beside the tangent by at most that.
    ASSERT_NEAR(length(arm), turning_radius, 0.002 + length(of.velocity()) * h);
  });
  EXPECT_GT(turned, 2);
  EXPECT_NEAR(way / turned, turning_radius, 0.02);
}

TEST(Vehicle, RollsOverRandomHillsWithoutEnergyFromNowhere) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    expect_no_energy_from_nowhere<2>(seed);
    expect_no_energy_from_nowhere<3>(seed);
  }
}

/// A car that bounces over its stop does not fall through it, whatever its springs.
TEST(Vehicle, IsStoppedWhereItsSpringsEnd) {
  for (const double stiffness : {0.0, 100.0, 1e9}) {
    Driven<3> of(level<3>(), {{0, 0, 4}});
    for (auto& wheel : of.car.wheels) wheel.stiffness = stiffness, wheel.damping = 100, wheel.hub[2] = -0.8;
    of.drive_for(6, {}, h, [&] { ASSERT_GT(of.position()[2], 0.8 + radius - 0.3 - 0.15); });
    if (stiffness < 1e3) {
      EXPECT_NEAR(of.position()[2], 0.8 + radius - 0.3, 1e-3);
    }
    EXPECT_NEAR(length(of.velocity()), 0, 1e-6);
    EXPECT_EQ(of.car.states[0].stiffness == stiffness, stiffness < 1e6);
    if (stiffness > 1e6) {
      EXPECT_NEAR(of.car.states[0].stiffness * of.car.states[0].compression, mass * gravity / 4, 1);
    }
  }
}

/// It goes up a kerb that is lower than its wheels.
TEST(Vehicle, GoesUpAKerb) {
  auto world = level<3>();
  ASSERT_TRUE(world.add({.shape = Box<double, 3>{{{20, 20, 0.4}}}, .position = {{15, 0, -0.08}}, .fixed = true}));
  Driven<3> of(world, {{0, 0, 0.73}});
  of.car.chassis = of.world.handle(1);
  for (auto& wheel : of.car.wheels) wheel.greatest_drive = 100;
  double highest = 0;
  of.drive_for(6, {.throttle = 1}, h, [&] { highest = std::max(highest, of.world.position[1][2]); });
  EXPECT_GT(of.world.position[1][0], 8);
  EXPECT_LT(highest, 0.73 + 0.12 + 0.15);
}

/// What only senses does not bear it: the same motion as without.
TEST(Vehicle, DrivesThroughSensors) {
  Driven<3> alone(level<3>(), {{0, 0, 0.73}}), other(level<3>(), {{0, 0, 0.73}});
  for (const double height : {0.1, 0.3})
    ASSERT_TRUE(other.world.add({.shape = Box<double, 3>{{{4, 8, 0.1}}},
                                 .position = {{2, 0, height}},
                                 .fixed = true,
                                 .traits = {.is_sensor = true}}));
  for (Driven<3>* of : {&alone, &other}) {
    for (auto& wheel : of->car.wheels) wheel.greatest_drive = 300;
    of->drive_for(3, {.throttle = 1});
  }
  EXPECT_GT(alone.position()[0], 4);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(other.position()[k], alone.position()[k], 1e-9);
}

TEST(Vehicle, GoesOnToTheSameBits) {
  Driven<3> of(level<3>(), {{0, 0, 1}});
  for (auto& wheel : of.car.wheels) wheel.greatest_drive = 500, wheel.greatest_steer = wheel.hub[0] > 0 ? 0.4 : 0.0;
  of.drive_for(2, {.throttle = 1, .steer = 0.3});
  Driven<3> copy = of;
  of.drive_for(2, {.throttle = 1, .steer = -1});
  copy.drive_for(2, {.throttle = 1, .steer = -1});
  EXPECT_EQ(state_hash(of.world), state_hash(copy.world));
  EXPECT_GT(of.velocity()[0], 3);
}

TEST(Vehicle, RestsInSinglePrecision) {
  World<float, 3> world;
  world.gravity = {{0, 0, -9.81F}};
  ASSERT_TRUE(world.add_wall({}));
  const auto body = world.add({.shape = Box<float, 3>{{{4, 1.8F, 0.6F}}}, .position = {{0, 0, 1}}, .mass = 1200.0F});
  Vehicle<float, 3> car{.chassis = *body};
  for (const float x : {-1.3F, 1.3F})
    for (const float y : {-0.8F, 0.8F}) car.wheels.push_back({.hub = {{x, y, -0.5F}}});
  FastMotion<float, 3> motion(world);
  for (int k = 0; k < 600; ++k) {
    ASSERT_TRUE(drive(world, Queries<float, 3>(world), car, {.brake = 1}, 1.0F / 60));
    ASSERT_TRUE(motion.advance());
  }
  EXPECT_LT(length(world.velocity[0]), 1e-4F);
  for (const auto& state : car.states) EXPECT_NEAR(state.load, 300 * 9.81F, 3);
}

TEST(Vehicle, SaysWhatMakesNoSense) {
  Driven<3> of(level<3>(), {{0, 0, 1}});
  const auto message = [&](const auto& change, const VehicleControls<double>& controls = {}, double duration = h) {
    Vehicle<double, 3> car = of.car;
    change(car);
    const auto hash = state_hash(of.world);
    const Status status = drive(of.world, Queries<double, 3>(of.world), car, controls, duration);
    EXPECT_FALSE(status);
    EXPECT_EQ(state_hash(of.world), hash);
    EXPECT_TRUE(car.forces.empty());
    return status.message;
  };
  const auto nothing = [](auto&) {};
  EXPECT_NE(message([](auto& car) { car.chassis = {}; }).find("no body of this world"), std::string::npos);
  EXPECT_NE(message([](auto& car) { car.wheels[2].radius = 0; }).find("radius"), std::string::npos);
  EXPECT_NE(message([](auto& car) { car.wheels[2].stiffness = -1; }).find("stiffness"), std::string::npos);
  EXPECT_NE(message([](auto& car) { car.wheels[2].inertia = 0; }).find("moment of inertia"), std::string::npos);
  EXPECT_NE(message([](auto& car) { car.wheels.resize(65); }).find("64"), std::string::npos);
  EXPECT_NE(message([](auto& car) { car.states.resize(1); }).find("one state for each"), std::string::npos);
  EXPECT_NE(message(nothing, {.throttle = 2}).find("throttle"), std::string::npos);
  EXPECT_NE(message(nothing, {.brake = std::nan("")}).find("brake"), std::string::npos);
  EXPECT_NE(message(nothing, {}, 0).find("duration"), std::string::npos);
  const auto rock = of.world.add({.position = {{9, 9, 9}}, .fixed = true});
  EXPECT_NE(message([&](auto& car) { car.chassis = *rock; }).find("fixed"), std::string::npos);
}

}  // namespace
}  // namespace continuo::vehicle_test
