// Twenty scenes, each moved exactly and by the fast motion in steps of 1/60 s: how far the fast one is off in energy,
// momentum and mean position, and what both cost.
//   fast_against_exact
#include <cmath>
#include <random>
#include <vector>

#include <bench/bodies/fast_against_exact.hpp>

namespace continuo::bench {
namespace {

template <int Dim>
Vector<double, Dim> up(double height) {
  Vector<double, Dim> v;
  v[static_cast<std::size_t>(Dim - 1)] = height;
  return v;
}
template <int Dim>
Vector<double, Dim> all(double value) {
  Vector<double, Dim> v;
  for (std::size_t axis = 0; axis < v.size(); ++axis) v[axis] = value;
  return v;
}

/// A ball or disc of radius 1/2 over a floor.
template <int Dim>
World<double, Dim> one(double height, const Material<double>& material, double speed = 0) {
  World<double, Dim> world;
  world.gravity = up<Dim>(-9.81);
  require(world.add_wall({.material = {.restitution = 0, .friction = material.friction}}));
  Vector<double, Dim> v;
  v[0] = speed;
  require(world.add({.position = up<Dim>(height), .velocity = v, .material = material}));
  return world;
}

World<double, 3> cradle(int in, double gap) {
  World<double, 3> world;
  for (int i = 0; i < 5; ++i)
    require(world.add({.position = {{i * (1 + gap) - (i < in ? 1.0 : 0.0), 0, 0}},
                       .velocity = {{i < in ? 1.0 : 0.0, 0, 0}},
                       .material = {.restitution = 1, .friction = 0}}));
  return world;
}

/// `side` balls to each side of a box without gravity, of speed 5 in all directions, radii from `smallest` to 1/2.
template <int Dim>
World<double, Dim> gas(int side, double restitution, double smallest) {
  World<double, Dim> world;
  const double spacing = 1.6;
  const Material<double> material{.restitution = restitution, .friction = 0};
  require(world.add_container({}, all<Dim>(spacing * side), material));
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> radius(smallest, 0.5);
  int count = 1;
  for (int axis = 0; axis < Dim; ++axis) count *= side;
  for (int i = 0; i < count; ++i) {
    Vector<double, Dim> x, v;
    for (std::size_t axis = 0, rest = static_cast<std::size_t>(i); axis < x.size(); ++axis) {
      const auto many = static_cast<std::size_t>(side);
      x[axis] = (static_cast<double>(rest % many) + 0.5) * spacing;
      v[axis] = normal(engine);
      rest /= many;
    }
    require(world.add({.shape = Sphere<double>{smallest < 0.5 ? radius(engine) : 0.5},
                       .position = x,
                       .velocity = v * (5 / length(v)),
                       .material = material}));
  }
  return world;
}

World<double, 2> billiards() {
  World<double, 2> world;
  const Material<double> material{.restitution = 0.95, .friction = 0.05};
  require(world.add_container({{-15, -8}}, {{30, 8}}, material));
  const double row = std::sqrt(3.0) / 2 * 1.001;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j <= i; ++j)
      require(world.add({.position = {{row * i, 1.001 * (j - 0.5 * i)}}, .material = material}));
  require(world.add({.position = {{-10, 0.1}}, .velocity = {{10, 0}}, .material = material}));
  return world;
}

World<double, 2> galton() {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  const Material<double> material{.restitution = 0.4, .friction = 0.1};
  require(world.add_container({{-12, -30}}, {{12, 100}}, material));
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j <= i; ++j)
      require(world.add({.shape = Sphere<double>{0.2},
                         .position = {{2.0 * (j - 0.5 * i), -2.0 * i}},
                         .fixed = true,
                         .material = material}));
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  for (int i = 0; i < 40; ++i)
    require(
        world.add({.shape = Sphere<double>{0.3}, .position = {{jitter(engine), 2.0 + 2 * i}}, .material = material}));
  return world;
}

