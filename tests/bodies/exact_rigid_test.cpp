// The exact motion of bodies of any shape and of joints, against closed forms, reduced equations and conservation laws.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "exact_steps.hpp"
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/snapshot.hpp>
#include <continuo/shapes/manifold.hpp>
#include <continuo/status/require.hpp>

namespace continuo::exact_rigid_test {
namespace {

using World2 = World<double, 2>;
using World3 = World<double, 3>;
using V2 = Vector<double, 2>;
using V3 = Vector<double, 3>;
constexpr double pi = std::numbers::pi, never = std::numeric_limits<double>::infinity();
constexpr Material<double> smooth{.restitution = 0, .friction = 0}, elastic{.restitution = 1, .friction = 0};

using test::advance, test::energy;
/// y'' = f(y, y') after T, by the classical Runge-Kutta method.
template <class F>
std::array<double, 2> integrated(double y, double v, double duration, F f) {
  constexpr int steps = 4000;  // to 1e-12 in what follows
  const double h = duration / steps;
  for (int i = 0; i < steps; ++i) {
    const double k1 = v, l1 = f(y, v), k2 = v + h / 2 * l1, l2 = f(y + h / 2 * k1, v + h / 2 * l1);
    const double k3 = v + h / 2 * l2, l3 = f(y + h / 2 * k2, v + h / 2 * l2);
    const double k4 = v + h * l3, l4 = f(y + h * k3, v + h * l3);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), v += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
  }
  return {y, v};
}

// Free bodies.

/// sn, cn and dn of Jacobi by the arithmetic-geometric mean (Abramowitz, Stegun, 16.4).
std::array<double, 3> jacobi(double u, double k2) {
  std::array<double, 12> a{1}, c{std::sqrt(k2)};
  double b = std::sqrt(1 - k2);
  std::size_t n = 0;
  for (; n + 1 < a.size() && c[n] > 1e-16; ++n) {
    a[n + 1] = (a[n] + b) / 2, c[n + 1] = (a[n] - b) / 2;
    b = std::sqrt(a[n] * b);
  }
  double phase = std::ldexp(a[n] * u, static_cast<int>(n));
  for (; n > 0; --n) phase = (phase + std::asin(c[n] / a[n] * std::sin(phase))) / 2;
  const double sn = std::sin(phase);
  return {sn, std::cos(phase), std::sqrt(1 - k2 * sn * sn)};
}
// L. D. Landau, E. M. Lifshitz, "Mechanics", 37: a body that turns about nearly its middle axis flips again and again.
TEST(ExactRigid, AFreeNutFlipsAsEulerSays) {
  World3 world;
  const double i1 = 5, i2 = 10, i3 = 13, w1 = 1.24, w3 = 1;
  require(world.add({.shape = Box<double, 3>{{{3, 2, 1}}}, .spin = {{w1, 0, w3}}, .mass = 12}));
  const double twice_energy = i1 * w1 * w1 + i3 * w3 * w3, l2 = i1 * i1 * w1 * w1 + i3 * i3 * w3 * w3;
  const double rate = std::sqrt((i3 - i2) * (l2 - twice_energy * i1) / (i1 * i2 * i3));
  const double k2 = (i2 - i1) * (twice_energy * i3 - l2) / ((i3 - i2) * (l2 - twice_energy * i1));
  ASSERT_LT(k2, 1);
  ASSERT_GT(k2, 0.98);  // at 1 it would turn about the middle axis for ever
  const V3 momentum = angular_momentum(world);
  const double before = kinetic_energy(world);
  ExactMotion motion(world, {.tolerance = 1e-12});
  for (int k = 1; k <= 200; ++k) {
    advance(motion, k);
    EXPECT_NEAR(kinetic_energy(world) / before, 1, 1e-14 * 64);
    EXPECT_LT(length(V3(angular_momentum(world) - momentum)), 1e-14 * 64 * length(momentum));
    const V3 spin = transposed_times(rotation(world.orientation[0]), world.spin[0]);
    const auto [sn, cn, dn] = jacobi(rate * k, k2);
    EXPECT_NEAR(spin[0], w1 * cn, 1e-8) << k;
    EXPECT_NEAR(spin[1], std::sqrt((twice_energy * i3 - l2) / (i2 * (i3 - i2))) * sn, 1e-8);
    EXPECT_NEAR(spin[2], w3 * dn, 1e-8);
  }
}
TEST(ExactRigid, BodiesHaveTheirTraits) {
  World2 world;
  world.gravity = {{0, -10}};
  const Box<double, 2> box{};
  require(world.add({.shape = box, .velocity = {{1, 0}}, .spin = {{2}}, .traits = {.gravity_scale = 0.5}}));
  require(world.add({.shape = box,
                     .position = {{9, 0}},
                     .velocity = {{3, 0}},
                     .spin = {{2}},
                     .traits = {.gravity_scale = 0, .damping = 0.7, .spin_damping = 0.4}}));
  require(world.add({.shape = box,
                     .position = {{50, 0}},
                     .velocity = {{0, 2}},
                     .spin = {{1}},
                     .fixed = true,
                     .traits = {.is_driven = true}}));
  ExactMotion motion(world);
  advance(motion, 2);
  EXPECT_NEAR(world.position[0][1], -0.5 * 10 * 2, 1e-9);
  EXPECT_NEAR(world.velocity[1][0], 3 * std::exp(-1.4), 1e-9);
  EXPECT_NEAR(world.spin[1][0], 2 * std::exp(-0.8), 1e-9);
  EXPECT_NEAR(world.position[2][1], 4, 1e-14);
  EXPECT_NEAR(world.orientation[2][0], 2, 1e-14);
}

// Joints.

/// A box of a length along its first axis, between two places of the plane of x and y.
template <int Dim>
BodyHandle add_bar(World<double, Dim>& world, const V2& from, const V2& to, double mass) {
  const double angle = std::atan2(to[1] - from[1], to[0] - from[0]);
  Box<double, Dim> box;
  box.size.components.fill(0.1);
  box.size[0] = length(V2(to - from));
  BodyDefinition<double, Dim> bar{.shape = box, .mass = mass};
  for (std::size_t i = 0; i < 2; ++i) bar.position[i] = (from[i] + to[i]) / 2;
  if constexpr (Dim == 2) {
    bar.orientation = {{angle}};
  } else {
    bar.orientation = {{std::cos(angle / 2), 0, 0, std::sin(angle / 2)}};
  }
  return require(world.add(bar));
}
template <int Dim>
JointDefinition<double, Dim> hinge(BodyHandle a, BodyHandle b, const V2& anchor) {
  JointDefinition<double, Dim> joint{.kind = JointKind::hinge, .a = a, .b = b};
  joint.anchor[0] = anchor[0], joint.anchor[1] = anchor[1];
  return joint;  // about z
}
/// The end of a bar, from its middle.
template <int Dim>
Vector<double, Dim> end_of(const World<double, Dim>& world, BodyHandle bar, double way) {
  const std::size_t i = world.index(bar);
  return world.position[i] + rotation(world.orientation[i])[0] * way;
}

/// A crank of length 1 and mass 1, a rod of length 3 and mass 2, a slider of mass 0.7 on the x axis.
struct SliderCrank {
  explicit SliderCrank(double angle, double spin, std::optional<JointMotor<double>> motor, double gravity) {
    world.gravity = {{0, -gravity}};
    const double b = std::asin(std::sin(angle) / 3), b1 = std::cos(angle) / (3 * std::cos(b));
    const V2 pin{{std::cos(angle), std::sin(angle)}}, end{{pin[0] + 3 * std::cos(b), 0}};
    crank = add_bar<2>(world, {}, pin, 1), rod = add_bar<2>(world, pin, end, 2);
    slider = add_bar<2>(world, V2{{end[0] - 0.1, 0}}, V2{{end[0] + 0.1, 0}}, 0.7);
    auto first = hinge<2>({}, crank, {});
    first.motor = motor;
    drive = require(world.add_joint(first));
    require(world.add_joint(hinge<2>(crank, rod, pin)));
    require(world.add_joint(hinge<2>(rod, slider, end)));
    require(world.add_joint({.kind = JointKind::slider, .b = slider, .anchor = end, .axis = {{1, 0}}}));
    world.spin = {{{spin}}, {{-b1 * spin}}, {{0}}};
    const double at_rod = -std::sin(angle) - 1.5 * std::sin(b) * b1,
                 at_slider = -std::sin(angle) - 3 * std::sin(b) * b1;
    world.velocity = {
        {{-pin[1] * spin / 2, pin[0] * spin / 2}}, {{at_rod * spin, pin[0] * spin / 2}}, {{at_slider * spin, 0}}};
  }
  [[nodiscard]] double violation() const {
    return std::max({length(end_of(world, crank, -0.5)), std::abs(world.position[2][1]),
                     length(V2(end_of(world, crank, 0.5) - end_of(world, rod, -1.5))),
                     length(V2(end_of(world, rod, 1.5) - world.position[2])), std::abs(world.orientation[2][0])});
  }
  World2 world;
  BodyHandle crank, rod, slider;
  JointHandle drive;
};
/// Lagrange's equation of the crank angle f: with the kinetic energy J(f) f'^2 / 2 and the potential energy V(f), the
/// torque is J f'' + J' f'^2 / 2 + V'.
struct ReducedCrank {
  explicit ReducedCrank(double f, double gravity) {
    const double sb = std::sin(f) / 3, cb = std::sqrt(1 - sb * sb), b1 = std::cos(f) / (3 * cb);
    const double b2 = (-std::sin(f) / 3 + sb * b1 * b1) / cb;  // second derivative of the angle of the rod
    const double of_crank = 1.01 / 12, of_rod = 2 * 9.01 / 12;
    const auto x1 = [&](double l) { return -std::sin(f) - l * sb * b1; };
    const auto x2 = [&](double l) { return -std::cos(f) - l * (cb * b1 * b1 + sb * b2); };
    const double y1 = std::cos(f) / 2, y2 = -std::sin(f) / 2;
    inertia = of_crank + 0.25 + of_rod * b1 * b1 + 2 * (x1(1.5) * x1(1.5) + y1 * y1) + 0.7 * x1(3) * x1(3);
    slope = 2 * (of_rod * b1 * b2 + 2 * (x1(1.5) * x2(1.5) + y1 * y2) + 0.7 * x1(3) * x2(3));
    weight = gravity * (std::cos(f) / 2 + 2 * y1);
  }
  double inertia, slope, weight;
};
TEST(ExactRigid, TheTorqueOfASliderCrankIsThatOfItsReducedEquation) {
  SliderCrank of(0.3, 2, JointMotor<double>{.speed = 2, .most = never}, 9.81);
  ExactMotion motion(of.world, {.tolerance = 1e-11});
  for (int k = 1; k <= 12; ++k) {
    advance(motion, 0.77 * k);
    EXPECT_LT(of.violation(), 1e-14);
    EXPECT_NEAR(of.world.orientation[0][0], 0.3 + 2 * of.world.time, 1e-10);
    const ReducedCrank reduced(0.3 + 2 * of.world.time, 9.81);
    EXPECT_NEAR(of.world.find(of.drive)->motor_effort, reduced.slope * 2 + reduced.weight, 1e-9);
  }
}
TEST(ExactRigid, AFreeSliderCrankTurnsByItsReducedEquation) {
  SliderCrank of(0.3, 3, {}, 9.81);
  ExactMotion motion(of.world, {.tolerance = 1e-12});
  advance(motion, 5);
  EXPECT_LT(of.violation(), 1e-13);
  const auto [angle, rate] = integrated(0.3, 3, 5, [](double f, double w) {
    const ReducedCrank at(f, 9.81);
    return -(at.slope * w * w / 2 + at.weight) / at.inertia;
  });
  EXPECT_NEAR(of.world.orientation[0][0], angle, 1e-8);
  EXPECT_NEAR(of.world.spin[0][0], rate, 1e-8);
}

/// Where the pin between a coupler of length 3 and a rocker of length 2.5 is, whose other end is at x = 2.8.
V2 pin_of_rocker(const V2& crank) {
  const V2 way{{2.8 - crank[0], -crank[1]}};
  const double d = length(way), angle = std::atan2(way[1], way[0]) + std::acos((9 + d * d - 6.25) / (6 * d));
  return {{crank[0] + 3 * std::cos(angle), crank[1] + 3 * std::sin(angle)}};
}
// In space the four hinges hold it three times more often than it needs.
template <int Dim>
void expect_four_bar_moves() {
  World<double, Dim> world;
  const V2 pin{{std::cos(0.9), std::sin(0.9)}}, other = pin_of_rocker(pin), ground{{2.8, 0}};
  const auto crank = add_bar<Dim>(world, {}, pin, 1), coupler = add_bar<Dim>(world, pin, other, 3),
             rocker = add_bar<Dim>(world, other, ground, 2.5);
  auto drive = hinge<Dim>({}, crank, {});
  drive.motor = JointMotor<double>{.speed = 2, .most = never};
  require(world.add_joint(drive));
  require(world.add_joint(hinge<Dim>(crank, coupler, pin)));
  require(world.add_joint(hinge<Dim>(coupler, rocker, other)));
  require(world.add_joint(hinge<Dim>({}, rocker, ground)));
  ExactMotion motion(world, {.tolerance = 1e-11});
  for (int k = 1; k <= 5; ++k) {
    advance(motion, 0.9 * k);
    const double angle = 0.9 + 2 * world.time;
    const V2 at{{std::cos(angle), std::sin(angle)}}, end = pin_of_rocker(at);
    EXPECT_NEAR(world.position[1][0], (at[0] + end[0]) / 2, 1e-10);
    EXPECT_NEAR(world.position[1][1], (at[1] + end[1]) / 2, 1e-10);
    EXPECT_LT(length(Vector<double, Dim>(end_of(world, crank, 0.5) - end_of(world, coupler, -1.5))), 1e-14);
    EXPECT_LT(length(Vector<double, Dim>(end_of(world, coupler, 1.5) - end_of(world, rocker, -1.25))), 1e-14);
  }
}
TEST(ExactRigid, AFourBarLinkageMovesAsItsGeometrySays) {
  expect_four_bar_moves<2>();
  expect_four_bar_moves<3>();
}

// What a joint holds does no work: a wrong derivative of any constraint would show in the energy.
template <int Dim>
void expect_joint_keeps_energy(JointKind kind, std::mt19937& random) {
  World<double, Dim> world;
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&] {
    Vector<double, Dim> v;
    for (double& c : v.components) c = number(random);
    return v;
  };
  world.gravity = vector() * 5;
  Box<double, Dim> box;
  for (double& c : box.size.components) c = 0.5 + std::abs(number(random));
  BodyDefinition<double, Dim> of{.shape = box};
  std::array<BodyHandle, 2> bodies;
  for (BodyHandle& body : bodies) {
    of.position = vector(), of.velocity = vector();
    for (double& c : of.spin.components) c = number(random);
    of.orientation = turned(of.orientation, of.spin, 1.3);
    body = require(world.add(of));
    of.traits.mask = of.traits.category = 0;
  }
  require(world.set_traits(bodies[0], of.traits));  // they do not collide
  JointDefinition<double, Dim> joint{.kind = kind, .b = bodies[0], .anchor = vector()};
  if (Dim == 3 || kind != JointKind::universal) joint.axis = vector(), joint.axle = vector();
  joint.ratio = 1.7;
  if (kind == JointKind::distance) joint.anchor_b = joint.anchor + vector() + vector();
  require(world.add_joint(joint));
  joint.a = bodies[0], joint.b = bodies[1];
  require(world.add_joint(joint));
  ExactMotion motion(world, {.tolerance = 1e-12});
  advance(motion, 1e-9);  // velocities are now those that the joints allow
  const double before = energy(world), size = kinetic_energy(world) + 1;
  advance(motion, 1.5);
  EXPECT_NEAR(energy(world), before, 1e-9 * size) << static_cast<int>(kind) << " in " << Dim;
}
TEST(ExactRigid, JointsDoNoWork) {
  std::mt19937 random(7);
  for (const JointKind kind : {JointKind::hinge, JointKind::ball, JointKind::slider, JointKind::weld,
                               JointKind::distance, JointKind::wheel, JointKind::gear}) {
    expect_joint_keeps_energy<2>(kind, random);
    if (kind != JointKind::gear) expect_joint_keeps_energy<3>(kind, random);
  }
  expect_joint_keeps_energy<3>(JointKind::universal, random);
}

