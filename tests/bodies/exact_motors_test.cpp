// Motors of the exact motion whose speed changes with time, against closed forms and a reduced equation.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "exact_steps.hpp"
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::exact_motors_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using test::advance;
using V2 = Vector<double, 2>;
using Law = std::function<MotorSpeed<double>(double)>;

/// A box of mass 2 that a hinge about z joins to the world, with a motor of this law.
template <int Dim>
struct Turned {
  World<double, Dim> world;
  JointHandle joint;
  double inertia = 2.0 / 6;
  Law law;

  Turned(Law of, double most) : law(std::move(of)) {
    const auto body = require(world.add({.shape = Box<double, Dim>{}, .mass = 2.0}));
    JointDefinition<double, Dim> hinge{.b = body, .motor = JointMotor<double>{0, most}};
    if constexpr (Dim == 3) hinge.axis = {{0, 0, 1}};
    joint = require(world.add_joint(hinge));
  }
  [[nodiscard]] ExactMotion<double, Dim> motion() { return ExactMotion(world, {.motors = {{joint, law}}}); }
  [[nodiscard]] double angle() const {
    const auto& at = world.orientation[0];
    if constexpr (Dim == 2) {
      return at[0];
    } else {
      return 2 * std::atan2(at[3], at[0]);
    }
  }
  [[nodiscard]] double spin() const { return world.spin[0][world.spin[0].size() - 1]; }
  [[nodiscard]] double effort() const { return world.find(joint)->motor_effort; }
};

template <int Dim>
void expect_speed_of_law() {
  Turned<Dim> of([](double t) { return MotorSpeed<double>{3 * std::sin(2 * t), 6 * std::cos(2 * t)}; }, infinity);
  auto motion = of.motion();
  for (const double t : {0.3, 1.0, 2.5}) {
    advance(motion, t);
    EXPECT_NEAR(of.angle(), 1.5 * (1 - std::cos(2 * t)), 1e-9);
    EXPECT_NEAR(of.spin(), 3 * std::sin(2 * t), 1e-13);
    EXPECT_NEAR(of.effort(), of.inertia * 6 * std::cos(2 * t), 1e-11);
    EXPECT_NEAR(of.world.find(of.joint)->motor->speed, 3 * std::sin(2 * t), 1e-13);
  }
}
TEST(ExactMotors, KeepTheSpeedOfTheirLaw) {
  expect_speed_of_law<2>();
  expect_speed_of_law<3>();
}

// A speed of t^2 up to t = 2, then 4. It asks for a torque of 2 I t: from t1 on for more than there is. The box lags
// until it has a speed of 4.
template <int Dim>
void expect_lag() {
  const double most = 0.5;
  Turned<Dim> of([](double t) { return t < 2 ? MotorSpeed<double>{t * t, 2 * t} : MotorSpeed<double>{4, 0}; }, most);
  const double t1 = most / (2 * of.inertia), pull = most / of.inertia, t2 = t1 + (4 - t1 * t1) / pull;
  ASSERT_GT(t2, 2);
  auto motion = of.motion();
  advance(motion, 0.9 * t1);
  EXPECT_NEAR(of.spin(), 0.81 * t1 * t1, 1e-12);
  EXPECT_NEAR(of.effort(), 0.9 * most, 1e-11);
  for (const double t : {t1 + 0.1, 1.9, 2.1, t2 - 0.01}) {
    advance(motion, t);
    EXPECT_NEAR(of.spin(), t1 * t1 + pull * (t - t1), 1e-9) << t;
    EXPECT_NEAR(of.effort(), most, 1e-13) << t;
  }
  advance(motion, t2 + 0.5);
  EXPECT_NEAR(of.spin(), 4, 1e-12);
  EXPECT_NEAR(of.effort(), 0, 1e-12);
}
TEST(ExactMotors, LagWhereTheirForceDoesNotSuffice) {
  expect_lag<2>();
  expect_lag<3>();
}

// So strong that the rounding of the time makes an error of the speed beyond that of other motors: it has its speed at
// once, and does not chatter about it.
TEST(ExactMotors, StrongOnesDoNotChatter) {
  for (const double most : {1e3, 1e6, 1e9}) {
    Turned<2> of([](double t) { return MotorSpeed<double>{t < 0.3 ? 2.0 : -1.0, 0}; }, most);
    ExactMotion motion(of.world, {.most_events = 1000, .motors = {{of.joint, of.law}}});
    advance(motion, 1);
    const double pull = most / of.inertia;  // from 0 to 2, and from there to -1
    EXPECT_NEAR(of.angle(), 0.6 - 2 / pull - (0.7 - 4.5 / pull), 1e-9) << most;
    EXPECT_NEAR(of.spin(), -1, 1e-12) << most;
  }
}

