// Adds the impulses of contacts to the velocities of their two bodies, several contacts at once, and bounds such
// impulses.
//
// Between spheres the arms lie along the normal n: a normal impulse turns nothing, and the mass that resists an impulse
// across the normal is a number, 1 / (1/m_a + 1/m_b + r_a^2/J_a + r_b^2/J_b). An impulse p on b at the point of contact
// is -p on a; both rims (radius times spin) change by the same moment n x p, times r^2 / J.
#pragma once
#include <cmath>

#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/contact_solver/lane_bodies.hpp>

namespace continuo {

template <class Real>
[[nodiscard]] ContactLanes<Real> inverse_or_zero(const ContactLanes<Real>& x) {
  return select(x > ContactLanes<Real>(Real(0)), ContactLanes<Real>(Real(1)) / x, ContactLanes<Real>(Real(0)));
}
template <class Real>
[[nodiscard]] ContactLanes<Real> smaller_radius(const ContactLanes<Real>& a, const ContactLanes<Real>& b) {
  return select(b > ContactLanes<Real>(Real(0)), min(a, b), a);  // a wall has no radius
}
/// A wall has neither a radius nor a spin, and any radius will do.
template <ContactKind kind, class Real>
[[nodiscard]] ContactLanes<Real> other_radius(const ContactLanes<Real>& radius_a, const ContactLanes<Real>& radius_b) {
  return kind == ContactKind::with_wall ? radius_a : radius_b;
}

/// Adds an impulse on b at the point of contact, and its opposite on a; `across` is its part across the normal.
template <class Real, int Dim>
void add_impulse(LaneMotions<Real, Dim>& a, LaneMotions<Real, Dim>& b, const Vector<ContactLanes<Real>, Dim>& normal,
                 const Vector<ContactLanes<Real>, Dim>& impulse, const Vector<ContactLanes<Real>, Dim>& across) {
  a.v -= impulse * a.inverse_mass;
  b.v += impulse * b.inverse_mass;
  const Spin<ContactLanes<Real>, Dim> change = moment(normal, across);
  a.rim -= change * a.mobility;
  b.rim -= change * b.mobility;
}
/// Adds the impulse of a torque on b, and its opposite on a: the velocity of the rim changes by impulse r / J.
template <class Real, int Dim>
void add_roll(LaneMotions<Real, Dim>& a, LaneMotions<Real, Dim>& b, const ContactLanes<Real>& radius_a,
              const ContactLanes<Real>& radius_b, const Spin<ContactLanes<Real>, Dim>& impulse) {
  a.rim -= impulse * (a.mobility * inverse_or_zero<Real>(radius_a));
  b.rim += impulse * (b.mobility * inverse_or_zero<Real>(radius_b));
}
/// Adds the impulse of a torque about the normal on b, and its opposite on a. The impulse is given over the smaller
/// radius: the velocity of a rim changes by the impulse times the mobility times the smaller radius over its own.
template <class Real>
void add_spin(LaneMotions<Real, 3>& a, LaneMotions<Real, 3>& b, const Vector<ContactLanes<Real>, 3>& normal,
              const ContactLanes<Real>& radius_a, const ContactLanes<Real>& radius_b,
              const ContactLanes<Real>& impulse) {
  const ContactLanes<Real> over_both = impulse * inverse_or_zero<Real>(max(radius_a, radius_b));
  a.rim -= normal * (over_both * a.mobility * radius_b);
  b.rim += normal * (over_both * b.mobility * radius_a);
}

/// `impulse` no longer than `most`.
template <class Number, int Size>
[[nodiscard]] Vector<Number, Size> clamped(const Vector<Number, Size>& impulse, const Number& most) {
  using std::sqrt;
  const Number square = squared(impulse);
  return impulse * select(square > most * most, most / sqrt(square), Number(1));
}
/// `impulse` with its part across the normal no longer than `most`. In space, its part along the normal resists
/// spinning and is unchanged.
template <class Real, int Dim>
[[nodiscard]] Vector<ContactLanes<Real>, Dim> clamped_across(const Vector<ContactLanes<Real>, Dim>& impulse,
                                                             const Vector<ContactLanes<Real>, Dim>& normal,
                                                             const ContactLanes<Real>& most) {
  using std::sqrt;
  using L = ContactLanes<Real>;
  if constexpr (Dim == 2) return clamped(impulse, most);
  const L along = dot(impulse, normal), square = squared(impulse) - along * along, one(Real(1));
  const L part = select(square > most * most, most / sqrt(square), one);
  return impulse * part + normal * (along * (one - part));
}

}  // namespace continuo
