// The kernel that solves contacts, several at once, one pass after another: sequential impulses, each of which corrects
// its own contact, with the velocities that the contacts before it have left.
//
// With the separation s and the normal velocity v, the goal of a substep of h is v = -s / h where the two bodies are
// apart: they may close the gap and no more. Where they overlap, the impulse is that of a soft contact
// (contact_step.hpp), and when bodies have moved, contacts `relax`: they are solved again with v = 0, which takes out
// the velocity that undoing the overlap gave. A normal impulse is never below 0. Friction acts across the normal
// against the slip, by the impulse that stops it, but at most by the coefficient times the normal impulse so far
// (Coulomb); the normal velocity is the same before and after it, so that both impulses are added at once. E. Catto,
// "Soft constraints" (GDC 2011), "Solver2D" (2024).
#pragma once
#include <cstddef>

#include <continuo/bodies/contact_solver/contact_batches.hpp>
#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/contact_solver/impulses.hpp>
#include <continuo/bodies/contact_solver/marks.hpp>
#include <continuo/bodies/contact_solver/restitution.hpp>
#include <continuo/bodies/contact_solver/torques.hpp>

namespace continuo {

/// The impulses of a batch after a pass, and the parts that the pass has added.
template <class Real, int Dim>
struct SolvedImpulses {
  using L = ContactLanes<Real>;
  L normal, added_normal;
  Vector<L, Dim> friction, added_friction;

  /// In these lanes nothing is added, and the impulses become the given ones.
  void leave(const typename L::Mask& these, const L& normal_instead, const Vector<L, Dim>& friction_instead) {
    const L zero(Real(0));
    normal = select(these, normal_instead, normal);
    added_normal = select(these, zero, added_normal);
    for (std::size_t axis = 0; axis < friction.size(); ++axis) {
      friction[axis] = select(these, friction_instead[axis], friction[axis]);
      added_friction[axis] = select(these, zero, added_friction[axis]);
    }
  }
};

/// `inverse`: 1/m_a + 1/m_b. Never below 0: a contact does not pull.
template <ContactPass pass, class Real>
[[nodiscard]] ContactLanes<Real> normal_impulse(const ContactLanes<Real>& so_far, const ContactLanes<Real>& speed,
                                                const ContactLanes<Real>& separation, const ContactLanes<Real>& inverse,
                                                const ContactStep<Real>& step) {
  using L = ContactLanes<Real>;
  const L zero(Real(0)), one(Real(1));
  const auto is_open = separation > zero;
  L bias = select(is_open, separation * L(1 / step.h), zero), of_mass = one, of_impulse = zero;
  if constexpr (pass != ContactPass::relax) {
    bias = select(is_open, bias, max(separation * L(step.soft.rate), L(-step.fastest_push)));
    of_mass = select(is_open, one, L(step.soft.of_mass));
    of_impulse = select(is_open, zero, L(step.soft.of_impulse));
  }
  return max(so_far - (speed + bias) * of_mass / inverse - of_impulse * so_far, zero);
}

/// Batch p; `is_plain`: all have the same friction, none bounces or resists rolling, and nothing is so fast that it may
/// strike.
template <ContactKind kind, ContactPass pass, bool is_plain, class Real, int Dim>
void solve(ColouredBatches<Real, Dim>& batches, std::size_t p, SolverBodies<Real, Dim>& bodies,
           const ContactStep<Real>& step) {
  using L = ContactLanes<Real>;
  const ContactBatch<Real, Dim>& batch = batches.batches[p];
  BatchImpulses<Real, Dim>& impulses = batches.impulses[p];
  [[maybe_unused]] SpecialMaterialBatch<Real, Dim>* const special = is_plain ? nullptr : batches.special_material_of(p);
  const L zero(Real(0)), one(Real(1));
  typename L::Mask is_meant(true);
  if constexpr (pass == ContactPass::push_again) {
    is_meant = L(disturbed_lanes(batch, bodies, step.sweep)) > zero;
    if (none(is_meant)) return;
  }

  // The two bodies, and where they are: as at the start of the substep, but for a pass after they have moved.
  auto a = load_motions(bodies, batch.a), b = load_motions(bodies, batch.b);
  const Vector<L, Dim> normal = loaded(batch.normal);
  const L so_far = impulses.normal;
  L separation = batch.separation, radius_a, radius_b;
  Vector<L, Dim> apart;
  if (pass == ContactPass::relax || !is_plain) {
    const auto place_a = load_places(bodies, batch.a), place_b = load_places(bodies, batch.b);
    radius_a = place_a.radius;
    radius_b = place_b.radius;
    apart = place_b.x - place_a.x;
    if (pass == ContactPass::relax) separation = dot(apart, normal) - (radius_a + radius_b);
  }
  if constexpr (!is_plain && pass != ContactPass::push_again)
    if (special) resist_rolling(*special, so_far, a, b, radius_a, radius_b);

  // Friction against the slip of the surfaces, and the normal impulse.
  const Vector<L, Dim> between = b.v - a.v;
  const L speed = dot(between, normal), inverse = a.inverse_mass + b.inverse_mass;
  const Vector<L, Dim> slip = between - turning(Spin<L, Dim>(a.rim + b.rim), normal) - normal * speed;
  L coefficient(step.friction);
  if constexpr (!is_plain)
    if (special) coefficient = special->friction;
  const Vector<L, Dim> friction_before = loaded(impulses.friction);
  SolvedImpulses<Real, Dim> now;
  now.friction = clamped_across<Real, Dim>(friction_before - slip * (one / (inverse + a.mobility + b.mobility)), normal,
                                           coefficient * so_far);
  now.added_friction = now.friction - friction_before;
  now.normal = normal_impulse<pass, Real>(so_far, speed, separation, inverse, step);
  now.added_normal = now.normal - so_far;

  // Contacts that are left to impacts, and contacts without a disturbed body, are not solved.
  if constexpr (!is_plain) {
    const L restitution = special ? L(special->restitution) : zero;
    const Vector<L, Dim> at_end = pass == ContactPass::relax ? apart : Vector<L, Dim>(apart + between * L(step.h));
    const auto parts_in_the_end =
        kind == ContactKind::with_wall ? typename L::Mask(false) : dot(at_end, between) > zero;
    now.leave(is_for_impacts<Real, Dim>(batch, restitution, bodies, separation, speed, parts_in_the_end,
                                        smaller_radius<Real>(radius_a, radius_b), step),
              zero, {});
  }
  if constexpr (pass == ContactPass::push_again) now.leave(!is_meant, so_far, friction_before);

  impulses.normal = now.normal;
  add_impulse<Real, Dim>(a, b, normal, now.added_friction + normal * now.added_normal, now.added_friction);
  if constexpr (pass == ContactPass::relax && Dim == 3)
    now.friction += normal * resist_spinning<Real>(dot(now.friction, normal), coefficient * now.normal, normal, a, b,
                                                   radius_a, other_radius<kind, Real>(radius_a, radius_b));
  store(now.friction, impulses.friction);
  store_motions(a, bodies, batch.a);
  if constexpr (kind == ContactKind::between_movers) store_motions(b, bodies, batch.b);
  if constexpr (pass != ContactPass::relax) {
    mark_touched<kind>(batch, impulses, bodies);
    mark_disturbed<kind>(batch, now.added_normal * inverse, bodies, step);
  }
}

}  // namespace continuo
