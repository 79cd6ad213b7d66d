// Joints: what they leave free, against closed forms; limits, springs, motors and strength.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::joints_test {

using namespace test;  // rigid_worlds.hpp

namespace {

template <int Dim>
JointHandle join(World<double, Dim>& world, const JointDefinition<double, Dim>& definition) {
  const auto joint = world.add_joint(definition);
  EXPECT_TRUE(joint) << describe(joint.status());
  return *joint;
}
/// The joint for a rotation in the plane of x and the vertical axis.
template <int Dim>
JointDefinition<double, Dim> hinge(BodyHandle a, BodyHandle b, const Vector<double, Dim>& anchor) {
  JointDefinition<double, Dim> of{.kind = JointKind::hinge, .a = a, .b = b, .anchor = anchor};
  if constexpr (Dim == 3) of.axis = {{0, -1, 0}};
  return of;
}
template <int Dim>
double turn_rate(const World<double, Dim>& world, BodyHandle body) {
  const auto& spin = world.spin[world.index(body)];
  if constexpr (Dim == 2) {
    return spin[0];
  } else {
    return -spin[1];
  }
}

// A box of side 1 and mass 1 on a hinge at the middle of its upper side: the inertia about the hinge is 1/6 + 1/4, of
// small amplitudes w^2 = g / 2 / (5 / 12).
template <int Dim>
double angle_of_pendulum(int substeps) {
  World<double, Dim> world;
  world.gravity = upright_vector<Dim>(0, -9.81);
  const double start = 0.2;
  const auto box = add_box<Dim>(world, upright_vector<Dim>(std::sin(start) / 2, -std::cos(start) / 2));
  world.orientation[0] = tilted<Dim>(start);
  join<Dim>(world, hinge<Dim>({}, box, {}));
  FastMotion<double, Dim> motion(world, {.substeps = substeps});
  advance(motion, 120);
  return std::atan2(world.position[0][0], -world.position[0][Dim - 1]);
}
double exact_angle_of_pendulum() {
  // Runge-Kutta of fourth order with a step of 1e-4 is exact to 1e-14 here.
  const double h = 1e-4, w2 = 9.81 / 2 / (5.0 / 12);
  double angle = 0.2, rate = 0;
  for (int k = 0; k < 20000; ++k) {
    const auto f = [w2](double x) { return -w2 * std::sin(x); };
    const double k1 = f(angle), k2 = f(angle + h / 2 * rate), k3 = f(angle + h / 2 * (rate + h / 2 * k1)),
                 k4 = f(angle + h * (rate + h / 2 * k2));
    angle += h * rate + h * h / 6 * (k1 + k2 + k3);
    rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return angle;
}
template <int Dim>
void expect_pendulum_converges() {
  const double exact = exact_angle_of_pendulum();
  const double coarse = std::abs(angle_of_pendulum<Dim>(4) - exact),
               fine = std::abs(angle_of_pendulum<Dim>(16) - exact);
  EXPECT_LT(coarse, 0.02);
  EXPECT_LT(fine, coarse / 3);  // of first order at least
}
TEST(Joints, APendulumConvergesToItsEquation) {
  expect_pendulum_converges<2>();
  expect_pendulum_converges<3>();
}

template <int Dim>
void expect_chain_holds(int links, double load) {
  World<double, Dim> world;
  world.gravity = upright_vector<Dim>(0, -9.81);
  BodyHandle above{};
  for (int i = 0; i < links; ++i) {
    const auto link = world.add({.shape = Capsule<double>{0.6, 0.1},
                                 .position = upright_vector<Dim>(0, -i - 0.5),
                                 .mass = i + 1 == links ? load : 1.0});
    ASSERT_TRUE(link);
    auto joint = hinge<Dim>(above, *link, upright_vector<Dim>(0, -i));
    if (Dim == 3) joint.kind = JointKind::ball;
    join<Dim>(world, joint);
    above = *link;
  }
  world.velocity.back()[0] = 1;
  FastMotion<double, Dim> motion(world);
  for (int k = 0; k < 60; ++k) {
    advance(motion, 1);
    Vector<double, Dim> anchor = world.position.back();
    anchor += rotation(world.orientation.back()) * upright_vector<Dim>(0, 0.5);
    EXPECT_LT(length(anchor), links - 1 + 1e-3);
  }
}
TEST(Joints, AChainDoesNotStretchUnderAThousandTimesItsWeight) {
  expect_chain_holds<2>(20, 20000);
  expect_chain_holds<3>(8, 8000);
}

template <int Dim>
void expect_motor_and_limits() {
  World<double, Dim> world;
  const auto box = add_box<Dim>(world, {});
  auto definition = hinge<Dim>({}, box, {});
  definition.motor = JointMotor<double>{.speed = 10, .most = 0.5};
  definition.limits = JointLimits<double>{.lower = -1, .upper = 2};
  const JointHandle joint = join<Dim>(world, definition);
  FastMotion<double, Dim> motion(world);
  advance(motion, 30);
  // The torque is less than it takes to reach the speed: t^2 / 2 of torque / inertia, 0.5 / (1/6), a substep ahead.
  EXPECT_NEAR(turn_rate<Dim>(world, box), 3 * 0.5, 1e-6);
  EXPECT_NEAR(world.find(joint)->motor_effort, 0.5, 1e-9);
  advance(motion, 120);
  EXPECT_NEAR(turn_rate<Dim>(world, box), 0, 1e-6);
  const Matrix<double, Dim> axes = rotation(world.orientation[0]);
  EXPECT_NEAR(std::atan2(axes[0][Dim - 1], axes[0][0]), 2, 1e-4);
  world.find(joint)->motor->speed = -0.1, world.find(joint)->motor->most = 100;
  advance(motion, 120);
  EXPECT_NEAR(turn_rate<Dim>(world, box), -0.1, 1e-6);
}
TEST(Joints, AMotorTurnsWithItsTorqueToTheLimit) {
  expect_motor_and_limits<2>();
  expect_motor_and_limits<3>();
}

template <int Dim>
void expect_slider_slides() {
  World<double, Dim> world;
  world.gravity = upright_vector<Dim>(0, -9.81);
  const auto box = add_box<Dim>(world, {});
  const double angle = 0.3;
  join<Dim>(world, {.kind = JointKind::slider,
                    .b = box,
                    .anchor = upright_vector<Dim>(0.2, 0.1),
                    .axis = upright_vector<Dim>(std::cos(angle), std::sin(angle))});
  FastMotion<double, Dim> motion(world);
  advance(motion, 60);
  const double way = -9.81 * std::sin(angle) / 2;
  EXPECT_NEAR(world.position[0][0], way * std::cos(angle), 1e-6);
  EXPECT_NEAR(world.position[0][Dim - 1], way * std::sin(angle), 1e-6);
  EXPECT_LT(length(Matrix<double, Dim>(rotation(world.orientation[0]))[0] - upright_vector<Dim>(1, 0)), 1e-6);
}
TEST(Joints, ASliderMovesAlongItsAxisOnly) {
  expect_slider_slides<2>();
  expect_slider_slides<3>();
}

template <int Dim>
void expect_spring_of(double hertz) {
  World<double, Dim> world;
  const auto box = add_box<Dim>(world, {});
  join<Dim>(world, {.kind = JointKind::slider,
                    .b = box,
                    .axis = upright_vector<Dim>(1, 0),
                    .spring = JointSpring<double>{.hertz = hertz, .damping = 0}});
  world.velocity[0][0] = 1;
  FastMotion<double, Dim> motion(world, {.substeps = 64});
  advance(motion, 30);
  // Implicit Euler damps by w^2 h / 2 per time.
  const double w = 2 * std::numbers::pi * hertz, h = 1.0 / 60 / 64;
  EXPECT_NEAR(world.position[0][0], std::exp(-w * w * h / 2 * 0.5) * std::sin(w * 0.5) / w, 0.01 / w);
}
TEST(Joints, ASpringHasItsFrequency) {
  expect_spring_of<2>(0.3);
  expect_spring_of<3>(1.7);
}

TEST(Joints, DistancesRopesAndWelds) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  const auto rod = add_box<2>(world, {{3, 0}}), rope = add_box<2>(world, {{10, -1}}),
             weld = add_box<2>(world, {{21, 0}});
  join<2>(world, {.kind = JointKind::distance, .b = rod, .anchor_b = {{{3, 0}}}});
  join<2>(world, {.kind = JointKind::distance,
                  .b = rope,
                  .anchor = {{10, 0}},
                  .anchor_b = {{{10, -1}}},
                  .limits = JointLimits<double>{.upper = 2}});
  const auto held = join<2>(world, {.kind = JointKind::weld, .b = weld, .anchor = {{20, 0}}});
  FastMotion<double, 2> motion(world);
  for (int k = 0; k < 240; ++k) {
    advance(motion, 1);
    EXPECT_NEAR(length(world.position_of(rod)), 3, 1e-3);
    EXPECT_LT(length(world.position_of(rope) - Vector<double, 2>{{10, 0}}), 2 + 1e-3);
    EXPECT_NEAR(world.position_of(weld)[1], 0, 1e-6);
  }
  EXPECT_NEAR(world.position_of(rope)[1], -2, 1e-6);
  EXPECT_NEAR(world.find(held)->force[1], 10, 1e-6);
  EXPECT_NEAR(world.find(held)->torque[0], 10, 1e-6);
}

TEST(Joints, AJointBreaksAtItsStrength) {
  World<double, 2> world;
  world.gravity = {{0, -10}};
  const auto light = add_box<2>(world, {{0, 0}}, 1), heavy = add_box<2>(world, {{5, 0}}, 3);
  const auto holds = join<2>(world, {.kind = JointKind::weld, .b = light, .breaks_at = 20});
  const auto breaks = join<2>(world, {.kind = JointKind::weld, .b = heavy, .anchor = {{5, 0}}, .breaks_at = 20});
  FastMotion<double, 2> motion(world);
  advance(motion, 60);
  EXPECT_FALSE(world.find(holds)->is_broken);
  EXPECT_TRUE(world.find(breaks)->is_broken);
  EXPECT_NEAR(world.position_of(light)[1], 0, 1e-6);
  EXPECT_LT(world.position_of(heavy)[1], -4);
}

TEST(Joints, GearsTurnInTheirRatio) {
  World<double, 2> world;
  const auto small = world.add({.shape = Sphere<double>{1}, .spin = {{6}}});
  const auto large = world.add({.shape = Sphere<double>{2}, .position = {{3.5, 0}}});
  ASSERT_TRUE(small && large);
  join<2>(world, hinge<2>({}, *small, {{0, 0}}));
  join<2>(world, hinge<2>({}, *large, {{3.5, 0}}));
  join<2>(world, {.kind = JointKind::gear, .a = *small, .b = *large, .anchor = {{1, 0}}, .ratio = 0.5});
  FastMotion<double, 2> motion(world);
  advance(motion, 120);
  EXPECT_NEAR(world.orientation[1][0] + 0.5 * world.orientation[0][0], 0, 1e-6);
  // What the gears share at first: I1 w1 = (I1 + I2 / 4) w; I = m r^2 / 2, m = pi r^2.
  EXPECT_NEAR(world.spin[0][0], 6.0 / (1 + 16.0 / 4), 1e-6);
}

TEST(Joints, AUniversalJointTurnsAsHookesDoes) {
  // Two shafts at an angle of b: tan(angle out) = tan(angle in) / cos(b).
  World<double, 3> world;
  const double bend = 0.5;
  const Vector<double, 3> out{{std::cos(bend), 0, std::sin(bend)}};
  const auto first = world.add(
      {.shape = Capsule<double>{1, 0.1}, .position = {{-1, 0, 0}}, .fixed = true, .traits = {.is_driven = true}});
  const auto second = world.add({.shape = Capsule<double>{1, 0.1}, .position = out});
  ASSERT_TRUE(first && second);
  world.spin[0] = {{1, 0, 0}};
  const Vector<double, 3> axle = moment(out, Vector<double, 3>{{0, 1, 0}});
  join<3>(world, {.kind = JointKind::universal, .a = *first, .b = *second, .axis = {{0, 1, 0}}, .axle = axle});
  JointDefinition<double, 3> bearing{.kind = JointKind::hinge, .b = *second, .anchor = out};
  bearing.axis = out;
  join<3>(world, bearing);
  FastMotion<double, 3> motion(world, {.substeps = 16});
  double angle = 0;
  for (int k = 1; k <= 60; ++k) {
    advance(motion, 1);
    angle += dot(world.spin[1], out) / 60;
    const double in = k / 60.0;
    // The cross of b began across the plane of the shafts.
    EXPECT_NEAR(std::tan(angle - 1.0 / 120 * 0), std::tan(in) * std::cos(bend), 0.02) << "step " << k;
  }
}

TEST(Joints, APullDrawsABodyToItsTarget) {
  World<double, 2> world;
  const auto box = add_box<2>(world, {});
  const auto pull = join<2>(world, {.kind = JointKind::pull, .b = box});
  world.find(pull)->target = {{4, 1}};
  FastMotion<double, 2> motion(world);
  advance(motion, 300);
  EXPECT_LT(length(Vector<double, 2>(world.position[0] - Vector<double, 2>{{4, 1}})), 1e-2);
}

/// Far from its target a pull has its greatest force, towards the target: s = F t^2/(2 m), whatever the direction.
TEST(Joints, APullIsNoStrongerThanItsGreatestForce) {
  for (const double angle : {0.0, 0.3, 0.8, 1.6, 2.5, -2.0}) {
    World<double, 2> world;
    const auto box = add_box<2>(world, {});
    const Vector<double, 2> direction{{std::cos(angle), std::sin(angle)}};
    const auto pull = join<2>(world, {.kind = JointKind::pull, .b = box, .breaks_at = 3});
    world.find(pull)->target = direction * 500;
    FastMotion<double, 2> motion(world);
    for (int k = 0; k < 120; ++k) {
      advance(motion, 1);
      EXPECT_LT(length(Vector<double, 2>(world.find(pull)->force - direction * 3)), 1e-6) << angle;
    }
    const double way = 3 / world.mass[0] * 4 / 2;
    EXPECT_LT(length(Vector<double, 2>(world.position[0] - direction * way)), 0.01 * way) << angle;
  }
}

TEST(Joints, AFourBarLinkageKeepsTogether) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  const std::vector<Vector<double, 2>> corners{{{0, 0}}, {{0, 1}}, {{3, 1.5}}, {{3, 0}}};
  std::vector<BodyHandle> bars;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector<double, 2> along = corners[i + 1] - corners[i];
    const auto bar = world.add({.shape = Box<double, 2>{{{length(along), 0.1}}},
                                .position = (corners[i] + corners[i + 1]) * 0.5,
                                .orientation = {{std::atan2(along[1], along[0])}}});
    ASSERT_TRUE(bar);
    bars.push_back(*bar);
  }
  auto crank = hinge<2>({}, bars[0], corners[0]);
  crank.motor = JointMotor<double>{.speed = 6, .most = 1e4};
  join<2>(world, crank);
  join<2>(world, hinge<2>(bars[0], bars[1], corners[1]));
  join<2>(world, hinge<2>(bars[1], bars[2], corners[2]));
  join<2>(world, hinge<2>({}, bars[2], corners[3]));
  FastMotion<double, 2> motion(world);
  for (int k = 0; k < 240; ++k) {
    advance(motion, 1);
    const auto end = [&](std::size_t bar, double side) {
      const Vector<double, 2> along = corners[bar + 1] - corners[bar];
      const Matrix<double, 2> axes = rotation(world.orientation[bar]);
      return Vector<double, 2>(world.position[bar] + axes[0] * (side * length(along) / 2));
    };
    EXPECT_LT(length(Vector<double, 2>(end(0, 1) - end(1, -1))), 1e-3) << k;
    EXPECT_LT(length(Vector<double, 2>(end(1, 1) - end(2, -1))), 1e-3) << k;
    EXPECT_NEAR(world.spin[0][0], 6, 1e-5) << k;
  }
}

