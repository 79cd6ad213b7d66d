// continuo/bodies/forces.hpp
// The forces and torques of a world at any positions and velocities, not only the present ones, for integrators.
#pragma once
#include <span>

#include <continuo/bodies/world.hpp>

namespace continuo {

/// force[i] = the sum of all forces on body i at x[i], v[i]; 0 of fixed bodies. All of size world.size(). O(N), with
/// attraction O(N^2) or, where it has an opening, O(N log N).
template <class Real, int Dim>
void forces(const World<Real, Dim>& world, Real t, std::span<const Vector<Real, Dim>> x,
            std::span<const Vector<Real, Dim>> v, std::span<Vector<Real, Dim>> force);

/// torque[i] = the sum of all torques on body i. Fixed bodies have torques too, although these turn nothing.
template <class Real, int Dim>
void torques(const World<Real, Dim>& world, Real t, const BodyStates<Real, Dim>& at, std::span<Spin<Real, Dim>> torque);

/// Whether gravity is the only force, so that paths between collisions are parabolas.
template <class Real, int Dim>
[[nodiscard]] bool only_gravity(const World<Real, Dim>& world);

}  // namespace continuo