// A torque of 0.5 turns an inertia of 1/6 until the speed is reached, after which only a load of 0.2 is borne.
TEST(ExactRigid, AMotorHasItsTorqueUntilItHasItsSpeed) {
  World2 world;
  const auto box = require(world.add({.shape = Box<double, 2>{}, .mass = 1}));
  auto joint = hinge<2>({}, box, {});
  joint.motor = JointMotor<double>{.speed = 3, .most = 0.5};
  const JointHandle motor = require(world.add_joint(joint));
  world.torque_laws.push_back([](const World2&, double, const BodyStates<double, 2>&,
                                 std::span<Vector<double, 1>> torque) { torque[0][0] -= 0.2; });
  ExactMotion motion(world);
  advance(motion, 1);
  EXPECT_NEAR(world.spin[0][0], 0.3 * 6, 1e-9);
  EXPECT_NEAR(world.find(motor)->motor_effort, 0.5, 1e-12);
  advance(motion, 3);
  const double reached = 3 / (0.3 * 6);
  EXPECT_NEAR(world.spin[0][0], 3, 1e-12);
  EXPECT_NEAR(world.orientation[0][0], 0.9 * reached * reached + 3 * (3 - reached), 1e-9);
  EXPECT_NEAR(world.find(motor)->motor_effort, 0.2, 1e-9);
}

