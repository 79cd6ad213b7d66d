// continuo/bodies/event_driven/sphere_proxy.hpp
// Proxies for bodies that another engine moves: for all flying bodies, a sphere at rest replaces such a body.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/event_driven/flights.hpp>

namespace continuo {

/// Puts body i elsewhere, perhaps with another radius. All predictions for it become void.
template <class Real, int Dim>
void put(Flights<Real, Dim>& flights, std::uint32_t i, const Path<Real, Dim>& path, const Spin<Real, Dim>& spin,
         Act act) {
  Plan<Real, Dim>& plan = flights.plans[i];
  if (plan.is_large) {
    std::erase(flights.large, i);
  } else {
    flights.grid.remove(i, plan.cell);
  }
  plan = {.number = plan.number, .material = plan.material, .inverse_mass = plan.inverse_mass};
  if (act == Act::falls) plan.acceleration = flights.world.gravity;
  plan.is_large = 2 * path.radius > flights.grid.edge() || !flights.grid.has_cell(path.x);
  if (plan.is_large) {
    flights.large.push_back(i);
  } else {
    plan.cell = flights.grid.cell_of(path.x);
    flights.grid.insert(i, plan.cell);
  }
  const Real now = flights.now, inverse_inertia = flights.turnings[i].inverse_inertia;
  flights.turnings[i] = {.spin = spin, .spun_to = now, .spun_since = now, .inverse_inertia = inverse_inertia};
  flights.paths[i] = path;
  flights.acts[i] = act;
  ++flights.collisions[i];
}
template <class Real, int Dim>
void put_sphere(Flights<Real, Dim>& flights, std::uint32_t i, const Vector<Real, Dim>& centre, const Real& radius) {
  put(flights, i, {centre, {}, flights.now, radius}, {}, Act::is_proxy);
}
/// Puts the body itself back, in its state in the world.
template <class Real, int Dim>
void put_body(Flights<Real, Dim>& flights, std::uint32_t i) {
  const World<Real, Dim>& world = flights.world;
  const std::uint32_t k = flights.plans[i].number;
  put(flights, i, {world.position[k], world.velocity[k], flights.now, world.radius[k]}, world.spin[k], Act::falls);
}

/// Finds the numbers of the bodies that overlap body i now and can collide with it.
template <class Real, int Dim>
void find_overlapping(const Flights<Real, Dim>& flights, std::uint32_t i, std::vector<std::uint32_t>& found) {
  const Vector<Real, Dim> x = flights.place_now(i);
  std::vector<std::uint32_t> near;
  found.clear();
  flights.for_each_near(i, near, [&](std::uint32_t j) {
    const Real reach = flights.paths[i].radius + flights.paths[j].radius;
    if (j == i || !(squared(Vector<Real, Dim>(flights.place_now(j) - x)) < reach * reach)) return;
    const std::uint32_t a = flights.plans[i].number, b = flights.plans[j].number;
    if (flights.world.collide(a, b)) found.push_back(b);
  });
  std::ranges::sort(found);
}

}  // namespace continuo
