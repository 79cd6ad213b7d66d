// The second kernel of a substep: every contact begins with the impulses of the last one. In a pile at rest these are
// right already, and each substep has to correct little (E. Catto, "Iterative dynamics with temporal coherence", GDC
// 2005). All contacts do so before any is solved, since the solution of each depends on the impulses of the others.
#pragma once

#include <continuo/bodies/contact_solver/contact_batches.hpp>
#include <continuo/bodies/contact_solver/impulses.hpp>
#include <continuo/bodies/contact_solver/prepare.hpp>

namespace continuo {

template <ContactKind kind, class Real, int Dim>
void warm_start(ColouredBatches<Real, Dim>& batches, std::size_t p, const PreparedContacts<Real, Dim>& now,
                SolverBodies<Real, Dim>& bodies) {
  using L = ContactLanes<Real>;
  const ContactBatch<Real, Dim>& batch = batches.batches[p];
  BatchImpulses<Real, Dim>& impulses = batches.impulses[p];
  // The normal has turned since, so that the stored friction has a part along the present normal. In space that part
  // acts as a torque.
  Vector<L, Dim> friction = loaded(impulses.friction);
  const L along = dot(friction, now.normal);
  friction -= now.normal * along;
  if constexpr (Dim == 2) store(friction, impulses.friction);
  auto a = load_motions(bodies, batch.a), b = load_motions(bodies, batch.b);
  add_impulse<Real, Dim>(a, b, now.normal, now.normal * L(impulses.normal) + friction, friction);
  if constexpr (Dim == 3)
    add_spin<Real>(a, b, now.normal, now.radius_a, other_radius<kind, Real>(now.radius_a, now.radius_b), along);
  if (const auto* special = batches.special_material_of(p))
    add_roll<Real, Dim>(a, b, now.radius_a, now.radius_b, loaded(special->rolling_impulse));
  store_motions(a, bodies, batch.a);
  if constexpr (kind == ContactKind::between_movers) store_motions(b, bodies, batch.b);
}

}  // namespace continuo