/// Jumps, once between the ends of calls, and once in a pulse of a hundredth.
TEST(ExactMotors, StrikeTheirJointWhereTheirSpeedJumps) {
  Turned<2> of(
      [](double t) {
        return MotorSpeed<double>{t < 1.0 / 3 ? 2.0 : t >= 1.7 && t < 1.71 ? 50.0 : -1.0, 0};
      },
      infinity);
  auto motion = of.motion();
  advance(motion, 1.5);
  EXPECT_NEAR(of.angle(), 2.0 / 3 - (1.5 - 1.0 / 3), 1e-13);
  EXPECT_NEAR(of.spin(), -1, 1e-14);
  advance(motion, 2);
  EXPECT_NEAR(of.angle(), 2.0 / 3 - (2 - 1.0 / 3) + 0.51, 1e-12);
}

/// A tray on a slider along an axis, and a box on it, with friction.
struct Tray {
  World<double, 2> world;
  JointHandle slider;
  static constexpr double friction = 0.4, g = 9.81;

  explicit Tray(std::size_t axis) {
    world.gravity = {{0, -g}};
    const Material<double> rough{.friction = friction};
    const auto tray = require(world.add({.shape = Box<double, 2>{{{20, 1}}}, .mass = 5.0, .material = rough}));
    require(world.add({.shape = Box<double, 2>{{{1, 1}}}, .position = {{0, 1}}, .mass = 1.0, .material = rough}));
    JointDefinition<double, 2> joint{.kind = JointKind::slider, .b = tray, .motor = JointMotor<double>{0, infinity}};
    joint.axis = {};
    joint.axis[axis] = 1;
    slider = require(world.add_joint(joint));
  }
};
// The tray has an acceleration of c t: the box sticks until that is more than friction has.
TEST(ExactMotors, ABoxSlidesOnATrayThatIsDrivenTooFast) {
  constexpr double c = 3;
  Tray of(0);
  ExactMotion motion(of.world,
                     {.motors = {{of.slider, [](double t) { return MotorSpeed<double>{c * t * t / 2, c * t}; }}}});
  const double pull = Tray::friction * Tray::g, t1 = pull / c;
  for (const double t : {0.4 * t1, 0.99 * t1, t1 + 0.2, t1 + 0.7}) {
    advance(motion, t);
    const double after = std::max(t - t1, 0.0), until = std::min(t, t1);
    EXPECT_NEAR(of.world.position[0][0], c * t * t * t / 6, 1e-10) << t;
    EXPECT_NEAR(of.world.position[1][0],
                c * until * until * until / 6 + c * until * until / 2 * after + pull * after * after / 2, 1e-9)
        << t;
  }
}
// It is thrown up as the tray jumps to a speed, and falls freely as that drops faster.
TEST(ExactMotors, ABoxLeavesATrayThatDrops) {
  Tray of(1);
  ExactMotion motion(of.world, {.motors = {{of.slider, [](double t) {
                                              return MotorSpeed<double>{t < 1 ? 0 : t < 1.25 ? 3.0 : -20.0, 0};
                                            }}}});
  advance(motion, 1.1);
  EXPECT_NEAR(of.world.position[1][1], 1.3, 1e-12);
  EXPECT_NEAR(of.world.velocity[1][1], 3, 1e-12);
  advance(motion, 1.5);
  EXPECT_NEAR(of.world.position[0][1], 0.75 - 20 * 0.25, 1e-12);
  EXPECT_NEAR(of.world.position[1][1], 1.75 + 3 * 0.25 - Tray::g * 0.25 * 0.25 / 2, 1e-11);
}

// Two blocks on a rough floor that a slider drives apart, from rest, by c t^3 / 6. At first neither wants to slip, but
// they cannot both stick: the light one goes, and the heavy one rests.
TEST(ExactMotors, BlocksThatAreDrivenApartFromRestDoNotBothStick) {
  constexpr double c = 0.5;
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  const Material<double> rough{.friction = 0.5};
  require(world.add_wall({.normal = {{0, 1}}, .material = rough}));
  const auto add = [&](double x, double mass) {
    return require(world.add({.shape = Box<double, 2>{}, .position = {{x, 0.5}}, .mass = mass, .material = rough}));
  };
  const auto heavy = add(0, 5), light = add(2, 1);
  const auto slider = require(world.add_joint({.kind = JointKind::slider,
                                               .a = heavy,
                                               .b = light,
                                               .anchor = {{2, 0.5}},
                                               .axis = {{1, 0}},
                                               .motor = JointMotor<double>{0, infinity}}));
  ExactMotion motion(world, {.most_events = 10'000,
                             .motors = {{slider, [](double t) { return MotorSpeed<double>{c * t * t / 2, c * t}; }}}});
  for (const double t : {0.1, 0.5, 2.0}) {
    advance(motion, t);
    EXPECT_NEAR(world.position[0][0], 0, 1e-9) << t;
    EXPECT_NEAR(world.position[1][0], 2 + c * t * t * t / 6, 1e-9) << t;
  }
}

