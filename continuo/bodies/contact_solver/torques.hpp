// Torques against the rotation of two spheres in contact, several contacts at once: rolling resistance, and friction
// within the contact patch, which resists spinning about the normal. Each begins with the impulse of the last substep,
// as a contact does (warm_start.hpp).
#pragma once
#include <numbers>

#include <continuo/bodies/contact_solver/contact_batches.hpp>
#include <continuo/bodies/contact_solver/impulses.hpp>

namespace continuo {

template <class Real, int Dim>
void resist_rolling(SpecialMaterialBatch<Real, Dim>& special, const ContactLanes<Real>& normal_impulse,
                    LaneMotions<Real, Dim>& a, LaneMotions<Real, Dim>& b, const ContactLanes<Real>& radius_a,
                    const ContactLanes<Real>& radius_b) {
  using L = ContactLanes<Real>;
  const L one_a = inverse_or_zero<Real>(radius_a), one_b = inverse_or_zero<Real>(radius_b);
  const L inertia = inverse_or_zero<Real>(a.mobility * one_a * one_a + b.mobility * one_b * one_b);
  const Spin<L, Dim> before = loaded(special.rolling_impulse);
  const Spin<L, Dim> impulse =
      clamped(Spin<L, Dim>(before - (b.rim * one_b - a.rim * one_a) * inertia),
              L(L(special.rolling_resistance) * smaller_radius<Real>(radius_a, radius_b) * normal_impulse));
  store(impulse, special.rolling_impulse);
  add_roll<Real, Dim>(a, b, radius_a, radius_b, impulse - before);
}

/// Soft spheres touch in a patch, which resists spinning about the normal by a torque of 3 pi / 16 friction times its
/// radius times the normal force (Hertz's pressure; K. L. Johnson, "Contact Mechanics", 1985, 7.4). The radius is that
/// of a sphere of radius r pressed in by 0.0025 r, as those within a pile are: sqrt(0.0025) r. Returns the addition to
/// the impulse of the last substep. If each substep began without an impulse, bodies that such a torque keeps at rest
/// would turn a little in every substep: a pile would creep by a millimetre per second, and lose a ball now and then
/// for ever.
template <class Real>
[[nodiscard]] ContactLanes<Real> resist_spinning(const ContactLanes<Real>& before, const ContactLanes<Real>& force,
                                                 const Vector<ContactLanes<Real>, 3>& normal, LaneMotions<Real, 3>& a,
                                                 LaneMotions<Real, 3>& b, const ContactLanes<Real>& radius_a,
                                                 const ContactLanes<Real>& radius_b) {
  using L = ContactLanes<Real>;
  const L stops = dot(a.rim * radius_b - b.rim * radius_a, normal) * max(radius_a, radius_b) *
                  inverse_or_zero<Real>(a.mobility * radius_b * radius_b + b.mobility * radius_a * radius_a);
  const L most = force * L(Real(3 * std::numbers::pi / 16 * 0.05));
  const L impulse = max(min(before + stops, most), -most);
  add_spin<Real>(a, b, normal, radius_a, radius_b, impulse - before);
  return impulse - before;
}

}  // namespace continuo
