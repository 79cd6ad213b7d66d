// What does not bounce, in an instant: the impulses of all contacts together, so that none of them is pushed apart by
// what is taken from another a moment later. No two approach afterwards, no impulse pulls, one is only where the two
// stay together, and friction stops the slip, or rubs with all it has (J. J. Moreau, in "Nonsmooth Mechanics and
// Applications", CISM 302, 1988).
//
// By the projected Gauss-Seidel iteration: each contact in turn has its whole impulse so far set right for what the
// others do. Each turn lowers the kinetic energy as far as this contact can, so that without friction it cannot but
// converge (M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235-257, for friction).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/bodies/held_contact.hpp>
#include <continuo/bodies/impulse.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// Changes the velocities and spins of the world until the sweeps change no speed by more than `least`, but no more
/// often than some hundred times. Gives the normal impulses.
template <class Real, int Dim>
std::vector<Real> strike_together(World<Real, Dim>& world, std::span<const Touching> touching, const Real& least) {
  using V = Vector<Real, Dim>;
  struct Struck {
    HeldContact<Real, Dim> contact;
    Real of_normal{}, of_slip{};  // speeds by impulses of 1
    Real press{};
    V rub{};
  };
  std::vector<Struck> all;
  for (const Touching& one : touching) {
    Struck struck{HeldContact<Real, Dim>(world, one)};
    struck.contact.place(world, world.position, world.velocity, world.spin);
    const V normal = struck.contact.normal, side = across(normal).front();
    const auto along = struck.contact.ends(world, normal, {}), beside = struck.contact.ends(world, side, {});
    struck.of_normal = response(world, along, along), struck.of_slip = response(world, beside, beside);
    all.push_back(struck);
  }
  const auto apply = [&](const Struck& to, const V& impulse) {
    const auto ends = to.contact.ends(world, impulse, {});
    for (const auto& end : ends.ends()) {
      world.velocity[end.body] += end.force * world.inverse_mass[end.body];
      world.spin[end.body] += end.torque * world.inverse_inertia[end.body];
    }
  };
  const auto set_right = [&](Struck& one) {
    one.contact.move(world, world.velocity, world.spin);
    const Real press = std::max(Real(0), Real(one.press - one.contact.parting / one.of_normal));
    V rub = one.rub - one.contact.slip.rate * (1 / one.of_slip);
    const Real size = length(rub), most = one.contact.slip.most * press;
    if (size > most) rub *= most / size;
    const Real normal_change = press - one.press;
    const V change = rub - one.rub;
    apply(one, one.contact.normal * normal_change + change);
    one.press = press, one.rub = rub;
    return std::max(std::abs(normal_change) * one.of_normal, length(change) * one.of_slip);
  };
  constexpr int most_sweeps = 400;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    Real greatest(0);
    if (sweep % 2 == 0) {  // to and fro: what one end of a heap does is at the other at once
      for (Struck& one : all) greatest = std::max(greatest, set_right(one));
    } else {
      for (auto one = all.rbegin(); one != all.rend(); ++one) greatest = std::max(greatest, set_right(*one));
    }
    if (!(greatest > least)) break;
  }
  std::vector<Real> impulses;
  for (const Struck& one : all) impulses.push_back(one.press);
  return impulses;
}

}  // namespace continuo
