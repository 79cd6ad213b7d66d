// The marks that a pushing pass sets for the bodies of a batch: whether a contact has a normal impulse on them, and
// whether it has disturbed them (disturbances.hpp).
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <continuo/bodies/contact_solver/contact_batches.hpp>
#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/contact_solver/disturbances.hpp>

namespace continuo {

/// Marks the bodies on which a contact has a normal impulse: they move as their contacts allow, not on their parabolas.
template <ContactKind kind, class Real, int Dim>
void mark_touched(const ContactBatch<Real, Dim>& batch, const BatchImpulses<Real, Dim>& impulses,
                  SolverBodies<Real, Dim>& bodies) {
  for (std::size_t lane = 0; lane < lanes_at_once<Real>; ++lane) {
    const auto is_pressed = static_cast<std::uint8_t>(impulses.normal.lane[lane] > Real(0));
    bodies.touched[batch.a[lane]] |= is_pressed;  // no branch: it would be unpredictable
    if (kind == ContactKind::between_movers) bodies.touched[batch.b[lane]] |= is_pressed;
  }
}
/// 1 in the lanes of bodies that the last sweep, or this one, disturbed.
template <class Real, int Dim>
[[nodiscard]] std::array<Real, lanes_at_once<Real>> disturbed_lanes(const ContactBatch<Real, Dim>& batch,
                                                                    const SolverBodies<Real, Dim>& bodies,
                                                                    std::uint8_t sweep) {
  std::array<Real, lanes_at_once<Real>> is{};
  const Disturbances& disturbances = bodies.disturbances;
  for (std::size_t lane = 0; lane < is.size(); ++lane)
    is[lane] = static_cast<Real>(
        std::max(disturbances.sweep_of(batch.a[lane]), disturbances.sweep_of(batch.b[lane])) + 1 >= sweep);
  return is;
}
/// Marks the bodies of contacts whose relative velocity has changed by more than this way per substep. For a large body
/// a lot is more: otherwise one among small ones would have all its contacts solved again in every step. A call, since
/// it is rare, and inlined would take registers from the kernel.
template <ContactKind kind, class Real, int Dim>
[[gnu::noinline]] void mark_moved(const ContactBatch<Real, Dim>& batch,
                                  const std::array<Real, lanes_at_once<Real>>& way, SolverBodies<Real, Dim>& bodies,
                                  const ContactStep<Real>& step) {
  for (std::size_t lane = 0; lane < lanes_at_once<Real>; ++lane) {
    Real radius = bodies.radius(batch.a[lane]);
    if (kind == ContactKind::between_movers) radius = std::max(radius, bodies.radius(batch.b[lane]));
    if (way[lane] <= std::max(step.disturbance, step.disturbance_of_radius * radius)) continue;
    bodies.disturbances.mark(batch.a[lane], step.sweep);
    if (kind == ContactKind::between_movers) bodies.disturbances.mark(batch.b[lane], step.sweep);
  }
}
/// Marks the bodies of contacts whose relative velocity has changed by a lot; `change` is that change.
template <ContactKind kind, class Real, int Dim>
void mark_disturbed(const ContactBatch<Real, Dim>& batch, const ContactLanes<Real>& change,
                    SolverBodies<Real, Dim>& bodies, const ContactStep<Real>& step) {
  using L = ContactLanes<Real>;
  const L way = abs(change) * L(step.h);
  if (all(way <= L(step.disturbance))) return;
  std::array<Real, lanes_at_once<Real>> lanes;
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) lanes[lane] = way[lane];
  mark_moved<kind>(batch, lanes, bodies, step);
}

}  // namespace continuo
