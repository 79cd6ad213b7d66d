// The guards of contacts in space that rub: friction reaches its limit, or a slip ends.
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <continuo/bodies/exact_rigid/cone_room.hpp>
#include <continuo/bodies/exact_rigid/reduced_contacts.hpp>
#include <continuo/bodies/exact_rigid/rigid_system.hpp>

namespace continuo {

/// The room of the forces of all contacts that stick, moved where that helps (cone_room.hpp).
template <class Real>
[[nodiscard]] Real room_of_sticking(const RigidSystem<Real, 3>& system) {
  const auto contacts = system.contacts();
  std::vector<Real> friction, forces;
  std::vector<MotionRow<Real, 3>> rows;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const auto& one = contacts[k];
    if (one.rubbing != Rubbing::sticks) continue;
    friction.push_back(one.friction);
    forces.push_back(system.press(k));
    for (const Real& force : system.hold(k)) forces.push_back(force);
  }
  const Real room = cone_room<Real>(friction, forces);
  if (friction.size() < 2 || !(room < Real(0))) return room;
  for (const auto& one : contacts) {
    if (one.rubbing != Rubbing::sticks) continue;
    const auto &a = system.bodies()[one.a], &b = system.bodies()[one.b];
    const auto at = place_of(one.feature, a, b);
    rows.push_back(normal_row(at, a, b));
    for (const auto& row : tangent_rows(at, a, b)) rows.push_back(row);
    for (std::size_t i = rows.size() - 3; i < rows.size(); ++i) rows[i].a = one.a, rows[i].b = one.b;
  }
  const ReducedContacts<Real, 3> reduced(system.bodies().data(), system.joint_rows(), rows);
  return ConeRoom<Real>(reduced.matrix(), friction).widen(forces);
}

/// The room of all that sticks; of each contact that slips what is left of its slip until it turns round, or turns
/// about 0 within its errors, and of one that has begun to slip what is left until its direction is sure; then whether
/// the forces of all that slip are stable. In units of a force and a speed.
template <class Real>
void add_rubbing_in_space(const RigidSystem<Real, 3>& system, const Real& force, const Real& speed,
                          std::vector<Real>& all) {
  bool sticks = false, slips = false;
  for (const auto& one : system.contacts()) {
    sticks = sticks || one.rubbing == Rubbing::sticks;
    if (one.rubbing != Rubbing::forwards) continue;
    slips = true;
    const auto slip = system.slip(one);
    all.push_back(dot(slip, one.slip) / speed);
    if (one.steady_below > Real(0)) all.push_back((one.steady_below - length(slip)) / speed);
    if (one.ends_below > Real(0)) all.push_back((length(slip) - one.ends_below) / speed);
  }
  if (sticks) all.push_back(room_of_sticking(system) / force);
  if (slips) all.push_back(system.is_stable() ? Real(1) : Real(-1));
}

}  // namespace continuo