// Contacts.

/// The deepest overlap of two boxes of a world.
template <int Dim>
double overlap_of_boxes(const World<double, Dim>& world) {
  double deepest = 0;
  const auto pose = [&](std::size_t i) { return Pose<double, Dim>{world.position[i], rotation(world.orientation[i])}; };
  for (std::size_t i = 0; i < world.size(); ++i) {
    const auto& a = world.solid(i)->parts[0].convex;
    for (std::size_t j = 0; j < i; ++j) {
      const auto& b = world.solid(j)->parts[0].convex;
      const auto axis = least_overlap(a.core, b.core, relative(pose(i), pose(j)), 0.0);
      deepest = std::max(deepest, -axis.separation);
    }
    for (const auto& wall : world.walls())
      for (const auto& corner : a.core.corners)
        deepest = std::max(deepest, wall.offset - dot(wall.normal, pose(i).place(corner)));
  }
  return deepest;
}
template <int Dim>
void expect_elastic_boxes_keep_energy(int boxes, double duration) {
  World<double, Dim> world;
  world.gravity[Dim - 1] = -10;
  Vector<double, Dim> upper;
  upper.components.fill(4);
  require(world.add_container({}, upper, elastic));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int i = 0; i < boxes; ++i) {
    BodyDefinition<double, Dim> of{.material = elastic};
    Box<double, Dim> box;
    for (double& c : box.size.components) c = 0.8 + 0.3 * number(random);
    of.shape = box;
    for (int axis = 0, k = i; axis < Dim; ++axis, k /= 2) of.position[static_cast<std::size_t>(axis)] = k % 2 * 2 + 1;
    for (double& c : of.velocity.components) c = 2 * number(random);
    for (double& c : of.spin.components) c = 2 * number(random);
    require(world.add(of));
  }
  ExactMotion motion(world);
  const double before = energy(world);
  for (int k = 1; k <= 20; ++k) {
    advance(motion, duration * k / 20);
    EXPECT_LT(overlap_of_boxes(world), 1e-10);
  }
  EXPECT_NEAR(energy(world) / before, 1, 1e-12);
  EXPECT_GT(motion.statistics().collisions, 4u);
}
TEST(ExactRigid, ElasticBoxesKeepTheirEnergyAndDoNotOverlap) {
  expect_elastic_boxes_keep_energy<2>(4, 4);
  expect_elastic_boxes_keep_energy<3>(8, 1);
}
TEST(ExactRigid, OfElasticBoxesInARowTheLastLeaves) {
  World2 world;
  for (int i = 0; i < 4; ++i)
    require(world.add({.shape = Box<double, 2>{}, .position = {{i == 0 ? -3.0 : i, 0}}, .material = elastic}));
  world.velocity[0] = {{2, 0}};
  ExactMotion motion(world);
  advance(motion, 3);  // they touch at t = 1.5
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(length(world.velocity[i]), 0, 1e-14);
  EXPECT_NEAR(world.position[3][0], 3 + 2 * 1.5, 1e-12);
}
TEST(ExactRigid, ADrivenPlateStrikesABox) {
  World3 world;
  require(world.add({.shape = Box<double, 3>{{{9, 9, 1}}},
                     .velocity = {{0, 0, 1}},
                     .fixed = true,
                     .material = elastic,
                     .traits = {.is_driven = true}}));
  require(
      world.add({.shape = Box<double, 3>{}, .position = {{0, 0, 5}}, .velocity = {{0, 0, -3}}, .material = elastic}));
  ExactMotion motion(world);
  advance(motion, 2);  // they meet after 1, where the box turns to 2 * 1 + 3
  EXPECT_NEAR(world.position[1][2], 2 + 5, 1e-12);
  EXPECT_NEAR(length(world.spin[1]), 0, 1e-13);
}
// e = 1/2: from a height that takes 1 to fall, the bounces last 1 + 1/2 + 1/4 + ... = 2 more.
TEST(ExactRigid, ABoxThatBouncesLessAndLessComesToRest) {
  World2 world;
  world.gravity = {{0, -10}};
  require(world.add_wall({.material = smooth}));
  require(world.add(
      {.shape = Box<double, 2>{}, .position = {{0, 5.5}}, .mass = 1, .material = {.restitution = 0.5, .friction = 0}}));
  ExactMotion motion(world, {.contact_events = 100});
  advance(motion, 4);
  EXPECT_NEAR(world.position[0][1], 0.5, 1e-14);
  EXPECT_NEAR(length(world.velocity[0]), 0, 1e-14);
  ASSERT_FALSE(motion.contact_events().empty());
  EXPECT_EQ(motion.contact_events().back().change, ContactChange::begin);
  EXPECT_NEAR(motion.contact_events().back().time, 3,
              1e-4);  // it rests where a bounce is shorter than the contact time
}

