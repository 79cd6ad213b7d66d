// The scenes that are measured: balls of density 1, of radius 1/2 without other words, in a box.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {

struct Scene {
  std::vector<Vector<double, 3>> position{}, velocity{};
  std::vector<double> radius{};  // where they differ
  Vector<double, 3> gravity{}, upper{};
  Material<double> material{};
  double duration = 0, step = 1.0 / 60;
};

/// Elastic, in a cube, on a grid, all at speed 5 in any direction.
inline Scene gas(int count, double edge, double duration) {
  Scene scene{.upper = {{edge, edge, edge}}, .material = {1, 0, 0}, .duration = duration};
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  const int side = static_cast<int>(std::ceil(std::cbrt(count)));
  for (int i = 0; i < count; ++i) {
    const double spacing = edge / side;
    scene.position.push_back(
        {{(i % side + 0.5) * spacing, (i / side % side + 0.5) * spacing, (i / side / side + 0.5) * spacing}});
    Vector<double, 3> v{{normal(engine), normal(engine), normal(engine)}};
    scene.velocity.push_back(v * (5 / length(v)));
  }
  return scene;
}

/// Dropped from a jittered grid, side x side balls a layer, into an open box.
inline Scene dropped(int count, double edge, int side, double jitter_width, const Material<double>& material) {
  Scene scene{.gravity = {{0, 0, -9.81}}, .upper = {{edge, edge, 1e4}}, .material = material, .duration = 10};
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> jitter(-jitter_width, jitter_width);
  for (int i = 0; i < count; ++i) {
    const double spacing = edge / side;
    scene.position.push_back({{(i % side + 0.5) * spacing + jitter(engine),
                               (i / side % side + 0.5) * spacing + jitter(engine), 1 + 1.1 * (i / side / side)}});
    scene.velocity.push_back({});
  }
  return scene;
}
/// The field's: 40 x 40 for 10,000, of 36 x 36 balls a layer.
inline Scene heap(int count) {
  const double edge = 40 * std::sqrt(count / 10000.0);
  return dropped(count, edge, static_cast<int>(std::lround(edge * 0.9)), 0.02, {0, 0.5, 0});
}

/// A heap in which this part of the balls is `times` as large. It falls from cells that have a large ball each, or as
/// many small ones as fit.
inline Scene heap_of_two_sizes(int count, double part, int times) {
  const int large = static_cast<int>(std::lround(part * count)), in_cell = times * times * times;
  std::vector<int> balls_of_cell(static_cast<std::size_t>(large), 0);  // 0: a large one
  for (int left = count - large; left > 0; left -= in_cell) balls_of_cell.push_back(std::min(left, in_cell));
  std::mt19937 engine(1);
  for (std::size_t i = balls_of_cell.size(); i-- > 1;) std::swap(balls_of_cell[i], balls_of_cell[engine() % (i + 1)]);
  const int side = std::max(2, static_cast<int>(std::lround(std::cbrt(static_cast<double>(balls_of_cell.size())))));
  const double spacing = 1.1, edge = spacing * times;
  Scene scene{.gravity = {{0, 0, -9.81}}, .upper = {{edge * side, edge * side, 1e5}}, .material = {0, 0.5, 0}};
  const auto add = [&](const Vector<double, 3>& x, double radius) {
    scene.position.push_back(x);
    scene.velocity.push_back({});
    scene.radius.push_back(radius);
  };
  for (std::size_t cell = 0; cell < balls_of_cell.size(); ++cell) {
    const int at = static_cast<int>(cell);
    const Vector<double, 3> corner{{edge * (at % side), edge * (at / side % side), edge * (at / side / side)}};
    if (balls_of_cell[cell] == 0) add(corner + Vector<double, 3>{{edge / 2, edge / 2, edge / 2}}, 0.5 * times);
    for (int i = 0; i < balls_of_cell[cell]; ++i) {
      const Vector<double, 3> place{{i % times + 0.5, i / times % times + 0.5, i / times / times + 0.5}};
      add(corner + spacing * place, 0.5);
    }
  }
  return scene;
}

template <class Real>
World<Real, 3> world_of(const Scene& scene) {
  const auto as = [](const Vector<double, 3>& v) {
    return Vector<Real, 3>{{static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2])}};
  };
  const Material<Real> material{static_cast<Real>(scene.material.restitution),
                                static_cast<Real>(scene.material.friction), 0};
  World<Real, 3> world;
  world.gravity = as(scene.gravity);
  require(world.add_container({}, as(scene.upper), material));
  for (std::size_t i = 0; i < scene.position.size(); ++i)
    require(world.add({.shape = Sphere<Real>{static_cast<Real>(scene.radius.empty() ? 0.5 : scene.radius[i])},
                       .position = as(scene.position[i]),
                       .velocity = as(scene.velocity[i]),
                       .material = material}));
  return world;
}

}  // namespace continuo::bench
