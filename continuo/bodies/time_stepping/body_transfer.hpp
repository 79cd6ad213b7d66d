// Copies bodies from the world to the arrays of the fast motion, in the order of its list of pairs, and back.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/contact_solver/solver_body.hpp>
#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/support/prefetch.hpp>
#include <continuo/bodies/support/thread_team.hpp>
#include <continuo/bodies/time_stepping/sleep.hpp>
#include <continuo/bodies/time_stepping/torque_integration.hpp>

namespace continuo {

/// Calls act(k, i) for all places k, where i is the number in the world of the body at place k. As the world has
/// another order, the elements of `arrays` are prefetched.
template <class Act, class... Arrays>
void for_each_in_order(ThreadTeam& team, const std::vector<std::uint32_t>& order, const Act& act,
                       const Arrays&... arrays) {
  constexpr std::size_t ahead = 20;
  team.for_each(0, order.size(), 1024, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      if (k + ahead < to) (prefetch(&arrays[order[k + ahead]]), ...);
      act(k, order[k]);
    }
  });
}

template <class Real, int Dim>
void load_bodies(ThreadTeam& team, const World<Real, Dim>& world, const std::vector<std::uint32_t>& order,
                 const ContactBlocks& blocks, const Sleep<Real, Dim>& sleep, SolverBodies<Real, Dim>& bodies) {
  using V = Vector<Real, Dim>;
  bodies.resize(order.size(), world.walls().size(), blocks);
  bodies.gravity = world.gravity;
  const auto load_body = [&](std::size_t k, std::size_t i) {
    const Real radius = world.radius[i];
    BodyMotion<Real>& motion = bodies.motion[k];
    BodyPlace<Real>& place = bodies.place[k];
    put(world.position[i], place.x_and_radius);
    place.x_and_radius[3] = radius;
    put(world.velocity[i], motion.linear);
    put(Spin<Real, Dim>(world.spin[i] * radius), motion.rim);
    const bool is_asleep = sleep.is_asleep(i);  // then it is treated as fixed
    motion.linear[3] = is_asleep ? Real(0) : world.inverse_mass[i];
    motion.rim[3] = is_asleep ? Real(0) : radius * radius * world.inverse_inertia[i];
  };
  for_each_in_order(team, order, load_body, world.position, world.velocity, world.spin, world.radius,
                    world.inverse_mass, world.inverse_inertia);
  for (std::size_t w = 0; w < world.walls().size(); ++w)
    put(V(world.walls()[w].normal * world.walls()[w].offset), bodies.place[bodies.wall(w)].x_and_radius);
  for (std::size_t k = bodies.wall(world.walls().size()); k < bodies.motion.size(); ++k) {  // the stand-ins
    bodies.place[k].x_and_radius[0] = static_cast<Real>(k % 2);
    bodies.motion[k].linear[3] = Real(1);
  }
  if (only_gravity(world)) bodies.accelerations.clear();
}

/// After a step of `step`.
template <class Real, int Dim>
void store_bodies(ThreadTeam& team, const SolverBodies<Real, Dim>& bodies, const std::vector<std::uint32_t>& order,
                  const TorqueIntegration<Real, Dim>& torques, const Real& step, World<Real, Dim>& world) {
  const auto store_body = [&](std::size_t k, std::size_t i) {
    if (!bodies.moves(k)) return;
    const Spin<Real, Dim> spin = vector_of<Spin<Real, Dim>::size()>(bodies.motion[k].rim) * (1 / bodies.radius(k));
    world.orientation[i] = torques.acts() ? torques.orientation(i) : turned(world.orientation[i], spin, step);
    world.position[i] = bodies.x(k);
    world.velocity[i] = bodies.v(k);
    world.spin[i] = spin;
  };
  for_each_in_order(team, order, store_body, world.orientation, world.position, world.velocity, world.spin);
}

}  // namespace continuo