template <int Dim>
World<double, Dim> rain(int count, double restitution, double edge) {
  World<double, Dim> world;
  world.gravity = up<Dim>(-9.81);
  const Material<double> material{.restitution = restitution, .friction = 0.5};
  Vector<double, Dim> upper = all<Dim>(edge);
  upper[static_cast<std::size_t>(Dim - 1)] = 1000;
  require(world.add_container({}, upper, material));
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> place(0.6, edge - 0.6);
  for (int i = 0; i < count; ++i) {
    Vector<double, Dim> x;
    for (std::size_t axis = 0; axis + 1 < x.size(); ++axis) x[axis] = place(engine);
    x[x.size() - 1] = 1 + 1.1 * i;
    require(world.add({.position = x, .material = material}));
  }
  return world;
}

World<double, 3> shot(double aside) {
  World<double, 3> world;
  const Material<double> material{.restitution = 1, .friction = 0};
  require(world.add({.shape = Sphere<double>{0.01}, .fixed = true, .material = material}));
  require(world.add({.shape = Sphere<double>{0.01},
                     .position = {{-20, aside, 0}},
                     .velocity = {{1000, 0, 0}},
                     .material = material}));
  return world;
}

World<double, 3> oblique() {
  World<double, 3> world;
  const Material<double> material{.restitution = 0.9, .friction = 0.3};
  require(
      world.add({.position = {{-3, 0.2, 0.1}}, .velocity = {{4, 0, 0}}, .spin = {{0, 5, 3}}, .material = material}));
  require(world.add({.position = {{3, -0.2, 0.3}}, .velocity = {{-2, 0, 0}}, .mass = 2, .material = material}));
  return world;
}

World<double, 3> heavy_and_light() {
  World<double, 3> world;
  const Material<double> material{.restitution = 1, .friction = 0};
  for (int i = 0; i < 10; ++i)
    require(world.add({.position = {{1.1 * i, 0, 0}}, .mass = std::pow(0.5, i), .material = material}));
  require(world.add({.position = {{-4, 0, 0}}, .velocity = {{3, 0, 0}}, .mass = 10, .material = material}));
  return world;
}

}  // namespace
}  // namespace continuo::bench

int main() {
  using namespace continuo::bench;
  using Material = continuo::Material<double>;
  print_head_of_comparison();
  compare("throw, 2 s", one<3>(100, {}, 3), 2);
  compare("ball, e = 1, from 10 m, 20 s", one<3>(10.5, Material{.restitution = 1}), 20);
  compare("ball, e = 0.8, 10 s", one<3>(10.5, Material{.restitution = 0.8}), 10);
  compare("disc, e = 0.5, until it rests", one<2>(10.5, Material{.restitution = 0.5}), 8);
  compare("ball, e = 0, from 10 m, 3 s", one<3>(10.5, {}), 3);
  compare("ball that slides, then rolls, 3 s", one<3>(0.5, {}, 3), 3);
  compare("disc without friction, 3 s", one<2>(0.5, Material{.friction = 0}, 3), 3);
  compare("ball that bounces into rolling, 6 s", one<3>(3, Material{.restitution = 0.6, .friction = 0.4}, 4), 6);
  compare("Newton's cradle, one in, 3 s", cradle(1, 0), 3);
  compare("Newton's cradle, two in, gaps, 3 s", cradle(2, 0.001), 3);
  compare("two balls with spin, oblique, 2 s", oblique(), 2);
  compare("one through ten ever lighter ones, 3 s", heavy_and_light(), 3);
  compare("1 km/s against 1 cm, head-on, 0.1 s", shot(0), 0.1);
  compare("1 km/s against 1 cm, grazing, 0.1 s", shot(0.015), 0.1);
  compare("break shot of 15, 4 s", billiards(), 4);
  compare("gas of 100 discs, e = 1, 5 s", gas<2>(10, 1, 0.5), 5);
  compare("gas of 216 balls, e = 1, radii 0.2 to 0.5, 5 s", gas<3>(6, 1, 0.2), 5);
  compare("gas of 216 balls, e = 0.9, 5 s", gas<3>(6, 0.9, 0.5), 5);
  compare("Galton board, 40 discs, 3.5 s", galton(), 3.5);
  compare("rain of 60 balls into a box, e = 0.8, 4 s", rain<3>(60, 0.8, 6), 4);
}