/// A box of side 1 and mass 1 on its corner, leaning by 0.1.
World2 box_on_corner(double friction) {
  World2 world;
  world.gravity = {{0, -9.81}};
  require(world.add_wall({.material = {.friction = friction}}));
  const double r = std::sqrt(0.5);
  require(world.add({.shape = Box<double, 2>{},
                     .position = {{r * std::sin(0.1), r * std::cos(0.1)}},
                     .orientation = {{pi / 4 - 0.1}},
                     .mass = 1,
                     .material = {.friction = friction}}));
  return world;
}
TEST(ExactRigid, ABoxOnItsCornerFallsByItsReducedEquation) {
  const double r = std::sqrt(0.5), inertia = 1.0 / 6, g = 9.81;
  {  // It sticks: a pendulum about the corner.
    World2 world = box_on_corner(5);
    ExactMotion motion(world, {.tolerance = 1e-12});
    advance(motion, 0.5);
    const auto [angle, rate] =
        integrated(0.1, 0, 0.5, [&](double q, double) { return g * r * std::sin(q) / (inertia + r * r); });
    EXPECT_NEAR(world.orientation[0][0], pi / 4 - angle, 1e-10);
    EXPECT_NEAR(world.spin[0][0], -rate, 1e-10);
    EXPECT_NEAR(world.position[0][0], r * std::sin(angle), 1e-10);
  }
  {  // Without friction its centre falls straight down: (I + r^2 sin^2) q'' + r^2 sin cos q'^2 = g r sin.
    World2 world = box_on_corner(0);
    ExactMotion motion(world, {.tolerance = 1e-12, .contact_events = 20});
    advance(motion, 0.4);
    const auto fall = [&](double q, double v) {
      const double s = std::sin(q), c = std::cos(q);
      return (g * r * s - r * r * s * c * v * v) / (inertia + r * r * s * s);
    };
    EXPECT_NEAR(world.orientation[0][0], pi / 4 - integrated(0.1, 0, 0.4, fall)[0], 1e-10);
    EXPECT_NEAR(world.position[0][0], r * std::sin(0.1), 1e-12);
    advance(motion, 2);  // it lies
    ASSERT_FALSE(motion.contact_events().empty());
    EXPECT_NEAR(integrated(0.1, 0, motion.contact_events().front().time, fall)[0], pi / 4, 1e-10);
    EXPECT_NEAR(world.position[0][1], 0.5, 1e-14);
    EXPECT_NEAR(std::remainder(world.orientation[0][0], pi / 2), 0, 1e-13);
  }
}
// G. W. Housner, "The behavior of inverted pendulum structures during earthquakes", 1963: where a rocking block comes
// down on its other corner, it keeps 1 - 3/2 sin^2 of its spin, with the angle of its diagonal: 1/4 of a square.
TEST(ExactRigid, ARockingBoxLosesWhatHousnerSays) {
  World2 world = box_on_corner(5);
  ExactMotion motion(world, {.tolerance = 1e-11, .contact_events = 20});
  advance(motion, 1.05);
  std::vector<double> impulses;
  for (const auto& event : motion.contact_events())
    if (event.change == ContactChange::impact) impulses.push_back(event.impulse);
  ASSERT_EQ(impulses.size(), 2u);
  EXPECT_NEAR(impulses[1] / impulses[0], 0.25, 1e-8);
}
// x = l cos q, y = l sin q of the centre: the wall no longer pushes where x'' = 0, at sin q = 2/3 of that of the start,
// whatever the inertia.
TEST(ExactRigid, ALadderLeavesItsWallAtTwoThirds) {
  World2 world;
  world.gravity = {{0, -9.81}};
  require(world.add_wall({.offset = -0.05, .material = smooth}));  // the axis of the ladder meets the axes of the plane
  require(world.add_wall({.normal = {{1, 0}}, .offset = -0.05, .material = smooth}));
  const double start = 1.2;
  require(world.add({.shape = Capsule<double>{2, 0.05},
                     .position = {{std::cos(start), std::sin(start)}},
                     .orientation = {{pi / 2 - start}},
                     .mass = 1,
                     .material = smooth}));
  ExactMotion motion(world, {.tolerance = 1e-12, .contact_events = 20});
  advance(motion, 0.7);
  std::optional<double> left;
  for (const auto& event : motion.contact_events())
    if (event.change == ContactChange::end) left = event.time;
  ASSERT_TRUE(left);
  const double k = 9.81 / (1 + world.inertia(0)[0][0]);
  const auto [angle, rate] = integrated(start, 0, *left, [&](double q, double) { return -k * std::cos(q); });
  EXPECT_NEAR(std::sin(angle), std::sin(start) * 2 / 3, 1e-9);
  EXPECT_NEAR(world.velocity[0][0], -std::sin(angle) * rate, 1e-9);  // from then on constant
}
TEST(ExactRigid, ABoxSticksAndSlipsAsCoulombSays) {
  for (const double ratio : {0.99, 1.01}) {
    World2 world;
    const double slope = 0.5, friction = std::tan(slope) / ratio;
    world.gravity = {{0, -9.81}};
    require(world.add_wall({.normal = {{-std::sin(slope), std::cos(slope)}}, .material = {.friction = friction}}));
    require(world.add({.shape = Box<double, 2>{},
                       .position = {{-0.5 * std::sin(slope), 0.5 * std::cos(slope)}},
                       .orientation = {{slope}},
                       .mass = 1,
                       .material = {.friction = friction}}));
    ExactMotion motion(world);
    advance(motion, 1);
    const double way = -(world.position[0][0] * std::cos(slope) + world.position[0][1] * std::sin(slope));
    EXPECT_NEAR(way, ratio < 1 ? 0 : 9.81 * (std::sin(slope) - friction * std::cos(slope)) / 2, 1e-12);
  }
  World2 world;
  world.gravity = {{0, -10}};
  require(world.add_wall({}));
  require(world.add({.shape = Box<double, 2>{}, .position = {{0, 0.5}}, .velocity = {{2, 0}}}));
  require(world.add({.position = {{9, 0.5}}, .velocity = {{3, 0}}}));  // a disc, which slides and then rolls
  ExactMotion motion(world);
  advance(motion, 1);
  EXPECT_NEAR(world.position[0][0], 4.0 / (2 * 5), 1e-12);
  EXPECT_NEAR(length(world.velocity[0]), 0, 1e-12);
  EXPECT_NEAR(world.velocity[1][0], 2, 1e-10);  // two thirds
  EXPECT_NEAR(world.spin[1][0], -4, 1e-10);
}
// A rod that slides with its foot on a rough floor; the force N of the floor follows from y'' = N - g of the centre at
// l sin q, and the torque of N and of the friction -f N.
TEST(ExactRigid, ASlidingRodTurnsByItsReducedEquation) {
  const double friction = 0.5, radius = 0.02, g = 9.81;
  World2 world;
  world.gravity = {{0, -g}};
  require(world.add_wall({.offset = -radius, .material = {.friction = friction}}));
  require(world.add({.shape = Capsule<double>{2, radius},
                     .position = {{std::cos(1.0), std::sin(1.0)}},
                     .velocity = {{4, 0}},
                     .orientation = {{1 - pi / 2}},
                     .mass = 1,
                     .material = {.friction = friction}}));
  ExactMotion motion(world, {.tolerance = 1e-12});
  advance(motion, 0.15);
  const double inertia = world.inertia(0)[0][0];
  const auto [angle, rate] = integrated(1, 0, 0.15, [&](double q, double v) {
    const double lever = (-std::cos(q) - friction * (std::sin(q) + radius)) / inertia;
    return lever * (g - std::sin(q) * v * v) / (1 - std::cos(q) * lever);
  });
  EXPECT_NEAR(world.orientation[0][0] + pi / 2, angle, 1e-11);
  EXPECT_NEAR(world.spin[0][0], rate, 1e-11);
}
// P. Painleve, "Sur les lois du frottement de glissement", 1895: with much friction, a rod that is pushed ahead of its
// foot has no forces that belong together.
TEST(ExactRigid, PainlevesRodIsNotMovedWrongly) {
  World2 world;
  world.gravity = {{0, -9.81}};
  require(world.add_wall({.offset = -0.02, .material = {.friction = 2}}));
  require(world.add({.shape = Capsule<double>{2, 0.02},
                     .position = {{std::cos(0.9), std::sin(0.9)}},
                     .velocity = {{-4, 0}},
                     .orientation = {{0.9 - pi / 2}},
                     .mass = 1,
                     .material = {.friction = 2}}));
  ExactMotion motion(world);
  const Status status = motion.advance_to(1);
  EXPECT_EQ(status.ending, Ending::cannot_continue);
  EXPECT_THAT(status.message, testing::HasSubstr("Painleve"));
  EXPECT_EQ(world.time, 0);
}
// F. Genot, B. Brogliato, "New results on Painleve paradoxes", European Journal of Mechanics A 18, 1999, 653-677: near
// the configurations where forces cease to belong together, those with `share` below 0, a sliding rod moves as its
// reduced equation says, until it comes off or sticks; afterwards it has no energy from nowhere, or does not move.
TEST(ExactRigid, ARodNearPainlevesParadoxTurnsByItsReducedEquation) {
  constexpr double friction = 2, radius = 0.02, g = 9.81, start = 1.5;
  for (const double spin : {-0.5, -1.0, -2.0}) {
    World2 world;
    world.gravity = {{0, -g}};
    require(world.add_wall({.offset = -radius, .material = {.friction = friction}}));
    require(world.add({.shape = Capsule<double>{2, radius},
                       .position = {{std::cos(start), std::sin(start)}},
                       .velocity = {{-4 - spin * std::sin(start), spin * std::cos(start)}},
                       .orientation = {{start - pi / 2}},
                       .spin = {{spin}},
                       .mass = 1,
                       .material = {.friction = friction}}));
    const double inertia = world.inertia(0)[0][0];
    const auto lever = [&](double q) { return (-std::cos(q) + friction * (std::sin(q) + radius)) / inertia; };
    const auto share = [&](double q) { return 1 - std::cos(q) * lever(q); };
    const auto force = [&](double q, double w) { return (g - std::sin(q) * w * w) / share(q); };
    ExactMotion motion(world, {.tolerance = 1e-12});
    double q = start, w = spin, before = energy(world);
    int compared = 0;
    for (int k = 1; k <= 100; ++k) {
      const Status status = motion.advance_to(0.004 * k);
      EXPECT_LT(energy(world), before + 1e-9) << spin;
      before = energy(world);
      const double slip = world.velocity[0][0] + w * (std::sin(q) + radius);
      std::tie(q, w) =
          std::tuple_cat(integrated(q, w, 0.004, [&](double p, double v) { return lever(p) * force(p, v); }));
      if (!(share(q) > 0.05 && force(q, w) > 0.1 && slip < -0.5)) {
        EXPECT_TRUE(status || status.message.find("Painleve") != std::string::npos) << status.message;
        break;
      }
      ASSERT_TRUE(status) << describe(status);
      EXPECT_NEAR(world.orientation[0][0] + pi / 2, q, 1e-9) << spin << ' ' << k;
      EXPECT_NEAR(world.spin[0][0], w, 1e-8);
      ++compared;
    }
    EXPECT_GT(compared, 3) << spin;
    const Status status = motion.advance_to(world.time + 0.3);
    EXPECT_TRUE(status || status.message.find("Painleve") != std::string::npos) << status.message;
    EXPECT_LT(energy(world), before + 1e-9) << spin;
  }
}
TEST(ExactRigid, AStackStands) {
  World2 flat;
  flat.gravity = {{0, -10}};
  require(flat.add_wall({}));
  for (int i = 0; i < 5; ++i)
    require(flat.add({.shape = Box<double, 2>{{{1 - 0.1 * i, 1}}}, .position = {{0.02 * i, 0.5 + i}}, .mass = 1}));
  ExactMotion motion(flat, {.contact_events = 50});
  advance(motion, 2);
  EXPECT_NEAR(flat.position[4][1], 4.5, 1e-12);
  EXPECT_NEAR(length(flat.velocity[4]), 0, 1e-12);
  World3 world;
  world.gravity = {{0, 0, -10}};
  require(world.add_wall({.material = smooth}));
  for (int i = 0; i < 3; ++i)
    require(world.add({.shape = Box<double, 3>{}, .position = {{0.03 * i, -0.02 * i, 0.5 + i}}, .material = smooth}));
  ExactMotion in_space(world);
  advance(in_space, 1);
  EXPECT_NEAR(world.position[2][2], 2.5, 1e-12);
}
// Groups that have become one leave the places of the others free, which the next call must not take for its own.
TEST(ExactRigid, GoesOnInFurtherCallsAfterBodiesHaveComeTogether) {
  World2 world;
  world.gravity = {{0, -10}};
  require(world.add_wall({.material = smooth}));
  for (int i = 0; i < 3; ++i)
    require(world.add({.shape = Box<double, 2>{{{4, 1}}},
                       .position = {{0, 0.5 + 1.2 * i}},
                       .velocity = {{0.2 * i, 0}},
                       .material = smooth}));
  ExactMotion motion(world);
  for (int k = 1; k <= 12; ++k) {
    advance(motion, 0.25 * k);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(world.position[i][0], 0.2 * static_cast<double>(i) * world.time, 1e-9) << k;
    EXPECT_LT(overlap_of_boxes(world), 1e-9) << k;
  }
  EXPECT_NEAR(world.position[2][1], 2.5, 1e-9);
}