// A rod hangs from the pin of a crank, whose speed is a sum of sines by chance. With the way P of the pin:
// (I + m c^2) a'' = -m c (P'' . (-sin a, cos a) + g cos a), by the classical Runge-Kutta method.
TEST(ExactMotors, ARodOnACrankMovesByItsReducedEquation) {
  using Wide = long double;
  std::mt19937 engine(11);
  const auto number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
  for (int trial = 0; trial < 8; ++trial) {
    std::array<std::array<double, 3>, 3> waves{};
    for (auto& [size, w, phase] : waves) size = number(-3, 3), w = number(0.5, 6), phase = number(0, 6);
    const auto speed = [&](Wide t) {
      std::array<Wide, 2> made{};
      for (const auto& [size, w, phase] : waves)
        made[0] += size * std::sin(w * t + phase), made[1] += size * w * std::cos(w * t + phase);
      return made;
    };
    constexpr double r = 0.5, l = 1.2, mass = 0.7, g = 9.81, c = l / 2, inertia = mass * (l * l + 0.01) / 12;
    World<double, 2> world;
    world.gravity = {{0, -g}};
    const double w0 = static_cast<double>(speed(0)[0]), start = number(-3, 3);
    const auto crank = require(world.add({.shape = Sphere<double>{0.6}, .spin = {{w0}}}));
    const V2 along{{std::cos(start), std::sin(start)}};
    const auto rod = require(world.add({.shape = Box<double, 2>{{{l, 0.1}}},
                                        .position = V2{{r, 0}} + along * c,
                                        .velocity = {{0, r * w0}},
                                        .orientation = {{start}},
                                        .mass = mass}));
    const auto shaft = require(world.add_joint({.b = crank, .motor = JointMotor<double>{w0, infinity}}));
    require(world.add_joint({.a = crank, .b = rod, .anchor = {{r, 0}}}));
    ExactMotion motion(world, {.tolerance = 1e-12, .motors = {{shaft, [&](double t) {
                                                                 const auto made = speed(t);
                                                                 return MotorSpeed<double>{
                                                                     static_cast<double>(made[0]),
                                                                     static_cast<double>(made[1])};
                                                               }}}});
    std::array<Wide, 3> x{0, start, 0};  // the angles of crank and rod, the spin of the rod
    const auto rate = [&](Wide t, const std::array<Wide, 3>& at) {
      const auto [w, change] = speed(t);
      const Wide px = -r * (change * std::sin(at[0]) + w * w * std::cos(at[0])),
                 py = r * (change * std::cos(at[0]) - w * w * std::sin(at[0]));
      const Wide pull = -mass * c * (-px * std::sin(at[1]) + py * std::cos(at[1]) + g * std::cos(at[1]));
      return std::array<Wide, 3>{w, at[2], pull / (inertia + mass * c * c)};
    };
    constexpr int steps = 20'000;
    constexpr Wide h = Wide(3) / steps;
    const auto moved = [](std::array<Wide, 3> from, const std::array<Wide, 3>& by, Wide size) {
      for (std::size_t i = 0; i < 3; ++i) from[i] += size * by[i];
      return from;
    };
    for (int k = 0; k < steps; ++k) {
      const Wide t = h * k;
      const auto k1 = rate(t, x), k2 = rate(t + h / 2, moved(x, k1, h / 2)), k3 = rate(t + h / 2, moved(x, k2, h / 2)),
                 k4 = rate(t + h, moved(x, k3, h));
      for (std::size_t i = 0; i < 3; ++i) x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    advance(motion, 3);
    EXPECT_NEAR(world.orientation[0][0], static_cast<double>(x[0]), 1e-9) << trial;
    EXPECT_NEAR(world.orientation[1][0], static_cast<double>(x[1]), 1e-8) << trial;
    EXPECT_NEAR(world.spin[1][0], static_cast<double>(x[2]), 1e-7) << trial;
  }
}

TEST(ExactMotors, ALawOfNoMotorIsAnError) {
  World<double, 2> world;
  const auto body = require(world.add({.shape = Box<double, 2>{}}));
  const auto joint = require(world.add_joint({.b = body}));
  ExactMotion motion(world, {.motors = {{joint, [](double) { return MotorSpeed<double>{}; }}}});
  EXPECT_THAT(motion.advance_to(1).message, testing::HasSubstr("a law of a motor"));
}

}  // namespace
}  // namespace continuo::exact_motors_test
