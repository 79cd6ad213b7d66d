// Scenes of boxes and joints, with the sizes of the benchmarks of Box2D and Box3D.
#pragma once
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {

/// A vector in the plane of x and the vertical axis.
template <int Dim>
[[nodiscard]] Vector<float, Dim> upright(float x, float height, float depth = 0) {
  Vector<float, Dim> v;
  v[0] = x, v[Dim - 1] = height;
  if constexpr (Dim == 3) v[1] = depth;
  return v;
}
template <int Dim>
[[nodiscard]] Box<float, Dim> cube(float side) {
  Box<float, Dim> box;
  for (float& length : box.size.components) length = side;
  return box;
}
inline constexpr float friction = 0.6f;

template <int Dim>
[[nodiscard]] World<float, Dim> world_with_gravity() {
  World<float, Dim> world;
  world.gravity = upright<Dim>(0, Dim == 2 ? -10.0f : -9.81f);
  return world;
}
template <int Dim>
void add_floor(World<float, Dim>& world) {
  require(world.add_wall({.normal = upright<Dim>(0, 1), .material = {.friction = friction}}));
}
/// Unit boxes in rows of base, base - 1, ..., 1; `x` is where the lowest row begins.
template <int Dim>
void add_pyramid(World<float, Dim>& world, int base, float x, float height, float depth) {
  for (int i = 0; i < base; ++i)
    for (int j = i; j < base; ++j)
      require(world
                  .add({.shape = cube<Dim>(1),
                        .position = upright<Dim>(x + 0.5f * static_cast<float>(i + 1) + static_cast<float>(j - i),
                                                 height + static_cast<float>(i) + 0.5f, depth),
                        .material = {.friction = friction}})
                  .status());
}
template <int Dim>
[[nodiscard]] World<float, Dim> large_pyramid(int base) {
  World<float, Dim> world = world_with_gravity<Dim>();
  add_floor(world);
  add_pyramid(world, base, -0.5f * static_cast<float>(base), 0, 0);
  return world;
}
/// In the plane, floors above each other; in space, rows behind each other.
template <int Dim>
[[nodiscard]] World<float, Dim> many_pyramids(int rows, int columns) {
  World<float, Dim> world = world_with_gravity<Dim>();
  constexpr int base = 10;
  const float width = static_cast<float>(columns) * (base + 1);
  if (Dim == 3) add_floor(world);
  for (int row = 0; row < rows; ++row) {
    const float shift = static_cast<float>(row) * (base + 1);
    if constexpr (Dim == 2) {
      require(world
                  .add({.shape = Box<float, 2>{{{width + 2, 0.1f}}},
                        .position = {{0, shift - 0.05f}},
                        .fixed = true,
                        .material = {.friction = friction}})
                  .status());
    }
    for (int column = 0; column < columns; ++column)
      add_pyramid(world, base, -0.5f * width + static_cast<float>(column) * (base + 1) + 0.5f, Dim == 2 ? shift : 0,
                  shift);
  }
  return world;
}
/// Small boxes in a box of 20 that a motor turns.
[[nodiscard]] inline World<float, 2> tumbler(int side) {
  World<float, 2> world = world_with_gravity<2>();
  Compound<float, 2> walls;
  const auto add = [&](float x, float y, float width, float height) {
    walls.parts.push_back({.shape = Box<float, 2>{{{width, height}}}, .position = {{x, y}}});
  };
  add(10, 0, 1, 20), add(-10, 0, 1, 20), add(0, 10, 20, 1), add(0, -10, 20, 1);
  const auto drum =
      world.add({.shape = walls, .position = {{0, 10}}, .mass = 4000, .material = {.friction = friction}});
  require(drum.status());
  require(world
              .add_joint({.kind = JointKind::hinge,
                          .b = *drum,
                          .anchor = {{0, 10}},
                          .motor = JointMotor<float>{25 * std::numbers::pi_v<float> / 180, 1e8f}})
              .status());
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const float corner = -0.2f * static_cast<float>(side);
      require(
          world
              .add({.shape = Box<float, 2>{{{0.25f, 0.25f}}},
                    .position = {{corner + 0.4f * static_cast<float>(j), corner + 10 + 0.4f * static_cast<float>(i)}},
                    .mass = 0.0625f,
                    .material = {.friction = friction}})
              .status());
    }
  return world;
}
/// Balls in a grid that hinges, or in space balls, join; some of the highest row are fixed.
template <int Dim>
[[nodiscard]] World<float, Dim> joint_grid(int side) {
  World<float, Dim> world = world_with_gravity<Dim>();
  std::vector<BodyHandle> bodies;
  for (int k = 0; k < side; ++k)
    for (int i = 0; i < side; ++i) {
      const float x = static_cast<float>(k), height = static_cast<float>(-i);
      const bool is_fixed = i == 0 && (Dim == 3 || (k >= side / 2 - 3 && k <= side / 2 + 3));
      const auto body = world.add(
          {.shape = Sphere<float>{0.4f}, .position = upright<Dim>(x, height), .mass = 0.5f, .fixed = is_fixed});
      require(body.status());
      require(world.set_traits(*body, {.category = 2, .mask = ~std::uint64_t{2}}));
      const auto join = [&](const BodyHandle& other, float at_x, float at_height) {
        if (is_fixed && world.is_fixed(world.index(other))) return;
        require(world
                    .add_joint({.kind = Dim == 2 ? JointKind::hinge : JointKind::ball,
                                .a = other,
                                .b = *body,
                                .anchor = upright<Dim>(at_x, at_height)})
                    .status());
      };
      if (i > 0) join(bodies.back(), x, height + 0.5f);
      if (k > 0) join(bodies[bodies.size() - static_cast<std::size_t>(side)], x - 0.5f, height);
      bodies.push_back(*body);
    }
  return world;
}
/// Calls act(x, height) for each of 10,000 discs of radius 1/2 that fall into a box that is 100 wide, 90 in a row.
template <class Act>
void for_each_place_of_discs(Act&& act) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> jitter(-0.02f, 0.02f);
  for (int k = 0; k < 10000; ++k)
    act((static_cast<float>(k % 90) + 0.5f) * 100 / 90 + jitter(engine), 1 + 1.1f * static_cast<float>(k / 90));
}
[[nodiscard]] inline World<float, 2> heap_of_discs() {
  World<float, 2> world = world_with_gravity<2>();
  require(world.add_container({}, {{100, 1e4f}}, {.friction = friction}));
  for_each_place_of_discs([&](float x, float y) {
    require(
        world.add({.shape = Sphere<float>{0.5f}, .position = {{x, y}}, .material = {.friction = friction}}).status());
  });
  return world;
}

}  // namespace continuo::bench
