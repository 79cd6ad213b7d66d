// continuo/bodies/event_driven/resting.hpp
// When a body that bounces on walls comes to rest on them: when its next flight would be shorter than the contact time.
// From then on it moves along the walls that support it, accelerated by the part of gravity along them, until another
// body hits it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <continuo/bodies/event_driven/flights.hpp>
#include <continuo/bodies/event_driven/rolling.hpp>

namespace continuo {

/// Sets the motion of the resting body i along its supports. In a groove or a corner, on several walls without
/// friction, it slides.
template <class Real, int Dim>
void go_on_along(Flights<Real, Dim>& flights, std::uint32_t i, const Real& contact_time) {
  using V = Vector<Real, Dim>;
  Plan<Real, Dim>& plan = flights.plans[i];
  if (plan.support_count != 1) return;
  const Wall<Real, Dim> wall = facing(flights.world.walls()[plan.supports[0]], flights.paths[i].x);
  const V& gravity = flights.world.gravity;
  const Real press = -dot(gravity, wall.normal);
  const V pull = gravity + wall.normal * press;
  const Real rounding = 16 * std::numeric_limits<Real>::epsilon() * length(gravity);
  move_along(flights.paths[i], plan, flights.turnings[i], wall.normal,
             combined(flights.world.combine_rule, flights.material(i), wall.material),
             length(pull) > rounding ? pull : V{}, press, flights.now, contact_time);
}

/// The result of hitting a wall: the body flies, lies, or lies in a groove of several walls with friction, where it has
/// no parabola.
enum class Rest : std::uint8_t { flies, lies, lies_in_groove };

/// Lets body i rest on wall `hit`, which it has just hit, and on the other walls that it touches, if it would fly off
/// each of them for less than `contact_time`. In a groove with friction, only its velocity is made tangential to the
/// walls.
template <class Real, int Dim>
[[nodiscard]] Rest rest_on_walls(Flights<Real, Dim>& flights, std::uint32_t i, std::uint32_t hit,
                                 const Real& contact_time) {
  using V = Vector<Real, Dim>;
  const World<Real, Dim>& world = flights.world;
  Path<Real, Dim>& path = flights.paths[i];
  Plan<Real, Dim>& plan = flights.plans[i];
  const auto wall_at = [&](std::uint32_t w) { return facing(world.walls()[w], path.x); };
  const auto speed = [&](std::uint32_t w) { return dot(path.v, wall_at(w).normal); };
  // A wall is touched up to the gap by which the body could rise within the contact time, or up to the rounding of a
  // position.
  const auto touches = [&](std::uint32_t w, const Real& press) {
    const Wall<Real, Dim> wall = wall_at(w);
    const Real along = dot(wall.normal, path.x), gap = along - wall.offset - path.radius;
    const Real rounding = 16 * std::numeric_limits<Real>::epsilon() * (std::abs(along) + std::abs(wall.offset));
    return w == hit || gap < std::max(Real(contact_time * contact_time * press), rounding);
  };
  const auto leaves = [&](std::uint32_t w, const Real& press) { return !(2 * speed(w) < contact_time * press); };
  const Real press_on_hit = -dot(world.gravity, wall_at(hit).normal);
  if (!(press_on_hit > Real(0)) || leaves(hit, press_on_hit)) return Rest::flies;

  // One wall after the other, beginning with the one against which gravity presses the body most. Each removes from
  // gravity and velocity the part along its normal, made orthogonal to the normals before.
  std::array<V, static_cast<std::size_t>(Dim)> across{};
  V pull = world.gravity;
  const Real least = length(world.gravity) * 16 * std::numeric_limits<Real>::epsilon();
  plan.support_count = 0;
  while (plan.support_count < Dim) {
    std::uint32_t next = nobody;
    Real most = least;
    for (std::uint32_t w = 0; w < world.walls().size(); ++w) {
      const Real press = -dot(pull, wall_at(w).normal);
      if (!(press > most) || leaves(w, press) || !touches(w, press)) continue;
      if (Flights<Real, Dim>::is_support(plan, w)) continue;
      most = press;
      next = w;
    }
    if (next == nobody) break;
    V direction = wall_at(next).normal;
    for (std::uint32_t k = 0; k < plan.support_count; ++k) direction -= across[k] * dot(direction, across[k]);
    const Real part = length(direction);
    if (!(part > Real(1e-3))) break;  // nearly parallel to walls that support the body already
    direction *= 1 / part;
    across[plan.support_count] = direction;
    plan.supports[plan.support_count++] = next;
    pull -= direction * dot(pull, direction);
    path.v -= direction * dot(path.v, direction);
  }
  if (plan.support_count == 0) return Rest::flies;
  const auto rubs = [&](std::uint32_t w) {
    return combined(world.combine_rule.friction, flights.material(i).friction, world.walls()[w].material.friction) >
           Real(0);
  };
  if (plan.support_count > 1 && std::any_of(plan.supports.begin(), plan.supports.begin() + plan.support_count, rubs)) {
    plan.support_count = 0;
    return Rest::lies_in_groove;
  }
  plan.acceleration = pull;
  flights.turnings[i].rests_since = flights.now;
  flights.acts[i] = Act::rests;
  go_on_along(flights, i, contact_time);
  return Rest::lies;
}

/// The forces of the walls that support the resting body i: mass * (acceleration - gravity) = sum of forces along
/// normals.
template <class Real, int Dim>
std::array<Real, static_cast<std::size_t>(Dim)> support_forces(const Flights<Real, Dim>& flights, std::uint32_t i) {
  constexpr auto size = static_cast<std::size_t>(Dim);
  const Plan<Real, Dim>& plan = flights.plans[i];
  const std::size_t count = plan.support_count;
  const auto normal = [&](std::size_t k) {
    return facing(flights.world.walls()[plan.supports[k]], flights.paths[i].x).normal;
  };
  const Vector<Real, Dim> carried = (plan.acceleration - flights.world.gravity) * (1 / plan.inverse_mass);
  std::array<std::array<Real, size>, size> m{};  // normal equations, positive definite: no pivots needed
  std::array<Real, size> force{};
  for (std::size_t k = 0; k < count; ++k) {
    force[k] = dot(normal(k), carried);
    for (std::size_t l = 0; l < count; ++l) m[k][l] = dot(normal(k), normal(l));
  }
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t row = k + 1; row < count; ++row) {
      const Real factor = m[row][k] / m[k][k];
      for (std::size_t l = k; l < count; ++l) m[row][l] -= factor * m[k][l];
      force[row] -= factor * force[k];
    }
  for (std::size_t k = count; k-- > 0;) {
    for (std::size_t l = k + 1; l < count; ++l) force[k] -= m[k][l] * force[l];
    force[k] /= m[k][k];
  }
  return force;
}

}  // namespace continuo
