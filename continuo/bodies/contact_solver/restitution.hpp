// Restitution is no matter of a soft contact: a spring gives back what its damping leaves. What bounces, or is so fast
// that it would go through, is an impact, located within the substep and reversed at its instant by u' = -e u
// (impacts.hpp). This kernel says which contacts of a batch are left to these: they get no impulse here.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include <continuo/bodies/contact_solver/contact_batches.hpp>
#include <continuo/bodies/contact_solver/contact_step.hpp>

namespace continuo {

/// The lanes that are left to impacts. Too fast for a soft contact: it has struck in this substep and parts, or it will
/// at the beginning of the next. What gravity alone brings about in a substep is no impact; nor is, without
/// restitution, what moves it by less than half a radius; nor what comes about, while contacts are solved, between two
/// that have touched since it began: in the end it may be slower than an impact is, and then nothing would hold them
/// apart. What has struck begins so far behind where it did, perhaps, that it comes from the other side of the other.
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
