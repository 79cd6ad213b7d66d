// Coulomb's friction of shapes in space, by the exact motion, against closed forms, reduced equations and the plane.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "exact_steps.hpp"
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::exact_friction_test {
namespace {

using World2 = World<double, 2>;
using World3 = World<double, 3>;
using V2 = Vector<double, 2>;
using V3 = Vector<double, 3>;
using Wide = long double;
constexpr double pi = std::numbers::pi, g = 9.81;

using test::advance, test::energy;
/// A ball that moves as the other shapes do.
Compound<double, 3> ball(double radius) {
  Compound<double, 3> made;
  made.parts.push_back({.shape = Sphere<double>{radius}});
  return made;
}
World3 floor_with(double friction, double restitution = 0) {
  World3 world;
  world.gravity = {{0, 0, -g}};
  require(world.add_wall({.normal = {{0, 0, 1}}, .material = {.restitution = restitution, .friction = friction}}));
  return world;
}
/// A slope that falls towards an azimuth.
struct Slope {
  double steepness, azimuth;
  [[nodiscard]] V3 normal() const {
    return {{std::sin(steepness) * std::cos(azimuth), std::sin(steepness) * std::sin(azimuth), std::cos(steepness)}};
  }
  [[nodiscard]] V3 down() const {
    return {{std::cos(steepness) * std::cos(azimuth), std::cos(steepness) * std::sin(azimuth), -std::sin(steepness)}};
  }
  [[nodiscard]] World3 world(double friction) const {
    World3 made;
    made.gravity = {{0, 0, -g}};
    require(made.add_wall({.normal = normal(), .material = {.friction = friction}}));
    return made;
  }
  /// Of a shape that lies on the slope, turned about its normal.
  [[nodiscard]] Orientation<double, 3> orientation(double turn) const {
    const V3 axis{{-std::sin(azimuth), std::cos(azimuth), 0}};
    return turned(turned(upright<double, 3>(), V3{{0, 0, turn}}, 1.0), V3(axis * steepness), 1.0);
  }
};

// One contact.

// Coulomb, "Theorie mathematique des effets du jeu de billard", 1835 (Coriolis): the slip keeps its direction, so that
// the centre has a parabola until 2 |slip| / (7 f g), and then a straight line. The spin about the normal stays.
TEST(ExactFriction, ABallThatSlidesAndSpinsMovesAsCoriolisSays) {
  const double friction = 0.3, r = 0.5;
  World3 world = floor_with(friction);
  const V3 v{{3, 1, 0}}, spin{{2, -7, 5}};
  require(world.add(
      {.shape = ball(r), .position = {{0, 0, r}}, .velocity = v, .spin = spin, .material = {.friction = friction}}));
  const V3 slip = v + moment(spin, V3{{0, 0, -r}}), direction = slip * (1 / length(slip));
  const double rolls = 2 * length(slip) / (7 * friction * g);
  const V3 pull = direction * (-friction * g);
  ExactMotion motion(world);
  for (const double t : {0.2 * rolls, 0.99 * rolls}) {
    advance(motion, t);
    EXPECT_LT(length(V3(world.position[0] - V3{{0, 0, r}} - v * t - pull * (t * t / 2))), 1e-11);
  }
  advance(motion, rolls + 1);
  const V3 rolling = v + pull * rolls;
  EXPECT_LT(length(V3(world.velocity[0] - rolling)), 1e-11);
  EXPECT_LT(length(V3(world.position[0] - V3{{0, 0, r}} - v * rolls - pull * (rolls * rolls / 2) - rolling)), 1e-10);
  EXPECT_LT(length(V3(world.velocity[0] + moment(world.spin[0], V3{{0, 0, -r}}))), 1e-13);
  EXPECT_NEAR(world.spin[0][2], 5, 1e-12);
}
// It rolls with 5/7 of the acceleration of a slide without friction, up to a slope of 7/2 of the friction.
TEST(ExactFriction, ABallRollsDownASlopeOrSlides) {
  for (const double ratio : {0.3, 0.99, 1.01, 3.0}) {
    const double friction = 0.2, r = 0.4;
    const Slope slope{std::atan(3.5 * friction * ratio), 0.7};
    World3 world = slope.world(friction);
    require(world.add({.shape = ball(r), .position = slope.normal() * r, .material = {.friction = friction}}));
    ExactMotion motion(world);
    advance(motion, 1);
    const double s = std::sin(slope.steepness), c = std::cos(slope.steepness);
    const double pull = ratio < 1 ? 5.0 / 7 * g * s : g * (s - friction * c);
    EXPECT_LT(length(V3(world.position[0] - slope.normal() * r - slope.down() * (pull / 2))), 1e-11) << ratio;
  }
}
// The slip u of a ball on a slope, across which it is thrown, changes by g sin along it, and by 7/2 f g cos against u.
// The centre changes by 2/7 of the second part: v - 2/7 u changes by 5/7 g sin, whatever u does.
TEST(ExactFriction, ASlipTurnsUntilABallRolls) {
  const double friction = 0.5, r = 0.3;
  const Slope slope{0.6, -0.4};
  const V3 across = moment(slope.normal(), slope.down());
  World3 world = slope.world(friction);
  const V3 v = across * 2.0;
  require(
      world.add({.shape = ball(r), .position = slope.normal() * r, .velocity = v, .material = {.friction = friction}}));
  ExactMotion motion(world, {.tolerance = 1e-12});
  const auto slip_of_world = [&] { return world.velocity[0] + moment(world.spin[0], slope.normal() * -r); };
  // u along and across the slope, by the classical Runge-Kutta method in steps that shrink with u.
  std::array<Wide, 2> u{0, 2};
  const Wide pull = g * std::sin(Wide(slope.steepness)),
             rub = Wide(3.5) * friction * g * std::cos(Wide(slope.steepness));
  const auto rate = [&](const std::array<Wide, 2>& at) {
    const Wide size = std::hypot(at[0], at[1]);
    return std::array<Wide, 2>{pull - rub * at[0] / size, -rub * at[1] / size};
  };
  const auto plus = [](const std::array<Wide, 2>& at, const std::array<Wide, 2>& by, Wide h) {
    return std::array<Wide, 2>{at[0] + by[0] * h, at[1] + by[1] * h};
  };
  Wide t = 0;
  for (int k = 1; k <= 40'000 && std::hypot(u[0], u[1]) > 1e-13L; ++k) {
    const Wide h = std::hypot(u[0], u[1]) / (200 * (rub + pull));
    const auto a = rate(u), b = rate(plus(u, a, h / 2)), c = rate(plus(u, b, h / 2)), d = rate(plus(u, c, h));
    for (std::size_t i = 0; i < 2; ++i) u[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    t += h;
    if (k % 400 != 0) continue;
    advance(motion, static_cast<double>(t));
    const V3 slip = slip_of_world();
    EXPECT_NEAR(dot(slip, slope.down()), static_cast<double>(u[0]), 1e-9) << k;
    EXPECT_NEAR(dot(slip, across), static_cast<double>(u[1]), 1e-9) << k;
  }
  ASSERT_LT(std::hypot(u[0], u[1]), 1e-12L);
  const double end = 2 * static_cast<double>(t);
  advance(motion, end);
  EXPECT_LT(length(slip_of_world()), 1e-12);
  EXPECT_LT(length(V3(world.velocity[0] - v * (5.0 / 7) - slope.down() * (5.0 / 7 * static_cast<double>(pull) * end))),
            1e-9);
}
// m r v about the line of contact stays: from v0 to v0 m r^2 / (m r^2 + I).
TEST(ExactFriction, ACapsuleSlidesUntilItRolls) {
  const double r = 0.2, friction = 0.4, turn = 0.3;
  World3 world = floor_with(friction);
  const V3 ahead{{std::cos(turn), std::sin(turn), 0}};
  require(
      world.add({.shape = Capsule<double>{1, r},
                 .position = {{0, 0, r}},
                 .velocity = ahead * 2.0,
                 .orientation = turned(turned(upright<double, 3>(), V3{{pi / 2, 0, 0}}, 1.0), V3{{0, 0, turn}}, 1.0),
                 .mass = 1,
                 .material = {.friction = friction}}));
  const double inertia = world.inertia(0)[2][2], rolling = 2 * r * r / (r * r + inertia);
  ExactMotion motion(world);
  advance(motion, 1);
  const double until = (2 - rolling) / (friction * g), way = (2 + rolling) / 2 * until + rolling * (1 - until);
  ASSERT_LT(until, 1);
  EXPECT_LT(length(V3(world.position[0] - V3{{0, 0, r}} - ahead * way)), 1e-10);
  EXPECT_LT(length(V3(world.velocity[0] - ahead * rolling)), 1e-10);
}

// Impacts.

// The least impulse across that stops the slip is 2/7 of it by unit of mass; friction has (1 + e) f of the approach.
TEST(ExactFriction, ABallThatBouncesSticksOrSlips) {
  for (const double friction : {0.1, 0.3, 2.0}) {
    const double r = 0.5, e = 0.7, height = 0.8;
    World3 world = floor_with(friction, e);
    const V3 v{{3, 1, 0}}, spin{{2, -7, 5}};
    require(world.add({.shape = ball(r),
                       .position = {{0, 0, r + height}},
                       .velocity = v,
                       .spin = spin,
                       .material = {.restitution = e, .friction = friction}}));
    const double falls = std::sqrt(2 * height / g);
    ExactMotion motion(world);
    advance(motion, 1.1 * falls);
    const V3 slip = v + moment(spin, V3{{0, 0, -r}});
    const double impulse = std::min(friction * (1 + e) * g * falls, 2.0 / 7 * length(slip));
    const V3 change = slip * (-impulse / length(slip));
    EXPECT_NEAR(world.velocity[0][0], v[0] + change[0], 1e-12) << friction;
    EXPECT_NEAR(world.velocity[0][1], v[1] + change[1], 1e-12) << friction;
    EXPECT_NEAR(world.velocity[0][2], (e - 0.1) * g * falls, 1e-12) << friction;
    const V3 turned_by = moment(V3{{0, 0, -r}}, change) * (2.5 / (r * r));
    EXPECT_LT(length(V3(world.spin[0] - spin - turned_by)), 1e-11) << friction;
  }
}

// Many contacts.

TEST(ExactFriction, ABoxSlidesStopsAndRests) {
  const double friction = 0.5, v = 2;
  World3 world = floor_with(friction);
  require(world.add({.shape = Box<double, 3>{{{1, 0.8, 0.6}}},
                     .position = {{0, 0, 0.3}},
                     .velocity = {{0.6 * v, 0.8 * v, 0}},
                     .material = {.friction = friction}}));
  const double stops = v / (friction * g), way = v * stops / 2;
  ExactMotion motion(world, {.contact_events = 100});
  advance(motion, stops / 2);
  EXPECT_NEAR(length(world.velocity[0]), v / 2, 1e-12);
  advance(motion, 2);
  EXPECT_LT(length(V3(world.position[0] - V3{{0.6 * way, 0.8 * way, 0.3}})), 1e-11);
  EXPECT_LT(length(world.velocity[0]) + length(world.spin[0]), 1e-13);
  EXPECT_EQ(std::ranges::count(motion.contact_events(), ContactChange::end, &ContactEvent<double, 3>::change), 0);
}
TEST(ExactFriction, ABoxOnASlopeHoldsOrSlips) {
  for (const double ratio : {0.99, 1.01})
    for (const double turn : {0.0, 0.6, 2.0}) {
      const Slope slope{0.5, 0.7};
      const double friction = std::tan(slope.steepness) / ratio;
      World3 world = slope.world(friction);
      require(world.add({.shape = Box<double, 3>{{{1, 0.8, 0.4}}},
                         .position = slope.normal() * 0.2,
                         .orientation = slope.orientation(turn),
                         .material = {.friction = friction}}));
      ExactMotion motion(world);
      advance(motion, 1);
      const double pull = g * (std::sin(slope.steepness) - friction * std::cos(slope.steepness));
      const V3 way = slope.down() * (ratio < 1 ? 0 : pull / 2);
      EXPECT_LT(length(V3(world.position[0] - slope.normal() * 0.2 - way)), 1e-12) << ratio << ' ' << turn;
      EXPECT_LT(length(world.spin[0]), 1e-10);
    }
}
// Where the tangent of the slope is the friction, speed and its part down the slope together stay: thrown across the
// slope, a box ends with half of its speed straight down.
TEST(ExactFriction, ABoxThrownAcrossASlopeTurnsDown) {
  const Slope slope{0.5, 0.7};
  const double friction = std::tan(slope.steepness);
  const V3 across = moment(slope.normal(), slope.down());
  World3 world = slope.world(friction);
  require(world.add({.shape = Box<double, 3>{{{1, 0.8, 0.3}}},
                     .position = slope.normal() * 0.15,
                     .velocity = across * 2.0,
                     .orientation = slope.orientation(0.4),
                     .material = {.friction = friction}}));
  ExactMotion motion(world, {.tolerance = 1e-12});
  for (int k = 1; k <= 30; ++k) {
    advance(motion, 0.1 * k);
    EXPECT_NEAR(length(world.velocity[0]) + dot(world.velocity[0], slope.down()), 2, 1e-10);
    EXPECT_LT(length(world.spin[0]), 1e-10);
  }
  EXPECT_NEAR(dot(world.velocity[0], slope.down()), 1, 1e-5);
}
// A force that grows evenly moves a box once it is as great as the friction, and from then on by its excess.
TEST(ExactFriction, ABoxBeginsToSlipWhereTheForceReachesFriction) {
  const double friction = 0.4, growth = 3;
  World3 world = floor_with(friction);
  require(world.add({.shape = Box<double, 3>{{{1, 1, 0.4}}},
                     .position = {{0, 0, 0.2}},
                     .mass = 1,
                     .material = {.friction = friction}}));
  const V3 ahead{{std::cos(0.3), std::sin(0.3), 0}};
  world.force_laws.push_back([&](const World3&, double t, std::span<const V3>, std::span<const V3>,
                                 std::span<V3> force) { force[0] += ahead * (growth * t); });
  ExactMotion motion(world);
  const double begins = friction * g / growth;
  advance(motion, 0.999 * begins);
  EXPECT_LT(length(world.velocity[0]), 1e-13);
  advance(motion, begins + 0.5);
  EXPECT_LT(length(V3(world.position[0] - V3{{0, 0, 0.2}} - ahead * (growth * 0.125 / 6))), 1e-9);
}

/// Three balls on the floor that carry a fourth, whose normal forces follow from the motion: the referee integrates
/// place and angle of the body that slides on the floor, in long double.
class Tripod {
 public:
  static constexpr double r = 0.1, friction = 0.3;
  Compound<double, 3> shape;
  Tripod() {
    for (const V3& at : feet) shape.parts.push_back({.shape = Sphere<double>{r}, .position = at});
    shape.parts.push_back({.shape = Sphere<double>{0.15}, .position = {{0.05, -0.1, 0.3}}});
  }
  /// x, y, angle and their rates of the centre of mass.
  using State = std::array<Wide, 6>;
  void know(const World3& world) {
    centre_ = world.position[0];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) inertia_[i][j] = 0;
    const auto in_body = world.inertia(0);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) inertia_[i][j] = in_body[i][j];
    mass_ = world.mass[0];
  }
  /// The rates for the angle 0 of the beginning, where the body is as its shape is.
  [[nodiscard]] State rate(const State& s) const {
    const Wide c = std::cos(s[2]), w = s[5];
    const Wide sn = std::sin(s[2]);
    // Inertia in the world, of which the column of z tells L = I w.
    const Wide ixz = c * inertia_[0][2] - sn * inertia_[1][2], iyz = sn * inertia_[0][2] + c * inertia_[1][2];
    const Wide izz = inertia_[2][2];
    // Unknowns: three normal forces and the angular acceleration.
    std::array<std::array<Wide, 5>, 4> m{};
    std::array<std::array<Wide, 2>, 3> against{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Wide bx = feet[k][0] - centre_[0], by = feet[k][1] - centre_[1];
      const Wide x = c * bx - sn * by, y = sn * bx + c * by, z = -Wide(centre_[2]) - r;
      const Wide vx = s[3] - w * y, vy = s[4] + w * x, size = std::hypot(vx, vy);
      against[k] = {-friction * vx / size, -friction * vy / size};
      m[0][k] = 1;
      m[1][k] = y - z * against[k][1];                  // torque about x
      m[2][k] = z * against[k][0] - x;                  // about y
      m[3][k] = x * against[k][1] - y * against[k][0];  // about z
    }
    m[0][4] = mass_ * g;
    m[1][3] = -ixz, m[1][4] = -w * w * iyz;  // dL/dt = I a + w x L, L = (ixz, iyz, izz) w
    m[2][3] = -iyz, m[2][4] = w * w * ixz;
    m[3][3] = -izz;
    const std::array<Wide, 4> found = solved(m);
    State d{s[3], s[4], s[5], 0, 0, found[3]};
    for (std::size_t k = 0; k < 3; ++k) {
      least_ = std::min(least_, found[k]);
      d[3] += found[k] * against[k][0] / mass_, d[4] += found[k] * against[k][1] / mass_;
    }
    return d;
  }
  [[nodiscard]] State after(State s, Wide duration, int steps) const {
    const Wide h = duration / steps;
    const auto plus = [](State at, const State& by, Wide size) {
      for (std::size_t i = 0; i < 6; ++i) at[i] += size * by[i];
      return at;
    };
    for (int k = 0; k < steps; ++k) {
      const State a = rate(s), b = rate(plus(s, a, h / 2)), c = rate(plus(s, b, h / 2)), d = rate(plus(s, c, h));
      for (std::size_t i = 0; i < 6; ++i) s[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    }
    return s;
  }
  /// The least normal force so far: the referee holds while it is above 0.
  [[nodiscard]] Wide least() const { return least_; }

 private:
  static constexpr std::array<V3, 3> feet{V3{{0.5, 0, 0}}, V3{{-0.3, 0.45, 0}}, V3{{-0.25, -0.4, 0}}};
  [[nodiscard]] static std::array<Wide, 4> solved(std::array<std::array<Wide, 5>, 4> m) {
    for (std::size_t k = 0; k < 4; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k; i < 4; ++i)
        if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
      std::swap(m[k], m[pivot]);
      for (std::size_t i = 0; i < 4; ++i)
        if (i != k)
          for (std::size_t j = 5; j-- > k;) m[i][j] -= m[i][k] / m[k][k] * m[k][j];
    }
    return {m[0][4] / m[0][0], m[1][4] / m[1][1], m[2][4] / m[2][2], m[3][4] / m[3][3]};
  }
  V3 centre_{};
  std::array<std::array<Wide, 3>, 3> inertia_{};
  Wide mass_ = 1;
  mutable Wide least_ = 1e9L;
};
TEST(ExactFriction, ATripodThatSlidesAndTurnsMovesByItsReducedEquations) {
  for (const double spin : {0.5, -3.0, 6.0}) {
    Tripod tripod;
    World3 world = floor_with(Tripod::friction);
    require(world.add(
        {.shape = tripod.shape, .position = {{0, 0, Tripod::r}}, .material = {.friction = Tripod::friction}}));
    world.velocity[0] = {{1, 0.5, 0}}, world.spin[0] = {{0, 0, spin}};
    World3 still = world;
    still.position[0] -= V3{{0, 0, Tripod::r}};
    tripod.know(still);
    Tripod::State state{0, 0, 0, 1, 0.5L, spin};
    const V3 from = world.position[0];
    ExactMotion motion(world, {.tolerance = 1e-12});
    for (int k = 1; k <= 6; ++k) {
      state = tripod.after(state, 0.04L, 2000);
      ASSERT_GT(tripod.least(), 0.02L);
      advance(motion, 0.04 * k);
      EXPECT_NEAR(world.position[0][0] - from[0], static_cast<double>(state[0]), 1e-9) << spin << ' ' << k;
      EXPECT_NEAR(world.position[0][1] - from[1], static_cast<double>(state[1]), 1e-9) << spin << ' ' << k;
      EXPECT_NEAR(world.spin[0][2], static_cast<double>(state[5]), 1e-8) << spin << ' ' << k;
      EXPECT_NEAR(world.position[0][2], from[2], 1e-13);
    }
    advance(motion, 4);  // it has come to rest
    EXPECT_LT(length(world.velocity[0]) + length(world.spin[0]), 1e-12) << spin;
  }
}

// The plane.

/// A box of the plane of x and z, 0.5 deep in space.
struct Thrown {
  V2 size{}, position{}, velocity{};
  double angle = 0, spin = 0, friction = 0.5, restitution = 0;
};
World2 in_plane(const Thrown& of) {
  World2 world;
  world.gravity = {{0, -g}};
  const Material<double> material{.restitution = of.restitution, .friction = of.friction};
  require(world.add_wall({.normal = {{0, 1}}, .material = material}));
  require(world.add({.shape = Box<double, 2>{of.size},
                     .position = of.position,
                     .velocity = of.velocity,
                     .orientation = {{of.angle}},
                     .spin = {{of.spin}},
                     .mass = 1,
                     .material = material}));
  return world;
}
World3 in_space(const Thrown& of) {
  World3 world = floor_with(of.friction, of.restitution);
  require(world.add({.shape = Box<double, 3>{{{of.size[0], 0.5, of.size[1]}}},
                     .position = {{of.position[0], 0, of.position[1]}},
                     .velocity = {{of.velocity[0], 0, of.velocity[1]}},
                     .orientation = turned(upright<double, 3>(), V3{{0, -of.angle, 0}}, 1.0),
                     .spin = {{0, -of.spin, 0}},
                     .mass = 1,
                     .material = {.restitution = of.restitution, .friction = of.friction}}));
  return world;
}
TEST(ExactFriction, ABoxOfSpaceMovesAsThatOfThePlane) {
  const std::array thrown{
      Thrown{.size = {{1, 1}}, .position = {{0, 0.8}}, .velocity = {{1, 0}}, .angle = 0.6, .spin = -1},
      Thrown{.size = {{2, 0.1}}, .position = {{0, 1.2}}, .velocity = {{3, -1}}, .angle = 1.1, .friction = 0.3},
      Thrown{.size = {{1, 0.5}},
             .position = {{0, 1.5}},
             .velocity = {{2, 0}},
             .angle = 0.3,
             .spin = 4,
             .friction = 0.7,
             .restitution = 0.6},
  };
  for (const Thrown& of : thrown) {
    World2 flat = in_plane(of);
    World3 deep = in_space(of);
    ExactMotion plane(flat, {.tolerance = 1e-12});
    ExactMotion space(deep, {.tolerance = 1e-12});
    for (int k = 1; k <= 15; ++k) {
      advance(plane, 0.1 * k), advance(space, 0.1 * k);
      EXPECT_NEAR(flat.position[0][0], deep.position[0][0], 1e-8) << of.size[1] << ' ' << k;
      EXPECT_NEAR(flat.position[0][1], deep.position[0][2], 1e-8) << of.size[1] << ' ' << k;
      EXPECT_NEAR(flat.spin[0][0], -deep.spin[0][1], 1e-7) << of.size[1] << ' ' << k;
      EXPECT_NEAR(deep.position[0][1], 0, 1e-9);
    }
  }
}
// P. Painleve, "Sur les lois du frottement de glissement", 1895: with much friction, a rod that is pushed ahead of its
// foot has no forces that belong together.
TEST(ExactFriction, PainlevesRodIsNotMovedWronglyInSpace) {
  const double angle = 0.9, half = std::hypot(1, 0.02);
  const double diagonal = angle + std::atan2(0.02, 1.0);
  World3 world = in_space({.size = {{2, 0.04}},
                           .position = {{half * std::cos(diagonal), half * std::sin(diagonal)}},
                           .velocity = {{-4, 0}},
                           .angle = angle,
                           .friction = 2});
  ExactMotion motion(world);
  const Status status = motion.advance_to(1);
  EXPECT_EQ(status.ending, Ending::cannot_continue);
  EXPECT_THAT(status.message, testing::HasSubstr("Painleve"));
  EXPECT_LT(energy(world), 16.0 / 2 + g + 1e-9);
}

}  // namespace
}  // namespace continuo::exact_friction_test
