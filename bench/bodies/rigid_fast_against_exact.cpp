// Twenty scenes of boxes and joints, each moved exactly and by the fast motion in steps of 1/60 s: how far the fast one
// is off in energy, momentum and mean position, and what both cost.
//   rigid_fast_against_exact
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>

#include <bench/bodies/fast_against_exact.hpp>

namespace continuo::bench {
namespace {

using World2 = World<double, 2>;
using World3 = World<double, 3>;
using V2 = Vector<double, 2>;
constexpr double g = 9.81, pi = std::numbers::pi;
constexpr Material<double> smooth{.restitution = 0, .friction = 0}, rough{.restitution = 0, .friction = 0.5};

/// A world with gravity along -y or -z, and a floor at 0.
template <int Dim>
World<double, Dim> over_floor(const Material<double>& material) {
  World<double, Dim> world;
  world.gravity[Dim - 1] = -g;
  require(world.add_wall({.material = material}));
  return world;
}

/// A box of side 1 over a floor, turned by an angle.
World2 falling_box(double height, double angle, const Material<double>& material, const V2& v = {}, double spin = 0) {
  World2 world = over_floor<2>(material);
  require(world.add({.shape = Box<double, 2>{},
                     .position = {{0, height}},
                     .velocity = v,
                     .orientation = {{angle}},
                     .spin = {{spin}},
                     .material = material}));
  return world;
}
World3 falling_cuboid() {
  const Material<double> material{.restitution = 0.5, .friction = 0};
  World3 world = over_floor<3>(material);
  require(world.add({.shape = Box<double, 3>{{{1, 1.5, 2}}},
                     .position = {{0, 0, 2}},
                     .orientation = {{std::cos(0.3), std::sin(0.3), 0, 0}},
                     .spin = {{0.2, 0.5, 1}},
                     .material = material}));
  return world;
}
/// A box on a slope with tan = 0.4: gravity is turned instead.
World2 slope(double friction) {
  const Material<double> material{.restitution = 0, .friction = friction};
  World2 world = falling_box(0.5, 0, material);
  const double angle = std::atan(0.4);
  world.gravity = {{g * std::sin(angle), -g * std::cos(angle)}};
  return world;
}
World2 stack(int boxes) {
  World2 world = over_floor<2>(rough);
  for (int i = 0; i < boxes; ++i)
    require(world.add({.shape = Box<double, 2>{}, .position = {{0, 0.5 + i}}, .material = rough}));
  return world;
}
/// On its corner, leaning by 0.1, with friction that holds it.
World2 rocking_box() {
  const double r = std::sqrt(0.5);
  const Material<double> material{.restitution = 0, .friction = 5};
  World2 world = over_floor<2>(material);
  require(world.add({.shape = Box<double, 2>{},
                     .position = {{r * std::sin(0.1), r * std::cos(0.1)}},
                     .orientation = {{pi / 4 - 0.1}},
                     .material = material}));
  return world;
}
World2 ladder() {
  World2 world;
  world.gravity = {{0, -g}};
  require(world.add_wall({.offset = -0.05, .material = smooth}));
  require(world.add_wall({.normal = {{1, 0}}, .offset = -0.05, .material = smooth}));
  const double start = 1.2;
  require(world.add({.shape = Capsule<double>{2, 0.05},
                     .position = {{std::cos(start), std::sin(start)}},
                     .orientation = {{pi / 2 - start}},
                     .material = smooth}));
  return world;
}

/// A bar along its first axis between two places of the plane of x and y; it collides with nothing.
template <int Dim>
BodyHandle add_bar(World<double, Dim>& world, const V2& from, const V2& to, double mass = 1) {
  Box<double, Dim> box;
  box.size.components.fill(0.1);
  box.size[0] = length(V2(to - from));
  BodyDefinition<double, Dim> bar{.shape = box, .mass = mass, .traits = {.category = 0, .mask = 0}};
  for (std::size_t i = 0; i < 2; ++i) bar.position[i] = (from[i] + to[i]) / 2;
  const double angle = std::atan2(to[1] - from[1], to[0] - from[0]);
  if constexpr (Dim == 2) {
    bar.orientation = {{angle}};
  } else {
    bar.orientation = {{std::cos(angle / 2), 0, 0, std::sin(angle / 2)}};
  }
  return require(world.add(bar));
}
template <int Dim>
void join(World<double, Dim>& world, JointKind kind, BodyHandle a, BodyHandle b, const V2& anchor) {
  JointDefinition<double, Dim> joint{.kind = kind, .a = a, .b = b};
  joint.anchor[0] = anchor[0], joint.anchor[1] = anchor[1];
  require(world.add_joint(joint));
}
/// Bars of length 1 from the origin along x, which begin to fall.
template <int Dim>
World<double, Dim> chain(int links, JointKind kind) {
  World<double, Dim> world;
  world.gravity[1] = -g;
  BodyHandle before{};
  for (int i = 0; i < links; ++i) {
    const BodyHandle link = add_bar<Dim>(world, V2{{double(i), 0}}, V2{{i + 1.0, 0}});
    join<Dim>(world, kind, before, link, V2{{double(i), 0}});
    before = link;
  }
  return world;
}
void drive(World2& world, BodyHandle crank, double speed) {
  require(world.add_joint({.kind = JointKind::hinge,
                           .b = crank,
                           .motor = JointMotor<double>{speed, std::numeric_limits<double>::infinity()}}));
}
World2 slider_crank() {
  World2 world;
  world.gravity = {{0, -g}};
  const V2 pin{{std::cos(0.3), std::sin(0.3)}}, end{{pin[0] + 3 * std::cos(std::asin(pin[1] / 3)), 0}};
  const BodyHandle crank = add_bar<2>(world, {}, pin), rod = add_bar<2>(world, pin, end, 2);
  const BodyHandle slider = add_bar<2>(world, V2{{end[0] - 0.1, 0}}, V2{{end[0] + 0.1, 0}});
  drive(world, crank, 2);
  join<2>(world, JointKind::hinge, crank, rod, pin);
  join<2>(world, JointKind::hinge, rod, slider, end);
  require(world.add_joint({.kind = JointKind::slider, .b = slider, .anchor = end, .axis = {{1, 0}}}));
  return world;
}
/// Crank 1, coupler 3, rocker 2.5, ground 3.
World2 four_bar() {
  World2 world;
  world.gravity = {{0, -g}};
  const V2 pin{{std::cos(0.9), std::sin(0.9)}}, ground{{3, 0}}, across = ground - pin;
  const double d = length(across), along = (d * d + 9 - 6.25) / (2 * d), aside = std::sqrt(9 - along * along);
  const V2 other = pin + across * (along / d) + V2{{-across[1], across[0]}} * (aside / d);
  const BodyHandle crank = add_bar<2>(world, {}, pin), coupler = add_bar<2>(world, pin, other),
                   rocker = add_bar<2>(world, other, ground);
  drive(world, crank, 2);
  join<2>(world, JointKind::hinge, crank, coupler, pin);
  join<2>(world, JointKind::hinge, coupler, rocker, other);
  join<2>(world, JointKind::hinge, {}, rocker, ground);
  return world;
}
/// `side` boxes to each side of a container, without gravity, of random sizes and velocities.
template <int Dim>
World<double, Dim> elastic_boxes(int side) {
  World<double, Dim> world;
  const Material<double> elastic{.restitution = 1, .friction = 0};
  Vector<double, Dim> upper;
  upper.components.fill(2.0 * side);
  require(world.add_container({}, upper, elastic));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  int count = 1;
  for (int axis = 0; axis < Dim; ++axis) count *= side;
  for (int i = 0; i < count; ++i) {
    BodyDefinition<double, Dim> body{.material = elastic};
    Box<double, Dim> box;
    for (double& edge : box.size.components) edge = 0.8 + 0.3 * number(random);
    body.shape = box;
    for (int axis = 0, k = i; axis < Dim; ++axis, k /= side)
      body.position[static_cast<std::size_t>(axis)] = k % side * 2 + 1;
    for (double& v : body.velocity.components) v = 2 * number(random);
    for (double& spin : body.spin.components) spin = 2 * number(random);
    require(world.add(body));
  }
  return world;
}
/// Turns about nearly its middle axis, and flips.
World3 nut() {
  World3 world;
  require(world.add({.shape = Box<double, 3>{{{3, 2, 1}}}, .spin = {{1.24, 0, 1}}, .mass = 12}));
  return world;
}
/// A flat box on a pin under its middle, which turns fast, and leans.
World3 top() {
  World3 world;
  world.gravity = {{0, 0, -g}};
  const double lean = 0.3;
  const BodyHandle body = require(world.add({.shape = Box<double, 3>{{{1, 1, 0.2}}},
                                             .position = {{0, -0.5 * std::sin(lean), 0.5 * std::cos(lean)}},
                                             .orientation = {{std::cos(lean / 2), std::sin(lean / 2), 0, 0}},
                                             .spin = {{0, -30 * std::sin(lean), 30 * std::cos(lean)}}}));
  require(world.add_joint({.kind = JointKind::ball, .b = body}));
  return world;
}

}  // namespace
}  // namespace continuo::bench

