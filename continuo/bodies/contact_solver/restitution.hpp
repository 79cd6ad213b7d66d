// A soft contact cannot model restitution: its spring gives back the energy that its damping leaves. Contacts that
// bounce, or are so fast that bodies would pass through each other, are impacts, located within the substep and
// reversed at their instant by u' = -e u (impacts.hpp). This kernel selects the contacts of a batch that are left to
// impacts: they get no impulse here.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include <continuo/bodies/contact_solver/contact_batches.hpp>
#include <continuo/bodies/contact_solver/contact_step.hpp>

namespace continuo {

/// The lanes that are left to impacts: contacts that have had an impact in this substep and separate, and contacts that
/// are too fast for a soft contact and will have one at the beginning of the next substep. An approach that gravity
/// alone causes in a substep is no impact, nor, without restitution, one by less than half a radius per substep. Bodies
/// that touched already at the beginning of the substep are left out as well: an approach between them may arise while
/// contacts are solved, and may be slower in the end than that of an impact, and then nothing would keep them apart. A
/// body that has had an impact begins the substep on its new path, perhaps so far back that it is on the other side of
/// its partner: so `parts_in_the_end` counts too.
template <class Real, int Dim>
[[nodiscard]] typename ContactLanes<Real>::Mask is_for_impacts(
    const ContactBatch<Real, Dim>& batch, const ContactLanes<Real>& restitution, const SolverBodies<Real, Dim>& bodies,
    const ContactLanes<Real>& separation, const ContactLanes<Real>& parting,
    const typename ContactLanes<Real>::Mask& parts_in_the_end, const ContactLanes<Real>& radius,
    const ContactStep<Real>& step) {
  using L = ContactLanes<Real>;
  const L zero(Real(0));
  if (!step.may_strike) return typename L::Mask(false);
  std::array<Real, lanes_at_once<Real>> struck{};
  for (std::size_t lane = 0; lane < struck.size(); ++lane) {
    const auto of = [&](std::uint32_t i) { return i < bodies.size() ? bodies.impacts[i] : 0u; };
    struck[lane] = of(batch.a[lane]) + of(batch.b[lane]) > 0 ? Real(1) : Real(0);
  }
  const auto has_struck = (L(struck) > zero) & (separation < zero) & ((parting > zero) | parts_in_the_end);
  const L approach = -parting;
  const auto bounces = restitution > zero;
  const auto will_strike = (bounces & (approach > L(4 * step.greatest_acceleration * step.h))) |
                           ((!bounces) & (approach * L(step.h) > radius * L(Real(0.5))));
  return has_struck | (will_strike & (L(batch.separation) > zero));
}

}  // namespace continuo
