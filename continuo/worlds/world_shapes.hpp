// The shapes of a world for display: names, sizes and constant positions of its bodies, walls and springs.
#pragma once
#include <cstddef>
#include <variant>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/language/world.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

/// The bodies, walls and springs of a world, without their motion.
struct Shapes {
  std::vector<BodyShape> bodies;
  std::vector<WallShape> walls;
  std::vector<SpringShape> springs;
};

/// A vector as a point; z is 0 in the plane.
template <int Dim>
[[nodiscard]] Point point_of(const Vector<double, Dim>& v) {
  Point point{};
  for (std::size_t i = 0; i < v.size(); ++i) point[i] = v[i];
  return point;
}

/// `text` is the description from which the world was built; its names have the order of the world.
template <int Dim>
[[nodiscard]] Shapes shapes_of(const World<double, Dim>& world, const model::WorldDescription& text) {
  Shapes shapes;
  for (std::size_t i = 0; i < world.size(); ++i)
    shapes.bodies.push_back({text.bodies[i].name, world.radius[i], world.mass[i], world.is_fixed(i)});
  for (std::size_t w = 0; w < world.walls().size(); ++w) {
    const Wall<double, Dim>& wall = world.walls()[w];
    shapes.walls.push_back({text.walls[w].name, point_of<Dim>(wall.normal), wall.offset, wall.thin});
  }
  for (std::size_t k = 0; k < world.springs.size(); ++k) {
    const auto* end = std::get_if<Vector<double, Dim>>(&world.springs[k].b);
    shapes.springs.push_back({text.springs[k].a, text.springs[k].b, end ? point_of<Dim>(*end) : Point{}});
  }
  return shapes;
}

}  // namespace continuo::worlds
