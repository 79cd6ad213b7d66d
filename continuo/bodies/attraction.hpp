// continuo/bodies/attraction.hpp
// Gravity between all pairs of bodies: by exact sums, or by a tree in which distant cells act from their centre of mass
// (J. Barnes, P. Hut, Nature 324 (1986) 446-449): a cell counts as one body where its edge is below `opening` times its
// distance.
#pragma once
#include <span>

#include <continuo/bodies/world.hpp>

namespace continuo {

/// Adds to force[i] the attraction of body i, at x[i], by all other bodies.
template <class Real, int Dim>
void add_attraction(const World<Real, Dim>& world, std::span<const Vector<Real, Dim>> x,
                    std::span<Vector<Real, Dim>> force);

/// -G m1 m2 / sqrt(r^2 + softening^2) over all pairs that include a body that moves; exact, O(N^2).
template <class Real, int Dim>
[[nodiscard]] Real attraction_energy(const World<Real, Dim>& world);

}  // namespace continuo
