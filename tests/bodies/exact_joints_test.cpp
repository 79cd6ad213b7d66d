// Limits, springs and strengths of joints in the exact motion, gears, pulls and held directions, against closed forms
// and reduced equations.
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "exact_steps.hpp"
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::exact_joints_test {
namespace {

constexpr double pi = std::numbers::pi;

using test::advance;
/// A vector along axis i, in the plane and in space.
template <int Dim>
Vector<double, Dim> along(std::size_t i, double size) {
  Vector<double, Dim> made;
  made[i] = size;
  return made;
}
/// The angle of a body that turns about z.
double angle_of(const Vector<double, 1>& orientation) {
  return orientation[0];
}
double angle_of(const Vector<double, 4>& orientation) {
  return 2 * std::atan2(orientation[3], orientation[0]);
}
/// A box on an axis, by which it is joined to the world, with a joint that may be changed.
template <int Dim>
struct Jointed {
  World<double, Dim> world;
  BodyHandle body;
  JointHandle joint;
  double inertia = 0;  // about its centre, around z

  template <class Change>
  explicit Jointed(JointKind kind, Change&& change, double mass = 2) {
    Box<double, Dim> box;
    body = require(world.add({.shape = box, .mass = mass}));
    inertia = mass / 6;
    JointDefinition<double, Dim> of{
        .kind = kind, .b = body, .axis = along<Dim>(kind == JointKind::hinge ? Dim - 1 : 0, 1)};
    if constexpr (Dim == 3) of.axle = along<Dim>(2, 1);
    change(of);
    joint = require(world.add_joint(of));
  }
  /// A torque about z as a function of the time.
  void turn_by(std::function<double(double)> torque) {
    world.torque_laws.push_back([torque](const World<double, Dim>&, double t, const BodyStates<double, Dim>&,
                                         std::span<Spin<double, Dim>> all) { all[0][all[0].size() - 1] += torque(t); });
  }
  /// A force along x as a function of the time.
  void push_by(std::function<double(double)> force) {
    world.force_laws.push_back([force](const World<double, Dim>&, double t, std::span<const Vector<double, Dim>>,
                                       std::span<const Vector<double, Dim>>,
                                       std::span<Vector<double, Dim>> all) { all[0][0] += force(t); });
  }
  [[nodiscard]] double angle() const { return angle_of(world.orientation[0]); }
  [[nodiscard]] double spin() const { return world.spin[0][world.spin[0].size() - 1]; }
  [[nodiscard]] double x() const { return world.position[0][0]; }
  [[nodiscard]] double v() const { return world.velocity[0][0]; }
  [[nodiscard]] const Joint<double, Dim>& bears() const { return *world.find(joint); }
};

// Limits.

// A body is turned against its stop, is pressed against it by a torque that falls to 0 at t = 2, and leaves it then
// with an angle of (t - 2)^3 / (6 I).
template <int Dim>
void expect_stop_is_left() {
  Jointed<Dim> of(JointKind::hinge, [](auto& joint) { joint.limits = JointLimits<double>{.lower = -0.5, .upper = 1}; });
  of.turn_by([](double t) { return t - 2; });
  ExactMotion motion(of.world);
  // The angle falls as (t^3/6 - t^2) / I.
  const auto free = [&](double t) { return (t * t * t / 6 - t * t) / of.inertia; };
  advance(motion, 0.3);
  EXPECT_NEAR(of.angle(), free(0.3), 1e-10);
  advance(motion, 1);
  EXPECT_NEAR(of.angle(), -0.5, 1e-14);
  EXPECT_NEAR(of.spin(), 0, 1e-14);
  EXPECT_NEAR(of.bears().torque[of.bears().torque.size() - 1], 1, 1e-12);
  advance(motion, 2.8);
  EXPECT_NEAR(of.angle(), -0.5 + std::pow(0.8, 3) / (6 * of.inertia), 1e-9);
  EXPECT_NEAR(of.spin(), 0.64 / (2 * of.inertia), 1e-9);
  EXPECT_NEAR(of.bears().torque[of.bears().torque.size() - 1], 0, 1e-12);
}
TEST(ExactJoints, AStopPressesUntilItsForceFallsToZero) {
  expect_stop_is_left<2>();
  expect_stop_is_left<3>();
}
// The motor of a door gives 2 until the door has its speed of 1, then less, and 2 again at the stop, until the wind,
// -t, is stronger.
template <int Dim>
void expect_door_at_stop() {
  Jointed<Dim> of(JointKind::hinge, [](auto& joint) {
    joint.limits = JointLimits<double>{.lower = -3, .upper = 0.9};
    joint.motor = JointMotor<double>{.speed = 1, .most = 2};
  });
  of.turn_by([](double t) { return -t; });
  ExactMotion motion(of.world);
  const double i = of.inertia, reached = 2 - std::sqrt(4 - 2 * i);  // I = 2 t - t^2/2
  const double there = (reached * reached - reached * reached * reached / 6) / i;
  const double stops = reached + 0.9 - there;
  advance(motion, stops - 1e-3);
  EXPECT_NEAR(of.angle(), 0.9 - 1e-3, 1e-9);
  EXPECT_NEAR(of.bears().motor_effort, stops - 1e-3, 1e-9);
  advance(motion, stops + 1e-3);
  EXPECT_NEAR(of.angle(), 0.9, 1e-14);
  EXPECT_NEAR(of.bears().motor_effort, 2, 1e-12);
  EXPECT_NEAR(of.bears().torque[of.bears().torque.size() - 1], stops + 1e-3, 1e-12);
  advance(motion, 2.5);
  EXPECT_NEAR(of.angle(), 0.9 - 0.125 / (6 * i), 1e-9);
}
TEST(ExactJoints, AMotorHoldsADoorAtItsStop) {
  expect_door_at_stop<2>();
  expect_door_at_stop<3>();
}
// From stop to stop by a force of 4 cos(2 t) on a mass of 2: it strikes the upper one, leaves it as the force falls to
// 0, and so on.
template <int Dim>
void expect_way_between_stops(JointKind kind) {
  Jointed<Dim> of(kind, [](auto& joint) { joint.limits = JointLimits<double>{.lower = -0.4, .upper = 0.3}; });
  of.push_by([](double t) { return 4 * std::cos(2 * t); });
  ExactMotion motion(of.world);
  // From rest at t0: v = sin(2 t) - sin(2 t0).
  const auto way = [](double from, double t) {
    return (std::cos(2 * from) - std::cos(2 * t)) / 2 - std::sin(2 * from) * (t - from);
  };
  const double first = std::acos(0.4) / 2;  // 0.3 = (1 - cos(2 t)) / 2
  advance(motion, first - 1e-4);
  EXPECT_NEAR(of.x(), way(0, first - 1e-4), 1e-10);
  advance(motion, first + 1e-4);
  EXPECT_NEAR(of.x(), 0.3, 1e-14);
  EXPECT_NEAR(of.bears().force[0], -4 * std::cos(2 * (first + 1e-4)), 1e-11);
  advance(motion, pi / 4 + 0.4);
  EXPECT_NEAR(of.x(), 0.3 + way(pi / 4, pi / 4 + 0.4), 1e-10);
  advance(motion, 3 * pi / 4);  // the way to the lower stop is shorter than it would be without it
  EXPECT_LT(way(pi / 4, 3 * pi / 4), -0.7);
  EXPECT_NEAR(of.x(), -0.4, 1e-14);
  advance(motion, 3 * pi / 4 + 0.3);
  EXPECT_NEAR(of.x(), -0.4 + way(3 * pi / 4, 3 * pi / 4 + 0.3), 1e-10);
}
TEST(ExactJoints, ASliderMovesBetweenItsStops) {
  expect_way_between_stops<2>(JointKind::slider);
  expect_way_between_stops<3>(JointKind::slider);
  expect_way_between_stops<2>(JointKind::wheel);
  expect_way_between_stops<3>(JointKind::wheel);
}

/// A point on a rope of length 1, by classical Runge-Kutta steps: free, or at the angle phi from below.
struct RopeReferee {
  static constexpr double g = 9.81;
  /// x, y, vx, vy of a ball that is thrown, at the time until which the rope is slack.
  static double taut_at(double x, double y, double vx, double vy) {
    const auto room = [&](double t) { return 1 - std::hypot(x + vx * t, y + vy * t - g / 2 * t * t); };
    double near = 1e-3, far = near;
    while (room(far) > 0) far += 1e-3;
    near = far - 1e-3;
    for (int k = 0; k < 60; ++k) (room((near + far) / 2) > 0 ? near : far) = (near + far) / 2;
    return far;
  }
  /// Swings until the rope is slack: w^2 + g cos(phi) = 0. The duration.
  static double swing(double& phi, double& w) {
    constexpr double h = 1e-4;
    const auto step = [](double& p, double& q, double size) {
      const auto pull = [](double angle) { return -g * std::sin(angle); };
      const double k1 = q, l1 = pull(p), k2 = q + size / 2 * l1, l2 = pull(p + size / 2 * k1);
      const double k3 = q + size / 2 * l2, l3 = pull(p + size / 2 * k2), k4 = q + size * l3, l4 = pull(p + size * k3);
      p += size / 6 * (k1 + 2 * k2 + 2 * k3 + k4), q += size / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
    };
    const auto tension = [](double p, double q) { return q * q + g * std::cos(p); };
    double t = 0;
    for (;;) {
      double p = phi, q = w;
      step(p, q, h);
      if (tension(p, q) < 0) break;
      phi = p, w = q, t += h;
    }
    double near = 0, far = h;
    for (int k = 0; k < 50; ++k) {
      double p = phi, q = w;
      step(p, q, (near + far) / 2);
      (tension(p, q) > 0 ? near : far) = (near + far) / 2;
    }
    step(phi, w, far);
    return t + far;
  }
};
// A ball is thrown up, swings where its rope is taut, and flies on where the rope is slack.
template <int Dim>
void expect_ball_on_rope() {
  World<double, Dim> world;
  const std::size_t up = Dim - 1;
  world.gravity = along<Dim>(up, -RopeReferee::g);
  const auto ball = require(world.add({.shape = Box<double, Dim>{}, .mass = 3}));
  world.position[0] = along<Dim>(0, 0.5) + along<Dim>(up, -0.6);
  world.velocity[0] = along<Dim>(0, 6) + along<Dim>(up, 2);
  const auto rope = require(world.add_joint({.kind = JointKind::distance,
                                             .b = ball,
                                             .anchor_b = world.position[0],
                                             .limits = JointLimits<double>{.upper = 1}}));
  ExactMotion motion(world);
  const double taut = RopeReferee::taut_at(0.5, -0.6, 6, 2);
  const double x = 0.5 + 6 * taut, y = -0.6 + 2 * taut - RopeReferee::g / 2 * taut * taut,
               vy = 2 - RopeReferee::g * taut;
  double phi = std::atan2(x, -y), w = 6 * -y + vy * x;  // across the rope
  // Just after it is taut there may be no tension: then it flies on along the tangent.
  ASSERT_GT(w * w + RopeReferee::g * std::cos(phi), 0);
  const double slack = taut + RopeReferee::swing(phi, w);
  advance(motion, taut - 1e-4);
  EXPECT_NEAR(world.position[0][0], 0.5 + 6 * (taut - 1e-4), 1e-11);
  EXPECT_EQ(length(world.find(rope)->force), 0);
  advance(motion, taut + 0.1);
  EXPECT_NEAR(length(world.position[0]), 1, 1e-14);
  EXPECT_GT(length(world.find(rope)->force), 0.1);
  const double later = 0.2;
  advance(motion, slack + later);
  EXPECT_NEAR(world.position[0][0], std::sin(phi) + w * std::cos(phi) * later, 1e-9);
  EXPECT_NEAR(world.position[0][up], -std::cos(phi) + w * std::sin(phi) * later - RopeReferee::g / 2 * later * later,
              1e-9);
  EXPECT_EQ(length(world.find(rope)->force), 0);
}
TEST(ExactJoints, ARopeIsTautAndSlack) {
  expect_ball_on_rope<2>();
  expect_ball_on_rope<3>();
}
// The ends of a rope meet while it is slack.
TEST(ExactJoints, ABallPassesTheEndOfItsRope) {
  World<double, 2> world;
  const auto ball = require(world.add({.shape = Box<double, 2>{}, .position = {{0.5, 0}}, .velocity = {{-1, 0}}}));
  require(world.add_joint({.kind = JointKind::distance,
                           .b = ball,
                           .anchor_b = Vector<double, 2>{{0.5, 0}},
                           .limits = JointLimits<double>{.lower = 0, .upper = 1}}));
  ExactMotion motion(world);
  advance(motion, 1.4999);
  EXPECT_NEAR(world.position[0][0], -0.9999, 1e-13);
  advance(motion, 3);
  EXPECT_NEAR(world.position[0][0], -1, 1e-13);
}
// A rod that keeps its ends at least 0.5 and at most 1 apart between two free bodies: their impact keeps the momentum,
// and the bodies move on together.
template <int Dim>
void expect_bodies_on_rope_keep_momentum() {
  World<double, Dim> world;
  const auto a = require(world.add({.shape = Box<double, Dim>{}, .position = along<Dim>(0, 0), .mass = 1}));
  const auto b = require(
      world.add({.shape = Box<double, Dim>{}, .position = along<Dim>(0, 3), .velocity = along<Dim>(0, 2), .mass = 3}));
  require(world.add_joint({.kind = JointKind::distance,
                           .a = a,
                           .b = b,
                           .anchor_b = along<Dim>(0, 3),
                           .limits = JointLimits<double>{.lower = 1.5, .upper = 4}}));
  ExactMotion motion(world);
  advance(motion, 0.49);
  EXPECT_EQ(world.velocity[0][0], 0);
  advance(motion, 2.5);
  EXPECT_NEAR(world.velocity[0][0], 1.5, 1e-14);
  EXPECT_NEAR(world.velocity[1][0], 1.5, 1e-14);
  EXPECT_NEAR(world.position[0][0], 3, 1e-13);
}
TEST(ExactJoints, ARopeBetweenTwoBodiesKeepsTheMomentum) {
  expect_bodies_on_rope_keep_momentum<2>();
  expect_bodies_on_rope_keep_momentum<3>();
}
// Two rods on a hinge whose limits are one fall as one rod that is bent.
template <int Dim>
void expect_one_limit_is_a_weld() {
  std::array<World<double, Dim>, 2> worlds;
  for (const bool is_weld : {false, true}) {
    World<double, Dim>& world = worlds[is_weld ? 1 : 0];
    world.gravity = along<Dim>(1, -10);
    Box<double, Dim> rod;
    rod.size = along<Dim>(0, 0.8) + along<Dim>(1, 0.2);
    if (Dim == 3) rod.size[2] = 0.3;
    const auto upper = require(world.add({.shape = rod, .position = along<Dim>(0, 0.5)}));
    const auto lower = require(world.add({.shape = rod, .position = along<Dim>(0, 1.5)}));
    const Vector<double, Dim> axis = along<Dim>(Dim - 1, 1);
    require(world.add_joint({.b = upper, .axis = axis}));
    JointDefinition<double, Dim> between{.a = upper, .b = lower, .anchor = along<Dim>(0, 1), .axis = axis};
    if (is_weld) {
      between.kind = JointKind::weld;
    } else {
      between.limits = JointLimits<double>{.lower = 0, .upper = 0};
    }
    require(world.add_joint(between));
    ExactMotion motion(world);
    advance(motion, 2);
  }
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(length(worlds[0].position[i] - worlds[1].position[i]), 1e-8);
}
TEST(ExactJoints, OneLimitOnBothSidesHolds) {
  expect_one_limit_is_a_weld<2>();
  expect_one_limit_is_a_weld<3>();
}
TEST(ExactJoints, AMotorWithoutAGreatestForceCannotDriveAgainstALimit) {
  Jointed<2> of(JointKind::hinge, [](auto& joint) {
    joint.limits = JointLimits<double>{.lower = -1, .upper = 0.5};
    joint.motor = JointMotor<double>{.speed = 1, .most = std::numeric_limits<double>::infinity()};
  });
  ExactMotion motion(of.world);
  advance(motion, 0.49);
  EXPECT_NEAR(of.angle(), 0.49, 1e-12);
  const Status status = motion.advance_to(1);
  EXPECT_FALSE(status);
  EXPECT_THAT(status.message, testing::HasSubstr("motor without a greatest force"));
  EXPECT_NEAR(of.world.time, 0.5, 1e-12);
}

// Springs.

/// From x0 at rest, of frequency w and damping d, after t.
double damped(double x0, double v0, double w, double d, double t) {
  const double slow = w * std::sqrt(1 - d * d);
  return std::exp(-d * w * t) * (x0 * std::cos(slow * t) + (v0 + d * w * x0) / slow * std::sin(slow * t));
}
template <int Dim>
void expect_damped_oscillation() {
  constexpr double hertz = 0.7, w = 2 * pi * hertz, d = 0.15;
  for (const JointKind kind : {JointKind::slider, JointKind::wheel}) {
    Jointed<Dim> of(kind, [](auto& joint) { joint.spring = {.hertz = hertz, .damping = d, .rest = 0.3}; });
    of.world.velocity[0] = along<Dim>(0, 1.1);
    ExactMotion motion(of.world);
    advance(motion, 2.2);
    EXPECT_NEAR(of.x() - 0.3, damped(-0.3, 1.1, w, d, 2.2), 1e-9);
    const double force = -2 * w * (w * (of.x() - 0.3) + 2 * d * of.v());
    EXPECT_NEAR(of.bears().force[0], force, 1e-10);
  }
  Jointed<Dim> turning(JointKind::hinge,
                       [](auto& joint) { joint.spring = {.hertz = hertz, .damping = d, .rest = 0.3}; });
  ExactMotion motion(turning.world);
  advance(motion, 2.2);
  EXPECT_NEAR(turning.angle() - 0.3, damped(-0.3, 0, w, d, 2.2), 1e-9);
}
TEST(ExactJoints, ASpringOscillatesAsItsFrequencyAndDampingSay) {
  expect_damped_oscillation<2>();
  expect_damped_oscillation<3>();
}
// The mass of a spring is that of the two bodies without what else holds them: a rod that turns about its end is slower
// by the root of its inertia about the centre over that about the end, 1/4 of a slender one.
TEST(ExactJoints, ASpringOfAHeldBodyIsSlower) {
  World<double, 2> world;
  const auto rod = require(world.add({.shape = Box<double, 2>{{{1, 0.1}}}, .position = {{0.5, 0}}, .mass = 1}));
  require(world.add_joint({.b = rod, .spring = JointSpring<double>{.hertz = 2, .damping = 0, .rest = 0.1}}));
  ExactMotion motion(world);
  advance(motion, 1.3);
  const double about_centre = (1 + 0.01) / 12, w = 4 * pi * std::sqrt(about_centre / (about_centre + 0.25));
  EXPECT_NEAR(world.orientation[0][0], 0.1 - 0.1 * std::cos(w * 1.3), 1e-9);
}
// Two bodies of masses 1 and 3 on a spring of 2.5 in length that is drawn to 3.
template <int Dim>
void expect_two_bodies_oscillate() {
  World<double, Dim> world;
  const auto a = require(world.add({.shape = Box<double, Dim>{}, .mass = 1}));
  const auto b = require(world.add({.shape = Box<double, Dim>{}, .position = along<Dim>(0, 2.5), .mass = 3}));
  require(world.add_joint({.kind = JointKind::distance,
                           .a = a,
                           .b = b,
                           .anchor_b = along<Dim>(0, 2.5),
                           .spring = JointSpring<double>{.hertz = 1.5, .damping = 0.1, .rest = 0.5}}));
  ExactMotion motion(world);
  advance(motion, 1.7);
  const double stretch = damped(-0.5, 0, 3 * pi, 0.1, 1.7);
  EXPECT_NEAR(world.position[1][0] - world.position[0][0], 3 + stretch, 1e-9);
  EXPECT_NEAR(world.position[0][0] + 3 * world.position[1][0], 7.5, 1e-11);
}
TEST(ExactJoints, ASpringDrawsTwoBodiesByTheirReducedMass) {
  expect_two_bodies_oscillate<2>();
  expect_two_bodies_oscillate<3>();
}
// A car of mass 8 on one wheel of mass 2 that stands on the floor: the spring carries it as one of stiffness m w^2,
// with m = 1 / (1/8 + 1/2), so that it is lower by 8 g / (m w^2) and oscillates at w sqrt(m / 8).
template <int Dim>
void expect_suspension() {
  constexpr Material<double> smooth{.restitution = 0, .friction = 0};
  constexpr std::size_t up = Dim - 1;
  World<double, Dim> world;
  world.gravity = along<Dim>(up, -10);
  require(world.add_wall({.normal = along<Dim>(up, 1), .material = smooth}));
  const auto rim = require(
      world.add({.shape = Sphere<double>{0.5}, .position = along<Dim>(up, 0.5), .mass = 2, .material = smooth}));
  const auto car =
      require(world.add({.shape = Box<double, Dim>{}, .position = along<Dim>(up, 2), .mass = 8, .material = smooth}));
  // The car cannot tip.
  require(
      world.add_joint({.kind = JointKind::slider, .b = car, .anchor = along<Dim>(up, 2), .axis = along<Dim>(up, 1)}));
  JointDefinition<double, Dim> wheel{
      .kind = JointKind::wheel, .a = car, .b = rim, .anchor = along<Dim>(up, 0.5), .axis = along<Dim>(up, 1)};
  if constexpr (Dim == 3) wheel.axle = along<Dim>(0, 1);
  wheel.spring = JointSpring<double>{.hertz = 2, .damping = 0.05};
  require(world.add_joint(wheel));
  ExactMotion motion(world);
  const double m = 1 / (1 / 8.0 + 1 / 2.0), w = 4 * pi, slower = w * std::sqrt(m / 8), sag = 10 / (slower * slower);
  const double damping = 2 * 0.05 * w * m / (2 * 8 * slower);
  for (const double t : {0.3, 0.7, 1.9}) {
    advance(motion, t);
    EXPECT_NEAR(world.position[1][up], 2 - sag + damped(sag, 0, slower, damping, t), 1e-8);
    EXPECT_NEAR(world.position[0][up], 0.5, 1e-12);
  }
}
TEST(ExactJoints, AWheelCarriesACarBySprings) {
  expect_suspension<2>();
  expect_suspension<3>();
}
// A spring without damping drives its mass against a stop, where it rests for no time and begins again. After 2 s it
// would graze the stop.
template <int Dim>
void expect_spring_with_stop() {
  Jointed<Dim> of(JointKind::slider, [](auto& joint) {
    joint.spring = {.hertz = 0.5, .damping = 0};
    joint.limits = JointLimits<double>{.upper = 0.2};
  });
  of.world.velocity[0] = along<Dim>(0, 1);
  ExactMotion motion(of.world);
  const double strikes = std::asin(0.2 * pi) / pi;  // sin(pi t) / pi = 0.2
  advance(motion, strikes - 1e-5);
  EXPECT_NEAR(of.x(), std::sin(pi * (strikes - 1e-5)) / pi, 1e-11);
  for (const double t : {0.1, 0.9, 1.4, 1.9}) {
    advance(motion, strikes + t);
    EXPECT_NEAR(of.x(), 0.2 * std::cos(pi * t), 1e-9);
  }
}
TEST(ExactJoints, ASpringLeavesItsStop) {
  expect_spring_with_stop<2>();
  expect_spring_with_stop<3>();
}

// Strength.

// A weld that bears the weight and a force that grows, 20 + 5 t, breaks at 27.5, after which the mass of 2 falls freely
// but for that force. All that time its force is the load.
template <int Dim>
void expect_weld_breaks() {
  Jointed<Dim> of(JointKind::weld, [](auto& joint) { joint.breaks_at = 27.5; });
  of.push_by([](double t) { return 20 + 5 * t; });
  ExactMotion motion(of.world);
  advance(motion, 1.4);
  EXPECT_FALSE(of.bears().is_broken);
  EXPECT_NEAR(of.bears().force[0], -27, 1e-11);
  EXPECT_NEAR(of.x(), 0, 1e-15);
  advance(motion, 2.5);
  EXPECT_TRUE(of.bears().is_broken);
  EXPECT_NEAR(of.bears().force[0], -27.5, 1e-9);
  EXPECT_NEAR(of.x(), (27.5 / 2 + 5.0 / 6) / 2, 1e-10);
}
TEST(ExactJoints, AWeldBreaksAtItsStrength) {
  expect_weld_breaks<2>();
  expect_weld_breaks<3>();
}
template <int Dim>
void expect_hinge_breaks_by_torque() {
  Jointed<Dim> of(JointKind::weld, [](auto& joint) { joint.breaks_at_torque = 3; });
  of.turn_by([](double t) { return 2 * t; });
  ExactMotion motion(of.world);
  advance(motion, 2);
  EXPECT_TRUE(of.bears().is_broken);
  EXPECT_NEAR(of.angle(), (8.0 / 3 - 1.5 * 1.5 * 1.5 / 3 - 1.5 * 1.5 * 0.5) / of.inertia, 1e-9);
}
TEST(ExactJoints, AWeldBreaksByTorque) {
  expect_hinge_breaks_by_torque<2>();
  expect_hinge_breaks_by_torque<3>();
}
// The pull of a pendulum that is let go level is 3 m g sin(phi), with phi from level: half of the greatest at 30
// degrees.
TEST(ExactJoints, APendulumBreaksOffWhereItsPullIsTooGreat) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  const auto ball = require(world.add({.shape = Box<double, 2>{}, .position = {{1, 0}}, .mass = 2}));
  const auto rod = require(world.add_joint(
      {.kind = JointKind::distance, .b = ball, .anchor_b = Vector<double, 2>{{1, 0}}, .breaks_at = 30}));
  ExactMotion motion(world);
  double t = 0;
  while (!world.find(rod)->is_broken && t < 1) advance(motion, t += 1.0 / 64);
  const double speed = std::sqrt(10.0);  // 2 g sin(phi)
  EXPECT_NEAR(world.velocity[0][0], -speed * 0.5, 1e-9);
  const double since = (-world.velocity[0][1] - speed * std::sqrt(0.75)) / 10;
  EXPECT_GE(since, 0);
  EXPECT_LT(since, 1.0 / 64);
  EXPECT_NEAR(world.position[0][0], std::sqrt(0.75) - speed * 0.5 * since, 1e-9);
}
// What presses harder than the joint can bear breaks it at the instant of an impact, but the impact alone does not.
TEST(ExactJoints, AnImpactDoesNotBreakAJoint) {
  for (const double strength : {15.0, 25.0}) {
    World<double, 2> world;
    world.gravity = {{0, -10}};
    const Material<double> smooth{.restitution = 0, .friction = 0};
    const auto shelf = require(world.add({.shape = Box<double, 2>{}, .mass = 1, .material = smooth}));
    require(world.add({.shape = Box<double, 2>{}, .position = {{0, 2}}, .mass = 1, .material = smooth}));
    const auto weld = require(world.add_joint({.kind = JointKind::weld, .b = shelf, .breaks_at = strength}));
    ExactMotion motion(world);
    advance(motion, 1);
    EXPECT_EQ(world.find(weld)->is_broken, strength < 20);
    // It broke as the other box came to rest on it, and falls from rest.
    if (strength < 20) {
      EXPECT_NEAR(world.velocity[0][1], -10 * (1 - std::sqrt(0.2)), 1e-9);
    }
  }
}
// A hook lets go of a body, which then falls on it.
TEST(ExactJoints, BodiesCollideOnceTheirJointIsBroken) {
  World<double, 2> world;
  const Material<double> elastic{.restitution = 1, .friction = 0};
  const auto plate = require(world.add({.shape = Box<double, 2>{}, .fixed = true, .material = elastic}));
  const auto ball =
      require(world.add({.shape = Box<double, 2>{}, .position = {{0, 2}}, .mass = 1, .material = elastic}));
  require(world.add_joint({.kind = JointKind::weld, .a = plate, .b = ball, .anchor = {{0, 2}}, .breaks_at = 1}));
  world.gravity = {{0, -2}};
  ExactMotion motion(world);
  advance(motion, 1.5);  // falls by 1 in a second, and rises again
  EXPECT_NEAR(world.position[1][1], 1 + 2 * 0.5 - 0.25, 1e-10);
}

// Gears, pulls, held directions.

// The wheels of a bevel gear: a torque of 2 about x turns a, and b about z by -ratio as much.
TEST(ExactJoints, GearsTurnBodiesInSpace) {
  World<double, 3> world;
  const auto a = require(world.add({.shape = Box<double, 3>{}, .mass = 6}));
  const auto b = require(world.add({.shape = Box<double, 3>{}, .position = {{5, 0, 0}}, .mass = 12}));
  require(world.add_joint({.b = a, .axis = {{1, 0, 0}}}));
  require(world.add_joint({.b = b, .anchor = {{5, 0, 0}}, .axis = {{0, 0, 1}}}));
  require(world.add_joint(
      {.kind = JointKind::gear, .a = a, .b = b, .axis = {{1, 0, 0}}, .axle = {{0, 0, 1}}, .ratio = 1.5}));
  world.torque_laws.push_back([](const World<double, 3>&, double, const BodyStates<double, 3>&,
                                 std::span<Vector<double, 3>> torque) { torque[0][0] += 2; });
  ExactMotion motion(world);
  advance(motion, 3);
  const double turns = 2 / (1 + 1.5 * 1.5 * 2);  // inertias of 1 and 2
  EXPECT_NEAR(world.spin[0][0], turns * 3, 1e-11);
  EXPECT_NEAR(world.spin[1][2], -1.5 * turns * 3, 1e-11);
  EXPECT_NEAR(2 * std::atan2(world.orientation[1][3], world.orientation[1][0]), -1.5 * turns * 4.5, 1e-9);
}
template <int Dim>
void expect_pull() {
  Jointed<Dim> of(JointKind::pull, [](auto& joint) { joint.spring = {.hertz = 0.5, .damping = 0.2}; });
  of.world.find(of.joint)->target = along<Dim>(0, 1);
  ExactMotion motion(of.world);
  advance(motion, 1.3);
  EXPECT_NEAR(of.x() - 1, damped(-1, 0, pi, 0.2, 1.3), 1e-9);
  // With a greatest force, first that: 2 m at 3 / 2 per square of time.
  Jointed<Dim> weak(JointKind::pull,
                    [](auto& joint) { joint.spring = {.hertz = 3, .damping = 0}, joint.breaks_at = 3; });
  weak.world.find(weak.joint)->target = along<Dim>(0, 1);
  ExactMotion weakly(weak.world);
  advance(weakly, 0.9);
  EXPECT_NEAR(weak.x(), 0.75 * 0.81, 1e-10);
}
TEST(ExactJoints, APullDrawsABodyToItsTarget) {
  expect_pull<2>();
  expect_pull<3>();
}
template <int Dim>
void expect_held_directions() {
  World<double, Dim> world;
  world.gravity = along<Dim>(0, 3) + along<Dim>(1, -10);
  const auto box = require(world.add({.shape = Box<double, Dim>{}, .velocity = along<Dim>(1, 1)}));
  require(world.set_traits(box, {.locked = Locked::x}));
  ExactMotion motion(world);
  advance(motion, 1);
  EXPECT_NEAR(world.position[0][0], 0, 1e-15);
  EXPECT_NEAR(world.position[0][1], 1 - 5, 1e-12);
}
TEST(ExactJoints, HeldDirectionsStay) {
  expect_held_directions<2>();
  expect_held_directions<3>();
  // A box that may not turn lands flat on its corner, and stays there.
  World<double, 2> world;
  world.gravity = {{0, -10}};
  const Material<double> smooth{.restitution = 0, .friction = 0};
  require(world.add_wall({.material = smooth}));
  const auto box = require(world.add({.shape = Box<double, 2>{},
                                      .position = {{0, 2}},
                                      .velocity = {{1, 0}},
                                      .orientation = {{0.3}},
                                      .material = smooth}));
  require(world.set_traits(box, {.locked = Locked::turn_z}));
  ExactMotion motion(world);
  advance(motion, 2);
  EXPECT_NEAR(world.orientation[0][0], 0.3, 1e-14);
  EXPECT_NEAR(world.position[0][0], 2, 1e-12);
  EXPECT_NEAR(world.position[0][1], (std::sin(0.3) + std::cos(0.3)) / 2, 1e-10);
  // One that may turn about z alone does so with its inertia about z.
  World<double, 3> space;
  const auto turned = require(space.add({.shape = Box<double, 3>{{{1, 2, 3}}}, .spin = {{0.5, 0.7, 2}}}));
  require(space.set_traits(turned, {.locked = both(Locked::turn_x, Locked::turn_y)}));
  ExactMotion turning(space);
  advance(turning, 1.2);
  EXPECT_NEAR(angle_of(space.orientation[0]), space.spin[0][2] * 1.2, 1e-9);
  EXPECT_NEAR(space.spin[0][0], 0, 1e-14);
}

// A ball that cannot turn slides over a rough floor, straight until its rope is taut, then around the end of that,
// until friction has taken its speed: limits, friction in space and held directions at once.
TEST(ExactJoints, ABallSlidesAroundOnItsRopeOverARoughFloor) {
  constexpr double friction = 0.3, g = 10, radius = 0.2, speed = 3, begin = 0.5;
  World<double, 3> world;
  world.gravity = {{0, 0, -g}};
  const Material<double> rough{.friction = friction};
  require(world.add_wall({.normal = {{0, 0, 1}}, .material = rough}));
  const auto ball = require(world.add({.shape = Compound<double, 3>{{{.shape = Sphere<double>{radius}}}},
                                       .position = {{begin, 0, radius}},
                                       .velocity = {{0, speed, 0}},
                                       .material = rough}));
  require(world.set_traits(ball, {.locked = both(both(Locked::turn_x, Locked::turn_y), Locked::turn_z)}));
  const auto rope = require(world.add_joint({.kind = JointKind::distance,
                                             .b = ball,
                                             .anchor = {{0, 0, radius}},
                                             .anchor_b = world.position[0],
                                             .limits = JointLimits<double>{.upper = 1}}));
  const double way = std::sqrt(1 - begin * begin);
  const double at_end = std::sqrt(speed * speed - 2 * friction * g * way), taut = (speed - at_end) / (friction * g);
  const double around = at_end * begin;  // what the rope leaves of it
  const double angle = std::atan2(way, begin), stop = taut + around / (friction * g);
  ExactMotion motion(world);
  advance(motion, taut - 1e-3);
  EXPECT_NEAR(world.position[0][1], way - at_end * 1e-3 - friction * g * 1e-6 / 2, 1e-11);
  EXPECT_EQ(length(world.find(rope)->force), 0);
  for (const double part : {0.2, 0.6, 0.95}) {
    const double t = part * (stop - taut), phi = angle + around * t - friction * g * t * t / 2;
    advance(motion, taut + t);
    EXPECT_NEAR(world.position[0][0], std::cos(phi), 1e-9);
    EXPECT_NEAR(world.position[0][1], std::sin(phi), 1e-9);
    EXPECT_NEAR(world.position[0][2], radius, 1e-12);
    EXPECT_NEAR(length(world.velocity[0]), around - friction * g * t, 1e-8);
  }
  advance(motion, stop + 1);
  const double phi = angle + around * around / (2 * friction * g);
  EXPECT_NEAR(world.position[0][0], std::cos(phi), 1e-8);
  EXPECT_NEAR(world.position[0][1], std::sin(phi), 1e-8);
  EXPECT_LT(length(world.velocity[0]), 1e-12);
}
// A crank in a heavy block on a rough floor drives a light one to and fro by a rod. The heavy one rests, so that the
// geometry alone moves the light one. At the dead centres neither slips, but the crank turns on, so that both cannot
// stick, although the friction of each would hold it.
TEST(ExactJoints, ACrankDrivesABlockOverARoughFloor) {
  constexpr double r = 0.3, l = 2, w = 0.4, height = 0.5, infinity = std::numeric_limits<double>::infinity();
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  const Material<double> rough{.friction = 0.5};
  require(world.add_wall({.normal = {{0, 1}}, .material = rough}));
  const auto add = [&](double x, double width, double thick, double mass, double lift, double spin) {
    return require(world.add({.shape = Box<double, 2>{{{width, thick}}},
                              .position = {{x, height}},
                              .velocity = {{0, lift}},
                              .spin = {{spin}},
                              .mass = mass,
                              .material = rough,
                              .group = 1}));
  };
  require(world.ignore(1, 1));
  const auto heavy = add(0, 2, 1, 10, 0, 0), light = add(r + l, 1, 1, 1, 0, 0), crank = add(0, 0.1, 0.1, 0.1, 0, w),
             rod = add(r + l / 2, l, 0.1, 0.1, r * w / 2, -r * w / l);
  require(world.add_joint({.a = heavy, .b = crank, .anchor = {{0, height}}, .motor = JointMotor<double>{w, infinity}}));
  require(world.add_joint({.a = crank, .b = rod, .anchor = {{r, height}}}));
  require(world.add_joint({.a = rod, .b = light, .anchor = {{r + l, height}}}));
  ExactMotion motion(world, {.most_events = 10'000});
  for (int k = 1; k <= 50; ++k) {
    const double t = 0.5 * k, y = r * std::sin(w * t);
    advance(motion, t);
    EXPECT_NEAR(world.position[world.index(light)][0], r * std::cos(w * t) + std::sqrt(l * l - y * y), 1e-9) << t;
    EXPECT_NEAR(world.position[world.index(heavy)][0], 0, 1e-9) << t;
  }
}
// What joints hold twice they hold where they agree: two motors of one speed, and a hinge in the middle of a distance
// while nothing turns it. Where they do not, that is an error and no compromise.
TEST(ExactJoints, JointsThatContradictEachOtherAreAnError) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double other : {1.0, 1.5}) {
    World<double, 2> world;
    const auto body = require(world.add({.shape = Box<double, 2>{}}));
    for (const double speed : {1.0, other})
      require(world.add_joint({.b = body, .motor = JointMotor<double>{speed, infinity}}));
    ExactMotion motion(world);
    const Status status = motion.advance_to(1);
    EXPECT_EQ(static_cast<bool>(status), other == 1) << describe(status);
    if (other == 1) {
      EXPECT_NEAR(world.orientation[0][0], 1, 1e-12);
    }
    if (other != 1) {
      EXPECT_THAT(status.message, testing::HasSubstr("hold each other twice"));
    }
  }
  for (const double spin : {0.0, 1.0}) {
    World<double, 2> world;
    const auto a = require(world.add({.position = {{-1, 0}}, .velocity = {{3, -spin}}, .spin = {{spin}}}));
    const auto b = require(world.add({.position = {{1, 0}}, .velocity = {{3, -spin}}, .spin = {{-spin}}}));
    require(world.add_joint({.a = a, .b = b}));
    require(world.add_joint(
        {.kind = JointKind::distance, .a = a, .b = b, .anchor = world.position[0], .anchor_b = world.position[1]}));
    ExactMotion motion(world);
    const Status status = motion.advance_to(1);
    EXPECT_EQ(static_cast<bool>(status), spin == 0) << describe(status);
    if (spin == 0) {
      EXPECT_NEAR(world.position[1][0], 4, 1e-12);
    }
    if (spin != 0) {
      EXPECT_THAT(status.message, testing::HasSubstr("hold each other twice"));
    }
  }
}
}  // namespace
}  // namespace continuo::exact_joints_test