// Options and errors.

TEST(ExactRigid, ASnapshotContinuesToTheBit) {
  const auto begin = [] {
    World3 world;
    world.gravity = {{0, 0, -10}};
    require(world.add_wall({.material = elastic}));
    for (int i = 0; i < 3; ++i)
      require(world.add({.shape = Box<double, 3>{{{1, 0.7, 0.5}}},
                         .position = {{0.2 * i, 0, 1 + 1.5 * i}},
                         .spin = {{1.0 * i, 0.5, 0.2}},
                         .material = elastic}));
    return world;
  };
  World3 world = begin(), other = begin();
  ExactMotion motion(world), from_snapshot(other);
  advance(motion, 0.8);
  const Bytes bytes = snapshot(world, motion);
  require(restore(bytes, other, from_snapshot));
  advance(motion, 1.6);
  advance(from_snapshot, 1.6);
  EXPECT_EQ(state_hash(world), state_hash(other));
}
TEST(ExactRigid, RefusesWhatItDoesNotKnow) {
  const auto refuses = [](auto&& change, const char* what) {
    World3 world;
    const auto box = require(world.add({.shape = Box<double, 3>{}}));
    ExactOptions<double> options;
    change(world, box, options);
    ExactMotion motion(world, options);
    const Status status = motion.advance_to(1);
    EXPECT_FALSE(status);
    EXPECT_THAT(status.message, testing::HasSubstr(what));
  };
  using Options = ExactOptions<double>;
  const auto with_joint = [](JointDefinition<double, 3> joint) {
    return [joint](World3& world, BodyHandle box, Options&) mutable {
      joint.b = box;
      require(world.add_joint(joint));
    };
  };
  refuses(with_joint({.limits = JointLimits<double>{.lower = -1}}), "hinges in space with one limit only");
  refuses(with_joint({.kind = JointKind::distance,
                      .anchor_b = V3{{1, 0, 0}},
                      .limits = JointLimits<double>{.lower = 0, .upper = 0}}),
          "distances with an upper limit of 0");
  refuses(with_joint({.kind = JointKind::slider, .limits = JointLimits<double>{.lower = 1}}),
          "beyond its lower limit by 1.0");
  refuses([](World3& world, BodyHandle box, Options&) { require(world.set_traits(box, {.is_sensor = true})); },
          "sensors");
  refuses([](World3& world, BodyHandle, Options&) { world.material[0].rolling_resistance = 0.1; },
          "rolling resistance");
  refuses([](World3&, BodyHandle, Options& options) { options.step = 0.1; }, "steps of a fixed size");
  refuses([](World3& world, BodyHandle,
             Options&) { require(world.add({.shape = Box<double, 3>{}, .position = {{0.9, 0, 0}}})); },
          "overlap by 0.1");
}

}  // namespace
}  // namespace continuo::exact_rigid_test
