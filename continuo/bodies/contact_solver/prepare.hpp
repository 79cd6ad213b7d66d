// The first kernel of a substep: the present normal and separation of every contact.
//
// From a to b the normal is n = (x_b - x_a) / |x_b - x_a|, and the separation s = |x_b - x_a| - r_a - r_b, below 0
// where they overlap. A wall keeps its normal; the body that represents it has its centre in the plane of the wall, so
// that s = n . (x_b - x_a) - r_a. Within the substep s is that of its start plus n . (change of x_b - x_a): E. Catto,
// "Solver2D" (2024).
#pragma once
#include <cmath>

#include <continuo/bodies/contact_solver/contact_batches.hpp>
#include <continuo/bodies/contact_solver/contact_step.hpp>

namespace continuo {

template <class Real, int Dim>
struct PreparedContacts {
  Vector<ContactLanes<Real>, Dim> normal;
  ContactLanes<Real> radius_a, radius_b;
};

template <ContactKind kind, class Real, int Dim>
[[nodiscard]] PreparedContacts<Real, Dim> prepare(ContactBatch<Real, Dim>& batch,
                                                  const SolverBodies<Real, Dim>& bodies) {
  using L = ContactLanes<Real>;
  using std::sqrt;
  const auto place_a = load_places(bodies, batch.a), place_b = load_places(bodies, batch.b);
  const Vector<L, Dim> apart = place_b.x - place_a.x;
  Vector<L, Dim> normal = loaded(batch.normal);
  if constexpr (kind == ContactKind::with_wall) {
    batch.separation = dot(apart, normal) - place_a.radius;
  } else {
    const L distance = sqrt(squared(apart));
    const auto are_apart = distance > L(Real(0));
    normal = apart * select(are_apart, L(Real(1)) / distance, L(Real(0)));
    normal[0] = select(are_apart, normal[0], L(Real(1)));  // any direction will do
    store(normal, batch.normal);
    batch.separation = distance - (place_a.radius + place_b.radius);
  }
  return {normal, place_a.radius, place_b.radius};
}

}  // namespace continuo
