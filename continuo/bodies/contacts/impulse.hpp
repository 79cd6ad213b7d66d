// continuo/bodies/contacts/impulse.hpp
// The impulse of a collision between two spheres, or a sphere and a wall: the normal impulse by Newton's restitution,
// the tangential impulse by Coulomb's friction, which at most stops the slip at the contact. O. Walton, R. Braun, J.
// Rheol. 30 (1986) 949-980, without tangential restitution.
#pragma once
#include <algorithm>
#include <cmath>

#include <continuo/bodies/body.hpp>

namespace continuo {

/// The motion of a sphere as an impulse changes it. A wall is one with inverses 0.
template <class Real, int Dim>
struct Mover {
  Vector<Real, Dim>& velocity;
  Spin<Real, Dim>& spin;
  Real radius, inverse_mass, inverse_inertia;
};

/// Velocity of b's surface relative to a's where they touch; `normal` points from a to b.
template <class Real, int Dim>
[[nodiscard]] Vector<Real, Dim> slip_of(const Mover<Real, Dim>& a, const Mover<Real, Dim>& b,
                                        const Vector<Real, Dim>& normal) {
  const Vector<Real, Dim> rate =
      b.velocity - turning(b.spin, normal * b.radius) - a.velocity - turning(a.spin, normal * a.radius);
  return rate - normal * dot(rate, normal);
}

/// What an impulse of 1 across the normal changes of the slip: 1/m1 + 1/m2 + r1^2/J1 + r2^2/J2.
template <class Real, int Dim>
[[nodiscard]] Real compliance_of_slip(const Mover<Real, Dim>& a, const Mover<Real, Dim>& b) {
  return a.inverse_mass + b.inverse_mass + a.radius * a.radius * a.inverse_inertia +
         b.radius * b.radius * b.inverse_inertia;
}
/// Applies an impulse across the normal to a, and the opposite one to b.
template <class Real, int Dim>
void rub(const Mover<Real, Dim>& a, const Mover<Real, Dim>& b, const Vector<Real, Dim>& normal,
         const Vector<Real, Dim>& impulse) {
  a.velocity += impulse * a.inverse_mass;
  b.velocity -= impulse * b.inverse_mass;
  const Spin<Real, Dim> twist = moment(normal, impulse);
  a.spin += twist * (a.radius * a.inverse_inertia);
  b.spin += twist * (b.radius * b.inverse_inertia);
}

/// Applies the impulse of a collision to both, which must approach each other; returns the normal impulse. With e = 1,
/// equal masses exchange their normal speeds to the last bit, since no quotient of masses is rounded.
template <class Real, int Dim>
[[nodiscard]] Real collide(const Mover<Real, Dim>& a, const Mover<Real, Dim>& b, const Vector<Real, Dim>& normal,
                           const Material<Real>& material) {
  const Real approach = -dot(b.velocity - a.velocity, normal);
  const Real sum = a.inverse_mass + b.inverse_mass;
  const Vector<Real, Dim> slip = slip_of(a, b, normal);
  const Real change = (1 + material.restitution) * approach;  // of the relative normal velocity
  a.velocity -= normal * (a.inverse_mass / sum * change);
  b.velocity += normal * (b.inverse_mass / sum * change);
  const Real speed = length(slip);
  if (!(material.friction > Real(0)) || !(speed > Real(0))) return change / sum;
  const Real compliance = compliance_of_slip(a, b);
  rub(a, b, normal,
      Vector<Real, Dim>(slip * (std::min(Real(material.friction * change / sum), Real(speed / compliance)) / speed)));
  return change / sum;
}

}  // namespace continuo
