// Simultaneous impacts without restitution. The impulses of all contacts are found together: if they were resolved one
// after the other, an impulse that is corrected later could have separated another contact for good. Afterwards no two
// bodies approach each other, no impulse pulls, only contacts that stay closed have an impulse, and friction either
// stops the slip or has the size of the Coulomb limit (J. J. Moreau, in "Nonsmooth Mechanics and Applications", CISM
// 302, 1988).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/direct_presses.hpp>
#include <continuo/bodies/contacts/newton_impulses.hpp>
#include <continuo/bodies/contacts/persistent_contact.hpp>
#include <continuo/bodies/contacts/projected_gauss_seidel.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

template <class Real>
struct JointImpulses {
  std::vector<Real> along_normals{};  // of each pair
  Real error{};                       // of a speed, about: the greatest change by the last sweep
};

/// Changes the velocities and spins of the world in up to 1000 sweeps, until these change no speed by more than
/// `least`; where that does not suffice, directly, or, where something rubs, by Newton's method, in 20 times as many,
/// and at last in as many from what would be without friction: the sweeps then have to find only what friction adds.
template <class Real, int Dim>
[[nodiscard]] JointImpulses<Real> strike_together(World<Real, Dim>& world, std::span<const Touching> touching,
                                                  const Real& least) {
  std::vector<std::uint32_t> bodies;
  for (const Touching& pair : touching) {
    bodies.push_back(pair.a);
    if (!pair.with_wall()) bodies.push_back(pair.b);
  }
  std::ranges::sort(bodies);
  bodies.erase(std::ranges::unique(bodies).begin(), bodies.end());
  ProjectedGaussSeidel<Real, Dim> sweeps;
  for (const std::uint32_t i : bodies) sweeps.add(world, i);
  const auto place_of = [&](std::uint32_t i) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(bodies, i) - bodies.begin()) + 1;
  };
  for (const Touching& pair : touching) {
    PersistentContact<Real, Dim> contact(world, pair);
    contact.roll.most = Real(0);  // an impact is over before anything rolls
    contact.place(world, world.position, world.velocity, world.spin);
    sweeps.add(contact, place_of(pair.a), pair.with_wall() ? 0 : place_of(pair.b));
  }
  constexpr int most_sweeps = 1000;
  const auto free = sweeps.movers();
  JointImpulses<Real> made{.error = sweeps.sweep(least, most_sweeps)};
  const bool rubs = std::ranges::any_of(sweeps.rows(), [](const auto& row) { return row.friction > Real(0); });
  if (made.error > least && !rubs && press_directly<Real, Dim>(sweeps, free)) made.error = sweeps.greatest_error();
  const auto is_found = [&] {
    return !(made.error > std::max(least, sweeps.fastest() * std::sqrt(std::numeric_limits<Real>::epsilon())));
  };
  if (!is_found() && rubs && sweeps.rows().size() <= NewtonImpulses<Real, Dim>::usual_rows) {
    sweeps.apply(free, NewtonImpulses<Real, Dim>(sweeps, free).find());
    made.error = sweeps.sweep(least, most_sweeps / 10);
    if (!is_found()) {
      sweeps.apply(free, NewtonImpulses<Real, Dim>(sweeps, free).find_by_parts());
      made.error = sweeps.sweep(least, most_sweeps / 10);
    }
  }
  if (!is_found()) made.error = sweeps.sweep(least, 20 * most_sweeps);
  if (!is_found() && rubs) {
    sweeps.restore(free);
    if (press_directly<Real, Dim>(sweeps, free)) made.error = sweeps.sweep(least, 20 * most_sweeps);
  }
  for (const std::uint32_t i : bodies) {
    const auto& mover = sweeps.mover(place_of(i));
    world.velocity[i] = mover.v, world.spin[i] = mover.spin;
  }
  for (const auto& row : sweeps.rows()) made.along_normals.push_back(row.impulse.press);
  return made;
}

}  // namespace continuo