int main() {
  using namespace continuo::bench;
  using continuo::JointKind;
  print_head_of_comparison();
  compare("box falls flat, e = 0.5, 3 s", falling_box(2, 0, {.restitution = 0.5, .friction = 0}), 3);
  compare("box falls on its corner, e = 0.5, 2 s", falling_box(2, 0.6, {.restitution = 0.5, .friction = 0}), 2);
  compare("box thrown, with spin and friction, 2 s",
          falling_box(2, 0.2, {.restitution = 0.3, .friction = 0.4}, {{3, 0}}, 2), 2);
  compare("box on a slope that holds, 3 s", slope(0.41), 3);
  compare("box on a slope that slips, 3 s", slope(0.3), 3);
  compare("stack of 5, 3 s", stack(5), 3);
  compare("stack of 20, 3 s", stack(20), 3);
  compare("rocking box, 3 s", rocking_box(), 3);
  compare("ladder on a smooth wall, 1.5 s", ladder(), 1.5);
  compare("pendulum, 10 s", chain<2>(1, JointKind::hinge), 10);
  compare("double pendulum, 3 s", chain<2>(2, JointKind::hinge), 3);
  compare("chain of 10, 2 s", chain<2>(10, JointKind::hinge), 2);
  compare("slider crank with motor, 5 s", slider_crank(), 5);
  compare("four-bar linkage with motor, 5 s", four_bar(), 5);
  compare("36 elastic boxes of the plane, 2 s", elastic_boxes<2>(6), 2);
  compare("nut that flips, 20 s", nut(), 20);
  compare("cuboid falls, e = 0.5, 2 s", falling_cuboid(), 2);
  compare("27 elastic boxes in space, 2 s", elastic_boxes<3>(3), 2);
  compare("top on a pin, 3 s", top(), 3);
  compare("chain of 10 by ball joints, 2 s", chain<3>(10, JointKind::ball), 2);
}
