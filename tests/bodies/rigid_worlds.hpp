// Worlds of boxes and other shapes for the tests of rigid bodies.
#pragma once
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/status.hpp>

namespace continuo::test {

/// A vector in the plane of x and the vertical axis.
template <int Dim>
[[nodiscard]] Vector<double, Dim> upright_vector(double x, double height) {
  Vector<double, Dim> v;
  v[0] = x, v[Dim - 1] = height;
  return v;
}
/// The orientation after a turn by `angle` from the x axis towards the vertical one.
template <int Dim>
[[nodiscard]] Orientation<double, Dim> tilted(double angle) {
  if constexpr (Dim == 2) {
    return {{angle}};
  } else {
    return {{std::cos(angle / 2), 0, -std::sin(angle / 2), 0}};
  }
}
/// A plane through the origin that rises with x at an angle.
template <int Dim>
[[nodiscard]] World<double, Dim> world_on_slope(double angle, double friction) {
  World<double, Dim> world;
  world.gravity = upright_vector<Dim>(0, -9.81);
  EXPECT_TRUE(world.add_wall(
      {.normal = upright_vector<Dim>(-std::sin(angle), std::cos(angle)), .material = {.friction = friction}}));
  return world;
}
template <int Dim>
BodyHandle add_box(World<double, Dim>& world, const Vector<double, Dim>& position, double mass = 1,
                   double friction = 0.6) {
  const auto box =
      world.add({.shape = Box<double, Dim>{}, .position = position, .mass = mass, .material = {.friction = friction}});
  EXPECT_TRUE(box) << describe(box.status());
  return *box;
}
/// A floor between two walls, 8 wide, about its origin.
inline Compound<double, 2> tray() {
  Compound<double, 2> made;
  made.parts.push_back({.shape = Box<double, 2>{{{8, 0.5}}}, .position = {{0, -2}}});
  made.parts.push_back({.shape = Box<double, 2>{{{0.5, 8}}}, .position = {{-4, 2}}});
  made.parts.push_back({.shape = Box<double, 2>{{{0.5, 8}}}, .position = {{4, 2}}});
  return made;
}
template <int Dim>
void advance(FastMotion<double, Dim>& motion, int steps) {
  for (int k = 0; k < steps; ++k) {
    const Status status = motion.advance();
    ASSERT_TRUE(status) << describe(status);
  }
}

}  // namespace continuo::test