TEST(Joints, RefusesWhatMakesNoSense) {
  World<double, 2> world;
  const auto box = add_box<2>(world, {});
  using Definition = JointDefinition<double, 2>;
  EXPECT_FALSE(world.add_joint(Definition{}));
  EXPECT_FALSE(world.add_joint(Definition{.a = box, .b = box}));
  EXPECT_FALSE(world.add_joint(Definition{.b = BodyHandle{7, 1}}));
  EXPECT_FALSE(world.add_joint(Definition{.b = box, .axis = {{0, 0}}}));
  EXPECT_FALSE(world.add_joint(Definition{.b = box, .limits = JointLimits<double>{.lower = 1, .upper = 0}}));
  EXPECT_FALSE(world.add_joint(Definition{.kind = JointKind::weld, .b = box, .motor = JointMotor<double>{}}));
  EXPECT_FALSE(world.add_joint(Definition{.kind = JointKind::distance, .b = box}));
  EXPECT_FALSE(world.add_joint(Definition{.kind = JointKind::universal, .b = box}));
  EXPECT_FALSE(world.add_joint(Definition{.b = box, .breaks_at = -1}));
  EXPECT_EQ(world.joint_count(), 0u);
  const auto joint = join<2>(world, {.b = box});
  EXPECT_TRUE(world.remove(box));
  EXPECT_FALSE(world.has_joint(joint));
  EXPECT_FALSE(world.remove_joint(joint));
  EXPECT_EQ(world.find(joint), nullptr);
}

}  // namespace
}  // namespace continuo::joints_test
